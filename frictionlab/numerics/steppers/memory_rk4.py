"""The classical Runge-Kutta method of order 4 (W. Kutta, 1901) for a mass and a memory of several numbers.

x'' = a(tau, x, x', z), z' = r(x', z) with z an array. Where a rate jumps, as of a spring that yields or is let go,
the order falls to two.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from frictionlab.compile.decorators import inner


class Taken(NamedTuple):
    """The state after a step, and the integral of the friction coefficient over it; the memory is a new array."""

    x: Any
    v: Any
    z: Any
    rubbed: Any


@inner
def _ahead(z: Any, h: float, rate: Any, out: Any) -> None:
    for k in range(z.size):
        out[k] = z[k] + h * rate[k]


def stepper(rates: Any) -> Any:
    """``step(problem, j, x, v, z, h)`` for a kernel function ``rates(problem, j, x, v, z, out)`` = (x'', friction).

    It writes z' into ``out``. j counts half steps; the kth step begins at j = 2 k.
    """

    @inner
    def step(problem: Any, k: int, x: Any, v: Any, z: Any, h: float) -> Taken:
        half, sixth = 0.5 * h, h / 6.0
        room = np.empty((5, z.size), z.dtype)
        r1, r2, r3, r4, at = room[0], room[1], room[2], room[3], room[4]
        a1, f1 = rates(problem, 2 * k, x, v, z, r1)
        v2 = v + half * a1
        _ahead(z, half, r1, at)
        a2, f2 = rates(problem, 2 * k + 1, x + half * v, v2, at, r2)
        v3 = v + half * a2
        _ahead(z, half, r2, at)
        a3, f3 = rates(problem, 2 * k + 1, x + half * v2, v3, at, r3)
        v4 = v + h * a3
        _ahead(z, h, r3, at)
        a4, f4 = rates(problem, 2 * k + 2, x + h * v3, v4, at, r4)
        for i in range(z.size):
            at[i] = z[i] + sixth * (r1[i] + 2.0 * r2[i] + 2.0 * r3[i] + r4[i])
        return Taken(
            x + sixth * (v + 2.0 * v2 + 2.0 * v3 + v4),
            v + sixth * (a1 + 2.0 * a2 + 2.0 * a3 + a4),
            at,
            sixth * (f1 + 2.0 * f2 + 2.0 * f3 + f4),
        )

    return step
