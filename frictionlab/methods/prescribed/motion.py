"""A prescribed slip whatever the law: where it is slow, and what is found of it."""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass


@dataclass(frozen=True)
class PrescribedMean:
    """What a law makes of a prescribed slip: mean friction (x1 + i x2), and the error of its x1.

    low, high: of a slip that leaves the mean open between two numbers. Whatever is not known is NaN.
    """

    mean: complex = complex(math.nan, math.nan)
    error: float = math.nan
    low: float = math.nan
    high: float = math.nan


def slow_passages(along: complex, across: complex, belt_speed: float) -> list[tuple[float, float]]:
    """Where in the complex plane of the angle the slip speed vanishes: (angle, distance from the real axis).

    |slip|^2 is the product of slip_1 + i slip_2 and slip_1 - i slip_2; each is p z - belt_speed + q/z in
    z = exp(i angle), and their zeros mirror each other in the real axis.
    """
    p, q = -0.5j * along + 0.5 * across, 0.5j * along.conjugate() - 0.5 * across.conjugate()
    root = cmath.sqrt(belt_speed * belt_speed - 4.0 * p * q)
    larger = max(belt_speed + root, belt_speed - root, key=abs)
    zeros = [
        top / bottom for top, bottom in ((larger, 2.0 * p), (2.0 * q, larger)) if top != 0 and bottom != 0
    ]
    return [(cmath.phase(z), abs(math.log(abs(z)))) for z in zeros]
