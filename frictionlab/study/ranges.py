"""A range of a sweep: its ends, how many values and how they are spaced; the values are built on demand."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass
from fractions import Fraction
from typing import Any

SPACINGS = ("linear", "log")


@dataclass(frozen=True)
class SweepRange:
    """The values from start to stop (> start), num (>= 2) of them, evenly spaced or evenly in the logarithm."""

    start: float
    stop: float
    num: int
    spacing: str = "linear"

    def values(self) -> tuple[float, ...]:
        """Every value, in rising order."""
        return self._logarithmic() if self.spacing == "log" else self._linear()

    def resolved(self) -> dict[str, Any]:
        """The entry of a study file; linear spacing is left out."""
        told = asdict(self)
        return told if self.spacing != "linear" else {key: told[key] for key in ("start", "stop", "num")}

    def _linear(self) -> tuple[float, ...]:
        """Evenly spaced and correctly rounded: {0.1, 1, 10} holds 0.3, not 0.30000000000000004."""
        first, last = Fraction(repr(self.start)), Fraction(repr(self.stop))
        shared = math.lcm(first.denominator, last.denominator)
        low, high = int(first * shared), int(last * shared)
        steps = self.num - 1
        return tuple((low * (steps - k) + high * k) / (shared * steps) for k in range(self.num))

    def _logarithmic(self) -> tuple[float, ...]:
        """Both ends exact."""
        low, high = math.log(self.start), math.log(self.stop)
        inner = (math.exp(low + (high - low) * k / (self.num - 1)) for k in range(1, self.num - 1))
        return (self.start, *inner, self.stop)


WITHIN = "within"
"""The key of a range out of which belt speeds are chosen as a run goes."""
FINEST = 10.0
"""Tolerances within which straight lines may be asked to be: a point's own error is as large as that."""
MOST_CHOSEN = 100_000
"""Points of a table whose belt speeds are chosen as a run goes."""
FIRST_SPEEDS = 17
"""Belt speeds, evenly spaced, from which others are chosen."""
CLOSEST = 2.0**-20
"""Share of a range within which no belt speed is chosen beside another: there a jump of friction is left."""
_KNOWN_SPEEDS = 187
"""Belt speeds by which methods know the curve: as many as of the longest that is solved in one piece."""


@dataclass(frozen=True)
class SpeedRange:
    """Belt speeds from start to stop (> start), to be chosen until straight lines between them are near the curve.

    within: how near [-], absolute in mean friction.
    """

    start: float
    stop: float
    within: float

    def first(self) -> tuple[float, ...]:
        """Those to begin with."""
        return SweepRange(self.start, self.stop, FIRST_SPEEDS).values()

    def known(self) -> tuple[float, ...]:
        """Those by which methods know the curve, whichever are chosen: its model does not change as others come."""
        return SweepRange(self.start, self.stop, _KNOWN_SPEEDS).values()

    def about(self) -> tuple[float, ...]:
        """About as many as will be chosen, evenly spaced: mostly where the curve bends at V_lin."""
        return SweepRange(
            self.start, self.stop, FIRST_SPEEDS + math.ceil(0.6 / math.sqrt(self.within))
        ).values()

    def resolved(self) -> dict[str, Any]:
        """The entry of a study file."""
        return asdict(self)
