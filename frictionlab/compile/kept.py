"""Compiled entries as files, one for each signature: a checksum, then the machine code as numba hands it over.

No file decides a result. One that cannot be read, or is not what was written, is dropped and its kernel compiled
afresh; where none can be written, kernels serve the process that compiled them. Either is said in one line on stderr.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
import pickle
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numba.core.caching
import numba.core.compiler
import numba.core.serialize
import numba.core.types
from filelock import FileLock

from frictionlab.compile.notice import compiled_here, mark_cache_miss

_Cache: Any = numba.core.caching._Cache  # internals of numba, untyped
_compiler: Any = numba.core.compiler
_serialize: Any = numba.core.serialize
_types: Any = numba.core.types

SUFFIX = ".kernel"
CHECKSUM = 32
"""Length of the checksum [bytes]."""
ABANDONED = 3600.0
"""Age [s] from which a file that was never finished is taken for one of a process that was killed."""

_warned: set[str] = set()


def cache_folder() -> Path | None:
    """Return the folder of compiled entries: $FRICTIONLAB_CACHE, else in the user's cache; None without a home."""
    if chosen := os.environ.get("FRICTIONLAB_CACHE"):
        return Path(chosen)
    if base := os.environ.get("XDG_CACHE_HOME") or os.environ.get("LOCALAPPDATA"):
        return Path(base) / "frictionlab"
    with contextlib.suppress(RuntimeError):
        return Path.home() / ".cache" / "frictionlab"
    return None


class KeptEntry(_Cache):  # type: ignore[misc]
    """Machine code of one entry: numba asks for it before it compiles, and hands it over afterwards."""

    cache_path = None

    def __init__(self, name: str) -> None:
        self._name = name

    def load_overload(self, signature: Any, context: Any) -> Any:
        """Return what was kept for this signature; None where nothing sound is."""
        context.refresh()
        found = self._found(signature, context)
        if found is None:
            mark_cache_miss()
        return found

    def _found(self, signature: Any, context: Any) -> Any:
        path = self._path(signature, context.codegen())
        if path is None:
            return None
        try:
            payload = _read(path, _about(signature))
            return None if payload is None else _compiler.CompileResult._rebuild(context, *payload)
        except Exception as problem:  # whatever a file may make the reader stumble over
            _tell(f"kernel cache: {path} {_fault(problem)}; its kernel is compiled afresh")
            with contextlib.suppress(OSError):
                path.unlink()
            return None

    def save_overload(self, signature: Any, result: Any) -> None:
        """Keep what was compiled, where that is possible."""
        compiled_here.append(self._name)
        path = self._path(signature, result.codegen)
        if path is None or any(not each.can_cache for each in result.lifted):
            return
        if result.library.has_dynamic_globals:  # addresses of this process
            return
        try:
            _write(path, _serialize.dumps((_about(signature), result._reduce())))
        except (OSError, ValueError) as problem:
            why = getattr(problem, "strerror", None) or str(problem)
            _tell(
                f"kernel cache: kernels cannot be kept in {path.parent} ({why}): every run compiles its own"
            )

    def has_any(self) -> bool:
        """Check whether there is a file for some signature, sound or not."""
        folder = cache_folder()
        return folder is not None and any(folder.glob(f"{self._name}_*{SUFFIX}"))

    def _path(self, signature: Any, codegen: Any) -> Path | None:
        folder = cache_folder()
        about = repr((_about(signature), codegen.magic_tuple()))
        return folder and folder / f"{self._name}_{hashlib.sha256(about.encode()).hexdigest()[:16]}{SUFFIX}"

    @contextlib.contextmanager
    def compiled_once(self, signature: Any, codegen: Any) -> Iterator[None]:
        """Keep other processes and threads from compiling this entry: they wait, then read what is kept.

        Where no file can be locked, each compiles its own.
        """
        path = self._path(signature, codegen)
        if path is None or path.exists():
            yield
            return
        mark_cache_miss()
        file = path.with_suffix(".lock")
        lock = FileLock(file)
        with contextlib.suppress(OSError, NotImplementedError):
            path.parent.mkdir(parents=True, exist_ok=True)
            lock.acquire()
        try:
            yield
        finally:
            with contextlib.suppress(OSError):
                file.unlink(missing_ok=True)  # whoever waits for it holds it open
            lock.release()

    def has(self, signature: Any, codegen: Any) -> bool:
        """Check whether there is a file for this signature, sound or not."""
        path = self._path(signature, codegen)
        return path is not None and path.exists()

    def enable(self) -> None:
        """Nothing to do: it always is."""

    def disable(self) -> None:
        """Not offered."""

    def flush(self) -> None:
        """Nothing to do: every file is written at once."""


class _Damaged(Exception):
    """A file that is not what was written."""


def _fault(problem: Exception) -> str:
    if isinstance(problem, _Damaged):
        return f"is damaged ({problem})"
    return f"cannot be read ({getattr(problem, 'strerror', None) or type(problem).__name__})"


def _about(signature: Any) -> str:
    """Types of the arguments, records told apart by their homes: numba names them by their last names alone."""
    return "; ".join(_type_name(each) for each in signature)


def _type_name(kind: Any) -> str:
    if not isinstance(kind, _types.BaseTuple):
        return str(kind)
    record = getattr(kind, "instance_class", tuple)
    inside = ", ".join(_type_name(each) for each in kind)
    return f"{record.__module__}.{record.__qualname__}({inside})"


def _read(path: Path, about: str) -> Any:
    """Read the file; None without one. Raises _Damaged, OSError, or what a reader of pickles raises."""
    try:
        content = path.read_bytes()
    except FileNotFoundError:
        return None
    if hashlib.sha256(content[CHECKSUM:]).digest() != content[:CHECKSUM]:
        raise _Damaged("its checksum is wrong" if content else "it is empty")
    written_for, payload = pickle.loads(content[CHECKSUM:])
    if written_for != about:
        raise _Damaged("it is that of another kernel")
    return payload


def _write(path: Path, content: bytes) -> None:
    """Write the file whole or not at all. Raises OSError."""
    path.parent.mkdir(parents=True, exist_ok=True)
    handle, temporary = tempfile.mkstemp(dir=path.parent, suffix=".tmp")
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(hashlib.sha256(content).digest() + content)
        os.replace(temporary, path)
    except BaseException:
        with contextlib.suppress(OSError):
            os.unlink(temporary)
        raise
    for left in _abandoned(path.parent):
        with contextlib.suppress(OSError):
            left.unlink()


def _abandoned(folder: Path) -> Iterator[Path]:
    with contextlib.suppress(OSError):
        yield from (file for file in folder.glob("*.tmp") if time.time() - file.stat().st_mtime > ABANDONED)


def _tell(message: str) -> None:
    """Say it once; a closed stderr is no error."""
    if message not in _warned and sys.stderr is not None:
        _warned.add(message)
        with contextlib.suppress(OSError, ValueError):
            print(message, file=sys.stderr)
