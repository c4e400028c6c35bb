"""Interface of all steppers: loads at half steps, start and end of a step, growth of the next step."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from frictionlab.compile.decorators import embedded, fast, inner
from frictionlab.compile.lane_arrays import select
from frictionlab.motion.equation import quickest_of
from frictionlab.scene.body import BodyNumbers

LOAD, NORMAL_LOAD, BELT, COLUMNS = 0, 1, 2, 3
"""Places in ``problem.grid``, which has COLUMNS numbers for every node of a lap of steps.

They are complex in the plane. The grid is a bare pointer, since kernels count the references to every array
they hand on."""
FIRST, MIDDLE, LAST = 0, 1, 2
"""Nodes of a step, half a step apart."""

GRID_NODES = 3
"""Count of nodes of a step: where something may jump at a corner, the step that ends there and the one that begins
there have a node each."""


@embedded
def load_at(problem: Any, k: int, part: int) -> Any:
    """Return the load on the mass at a node of the k-th step."""
    return problem.grid[COLUMNS * (GRID_NODES * k + part) + LOAD]


@embedded
def normal_load_at(problem: Any, k: int, part: int) -> float:
    """Return the normal load at a node of the k-th step."""
    return problem.grid[COLUMNS * (GRID_NODES * k + part) + NORMAL_LOAD].real


@embedded
def belt_at(problem: Any, k: int, part: int) -> Any:
    """Return the velocity of the belt at a node of the k-th step."""
    return problem.grid[COLUMNS * (GRID_NODES * k + part) + BELT]


class StepStart(NamedTuple):
    """Start of the k-th step; ``problem.memory`` holds the memory of the law there."""

    k: int
    tau: float
    x: Any
    v: Any


class StepEnd(NamedTuple):
    """End of a step; the memory of the law there is written into ``problem.ahead``.

    growth: factor for the length of the next step; below one, this step must be repeated, shorter.
    """

    x: Any
    v: Any
    impulse: Any  # integral of friction over the step, in shares of the mean normal load
    stuck: bool  # whether it ended at rest on the belt
    growth: float


@fast
def squared(body: BodyNumbers, x: Any, v: Any) -> float:
    """Return twice the energy of a state."""
    elastic = body.stiffness_mean * x + body.stiffness_split * x.conjugate()
    return (elastic * x.conjugate()).real + (v * v.conjugate()).real


@inner
def growth_of(body: BodyNumbers, taken: Any, accuracy: float) -> float:
    """Return the growth after a step of DOP853, by both error estimates (Hairer et al., 1993, II.10)."""
    fifth = squared(body, taken.x_error5, taken.v_error5)
    third = squared(body, taken.x_error3, taken.v_error3)
    # 1e-300 avoids 0/0.
    error = fifth / math.sqrt(fifth + 0.01 * third + 1e-300) / accuracy
    return _growth_at_order_8(error)


@inner
def wary_growth_of(body: BodyNumbers, taken: Any, accuracy: float) -> float:
    """Return the growth after a step of DOP853, by the fifth-order error alone.

    The mixture of orders does not see a layer that is passed in one step.
    """
    return _growth_at_order_8(math.sqrt(squared(body, taken.x_error5, taken.v_error5)) / accuracy)


@inner
def growth_factor(error: float, order: float) -> float:
    """Return the factor for the length of a step, from its error relative to the tolerance.

    order: power of the length with which the error falls. Below one, the step is to be repeated.
    """
    return _bounded_growth(error, error ** (1.0 / order))


@inner
def _growth_at_order_8(error: Any) -> Any:
    """Return the growth for an error of order 8; three square roots take a fifth of the time of a power."""
    return _bounded_growth(error, math.sqrt(math.sqrt(math.sqrt(error))))


@inner
def _bounded_growth(error: Any, root: Any) -> Any:
    """Return the growth from an error and its root of the order of the step.

    It is at most 6, at least 1 for an error of at most 1, at least 0.1 for a larger one and 0.1 where the
    error is not a number.
    """
    least = select(error > 1.0, 0.1, 1.0)
    return select(error < 1e300, min(6.0, max(least, 0.9 / max(root, 0.1))), 0.1)


@inner
def longest_step(body: BodyNumbers, sliding: float, accuracy: float) -> float:
    """Return the longest step: a radian of the quickest load or oscillation, less for finer maps.

    With one longest step for all maps, two maps could agree because both are limited by it, and neither be
    accurate.
    """
    stiffest = body.stiffness_mean + abs(body.stiffness_split)
    radian = min(1.0 / quickest_of(body), 1.0 / math.sqrt(stiffest))
    return radian * min(1.0, 2.4 * (accuracy / (body.normal_load * sliding)) ** 0.125)
