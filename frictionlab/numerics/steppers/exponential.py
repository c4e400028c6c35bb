"""Exponential splitting: bristles carried along exactly, or nearly so, while the velocity waits; then the reverse.

Half a step of drift (x and z move at constant velocity), a whole step of kick (the velocity changes by the load and
the forces of the middle, by the explicit midpoint rule), half a step of drift: G. Strang, SIAM J. Numer. Anal. 5
(1968); of order two. However long the step, the bristles stay in their invariant set and end where steady slip
brings them. The kick is explicit: springs limit the step to step * frequency <= 2, dashpots to step * rate <= 2, the
springs of the bristles included, however little they matter while the mass slips.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from frictionlab.compile.decorators import inner
from frictionlab.numerics.steppers.grid import BELT, LOAD, NORMAL_LOAD

DECAY = 2.0
"""Largest step times frequency, or rate of decay, of a mass held by its springs and bristles."""


class Taken(NamedTuple):
    """The state after a step, and the integral of the friction coefficient over it."""

    x: Any
    v: Any
    z: Any
    rubbed: Any


def stepper(acceleration_under: Any, resistance: Any, carried: Any) -> Any:
    """``step(problem, k, x, v, z, h)``: from the kth step's start over h.

    The problem has ``law``, ``body`` and ``grid``, what acts at every half step (grid.py);
    acceleration_under(body, load, normal_load, x, v, friction) is the equation of motion,
    resistance(law, w, z) = (z', friction); carried(law, h, w, z) is the deflection after slip w that lasts h.
    """

    @inner
    def step(problem: Any, k: int, x: Any, v: Any, z: Any, h: float) -> Taken:
        law, body, grid, half = problem.law, problem.body, problem.grid, 0.5 * h
        start, middle, end = grid[2 * k, BELT].real, grid[2 * k + 1, BELT].real, grid[2 * k + 2, BELT].real
        push, pressed = grid[2 * k + 1, LOAD], grid[2 * k + 1, NORMAL_LOAD].real
        # Drift: over either half the belt goes at the mean of its velocities at the ends.
        there = x + half * v
        bent = carried(law, half, v - 0.5 * (start + middle), z)
        # Kick, by the explicit midpoint rule.
        rub = resistance(law, v - middle, bent)[1]
        early = v + half * acceleration_under(body, push, pressed, there, v, rub)
        rub = resistance(law, early - middle, bent)[1]
        after = v + h * acceleration_under(body, push, pressed, there, early, rub)
        bent = carried(law, half, after - 0.5 * (middle + end), bent)
        return Taken(there + half * after, after, bent, h * rub)

    return step
