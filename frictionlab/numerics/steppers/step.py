"""A time step as every stepper sees it: what acts on the mass at half steps, where a step starts, where it ends."""

from __future__ import annotations

from typing import Any, NamedTuple

from frictionlab.compile.decorators import embedded
from frictionlab.compile.dispatch import by_relaxing, by_variation

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
