"""A run whose table is too long to be held: solved chunks are kept, and gathered piece by piece at the end."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Iterator, Sequence
from concurrent.futures import BrokenExecutor
from dataclasses import asdict
from datetime import UTC, datetime
from typing import Any, NamedTuple

import numpy as np
import pandas as pd

from frictionlab import registry
from frictionlab.columns import ALWAYS, INPUTS, OF_SHAPE, RESULTS, SI
from frictionlab.results.curve_table import curve_table
from frictionlab.results.expectations import Verdict, judge
from frictionlab.results.part import KeptRows, Part
from frictionlab.results.run import Run
from frictionlab.results.table import InputColumns, Inputs, Results, orbit_rows, status_counts
from frictionlab.results.thinned import Thinned, shown_rows, thinned
from frictionlab.runner.chunks import Cut, cuts, task_of
from frictionlab.runner.folder import SOLVER, RunFolder
from frictionlab.runner.kept_chunks import KeptChunks, Keys
from frictionlab.runner.limit import solve_within
from frictionlab.runner.long_files import (
    LongFiles,
    read_columns_of_file,
    read_pieces,
    read_whole,
    rows_of_file,
)
from frictionlab.runner.onsets import READ_FOR_ONSETS, onset_table
from frictionlab.runner.open_chunks import OpenChunk, answered, open_chunks
from frictionlab.runner.progress import Progress
from frictionlab.runner.workforce import Workforce
from frictionlab.study import Study, StudyCurve

ROWS_TOGETHER = 20_000
"""Rows of a piece of the table, at least; more where those of a curve are more, or lie farther apart."""
ROWS_AT_ONCE = 10_000
"""Rows of it that are written at once."""


class LongRun:
    """A study, the folder its table goes to, and the chunks that are kept meanwhile."""

    def __init__(self, study: Study, folder: RunFolder, kept: KeptChunks, overrides: Sequence[str]) -> None:
        self._study, self._folder, self._kept = study, folder, kept
        self._curves = list(study.curves())
        self._size = sum(len(each.rows) for each in self._curves)
        self._keys: list[str | None] = []
        self._there: set[int] = set()
        self._loose: dict[int, list[Part]] = {}
        self._rest = "not finished"
        self._earlier_runs = folder.previous_runs()
        self._started = time.monotonic()
        started = datetime.now(UTC).isoformat(timespec="seconds")
        self._run: dict[str, Any] = {
            "started": started,
            "overrides": list(overrides),
            "computed": 0,
            "found": 0,
        }

    # --- what an earlier run left -----------------------------------------------------------------------------------

    def is_whole(self, as_csv: bool) -> bool:
        """Whether the folder holds all that this run would write, found by the same code."""
        if not self._folder.is_intact(as_csv) or rows_of_file(self._folder.table) != self._size:
            return False
        first = next(read_pieces(self._folder.table))
        names = [name for name in first if name in RESULTS or name in SI]
        asked = [name for name in [*RESULTS, *SI] if name in self._study.selected()]
        counts = self._folder.counts()
        tried_again = {"killed", "failed"} & counts.keys()
        same_code = first.attrs.get(SOLVER) == self._folder.identity.solver
        return (
            same_code
            and not tried_again
            and [name for name in asked if name not in SI or name in names] == names
        )

    def taken_over(self) -> Run:
        """The run as the folder holds it, judged anew."""
        shown = thinned(read_pieces(self._folder.table), shown_rows(self._curves))
        shapes = self._folder.curves()
        verdicts, counts = self._verdicts(shapes), self._folder.counts()
        self._describe(counts, verdicts, self._earlier_runs)
        return self._as_run(verdicts, shapes, shown, counts)

    # --- solving ----------------------------------------------------------------------------------------------------

    def solve(self, force: Workforce, progress: Progress) -> bool:
        """Solve and keep every chunk that is not kept yet; True when that was interrupted."""
        self._describe({}, (), self._runs())
        places: dict[int, int] = {}

        def take(chunk: OpenChunk, parts: list[Part]) -> None:
            self._run["computed"] += len(chunk.whole)
            if not self._kept.keeps(chunk.key, answered(chunk, parts)):
                self._loose[places[id(chunk)]] = parts

        def unknown() -> Iterator[OpenChunk]:
            for place, chunk in enumerate(self._open_chunks()):
                self._keys.append(chunk.key)
                if chunk.key is not None and self._kept.has(chunk.key):
                    self._run["found"] += len(chunk.whole)
                    self._there.add(place)
                else:
                    places[id(chunk)] = place
                    yield chunk

        try:
            force.solve(
                unknown(), take, lambda: progress(self._run["found"] + self._run["computed"], self._size)
            )
        except KeyboardInterrupt:
            self._rest = "interrupted"
        except BrokenExecutor as problem:
            self._rest = f"a worker died: {problem}"
        finally:
            self._kept.trim()
        return self._rest == "interrupted"

    def _open_chunks(self) -> Iterator[OpenChunk]:
        return open_chunks(self._curves, task_of(self._study), keys=Keys(self._study.code))

    # --- gathering --------------------------------------------------------------------------------------------------

    def gather(self, stopped: bool, as_csv: bool) -> Run:
        """Write the table from the chunks, with curves and verdicts. Raises SaveError."""
        laws = registry.Laws({law.kind: law.law_class for law in self._study.laws})
        shown, counts = Thinned(shown_rows(self._curves)), Counter[str]()
        curves: list[pd.DataFrame] = []
        with LongFiles(self._folder, as_csv) as files:
            for piece in self._pieces():
                for table in piece.tables():
                    files.add_rows(table)
                    shown.add(table)
                    counts.update(status_counts(table))
                files.add_orbits(piece.orbits)
                curves.append(curve_table(piece.for_curves(stopped), laws))
        shapes = _together(curves)
        self._folder.save_curves(shapes)
        verdicts = () if stopped else self._verdicts(shapes)
        self._describe(dict(counts.most_common()), verdicts, self._runs())
        return self._as_run(verdicts, shapes, shown.table, dict(counts.most_common()))

    def _as_run(
        self, verdicts: tuple[Verdict, ...], curves: pd.DataFrame, shown: pd.DataFrame, counts: dict[str, int]
    ) -> Run:
        table, orbits = self._folder.table, self._folder.orbits_file
        wanted = {*READ_FOR_ONSETS, *INPUTS}
        return Run(
            self._study,
            lambda: read_whole(table),
            lambda: read_whole(orbits) if orbits.exists() else None,
            verdicts,
            self._folder.path,
            self._run["computed"],
            curves,
            lambda: onset_table(
                self._study, read_columns_of_file(table, lambda name: name in wanted or _is_input(name))
            ),
            shown,
            counts,
        )

    def _pieces(self) -> Iterator[_Piece]:
        """The table piece by piece."""
        columns, chosen, memories = InputColumns(self._curves), self._study.selected(), self._memories()
        found = self._answers()
        for block in blocks(self._curves):
            first = min(self._curves[place].rows.start for place in block)
            inputs = columns.of(block)
            results, orbits = Results(inputs.size, chosen), KeptRows()
            results.unfinished(self._rest)
            for part in _of_next(found, len(block)):
                moved = part.moved(part.rows - first)
                results.put(moved)
                orbits |= part.kept.get("orbits", {})
            yield _Piece(inputs, results, orbit_rows(orbits, None, np.empty(0, np.int64), memories))

    def _memories(self) -> list[str]:
        """The columns of memory of all laws, where orbits are kept: all rows of a file have the same."""
        if not task_of(self._study).samples:
            return []
        from frictionlab.orbit.sample import memory_columns  # imports numba: only where it is needed

        laws = {id(curve.given_law): curve.given_law for curve in self._curves}.values()
        return list(dict.fromkeys(name for law in laws for name in memory_columns(law)))

    def _answers(self) -> Iterator[list[Part]]:
        """Of one curve after another, the answers that are there."""
        place = 0
        for curve in self._curves:
            parts: list[Part] = []
            for cut in cuts([curve]):
                parts += self._answer(place, cut)
                place += 1
            yield parts

    def _answer(self, place: int, cut: Cut) -> list[Part]:
        """What was found of a chunk; one whose file turns out damaged is solved now."""
        if place in self._loose:
            return self._loose[place]
        key = self._keys[place] if place < len(self._keys) else None
        part = None if key is None else self._kept.found(key)
        if part is not None:
            return [part.moved(cut.rows)]
        return solve_within(cut.chunk(task_of(self._study))) if place in self._there else []

    def _verdicts(self, curves: pd.DataFrame) -> tuple[Verdict, ...]:
        """What was expected, judged on the columns that it speaks of."""
        if not self._study.expect:
            return ()
        wanted = {"mean_friction", "error", "status", "reason", *(each.column for each in self._study.expect)}
        table = read_columns_of_file(
            self._folder.table, lambda name: name in wanted or name in INPUTS or _is_input(name)
        )
        return tuple(judge(each, table, curves) for each in self._study.expect)

    def _runs(self) -> list[dict[str, Any]]:
        """The earlier runs and this one."""
        this = self._run | {"seconds": round(time.monotonic() - self._started, 3)}
        return [*self._earlier_runs, this]

    def _describe(
        self, counts: dict[str, int], verdicts: Sequence[Verdict], runs: list[dict[str, Any]]
    ) -> None:
        told = [asdict(verdict) for verdict in verdicts]
        self._folder.describe({"counts": counts, "expect": told, "runs": runs})


class _Piece(NamedTuple):
    """Rows of the table that make whole curves, and their orbits."""

    inputs: Inputs
    results: Results
    orbits: pd.DataFrame | None

    def tables(self) -> Iterator[pd.DataFrame]:
        """The rows, so many at a time."""
        for first in range(0, self.inputs.size, ROWS_AT_ONCE):
            yield self.results.frame(self.inputs, slice(first, first + ROWS_AT_ONCE))

    def for_curves(self, stopped: bool) -> pd.DataFrame:
        """What the shape of curves is read from; no rows for a run that was stopped."""
        none_or_all = slice(0) if stopped else slice(None)
        return self.results.frame(self.inputs, none_or_all, {*OF_SHAPE, *ALWAYS})


def _is_input(name: str) -> bool:
    return name.startswith(("scene.", "law."))


def _of_next(found: Iterator[list[Part]], curves: int) -> Iterator[Part]:
    for _ in range(curves):
        yield from next(found)


def _together(tables: Sequence[pd.DataFrame]) -> pd.DataFrame:
    """The tables one below the other; those without a row say nothing about types."""
    filled = [table for table in tables if len(table)] or list(tables[:1])
    return pd.concat(filled, ignore_index=True)


def blocks(curves: Sequence[StudyCurve]) -> Iterator[range]:
    """Curves one after another whose rows together are neighbours: the pieces of a table."""
    start, low, high, rows = 0, 0, 0, 0
    for place, curve in enumerate(curves):
        high, rows = max(high, curve.rows[-1] + 1), rows + len(curve.rows)
        if high - low == rows and (rows >= ROWS_TOGETHER or place == len(curves) - 1):
            yield range(start, place + 1)
            start, low, rows = place + 1, high, 0
