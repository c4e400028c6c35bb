"""The order of a sequence of errors: the slope of log error over log setting where it no longer changes."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from frictionlab.quantities import Floats

SETTINGS_OF_A_SLOPE = 5
"""Settings that a local slope is fitted to: one pair of neighbours says little where errors are irregular."""
STEADY_SLOPES = 0.12
"""Most that local slopes may differ by where the range is asymptotic."""
FEWEST_SLOPES = 2
"""Local slopes of an asymptotic range; one more where they are those between neighbours."""
MOST_SETTINGS = 7
"""Of a fit: the finest ones."""
FLOOR_OF_ERRORS = 20.0
"""Errors below so many times what the reference is known to are left out."""


class Fit(NamedTuple):
    """An order, how far local slopes are from it at most, and the first and last setting it is fitted to.

    Not asymptotic: the slope through all errors above the floor; NaN, with an empty range, where fewer than two are.
    """

    order: float
    spread: float
    first: int
    last: int
    asymptotic: bool


NO_FIT = Fit(math.nan, math.nan, 0, 0, False)


def fit_order(sizes: Floats, errors: Floats, known: float) -> Fit:
    """The order of errors at sizes that shrink from each to the next; known: error of the reference."""
    first, last = _longest_run(np.isfinite(errors) & (errors > FLOOR_OF_ERRORS * known))
    if last - first < 1:
        return NO_FIT
    x, y = np.log(sizes), np.log(np.where(errors > 0.0, errors, 1.0))
    for points, fewest in ((SETTINGS_OF_A_SLOPE, FEWEST_SLOPES), (2, FEWEST_SLOPES + 1)):
        finest = range(max(first, last - MOST_SETTINGS + 1), last - points + 2)
        steady = _steady_at_the_end([_slope(x, y, at, at + points - 1) for at in finest])
        if len(steady) >= fewest:
            begin = last - points + 2 - len(steady)
            order = _slope(x, y, begin, last)
            return Fit(order, max(abs(slope - order) for slope in steady), begin, last, True)
    order, points = (
        _slope(x, y, first, last),
        SETTINGS_OF_A_SLOPE if last - first > SETTINGS_OF_A_SLOPE else 2,
    )
    slopes = [_slope(x, y, at, at + points - 1) for at in range(first, last - points + 2)]
    return Fit(order, max(abs(slope - order) for slope in slopes), first, last, False)


def _longest_run(good: np.ndarray) -> tuple[int, int]:
    """First and last of the longest stretch of good ones; (0, -1) for none."""
    best, start = (0, -1), 0
    for i, each in enumerate(good):
        start = start if each else i + 1
        best = max(best, (start, i), key=lambda run: run[1] - run[0])
    return best


def _slope(x: Floats, y: Floats, first: int, last: int) -> float:
    """By least squares."""
    return float(np.polyfit(x[first : last + 1], y[first : last + 1], 1)[0])


def _steady_at_the_end(slopes: list[float]) -> list[float]:
    """The last slopes that differ by little enough."""
    kept = list[float]()
    for slope in reversed(slopes):
        if max([*kept, slope]) - min([*kept, slope]) > STEADY_SLOPES:
            break
        kept.append(slope)
    return kept
