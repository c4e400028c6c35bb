"""Runs in their folders: read as they were written, nothing computed; runs in memory, written into one."""

from __future__ import annotations

import shlex
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import asdict, replace
from datetime import UTC, datetime, timedelta
from functools import partial
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from frictionlab import __version__
from frictionlab.runner.curve_table import CURVE_TEXT
from frictionlab.runner.expectations import Verdict
from frictionlab.runner.files import FolderError, alone_in
from frictionlab.runner.folder import run_folder
from frictionlab.runner.folder_files import FolderFiles, rerun
from frictionlab.runner.gathering import LONG_TABLE, shown_rows, thinned
from frictionlab.runner.packing import WORDS
from frictionlab.runner.results import Reader, Results
from frictionlab.runner.table import status_counts
from frictionlab.runner.table_files import (
    TableFiles,
    read_columns_of_file,
    read_head,
    read_pieces,
    read_whole,
    rows_of_file,
)
from frictionlab.study.grid import grid_size
from frictionlab.study.load import read_back
from frictionlab.study.study import Study
from frictionlab.values.columns import ALWAYS, BELT_SPEEDS, INPUTS, RESULTS, TEXT, belt_speed
from frictionlab.values.notes import StudyError

WANTED = "RUN is a folder that 'frictionlab run STUDY -o RUN' wrote"
REPORT_FILES = frozenset({"results.parquet", "curves.csv", "onsets.csv", "boundaries.csv"})
"""Files that a report is made from, beside the study and its account."""
MOST_NAMED = 3
"""Runs named to somebody who gave the folder around them."""


def read_run(folder: Path) -> Results:
    """Return the run of this folder. Raises FolderError where it is no run or a damaged one, StudyError."""
    _check_is_a_run(folder)
    files = FolderFiles(folder)
    account = files.account()
    study = _study(folder, account)
    wrong = _damaged(files, account, study)
    for name in REPORT_FILES & wrong.keys():
        raise FolderError(wrong[name])
    with _readable(files.table):
        rows, head = rows_of_file(files.table), read_head(files.table)
    if told := _wrong(head, rows, study):
        raise FolderError(f"{files.table} is not a result table: {told}; {_remedy(folder)}")
    with _readable(files.table):
        found = read_folder(files, study, damaged=tuple(wrong.values()))
    _check_belongs_together(folder, rows, found.study, account)
    return found


@contextmanager
def _readable(file: Path) -> Iterator[None]:
    """Raise FolderError in place of whatever arrow raises where it stumbles over a damaged file."""
    try:
        yield
    except (FolderError, StudyError):
        raise
    except Exception as problem:
        reason = str(problem).partition("\n")[0]
        raise FolderError(f"{file} cannot be read ({reason}); {_remedy(file.parent)}") from problem


def read_folder(
    files: FolderFiles, study: Study, shown: pd.DataFrame | None = None, damaged: tuple[str, ...] = ()
) -> Results:
    """Return the results that a folder holds.

    shown: of a long table the rows that figures show, where they are known. Raises FolderError.
    """
    account = files.account()
    table = None if rows_of_file(files.table) > LONG_TABLE else read_whole(files.table)
    study = _with_chosen_speeds(study, files.table)
    if table is None and shown is None:
        shown = thinned(read_pieces(files.table), shown_rows(study))
    orbits = files.orbits_file
    are_damaged = any(str(orbits) in told for told in damaged)
    readers: dict[str, Reader] = {
        "table": lambda: read_whole(files.table) if table is None else table.copy(),
        "curves": lambda: _curves(files),
        "orbits": lambda: None if are_damaged or not orbits.exists() else read_whole(orbits),
        **{name: partial(files.read_text, files.path / f"{name}.csv") for name in BESIDE_THE_TABLE},
        **({} if shown is None else {"shown": lambda: shown}),
    }
    counts = dict(account["counts"]) if table is None else status_counts(table)
    verdicts = tuple(Verdict(bool(each["passed"]), str(each["sentence"])) for each in account["expect"])
    return Results(study, readers, counts, verdicts, 0, seconds_of(account), files.path, account, damaged)


def seconds_of(account: Mapping[str, Any]) -> float:
    """Return the wall time of all runs that worked in a folder [s]."""
    return float(sum(run["seconds"] for run in account["runs"]))


BESIDE_THE_TABLE = "onsets", "boundaries", "attractors", "harmonics"


def _curves(files: FolderFiles) -> pd.DataFrame | None:
    found = files.read_text(files.curves_file)
    return None if found is None else found.astype({name: WORDS for name in CURVE_TEXT if name in found})


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
    wrong = files.damage()
    complete = study.digest() == account.get("digest") and not any(name.endswith(".py") for name in wrong)
    command = rerun(files.path, shlex.quote(str(files.study_file)) if complete else "STUDY")
    return {name: f"{files.path / name} {what}; mend it: {command}" for name, what in wrong.items()}


def _with_chosen_speeds(study: Study, file: Path) -> Study:
    """Return the study with the belt speeds that its run chose, rising in each scene from the start of the range."""
    along = study.chosen_range
    if along is None:
        return study
    table = read_columns_of_file(file, lambda name: name in BELT_SPEEDS)
    speeds = table[belt_speed(table.columns)].to_numpy(dtype=float)
    starts = [*np.flatnonzero(speeds == along.start).tolist(), len(speeds)]
    scenes = pairwise(starts[: len(study.scenes_along) + 1])
    return study.with_speeds([speeds[start:stop].tolist() for start, stop in scenes])


def _wrong(table: pd.DataFrame, rows: int, study: Study) -> str:
    """Return what keeps a table from being a result table; '' for nothing. table: its columns alone."""
    asked = INPUTS.keys() | (ALWAYS if study.columns is None else study.selected())
    missing = [name for name in [*INPUTS, *RESULTS] if name in asked and name not in table]
    if missing:
        return f"it has no column {missing[0]}"
    words = [name for name in RESULTS if name in table and name not in TEXT and table[name].dtype.kind != "f"]
    if words:
        return f"its column {words[0]} does not hold numbers"
    return "" if rows else "it is empty"


def _check_belongs_together(folder: Path, rows: int, study: Study, account: Mapping[str, Any]) -> None:
    """Raise FolderError for a table beside another study: they would make a page of lies."""
    wanted = grid_size(study)
    edited = account.get("digest") != study.digest()
    if rows != wanted or (edited and account.get("frictionlab") == __version__):
        differs = (
            f"it has {wanted} points, the table {rows}" if rows != wanted else "it asks for other numbers"
        )
        raise FolderError(
            f"{folder}: study.yaml is not the study of results.parquet ({differs}; only title, source, "
            f"figures and expect may be edited); {_remedy(folder)}"
        )


def _remedy(folder: Path, force: bool = True) -> str:
    return f"run the study again: {rerun(folder)}{' --force' if force else ''}"


def save_run(done: Results, out: Path) -> Results:
    """Write table, curves and account of a run in memory; return the same run in its folder.

    Raises FolderError where it is the folder of another study, SaveError.
    """
    with alone_in(out):
        folder = run_folder(done.study, out)
        folder.check("reuse")
        folder.open("replace")
        started = datetime.now(UTC) - timedelta(seconds=done.seconds)
        told = {"started": started.isoformat(timespec="seconds"), "overrides": [], "found": 0}
        runs = [told | {"computed": done.computed, "seconds": done.seconds}]
        account = {"counts": done.counts, "expect": [asdict(each) for each in done.verdicts], "runs": runs}
        folder.describe(account)
        with TableFiles(folder) as files:
            files.add_rows(done.table)
            files.add_orbits(done.orbits)
            files.add_harmonics(done.harmonics)
        for file, table in ((folder.curves_file, done.curves), (folder.attractors_file, done.attractors)):
            if table is not None and not table.empty:
                folder.save_text(file, table)
        folder.describe(account, done=True)
        return replace(done, folder=out, account=folder.account())
