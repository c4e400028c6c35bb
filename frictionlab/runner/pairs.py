"""Curves compared in pairs: where the means of two laws, or of two methods, differ most, and by how much.

Who has the highest mean friction where: laws, or what else is swept, ranked at every point that they share.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations, pairwise
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from frictionlab.runner.table import swept_inputs
from frictionlab.values.columns import given
from frictionlab.values.quantities import Floats

MOST_BY_SETTING = 24
"""Rows up to which pairs are told for each set of swept values; beyond, each pair has one row."""
_FRICTION = "law.mu", "law.mu_kinetic"
"""Coefficients of laws that scale friction of steady sliding."""
ROUNDING_OF_MEANS = 1e-15
OWN_ERROR_OF_MODELS = 1e-8
"""Largest error of the numbers of a reduced model against its own formulas."""
_OTHER = " other"


class Difference(NamedTuple):
    """Two laws or methods where their means differ most: value is that of one less that of the other.

    law: whose curves they are, where methods are compared; '' where laws are. error: of the value, the sum of both.
    where: the inputs that are swept, in the units given. shared: points where both have a number; apart: those of
    them where they differ by more than their errors; most: largest difference that the errors allow anywhere.
    """

    law: str
    one: str
    other: str
    where: Mapping[str, Any]
    value: float
    error: float
    shared: int
    apart: int
    most: float


def best_rows(table: pd.DataFrame) -> pd.DataFrame:
    """Return the rows with a number; of those that differ in their method alone the one with the smallest error."""
    found = table[table["mean_friction"].notna()]
    keys = ["law", *_varied(table)]
    return found.sort_values("error", kind="stable").drop_duplicates(keys).sort_index()


def law_pairs(table: pd.DataFrame) -> list[Difference]:
    """Every two laws at the same points, each by its most exact method."""
    best = best_rows(table)
    on = shared_inputs(best)
    best = with_friction(best)
    laws = [best[best["law"] == law] for law in best["law"].unique()]
    return _told([("", pair, on) for pair in combinations(laws, 2)], "law")


def method_pairs(table: pd.DataFrame, reduced: Collection[str] = ()) -> list[Difference]:
    """Every two methods at the same points of each law.

    reduced: labels of methods that solve a simpler model. They stand first, and are judged by what they are compared
    with: what is known of their distance to the full answers is no error of the difference.
    """
    found = table[table["mean_friction"].notna()]
    own = found["error"].clip(upper=OWN_ERROR_OF_MODELS)
    found = found.assign(error=found["error"].mask(found["method"].isin(reduced), own))
    on = _varied(table)
    pairs = []
    for law, rows in found.groupby("law", sort=False):
        labels = sorted(rows["method"].unique(), key=lambda label: label not in reduced)
        methods = [rows[rows["method"] == label] for label in labels]
        pairs += [(str(law), pair, on) for pair in combinations(methods, 2)]
    return _told(pairs, "method")


def shared_inputs(table: pd.DataFrame) -> list[str]:
    """Inputs that say that two laws are at the same point: the scene, and the laws' parameters swept together.

    Friction coefficients are swept together where each law has several; they are then the column ``law.mu`` of
    `with_friction`.
    """
    swept = [name for name in swept_inputs(table) if name.startswith("law.")] if len(table) else []
    within = with_friction(table).groupby("law")
    together = [name for name in dict.fromkeys(_own_name(name) for name in swept) if _in_all(within, name)]
    return [name for name in _varied(table) if name.startswith("scene.")] + together


def own_parameters(table: pd.DataFrame, on: Sequence[str]) -> list[str]:
    """Return the swept parameters of laws that are not among these inputs, which all laws share."""
    return [name for name in swept_inputs(table) if name.startswith("law.") and _own_name(name) not in on]


def with_friction(table: pd.DataFrame) -> pd.DataFrame:
    """Return the table with the friction coefficient of every law as ``law.mu``."""
    known = [name for name in _FRICTION if name in table]
    return table.assign(**{_FRICTION[0]: table[known].bfill(axis=1).iloc[:, 0]}) if known else table


def _own_name(name: str) -> str:
    return _FRICTION[0] if name in _FRICTION else name


def _in_all(within: Any, name: str) -> bool:
    return bool((within[name].nunique() > 1).all())


def _varied(table: pd.DataFrame) -> list[str]:
    """Return the inputs of more than one value, in the units given."""
    return [name for name in given(table.columns) if table[name].nunique(dropna=False) > 1]


def _told(
    pairs: Sequence[tuple[str, tuple[pd.DataFrame, pd.DataFrame], list[str]]], what: str
) -> list[Difference]:
    """For each set of swept values where these are few, else once."""
    count = sum(
        len(pair[0][_settings(on)].drop_duplicates()) if _settings(on) else 1 for _, pair, on in pairs
    )
    few = count <= MOST_BY_SETTING
    return [
        each
        for law, pair, on in pairs
        for each in _differences(law, pair, on, what, _settings(on) if few else [])
    ]


def _settings(on: Sequence[str]) -> list[str]:
    return [name for name in on if "belt_speed" not in name]


def _differences(
    law: str, pair: tuple[pd.DataFrame, pd.DataFrame], on: list[str], what: str, by: list[str]
) -> Iterator[Difference]:
    one, other = pair
    both = (
        one.merge(other, on=on, suffixes=("", _OTHER))
        if on
        else one.merge(other, "cross", suffixes=("", _OTHER))
    )
    for _, rows in both.groupby(by, sort=False, dropna=False) if by else [((), both)]:
        if len(rows):
            yield _largest_difference(law, rows, on, what)


def _largest_difference(law: str, rows: pd.DataFrame, on: list[str], what: str) -> Difference:
    value = (rows["mean_friction"] - rows[f"mean_friction{_OTHER}"]).to_numpy(dtype=float)
    error = (rows["error"] + rows[f"error{_OTHER}"]).to_numpy(dtype=float)
    size = np.abs(value)
    apart = size > error + ROUNDING_OF_MEANS
    at = int(np.argmax(np.where(apart, size, -1.0) if apart.any() else size))
    row = rows.iloc[at]
    where = {name: row[name] for name in on} | _own(rows, row, on)
    names = str(row[what]), str(row[f"{what}{_OTHER}"])
    counts = len(rows), int(apart.sum())
    return Difference(
        law, *names, where, float(value[at]), float(error[at]), *counts, float((size + error).max())
    )


def _own(rows: pd.DataFrame, row: pd.Series, on: Sequence[str]) -> dict[str, Any]:
    """Return the values that only one of the two sweeps: parameters of its law."""
    names = [name for name in given(rows.columns) if name.startswith("law.") and not name.endswith(_OTHER)]
    return {
        name: row[own]
        for name in names
        if name not in on
        for own in (name, f"{name}{_OTHER}")
        if own in rows and rows[own].nunique() > 1
    }


MOST_RANKED = 12
"""Values of what is swept that are ranked against each other where there is one law."""
NOBODY = -1


@dataclass(frozen=True)
class Ranking:
    """Ranked laws, and the points at which two or more of them have a number, along the axis where there is one.

    ranked: of each, its law and the values that tell it apart. points: the inputs of each point. mean, error: point
    by point for each of them, NaN where it has none. first: the place of the highest, ``NOBODY`` where it is not
    above the second by more than both errors.
    """

    ranked: Sequence[Mapping[str, Any]]
    points: pd.DataFrame
    mean: Floats
    error: Floats
    first: NDArray[np.int64]
    second: NDArray[np.int64]

    @property
    def stretches(self) -> list[tuple[int, int, int]]:
        """Neighbouring points with the same first: who, the first point and the last one."""
        cuts = [0, *(np.flatnonzero(np.diff(self.first)) + 1).tolist(), len(self.first)]
        return [(int(self.first[start]), start, stop - 1) for start, stop in pairwise(cuts)]

    def widest(self, along: str, most: int, against: int | None = None) -> list[tuple[int, int, int]]:
        """Find where the highest is furthest above the lowest, or one furthest from that which all are held against.

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
        """Check whether somebody has no number at some point."""
        return bool(np.isnan(self.mean).any())


def ranking_of(table: pd.DataFrame, along: str) -> Ranking | None:
    """Return the ranking of a table; None where fewer than two are ranked. along: the input of the axis.

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
    excess, slack = mean[rows, first] - mean[rows, second], error[rows, first] + error[rows, second]
    first = np.where(excess > slack + ROUNDING_OF_MEANS, first, NOBODY)
    ranked = best[who].drop_duplicates().to_dict("records")
    return Ranking(ranked, points, mean, error, first, second)
