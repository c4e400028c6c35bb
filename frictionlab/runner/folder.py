"""The folder of a run: its table, the study it answers, where it came from; written whole or not at all."""

from __future__ import annotations

import errno
import io
import json
import os
import secrets
import shlex
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pyarrow.parquet as pq

from frictionlab.faults import INTERNAL, MARK
from frictionlab.printable import printable
from frictionlab.results.csv_text import as_csv
from frictionlab.results.curve_table import CURVE_TEXT
from frictionlab.runner.arguments import Existing
from frictionlab.runner.errors import FolderError, SaveError
from frictionlab.runner.files import damage, remove_leftovers, stamp, stamp_of_file, stamps, write_whole
from frictionlab.runner.machine import machine_and_versions
from frictionlab.study.study import LAW_COPIES
from frictionlab.study.yaml_text import yaml_text

PAGE_MARK = '<meta name="generator" content="frictionlab'
MOST_DIFFERENCES = 2
"""Lines shown of each of two studies that differ."""
SHOWN = 72
"""Letters shown of such a line."""
SOLVER, ASKED = "solver", "asked"
"""Where a saved table holds the digest of the code that found it, and of what was asked for beside the numbers."""


@dataclass(frozen=True)
class Identity:
    """What a folder's results answer: the study, whole and as a digest of what determines its numbers.

    file: the name of the file it came from, for the record. code: SHA-256 by law, of those from outside.
    law_texts: its law files, by their names in the folder. marks: what its tables are marked with, a digest of all
    code that finds the numbers (``SOLVER``), and one of columns, order of rows and what is kept beside (``ASKED``).
    """

    study: dict[str, Any]
    digest: str
    version: str
    file: str | None = None
    code: Mapping[str, str] = field(default_factory=dict)
    law_texts: Mapping[str, str] = field(default_factory=dict)
    marks: Mapping[str, str] = field(default_factory=dict)

    @property
    def text(self) -> str:
        """The study as a study file."""
        return yaml_text(self.study)


@dataclass(frozen=True)
class RunFolder:
    """The output folder of one study."""

    path: Path
    identity: Identity

    @property
    def table(self) -> Path:
        """Where the table is."""
        return self.path / "results.parquet"

    @property
    def _study(self) -> Path:
        return self.path / "study.yaml"

    @property
    def _account(self) -> Path:
        return self.path / "provenance.json"

    @property
    def orbits_file(self) -> Path:
        """Where the kept orbits are."""
        return self.path / "orbits.parquet"

    @property
    def csv_file(self) -> Path:
        """Where the table is as text."""
        return self.path / "results.csv"

    @property
    def curves_file(self) -> Path:
        """Where the table of curves is."""
        return self.path / "curves.csv"

    @property
    def onsets_file(self) -> Path:
        """Where the table of onsets is."""
        return self.path / "onsets.csv"

    @property
    def attractors_file(self) -> Path:
        """Where the table of attractors is."""
        return self.path / "attractors.csv"

    @property
    def harmonics_file(self) -> Path:
        """Where the table of harmonics is."""
        return self.path / "harmonics.csv"

    def check(self, existing: Existing) -> None:
        """Raises FolderError where this run cannot be written, or would mix with another study."""
        nearest = next(place for place in [self.path, *self.path.absolute().parents] if place.exists())
        if not nearest.is_dir():
            raise FolderError(f"{self.path}: {nearest} is a file, not a folder; give another one with -o")
        if not os.access(nearest, os.W_OK | os.X_OK):
            raise FolderError(
                f"{self.path}: no permission to write in {nearest}; give another folder with -o"
            )
        if self._study.exists() and not self._account.exists() and not self.table.exists():
            raise FolderError(
                f"{self.path} holds a study.yaml that no run wrote; choose another folder with -o"
            )
        if existing == "reuse" and any(path.exists() for path in self._results()):
            self._check_same_study()
        self._check_law_files()

    def _check_law_files(self) -> None:
        """A copy of a law must not replace what a person wrote."""
        ours = self._copies()
        for name, text in self.identity.law_texts.items():
            place = self.path / name
            if place not in ours and place.exists() and place.read_bytes() != text.encode():
                raise FolderError(
                    f"{place} is in the way of the copy of a law that a run keeps; choose another folder with -o"
                )

    def _copies(self) -> list[Path]:
        """The copies of laws that the run in this folder kept."""
        try:
            names = self.account().get("plugins", [])
        except FolderError:  # without provenance.json the folder may not be a run
            names = []
        return [self.path / LAW_COPIES / Path(str(name)).name for name in names]

    def _check_same_study(self) -> None:
        there = self.account()
        if there.get("frictionlab") != self.identity.version:
            raise FolderError(
                f"{self.path} holds results of frictionlab {there.get('frictionlab')}, this is "
                f"{self.identity.version}; {REMEDY}"
            )
        if there.get("digest") != self.identity.digest:
            difference = self._difference()
            told = f":\n{difference}\n{REMEDY}" if difference else f"; {REMEDY}"
            raise FolderError(f"{self.path} holds results of another study{told}")

    def account(self) -> dict[str, Any]:
        """What provenance.json says. Raises FolderError where there is none."""
        try:
            found = json.loads(self._account.read_text(encoding="utf-8"))
            stamps(found)
        except (OSError, ValueError, AttributeError):
            found = None
        if not isinstance(found, dict):
            raise FolderError(
                f"{self.path} holds results, but no readable provenance.json; replace them: "
                f"{rerun(self.path)} --force, or choose another folder with -o"
            )
        return found

    def _difference(self) -> str:
        """The first lines in which the studies differ, for the message."""
        try:
            there = self._study.read_text(encoding="utf-8").splitlines()
        except (OSError, ValueError):
            return ""
        here = self.identity.text.splitlines()
        old, new = [line for line in there if line not in here], [line for line in here if line not in there]
        lines = [f"  there: {_brief(line, new)}" for line in old[:MOST_DIFFERENCES]]
        lines += [f"  here:  {_brief(line, old)}" for line in new[:MOST_DIFFERENCES]]
        return "\n".join(lines + self._edited())

    def _edited(self) -> list[str]:
        """The plugin laws whose code has changed."""
        there = self.account().get("code", {})
        laws = [law for law, code in self.identity.code.items() if there.get(law, code) != code]
        return [f"  the code of law '{law}' was edited since" for law in laws]

    def earlier(self, existing: Existing) -> pd.DataFrame | None:
        """The table of an earlier run of this study, without the points to try again; None without an intact one.

        Those are the points that failed by a defect, and all that failed where the code that finds numbers is
        another. Raises FolderError.
        """
        table = self._earlier(self.table, existing)
        if table is None or not {"status", "reason"} <= set(table):
            return table
        again = table["status"] == "failed"
        if table.attrs.get(SOLVER) == self.identity.marks.get(SOLVER):
            again &= table["reason"].astype("str").str.startswith((INTERNAL, MARK))
        return table[~again]

    def earlier_orbits(self, existing: Existing) -> pd.DataFrame | None:
        """The orbits kept by an earlier run of this study; None where they are not there or damaged."""
        return self._earlier(self.orbits_file, existing)

    def earlier_text(self, file: Path, existing: Existing) -> pd.DataFrame | None:
        """The table that an earlier run of this very study file wrote as text; None where missing or damaged."""
        if existing == "replace" or not file.exists() or self._damage(file.name):
            return None
        try:
            same = self._study.read_text(encoding="utf-8") == self.identity.text
        except (OSError, ValueError):
            return None
        return _read_text(file) if same else None

    def _earlier(self, path: Path, existing: Existing) -> pd.DataFrame | None:
        if existing == "replace" or not path.exists() or self._damage(path.name):
            return None
        return _parquet(path)

    def damaged(self) -> list[str]:
        """What is wrong with the files of an earlier run of this study, and what the next run does about it."""
        if not self._account.exists():
            return []
        what = {self.table.name: "its points are", self.orbits_file.name: "its points are"}
        found = {name: self._damage(name) for name in self._stamps()}
        return [
            f"{self.path / name} {wrong}; {what.get(name, 'it is')} made again"
            for name, wrong in found.items()
            if wrong
        ]

    def _damage(self, name: str) -> str:
        """What is wrong with a file of an earlier run; '' for an intact one. Raises FolderError."""
        path = self.path / name
        try:
            wrong = damage(path, self._stamps().get(name, []))
        except OSError as problem:
            raise FolderError(f"{path} cannot be read ({problem.strerror}); {REMEDY}") from problem
        known = self._stamps().get(name)
        if not wrong and not known and path.suffix == ".parquet" and path.exists() and _parquet(path) is None:
            return "is damaged: it is no table"
        return wrong

    def _stamps(self) -> dict[str, list[dict[str, Any]]]:
        """What the files of an earlier run are known to hold; nothing where that is not known."""
        with suppress(FolderError):
            return stamps(self.account())
        return {}

    def open(self, existing: Existing) -> None:
        """Create the folder; ``replace`` removes the results in it. Raises FolderError, SaveError."""
        try:
            self.path.mkdir(parents=True, exist_ok=True)
            remove_leftovers(self.path)
            remove_leftovers(self.path / LAW_COPIES)
            kept = self.identity.law_texts
            copies = [path for path in self._copies() if path.relative_to(self.path).as_posix() not in kept]
            # study.yaml before provenance.json: without it a study.yaml is treated as a user's own file.
            old = [*self._results(), *copies, self._study, self._account]
            for path in old if existing == "replace" else ():
                path.unlink(missing_ok=True)
        except OSError as problem:
            _refuse_folder(self.path, problem)

    @property
    def _tables(self) -> list[Path]:
        own = [self.table, self.orbits_file]
        return [*own, *self._texts]

    @property
    def _texts(self) -> list[Path]:
        return [self.csv_file, self.curves_file, self.onsets_file, self.attractors_file, self.harmonics_file]

    def _results(self) -> Iterator[Path]:
        yield from (*self._tables, self.path / "report.html")
        for pattern in ("*.svg", "*.png"):
            yield from (self.path / "figures").glob(pattern)

    def describe(self, runs: dict[str, Any], done: bool = False) -> None:
        """Write study.yaml and provenance.json. done: all files are as they stay. Raises SaveError."""
        for name in self.identity.law_texts:
            _make_folder((self.path / name).parent)
        provenance = {
            "frictionlab": self.identity.version,
            "study": self.identity.file,
            "digest": self.identity.digest,
            "code": dict(self.identity.code),
            "plugins": list(self.identity.law_texts),
            "unknown_code": self.unknown_code,
            **runs,
            **machine_and_versions(),
            "files": {path.name: [stamp_of_file(path)] for path in self._tables if path.exists()}
            if done
            else self._stamps_of_files(),
        }
        copies = {name: law.encode() for name, law in self.identity.law_texts.items()}
        provenance["files"] |= {name: [stamp(law)] for name, law in copies.items()}
        with suppress(FolderError):
            provenance |= {"pages": self.account()["pages"]} if "pages" in self.account() else {}
        # provenance.json first: a study.yaml without it is treated as a user's own file.
        self.write_account(provenance)
        for name, law in copies.items():
            write_whole(self.path / name, law)
        write_whole(self._study, self.identity.text.encode())

    def write_account(self, account: dict[str, Any]) -> None:
        """Write provenance.json. Raises SaveError."""
        write_whole(self._account, (json.dumps(account, indent=2) + "\n").encode())

    def _stamps_of_files(self) -> dict[str, list[dict[str, Any]]]:
        return {name: known for name, known in self._stamps().items() if (self.path / name).exists()}

    def know_only(self, paths: Iterable[Path] = (), new: Path | None = None) -> None:
        """Of the files of a run know these and a new one: a file that is about to be replaced is not known."""
        names = {path.name for path in paths}
        files = {
            name: known for name, known in self._stamps_of_files().items() if name in names or "/" in name
        }
        if new is not None:
            files[new.name] = [stamp_of_file(new)]
        with suppress(FolderError):  # somebody took the account away; the end of the run writes it again
            self.write_account(self.account() | {"files": files})

    @property
    def unknown_code(self) -> str:
        """What stands for code that is not known in the names of kept chunks: another in every folder."""
        found = None
        with suppress(FolderError):
            found = self.account().get("unknown_code")
        return str(found or secrets.token_hex(16))

    def previous_runs(self) -> list[dict[str, Any]]:
        """When and how long earlier runs of this study worked in this folder."""
        return list(self.account().get("runs", [])) if self.table.exists() else []

    def counts(self) -> dict[str, int]:
        """How many rows of an earlier run have each status. Raises FolderError."""
        return dict(self.account().get("counts", {}))

    def is_whole(self, as_csv: bool) -> bool:
        """Whether all that this run would write is there as it was written, by the same code and without a gap."""
        known = self._stamps()
        wanted = {self.table.name, *([self.csv_file.name] if as_csv else [])}
        if not wanted <= known.keys() or any(map(self._damage, known)):
            return False
        counts = self.counts()
        return (
            bool(counts)
            and not {"killed", "failed"} & counts.keys()
            and marks_of_file(self.table) == dict(self.identity.marks)
        )

    def save_text(self, path: Path, table: pd.DataFrame) -> None:
        """Write a table as text, floats in shortest round-trip form. Raises SaveError."""
        write_whole(path, as_csv(table))
        self.know_only(self._tables, path)

    def remove_texts(self) -> None:
        """Remove what was made from an earlier table. Raises SaveError."""
        for path in self._texts:
            try:
                path.unlink(missing_ok=True)
            except OSError as problem:
                raise SaveError(f"cannot replace {path}: {problem.strerror}") from problem

    def read_curves(self) -> pd.DataFrame:
        """The table of curves of an earlier run; empty where it has none."""
        found = self.read_text(self.curves_file)
        words = {name: pd.StringDtype(na_value=np.nan) for name in CURVE_TEXT}
        return pd.DataFrame() if found is None else found.astype(words)

    def read_text(self, path: Path) -> pd.DataFrame | None:
        """A table of an earlier run as text; None without an intact one."""
        known = path.name in self._stamps() and not self._damage(path.name)
        return _read_text(path) if known else None


REMEDY = "choose another folder with -o, or replace what is there with --force"


def rerun(folder: Path, study: str = "STUDY") -> str:
    """The command that runs a study into a folder."""
    return f"frictionlab run {study} -o {shlex.quote(str(folder))}"


def _parquet(path: Path) -> pd.DataFrame | None:
    """The table of a file; None for one that holds none."""
    try:
        return pd.read_parquet(io.BytesIO(path.read_bytes()))
    except Exception:  # a damaged file makes pyarrow raise whatever it stumbles over
        return None


def _read_text(path: Path) -> pd.DataFrame:
    return pd.read_csv(path, dtype={"how": "str"})  # "-1" is a word there


def marks_of_file(path: Path) -> dict[str, str]:
    """What a table is marked with; nothing for what is no table."""
    try:
        with path.open("rb") as opened:
            return dict(json.loads(pq.read_schema(opened).metadata[b"pandas"]).get("attributes", {}))
    except Exception:  # a damaged file makes pyarrow raise whatever it stumbles over
        return {}


def _brief(line: str, others: Sequence[str]) -> str:
    """Of a long line the part, from a word on, in which it leaves the line most like it."""
    if len(line.strip()) <= SHOWN:
        return line.strip()
    start = line.rfind(" ", 0, max(0, _equal(line, others) - SHOWN // 2)) + 1
    if line[:start].endswith(": "):  # a value without its key is unclear
        start = line.rfind(" ", 0, start - 1) + 1
    begins = f"{line.split(':')[0].strip()}: ... " if start else ""
    return f"{begins}{line[start : start + SHOWN].strip()}{' ...' if len(line) > start + SHOWN else ''}"


def _equal(line: str, others: Sequence[str]) -> int:
    """With how many letters one of the others begins like this line, at most."""
    shared = [[one == other for one, other in zip(line, text, strict=False)] for text in others]
    return max(([*same, False].index(False) for same in shared), default=0)


def check_page(path: Path) -> None:
    """Raises FolderError where a page is in the way that a person wrote."""
    try:
        ours = not path.exists() or PAGE_MARK in path.read_text(encoding="utf-8")
    except (OSError, ValueError):
        ours = False
    if not ours:
        raise FolderError(
            f"{path} is there already and was not written by frictionlab; choose another folder with -o"
        )


def write_page(path: Path, text: str) -> None:
    """Write a page. Raises SaveError."""
    with suppress(OSError):
        remove_leftovers(path.parent)
    write_whole(path, printable(text).encode())


def _make_folder(path: Path) -> None:
    try:
        path.mkdir(exist_ok=True)
    except OSError as problem:
        raise SaveError(f"cannot make the folder {path}: {problem.strerror}") from problem


def _refuse_folder(path: Path, problem: OSError) -> None:
    sentence = f"cannot make the folder {path}: {problem.strerror}"
    if problem.errno in (errno.ENOSPC, errno.EDQUOT, errno.EIO):
        raise SaveError(sentence) from problem
    raise FolderError(f"{sentence}; give another one with -o") from problem
