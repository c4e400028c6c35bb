"""Results of a prescribed slip: its mean friction, and one period of a closed deflection on panels."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from frictionlab.laws.memory import BristleLaw
from frictionlab.values.quantities import Floats

Vectors = NDArray[np.complex128]

NOTHING_MOVES = "no slip: friction is that of the initial deflection, any value up to the limit"
ELASTIC = (
    "the belt is at rest and the slip stays within the elastic range of the contact: the mean deflection is that of "
    "the start"
)


@dataclass(frozen=True)
class PrescribedMean:
    """Result of a law under a prescribed slip: mean friction (x1 + i x2), and the error of its x1.

    low, high: of a slip that leaves the mean open between two numbers. Whatever is not known is NaN.
    """

    mean: complex = complex(math.nan, math.nan)
    error: float = math.nan
    low: float = math.nan
    high: float = math.nan


class Loop(NamedTuple):
    """Panels of a period in order of angle: start, width [n]; slip, deflection, friction [n, k], x1 + i x2.

    points, shares [k]: places in a panel of width one, and the weights of its quadrature. The deflection is the law's
    own number along one direction, or a vector; frictions and slips are vectors.
    """

    start: Floats
    width: Floats
    points: Floats
    shares: Floats
    slip: Vectors
    deflection: Any
    friction: Vectors

    def total(self, values: Any) -> complex:
        """Return the integral over the period of the angle."""
        return complex((self.width[:, None] * self.shares * values).sum())

    @property
    def mean(self) -> complex:
        """Return the mean coefficient along x1 (+ i x2), positive where the belt drags towards it."""
        return -self.total(self.friction) / (2.0 * math.pi)

    @property
    def largest(self) -> float:
        """Return the largest coefficient met."""
        return float(np.abs(self.friction).max())

    def at(self, angle: Floats, values: Any) -> Any:
        """Interpolate values at the points of panels to angles of the period, by each panel's polynomial."""
        begin = self.start[0]
        turned = begin + np.mod(angle - begin, 2.0 * math.pi)
        panel = np.clip(np.searchsorted(self.start, turned, side="right") - 1, 0, len(self.start) - 1)
        at = np.clip((turned - self.start[panel]) / self.width[panel], 0.0, 1.0)
        value: Any = 0.0
        for k, point in enumerate(self.points):
            others = np.delete(self.points, k)
            basis = np.prod((at[..., None] - others) / (point - others), axis=-1)
            value = value + basis * values[panel, k]
        return value


class Closed(NamedTuple):
    """A closed loop, the error of its mean, how it was found, and the kernel's seconds."""

    loop: Loop
    error: float
    model: str
    seconds: float


class Open(NamedTuple):
    """Range of means where no single loop exists, and why."""

    low: float
    high: float
    reason: str
    seconds: float = 0.0

    @classmethod
    def up_to(cls, law: BristleLaw, deflection: float, reason: str) -> Open:
        """Return the mean is the friction of a constant deflection, any up to this one."""
        most = abs(law.friction(0.0, deflection, 0.0))
        return cls(-most, most, reason)
