"""The classical Runge-Kutta method of order 4 (W. Kutta, 1901) for a mass and the bristles that rub on it.

x'' = a(tau, x, x', z), z' = r(x', z). Explicit: a step is short enough while step * rate <= 2.785 for every rate at
which something decays, and step * frequency <= 2.828 for every frequency that nothing damps. Where slip reverses
the rate of the bristles has a kink, and the order falls to two.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from frictionlab.compile.decorators import inner

DECAY = 2.785
"""Largest step times rate of decay: where the stability polynomial leaves the unit disk on the real axis."""


class Taken(NamedTuple):
    """The state after a step, and the integral of the friction coefficient over it."""

    x: Any
    v: Any
    z: Any
    rubbed: Any


def stepper(rates: Any) -> Any:
    """``step(problem, k, x, v, z, h)`` for a kernel function ``rates(problem, j, x, v, z)`` = (x'', friction, z').

    j counts half steps; the kth step begins at j = 2 k.
    """

    @inner
    def step(problem: Any, k: int, x: Any, v: Any, z: Any, h: float) -> Taken:
        half, sixth = 0.5 * h, h / 6.0
        a1, f1, r1 = rates(problem, 2 * k, x, v, z)
        v2 = v + half * a1
        a2, f2, r2 = rates(problem, 2 * k + 1, x + half * v, v2, z + half * r1)
        v3 = v + half * a2
        a3, f3, r3 = rates(problem, 2 * k + 1, x + half * v2, v3, z + half * r2)
        v4 = v + h * a3
        a4, f4, r4 = rates(problem, 2 * k + 2, x + h * v3, v4, z + h * r3)
        return Taken(
            x + sixth * (v + 2.0 * v2 + 2.0 * v3 + v4),
            v + sixth * (a1 + 2.0 * a2 + 2.0 * a3 + a4),
            z + sixth * (r1 + 2.0 * r2 + 2.0 * r3 + r4),
            sixth * (f1 + 2.0 * f2 + 2.0 * f3 + f4),
        )

    return step
