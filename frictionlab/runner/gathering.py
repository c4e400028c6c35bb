"""Table of a run, gathered from the answers to its pieces, block by block.

A long table for people: of its curves so many, of each so many points, and some of the points that are not ok.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Collection, Iterable, Sequence
from itertools import accumulate

import numpy as np
import pandas as pd

from frictionlab.runner.curve_table import curve_table
from frictionlab.runner.more_tables import harmonic_table, states_table
from frictionlab.runner.pieces import Places
from frictionlab.runner.progress import Progress, silent
from frictionlab.runner.solving import Solving
from frictionlab.runner.table import InputColumns, kept_rows, result_frame, status_counts
from frictionlab.runner.table_files import TableFiles
from frictionlab.study import registry
from frictionlab.study.grid import StudyGrid
from frictionlab.values.columns import ALWAYS, OF_SHAPE, SHOWN_IN_PART

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
    """Places of curves, of all laws at the same values: ``MOST_CURVES`` at most, as many along each axis."""
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
    """Return this many places at most of so many, the first and the last among them."""
    return np.unique(np.linspace(0, count - 1, min(count, most)).round().astype(np.int64))


class Thinned:
    """Shown rows of a table that comes piece by piece."""

    def __init__(self, rows: Places) -> None:
        self._rows, self._first, self._odd = rows, 0, 0
        self._pieces: list[pd.DataFrame] = []

    def add(self, piece: pd.DataFrame) -> None:
        """Append the next rows of the table."""
        start, stop = np.searchsorted(self._rows, [self._first, self._first + len(piece)])
        odd = np.flatnonzero((piece["status"] != "ok").to_numpy())[: MOST_ODD - self._odd]
        places = np.union1d(self._rows[start:stop] - self._first, odd)
        self._pieces.append(piece.iloc[places])
        self._first += len(piece)
        self._odd += len(odd)

    @property
    def table(self) -> pd.DataFrame:
        """Return the rows so far, numbered anew."""
        table = pd.concat(self._pieces, ignore_index=True)
        table.attrs = {**table.attrs, SHOWN_IN_PART: True}
        return table


def thinned(pieces: Iterable[pd.DataFrame], rows: Places) -> pd.DataFrame:
    """Return the shown rows of a table, piece by piece."""
    found = Thinned(rows)
    for piece in pieces:
        found.add(piece)
    return found.table


class GatheredTable:
    """A table on its way to its files, block by block, and what is read from it meanwhile.

    shown: the rows of a long one that are held; None for all rows.
    """

    def __init__(self, shown: Places | None = None) -> None:
        self._thinned = None if shown is None else Thinned(shown)
        self._held = list[pd.DataFrame]()
        self._orbits, self._harmonics = list[pd.DataFrame](), list[pd.DataFrame]()
        self._states, self._curves = list[pd.DataFrame](), list[pd.DataFrame]()
        self._counts = Counter[str]()

    def gather(
        self,
        solving: Solving,
        files: TableFiles,
        laws: registry.Laws,
        names: Collection[str],
        stopped: bool = False,
        tell: Progress = silent,
    ) -> None:
        """Write the table with these results, held in whole or in part. stopped: curves are not read then."""
        curves, inputs = solving.curves, InputColumns(solving.curves)
        reduced = {each.method.label for each in curves if each.method.is_reduced}
        orbit_names = ["row", *(solving.columns_of("orbits") if solving.task.samples else ())]
        of_curves = {*OF_SHAPE, *ALWAYS} & solving.task.columns
        for block in solving.blocks:
            first = min(curves[place].rows.start for place in block.curves)
            tell(first, solving.points, math.nan, "")
            given, answers = inputs.of(block.curves), solving.answers(block)
            table = result_frame(answers, given, names)
            files.add_rows(table)
            self._counts.update(status_counts(table))
            if self._thinned is None:
                self._held.append(table)
            else:
                self._thinned.add(table)
            if solving.task.samples:
                orbits = kept_rows(answers, "orbits", given, first)
                in_order = [*orbit_names, *(name for name in orbits if name not in orbit_names)]
                self._keep(self._orbits, files.add_orbits, orbits.reindex(columns=in_order))
            if solving.task.harmonics:
                harmonics = harmonic_table(given, answers)
                self._keep(self._harmonics, files.add_harmonics, harmonics)
            self._states.append(states_table(given, answers))
            read = table if stopped or of_curves <= {*names} else result_frame(answers, given, of_curves)
            self._curves.append(curve_table(read.iloc[:0] if stopped else read, laws, reduced))
        if solving.task.harmonics and not files.has_harmonics:
            files.add_harmonics(harmonics)  # the names of its columns

    def _keep(
        self, held: list[pd.DataFrame], write: Callable[[pd.DataFrame], None], rows: pd.DataFrame
    ) -> None:
        """Write rows that are kept beside the table, and hold them where all of it is held."""
        if len(rows):
            write(rows)
        if self._thinned is None:
            held.append(rows)

    @property
    def table(self) -> pd.DataFrame:
        """Rows that are held."""
        return _joined(self._held) if self._thinned is None else self._thinned.table

    @property
    def orbits(self) -> pd.DataFrame | None:
        """Orbits of the rows that are held; None without any."""
        found = _joined(self._orbits)
        return found if len(found) else None

    @property
    def harmonics(self) -> pd.DataFrame | None:
        """Harmonics of the rows that are held; None where none are kept."""
        return _joined(self._harmonics) if self._harmonics else None

    @property
    def states(self) -> pd.DataFrame | None:
        """States of points that have several; None where there is no such point."""
        found = _joined(self._states)
        return found if len(found) else None

    @property
    def counts(self) -> dict[str, int]:
        """Count of rows of each status, the commonest first."""
        return dict(self._counts.most_common())

    @property
    def curves(self) -> pd.DataFrame:
        """Table of curves."""
        return _joined(self._curves)


def _joined(tables: Sequence[pd.DataFrame]) -> pd.DataFrame:
    """Return the rows of tables one after another; a table without a row says nothing about types."""
    filled = [table for table in tables if len(table)] or [*tables[:1], pd.DataFrame()][:1]
    return filled[0] if len(filled) == 1 else pd.concat(filled, ignore_index=True)


def whole_table(solving: Solving, usual: bool) -> pd.DataFrame:
    """Return the table with every result that was asked for. usual: those alone that some row has."""
    given = InputColumns(solving.curves).of(range(len(solving.curves)))
    return result_frame(solving.answers(), given, solving.columns() if usual else solving.task.columns)
