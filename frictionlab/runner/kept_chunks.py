"""Solved chunks, each a file named by the hash of what it computes: found again by whatever study asks for it.

What finds the numbers of a run, as a digest: where it changes, a point that failed may succeed, and a chunk that
was kept is solved anew.
"""

from __future__ import annotations

import hashlib
import json
import os
import platform
import time
import zlib
from collections.abc import Collection, Mapping
from contextlib import suppress
from functools import cache
from importlib.metadata import version
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

import frictionlab
from frictionlab.laws.base import FrictionLaw
from frictionlab.laws.faults import INTERNAL, MARK, from_outside
from frictionlab.methods.base import Method
from frictionlab.runner.chunks import Chunk
from frictionlab.runner.files import remove_leftovers, write_whole
from frictionlab.runner.part import KeptRows, Part
from frictionlab.study import registry
from frictionlab.study.study import Study
from frictionlab.values.quantities import Floats

SOLVERS = ("numpy", "numba", "llvmlite", "scipy")
BESIDE = {"analysis", "bench", "charts", "cli", "report", "study", "testing"}
"""Rooms of frictionlab that no number of a point hangs on: what a study means is in its scenes and laws."""


def code_digest(study: Study) -> str:
    """SHA-256 of frictionlab, of the laws and methods of other packages in a study, and of the versions they use."""
    outside = [registry.method_code(name) for name in sorted({choice.name for choice in study.methods})]
    return hashlib.sha256(repr((solving_code(), sorted(study.code.items()), outside)).encode()).hexdigest()


def solving_code() -> str:
    """SHA-256 of frictionlab and of the versions it uses."""
    told = own_code(), platform.python_version(), [version(name) for name in SOLVERS]
    return hashlib.sha256(repr(told).encode()).hexdigest()


@cache
def own_code(beside: Collection[str] = tuple(sorted(BESIDE))) -> str:
    """SHA-256 of the source files of frictionlab, but for rooms beside: of those that numbers hang on."""
    home, digest = Path(frictionlab.__file__).parent, hashlib.sha256()
    for file in sorted(home.rglob("*.py")):
        if file.relative_to(home).parts[0] in beside:
            continue
        digest.update(file.relative_to(home).as_posix().encode() + b"\0" + file.read_bytes() + b"\0")
    return digest.hexdigest()


FolderName = str | PathLike[str]
FOLDER = ".cache"
USUAL_GIGABYTES = 4.0
_HEAD = b"frictionlab chunk 4 "
_CHECKSUM = 8
"""Letters of a checksum."""


class Keys:
    """The hash of what a chunk computes: of everything its numbers hang on.

    law_code: SHA-256 by kind of each law of a study that is not frictionlab's own. unknown: what stands for code that
    is not known.
    """

    def __init__(self, law_code: Mapping[str, str], unknown: str = "") -> None:
        self._law_code, self._unknown, self._code = law_code, unknown, solving_code()

    def of(self, chunk: Chunk, kind: str, method: str) -> str | None:
        """The key of a chunk of a law of this kind by the method of this name; None where their code is not known."""
        law_code = self._law_code.get(kind) or self._stand_in(chunk.law)
        method_code = _code_of_method(method) or self._stand_in(chunk.method)
        if law_code is None or method_code is None:
            return None
        task, scenes = chunk.task, chunk.scenes
        told = [
            self._code,
            law_code,
            method_code,
            *_identity(chunk.law),
            *_identity(chunk.method),
            repr(sorted(scenes.scene.model_copy(update=_BESIDE).values().items())),
            repr(
                (task.tolerance, task.samples, task.harmonics, task.seconds_per_point, sorted(task.columns))
            ),
        ]
        digest = hashlib.sha256("\0".join(told).encode())
        digest.update(scenes.belt_speeds.tobytes())
        return digest.hexdigest()

    def _stand_in(self, record: FrictionLaw | Method) -> str | None:
        return (self._unknown or None) if from_outside(type(record)) else ""


_BESIDE = {"belt_speed": 0.0, "dimensional": None}
"""What of a scene says nothing about the numbers of a chunk, or is told otherwise."""
_code_of_method = cache(registry.method_code)


def _identity(record: Any) -> tuple[str, str]:
    """The class of a law or method, whose code is told apart where it is another's, and its numbers."""
    kind = type(record)
    home = "" if from_outside(kind) else kind.__module__
    return f"{home}.{kind.__qualname__}", str(record.model_dump_json())


class KeptChunks:
    """The chunks kept in a folder. gigabytes: their size in all, above which those used longest ago are removed."""

    def __init__(self, folder: Path, gigabytes: float = USUAL_GIGABYTES) -> None:
        self.folder, self._most = folder, gigabytes * 1e9
        self._began = time.time()
        self._made = set[Path]()

    def found(self, key: str) -> Part | None:
        """The answers kept under a key, by their places in the chunk; None without, or where the file is damaged."""
        path = self._path(key)
        try:
            content = path.read_bytes()
        except OSError:
            return None
        part = _unpacked(content)
        with suppress(OSError):
            os.utime(path) if part is not None else path.unlink()
        return part

    def keep(self, key: str, part: Part) -> bool:
        """Keep answers, by their places in the chunk, but for those to be tried anew. Raises SaveError."""
        if not _is_an_answer(part):
            return False
        path = self._path(key)
        self._make(path.parent)
        write_whole(path, _packed(part))
        return True

    def _make(self, folder: Path) -> None:
        if folder not in self._made:
            with suppress(OSError):  # what cannot be written then says so, or is not kept
                folder.mkdir(parents=True, exist_ok=True)
            self._made.add(folder)

    def trim(self) -> None:
        """Remove those used longest ago until the rest is small enough; none that this run has used."""
        files = []
        for folder in self.folder.glob("??"):
            with suppress(OSError):
                remove_leftovers(folder)
        for path in self.folder.glob("??/*.chunk"):
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
        return self.folder / key[:2] / f"{key[2:]}.chunk"


def kept_beside(
    out: FolderName | None, cache: FolderName | None, gigabytes: float = USUAL_GIGABYTES
) -> KeptChunks | None:
    """The chunks kept in ``cache``, beside the results in ``out`` where that is not said; None without either."""
    if cache is not None:
        return KeptChunks(Path(cache), gigabytes)
    return None if out is None else KeptChunks(Path(out).absolute().parent / FOLDER, gigabytes)


def _is_an_answer(part: Part) -> bool:
    """Whether no point was killed or failed by a defect."""
    defects = any(reason.startswith((INTERNAL, MARK)) for reason in set(part.text["reason"]))
    return not defects and "killed" not in part.text["status"]


def _packed(part: Part) -> bytes:
    """A head, a checksum, a line that says what follows, the numbers of all columns, then those of what is kept."""
    words = {name: _indexed(column) for name, column in part.text.items()}
    told = {
        "points": len(part.rows),
        "columns": list(part.numbers),
        "words": {name: different for name, (different, _) in words.items()},
        "kept": {name: _told_of(rows) for name, rows in part.kept.items()},
    }
    numbers = [np.asarray(column, dtype=np.float64).tobytes() for column in part.numbers.values()]
    indices = [np.array(column, dtype=np.int32).tobytes() for _, column in words.values()]
    kept = [
        np.asarray(values, dtype=np.float64).tobytes()
        for rows in part.kept.values()
        for columns in rows.values()
        for values in columns.values()
    ]
    content = b"".join([json.dumps(told).encode(), b"\n", *numbers, *indices, *kept])
    return _HEAD + _checksum(content) + b"\n" + content


def _indexed(column: list[str]) -> tuple[list[str], list[int]]:
    """The different words, and for each row which of them."""
    places = {word: place for place, word in enumerate(dict.fromkeys(column))}
    return list(places), [places[word] for word in column] if len(places) > 1 else [0] * len(column)


def _unpacked(content: bytes) -> Part | None:
    """The answers of a file; None where it is not what was written."""
    head = len(_HEAD) + _CHECKSUM + 1
    if not content.startswith(_HEAD) or content[len(_HEAD) : head - 1] != _checksum(content[head:]):
        return None
    line, _, numbers = content[head:].partition(b"\n")
    told = json.loads(line)
    n, names = told["points"], told["columns"]
    floats, integers = 8 * n * len(names), 4 * n * len(told["words"])
    columns = np.frombuffer(numbers[:floats], np.float64).reshape(len(names), n)
    indices = np.frombuffer(numbers[floats : floats + integers], np.int32).reshape(len(told["words"]), n)
    text = {
        name: [different[k] for k in row]
        for (name, different), row in zip(told["words"].items(), indices.tolist(), strict=True)
    }
    return Part(
        np.arange(n),
        text,
        dict(zip(names, columns, strict=True)),
        _kept_of(told["kept"], np.frombuffer(numbers[floats + integers :], np.float64)),
    )


def _told_of(rows: KeptRows) -> dict[str, Any]:
    """The rows of a kept table, its columns, which every row has, and the lengths of these in each row."""
    first = next(iter(rows.values()), {})
    lengths = [len(next(iter(columns.values()), ())) for columns in rows.values()]
    return {"rows": list(rows), "columns": list(first), "lengths": lengths}


def _kept_of(told: Mapping[str, dict[str, Any]], numbers: Floats) -> dict[str, KeptRows]:
    kept, start = dict[str, KeptRows](), 0
    for name, one in told.items():
        names, kept[name] = one["columns"], {}
        for row, length in zip(one["rows"], one["lengths"], strict=True):
            values = numbers[start : start + len(names) * length].reshape(len(names), length)
            kept[name][row] = dict(zip(names, values, strict=True))
            start += values.size
    return kept


def _checksum(content: bytes) -> bytes:
    return b"%08x" % zlib.crc32(content)
