"""Reads and writes the pinned numbers, and says where they were made; for make_golden.py and tests/golden."""

from __future__ import annotations

import csv
import json
import platform
from pathlib import Path
from typing import Any

import llvmlite
import llvmlite.binding
import numba
import numpy as np

HERE = Path(__file__).parent
RESULTS, CURVES = HERE / "golden.csv", HERE / "golden_curves.csv"
MADE_ON, CHANGES = HERE / "golden_made_on.json", HERE / "golden_changes.csv"

Rows = dict[str, dict[str, Any]]


def this_machine() -> dict[str, str]:
    """What rounding depends on: the processor as LLVM sees it, and the versions that make machine code."""
    return {
        "platform": platform.system(),
        "machine": platform.machine(),
        "cpu": str(llvmlite.binding.get_host_cpu_name()),
        "python": ".".join(platform.python_version_tuple()[:2]),
        "numba": numba.__version__,
        "llvmlite": llvmlite.__version__,
        "numpy": np.__version__,
    }


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


def write_machine() -> None:
    """Say which machine wrote the tables."""
    MADE_ON.write_text(json.dumps(this_machine(), indent=2) + "\n")


def made_here() -> bool:
    """Whether this machine rounds as the one that wrote the tables."""
    return bool(json.loads(MADE_ON.read_text()) == this_machine())
