"""Files in the folder of a run, and its account, which knows the table by its checksum and all by their length.

The machine and the versions of packages with which numbers are made.
"""

from __future__ import annotations

import hashlib
import json
import os
import platform
import shlex
from collections.abc import Iterable
from contextlib import suppress
from importlib.metadata import version
from pathlib import Path
from typing import Any

import pandas as pd

from frictionlab.runner.csv_text import as_csv
from frictionlab.runner.files import FolderError, write_whole
from frictionlab.study.study import LAW_COPIES

PACKAGES = ("numpy", "numba", "llvmlite", "pandas", "pyarrow", "pydantic", "scipy")


def machine_and_versions(packages: Iterable[str] = PACKAGES) -> dict[str, Any]:
    """Python, platform, processor, and the version of every package that is installed."""
    return {
        "python": platform.python_version(),
        "platform": platform.platform(),
        "processor": _processor(),
        "packages": {name: found for name in packages if (found := _version(name))},
    }


def cores() -> int:
    """Return how many processor cores this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _processor() -> str:
    """Its name, where the machine tells it."""
    with suppress(OSError, ValueError):
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
        names = (line.partition(":")[2].strip() for line in lines if line.startswith("model name"))
        return next(names, "") or platform.processor() or platform.machine()
    return platform.processor() or platform.machine()


def _version(name: str) -> str | None:
    try:
        return version(name)
    except ModuleNotFoundError:  # PackageNotFoundError is one
        return None


EMPTY_ACCOUNT = {"expect": [], "runs": [], "packages": {}, "code": {}, "files": {}, "counts": {}, "table": ""}
"""Parts of every provenance.json."""


class FolderFiles:
    """Files of a run by what they hold. tables: those that are read again."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.study_file, self.account_file = path / "study.yaml", path / "provenance.json"
        self.table, self.orbits_file = path / "results.parquet", path / "orbits.parquet"
        names = "results", "curves", "onsets", "attractors", "harmonics", "boundaries"
        self.texts = [path / f"{name}.csv" for name in names]
        self.csv_file, self.curves_file, self.onsets_file, *more = self.texts
        self.attractors_file, self.harmonics_file, self.boundaries_file = more
        self.tables = [self.table, self.orbits_file, *self.texts]

    def account(self) -> dict[str, Any]:
        """Return what provenance.json says. Raises FolderError where it is not the account of a run."""
        try:
            whole = EMPTY_ACCOUNT | json.loads(self.account_file.read_text(encoding="utf-8"))
            sound = (
                all(isinstance(each["sentence"], str) and "passed" in each for each in whole["expect"])
                and all(isinstance(run["seconds"], float | int) for run in whole["runs"])
                and all(isinstance(whole[name], dict) for name in ("packages", "code", "files", "counts"))
            )
        except (OSError, ValueError, TypeError, KeyError):
            sound = False
        if not sound:
            what = f"{self.account_file} is not the account of a run; run the study again"
            raise FolderError(f"{what}: {rerun(self.path)} --force, or choose another folder with -o")
        return whole

    def write_account(self, account: dict[str, Any]) -> None:
        """Write provenance.json. Raises SaveError."""
        write_whole(self.account_file, (json.dumps(account, indent=2) + "\n").encode())

    def stamps(self) -> dict[str, Any]:
        """Return the checksum of the table, and how long its other files are, as an account holds them."""
        files = [*self.tables, *(self.path / LAW_COPIES).glob("*.py")]
        there = {
            path.relative_to(self.path).as_posix(): path.stat().st_size for path in files if path.exists()
        }
        return {"table": checksum(self.table), "files": there}

    def damage(self) -> dict[str, str]:
        """Return what is wrong with files that a run wrote, by their names."""
        with suppress(FolderError):
            account = self.account()
            wrong = {name: _wrong_size(self.path / name, size) for name, size in account["files"].items()}
            name = self.table.name
            if not wrong.get(name) and account["table"] and checksum(self.table) != account["table"]:
                wrong[name] = "is damaged: its bytes are not those that were written"
            return {name: told for name, told in wrong.items() if told}
        return {}

    def save_text(self, path: Path, table: pd.DataFrame) -> None:
        """Write a table as text, floats in shortest round-trip form. Raises SaveError."""
        write_whole(path, as_csv(table))

    def read_text(self, path: Path) -> pd.DataFrame | None:
        """Return a table that was written as text; None where there is none. Raises FolderError."""
        try:
            return pd.read_csv(path, dtype={"how": "str"}) if path.exists() else None  # "-1" is a word there
        except pd.errors.EmptyDataError:
            return None
        except (OSError, ValueError) as problem:
            reason = str(problem).partition("\n")[0]
            told = f"{path} cannot be read ({reason}); run the study again"
            raise FolderError(f"{told}: {rerun(self.path)} --force") from problem


def _wrong_size(path: Path, size: int) -> str:
    """Return what is wrong with a file of so many bytes; '' for nothing that its length tells."""
    try:
        found = path.stat().st_size
    except FileNotFoundError:
        return "is missing"
    except OSError as problem:
        return f"cannot be read ({problem.strerror})"
    return "" if found == size else f"is damaged: it has {found} bytes, and {size} were written"


def checksum(path: Path) -> str:
    """Return the SHA-256 of a file, which need not fit into memory; '' for one that cannot be read."""
    try:
        with path.open("rb") as file:
            return hashlib.file_digest(file, "sha256").hexdigest()
    except OSError:
        return ""


def rerun(folder: Path, study: str = "STUDY") -> str:
    """Return the command that runs a study into a folder."""
    return f"frictionlab run {study} -o {shlex.quote(str(folder))}"
