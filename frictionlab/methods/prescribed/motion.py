"""A prescribed slip whatever the law: where it is slow, and what is found of it."""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from frictionlab.quantities import Floats
from frictionlab.scene.body import Motion

SlowPassage = tuple[float, float]
"""Where slip is slow: the angle, and how far from the real axis it vanishes."""


@dataclass(frozen=True)
class PrescribedMean:
    """What a law makes of a prescribed slip: mean friction (x1 + i x2), and the error of its x1.

    low, high: of a slip that leaves the mean open between two numbers. Whatever is not known is NaN.
    """

    mean: complex = complex(math.nan, math.nan)
    error: float = math.nan
    low: float = math.nan
    high: float = math.nan


def slow_passages(along: complex, across: complex, belt_speed: float) -> list[SlowPassage]:
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


def between_passages(passages: list[SlowPassage], none: float) -> Iterator[tuple[SlowPassage, SlowPassage]]:
    """Every passage of a period and the one after it, once around; else one at 0, ``none`` deep."""
    places = sorted((angle % (2.0 * math.pi), depth) for angle, depth in passages) or [(0.0, none)]
    yield from zip(places, [*places[1:], (places[0][0] + 2.0 * math.pi, places[0][1])], strict=True)


def velocity(motion: Motion, angle: Floats) -> NDArray[np.complex128]:
    """x1' + i x2' at these angles of the period."""
    turn = np.exp(1j * angle)
    return (motion.velocity * turn).imag + 1j * (motion.transverse_velocity * turn).imag


def displacement(motion: Motion, angle: Floats) -> NDArray[np.complex128]:
    """x1 + i x2 about its mean."""
    turn = np.exp(1j * angle)
    return -((motion.velocity * turn).real + 1j * (motion.transverse_velocity * turn).real) / motion.frequency
