"""Who has the highest mean friction where: laws, or what else is swept, ranked at every point that they share."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from frictionlab.quantities import Floats
from frictionlab.results.pairs import (
    ROUNDING_OF_MEANS,
    best_rows,
    own_parameters,
    shared_inputs,
    with_friction,
)

MOST_RANKED = 12
"""Values of what is swept that are ranked against each other where there is one law."""
NOBODY = -1


@dataclass(frozen=True)
class Ranking:
    """Who is ranked, and the points at which two or more of them have a number, along the axis where there is one.

    ranked: of each, its law and the values that tell it apart. points: the inputs of each point. mean, error: point
    by point for each of them, NaN where it has none. first: the place of the highest, ``NOBODY`` where it is not
    above the second by more than both errors; excess, excess_error: of the highest over the second.
    """

    ranked: Sequence[Mapping[str, Any]]
    points: pd.DataFrame
    mean: Floats
    error: Floats
    first: NDArray[np.int64]
    second: NDArray[np.int64]
    excess: Floats
    excess_error: Floats

    @property
    def stretches(self) -> list[tuple[int, int, int]]:
        """Neighbouring points with the same first: who, the first point and the last one."""
        cuts = [0, *(np.flatnonzero(np.diff(self.first)) + 1).tolist(), len(self.first)]
        return [(int(self.first[start]), start, stop - 1) for start, stop in pairwise(cuts)]

    def widest(self, along: str, most: int, against: int | None = None) -> list[tuple[int, int, int]]:
        """Where the highest is furthest above the lowest, or one furthest from the one against which all are held.

        Each with the point, the place of the higher one and that of the lower.

        For each setting of what is not along the axis, where these are so many at most; else once.
        """
        others = [name for name in self.points if name != along]
        groups = self.points.reset_index(drop=True).groupby(others, sort=False).indices if others else {}
        every = [np.arange(len(self.points))]
        told = groups.values() if 0 < len(groups) <= most else every
        return [self._widest(places, against) for places in told]

    def _widest(self, places: NDArray[np.int64], against: int | None) -> tuple[int, int, int]:
        mean = self.mean[places]
        if against is not None:
            apart = np.abs(mean - mean[:, [against]])
            row, who = divmod(int(np.nanargmax(apart)), apart.shape[1])
            low, high = sorted((who, against), key=lambda each: float(mean[row, each]))
            return int(places[row]), high, low
        at = int(np.argmax(np.nanmax(mean, axis=1) - np.nanmin(mean, axis=1)))
        return int(places[at]), int(np.nanargmax(mean[at])), int(np.nanargmin(mean[at]))

    @property
    def has_gaps(self) -> bool:
        """Whether somebody has no number at some point."""
        return bool(np.isnan(self.mean).any())


def ranking_of(table: pd.DataFrame, along: str) -> Ranking | None:
    """That of a table; None where fewer than two are ranked. along: the input of the axis.

    Laws are ranked, with each value of their own parameters. Of one law without any, the curves of each set of swept
    values are, where they are few.
    """
    best = best_rows(table)
    if best.empty:
        return None
    on = shared_inputs(best)
    who = ["law", *own_parameters(best, on)]
    best = with_friction(best)
    if along in who or len(best[who].drop_duplicates()) < 2:
        others = [name for name in dict.fromkeys([*who[1:], *on]) if name != along]
        who, on = ["law", *others], [along] if best[along].nunique() > 1 else []
        if not 2 <= len(best[who].drop_duplicates()) <= MOST_RANKED:
            return None
    return _ranked(best, who, on)


def _ranked(best: pd.DataFrame, who: list[str], on: list[str]) -> Ranking | None:
    column = best.groupby(who, sort=False, dropna=False).ngroup().to_numpy()
    point = best.groupby(on, sort=True, dropna=False).ngroup().to_numpy() if on else np.zeros(len(best), int)
    shape = int(point.max()) + 1, int(column.max()) + 1
    mean, error = np.full(shape, np.nan), np.full(shape, np.nan)
    mean[point, column], error[point, column] = best["mean_friction"], best["error"]
    shared = np.isfinite(mean).sum(axis=1) > 1
    if not shared.any():
        return None
    points = best[on].assign(point=point).drop_duplicates("point").sort_values("point")[on][shared]
    mean, error = mean[shared], error[shared]
    order = np.argsort(np.where(np.isfinite(mean), -mean, np.inf), axis=1, kind="stable")
    rows, first, second = np.arange(len(mean)), order[:, 0], order[:, 1]
    excess = mean[rows, first] - mean[rows, second]
    excess_error = error[rows, first] + error[rows, second]
    first = np.where(excess > excess_error + ROUNDING_OF_MEANS, first, NOBODY)
    ranked = best[who].drop_duplicates().to_dict("records")
    return Ranking(ranked, points, mean, error, first, second, excess, excess_error)
