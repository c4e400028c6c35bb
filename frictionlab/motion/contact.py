"""Friction of a contact: its rates, advance of a bristle, changing load, smoothed friction.

First come rate and friction of a law with memory, then the advance of one bristle over a time and its
projection onto the yield surface, then a contact of constant stiffness under a changing normal load.

Last comes smoothed dry friction, in which a steep slope replaces the jump at rest, for steppers that need
smooth rates: friction = phi(|v|/width) * sliding_vector(v), with phi(u) = tanh u or (2/pi) arctan u. The
mass then creeps where it should stick, which biases the mean. The bias falls in proportion to the width, or to
its square root where slip nearly vanishes without reversing. With arctan, which has a long
tail, the mean is biased even where slip never comes near to rest. The width belongs to the method: no law has
one.
"""

from __future__ import annotations

import math
from typing import Any

from frictionlab.compile.decorators import inner
from frictionlab.compile.dispatch import by_dimension, by_law, length
from frictionlab.laws.memory import PER_AXIS, VECTORIAL, bristle_in_the_plane, bristle_on_the_line

resistance = by_dimension(bristle_on_the_line, bristle_in_the_plane)
"""resistance(law, w, z): rate of deflection and friction coefficient at slip velocity w; interpreted and
compiled."""


def _rate_of_a_bristle_in_the_plane(law: Any, memory: Any, k: int, w: complex) -> complex:
    z = memory[0]
    if law.form == VECTORIAL:
        return law.rate(w, z)
    return complex(law.rate(w.real, z.real), law.rate(w.imag, z.imag))


_rate_of_a_bristle = by_dimension(
    lambda law, memory, k, w: law.rate(w, memory[0]), _rate_of_a_bristle_in_the_plane
)


def _bristle_rate(law: Any, memory: Any, k: int, w: Any) -> Any:
    return _rate_of_a_bristle(law, memory, k, w)


rate_of = by_law(_bristle_rate, _bristle_rate, lambda law, memory, k, w: law.rate(w, memory, k))
"""rate_of(law, memory, k, w): rate of the k-th memory at slip velocity w; a bristle law has one memory."""


def _friction_of_a_bristle_in_the_plane(law: Any, memory: Any, moving: Any, w: complex) -> complex:
    z, dz = memory[0], moving[0]
    if law.form == VECTORIAL:
        return law.friction(w, z, dz)
    return complex(law.friction(w.real, z.real, dz.real), law.friction(w.imag, z.imag, dz.imag))


_friction_of_a_bristle = by_dimension(
    lambda law, memory, moving, w: law.friction(w, memory[0], moving[0]), _friction_of_a_bristle_in_the_plane
)


def _bristle_friction(law: Any, memory: Any, moving: Any, w: Any) -> Any:
    return _friction_of_a_bristle(law, memory, moving, w)


friction_of = by_law(
    _bristle_friction, _bristle_friction, lambda law, memory, moving, w: law.friction(w, memory, moving)
)
"""friction_of(law, memory, moving, w): friction coefficient of a memory that changes at the rates
``moving``."""


# --- the advance of one bristle -----------------------------------------------------------------------------------

NEARBY = 1e-6
"""Share of a path or a deflection at which the decay rate of undeflected bristles is evaluated."""


@inner
def _decay(law: Any, v: Any, z: Any) -> float:
    """Return the decay rate a of z' = v - a z, of the deflection z under slip v, from the rate of the law."""
    lost = v - law.rate(v, z)
    return (lost * z.conjugate()).real / (z * z.conjugate()).real


@inner
def _after(law: Any, h: float, v: Any, at: Any, z: Any) -> Any:
    """Return z after the time h with constant a, that of the deflection ``at`` (an exponential step)."""
    # For z = 0 the quotient that defines a is undefined: it is evaluated at a small deflection along the slip.
    if length(at) == 0.0:
        at = (NEARBY * min(h, law.largest_deflection() / length(v))) * v
    gone = h * _decay(law, v, at)
    share = -math.expm1(-gone) / gone if gone != 0.0 else 1.0
    return z * math.exp(-gone) + (h * share) * v


@inner
def _within(radius: float, z: Any) -> Any:
    """Return the deflection, or the nearest one of magnitude ``radius`` where it is larger."""
    size = length(z)
    return (radius / size) * z if size > radius else z


@inner
def _moved(law: Any, h: float, v: Any, z: Any) -> Any:
    """Return the deflection after the time h: exact for laws with an exact path, else of order two in h."""
    if length(v) * h == 0.0:
        return z
    if law.exact_path():
        return law.deflected(z, h * v)
    # Exponential midpoint rule: a half step gives the deflection at which a is evaluated for the whole step. Neither
    # may leave the set of deflections that slip can reach.
    largest = max(law.largest_deflection(), length(z))
    middle = _within(largest, _after(law, 0.5 * h, v, z, z))
    return _within(largest, _after(law, h, v, middle, z))


def _carried_in_the_plane(law: Any, h: float, v: complex, z: complex) -> complex:
    if law.form == VECTORIAL:
        return _moved(law, h, v, z)
    return complex(_moved(law, h, v.real, z.real), _moved(law, h, v.imag, z.imag))


advance_bristle = by_dimension(lambda law, h, v, z: _moved(law, h, v, z), _carried_in_the_plane)
"""advance_bristle(law, h, v, z): deflection after slip velocity v for the time h, in the law's planar
form."""


@inner
def _yielded(law: Any, z: Any) -> Any:
    # 2e-15 outside the yield surface, so that rounding cannot make a yielded deflection elastic.
    return _within((1.0 + 2e-15) * law.yield_deflection(), z)


def _caught_in_the_plane(law: Any, z: complex) -> complex:
    if law.form == PER_AXIS:
        return complex(_yielded(law, z.real), _yielded(law, z.imag))
    return _yielded(law, z)


project_to_yield = by_dimension(lambda law, z: _yielded(law, z), _caught_in_the_plane)
"""project_to_yield(law, z): deflection, projected onto the yield surface if a step has left it outside."""


# --- a contact of constant stiffness under a changing load ---------------------------------------------------------


@inner
def resistance_at_share(law: Any, w: Any, z: Any, n: float) -> Any:
    """Return rate of a bristle and friction at n times the mean normal load, at constant stiffness.

    The contact has the stiffness and damping of the mean load: the law, per unit normal load, sees z/n.
    """
    bent = project_to_yield(law, z / n)
    rate = rate_of(law, (bent,), 0, w)
    return rate, friction_of(law, (bent,), (rate / n,), w)


TANH, ARCTAN = 0.0, 1.0


@inner
def share(shape: float, u: float) -> float:
    """Return phi(u), the share of the sliding friction that acts at a speed of u widths, u >= 0."""
    if shape == TANH:
        return math.tanh(u)
    return 2.0 / math.pi * math.atan(u)


@inner
def friction(problem: Any, w: Any) -> Any:
    """Return the smoothed coefficient, along the slip velocity w.

    The problem has ``law``, ``width`` and ``shape``.
    """
    speed = length(w)
    if speed == 0.0:
        return 0.0 * w
    return share(problem.shape, speed / problem.width) * problem.law.sliding_vector(w)
