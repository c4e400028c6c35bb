"""Compares every number of some 570 scenes with what it was when tests/reference/make_golden.py wrote it down.

The groups of scenes are spread over the test files beside this one by what laws remember and by dimension, for both
of which kernels are compiled: two files that run at once compile next to nothing twice.

Statuses and kinds of error are compared exactly, numbers to ``ROUNDING``, absolute and relative; sentences (reason,
model) are kept in the tables and not compared. A column that has come since is not compared either.

A row whose path of computation was changed on purpose is listed in tests/reference/golden_changes.csv: ``key`` (a
pattern of fnmatch), ``reason``, and ``status`` where that is another one now, or the same with a larger error. Such
a row must agree with the old one within the errors of both; without a status it must state no more than twice the old
error, and keep its other columns to ``LOOSE`` and ten times its error. One that was not ok and is listed with a new
status is compared no further, and neither are the numbers of its curve but for their verdicts.
"""

from __future__ import annotations

import csv
import math
import sys
from collections.abc import Callable
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any

import pytest

sys.path.append(str(Path(__file__).parents[1] / "reference"))

import golden_files
import golden_scenes
from profiles import deep, some

ROUNDING, LOOSE = 1e-11, 1e-6
"""Two compilations of the same code on one machine differ by up to 6e-13 (measured, Dahl friction on the line): LLVM
orders what it inlines by names that hold a number of the process."""
VERDICTS = "shape", "shape_by_initial"
SLACK: dict[str, float] = {"floquet": 1e-9, "error_N": 1e-8}
"""Columns that are compared no closer than this, absolute and relative: multipliers are difference quotients of the
period map, errors the difference of two maps, and machine code rounds otherwise when functions only change their
names or files (measured, planar Coulomb friction: 1.5e-10, 1.6e-9 N)."""
OLD = {"results": golden_files.read(golden_files.RESULTS), "curves": golden_files.read(golden_files.CURVES)}
KNOWN = {name for rows in OLD.values() for row in rows.values() for name in row} - {"reason", "model"}
"""Columns that are compared: those of the day the tables were made, but for sentences."""
slow = deep("kernels slow to compile")


def changes() -> list[dict[str, str]]:
    """The rows whose path of computation was changed: key, reason, status, columns."""
    if not golden_files.CHANGES.exists():
        return []
    with golden_files.CHANGES.open(newline="") as file:
        return [
            {"status": "", "columns": "", **{name: text or "" for name, text in row.items()}}
            for row in csv.DictReader(file)
        ]


CHANGES = changes()


def change_of(key: str) -> dict[str, str] | None:
    """The first change that names this row and not only columns of it."""
    return next(
        (change for change in CHANGES if fnmatchcase(key, change["key"]) and not change["columns"]), None
    )


def without_moved(key: str, row: dict[str, Any]) -> dict[str, Any]:
    """A row without the columns that a change names."""
    named = [change["columns"].split() for change in CHANGES if fnmatchcase(key, change["key"])]
    return {name: cell for name, cell in row.items() if not any(name in columns for columns in named)}


def apart(old: float, new: float, slack: float) -> bool:
    """Whether two numbers differ by more than the slack, absolute and relative."""
    if not (math.isfinite(old) and math.isfinite(new)):
        return old != new
    return abs(new - old) > slack * max(1.0, abs(old), abs(new))


def differs(column: str, old: Any, new: Any) -> bool:
    """Whether a cell is another one: None where it is empty."""
    if isinstance(old, float) and isinstance(new, int | float):
        return apart(old, float(new), SLACK.get(column, ROUNDING))
    return bool(old != new)


def line(key: str, column: str, old: Any, new: Any) -> str:
    """What is told of a cell that differs."""
    return (
        f"{key}: {column}: {'empty' if old is None else repr(old)} -> {'empty' if new is None else repr(new)}"
    )


def different(key: str, old: dict[str, Any], new: dict[str, Any]) -> list[str]:
    """The cells of a row that are not what they were: all that were told, and those of old columns told now."""
    names = [name for name in dict.fromkeys((*old, *new)) if name in KNOWN]
    return [
        line(key, name, old.get(name), new.get(name))
        for name in names
        if differs(name, old.get(name), new.get(name))
    ]


def disagrees(key: str, old: dict[str, Any], new: dict[str, Any], status: str) -> list[str]:
    """The cells of a row of another path of computation that are not what they must be."""
    wanted = status or old["status"]
    if new["status"] != wanted:
        return [line(key, "status", wanted, new["status"])]
    if status and "ok" not in (old["status"], status):
        return []
    found, error = [], float(new.get("error", math.nan))
    before = float(old.get("error", math.nan))
    if (
        abs(float(new.get("mean_friction", math.nan)) - float(old.get("mean_friction", math.nan)))
        > error + before
    ):
        found.append(line(key, "mean_friction", old["mean_friction"], new["mean_friction"]))
    if not status and error > 2.0 * before:
        found.append(line(key, "error", before, error))
    if status:
        return found
    slack = LOOSE + (10.0 * error if math.isfinite(error) else 0.0)
    for name in old:
        number = isinstance(old[name], float) and name not in ("mean_friction", "error", "error_N")
        if number and apart(old[name], float(new.get(name, math.nan)), slack):
            found.append(line(key, name, old[name], new.get(name)))
    return found


def curve_disagrees(key: str, old: dict[str, Any], new: dict[str, Any]) -> list[str]:
    """What is not as it must be of a curve with points of another path of computation."""
    found = [
        line(key, name, old.get(name), new.get(name)) for name in VERDICTS if old.get(name) != new.get(name)
    ]
    if points_came(key):
        return found
    for name in (name for name in old if f"{name}_error" in old):
        errors = old[f"{name}_error"] + float(new.get(f"{name}_error", math.nan))
        if not abs(old[name] - float(new.get(name, math.nan))) <= errors:
            found.append(line(key, name, old[name], new.get(name)))
    return found


def points_of(key: str) -> list[str]:
    """The points of a curve: those of the same group, law and method."""
    of_curve = "/".join(key.split("/")[:3]) + "/"
    return [point for point in OLD["results"] if point.startswith(of_curve)]


def changed_points(key: str) -> bool:
    """Whether a curve or any of its points is listed as changed."""
    return any(change_of(each) for each in (key, *points_of(key)))


def points_came(key: str) -> bool:
    """Whether a point of a curve is listed with another status: its numbers are then those of other points."""
    changes = ((OLD["results"][point]["status"], change_of(point)) for point in points_of(key))
    return any(change["status"] not in ("", before) for before, change in changes if change is not None)


def compared(old: golden_files.Rows, new: golden_files.Rows) -> list[str]:
    """Every cell of these rows that is not as it must be, and rows that came or went."""
    found = [f"{key}: the row is gone" for key in old if key not in new]
    found += [f"{key}: a new row; make the tables anew for its group" for key in new if key not in old]
    for key in old.keys() & new.keys():
        change = change_of(key)
        if "status" not in old[key] and changed_points(key):
            found += curve_disagrees(key, old[key], new[key])
            continue
        before, now = without_moved(key, old[key]), without_moved(key, new[key])
        if change is not None and "status" in before:
            found += disagrees(key, before, now, change["status"])
        else:
            found += different(key, before, now)
    return sorted(found)


def of_group(rows: golden_files.Rows, name: str) -> golden_files.Rows:
    """The rows of one group."""
    return {key: row for key, row in rows.items() if key.split("/")[0] == name}


def comparing(*families: str) -> Callable[[str], None]:
    """The test of the groups of these families."""
    groups = [group for group in golden_scenes.GROUPS if group.family in families]
    names = [pytest.param(group.name, marks=slow if group.deep else ()) for group in groups]

    @some(4, "rows of many scenes each")
    @pytest.mark.parametrize("name", names)
    def test(name: str) -> None:
        results, curves = golden_scenes.solved(name)

        found = compared(of_group(OLD["results"], name), results)
        found += compared(of_group(OLD["curves"], name), curves)

        print(*found, sep="\n")
        assert not found, f"{len(found)} cells differ, key: column: old -> new:\n" + "\n".join(found)

    return test
