"""One study or a folder of them, read and checked as a whole before the first is run."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NamedTuple

from frictionlab.runner.api import run_folder
from frictionlab.runner.arguments import Existing
from frictionlab.runner.errors import FolderError
from frictionlab.runner.folder import check_page
from frictionlab.runner.in_use import check_free
from frictionlab.study import Mistake, Plugins, Study, StudyError, load_study


class Job(NamedTuple):
    """A study, the name it goes by, and the folder its results go to."""

    name: str
    study: Study
    out: Path


def jobs(
    path: Path,
    out: Path | None,
    overrides: Sequence[str],
    law_files: Sequence[Path] = (),
    plugins: Plugins = "run",
) -> list[Job]:
    """The studies of a file or of a folder's ``*.yaml``. Raises StudyError with all their mistakes, BrokenPlugin.

    plugins: whether law files that a study itself lists are run, or refused.
    """
    folder = _folder(path, out)
    if not path.is_dir():
        return [Job(path.stem, load_study(path, overrides, law_files, plugins), folder)]
    files = sorted(path.glob("*.yaml"))
    if not files:
        raise StudyError([Mistake(str(path), None, "", "a folder without studies: no *.yaml in it")])
    studies = _all_read(files, lambda file: load_study(file, overrides, law_files, plugins))
    return [Job(file.stem, study, folder / file.stem) for file, study in zip(files, studies, strict=True)]


def index_folder(path: Path, out: Path | None) -> Path | None:
    """Where a folder of studies gets its index; None for a single study. Raises FolderError."""
    if not path.is_dir():
        return None
    folder = _folder(path, out)
    check_page(folder / "index.html")
    return folder


def _folder(path: Path, out: Path | None) -> Path:
    return out or Path("runs") / path.absolute().stem


def _all_read(files: Sequence[Path], read: Callable[[Path], Study]) -> list[Study]:
    studies: list[Study] = []
    mistakes: list[Mistake] = []
    for file in files:
        try:
            studies.append(read(file))
        except StudyError as problem:
            mistakes += problem.mistakes
    if mistakes:
        raise StudyError(mistakes)
    return studies


def check_folders(found: Sequence[Job], existing: Existing, alone: bool = True) -> None:
    """Raises FolderError with every folder to which its study cannot be written.

    alone: also where another run is at work in it; parts of a run work side by side.
    """
    problems = []
    for job in found:
        try:
            run_folder(job.study, job.out).check(existing)
            if alone:
                check_free(job.out)
        except FolderError as problem:
            problems.append(str(problem))
    if problems:
        raise FolderError("\n".join(problems))
