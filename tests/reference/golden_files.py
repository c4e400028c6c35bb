"""Reads and writes the pinned numbers, for make_golden.py and tests/golden."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import Any

HERE = Path(__file__).parent
RESULTS, CURVES = HERE / "golden.csv", HERE / "golden_curves.csv"
CHANGES = HERE / "golden_changes.csv"

Rows = dict[str, dict[str, Any]]


def write(path: Path, rows: Rows) -> None:
    """A table with every column that any row has, empty cells left empty, numbers in full."""
    names = list(dict.fromkeys(name for row in rows.values() for name in row))
    with path.open("w", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(["key", *names])
        for key, row in rows.items():
            out.writerow([key, *(_cell(row.get(name, "")) for name in names)])


def _cell(value: Any) -> str:
    return value if isinstance(value, str) else repr(float(value))


def read(path: Path) -> Rows:
    """The same rows without their empty cells, numbers as floats."""
    with path.open(newline="") as file:
        return {
            row.pop("key"): {name: _value(text) for name, text in row.items() if text != ""}
            for row in csv.DictReader(file)
        }


def _value(text: str) -> Any:
    try:
        return float(text)
    except ValueError:
        return text
