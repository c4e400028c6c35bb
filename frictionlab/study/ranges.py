"""A range of a sweep: its ends, how many values and how they are spaced; the values are built on demand."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import Annotated, Any, Literal, Self

from pydantic import Field, model_validator

from frictionlab.laws.base import Finite, Positive, Record
from frictionlab.mistakes.notes import number_text

LARGEST_RANGE = 1_000_000


class _Ends(Record):
    """A range.

    start: first value
    stop: last value
    """

    start: Finite
    stop: Finite

    @property
    def ends(self) -> tuple[float, float]:
        """Both."""
        return self.start, self.stop

    @model_validator(mode="after")
    def _check_ends(self) -> Self:
        start, stop = map(number_text, (self.start, self.stop))
        if self.stop <= self.start:
            raise ValueError(f"stop: must be > start = {start}, got {stop}")
        if self.start <= 0.0 and getattr(self, "spacing", "") == "log":
            raise ValueError(f"start: must be > 0 for log spacing, got {start}")
        return self


class SweepRange(_Ends):
    """Values from start to stop (> start), evenly spaced or evenly in the logarithm.

    num: number of values, both ends included
    spacing: equal differences (linear) or equal ratios (log)
    """

    num: Annotated[int, Field(strict=True, ge=2, le=LARGEST_RANGE)]
    spacing: Literal["linear", "log"] = "linear"

    def values(self) -> tuple[float, ...]:
        """Every value, in rising order."""
        return self._logarithmic() if self.spacing == "log" else self._linear()

    def resolved(self) -> dict[str, Any]:
        """The entry of a study file; linear spacing is left out."""
        return self.model_dump(exclude_defaults=True)

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


ENDS = "start", "stop"
"""The keys of its ends."""
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


class SpeedRange(_Ends):
    """Belt speeds from start to stop (> start), to be chosen as a run goes.

    within: belt speeds are chosen until straight lines between points are within this of mean_friction
    """

    within: Positive

    def _even(self, num: int) -> tuple[float, ...]:
        return SweepRange.model_construct(start=self.start, stop=self.stop, num=num).values()

    def first(self) -> tuple[float, ...]:
        """Those to begin with."""
        return self._even(FIRST_SPEEDS)

    def about(self) -> tuple[float, ...]:
        """About as many as will be chosen, evenly spaced: mostly where the curve bends at V_lin."""
        return self._even(FIRST_SPEEDS + math.ceil(0.6 / math.sqrt(self.within)))

    def resolved(self) -> dict[str, Any]:
        """The entry of a study file."""
        return self.model_dump()
