"""Profiles: each number held, the others fitted anew, how much worse the fit gets, where that is little.

How well a law foretells what it was not fitted to: blocks left out in turn, the law fitted to the rest.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from frictionlab.analysis.fit.residuals import Optimum, Residuals, descend
from frictionlab.values.quantities import Floats

ProfileForm = Literal["bounded", "one-sided", "flat", "multimodal"]
PLACES = 11
"""Values at which a number is held, over its range."""
TRIES_OF_AN_END = 5
"""Most tries of an end of an interval between two places: the root of the rise is nearly straight there."""
ROUGH = 1e-5
"""Relative closeness of a profile's minima."""
NEAR_ENOUGH = 0.02
"""Difference of the rise at an end from its threshold that is near enough."""


@dataclass(frozen=True, eq=False)
class Profile:
    """Profile of one number: the ends of its interval, in shares of its range; form: its shape in a word."""

    low: float
    high: float
    form: ProfileForm


def profile(
    residuals: Residuals, best: Optimum, number: int, threshold: float, others: list[Optimum]
) -> Profile:
    """Return the profile of the number at a place. threshold: rise of twice the cost at its ends; others: minima."""
    moves = np.arange(len(best.shares)) != number
    held = float(best.shares[number])

    def beside(share: float, near: Optimum) -> Optimum:
        start = np.array(near.shares)
        start[number] = share
        return descend(residuals, start, moves, ROUGH)

    def rise(found: Optimum) -> float:
        return 2.0 * (found.cost - best.cost) / threshold

    grid = np.unique(np.append(np.linspace(0.0, 1.0, PLACES), held))
    at = int(np.searchsorted(grid, held))
    found: dict[int, Optimum] = {at: best}
    for step, end in ((1, len(grid)), (-1, -1)):
        for place in range(at + step, end, step):
            found[place] = beside(float(grid[place]), found[place - step])
    ordered = [found[place] for place in range(len(grid))]
    rises = np.array([rise(each) for each in ordered])
    low = _end(grid, rises, ordered, at, -1, beside, rise)
    high = _end(grid, rises, ordered, at, 1, beside, rise)
    inside = rises <= 1.0
    stretches = int(inside[0]) + int((inside[1:] & ~inside[:-1]).sum())
    as_good = [other.shares[number] for other in others if rise(other) <= 1.0]
    form: ProfileForm = "bounded"
    if stretches > 1 or any(not low <= share <= high for share in as_good):
        form = "multimodal"  # the interval holds all that fits as well
        low, high = (end([own, *grid[inside], *as_good]) for end, own in ((min, low), (max, high)))
    elif inside.all():
        form = "flat"
    elif inside[0] or inside[-1]:
        form = "one-sided"
    return Profile(low, high, form)


def _end(
    grid: Floats,
    rises: Floats,
    found: list[Optimum],
    at: int,
    step: int,
    beside: Callable[[float, Optimum], Optimum],
    rise: Callable[[Optimum], float],
) -> float:
    """Return where the rise first reaches its threshold on one side; the end of the range where it does not."""
    place = at
    while 0 <= place + step < len(grid) and rises[place + step] <= 1.0:
        place += step
    if not 0 <= place + step < len(grid):
        return float(grid[place])
    ends = [
        (float(grid[place]), float(rises[place])),
        (float(grid[place + step]), float(rises[place + step])),
    ]
    near, middle = found[place], 0.0
    for _ in range(TRIES_OF_AN_END):
        (within, low), (beyond, high) = ends
        roots = math.sqrt(max(low, 0.0)), math.sqrt(high)
        share = min(max((1.0 - roots[0]) / (roots[1] - roots[0]), 0.02), 0.98)
        middle = within + share * (beyond - within)
        there = beside(middle, near)
        height = rise(there)
        if height <= 1.0:
            ends[0], near = (middle, height), there
        else:
            ends[1] = middle, height
        if abs(height - 1.0) < NEAR_ENOUGH:
            break
    return middle


FOLDS = 6
"""Parts that are left out in turn: whole blocks, neighbours together."""


@dataclass(frozen=True, eq=False)
class LeftOut:
    """Root mean square of what is foretold less measured, part by part: in that of the measured value."""

    squares: Floats

    @property
    def rms(self) -> float:
        """Over all parts."""
        return float(np.sqrt(self.squares.mean()))

    @property
    def error(self) -> float:
        """Its standard error, by the scatter between parts."""
        return float(self.squares.std(ddof=1) / np.sqrt(len(self.squares)) / (2.0 * self.rms or 1.0))

    def apart(self, other: LeftOut) -> tuple[float, float]:
        """Return how much larger the mean square is than another's, part by part, and the standard error of that."""
        more = self.squares - other.squares
        return float(more.mean()), float(more.std(ddof=1) / np.sqrt(len(more)))


def without_blocks(residuals: Residuals, best: Optimum, blocks: NDArray[np.int64]) -> LeftOut:
    """Return the profiles of a model at its optimum."""
    count = int(blocks.max()) + 1
    parts = blocks * min(FOLDS, count) // count
    weights, squares = residuals.weights, []
    try:
        for part in np.unique(parts):
            own = parts == part
            residuals.weights = np.where(own, 0.0, weights)
            found = descend(residuals, best.shares)
            squares.append(float(np.mean(residuals.raw(found.shares)[own] ** 2)))
    finally:
        residuals.weights = weights
    return LeftOut(np.array(squares))
