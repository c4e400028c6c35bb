"""The table of a run, gathered from the answers to its chunks: in one piece, or piece by piece where it is long.

A long table for people: of its curves so many, of each so many points, and some of the points that are not ok.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import accumulate, chain, islice
from typing import NamedTuple

import numpy as np
import pandas as pd

from frictionlab.runner.curve_table import curve_table
from frictionlab.runner.more_tables import harmonic_table, states_table
from frictionlab.runner.part import KeptRows, Part, Places
from frictionlab.runner.progress import silent
from frictionlab.runner.solving import Solving
from frictionlab.runner.table import InputColumns, Inputs, Results, orbit_rows, status_counts, without_empty
from frictionlab.runner.table_files import TableFiles
from frictionlab.study import registry
from frictionlab.study.grid import StudyCurve, StudyGrid
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


ROWS_TOGETHER = 20_000
"""Rows of a piece of a long table, at least; more where those of a curve are more, or lie farther apart."""
ROWS_AT_ONCE = 10_000
"""Rows of it that are made a table at once."""


class TablePiece(NamedTuple):
    """Rows of the table that make whole curves.

    kept: their orbits, harmonics and states. memories: the columns of all orbits.
    """

    inputs: Inputs
    first: int
    results: Results
    kept: dict[str, KeptRows]
    memories: Sequence[str]

    def harmonics(self) -> pd.DataFrame:
        """The kept harmonics."""
        own = {row - self.first: found for row, found in self.kept.get("harmonics", {}).items()}
        return harmonic_table(self.inputs, own)

    def states(self) -> pd.DataFrame:
        """The states of points that have several."""
        own = {row - self.first: found for row, found in self.kept.get("states", {}).items()}
        return states_table(self.inputs, own)


class GatheredTable:
    """A table on its way to its files.

    shown: the rows of a long one that are held; None for all rows. leave_out_empty: result columns that no row has.
    """

    def __init__(self, shown: Places | None, leave_out_empty: bool = False) -> None:
        self._leave_out_empty = leave_out_empty
        self._shown = None if shown is None else Thinned(shown)
        self._held = pd.DataFrame()
        self._curves: list[pd.DataFrame] = []
        self._counts = Counter[str]()
        self.orbits: pd.DataFrame | None = None
        self.harmonics: pd.DataFrame | None = None
        self._states: list[pd.DataFrame] = []

    def gather(
        self,
        solving: Solving,
        files: TableFiles,
        laws: registry.Laws,
        stopped: bool,
        tell: Callable[[int, int], None] = silent,
    ) -> None:
        """Write the table, held in whole or in part. stopped: curves are not read then. tell: how far it is."""
        none: pd.DataFrame | None = None
        size = sum(len(each.rows) for each in solving.curves)
        for piece in pieces(solving):
            tell(piece.first, size)
            for table in self._tables(piece):
                files.add_rows(table)
                self._counts.update(status_counts(table))
            orbits = orbit_rows(piece.kept.get("orbits", {}), piece.memories, piece.inputs, piece.first)
            harmonics = piece.harmonics() if solving.task.harmonics else None
            files.add_orbits(orbits)
            if harmonics is not None and harmonics.empty:  # columns across the belt are not told of no orbits
                none = harmonics
            else:
                files.add_harmonics(harmonics)
            if piece.kept.get("states"):
                self._states.append(piece.states())
            if self._shown is None:
                self.orbits, self.harmonics = orbits, harmonics
            read = piece.results.frame(piece.inputs, names={*OF_SHAPE, *ALWAYS})
            reduced = {each.method.label for each in solving.curves if each.method.is_reduced}
            self._curves.append(curve_table(read.iloc[:0] if stopped else read, laws, reduced))
        if none is not None and not files.has_harmonics:
            files.add_harmonics(none)

    def _tables(self, piece: TablePiece) -> Iterator[pd.DataFrame]:
        """Its rows, so many at a time where not all are held."""
        if self._shown is None:
            table = piece.results.frame(piece.inputs)
            self._held = without_empty(table) if self._leave_out_empty else table
            yield self._held
            return
        for first in range(0, piece.inputs.size, ROWS_AT_ONCE):
            table = piece.results.frame(piece.inputs, slice(first, first + ROWS_AT_ONCE))
            self._shown.add(table)
            yield table

    @property
    def table(self) -> pd.DataFrame:
        """The rows that are held."""
        return self._held if self._shown is None else self._shown.table

    @property
    def states(self) -> pd.DataFrame | None:
        """Those of points that have several; None where there is no such point."""
        return pd.concat(self._states, ignore_index=True) if self._states else None

    @property
    def counts(self) -> dict[str, int]:
        """How many of all rows have each status, the commonest first."""
        return dict(self._counts.most_common())

    @property
    def curves(self) -> pd.DataFrame:
        """The table of curves; pieces without a row say nothing about types."""
        filled = [table for table in self._curves if len(table)] or self._curves[:1]
        return pd.concat(filled, ignore_index=True)


def pieces(solving: Solving) -> Iterator[TablePiece]:
    """The table: one piece where all answers are held, else one after another."""
    curves, found = solving.curves, solving.answers()
    columns, memories = InputColumns(curves), _memories(solving)
    for block in [range(len(curves))] if solving.in_memory else blocks(curves):
        inputs, first = columns.of(block), min(curves[place].rows.start for place in block)
        results, kept = Results(inputs.size, solving.task.columns, solving.rest), dict[str, KeptRows]()
        parts: Iterator[Part] = chain.from_iterable(islice(found, len(block)))
        for part in chain(solving.known, parts):
            results.put(part, first)
            for name, rows in part.kept.items():
                kept.setdefault(name, {}).update(rows)
        yield TablePiece(inputs, first, results, kept, memories)


def whole_table(solving: Solving) -> pd.DataFrame:
    """The table of answers that are held."""
    (piece,) = pieces(solving)
    return piece.results.frame(piece.inputs)


def _memories(solving: Solving) -> list[str]:
    """The columns of memory of all laws, where orbits are kept: all rows of a file have the same."""
    if not solving.task.samples:
        return []
    from frictionlab.motion.orbit.sample import memory_columns  # imports numba: only where it is needed

    laws = {id(curve.given_law): curve.given_law for curve in solving.curves}.values()
    return list(dict.fromkeys(name for law in laws for name in memory_columns(law)))


def blocks(curves: Sequence[StudyCurve]) -> Iterator[range]:
    """Curves one after another whose rows together are neighbours: the pieces of a table."""
    start, low, high, rows = 0, 0, 0, 0
    for place, curve in enumerate(curves):
        high, rows = max(high, curve.rows[-1] + 1), rows + len(curve.rows)
        if high - low == rows and (rows >= ROWS_TOGETHER or place == len(curves) - 1):
            yield range(start, place + 1)
            start, low, rows = place + 1, high, 0
