"""A law linearized about steady sliding or about rest: what friction makes of small changes of the slip velocity."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from frictionlab.laws.base import FrictionLaw, SlidingLaw
from frictionlab.laws.memory import BristleLaw, MemoryLaw, bristle_in_the_plane, bristle_on_the_line
from frictionlab.quantities import EPSILON, Floats
from frictionlab.sensitivity.quotients import derivative
from frictionlab.theory.loops import Complexes
from frictionlab.theory.sliding_stability import steady_deflection

_WIDEST = 0.5
"""Of a number: the largest offset of difference quotients."""
_STEADY = 1e-9
"""Of what changes a memory: what its rate may be in steady sliding."""
_SHARP = 1e-6
"""Of what is differentiated: an error that is larger is that of a corner."""


class Linearized(NamedTuple):
    """Small changes: memory' = by_memory memory + by_slip v, friction = from_memory memory + from_slip v."""

    by_slip: Floats
    by_memory: Floats
    from_slip: float
    from_memory: Floats

    def impedance(self, s: Complexes) -> Complexes:
        """Change of friction per change of slip velocity at each s [1/time]; infinite at a pole."""
        found = np.full(s.shape, self.from_slip + 0j)
        for place in np.ndindex(s.shape if self.by_slip.any() else (0,)):
            lag = s[place] * np.eye(len(self.by_slip)) - self.by_memory
            try:
                found[place] += self.from_memory @ np.linalg.solve(lag, self.by_slip)
            except np.linalg.LinAlgError:
                found[place] = np.inf
        return found


def linearized(law: FrictionLaw, speed: float, across: bool) -> Linearized:
    """The law about steady sliding at this speed, or about rest at 0, along the slip or across it.

    Raises ValueError where there is no such state or where the law has a corner there.
    """
    if why := _no_steady_state(law, speed, across):
        raise ValueError(f"impedance: {why}")
    memory = _steady_memory(law, speed)
    n = len(memory)
    if speed > 0.0 and not across and isinstance(law, BristleLaw | MemoryLaw) and law.rate_independent():
        # friction of the path alone is constant while slip does not turn round, corner or not
        return Linearized(np.zeros(n), np.zeros((n, n)), 0.0, np.zeros(n))
    here = np.array([speed, *memory])
    sizes = np.where(here != 0.0, np.abs(here), law.presliding() or 1.0)
    jacobian, steady = _jacobian(law, _answer_of(law, speed, memory, across), sizes)
    if not steady:
        raise ValueError(f"impedance: rate of {law!r} does not vanish where steady puts its memory")
    return Linearized(jacobian[:-1, 0], jacobian[:-1, 1:], float(jacobian[-1, 0]), jacobian[-1, 1:])


def _no_steady_state(law: FrictionLaw, speed: float, across: bool) -> str:
    if not isinstance(law, SlidingLaw | BristleLaw | MemoryLaw):
        return f"{law!r} does not say what it remembers"
    if speed == 0.0 and isinstance(law, SlidingLaw):
        return f"at belt_speed 0 friction of {law!r} jumps where slip turns round; use fl.describing_function"
    if speed == 0.0 and law.memory_kind == "scalars":
        return f"at belt_speed 0 there is no sliding to renew the memory of {law!r}"
    return law.no_vector_form() if across and law.planar_form() == "vectorial" else ""


def _steady_memory(law: FrictionLaw, speed: float) -> list[float]:
    if speed == 0.0 or isinstance(law, SlidingLaw):
        return [0.0] * law.count()
    if isinstance(law, MemoryLaw):
        return [float(law.steady(speed, k)) for k in range(law.count())]
    assert isinstance(law, BristleLaw)
    z = float(steady_deflection(law, speed))
    return [z + law.rate(speed, z) * z / speed]  # a step of Newton's: rates fall as speed z/z_steady


def _answer_of(law: Any, speed: float, memory: list[float], across: bool) -> Callable[[Floats], Floats]:
    """What gives the rates of all numbers and friction after small changes of slip and memory, along or across."""
    unit: Any = 1j if across else 1.0
    change = 1.0 if law.memory_kind == "scalars" else unit

    def answer(by: Floats) -> Floats:
        v, *moved = by.tolist()
        numbers = [z + dz * change for z, dz in zip(memory, moved, strict=True)]
        rates, friction = _rates_and_friction(law, speed + v * unit, numbers, across, speed == 0.0)
        part = [each.imag if across else each.real for each in (*rates, friction)]
        return np.array(part, dtype=np.float64)

    return answer


def _rates_and_friction(law: Any, v: Any, memory: list[Any], across: bool, at_rest: bool) -> Any:
    if isinstance(law, SlidingLaw):
        return [], law.sliding_vector(v) if across else law.sliding_friction(v)
    if isinstance(law, BristleLaw):
        rate, friction = (bristle_in_the_plane if across else bristle_on_the_line)(law, v, memory[0])
        return [rate], friction
    rates = [v if at_rest and law.remembers_stick() else law.rate(v, memory, k) for k in range(len(memory))]
    return rates, law.friction(v, memory, rates)


def _jacobian(law: FrictionLaw, answer: Callable[[Floats], Floats], sizes: Floats) -> tuple[Floats, bool]:
    """The derivatives of all that is answered by all numbers, and whether memory is steady. Raises ValueError."""
    ways = np.eye(len(sizes)) * sizes
    here = answer(np.zeros(len(sizes)))
    terms = np.abs(here) + np.sum([np.abs(answer(_WIDEST * way) - here) / _WIDEST for way in ways], axis=0)
    columns = []
    for way in ways:

        def along(offsets: Floats, way: Floats = way) -> list[Floats | None]:
            return [answer(offset * way) for offset in offsets]

        found = derivative(along, here, _WIDEST, 4.0 * EPSILON * terms, scatters=False)
        if found.reason or (found.error > _SHARP * terms).any():
            raise ValueError(
                f"impedance: {law!r} has a corner in steady sliding at this speed, so no derivative"
            )
        columns.append(found.value)
    return np.column_stack(columns) / sizes, bool((np.abs(here) <= _STEADY * terms)[:-1].all())
