"""Cut curves into pieces, each of which is found in the store or solved as a whole."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import Method
from frictionlab.scene.scenes import Scenes
from frictionlab.study.grid import StudyCurve
from frictionlab.study.study import Study
from frictionlab.values.columns import selected

Places = NDArray[np.int64]

QUICK, SLOW = (125, 500), (16, 125)
"""Points per chunk, about, in a usual study and in a long one: of driven bodies or given slips without memory of
friction, and of all others, whose points may take seconds each.

Fewer lose the continuation from the neighbour, more leave workers idle. Never made to depend on the number of
workers: answers would, too."""
SLOW_END = 4, 12
"""Places where the slow end of such a curve is cut first, at the lowest belt speeds: the longest of five pieces of
the hardest case known takes 20 s then, that of four equal ones 28 s, at the same cost in all."""
LONG_STUDY, TOGETHER = 20_000, 500
"""Points of a study long enough to keep workers busy by larger chunks, and of those that are then one piece: to send
out and to keep a few points takes longer than to solve them."""
ROWS_OF_A_BLOCK = 20_000
"""Rows of the table that are made at once, at least; more where those of a curve are more, or lie farther apart."""


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


def task_of(study: Study, limited: bool = True) -> Task:
    """Return the settings that the points of a study share. limited: whether its limit of time is kept."""
    kept = study.keep.orbit or 0, study.keep.harmonics or 0
    return Task(
        study.tolerance, *kept, study.selected(), study.limit.seconds_per_point if limited else math.inf
    )


@dataclass(frozen=True)
class Chunk:
    """Neighbouring points of one curve, ascending in belt speed, that a method is given at once."""

    scenes: Scenes
    law: FrictionLaw
    method: Method
    task: Task

    def __len__(self) -> int:
        """Count the points."""
        return len(self.scenes)

    def of(self, places: slice) -> Chunk:
        """Return the points at these places."""
        return replace(self, scenes=self.scenes[places])


class Cut(NamedTuple):
    """Place of a chunk in a study: its curve, the places on that and the rows of the table."""

    curve: StudyCurve
    places: Places
    rows: Places

    def chunk(self, task: Task) -> Chunk:
        """Return the chunk; the law and the method are made here."""
        curve = self.curve
        return Chunk(curve.scenes.taken(self.places), curve.law, curve.method.method, task)


@dataclass(eq=False)
class Piece:
    """Chunks of one law and one method that are solved and kept together.

    rows: that of each point in the table. key: the hash of what it computes, once somebody asks for it.
    """

    cuts: tuple[Cut, ...]
    rows: Places
    task: Task
    key: str = ""

    def __len__(self) -> int:
        """Count the points."""
        return len(self.rows)

    @property
    def kind(self) -> tuple[str, str]:
        """Labels of its law and its method."""
        return self.cuts[0].curve.labels

    def chunks(self) -> list[Chunk]:
        """Return what its method is given, one after another."""
        return [cut.chunk(self.task) for cut in self.cuts]


class TableBlock(NamedTuple):
    """Curves, one after another, whose rows together are neighbours in the table, and their pieces."""

    curves: range
    pieces: list[Piece]


def blocks_of_table(curves: Sequence[StudyCurve], task: Task) -> list[TableBlock]:
    """Return all pieces of the curves of a study, by the blocks of its table."""
    long = is_long(curves)
    return [TableBlock(own, [*_pieces(curves[own.start : own.stop], task, long)]) for own in _blocks(curves)]


def _blocks(curves: Sequence[StudyCurve]) -> Iterator[range]:
    start, low, high, rows = 0, 0, 0, 0
    for place, curve in enumerate(curves, 1):
        high, rows = max([high, *(row + 1 for row in curve.rows[-1:])]), rows + len(curve.rows)
        if high - low == rows >= ROWS_OF_A_BLOCK:
            yield range(start, place)
            start, low, rows = place, high, 0
    if rows:
        yield range(start, len(curves))


def _pieces(curves: Sequence[StudyCurve], task: Task, long: bool) -> Iterator[Piece]:
    own, size = list[Cut](), 0
    for cut in cuts(curves, long):
        fits = long and own and cut.curve.labels == own[0].curve.labels and size + len(cut.rows) <= TOGETHER
        if own and not fits:
            yield _piece(own, task)
            own, size = [], 0
        own, size = [*own, cut], size + len(cut.rows)
    if own:
        yield _piece(own, task)


def _piece(own: list[Cut], task: Task) -> Piece:
    return Piece(tuple(own), np.concatenate([cut.rows for cut in own]), task)


def is_long(curves: Sequence[StudyCurve]) -> bool:
    """Check whether a study of these curves has enough points for larger chunks."""
    return sum(len(each.rows) for each in curves) >= LONG_STUDY


def cuts(curves: Iterable[StudyCurve], long: bool) -> Iterator[Cut]:
    """Yield the places where curves of a study are cut into chunks."""
    for curve in (each for each in curves if each.rows):
        rising = np.argsort(curve.scenes.given, kind="stable")
        rows = np.arange(curve.rows.start, curve.rows.stop, curve.rows.step)
        quick = curve.given_law.memory_kind == "none" and not curve.scenes.scene.undriven
        size, points = (QUICK if quick else SLOW)[long], len(rising)
        begun = [0, *(() if quick or long or points < 2 * size else SLOW_END)]
        left = points - begun[-1]
        count = max(1, round(left / size))
        ends = [*begun, *(begun[-1] + left * piece // count for piece in range(1, count + 1))]
        for start, end in pairwise(ends):
            yield Cut(curve, rising[start:end], rows[rising[start:end]])
