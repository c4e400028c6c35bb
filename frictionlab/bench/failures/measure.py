"""What a method or peer says at every point of a map, and how far that is from an unrelated method's answer."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np

from frictionlab.bench.failures.record import FailureMap, GridRow
from frictionlab.bench.peers.base import Peer
from frictionlab.bench.record import Contender, ReferenceSource
from frictionlab.bench.solvers import SolverAnswers, known_means, solve_points
from frictionlab.quantities import Floats

OUTCOMES = ("ok", "refused", "failed", "not_unique", "silent")
"""What a point can come to. ``silent``: a number that is wrong without a word: for a method its true error is above
the error it states, for a peer above ten times the tolerance asked, each with the reference's own error added."""
PEER_MARGIN = 10.0
MOTION = ("stick_fraction", "reversals")


class KnownMeans(NamedTuple):
    """The answers of a reference on a map: mean friction and its error, NaN where it has none, a row for each value
    and one for each named point. more: the columns of ``MOTION``, of a method.
    """

    label: str
    kind: str
    means: list[Floats]
    errors: list[Floats]
    more: list[dict[str, Floats]]


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

    @cached_property
    def known(self) -> list[KnownMeans]:
        """The answers of every reference."""
        return [self._known(trusted) for trusted in self.drawn.references]

    def motions(self) -> dict[str, Floats]:
        """Where on the grid the slip reverses or sticks, and where the mass sticks, by the first method among the
        references: 1 or 0, NaN where that is not known; a row for each value.
        """
        first = next((each.more for each in self.known if each.more[0]), None)
        if first is None:
            return {}
        rows = first[: len(self.drawn.rows)]
        stick, turns = (np.array([row[name] for row in rows]) for name in MOTION)
        sticks = np.where(np.isnan(stick), np.nan, stick > 0.0)
        return {
            "reverses": np.where(np.isnan(turns), np.nan, (stick > 0.0) | (turns > 0.0)),
            "sticks": sticks,
        }

    def _known(self, trusted: ReferenceSource) -> KnownMeans:
        assert trusted.solver is not None
        rows = (*self.drawn.rows, *self.drawn.named_rows)
        methods = (each for each in self.drawn.references if not isinstance(each.solver, Peer))
        wanted = MOTION if trusted is next(methods, None) else ()
        found = [solve_points(trusted.solver, row.scenes, row.law, trusted.tolerance, wanted) for row in rows]
        pairs = [
            known_means(trusted, each, row.scenes, row.law) for each, row in zip(found, rows, strict=True)
        ]
        means, errors = (list(part) for part in zip(*pairs, strict=True))
        return KnownMeans(trusted.label, trusted.kind, means, errors, [each.more for each in found])


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
        replace(points[0], point=point.name) for points, point in zip(rows[size:], drawn.points, strict=True)
    ]
    return MapOutcome(drawn, tuple(rows[:size]), tuple(named))


def _row(
    truth: MapTruth, contender: Contender, place: int, row: GridRow, outcome: SolverAnswers
) -> tuple[PointOutcome, ...]:
    (setting, solver), ratio = contender.solvers[0], row.friction_to_load
    found = []
    for i, speed in enumerate(row.scenes.belt_speeds.tolist()):
        label, mean, known = _reference_at(truth.known, contender.kind, place, i)
        status, stated = outcome.status[i], float(outcome.errors[i])
        off = abs(float(outcome.means[i]) - mean) if status == "ok" else math.nan
        claimed = PEER_MARGIN * setting.tolerance if isinstance(solver, Peer) else stated
        said = "silent" if status == "ok" and off > claimed + known else status
        stated = stated if status == "ok" else math.nan
        point = speed, row.value, ratio, said, outcome.reason[i], stated, off, label, known
        found.append(PointOutcome(*point))
    return tuple(found)


def _reference_at(known: Sequence[KnownMeans], kind: str, place: int, i: int) -> tuple[str, float, float]:
    """The first reference not made by this kind of solver that has an answer here: its label, mean and error."""
    for each in known:
        if each.kind != kind and math.isfinite(each.means[place][i]):
            return each.label, float(each.means[place][i]), float(each.errors[place][i])
    return "", math.nan, math.nan
