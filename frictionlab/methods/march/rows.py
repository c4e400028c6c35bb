"""What is found of one marched point, and of many the answers."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from frictionlab.methods.base import Answers, Status
from frictionlab.orbit.record import Orbit


@dataclass(frozen=True)
class Row:
    """Mean friction (x1 + i x2), the error of its x1 and the period; the range of a mean that depends on the start.

    Whatever is not known is NaN.
    """

    mean: complex = complex(math.nan, math.nan)
    error: float = math.nan
    period: float = math.nan
    low: float = math.nan
    high: float = math.nan


class Point(Protocol):
    """A point once it is marched."""

    status: Status
    reason: str
    model: str
    found: Row
    seconds: float

    @property
    def orbit(self) -> Callable[[], Orbit | None]:
        """Makes the orbit; None without one."""


def answers_of(points: Sequence[Point]) -> Answers:
    """The answers of points, none of which hangs on another."""
    low = np.array([point.found.low for point in points])
    return Answers(
        status=[point.status for point in points],
        reason=[point.reason for point in points],
        model=[point.model for point in points],
        error_kind=["estimated" if point.status == "ok" else "" for point in points],
        mean=np.array([point.found.mean for point in points]),
        error=np.array([point.found.error for point in points]),
        period=np.array([point.found.period for point in points]),
        mean_low=low,
        mean_high=np.array([point.found.high for point in points]),
        window=np.where(np.isnan(low), np.nan, 1.0),
        seconds=np.array([point.seconds for point in points]),
        orbit=lambda i: points[i].orbit(),
    )
