"""Exponential splitting of order two: drift at constant velocity, kick of the velocity, drift.

The drift advances the deflection exactly or nearly so.

A step is half a step of drift (x and z move at constant velocity), a whole step of kick (the velocity changes
by the load and the forces of the middle, by the explicit midpoint rule) and half a step of drift: G. Strang,
SIAM J. Numer. Anal. 5 (1968); of order two. However long the step, the deflection stays in its invariant set
and ends where steady slip brings it. The kick is explicit: springs limit the step to step * frequency <= 2,
dashpots to step * rate <= 2. Springs of the bristles count among them, however little they matter while the
mass slips.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from frictionlab.compile.decorators import inner
from frictionlab.motion.steppers.step import (
    FIRST,
    LAST,
    MIDDLE,
    StepEnd,
    StepStart,
    belt_at,
    load_at,
    normal_load_at,
)

DECAY = 2.0
"""Largest step times frequency, or times rate of decay, of a mass held by its springs and bristles."""


class Drift(NamedTuple):
    """Position and deflection after half a step at constant velocity."""

    x: Any
    z: Any


@inner
def kick(
    acceleration_under: Any, resistance: Any, problem: Any, start: StepStart, h: float, at: Drift
) -> Any:
    """Return the velocity after a whole step at this place, and the coefficient of friction over it."""
    body, k = problem.body, start.k
    push, pressed = load_at(problem, k, MIDDLE), normal_load_at(problem, k, MIDDLE)
    belt = belt_at(problem, k, MIDDLE)
    # Explicit midpoint rule: half a step gives the velocity at which friction and dashpots act.
    mu = resistance(problem, k, start.v - belt, at.z)
    middle = start.v + 0.5 * h * acceleration_under(body, push, pressed, at.x, start.v, mu)
    mu = resistance(problem, k, middle - belt, at.z)
    return start.v + h * acceleration_under(body, push, pressed, at.x, middle, mu), mu


@inner
def exponential_step(
    acceleration_under: Any, resistance: Any, advance: Any, problem: Any, start: StepStart, h: float
) -> StepEnd:
    """Take one step over h, for a law of one deflection.

    acceleration_under(body, load, normal_load, x, v, friction) is the equation of motion. resistance(problem,
    k, w, z) is the coefficient in the middle of the k-th step. advance(problem, k, part, h, w, z) is the
    deflection after slip w for half the step, h, from its node ``part`` on. The impulse is that of the
    coefficient.
    """
    k, half = start.k, 0.5 * h
    first, middle = belt_at(problem, k, FIRST), belt_at(problem, k, MIDDLE)
    last = belt_at(problem, k, LAST)
    # Drift: in each half the belt has the mean of its velocities at the ends of that half.
    x = start.x + half * start.v
    z = advance(problem, k, FIRST, half, start.v - 0.5 * (first + middle), problem.memory[0])
    v, mu = kick(acceleration_under, resistance, problem, start, h, Drift(x, z))
    problem.ahead[0] = advance(problem, k, MIDDLE, half, v - 0.5 * (middle + last), z)
    return StepEnd(x + half * v, v, h * mu, False, 1.0)
