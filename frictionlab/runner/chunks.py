"""Curves into chunks of neighbouring belt speeds: what a method is given at once."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from frictionlab.columns import selected
from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import Method
from frictionlab.results.part import Places
from frictionlab.runner.kept_calls import KeptCalls
from frictionlab.scene.scenes import Scenes
from frictionlab.study import Study, StudyCurve

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
