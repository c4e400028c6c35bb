"""Figures and report of a run: whether they are there as they would be made again."""

from __future__ import annotations

import hashlib
from importlib.metadata import version
from pathlib import Path

from frictionlab.runner.folder import RunFolder, run_folder
from frictionlab.runner.results import Results
from frictionlab.runner.store import BESIDE_A_PIECE, own_code

MADE_BY = "charts", "report"
"""Rooms of frictionlab that make them."""


def pages_are_there(done: Results, every_point: bool) -> bool:
    """Check whether an earlier run made the same pages of the same tables and nobody changed them since."""
    folder = _folder(done)
    known = folder.account().get("pages", {})
    return known == {"made_of": _made_of(folder, done, every_point), "files": _files(folder.path)}


def know_pages(done: Results, every_point: bool) -> None:
    """Enter the pages in the account of their run. Raises SaveError, FolderError."""
    folder = _folder(done)
    made_of = _made_of(folder, done, every_point)
    folder.write_account(folder.account() | {"pages": {"made_of": made_of, "files": _files(folder.path)}})


def _folder(done: Results) -> RunFolder:
    assert done.folder is not None
    return run_folder(done.study, done.folder)


def _made_of(folder: RunFolder, done: Results, every_point: bool) -> str:
    """A digest of the tables, the study and the code that pages are made of."""
    code = own_code(), own_code(tuple(sorted(BESIDE_A_PIECE - {*MADE_BY}))), version("matplotlib")
    account = folder.account()
    told = [account.get("table"), account.get("runs"), folder.identity.text, every_point, done.counts, code]
    return hashlib.sha256(repr(told).encode()).hexdigest()


def _files(folder: Path) -> dict[str, int]:
    found = [*folder.glob("figures/*"), *folder.glob("report.html")]
    return {path.relative_to(folder).as_posix(): path.stat().st_size for path in sorted(found)}
