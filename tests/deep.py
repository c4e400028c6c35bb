"""The deep profile in ten parts of at most ten minutes each: .venv/bin/python tests/deep.py [PART...].

PART is 1 to 10; all of them where none is named. The collected tests are cut, in their order, by the seconds of
their files in ``reference/deep_seconds.csv``; a file that is not in it is estimated. Every part is a pytest of its
own, whose words go to ``build/deep/partN.txt`` and whose seconds to ``build/deep/partN.csv``; once all ten are there,
the table is brought up to date. Exit code 1 where a part fails.
"""

from __future__ import annotations

import csv
import itertools
import os
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Sequence
from pathlib import Path

import pytest

PROJECT = Path(__file__).parents[1]
TABLE = Path(__file__).parent / "reference" / "deep_seconds.csv"
FOLDER = PROJECT / "build" / "deep"
PARTS = 10
LIMIT = 600.0
"""Seconds that a part may take."""
MARKED, DRAWN, OTHER = 8.0, 6.0, 0.06
"""Seconds of tests whose file is not in the table: those that only this profile runs, those drawn, any other."""
FAILED, PASSED = 1, (pytest.ExitCode.OK, pytest.ExitCode.NO_TESTS_COLLECTED)


# In pytest, which loads this file as a plugin: DEEP_PART says which tests stay.


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Keep the tests of the part."""
    kept = parts(items)[int(os.environ["DEEP_PART"]) - 1]
    own = set(kept)
    others = [item for item in items if item not in own]
    config.hook.pytest_deselected(items=others)
    items[:] = kept


def pytest_sessionstart(session: pytest.Session) -> None:
    """Note seconds where all reports arrive."""
    if not hasattr(session.config, "workerinput"):
        session.config.pluginmanager.register(Clock(), "seconds of the deep profile")


class Clock:
    """Sums the seconds of each file."""

    def __init__(self) -> None:
        self.seconds, self.counts = Counter[str](), Counter[str]()

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Of the setup, the test and the teardown."""
        file = report.nodeid.partition("::")[0]
        self.seconds[file] += report.duration
        self.counts[file] += report.when == "call" or report.skipped

    def pytest_sessionfinish(self) -> None:
        """Write those of this part."""
        found = {file: self.seconds[file] / n for file, n in self.counts.items() if n}
        write_seconds(FOLDER / f"part{os.environ['DEEP_PART']}.csv", found)


def write_seconds(path: Path, found: dict[str, float]) -> None:
    """Of a test of each file, in the mean."""
    with path.open("w", encoding="utf-8", newline="") as file:
        rows = csv.writer(file, lineterminator="\n")
        rows.writerows(
            [("file", "seconds_per_test"), *((name, f"{found[name]:.3g}") for name in sorted(found))]
        )


def seconds_in(path: Path) -> dict[str, float]:
    """What ``write_seconds`` wrote."""
    if not path.exists():
        return {}
    with path.open(encoding="utf-8", newline="") as file:
        return {row["file"]: float(row["seconds_per_test"]) for row in csv.DictReader(file)}


def record() -> None:
    """Bring the table up to date, once all parts have run; until then they are cut as it stood."""
    parts_run = [FOLDER / f"part{part}.csv" for part in range(1, PARTS + 1)]
    if all(path.exists() for path in parts_run):
        found: dict[str, float] = {}
        for path in parts_run:
            found |= seconds_in(path)
            path.unlink()
        write_seconds(TABLE, found)


def parts(items: Sequence[pytest.Item]) -> list[list[pytest.Item]]:
    """All tests in their order, cut into parts of the same seconds."""
    known = seconds_in(TABLE)
    weights = [_seconds(item, known) for item in items]
    found: list[list[pytest.Item]] = [[] for _ in range(PARTS)]
    for item, weight, end in zip(items, weights, itertools.accumulate(weights), strict=True):
        middle = (end - 0.5 * weight) / sum(weights)
        found[min(int(middle * PARTS), PARTS - 1)].append(item)
    return found


def _seconds(item: pytest.Item, known: dict[str, float]) -> float:
    file = item.nodeid.partition("::")[0]
    if file in known:
        return max(known[file], 1e-3)
    if item.get_closest_marker("deep") is not None:
        return MARKED
    return DRAWN if getattr(getattr(item, "obj", None), "is_hypothesis_test", False) else OTHER


# The command.


def run(part: int) -> int:
    """Run a part and print a line about it; its exit code."""
    path = os.pathsep.join([str(Path(__file__).parent), os.environ.get("PYTHONPATH", "")])
    more = {"HYPOTHESIS_PROFILE": "deep", "DEEP_PART": str(part), "PYTHONPATH": path}
    words, begun = FOLDER / f"part{part}.txt", time.perf_counter()
    with words.open("w", encoding="utf-8") as file:
        command = [sys.executable, "-m", "pytest", "-vv", "-p", "deep", "--durations=30"]
        code = subprocess.run(
            command, cwd=PROJECT, env=os.environ | more, stdout=file, stderr=file
        ).returncode
    seconds = time.perf_counter() - begun
    lines = words.read_text(encoding="utf-8", errors="replace").splitlines() or [""]
    late = ", longer than it may" if seconds > LIMIT else ""
    end = "passed" if code in PASSED else f"failed ({words})"
    print(f"part {part} of {PARTS}: {seconds:.0f} s{late}, {end}: {lines[-1].strip('= ')}", flush=True)
    if code not in PASSED:
        print(*(f"  {line}" for line in lines if line.startswith(("FAILED", "ERROR"))), sep="\n", flush=True)
    return 0 if code in PASSED else FAILED


def main(arguments: Sequence[str]) -> int:
    """Run the parts named, or all."""
    if any(not word.isdigit() or not 1 <= int(word) <= PARTS for word in arguments):
        print(f"{' '.join(arguments)!r}: a part is a number from 1 to {PARTS}", file=sys.stderr)
        return 2
    FOLDER.mkdir(parents=True, exist_ok=True)
    code = max([run(part) for part in map(int, arguments or range(1, PARTS + 1))])
    record()
    return code


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
