"""Answers to pieces, each found again by the hash of what it computes, by whatever study asks for it.

In a folder each is a parquet file, with the checksums that parquet keeps.
"""

from __future__ import annotations

import hashlib
import os
import platform
import secrets
import time
from collections.abc import Callable, Collection, Mapping
from contextlib import suppress
from functools import cache
from importlib.metadata import version
from os import PathLike
from pathlib import Path
from typing import Any

import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq

import frictionlab
from frictionlab.laws.base import FrictionLaw
from frictionlab.laws.faults import INTERNAL, MARK, from_outside
from frictionlab.methods.base import Method
from frictionlab.runner.files import SaveError, remove_leftovers, written_whole
from frictionlab.runner.pieces import Cut, Piece
from frictionlab.study import registry
from frictionlab.study.study import Study

SOLVERS = ("numpy", "numba", "llvmlite", "scipy")
BESIDE_A_PIECE = {"analysis", "bench", "charts", "cli", "report", "study", "testing"}
"""Rooms of frictionlab that no number of a point hangs on: what a study means is in its scenes and laws."""


def code_digest(study: Study) -> str:
    """Return the SHA-256 of frictionlab, of laws and methods from elsewhere, and of the versions they use."""
    outside = [registry.method_code(name) for name in sorted({choice.name for choice in study.methods})]
    return hashlib.sha256(repr((solving_code(), sorted(study.code.items()), outside)).encode()).hexdigest()


def solving_code() -> str:
    """Return the SHA-256 of frictionlab and of the versions it uses."""
    told = own_code(), platform.python_version(), [version(name) for name in SOLVERS]
    return hashlib.sha256(repr(told).encode()).hexdigest()


@cache
def own_code(beside: Collection[str] = tuple(sorted(BESIDE_A_PIECE))) -> str:
    """Return the SHA-256 of the source files of frictionlab that numbers hang on, those of rooms beside left out."""
    home, digest = Path(frictionlab.__file__).parent, hashlib.sha256()
    for file in sorted(home.rglob("*.py")):
        if file.relative_to(home).parts[0] in beside:
            continue
        digest.update(file.relative_to(home).as_posix().encode() + b"\0" + file.read_bytes() + b"\0")
    return digest.hexdigest()


FolderName = str | PathLike[str]
FOLDER = ".cache"
USUAL_GIGABYTES = 4.0
_UNKNOWN = f"?{secrets.token_hex(8)}"
"""Stands for code that nobody knows in the keys of this process: no other finds what it made."""


class Keys:
    """Keys of pieces: the hash of everything that their numbers hang on.

    law_code: SHA-256 by kind of each law of a study that is not frictionlab's own.
    """

    def __init__(self, law_code: Mapping[str, str]) -> None:
        self._law_code, self._code = law_code, solving_code()
        self._last: tuple[Any, str, bool] = None, "", True

    def of(self, piece: Piece) -> str:
        """Return the key of a piece; it begins with ``?`` where the code of its law or method is not known."""
        digest, known = hashlib.sha256(repr(_settings(piece)).encode()), True
        for cut in piece.cuts:
            if self._last[0] is not cut.curve:
                self._last = cut.curve, *self._told_of(cut)
            _, told, is_known = self._last
            known = known and is_known
            digest.update(told.encode() + b"\0" + cut.curve.scenes.belt_speeds[cut.places].tobytes())
        return ("" if known else "?") + digest.hexdigest()

    def _told_of(self, cut: Cut) -> tuple[str, bool]:
        """Return what its curve hangs on but for belt speeds, and whether all of its code is known."""
        curve, method = cut.curve, cut.curve.method.method
        law_code = self._law_code.get(curve.kind) or _stand_in(curve.given_law)
        method_code = _code_of_method(curve.method.name) or _stand_in(method)
        scene = curve.scenes.scene.model_copy(update=_BESIDE).values()
        told = self._code, law_code, method_code, *_identity(curve.law), *_identity(method)
        return "\0".join([*told, repr(sorted(scene.items()))]), _UNKNOWN not in (law_code, method_code)


def _settings(piece: Piece) -> tuple[object, ...]:
    task = piece.task
    return task.tolerance, task.samples, task.harmonics, sorted(task.columns)


def _stand_in(record: FrictionLaw | Method) -> str:
    return _UNKNOWN if from_outside(type(record)) else ""


_BESIDE = {"belt_speed": 0.0, "dimensional": None}
"""Values of a scene on which the numbers of a piece do not hang, or which its key holds otherwise."""
_code_of_method = cache(registry.method_code)


def _identity(record: Any) -> tuple[str, str]:
    """Return the class of a law or method, whose code is told apart where it is another's, and its numbers."""
    kind = type(record)
    home = "" if from_outside(kind) else kind.__module__
    return f"{home}.{kind.__qualname__}", str(record.model_dump_json())


class Store:
    """Answers by key: in a folder, or in memory without one and where the folder does not take them.

    must_keep: whether it is an error where the disk does not take them. gigabytes: size of the folder above which
    those used longest ago are removed.
    """

    def __init__(
        self, folder: Path | None = None, gigabytes: float = USUAL_GIGABYTES, must_keep: bool = False
    ) -> None:
        self.folder, self._most, self._must_keep = folder, gigabytes * 1e9, must_keep
        self._began, self._made = time.time(), set[Path]()
        self._held: dict[str, pa.Table] = {}
        self._columns: dict[str, list[str]] = {}

    def get(self, key: str) -> pa.Table | None:
        """Return the answers of this key; None where there are none, or their file is damaged."""
        if key in self._held or self.folder is None:
            return self._held.get(key)
        path = self._path(key)
        try:
            with path.open("rb") as file:
                found = pq.ParquetFile(file, page_checksum_verification=True).read(use_threads=False)
            if found.schema.metadata.get(_MARK) != _mark(key, found):
                raise ValueError("it is not what was written here")
        except FileNotFoundError:
            return None
        except Exception:  # a damaged file makes pyarrow raise whatever it stumbles over
            with suppress(OSError):
                path.unlink()
            return None
        return found

    def columns(self, key: str) -> list[str]:
        """Return the names of the columns that some point of a piece has; nothing where there are no answers."""
        if key in self._held:
            return self._held[key].column_names
        if key not in self._columns and self.folder is not None:
            path = self._path(key)
            with suppress(Exception), path.open("rb") as file:  # a damaged file makes pyarrow raise anything
                self._columns[key] = list(pq.read_schema(file).names)
                os.utime(path)
        return self._columns.get(key, [])

    def put(self, key: str, answers: pa.Table) -> None:
        """Keep answers; in memory alone where some are to be tried anew, or their code is not known.

        Raises SaveError.
        """
        if self.folder is None or key.startswith("?") or not _is_an_answer(answers):
            self._held[key] = answers
            return
        path = self._path(key)
        try:
            self._make(path.parent)
            marked = answers.replace_schema_metadata(
                {**(answers.schema.metadata or {}), _MARK: _mark(key, answers)}
            )
            with written_whole(path) as file:
                pq.write_table(marked, file, **_PLAIN)
            self._columns[key] = answers.column_names
        except SaveError:  # the run has the answers, and says so where it cannot save them either
            if self._must_keep:
                raise
            self._held[key] = answers

    def derived(self, key: str, make: Callable[[], pd.DataFrame]) -> pd.DataFrame:
        """Return the table of this key, found or made."""
        found = self.get(key)
        if found is None:
            found = pa.Table.from_pandas(make(), preserve_index=False)
            self.put(key, found)
        return found.to_pandas()

    def _make(self, folder: Path) -> None:
        if folder not in self._made:
            with suppress(OSError):  # what cannot be written then says so, or is not kept
                folder.mkdir(parents=True, exist_ok=True)
            self._made.add(folder)

    def trim(self) -> None:
        """Remove those used longest ago until the rest is small enough; none that this run has used."""
        files = []
        for folder in self.folder.glob("??") if self.folder is not None else ():
            with suppress(OSError):
                remove_leftovers(folder)
            for path in folder.glob("*.parquet"):
                with suppress(OSError):  # another process removed it
                    there = path.stat()
                    files.append((there.st_mtime, there.st_size, path))
        size = sum(bytes_ for _, bytes_, _ in files)
        for used, bytes_, path in sorted(files):
            if size <= self._most or used >= self._began:
                return
            with suppress(OSError):
                path.unlink()
            size -= bytes_

    def _path(self, key: str) -> Path:
        assert self.folder is not None
        return self.folder / key[:2] / f"{key[2:]}.parquet"


_PLAIN = {
    "compression": "lz4",
    "use_dictionary": False,
    "write_statistics": False,
    "write_page_checksum": True,
}
"""Choices of the writer of files: quick ones, as most files are read once."""
_MARK = b"columns"
"""Key of the checksum of what parquet has none of: the key of a piece, names and types of columns."""


def _mark(key: str, answers: pa.Table) -> bytes:
    told = [(each.name, "list" if pa.types.is_list(each.type) else str(each.type)) for each in answers.schema]
    return hashlib.sha256(repr((key, len(answers), told)).encode()).hexdigest().encode()


def store_of(
    out: FolderName | None,
    cache: FolderName | None = None,
    gigabytes: float = USUAL_GIGABYTES,
    must_keep: bool = False,
) -> Store:
    """Return the store in ``cache``, beside the results in ``out`` where that is not said, in memory without both."""
    if cache is not None:
        return Store(Path(cache), gigabytes, must_keep)
    return Store(None if out is None else Path(out).absolute().parent / FOLDER, gigabytes, must_keep)


def _is_an_answer(answers: pa.Table) -> bool:
    """Check that no point was killed or failed by a defect."""
    reasons = answers["reason"].unique().to_pylist() if "reason" in answers.column_names else []
    if "status" not in answers.column_names:
        return True
    defects = any(reason.startswith((INTERNAL, MARK)) for reason in reasons if reason)
    return not defects and "killed" not in answers["status"].unique().to_pylist()
