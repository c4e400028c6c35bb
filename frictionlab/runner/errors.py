"""What can go wrong with the folder of a run, and with files begun anew."""

from __future__ import annotations

from pathlib import Path


class FolderError(Exception):
    """The run cannot be written to this folder; the message says why and gives a remedy. Nothing was written."""


class SaveError(Exception):
    """The results could not be written, for want of room or of a working disk."""


def not_written(path: Path, problem: OSError) -> FolderError | SaveError:
    """Why what is begun anew could not be written there, and what to do."""
    if isinstance(problem, FileExistsError):
        return FolderError(f"{path} is there already and stays as it is; choose another name")
    if isinstance(problem, FileNotFoundError | NotADirectoryError):
        return FolderError(f"{path}: there is no folder {path.parent}; make it first, or choose another")
    if isinstance(problem, PermissionError):
        return FolderError(f"{path}: no permission to write in {path.parent}; choose another folder")
    return SaveError(f"cannot write {path}: {problem.strerror}")


class NoScheduler(Exception):
    """There is no cluster to send chunks to; the message says why."""
