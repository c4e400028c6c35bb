"""Curves into chunks of neighbouring belt speeds: what a method is given at once.

What long calls of methods have found for points under way: an interrupted run loses those it is at, not the rest.

Kept beside the chunks, in a folder for each chunk that is gone once the chunk is solved. A call is found by all that
its answer hangs on, so answers never hang on when a run was interrupted.
"""

from __future__ import annotations

import hashlib
import io
import math
import pickle
import shutil
from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from enum import StrEnum
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import Method
from frictionlab.runner.files import SaveError, write_whole
from frictionlab.runner.part import Places
from frictionlab.scene.scenes import Scenes
from frictionlab.study.grid import StudyCurve
from frictionlab.study.study import Study
from frictionlab.values.columns import selected

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


USUAL_SIZE = 125
"""Points per chunk: pieces of one curve then hold 84 to 187 points. Fewer lose the continuation from the
neighbour, more leave workers idle. Never made to depend on the number of workers: answers would, too."""
LONG_STUDY, LONG_SIZE = 20_000, 500
"""Points of a study long enough to keep workers busy by larger chunks, and the points of these, or of several short
ones that a worker is given together."""


@dataclass(frozen=True)
class Task:
    """What all points of a run share: tolerance on mean_friction [-], samples per kept orbit and the highest harmonic
    kept (0: none), the result columns asked for, and the time a point may take [s]."""

    tolerance: float
    samples: int = 0
    harmonics: int = 0
    columns: frozenset[str] = selected(None)
    seconds_per_point: float = math.inf


def task_of(study: Study) -> Task:
    """What the points of a study share."""
    kept = study.keep_orbit or 0, study.keep_harmonics or 0
    return Task(study.tolerance, *kept, study.selected(), study.seconds_per_point)


@dataclass(frozen=True)
class Chunk:
    """Neighbouring points of one curve, ascending in belt speed, with the table row of each.

    calls: where long calls for them are kept until all are solved, if anywhere.
    """

    rows: Places
    scenes: Scenes
    law: FrictionLaw
    method: Method
    task: Task
    calls: KeptCalls | None = None

    def of(self, places: Sequence[int] | slice | Places) -> Chunk:
        """The points at these places."""
        scenes = self.scenes[places] if isinstance(places, slice) else self.scenes.taken(places)
        return replace(self, rows=self.rows[places], scenes=scenes)


class Cut(NamedTuple):
    """Where a chunk is cut out of a study: its curve, the places on that and the rows of the table."""

    curve: StudyCurve
    places: Places
    rows: Places

    def chunk(self, task: Task) -> Chunk:
        """The chunk; the law and the method are made here."""
        curve = self.curve
        return Chunk(self.rows, curve.scenes.taken(self.places), curve.law, curve.method.method, task)


def chunk_size(curves: Sequence[StudyCurve]) -> int:
    """Points per chunk of a study of these curves, about."""
    return LONG_SIZE if _is_long(curves) else USUAL_SIZE


def group_size(curves: Sequence[StudyCurve]) -> int:
    """Points of the chunks that a worker is given together."""
    return LONG_SIZE if _is_long(curves) else 1


def _is_long(curves: Sequence[StudyCurve]) -> bool:
    return sum(len(each.rows) for each in curves) >= LONG_STUDY


def cuts(curves: Iterable[StudyCurve], size: int) -> Iterator[Cut]:
    """Where curves are cut into chunks of about this size, whatever of them is already solved."""
    for curve in curves:
        rising = np.argsort(curve.scenes.given, kind="stable")
        rows = np.arange(curve.rows.start, curve.rows.stop, curve.rows.step)
        count = max(1, round(len(rising) / size))
        ends = [len(rising) * piece // count for piece in range(count + 1)]
        for start, end in pairwise(ends):
            yield Cut(curve, rising[start:end], rows[rising[start:end]])
