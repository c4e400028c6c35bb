"""A run that was solved in memory, written as one that was solved into a folder."""

from __future__ import annotations

from dataclasses import replace
from datetime import UTC, datetime, timedelta
from pathlib import Path

from frictionlab.results.run import Run
from frictionlab.runner.api import run_folder
from frictionlab.runner.in_use import alone_in
from frictionlab.runner.table_files import TableFiles


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
