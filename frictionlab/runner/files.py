"""Files of a run: written whole or not at all, and known again by their length and checksum.

What can go wrong with the folder of a run, and with files begun anew.

One run at a time in a folder: a lock that the system drops with the process that holds it, however that ends.
"""

from __future__ import annotations

import contextlib
import os
import platform
import re
import threading
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any


class FolderError(Exception):
    """Run cannot be written to this folder; the message says why and gives a remedy. Nothing was written."""


class SaveError(Exception):
    """Results could not be written, for want of room or of a working disk."""


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
    """There is no cluster to send pieces to; the message says why."""


_TEMPORARY = re.compile(
    rf"\.(?:.+\.(?:csv|html|json|parquet|py|yaml))\.{re.escape(platform.node())}\.\d+\.(?P<process>\d+)"
)


def unfinished(path: Path, process: int) -> Path:
    """Return the place of a file while this thread of a process writes it."""
    return path.with_name(f".{path.name}.{platform.node()}.{threading.get_ident()}.{process}")


@contextlib.contextmanager
def written_whole(path: Path) -> Iterator[Any]:
    """Give a file to write beside the place, then rename it into that: a crash leaves the old file or the new one.

    Raises SaveError.
    """
    temporary = unfinished(path, os.getpid())
    try:
        with temporary.open("wb") as file:
            yield file
        os.replace(temporary, path)
    except BaseException as problem:
        with suppress(OSError):
            temporary.unlink(missing_ok=True)
        if isinstance(problem, OSError):
            raise SaveError(f"cannot write {path}: {problem.strerror or problem}") from problem
        raise


def write_whole(path: Path, content: bytes) -> None:
    """Write a file whole or not at all. Raises SaveError."""
    with written_whole(path) as file:
        file.write(content)


def remove_leftovers(folder: Path) -> None:
    """Remove what killed processes had begun to write in a folder; that of running ones stays. Raises OSError."""
    if not folder.is_dir():
        return
    for path in folder.iterdir():
        found = _TEMPORARY.fullmatch(path.name)
        if found and not _is_running(int(found["process"])):
            path.unlink(missing_ok=True)


def _is_running(process: int) -> bool:
    """Check whether it is another process that still runs."""
    if process == os.getpid():
        return False
    if os.name == "nt":  # to ask there is to interrupt
        return True
    try:
        os.kill(process, 0)
    except (ProcessLookupError, OverflowError):
        return False
    except OSError:  # it is somebody else's
        return True
    return True


MARK_FILE = ".running"
"""In the folder while somebody works in it, and locked; one without a lock is left by a killed run."""


@contextlib.contextmanager
def alone_in(folder: Path, make: bool = True) -> Iterator[None]:
    """Within, no other process and no other thread works in the folder.

    make: the folder, where it is missing; it goes again where nothing was put there. Where files cannot be locked or
    written, none is: what is written there then says what is wrong. Raises FolderError where another run is at work.
    """
    from filelock import FileLock, Timeout  # takes a moment, of runs alone

    key = folder.absolute()
    # one lock a folder, which knows its thread again; its owner may be giving it back at this moment
    lock = FileLock(key / MARK_FILE, timeout=0.1, is_singleton=True)
    if lock.is_locked or not (make or key.is_dir()):
        yield
        return
    made = [place for place in [key, *key.parents] if not place.exists()]
    try:
        lock.acquire()  # makes the folder, too
    except Timeout:
        other = ", or choose another folder with -o" if make else ""
        raise FolderError(f"{folder} is in use by another run; wait until it has ended{other}") from None
    except (OSError, NotImplementedError):
        pass
    try:
        yield
    finally:
        if lock.is_locked:
            with suppress(OSError):  # on Windows the library removes it
                (key / MARK_FILE).unlink()
            lock.release()
        with suppress(OSError):  # nothing was written
            for place in made:
                place.rmdir()


def check_free(folder: Path) -> None:
    """Raises FolderError where another run works in the folder."""
    if (folder / MARK_FILE).exists():
        with alone_in(folder):
            pass
