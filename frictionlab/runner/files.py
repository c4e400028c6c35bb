"""Files of a run: written whole or not at all, and known again by their length and checksum."""

from __future__ import annotations

import hashlib
import os
import re
from contextlib import suppress
from pathlib import Path
from typing import Any

from frictionlab.runner.errors import SaveError

_TEMPORARY = re.compile(
    r"\.(?:results\.parquet|orbits\.parquet|.+\.(?:call|chunk|csv|html|json|py|yaml))\.(?P<process>\d+)"
)


def write_whole(path: Path, content: bytes) -> None:
    """Beside the place, then renamed into it: a crash leaves the old file or the new one. Raises SaveError."""
    temporary = path.with_name(f".{path.name}.{os.getpid()}")
    try:
        temporary.write_bytes(content)
        os.replace(temporary, path)
    except BaseException as problem:
        with suppress(OSError):
            temporary.unlink(missing_ok=True)
        if isinstance(problem, OSError):
            raise SaveError(f"cannot write {path}: {problem.strerror or problem}") from problem
        raise


def remove_leftovers(folder: Path) -> None:
    """Remove what killed processes had begun to write in a folder; that of running ones stays. Raises OSError."""
    if not folder.is_dir():
        return
    for path in folder.iterdir():
        found = _TEMPORARY.fullmatch(path.name)
        if found and not _is_running(int(found["process"])):
            path.unlink(missing_ok=True)


def _is_running(process: int) -> bool:
    """Whether it is another process that still runs."""
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


def stamp(content: bytes) -> dict[str, Any]:
    """Length and SHA-256 of a file, as an account holds them."""
    return {"bytes": len(content), "sha256": hashlib.sha256(content).hexdigest()}


def stamp_of_file(path: Path) -> dict[str, Any]:
    """The stamp of what a file holds, which need not fit into memory. Raises OSError."""
    with path.open("rb") as file:
        checksum = hashlib.file_digest(file, "sha256").hexdigest()
        return {"bytes": file.tell(), "sha256": checksum}
