"""One interface to laws with any kind of memory: slip velocity and memory in, rates and friction out."""

from __future__ import annotations

import cmath
from typing import Any, NamedTuple

import numpy as np

from frictionlab.laws.base import FrictionLaw
from frictionlab.laws.memory import BristleLaw, MemoryLaw, bristle_in_the_plane, bristle_on_the_line

ContactMemory = tuple[Any, ...]


class Response(NamedTuple):
    """Response of a contact to a slip velocity: rates of its memory and the friction coefficient."""

    rates: ContactMemory
    friction: Any


def response(law: FrictionLaw, v: Any, memory: ContactMemory) -> Response:
    """Return the law at slip velocity ``v``: ``float`` on the line, ``complex`` in the plane."""
    if isinstance(law, BristleLaw):
        rate, friction = (bristle_in_the_plane if isinstance(v, complex) else bristle_on_the_line)(
            law, v, memory[0]
        )
        return Response((rate,), friction)
    if isinstance(law, MemoryLaw):
        kept = np.array(memory)
        rates = tuple(law.rate(v, kept, k) for k in range(len(memory)))
        return Response(rates, law.friction(v, kept, np.array(rates)))
    return Response((), law.sliding_vector(v))


def deflection_scale(law: BristleLaw) -> float:
    """Return the largest deflection, else the presliding length, else 1 [scene length]."""
    return next(
        (size for size in (law.largest_deflection(), law.presliding()) if 0.0 < size < float("inf")), 1.0
    )


def memory_after_slip(law: FrictionLaw, v: Any, share: float) -> ContactMemory:
    """A share of the deflections of steady sliding at velocity ``v``; scalars as in steady sliding."""
    if isinstance(law, BristleLaw):
        return (share * deflection_scale(law) * (v / abs(v)),)
    if isinstance(law, MemoryLaw):
        share = share if law.memory_kind == "deflections" else 1.0
        return tuple(share * law.steady(v, k) for k in range(law.count()))
    return ()


def stored_work(law: FrictionLaw, memory: ContactMemory) -> float:
    """Return the recoverable work in the memory per unit normal load [scene length]."""
    if isinstance(law, BristleLaw):
        return law.stored(memory[0])
    return law.stored(np.array(memory)) if isinstance(law, MemoryLaw) else 0.0


def rotate(law: FrictionLaw, memory: ContactMemory, turn: complex) -> ContactMemory:
    """Memory after a rotation of the plane: deflections rotate, scalars and a deflection along slip do not."""
    if not has_direction(law):
        return memory
    return tuple(turn * each for each in memory)


def reflect(law: FrictionLaw, memory: ContactMemory) -> ContactMemory:
    """Return the memory after a reflection about the direction of the belt."""
    return tuple(each.conjugate() for each in memory) if has_direction(law) else memory


def has_direction(law: FrictionLaw) -> bool:
    """Check whether the memory has a direction."""
    return not isinstance(law, MemoryLaw) or law.memory_kind == "deflections"


def no_plane(law: FrictionLaw) -> str:
    """Why the law has no meaning in the plane, or ''."""
    return law.no_vector_form() if isinstance(law, BristleLaw) and law.planar == "vectorial" else ""


def dot(a: Any, b: Any) -> float:
    """Return the scalar product of two vectors of the plane, or the product on the line."""
    return float((a * b.conjugate()).real)


def rounding_noise(law: FrictionLaw, v: Any, memory: ContactMemory, step: float = 1e-13) -> Response:
    """Return the change of the response under rounding of its arguments: the smallest tolerance of a comparison."""
    base = response(law, v, memory)
    rates, friction = [0.0] * len(memory), 0.0
    shifts = (1.0 + step, 1.0 - step, cmath.exp(1j * step))
    for shift in shifts if isinstance(v, complex) else shifts[:2]:
        moved = [response(law, shift * v, memory)]
        for k, each in enumerate(memory):
            if isinstance(each, complex) or not isinstance(shift, complex):
                moved.append(response(law, v, (*memory[:k], shift * each, *memory[k + 1 :])))
        for other in moved:
            friction = max(friction, abs(other.friction - base.friction))
            rates = [max(was, abs(a - b)) for was, a, b in zip(rates, other.rates, base.rates, strict=True)]
    return Response(tuple(rates), friction)
