"""The files in the folder of a run, and its account, which knows them by length and checksum.

The machine and the versions of packages with which numbers are made.
"""

from __future__ import annotations

import io
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
from frictionlab.runner.files import FolderError, stamp_of_file, write_whole

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
    """How many processor cores this process may use."""
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


Stamp = dict[str, Any]
"""Length and checksum of a file."""


class FolderFiles:
    """The files of a run by what they hold. tables: those that are read again."""

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
        """What provenance.json says. Raises FolderError where it is not the account of a run."""
        try:
            told = json.loads(self.account_file.read_text(encoding="utf-8"))
            whole = {"expect": [], "runs": [], "packages": {}, "code": {}, "files": {}} | told
            sound = (
                all(isinstance(each["sentence"], str) and "passed" in each for each in whole["expect"])
                and all(isinstance(run["seconds"], float | int) for run in whole["runs"])
                and all(isinstance(whole[name], dict) for name in ("packages", "code", "files"))
                and all(isinstance(known[-1]["bytes"], int) for known in whole["files"].values())
                and all("sha256" in known[-1] for known in whole["files"].values())
            )
        except (OSError, ValueError, TypeError, KeyError, IndexError, AttributeError):
            sound = False
        if not sound:
            what = f"{self.account_file} is not the account of a run; run the study again"
            raise FolderError(f"{what}: {rerun(self.path)} --force, or choose another folder with -o")
        return whole

    def write_account(self, account: dict[str, Any]) -> None:
        """Write provenance.json. Raises SaveError."""
        write_whole(self.account_file, (json.dumps(account, indent=2) + "\n").encode())

    def stamps(self) -> dict[str, Stamp]:
        """By file, what it was written with; nothing where that is not known."""
        with suppress(FolderError):
            return {name: known[-1] for name, known in self.account()["files"].items()}
        return {}

    def know_only(self, paths: Iterable[Path] = (), new: Path | None = None) -> None:
        """Of the tables of a run know these and a new one: a file that is about to be replaced is not known."""
        names = {path.name for path in paths if path.exists()}
        kept = {name: [known] for name, known in self.stamps().items() if name in names or "/" in name}
        files = kept | ({} if new is None else {new.name: [stamp_of_file(new)]})
        with suppress(FolderError):  # somebody took the account away; the end of the run writes it again
            self.write_account(self.account() | {"files": files})

    def damage(self, name: str) -> str:
        """What is wrong with a file; '' for an intact one."""
        path, known = self.path / name, self.stamps().get(name)
        try:
            if known is None:  # written before files had stamps, or by a run that was killed then
                torn = path.suffix == ".parquet" and path.exists() and read_parquet(path) is None
                return "is damaged: it is no table" if torn else ""
            if not path.exists():
                return "is missing"
            found = stamp_of_file(path)
        except OSError as problem:
            return f"cannot be read ({problem.strerror})"
        if found["bytes"] != known["bytes"]:
            return f"is damaged: it has {found['bytes']} bytes, and {known['bytes']} were written"
        return "" if found == known else "is damaged: its bytes are not those that were written"

    def save_text(self, path: Path, table: pd.DataFrame) -> None:
        """Write a table as text, floats in shortest round-trip form. Raises SaveError."""
        write_whole(path, as_csv(table))
        self.know_only(self.tables, path)

    def read_text(self, path: Path) -> pd.DataFrame | None:
        """A table that an earlier run wrote as text; None where there is none. Raises FolderError."""
        try:
            return pd.read_csv(path, dtype={"how": "str"}) if path.exists() else None  # "-1" is a word there
        except pd.errors.EmptyDataError:
            return None
        except (OSError, ValueError) as problem:
            reason = str(problem).partition("\n")[0]
            told = f"{path} cannot be read ({reason}); run the study again"
            raise FolderError(f"{told}: {rerun(self.path)} --force") from problem


def rerun(folder: Path, study: str = "STUDY") -> str:
    """The command that runs a study into a folder."""
    return f"frictionlab run {study} -o {shlex.quote(str(folder))}"


def read_parquet(path: Path) -> pd.DataFrame | None:
    """The table of a file; None for one that holds none."""
    try:
        return pd.read_parquet(io.BytesIO(path.read_bytes()))
    except Exception:  # a damaged file makes pyarrow raise whatever it stumbles over
        return None
