"""The answer of one marched point, and the answers of many."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from frictionlab.methods.base import Answers, Status
from frictionlab.orbit.record import Orbit


@dataclass(frozen=True)
class PointAnswer:
    """Mean friction (x1 + i x2), the error of its x1 and the period; the range of a mean that depends on the start.

    Whatever is not known is NaN.
    """

    mean: complex = complex(math.nan, math.nan)
    error: float = math.nan
    period: float = math.nan
    low: float = math.nan
    high: float = math.nan


class AnsweredPoint(Protocol):
    """A point once it is marched."""

    status: Status
    reason: str
    model: str
    answer: PointAnswer
    seconds: float

    @property
    def orbit(self) -> Callable[[], Orbit | None]:
        """Makes the orbit; None without one."""


def answers_of(points: Sequence[AnsweredPoint]) -> Answers:
    """The answers of points, none of which hangs on another."""
    low = np.array([point.answer.low for point in points])
    return Answers(
        status=[point.status for point in points],
        reason=[point.reason for point in points],
        model=[point.model for point in points],
        error_kind=["estimated" if point.status == "ok" else "" for point in points],
        mean=np.array([point.answer.mean for point in points]),
        error=np.array([point.answer.error for point in points]),
        period=np.array([point.answer.period for point in points]),
        mean_low=low,
        mean_high=np.array([point.answer.high for point in points]),
        window=np.where(np.isnan(low), np.nan, 1.0),
        seconds=np.array([point.seconds for point in points]),
        orbit=lambda i: points[i].orbit(),
    )
