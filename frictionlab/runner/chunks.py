"""Cases into curves, and curves into chunks of neighbouring belt speeds: what a method is given at once."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

from frictionlab.columns import selected
from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import Method
from frictionlab.scene.scene import Scene
from frictionlab.study import StudyCase

USUAL_SIZE = 125
"""Points per chunk: pieces of one curve then hold 84 to 187 points. Fewer lose the continuation from the
neighbour, more leave workers idle. Never made to depend on the number of workers: answers would, too."""


@dataclass(frozen=True)
class Task:
    """What all points of a run share: tolerance on mean_friction [-], samples per kept orbit (0: none), the result
    columns asked for, and the time a point may take [s]."""

    tolerance: float
    samples: int = 0
    columns: frozenset[str] = selected(None)
    seconds_per_point: float = math.inf


@dataclass(frozen=True)
class Chunk:
    """Neighbouring points of one curve, ascending in belt speed, with the table row of each."""

    rows: tuple[int, ...]
    scenes: tuple[Scene, ...]
    law: FrictionLaw
    method: Method
    task: Task


def chunk_by_curve(cases: Sequence[StudyCase]) -> list[list[int]]:
    """The rows of each curve (everything equal but belt speed), ascending in belt speed."""
    found: dict[Any, list[int]] = {}
    for row, case in enumerate(cases):
        found.setdefault(_curve_key(case), []).append(row)
    return [sorted(rows, key=lambda row: cases[row].scene.belt_speed) for rows in found.values()]


def _curve_key(case: StudyCase) -> Any:
    values = case.scene.at(0.0).values()
    return case.law_label, case.law, case.method_label, case.method, tuple(values.items())


def chunks(cases: Sequence[StudyCase], task: Task, finished: frozenset[int] = frozenset()) -> list[Chunk]:
    """The chunks still to solve.

    Curves are cut before finished rows are left out: a run stopped and continued then solves the very chunks
    of one that went through.
    """
    pieces = [piece for curve in chunk_by_curve(cases) for piece in _cut(curve)]
    left = [[row for row in piece if row not in finished] for piece in pieces]
    return [_chunk(cases, rows, task) for rows in left if rows]


def _cut(curve: list[int]) -> list[list[int]]:
    pieces = max(1, round(len(curve) / USUAL_SIZE))
    ends = [len(curve) * piece // pieces for piece in range(pieces + 1)]
    return [curve[start:end] for start, end in pairwise(ends)]


def _chunk(cases: Sequence[StudyCase], rows: list[int], task: Task) -> Chunk:
    first = cases[rows[0]]
    return Chunk(tuple(rows), tuple(cases[row].scene for row in rows), first.law, first.method, task)
