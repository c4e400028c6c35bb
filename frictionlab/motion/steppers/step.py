"""A time step as every stepper sees it: what acts on the mass at half steps, where a step starts, where it ends.

How much longer the next step of an adaptive method may be.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from frictionlab.compile.decorators import embedded, fast, inner
from frictionlab.compile.dispatch import by_relaxing, by_variation
from frictionlab.compile.lane_arrays import select
from frictionlab.motion.equation import quickest_of
from frictionlab.motion.relaxing import hardest
from frictionlab.scene.body import BodyNumbers

LOAD, NORMAL_LOAD, BELT, COLUMNS = 0, 1, 2, 3
"""Places in ``problem.grid``, which has COLUMNS numbers for every node of a lap of steps.

Complex in the plane. A bare pointer: kernels count the references to every array they hand on.
"""
FIRST, MIDDLE, LAST = 0, 1, 2
"""The nodes of a step, half a step apart."""

node = by_variation(lambda body, k, part: 2 * k + part, lambda body, k, part: 3 * k + part)
"""node(body, k, part): which node of the lap is that of the k-th step. Where something may jump at a corner, a step
that ends there and the one that begins there have a node each."""

_belt = by_variation(lambda body, velocity: velocity.real, lambda body, velocity: velocity)


@embedded
def _driven_by(problem: Any, k: int, part: int) -> Any:
    return problem.grid[COLUMNS * node(problem.body, k, part) + LOAD]


load_at = by_relaxing(
    lambda problem, k, part: _driven_by(problem, k, part),
    lambda problem, k, part: _driven_by(problem, k, part) - problem.body.relaxing.force,
)
"""load_at(problem, k, part): what drives the mass, at a node of the k-th step; less the force of what of the body
remembers in the middle of the step."""


@embedded
def normal_load_at(problem: Any, k: int, part: int) -> float:
    """What presses it on the belt."""
    return problem.grid[COLUMNS * node(problem.body, k, part) + NORMAL_LOAD].real


@embedded
def belt_at(problem: Any, k: int, part: int) -> Any:
    """The velocity of the belt; a number on the line where it is steady."""
    return _belt(problem.body, problem.grid[COLUMNS * node(problem.body, k, part) + BELT])


class StepStart(NamedTuple):
    """Where the k-th step starts; what the law remembers there is ``problem.memory``."""

    k: int
    tau: float
    x: Any
    v: Any


class StepEnd(NamedTuple):
    """Where a step ends; what the law remembers there is written into ``problem.ahead``.

    growth: by how much to change the next step; below one where this one is to be repeated, shorter.
    """

    x: Any
    v: Any
    impulse: Any  # integral of friction over the step, in shares of the mean normal load
    stuck: bool  # whether it ended at rest on the belt
    growth: float


@fast
def squared(body: BodyNumbers, x: Any, v: Any) -> float:
    """Twice the energy of a state."""
    elastic = body.stiffness_mean * x + body.stiffness_split * x.conjugate()
    return (elastic * x.conjugate()).real + (v * v.conjugate()).real


@inner
def growth_of(body: BodyNumbers, taken: Any, accuracy: float) -> float:
    """For a step of DOP853, by both of its estimates (Hairer et al., 1993, II.10)."""
    fifth = squared(body, taken.x_error5, taken.v_error5)
    third = squared(body, taken.x_error3, taken.v_error3)
    # Nothing divided by nothing would not be a number.
    error = fifth / math.sqrt(fifth + 0.01 * third + 1e-300) / accuracy
    return _growth_at_order_8(error)


@inner
def wary_growth_of(body: BodyNumbers, taken: Any, accuracy: float) -> float:
    """The same by the fifth-order error alone: the mixture of orders does not see a layer passed in one step."""
    return _growth_at_order_8(math.sqrt(squared(body, taken.x_error5, taken.v_error5)) / accuracy)


@inner
def growth_factor(error: float, order: float) -> float:
    """By how much to change a step whose error, relative to what it may be, falls with this power of its length.

    Below one, the step is to be repeated.
    """
    return _bounded_growth(error, error ** (1.0 / order))


@inner
def _growth_at_order_8(error: Any) -> Any:
    """The same; three square roots take a fifth of the time of a power."""
    return _bounded_growth(error, math.sqrt(math.sqrt(math.sqrt(error))))


@inner
def _bounded_growth(error: Any, root: Any) -> Any:
    """At most sixfold; not shorter without need, and never much shorter but where the error is not a number."""
    least = select(error > 1.0, 0.1, 1.0)
    return select(error < 1e300, min(6.0, max(least, 0.9 / max(root, 0.1))), 0.1)


@inner
def longest_step(body: BodyNumbers, sliding: float, accuracy: float) -> float:
    """The longest step: a radian of the loads or of the body's quickest oscillation, less for finer maps.

    Were it the same for all, two maps could agree because both are limited by it, and neither be accurate.
    """
    stiffest = body.stiffness_mean + abs(body.stiffness_split) + hardest(body)
    radian = min(1.0 / quickest_of(body), 1.0 / math.sqrt(stiffest))
    return radian * min(1.0, 2.4 * (accuracy / (body.normal_load * sliding)) ** 0.125)
