"""What long calls of methods have found for points under way: an interrupted run loses those it is at, not the rest.

Kept beside the chunks, in a folder for each chunk that is gone once the chunk is solved. A call is found by all that
its answer hangs on, so answers never hang on when a run was interrupted.
"""

from __future__ import annotations

import hashlib
import io
import pickle
import shutil
from contextlib import suppress
from enum import StrEnum
from pathlib import Path
from typing import Any

from frictionlab.runner.errors import SaveError
from frictionlab.runner.files import write_whole

_CHECKSUM = hashlib.sha256().digest_size
_OF_ARRAYS = {"_reconstruct", "_frombuffer", "ndarray", "dtype", "scalar"}
"""What numpy's arrays and numbers are read by."""


class KeptCalls:
    """Those of one chunk, in a folder."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder

    def found(self, digest: str) -> Any:
        """What a call found; None where it is not kept, or the file is damaged."""
        try:
            content = self._path(digest).read_bytes()
        except OSError:
            return None
        checksum, pickled = content[:_CHECKSUM], content[_CHECKSUM:]
        if checksum != hashlib.sha256(pickled).digest():
            return None
        with suppress(pickle.UnpicklingError):
            return _Records(io.BytesIO(pickled)).load()
        return None

    def keep(self, digest: str, found: Any) -> None:
        """Where the disk takes it, and the chunks have a place: another machine may have none."""
        if self._folder.parent.parent.is_dir():
            pickled = pickle.dumps(found, pickle.HIGHEST_PROTOCOL)
            with suppress(OSError, SaveError):
                self._folder.mkdir(parents=True, exist_ok=True)
                write_whole(self._path(digest), hashlib.sha256(pickled).digest() + pickled)

    def remove(self) -> None:
        """All of them."""
        shutil.rmtree(self._folder, ignore_errors=True)

    def _path(self, digest: str) -> Path:
        return self._folder / f"{digest}.call"


class _Records(pickle.Unpickler):
    """Reads numbers, texts, arrays, and named tuples and words of this package, and nothing that could run."""

    def find_class(self, module: str, name: str) -> Any:
        """Raises UnpicklingError."""
        package = module.partition(".")[0]
        if package == "frictionlab" or (package == "numpy" and name in _OF_ARRAYS):
            found = super().find_class(module, name)
            if package == "numpy" or (isinstance(found, type) and issubclass(found, tuple | StrEnum)):
                return found
        raise pickle.UnpicklingError(f"{module}.{name} is no record")
