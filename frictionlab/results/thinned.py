"""A long table for people: of its curves so many, of each so many points, and some of the points that are not ok."""

from __future__ import annotations

import math
from collections.abc import Iterable
from itertools import accumulate

import numpy as np
import pandas as pd

from frictionlab.columns import SHOWN_IN_PART
from frictionlab.results.part import Places
from frictionlab.study.grid import StudyGrid

LONG_TABLE = 100_000
"""Rows above which a table is written piece by piece, and shown thinned."""
MOST_CURVES, MOST_POINTS = 100, 200
MOST_ODD = 1000


def shown_rows(grid: StudyGrid) -> Places:
    """Rows of some curves of a grid, of each the ends and points spread between them.

    The curves make a grid of their own: of every axis, method and law the first, the last and some spread between.
    """
    curves = list(grid.curves())
    rows = [
        np.asarray(curves[place].rows)[_spread_over(len(curves[place].rows), MOST_POINTS)]
        for place in _shown_curves(grid)
    ]
    return np.sort(np.concatenate(rows))


def _shown_curves(grid: StudyGrid) -> list[int]:
    """The places of curves, of all laws at the same values: ``MOST_CURVES`` at most, as many along each axis."""
    along = [len(axis) for axis in grid.scene_axes if axis is not grid.speed_axis]
    shapes = [(*map(len, grid.own_axes(law)), len(grid.methods), *along) for law in grid.laws]
    firsts = [0, *accumulate(map(math.prod, shapes))]
    laws, many = _spread_over(len(shapes), MOST_CURVES).tolist(), 1
    while (
        many < max(map(max, shapes))
        and sum(math.prod(min(size, many + 1) for size in shapes[law]) for law in laws) <= MOST_CURVES
    ):
        many += 1
    found = list[int]()
    for law in laws:
        places = np.meshgrid(*(_spread_over(size, many) for size in shapes[law]), indexing="ij")
        found += (firsts[law] + np.ravel_multi_index([each.ravel() for each in places], shapes[law])).tolist()
    return found


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
