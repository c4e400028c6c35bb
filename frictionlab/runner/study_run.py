"""A study to its run: what is left of it solved in chunks, gathered, judged, and written where it has a folder."""

from __future__ import annotations

import time
from collections.abc import Callable, Collection, Sequence
from concurrent.futures import Executor
from dataclasses import asdict, replace
from datetime import UTC, datetime
from typing import Any, NamedTuple

import pandas as pd

from frictionlab.runner.arguments import Existing
from frictionlab.runner.boundaries import boundary_table
from frictionlab.runner.chosen_speeds import choose_speeds
from frictionlab.runner.expectations import Verdict, judge
from frictionlab.runner.files import SaveError
from frictionlab.runner.folder import RunFolder
from frictionlab.runner.gathering import LONG_TABLE, GatheredTable, shown_rows, thinned
from frictionlab.runner.more_tables import READ_FOR_ONSETS, attractor_table, onset_table
from frictionlab.runner.pieces import task_of
from frictionlab.runner.progress import Meter, Progress, silent
from frictionlab.runner.run import Run
from frictionlab.runner.solving import Solving
from frictionlab.runner.store import Store
from frictionlab.runner.table import whole
from frictionlab.runner.table_files import TableFiles, read_columns_of_file, read_pieces, read_whole
from frictionlab.runner.workforce import Workforce, workforce
from frictionlab.study import registry
from frictionlab.study.grid import StudyCurve, grid_size
from frictionlab.study.study import Study
from frictionlab.values.columns import ALWAYS, INPUTS


class Interrupted(KeyboardInterrupt):
    """A run was stopped; ``run`` is what it had found, already saved where it has a folder."""

    def __init__(self, run: Run) -> None:
        super().__init__("interrupted")
        self.run = run


class UnsavedError(SaveError):
    """A run whose results could not be written; ``run`` holds them."""

    def __init__(self, problem: SaveError, run: Run) -> None:
        super().__init__(str(problem))
        self.run = run


class RunWays(NamedTuple):
    """How to go about a run: as ``fl.run`` is told."""

    overrides: Sequence[str] = ()
    existing: Existing = "reuse"
    executor: Executor | Workforce | None = None
    progress: Progress = silent
    as_csv: bool = False


class StudyRun:
    """One run of a study. folder: where its results go, None for nowhere; store: where its pieces are."""

    def __init__(self, study: Study, folder: RunFolder | None, store: Store, ways: RunWays) -> None:
        self.study, self.folder, self.store, self.ways = study, folder, store, ways
        self._started, self._clock = datetime.now(UTC), time.monotonic()
        self._earlier_runs: list[dict[str, Any]] = []
        self._points = self._computed = self._found = 0
        self._is_idle = False

    def run(self) -> Run:
        """What came of it. Raises Interrupted or UnsavedError, both with the run; SaveError, FolderError."""
        if self.folder is not None and self.ways.existing == "reuse":
            self._earlier_runs = self.folder.previous_runs()
            if self._is_there():
                return self._taken_over()
        if self.folder is not None:
            self.folder.open(self.ways.existing)
            self._describe({}, ())
        solving, stopped = self._solved()
        return self._with_attractors(self._gathered(solving, stopped), solving)

    # --- what an earlier run left -----------------------------------------------------------------------------------

    @property
    def _is_long(self) -> bool:
        return self.folder is not None and grid_size(self.study) > LONG_TABLE

    @property
    def _as_csv(self) -> bool:
        return self.ways.as_csv or not self._is_long

    def _is_there(self) -> bool:
        """Whether the folder holds all that this run would write."""
        folder, study = self.folder, self.study
        assert folder is not None
        kept = {
            folder.orbits_file: study.keep_orbit,
            folder.harmonics_file: study.keep_harmonics,
            folder.attractors_file: study.keep_attractors,
        }
        there = all(file.exists() for file, asked in kept.items() if asked is not None)
        return there and study.chosen_range is None and folder.is_whole(self._as_csv)

    def _taken_over(self) -> Run:
        """The run as the folder holds it, judged anew."""
        assert self.folder is not None
        folder, study, self._is_idle = self.folder, self.study, True
        shown = thinned(read_pieces(folder.table), shown_rows(study)) if self._is_long else None
        done = self._read_run(shown, folder.counts(), folder.read_curves())
        if study.keep_harmonics is not None:
            done = replace(done, harmonics=folder.intact_text(folder.harmonics_file))
        if folder.attractors_file.exists():
            done = replace(done, attractors=folder.intact_text(folder.attractors_file))
        done = self._judged(done)
        self._describe(done.counts, done.verdicts, done=True)
        return done

    # --- solving ----------------------------------------------------------------------------------------------------

    def _solved(self) -> tuple[Solving, bool]:
        """Solve all that can be solved; return True where that was interrupted. Belt speeds are chosen as it goes."""
        if self.study.chosen_range is None:
            return self._solve(list(self.study.curves()))
        self.study, solving, stopped = choose_speeds(self.study, self._solve)
        return solving, stopped

    def _solve(self, curves: list[StudyCurve]) -> tuple[Solving, bool]:
        before, tell = self._points, self.ways.progress
        with workforce(self.ways.executor) as force:
            task = task_of(self.study, limited=force.elsewhere)
            solving = Solving(curves, task, self.store, self.study.code)
            self._points += solving.points
            stopped = solving.solve_or_say_why_not(
                force,
                silent if tell is silent else lambda done, of, *how: tell(before + done, before + of, *how),
            )
        self._computed += solving.computed
        self._found += solving.found
        return solving, stopped

    # --- gathering --------------------------------------------------------------------------------------------------

    def _gathered(self, solving: Solving, stopped: bool) -> Run:
        """The run, written and judged. Raises Interrupted or UnsavedError, both with the run."""
        names = solving.columns() if self.study.columns is None else solving.task.columns
        gathered = GatheredTable(shown_rows(self.study) if self._is_long else None)
        unsaved = None
        try:
            with TableFiles(self.folder, self._as_csv) as files:
                tell = silent if stopped else self._next_stage("gathering", "points")
                gathered.gather(solving, files, self._laws, names, stopped, tell)
            if self.folder is not None and not gathered.curves.empty:
                self.folder.save_text(self.folder.curves_file, gathered.curves)
        except SaveError as problem:
            if self._is_long:
                raise
            unsaved = problem
        done = self._judged(replace(self._as_run(gathered, stopped), attractors=gathered.states), stopped)
        try:
            if unsaved is None:
                self._describe(done.counts, done.verdicts, done=True)
        except SaveError as problem:
            unsaved = problem
        if unsaved is not None:
            raise UnsavedError(unsaved, replace(done, folder=None)) from unsaved
        if stopped:
            raise Interrupted(done)
        return done

    def _next_stage(self, doing: str, things: str) -> Callable[[int, int], None]:
        """What tells how far it is; only a meter knows of stages beside solving."""
        tell = self.ways.progress
        if not isinstance(tell, Meter):
            return silent
        tell.begins(doing, things)
        return tell

    @property
    def _laws(self) -> registry.Laws:
        return registry.Laws({law.kind: law.law_class for law in self.study.laws})

    def _as_run(self, gathered: GatheredTable, stopped: bool) -> Run:
        study, table, orbits = self.study, gathered.table, gathered.orbits
        if self._is_long and self.folder is not None:
            done = self._read_run(table, gathered.counts, gathered.curves)
            kept = self.folder.harmonics_file if study.keep_harmonics is not None else None
            return done if kept is None else replace(done, harmonics=self.folder.read_text(kept))
        read = table.iloc[:0] if stopped else table
        return Run(
            study,
            lambda: table,
            lambda: orbits,
            (),
            None if self.folder is None else self.folder.path,
            self._computed,
            gathered.curves,
            lambda: onset_table(self.study, read),
            lambda: boundary_table(
                study, gathered.curves.iloc[:0] if stopped else gathered.curves, self._laws
            ),
            harmonics=None if study.keep_harmonics is None else gathered.harmonics,
        )

    def _read_run(self, shown: pd.DataFrame | None, counts: dict[str, int], curves: pd.DataFrame) -> Run:
        """A run whose table stays in its file."""
        assert self.folder is not None
        study, table, orbits = self.study, self.folder.table, self.folder.orbits_file
        return Run(
            study,
            lambda: read_whole(table),
            lambda: read_whole(orbits) if study.keep_orbit is not None and orbits.exists() else None,
            (),
            self.folder.path,
            self._computed,
            curves,
            lambda: onset_table(self.study, read_columns_of_file(table, _is_read_for({*READ_FOR_ONSETS}))),
            lambda: boundary_table(study, curves, self._laws),
            shown,
            counts,
        )

    def _judged(self, done: Run, stopped: bool = False) -> Run:
        """The run with its verdicts, judged on the columns that they speak of."""
        expect = self.study.expect
        if stopped or not expect:
            return done
        table, wanted = self.folder and self.folder.table, {*ALWAYS, *(each.column for each in expect)}
        read = (
            read_columns_of_file(table, _is_read_for(wanted))
            if self._is_long and table
            else whole(done.table)
        )
        return replace(done, verdicts=tuple(judge(each, read, done.curves) for each in expect))

    def _describe(self, counts: dict[str, int], verdicts: Sequence[Verdict], done: bool = False) -> None:
        """Write what the folder answers and how far it is. Raises SaveError."""
        if self.folder is None:
            return
        this = {
            "started": self._started.isoformat(timespec="seconds"),
            "overrides": list(self.ways.overrides),
            "computed": self._computed,
            "found": self._found,
            "seconds": round(time.monotonic() - self._clock, 3),
        }
        runs = [*self._earlier_runs, *([] if self._is_idle else [this])]
        self.folder.describe(
            {"counts": counts, "expect": [asdict(each) for each in verdicts], "runs": runs}, done
        )

    def _with_attractors(self, done: Run, solving: Solving) -> Run:
        """The run with its attractors, where the study keeps them, or some points have several.

        Raises Interrupted, UnsavedError.
        """
        starts, table = done.study.keep_attractors, done.attractors
        try:
            if starts is not None:
                table = self.store.derived(
                    solving.key("attractors", starts),
                    lambda: attractor_table(solving.curves, done.study.tolerance, starts),
                )
        except KeyboardInterrupt:
            raise Interrupted(done) from None
        if table is None:
            return done
        done = replace(done, attractors=table)
        try:
            if self.folder is not None:
                self.folder.save_text(self.folder.attractors_file, table)
        except SaveError as problem:
            raise UnsavedError(problem, done) from problem
        return done


def _is_read_for(wanted: Collection[str | None]) -> Callable[[str], bool]:
    """Whether a column is an input or one of these."""
    return lambda name: name in wanted or name in INPUTS or name.startswith(("scene.", "law."))
