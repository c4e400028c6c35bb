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

DECAY = 2.0
"""Largest step times frequency, or rate of decay, of a mass held by its springs and bristles."""


class Taken(NamedTuple):
    """The state after a step, and the integral of the friction coefficient over it."""

    x: Any
    v: Any
    z: Any
    rubbed: Any


def stepper(restoring_force: Any, resistance: Any, carried: Any) -> Any:
    """``step(problem, k, x, v, z, h)``: from the kth step's start over h.

    The problem has ``law``, ``body``, ``belt_speed`` and ``loads``, the load at every half step;
    resistance(law, w, z) = (z', friction); carried(law, h, w, z) is the deflection after slip w that lasts h.
    """

    @inner
    def step(problem: Any, k: int, x: Any, v: Any, z: Any, h: float) -> Taken:
        law, body, half = problem.law, problem.body, 0.5 * h
        middle = x + half * v
        bent = carried(law, half, v - problem.belt_speed, z)
        push = problem.loads[2 * k + 1]
        rub = resistance(law, v - problem.belt_speed, bent)[1]
        early = v + half * (push - restoring_force(body, middle, v) - body.normal_load * rub)
        rub = resistance(law, early - problem.belt_speed, bent)[1]
        after = v + h * (push - restoring_force(body, middle, early) - body.normal_load * rub)
        return Taken(
            middle + half * after, after, carried(law, half, after - problem.belt_speed, bent), h * rub
        )

    return step
