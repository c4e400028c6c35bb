"""Folder of a run: its table, the study it answers, where it came from; written whole or not at all."""

from __future__ import annotations

import errno
import hashlib
import os
from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pandas as pd

from frictionlab import __version__
from frictionlab.runner.arguments import Existing
from frictionlab.runner.files import (
    FolderError,
    SaveError,
    remove_leftovers,
    write_whole,
)
from frictionlab.runner.folder_files import FolderFiles, machine_and_versions
from frictionlab.runner.store import code_digest
from frictionlab.study.study import LAW_COPIES, Study
from frictionlab.study.written import yaml_text
from frictionlab.values.printable import printable

PAGE_MARK = '<meta name="generator" content="frictionlab'
MOST_DIFFERENCES = 2
"""Lines shown of each of two studies that differ."""
LETTERS_SHOWN = 72
"""Letters shown of such a line."""
SOLVER, ASKED = "solver", "asked"
"""Keys of an account: digests of the code that found the numbers, and of what was asked for beside them."""


@dataclass(frozen=True)
class Identity:
    """Question that a folder's results answer: the study, whole and as a digest of what determines its numbers.

    file: the name of the file it came from, for the record. code: SHA-256 by law, of those from outside.
    law_texts: its law files, by their names in the folder. marks: a digest of all code that finds the numbers
    (``SOLVER``), and one of columns, order of rows and what is kept beside (``ASKED``).
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
        """Return the study as a study file."""
        return yaml_text(self.study)


class RunFolder(FolderFiles):
    """Output folder of one study."""

    def __init__(self, path: Path, identity: Identity) -> None:
        super().__init__(path)
        self.identity = identity

    def check(self, existing: Existing) -> None:
        """Raises FolderError where this run cannot be written, or would mix with another study."""
        nearest = next(place for place in [self.path, *self.path.absolute().parents] if place.exists())
        if not nearest.is_dir():
            raise FolderError(f"{self.path}: {nearest} is a file, not a folder; give another one with -o")
        if not os.access(nearest, os.W_OK | os.X_OK):
            raise FolderError(
                f"{self.path}: no permission to write in {nearest}; give another folder with -o"
            )
        if self.study_file.exists() and not self.account_file.exists() and not self.table.exists():
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
        """Return the copies of laws that the run in this folder kept."""
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

    def _difference(self) -> str:
        """Return the first lines in which the studies differ, for the message."""
        try:
            there = self.study_file.read_text(encoding="utf-8").splitlines()
        except (OSError, ValueError):
            return ""
        here = self.identity.text.splitlines()
        old, new = [line for line in there if line not in here], [line for line in here if line not in there]
        lines = [f"  there: {_brief(line, new)}" for line in old[:MOST_DIFFERENCES]]
        lines += [f"  here:  {_brief(line, old)}" for line in new[:MOST_DIFFERENCES]]
        return "\n".join(lines + self._edited())

    def _edited(self) -> list[str]:
        """Return the plugin laws whose code has changed."""
        there = self.account().get("code", {})
        laws = [law for law, code in self.identity.code.items() if there.get(law, code) != code]
        return [f"  the code of law '{law}' was edited since" for law in laws]

    def damaged(self) -> list[str]:
        """Return what is wrong with the files of an earlier run of this study; the next run makes them again."""
        return [f"{self.path / name} {wrong}; it is made again" for name, wrong in self.damage().items()]

    def open(self, existing: Existing) -> None:
        """Create the folder; ``replace`` removes the results in it. Raises FolderError, SaveError."""
        try:
            self.path.mkdir(parents=True, exist_ok=True)
            remove_leftovers(self.path)
            remove_leftovers(self.path / LAW_COPIES)
            kept = self.identity.law_texts
            copies = [path for path in self._copies() if path.relative_to(self.path).as_posix() not in kept]
            # study.yaml before provenance.json: without it a study.yaml is treated as a user's own file.
            old = [*self._results(), *copies, self.study_file, self.account_file]
            for path in old if existing == "replace" else ():
                path.unlink(missing_ok=True)
        except OSError as problem:
            _refuse_folder(self.path, problem)

    def _results(self) -> Iterator[Path]:
        yield from (*self.tables, self.path / "report.html")
        for pattern in ("*.svg", "*.png"):
            yield from (self.path / "figures").glob(pattern)

    def describe(self, runs: dict[str, Any], done: bool = False) -> None:
        """Write study.yaml and provenance.json. done: all files are as they stay. Raises SaveError."""
        pages: dict[str, Any] = {}
        with suppress(FolderError):
            pages = self.account().get("pages", {})
        provenance = {
            "frictionlab": self.identity.version,
            "study": self.identity.file,
            "digest": self.identity.digest,
            "marks": dict(self.identity.marks),
            "code": dict(self.identity.code),
            "plugins": list(self.identity.law_texts),
            **runs,
            **machine_and_versions(),
            **(self.stamps() if done else {"table": "", "files": {}}),
            "pages": pages,
        }
        # provenance.json first: a study.yaml without it is treated as a user's own file.
        self.write_account(provenance)
        self.write_study()

    def write_study(self) -> None:
        """Write study.yaml and the copies of its law files. Raises SaveError."""
        for name, law in self.identity.law_texts.items():
            _make_folder((self.path / name).parent)
            write_whole(self.path / name, law.encode())
        write_whole(self.study_file, self.identity.text.encode())

    def add_text(self, path: Path, table: pd.DataFrame) -> None:
        """Write a table that is made once all others are there, and enter it in the account. Raises SaveError."""
        self.save_text(path, table)
        with suppress(FolderError):  # somebody took the account away
            self.write_account(self.account() | self.stamps())

    def previous_runs(self) -> list[dict[str, Any]]:
        """Return when and how long earlier runs of this study worked in this folder."""
        return list(self.account().get("runs", [])) if self.table.exists() else []

    def is_whole(self, as_csv: bool, kept: Collection[Path] = ()) -> bool:
        """Check that all that this run would write is there as it was written, by the same code and without a gap.

        kept: files that it writes beside the table.
        """
        try:
            account = self.account()
        except FolderError:
            return False
        wanted = {self.table.name, *(path.name for path in kept), *([self.csv_file.name] if as_csv else [])}
        return (
            wanted <= account["files"].keys()
            and not {"killed", "failed"} & account["counts"].keys()
            and account.get("marks") == dict(self.identity.marks)
            and not self.damage()
        )

    def remove_beside(self) -> None:
        """Remove what was made from an earlier table, or beside it. Raises SaveError."""
        for path in (self.orbits_file, *self.texts):
            try:
                path.unlink(missing_ok=True)
            except OSError as problem:
                raise SaveError(f"cannot replace {path}: {problem.strerror}") from problem


def run_folder(study: Study, out: Path) -> RunFolder:
    """Return the output folder of a study."""
    file = study.path.name if study.path is not None else None
    told = study.resolved(), study.digest(), __version__, file, study.code, study.law_texts()
    kept = study.keep.orbit, study.keep.harmonics, study.keep.attractors
    asked = repr((list(study.sweep), kept, sorted(study.selected()), *sorted(study.boundaries.items())))
    marks = {SOLVER: code_digest(study), ASKED: hashlib.sha256(asked.encode()).hexdigest()}
    return RunFolder(out, Identity(*told, marks=marks))


REMEDY = "choose another folder with -o, or replace what is there with --force"


def _brief(line: str, others: Sequence[str]) -> str:
    """Return the part of a long line, from a word on, in which it leaves the line most like it."""
    if len(line.strip()) <= LETTERS_SHOWN:
        return line.strip()
    differs = _equal(line, others)
    start = line.rfind(" ", 0, max(0, differs - LETTERS_SHOWN // 2)) + 1
    if line[:start].endswith(": "):  # a value without its key is unclear
        start = line.rfind(" ", 0, start - 1) + 1
    begins = f"{line.split(':')[0].strip()}: ... " if line[:start].strip() else ""
    stop = max(start + LETTERS_SHOWN, differs + LETTERS_SHOWN // 4)
    return f"{begins}{line[start:stop].strip()}{' ...' if len(line) > stop else ''}"


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
