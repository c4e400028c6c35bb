"""The classical Runge-Kutta method of order 4 (W. Kutta, 1901) for x'' = f(tau, x, x'), without event location.

A step in which the rates jump is of order one, with irregular errors: the weighted mean of four rates does not depend
on the time of the jump.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from frictionlab.compile.decorators import inner


class Taken(NamedTuple):
    """The state after a step, the integral of the friction coefficient over it, and whether it ended at rest."""

    x: Any
    v: Any
    rubbed: Any
    stuck: bool


def stepper(rates: Any) -> Any:
    """``step(problem, k, x, v, h)`` for a kernel function ``rates(problem, j, x, v)`` = (x'', friction).

    j counts half steps; the kth step begins at j = 2 k. It has no stick phases: a step never ends at rest.
    """

    @inner
    def step(problem: Any, k: int, x: Any, v: Any, h: float) -> Taken:
        a1, f1 = rates(problem, 2 * k, x, v)
        v2 = v + 0.5 * h * a1
        a2, f2 = rates(problem, 2 * k + 1, x + 0.5 * h * v, v2)
        v3 = v + 0.5 * h * a2
        a3, f3 = rates(problem, 2 * k + 1, x + 0.5 * h * v2, v3)
        v4 = v + h * a3
        a4, f4 = rates(problem, 2 * k + 2, x + h * v3, v4)
        sixth = h / 6.0
        return Taken(
            x + sixth * (v + 2.0 * v2 + 2.0 * v3 + v4),
            v + sixth * (a1 + 2.0 * a2 + 2.0 * a3 + a4),
            sixth * (f1 + 2.0 * f2 + 2.0 * f3 + f4),
            False,
        )

    return step
