"""The page of a folder of studies: a row for each, leading to its report."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Any
from urllib.parse import quote

from frictionlab.report.figures import address
from frictionlab.report.page import rendered, wall
from frictionlab.report.tables import size
from frictionlab.results.words import counted
from frictionlab.runner.folder import write_page
from frictionlab.runner.saved import Saved

LARGEST_THUMBNAIL = 200_000
"""Length of a picture's data above which the index goes without it: the report has it."""


def write_index(folder: Path, runs: Sequence[Saved]) -> Path:
    """Write the index.html of runs in folders below this one; where it is. Raises SaveError."""
    file = folder / "index.html"
    write_page(file, index(folder, runs))
    return file


def index(folder: Path, runs: Sequence[Saved]) -> str:
    """The page of a folder of studies."""
    entries = [_entry(folder, run) for run in runs]
    counts = sum((Counter(run.counts) for run in runs), Counter())
    return rendered(
        "index.html",
        title=f"Studies in {folder.absolute().name}",
        size=f"{len(runs)} studies, {counted(sum(counts.values()), 'point')}",
        counts=dict(counts.most_common()),
        passed=sum(entry["passed"] for entry in entries),
        failed=sum(entry["failed"] for entry in entries),
        wall=wall(sum(run.seconds for run in runs)),
        entries=entries,
    )


def _entry(folder: Path, run: Saved) -> dict[str, Any]:
    """A study's row."""
    name, passed = run.folder.relative_to(folder).as_posix(), sum(verdict.passed for verdict in run.verdicts)
    picture = address(run.folder / "figures" / "mean_friction")
    return {
        "name": name,
        "title": run.title,
        "link": f"{quote(name)}/report.html",
        "points": ", ".join(f"{count} {status}" for status, count in run.counts.items()),
        "passed": passed,
        "failed": len(run.verdicts) - passed,
        "error": size(float(run.table["error"].max())),
        "wall": wall(run.seconds),
        "thumbnail": picture if len(picture) <= LARGEST_THUMBNAIL else "",
    }
