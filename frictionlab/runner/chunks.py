"""Cut curves into chunks of neighbouring belt speeds, each of which a method is given at once."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import Method
from frictionlab.runner.part import Places
from frictionlab.scene.scenes import Scenes
from frictionlab.study.grid import StudyCurve
from frictionlab.study.study import Study
from frictionlab.values.columns import selected

QUICK, SLOW = (125, 500), (16, 125)
"""Points per chunk, about, in a usual study and in a long one: of driven bodies or given slips without memory of
friction, and of all others, whose points may take seconds each.

Fewer lose the continuation from the neighbour, more leave workers idle. Never made to depend on the number of
workers: answers would, too."""
LONG_STUDY, TOGETHER = 20_000, 500
"""Points of a study long enough to keep workers busy by larger chunks, and of those that a worker is then given at
once."""


@dataclass(frozen=True)
class Task:
    """Settings that all points of a run share.

    They are the tolerance on mean_friction [-], samples per kept orbit and the highest harmonic kept (0: none), the
    result columns asked for, and the time a point may take [s].
    """

    tolerance: float
    samples: int = 0
    harmonics: int = 0
    columns: frozenset[str] = selected(None)
    seconds_per_point: float = math.inf


def task_of(study: Study) -> Task:
    """Return the settings that the points of a study share."""
    kept = study.keep_orbit or 0, study.keep_harmonics or 0
    return Task(study.tolerance, *kept, study.selected(), study.seconds_per_point)


@dataclass(frozen=True)
class Chunk:
    """Neighbouring points of one curve, ascending in belt speed, with the table row of each."""

    rows: Places
    scenes: Scenes
    law: FrictionLaw
    method: Method
    task: Task

    def of(self, places: Sequence[int] | slice | Places) -> Chunk:
        """Return the points at these places."""
        scenes = self.scenes[places] if isinstance(places, slice) else self.scenes.taken(places)
        return replace(self, rows=self.rows[places], scenes=scenes)


class Cut(NamedTuple):
    """Place of a chunk in a study: its curve, the places on that and the rows of the table."""

    curve: StudyCurve
    places: Places
    rows: Places

    def chunk(self, task: Task) -> Chunk:
        """Return the chunk; the law and the method are made here."""
        curve = self.curve
        return Chunk(self.rows, curve.scenes.taken(self.places), curve.law, curve.method.method, task)


def is_long(curves: Sequence[StudyCurve]) -> bool:
    """Check whether a study of these curves has enough points for larger chunks."""
    return sum(len(each.rows) for each in curves) >= LONG_STUDY


def cuts(curves: Iterable[StudyCurve], long: bool) -> Iterator[Cut]:
    """Yield the places where curves of a study are cut into chunks, whatever of them is already solved."""
    for curve in curves:
        rising = np.argsort(curve.scenes.given, kind="stable")
        rows = np.arange(curve.rows.start, curve.rows.stop, curve.rows.step)
        quick = curve.given_law.memory_kind == "none" and not curve.scenes.scene.undriven
        count = max(1, round(len(rising) / (QUICK if quick else SLOW)[long]))
        ends = [len(rising) * piece // count for piece in range(count + 1)]
        for start, end in pairwise(ends):
            yield Cut(curve, rising[start:end], rows[rising[start:end]])
