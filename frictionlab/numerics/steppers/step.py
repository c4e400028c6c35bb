"""A time step as every stepper sees it: what acts on the mass at half steps, where a step starts, where it ends."""

from __future__ import annotations

from typing import Any, NamedTuple

from frictionlab.compile.decorators import embedded

LOAD, NORMAL_LOAD, BELT, COLUMNS = 0, 1, 2, 3
"""Places in ``problem.grid``, which has COLUMNS numbers for every half step of a lap of equal steps.

Complex in the plane. A bare pointer: kernels count the references to every array they hand on.
"""


@embedded
def load_at(problem: Any, j: int) -> Any:
    """What drives the mass, at the j-th half step."""
    return problem.grid[COLUMNS * j + LOAD]


@embedded
def normal_load_at(problem: Any, j: int) -> float:
    """What presses it on the belt."""
    return problem.grid[COLUMNS * j + NORMAL_LOAD].real


@embedded
def belt_at(problem: Any, j: int) -> float:
    """The velocity of the belt."""
    return problem.grid[COLUMNS * j + BELT].real


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
    impulse: Any  # integral of the friction coefficient over the step
    stuck: bool  # whether it ended at rest on the belt
    growth: float
