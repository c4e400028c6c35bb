"""A long table for people: of its curves so many, of each so many points, and some of the points that are not ok."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np
import pandas as pd

from frictionlab.columns import SHOWN_IN_PART
from frictionlab.results.part import Places
from frictionlab.study import StudyCurve

LONG_TABLE = 100_000
"""Rows above which a table is written piece by piece, and shown thinned."""
MOST_CURVES, MOST_POINTS = 100, 200
MOST_ODD = 1000


def shown_rows(curves: Sequence[StudyCurve]) -> Places:
    """Rows of curves spread over the study, of each the ends and points spread between them."""
    chosen = [curves[place] for place in _spread_over(len(curves), MOST_CURVES)]
    rows = [np.asarray(each.rows)[_spread_over(len(each.rows), MOST_POINTS)] for each in chosen]
    return np.sort(np.concatenate(rows))


def _spread_over(count: int, most: int) -> Places:
    """Of so many places this many at most, the first and the last among them."""
    return np.unique(np.linspace(0, count - 1, min(count, most)).round().astype(np.int64))


class Thinned:
    """The shown rows of a table that comes piece by piece."""

    def __init__(self, rows: Places) -> None:
        self._rows, self._first, self._odd = rows, 0, 0
        self._pieces: list[pd.DataFrame] = []

    def add(self, piece: pd.DataFrame) -> None:
        """The next rows of the table."""
        start, stop = np.searchsorted(self._rows, [self._first, self._first + len(piece)])
        odd = np.flatnonzero((piece["status"] != "ok").to_numpy())[: MOST_ODD - self._odd]
        places = np.union1d(self._rows[start:stop] - self._first, odd)
        self._pieces.append(piece.iloc[places])
        self._first += len(piece)
        self._odd += len(odd)

    @property
    def table(self) -> pd.DataFrame:
        """The rows so far, numbered anew."""
        table = pd.concat(self._pieces, ignore_index=True)
        table.attrs = {**table.attrs, SHOWN_IN_PART: True}
        return table


def thinned(pieces: Iterable[pd.DataFrame], rows: Places) -> pd.DataFrame:
    """The shown rows of a table, piece by piece."""
    found = Thinned(rows)
    for piece in pieces:
        found.add(piece)
    return found.table
