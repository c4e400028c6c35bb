"""A study to its run: its pieces found or solved, gathered, judged, and written where it has a folder."""

from __future__ import annotations

import time
from collections.abc import Callable, Collection, Sequence
from concurrent.futures import Executor
from dataclasses import asdict, replace
from datetime import UTC, datetime
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import pandas as pd

from frictionlab.runner.arguments import Existing
from frictionlab.runner.boundaries import boundary_table
from frictionlab.runner.chosen_speeds import choose_speeds
from frictionlab.runner.expectations import Verdict, judge
from frictionlab.runner.files import SaveError
from frictionlab.runner.folder import RunFolder
from frictionlab.runner.gathering import LONG_TABLE, GatheredTable, shown_rows
from frictionlab.runner.more_tables import READ_FOR_ONSETS, attractor_table, onset_table
from frictionlab.runner.pieces import task_of
from frictionlab.runner.progress import Meter, Progress, silent
from frictionlab.runner.results import Reader, Results
from frictionlab.runner.saved import read_folder, seconds_of
from frictionlab.runner.solving import Solving
from frictionlab.runner.store import Keys, Store
from frictionlab.runner.table import whole
from frictionlab.runner.table_files import TableFiles, read_columns_of_file
from frictionlab.runner.workforce import Workforce, workforce
from frictionlab.study import registry
from frictionlab.study.grid import StudyCurve, grid_size
from frictionlab.study.study import Study
from frictionlab.values.columns import ALWAYS, INPUTS


class Interrupted(KeyboardInterrupt):
    """A run was stopped; ``run`` is what it had found, already saved where it has a folder."""

    def __init__(self, run: Results) -> None:
        super().__init__("interrupted")
        self.run = run


class UnsavedError(SaveError):
    """A run whose results could not be written; ``run`` holds them."""

    def __init__(self, problem: SaveError, run: Results) -> None:
        super().__init__(str(problem))
        self.run = run


class RunWays(NamedTuple):
    """Options of a run, as ``fl.run`` is told."""

    overrides: Sequence[str] = ()
    existing: Existing = "reuse"
    executor: Executor | Workforce | None = None
    progress: Progress = silent
    as_csv: bool = False


class StudyRun:
    """Run of a study, from its pieces to its files.

    folder: its results go there, None to keep them in memory. store: its pieces are there.
    """

    def __init__(self, study: Study, folder: RunFolder | None, store: Store, ways: RunWays) -> None:
        self.study, self.folder, self.store, self.ways = study, folder, store, ways
        self._started, self._clock = datetime.now(UTC), time.monotonic()
        self._earlier_runs: list[dict[str, Any]] = []
        self._points = self._computed = self._found = 0

    def run(self) -> Results:
        """Return what came of it. Raises Interrupted or UnsavedError, both with the run; SaveError, FolderError."""
        if self.folder is not None:
            if self.ways.existing == "reuse":
                self._earlier_runs = self.folder.previous_runs()
                if self.folder.is_whole(self._as_csv, self._kept_files(self.folder)):
                    return self._taken_over(self.folder)
            self.folder.open(self.ways.existing)
            self._describe({}, ())
        if self.study.chosen_range is None:
            solving, stopped = self._solve(list(self.study.curves()))
        else:
            self.study, solving, stopped = choose_speeds(self.study, self._solve)
        return self._gathered(solving, stopped)

    @property
    def _long(self) -> RunFolder | None:
        """Folder into which a table goes that is too long to be held; None where it is held."""
        return self.folder if grid_size(self.study) > LONG_TABLE else None

    @property
    def _as_csv(self) -> bool:
        return self.ways.as_csv or not self._long

    def _kept_files(self, folder: RunFolder) -> list[Path]:
        study = self.study
        kept = {
            folder.orbits_file: study.keep.orbit,
            folder.harmonics_file: study.keep.harmonics,
            folder.attractors_file: study.keep.attractors,
        }
        return [file for file, asked in kept.items() if asked is not None]

    def _taken_over(self, folder: RunFolder) -> Results:
        """Return the run as the folder holds it, judged anew; nothing of it is solved."""
        found = read_folder(folder, self.study)
        self.study = found.study
        solving = Solving(list(self.study.curves()), task_of(self.study), self.store, Keys(self.study.code))
        made = self._made(solving, found)
        found = replace(
            found, readers={**found.readers, "onsets": made["onsets"], "boundaries": made["boundaries"]}
        )
        found = replace(found, verdicts=self._verdicts(found))
        account = {**found.account, "expect": [asdict(each) for each in found.verdicts]}
        folder.write_account(account)
        folder.write_study()
        return replace(found, account=account)

    def _solve(self, curves: list[StudyCurve]) -> tuple[Solving, bool]:
        """Solve all that can be solved; return True where that was interrupted."""
        before, tell = self._points, self.ways.progress
        with workforce(self.ways.executor) as force:
            task = task_of(self.study, limited=force.elsewhere)
            solving = Solving(curves, task, self.store, Keys(self.study.code))
            self._points += solving.points
            stopped = solving.solve_or_say_why_not(
                force,
                silent if tell is silent else lambda done, of, *how: tell(before + done, before + of, *how),
            )
        self._computed += solving.computed
        self._found += solving.found
        return solving, stopped

    # --- gathering --------------------------------------------------------------------------------------------------

    def _gathered(self, solving: Solving, stopped: bool) -> Results:
        """Return the run, written and judged. Raises Interrupted or UnsavedError, both with the run."""
        names = solving.columns() if self.study.columns is None else solving.task.columns
        gathered, problem = GatheredTable(shown_rows(self.study) if self._long else None), None
        try:
            with TableFiles(self.folder, self._as_csv) as files:
                tell = silent if stopped else self._next_stage("gathering", "points")
                gathered.gather(solving, files, self._laws, names, stopped, tell)
        except SaveError as unsaved:
            if self._long:
                raise
            problem = unsaved
        found = self._results(gathered, solving)
        try:
            found = replace(found, verdicts=() if stopped else self._verdicts(found))
            attractors = None if stopped else found.attractors
        except KeyboardInterrupt:
            stopped = True
        try:
            if problem is None:
                self._write_beside(found, None if stopped else attractors)
        except SaveError as unsaved:
            problem = unsaved
        if problem is not None:
            raise UnsavedError(problem, replace(found, folder=None)) from problem
        if self.folder is not None:
            account = self.folder.account()
            found = replace(found, account=account, seconds=seconds_of(account))
        if stopped:
            raise Interrupted(found)
        return found

    def _results(self, gathered: GatheredTable, solving: Solving) -> Results:
        """Return the results that are held, or are in the files of a long table."""
        table, curves, folder = gathered.table, gathered.curves, self._long
        readers: dict[str, Reader] = {
            "table": table.copy,  # onsets are made of it later, whatever somebody does with theirs
            "curves": curves.copy,
            "orbits": lambda: gathered.orbits,
            "harmonics": lambda: gathered.harmonics,
            "attractors": lambda: gathered.states,
        }
        if folder is not None:
            in_files = read_folder(folder, self.study, table).readers
            readers |= {name: in_files[name] for name in ("table", "shown", "orbits", "harmonics")}
        seconds, path = time.monotonic() - self._clock, None if self.folder is None else self.folder.path
        found = Results(self.study, readers, gathered.counts, (), self._computed, seconds, path)
        return replace(found, readers=readers | self._made(solving, found))

    def _made(self, solving: Solving, found: Results) -> dict[str, Reader]:
        """Return what makes the tables that are made from all answers, each once, or reads their files."""
        study, starts = self.study, self.study.keep.attractors

        def onsets() -> pd.DataFrame:
            return onset_table(study, self._columns(found, READ_FOR_ONSETS))

        makers: dict[str, Callable[[], pd.DataFrame]] = {
            "onsets": onsets,
            "boundaries": lambda: boundary_table(study, found.curves, self._laws),
        }
        if starts is not None:
            makers["attractors"] = lambda: attractor_table(solving.curves, study.tolerance, starts)
        return {name: partial(self._read_or_made, name, solving, make) for name, make in makers.items()}

    def _read_or_made(
        self, name: str, solving: Solving, make: Callable[[], pd.DataFrame]
    ) -> pd.DataFrame | None:
        file = None if self.folder is None else self.folder.path / f"{name}.csv"
        if self.folder is not None and file is not None and file.exists():
            return self.folder.read_text(file)
        if solving.rest:  # what is not solved has no onset
            return None
        # the study, too: keys of pieces know neither labels nor the lengths of scenes in SI units
        asked = self.study.keep.attractors, sorted(self.study.boundaries.items()), self.study.digest()
        return self.store.derived(solving.key(name, asked), make)

    def _columns(self, found: Results, wanted: Collection[str | None]) -> pd.DataFrame:
        """Return inputs and these columns of every row."""
        if self._long is None:
            return whole(found.table)
        return read_columns_of_file(
            self._long.table,
            lambda name: name in wanted or name in INPUTS or name.startswith(("scene.", "law.")),
        )

    def _verdicts(self, found: Results) -> tuple[Verdict, ...]:
        """Return the verdicts on all that is expected, judged on the columns that they speak of."""
        expect = self.study.expect
        if not expect:
            return ()
        read = self._columns(found, {*ALWAYS, *(each.column for each in expect)})
        return tuple(judge(each, read, found.curves) for each in expect)

    def _next_stage(self, doing: str, things: str) -> Progress:
        """Return what tells how far it is; only a meter knows of stages beside solving."""
        tell = self.ways.progress
        if not isinstance(tell, Meter):
            return silent
        tell.begins(doing, things)
        return tell

    @property
    def _laws(self) -> registry.Laws:
        return registry.Laws({law.kind: law.law_class for law in self.study.laws})

    def _write_beside(self, found: Results, attractors: pd.DataFrame | None) -> None:
        """Write curves, attractors and the account. Raises SaveError."""
        if self.folder is not None and not found.curves.empty:
            self.folder.save_text(self.folder.curves_file, found.curves)
        if self.folder is not None and attractors is not None:
            self.folder.save_text(self.folder.attractors_file, attractors)
        self._describe(found.counts, found.verdicts, done=True)

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
        runs, expect = [*self._earlier_runs, this], [asdict(each) for each in verdicts]
        self.folder.describe({"counts": counts, "expect": expect, "runs": runs}, done)
