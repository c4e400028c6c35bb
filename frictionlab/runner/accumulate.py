"""The table of a run as it grows: what an earlier run left, what comes in, what is saved meanwhile."""

from __future__ import annotations

import time
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import asdict
from datetime import UTC, datetime
from typing import Any

import numpy as np
import pandas as pd

from frictionlab.columns import selected
from frictionlab.results.expectations import Verdict
from frictionlab.results.harmonic_table import harmonic_table
from frictionlab.results.part import KeptRows, Part, Places
from frictionlab.results.table import Inputs, Results, finished_rows, orbit_rows
from frictionlab.runner.arguments import Existing
from frictionlab.runner.errors import SaveError
from frictionlab.runner.folder import RunFolder
from frictionlab.runner.progress import Progress, silent

ALL = selected(None)
SAVE_EVERY = 10.0
"""Most seconds of work that a crash may lose, apart from the chunks in progress, where chunks are not kept."""


class Accumulator:
    """The rows of a run, those found so far, and the folder that keeps them, if any."""

    def __init__(
        self,
        given: Inputs,
        folder: RunFolder | None = None,
        progress: Progress = silent,
        overrides: Sequence[str] = (),
        columns: frozenset[str] = ALL,
    ) -> None:
        self._given = given
        self._results = Results(given.size, columns)
        self._kept: dict[str, KeptRows] = {"orbits": {}, "harmonics": {}}
        self._earlier_orbits: pd.DataFrame | None = None
        self._folder = folder
        self._progress = progress
        self._started = time.monotonic()
        self._next_save = self._started + SAVE_EVERY
        self._runs: list[dict[str, Any]] = []
        self._run: dict[str, Any] = {
            "started": datetime.now(UTC).isoformat(timespec="seconds"),
            "overrides": list(overrides),
            "computed": 0,
            "found": 0,
        }
        self._unsaved = 0
        self._verdicts: list[dict[str, Any]] = []
        self.finished = np.zeros(given.size, np.bool_)

    def resume(
        self, existing: Existing, samples: int, in_part: bool = True, folder: RunFolder | None = None
    ) -> None:
        """Take over the rows an earlier run of the same study finished. Raises FolderError.

        in_part: also where it did not finish all of them. folder: where it is, if nothing is written there now.
        """
        source = self._folder if folder is None else folder
        earlier = source.earlier(existing) if source is not None else None
        if source is None or earlier is None:
            return
        self._runs = source.previous_runs()
        if self._results.lacking(earlier):
            return
        if samples:
            self._earlier_orbits = source.earlier_orbits(existing)
            if not _has_samples(self._earlier_orbits, samples):
                self._earlier_orbits = None
                return
        rows, kept = finished_rows(self._given, earlier)
        if len(rows) < self._given.size and not in_part:
            return
        self._results.put_earlier(rows, kept)
        self.finished[rows] = True

    def take(self, parts: Sequence[Part], kept: bool = False) -> None:
        """Enter rows that were solved. kept: whether they are kept already, apart from the table."""
        for part in parts:
            self._put(part)
            self._run["computed"] += len(part.rows)
            self._unsaved += 0 if kept else len(part.rows)

    def take_found(self, parts: Sequence[Part]) -> None:
        """Enter rows that are known from an earlier run, of this study or of another."""
        for part in parts:
            self._put(part)
            self._run["found"] += len(part.rows)

    def take_over(self, other: Accumulator, there: Places, rows: Places) -> None:
        """Enter rows that were gathered elsewhere, but for those finished before."""
        new = ~self.finished[rows]
        there, rows = there[new], rows[new]
        self._results.put_rows(rows, other._results, there)
        here = dict(zip(there.tolist(), rows.tolist(), strict=True))
        for name, found in other._kept.items():
            self._kept[name] |= {here[row]: kept for row, kept in found.items() if row in here}
        for count in ("computed", "found"):
            self._run[count] += other._run[count]

    def _put(self, part: Part) -> None:
        self._results.put(part)
        for name, found in part.kept.items():
            self._kept[name] |= found

    def tick(self) -> None:
        """Tell how far the run is, and save it when that is due."""
        done = int(self.finished.sum()) + self._run["found"] + self._run["computed"]
        self._progress(done, self._given.size)
        if time.monotonic() < self._next_save or not self._unsaved:
            return
        before = time.monotonic()
        with suppress(SaveError):  # the end of the run tries again and reports the error
            self.save(self.table, self.orbits)
            self._unsaved = 0
        after = time.monotonic()
        self._next_save = after + max(SAVE_EVERY, 20.0 * (after - before))

    def unfinished(self, reason: str) -> None:
        """Say why the rows that are missing are missing."""
        self._results.unfinished(reason)

    def judged(self, verdicts: Sequence[Verdict]) -> None:
        """Enter what was expected and whether it is so, for the account."""
        self._verdicts = [asdict(verdict) for verdict in verdicts]

    @property
    def complete(self) -> bool:
        """Whether an earlier run left nothing to do."""
        return bool(self.finished.all())

    @property
    def table(self) -> pd.DataFrame:
        """The current table."""
        return self._results.frame(self._given)

    @property
    def orbits(self) -> pd.DataFrame | None:
        """The kept orbits as they stand; None where none are kept."""
        return orbit_rows(self._kept["orbits"], self._earlier_orbits, np.flatnonzero(self.finished))

    @property
    def harmonics(self) -> pd.DataFrame:
        """The kept harmonics as they stand."""
        return harmonic_table(self._given, self._kept["harmonics"])

    @property
    def computed(self) -> int:
        """How many rows this run has answered itself."""
        return int(self._run["computed"])

    def save(self, table: pd.DataFrame, orbits: pd.DataFrame | None) -> None:
        """Write what a later run continues from, and its account. Raises SaveError."""
        if self._folder is not None:
            if not self.complete:
                self._folder.save(table, orbits)
            self.describe()

    def save_all(self, table: pd.DataFrame, orbits: pd.DataFrame | None, curves: pd.DataFrame) -> None:
        """Write everything; what is missing where an earlier run left nothing to do. Raises SaveError."""
        self.save(table, orbits)
        if self._folder is not None:
            self._folder.save_curves(curves)
        if self._folder is not None and not (self.complete and self._folder.has_csv):
            self._folder.save_csv(table)

    def describe(self) -> None:
        """Write what the folder answers and how far it is. Raises SaveError."""
        if self._folder is not None:
            this = self._run | {"seconds": round(time.monotonic() - self._started, 3)}
            runs = self._runs if self.complete else [*self._runs, this]
            found = {"counts": self._results.counts(), "expect": self._verdicts}
            self._folder.describe(found | {"runs": runs})


def _has_samples(orbits: pd.DataFrame | None, samples: int) -> bool:
    """Whether an earlier run kept orbits, with this many samples each."""
    return orbits is not None and bool((orbits.groupby("row").size() == samples).all())
