"""What a method or peer says at every point of a map, and how far that is from an unrelated method's answer."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from frictionlab.bench.failures.record import FailureMap, GridRow
from frictionlab.bench.peers.base import Peer
from frictionlab.bench.record import Contender, ReferenceSource
from frictionlab.bench.solvers import SolverAnswers, known_means, solve_points
from frictionlab.methods.base import Method
from frictionlab.quantities import Floats
from frictionlab.runner.chunks import Chunk, Task
from frictionlab.runner.solve import answer, number_columns

OUTCOMES = ("ok", "refused", "failed", "not_unique", "silent")
"""What a point can come to. ``silent``: a number that is wrong without a word: for a method its true error is above
the error it states, for a peer above ten times the tolerance asked, each with the reference's own error added."""
PEER_MARGIN = 10.0
MOTION = ("stick_fraction", "reversals")


class KnownMeans(NamedTuple):
    """The answers of a reference on a map: mean friction and its error, NaN where it has none, a row for each value
    and one for each named point.
    """

    label: str
    kind: str
    means: list[Floats]
    errors: list[Floats]


class GridMotions(NamedTuple):
    """Where on the grid the mass sticks, and where its slip reverses or sticks: 1 or 0, NaN where that is not known;
    a row for each value.
    """

    sticks: Floats
    reverses: Floats


@dataclass(frozen=True)
class PointOutcome:
    """One point: what the solver said, and what is known of it. Numbers are NaN where there is none."""

    belt_speed: float
    value: float
    friction_to_load: float
    outcome: str
    reason: str
    stated: float
    true: float
    reference: str
    reference_error: float
    point: str = ""

    @property
    def undecided(self) -> bool:
        """Whether the reference is too coarse to tell if the stated error covers the true one."""
        return self.outcome == "ok" and self.stated < self.true


@dataclass(frozen=True)
class MapOutcome:
    """A map as one solver sees it: the grid, a row for each value, and the named points."""

    drawn: FailureMap
    grid: tuple[tuple[PointOutcome, ...], ...]
    named: tuple[PointOutcome, ...]

    @property
    def points(self) -> list[PointOutcome]:
        """Of the grid, and the named ones."""
        return [point for row in self.grid for point in row] + list(self.named)

    def counts(self) -> Counter[str]:
        """How many points came to what."""
        return Counter(point.outcome for point in self.points)

    @property
    def has_panel(self) -> bool:
        """Whether any point is not refused."""
        return self.counts()["refused"] < len(self.points)


class MapTruth:
    """A map with what is known of it by its references, computed once for all solvers."""

    def __init__(self, drawn: FailureMap) -> None:
        self.drawn = drawn
        self._motions: GridMotions | None = None

    @cached_property
    def known(self) -> list[KnownMeans]:
        """The answers of every reference."""
        return [self._known(trusted) for trusted in self.drawn.references]

    @property
    def motions(self) -> GridMotions | None:
        """Where the mass sticks and its slip reverses, by the first reference; None without references."""
        return self._motions if self.known else None

    def _known(self, trusted: ReferenceSource) -> KnownMeans:
        assert trusted.solver is not None
        rows = (*self.drawn.rows, *self.drawn.named_rows)
        if isinstance(trusted.solver, Peer) or self._motions is not None:
            answers = [solve_points(trusted.solver, row.scenes, row.law, trusted.tolerance) for row in rows]
        else:
            solved = [_with_motion(trusted.solver, row, trusted.tolerance) for row in rows]
            answers = [found for found, _ in solved]
            self._motions = _motions(np.array([motion for _, motion in solved[: len(self.drawn.rows)]]))
        pairs = [
            known_means(trusted, found, row.scenes, row.law) for found, row in zip(answers, rows, strict=True)
        ]
        return KnownMeans(
            trusted.label, trusted.kind, [means for means, _ in pairs], [errors for _, errors in pairs]
        )


def _motions(columns: Floats) -> GridMotions:
    """From the columns of ``MOTION``, on the second axis."""
    stick, reversals = columns[:, 0], columns[:, 1]
    sticks = np.where(np.isnan(stick), np.nan, stick > 0.0)
    return GridMotions(sticks, np.where(np.isnan(reversals), np.nan, (stick > 0.0) | (reversals > 0.0)))


def _with_motion(method: Method, row: GridRow, tolerance: float) -> tuple[SolverAnswers, Floats]:
    """The answers along a row, and the columns of ``MOTION``."""
    n = len(row.scenes)
    found, columns = SolverAnswers.without("failed", "", n), np.full((len(MOTION), n), np.nan)
    for piece in answer(Chunk(np.arange(n), row.scenes, row.law, method, Task(tolerance))):
        found.put(piece.places, piece.answers)
        if "ok" in piece.answers.status:
            read = number_columns(piece.answers, row.scenes.taken(piece.places), MOTION)
            for place, name in enumerate(MOTION):
                columns[place, piece.places] = read[name]
    return found, columns


def measure_map(truth: MapTruth, contender: Contender) -> MapOutcome:
    """The map as this solver sees it."""
    ((setting, solver),) = contender.solvers
    drawn = truth.drawn
    rows = []
    for place, row in enumerate((*drawn.rows, *drawn.named_rows)):
        outcome = solve_points(solver, row.scenes, row.law, setting.tolerance)
        rows.append(_row(truth, contender, place, row, outcome))
    size = len(drawn.rows)
    named = [
        PointOutcome(**(vars(points[0]) | {"point": point.name}))
        for points, point in zip(rows[size:], drawn.points, strict=True)
    ]
    return MapOutcome(drawn, tuple(rows[:size]), tuple(named))


def _row(
    truth: MapTruth, contender: Contender, place: int, row: GridRow, outcome: SolverAnswers
) -> tuple[PointOutcome, ...]:
    (setting, solver), ratio = contender.solvers[0], row.friction_to_load
    found = []
    for i, speed in enumerate(row.scenes.belt_speeds.tolist()):
        label, mean, known = _reference_at(truth.known, contender.kind, place, i)
        status = outcome.status[i]
        off = abs(float(outcome.means[i]) - mean) if status == "ok" else math.nan
        stated = float(outcome.errors[i])
        claimed = PEER_MARGIN * setting.tolerance if isinstance(solver, Peer) else stated
        silent = status == "ok" and off > claimed + known
        found.append(
            PointOutcome(
                speed,
                row.value,
                ratio,
                "silent" if silent else status,
                outcome.reason[i],
                stated if status == "ok" else math.nan,
                off,
                label,
                known,
            )
        )
    return tuple(found)


def _reference_at(known: Sequence[KnownMeans], kind: str, place: int, i: int) -> tuple[str, float, float]:
    """The first reference not made by this kind of solver that has an answer here: its label, mean and error."""
    for each in known:
        if each.kind != kind and math.isfinite(each.means[place][i]):
            return each.label, float(each.means[place][i]), float(each.errors[place][i])
    return "", math.nan, math.nan
