"""A saved run: its study, table and provenance, read from its folder. Nothing is computed.

A run that was solved in memory, written as one that was solved into a folder.
"""

from __future__ import annotations

import shlex
from collections.abc import Sequence
from dataclasses import dataclass, replace
from datetime import UTC, datetime, timedelta
from functools import cached_property
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from frictionlab import __version__
from frictionlab.runner.api import run_folder
from frictionlab.runner.expectations import Verdict
from frictionlab.runner.files import FolderError, alone_in
from frictionlab.runner.folder_files import FolderFiles, rerun
from frictionlab.runner.gathering import LONG_TABLE, shown_rows, thinned
from frictionlab.runner.run import Run
from frictionlab.runner.table import status_counts, whole
from frictionlab.runner.table_files import TableFiles, read_pieces, read_whole, rows_of_file
from frictionlab.study.grid import grid_size
from frictionlab.study.load import read_back
from frictionlab.study.study import Study
from frictionlab.values.columns import ALWAYS, INPUTS, RESULTS, TEXT, belt_speed
from frictionlab.values.notes import StudyError

WANTED = "RUN is a folder that 'frictionlab run STUDY -o RUN' wrote"
REPORT_FILES = frozenset({"results.parquet", "curves.csv", "onsets.csv", "boundaries.csv"})
"""Files that a report is made from, beside the study and its account."""
MOST_NAMED = 3
"""Runs named to somebody who gave the folder around them."""


@dataclass(frozen=True)
class Saved:
    """A run in its folder. account: provenance.json; curves, onsets: of curves.csv and onsets.csv, None without one.

    table: of a long one the rows that are shown; ``rows`` is then the number of all.
    damaged: what is wrong with files that a report does without, and the command that mends them.
    """

    folder: Path
    study: Study
    table: pd.DataFrame
    curves: pd.DataFrame | None
    account: dict[str, Any]
    damaged: tuple[str, ...] = ()
    rows: int | None = None

    @cached_property
    def onsets(self) -> pd.DataFrame | None:
        """onsets.csv; None where there is none. Raises FolderError."""
        return self._read("onsets.csv")

    @cached_property
    def boundaries(self) -> pd.DataFrame | None:
        """boundaries.csv; None where there is none. Raises FolderError."""
        return self._read("boundaries.csv")

    @cached_property
    def attractors(self) -> pd.DataFrame | None:
        """attractors.csv; None where there is none. Raises FolderError."""
        return self._read("attractors.csv")

    @cached_property
    def harmonics(self) -> pd.DataFrame | None:
        """harmonics.csv; None where there is none. Raises FolderError."""
        return self._read("harmonics.csv")

    def _read(self, name: str) -> pd.DataFrame | None:
        return FolderFiles(self.folder).read_text(self.folder / name)

    def orbits_of(self, rows: Sequence[int]) -> pd.DataFrame | None:
        """The kept orbits of these rows; None where none are kept, or their file is damaged."""
        file = self.folder / "orbits.parquet"
        if not file.exists() or any(str(file) in told for told in self.damaged):
            return None
        return pd.read_parquet(file, filters=[("row", "in", list(rows))])

    @property
    def size(self) -> int:
        """How many rows the table has."""
        return len(self.table) if self.rows is None else self.rows

    @property
    def title(self) -> str:
        """The study's title, else the name of its file, else of the folder."""
        file = Path(str(self.account.get("study") or "")).stem
        return self.study.title or file or self.folder.absolute().name

    @property
    def verdicts(self) -> list[Verdict]:
        """What was expected and whether it is so; empty for an interrupted run, which is not judged."""
        return [Verdict(bool(each["passed"]), str(each["sentence"])) for each in self.account["expect"]]

    @property
    def counts(self) -> dict[str, int]:
        """How many rows have each status, the commonest first."""
        return status_counts(self.table) if self.rows is None else dict(self.account["counts"])

    @property
    def seconds(self) -> float:
        """Wall time of all runs that worked in the folder [s]."""
        return float(sum(run["seconds"] for run in self.account["runs"]))


def read_saved(folder: Path) -> Saved:
    """The run of this folder. Raises FolderError where it is no run or a damaged one, StudyError."""
    _check_is_a_run(folder)
    files = FolderFiles(folder)
    account = files.account()
    study = _study(folder, account)
    wrong = _damaged(files, account, study)
    for name in REPORT_FILES & wrong.keys():
        raise FolderError(wrong[name])
    table = _table(folder, study)
    study = _with_chosen_speeds(study, table)
    rows = rows_of_file(folder / "results.parquet")
    long = rows if rows > LONG_TABLE else None
    saved = Saved(
        folder, study, whole(table), files.read_text(files.curves_file), account, tuple(wrong.values()), long
    )
    _check_belongs_together(saved)
    return saved


def saved_as(run: Run) -> Saved:
    """A run that was just written. Raises FolderError where somebody took its account away meanwhile."""
    assert run.folder is not None
    files, long = FolderFiles(run.folder), None if run.shown is None else run.size
    return Saved(
        run.folder,
        run.study,
        whole(run.to_show),
        files.read_text(files.curves_file),
        files.account(),
        (),
        long,
    )


def _check_is_a_run(folder: Path) -> None:
    if not folder.exists():
        raise FolderError(f"{folder}: no such folder; {WANTED}")
    if not folder.is_dir():
        raise FolderError(f"{folder} is a file, not a folder; {WANTED}")
    names = ("results.parquet", "study.yaml", "provenance.json")
    missing = [name for name in names if not (folder / name).is_file()]
    if missing:
        hint = _folder_hint(folder)
        if len(missing) < len(names):
            hint = f"{hint}; if it is one, {_remedy(folder, 'provenance.json' in missing)}"
        raise FolderError(f"{folder} is not the folder of a run: no {', '.join(missing)} in it; {hint}")


def _folder_hint(folder: Path) -> str:
    runs = sorted(path.parent for path in folder.glob("*/results.parquet"))
    if not runs:
        return WANTED
    named = ", ".join(str(run) for run in runs[:MOST_NAMED]) + (", ..." if len(runs) > MOST_NAMED else "")
    return f"it holds runs, give one of them: {named}"


def _study(folder: Path, account: dict[str, Any]) -> Study:
    try:
        return read_back(folder / "study.yaml", account["code"])
    except StudyError as problem:
        raise FolderError(f"{problem}\nput it right there, or {_remedy(folder, force=False)}") from problem


def _damaged(files: FolderFiles, account: dict[str, Any], study: Study) -> dict[str, str]:
    """By file, what is wrong with it and the command that mends it."""
    wrong = {name: what for name in files.stamps() if (what := files.damage(name))}
    complete = study.digest() == account.get("digest") and not any(name.endswith(".py") for name in wrong)
    command = rerun(files.path, shlex.quote(str(files.study_file)) if complete else "STUDY")
    return {name: f"{files.path / name} {what}; mend it: {command}" for name, what in wrong.items()}


def _table(folder: Path, study: Study) -> pd.DataFrame:
    file = folder / "results.parquet"
    try:
        long = rows_of_file(file) > LONG_TABLE and rows_of_file(file) == grid_size(study)
        rows = shown_rows(study) if long else None
        table = read_whole(file) if rows is None else thinned(read_pieces(file), rows)
    except Exception as problem:  # a damaged file makes pyarrow raise whatever it stumbles over
        reason = str(problem).partition("\n")[0]
        raise FolderError(f"{file} cannot be read ({reason}); {_remedy(folder)}") from problem
    if wrong := _wrong(table, study):
        raise FolderError(f"{file} is not a result table: {wrong}; {_remedy(folder)}")
    return table


def _with_chosen_speeds(study: Study, table: pd.DataFrame) -> Study:
    """The study with the belt speeds that its run chose: of each scene they rise from the start of their range."""
    along = study.chosen_range
    if along is None:
        return study
    speeds = table[belt_speed(table.columns)].to_numpy(dtype=float)
    starts = [*np.flatnonzero(speeds == along.start).tolist(), len(speeds)]
    scenes = pairwise(starts[: len(study.scenes_along) + 1])
    return study.with_speeds([speeds[start:stop].tolist() for start, stop in scenes])


def _wrong(table: pd.DataFrame, study: Study) -> str:
    """What keeps a table from being a result table; nothing for one that is."""
    asked = INPUTS.keys() | (ALWAYS if study.columns is None else study.selected())
    missing = [name for name in [*INPUTS, *RESULTS] if name in asked and name not in table]
    if missing:
        return f"it has no column {missing[0]}"
    words = [name for name in RESULTS if name in table and name not in TEXT and table[name].dtype.kind != "f"]
    if words:
        return f"its column {words[0]} does not hold numbers"
    return "it is empty" if table.empty else ""


def _check_belongs_together(saved: Saved) -> None:
    """A table beside another study would make a page of lies."""
    rows, wanted = saved.size, grid_size(saved.study)
    edited = saved.account.get("digest") != saved.study.digest()
    if rows != wanted or (edited and saved.account.get("frictionlab") == __version__):
        differs = (
            f"it has {wanted} points, the table {rows}" if rows != wanted else "it asks for other numbers"
        )
        raise FolderError(
            f"{saved.folder}: study.yaml is not the study of results.parquet ({differs}; only title, source, "
            f"figures and expect may be edited); {_remedy(saved.folder)}"
        )


def _remedy(folder: Path, force: bool = True) -> str:
    return f"run the study again: {rerun(folder)}{' --force' if force else ''}"


def save_run(done: Run, out: Path, seconds: float) -> Run:
    """Write table, curves and account of a run that took so long [s]; the same run in its folder.

    Raises FolderError where it is the folder of another study, SaveError.
    """
    with alone_in(out):
        return _saved_alone(done, out, seconds)


def _saved_alone(done: Run, out: Path, seconds: float) -> Run:
    folder = run_folder(done.study, out)
    folder.check("reuse")
    folder.open("replace")
    started = datetime.now(UTC) - timedelta(seconds=seconds)
    told = {"started": started.isoformat(timespec="seconds"), "overrides": [], "found": 0}
    account = {
        "counts": done.counts,
        "expect": [],
        "runs": [told | {"computed": done.computed, "seconds": seconds}],
    }
    folder.describe(account)
    with TableFiles(folder) as files:
        files.add_rows(done.table)
        files.add_orbits(done.orbits)
        files.add_harmonics(done.harmonics)
    for file, table in ((folder.curves_file, done.curves), (folder.attractors_file, done.attractors)):
        if table is not None and not table.empty:
            folder.save_text(file, table)
    folder.describe(account, done=True)
    return replace(done, folder=out)
