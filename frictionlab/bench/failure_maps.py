"""The record of a failure map: belt speed against one other number of a scene or law, and what theory says of it.

What a method or peer says at every point of a map, and how far that is from an unrelated method's answer.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np

from frictionlab.bench.measure import SolverAnswers, known_means, solve_points
from frictionlab.bench.peers.base import Peer
from frictionlab.bench.record import Contender, ReferenceSource
from frictionlab.laws.base import FrictionLaw
from frictionlab.scene.scene import Scene
from frictionlab.scene.scenes import Scenes
from frictionlab.study.axes import GridValue
from frictionlab.study.study import Study
from frictionlab.theory import friction_free_velocity
from frictionlab.theory.rest import can_hold, friction_at_rest, is_unique
from frictionlab.values.quantities import Finite, Floats, Record

OF_FRICTION_TO_LOAD = ("scene.normal_load", "scene.drive.amplitude", "scene.drive.unbalance")
"""Quantities that are drawn as friction over load."""
_HALVINGS = 30
"""Of the interval between two values of the grid in which an edge lies."""


class NamedPoint(Record):
    """A point of a map with a name: its belt speed [scene velocity] and the value of the other quantity."""

    name: str
    belt_speed: Finite
    value: Finite


class GridRow(NamedTuple):
    """The scenes of a map at one value of the other quantity, which differ in belt speed alone."""

    value: float
    scenes: Scenes
    law: FrictionLaw

    @property
    def friction_to_load(self) -> float:
        """Largest friction at rest over the amplitude of the load along the belt; NaN where nothing loads a mass."""
        scene = self.scenes.scene
        if scene.degrees_of_freedom == 0 or not scene.mass().force:
            return math.nan
        mass = scene.mass()
        return friction_at_rest(self.law) * mass.normal_load / abs(mass.force)


@dataclass(frozen=True)
class FailureMap:
    """A grid of scenes: belt speed along, another quantity across.

    quantity: its path, ``scene.<path>`` or ``laws.<label>.<parameter>``; study: has both sweeps and one law.
    """

    name: str
    title: str
    study: Study
    speed_path: str
    quantity: str
    points: tuple[NamedPoint, ...]
    references: tuple[ReferenceSource, ...]

    @cached_property
    def speeds(self) -> Floats:
        """The belt speeds, ascending."""
        return np.sort(np.array(self.study.sweep[self.speed_path], dtype=np.float64))

    @cached_property
    def values(self) -> Floats:
        """The values of the other quantity, ascending."""
        return np.sort(np.array(self.study.sweep[self.quantity], dtype=np.float64))

    @cached_property
    def rows(self) -> tuple[GridRow, ...]:
        """The grid, a row for each value; raises StudyError where one cannot be built."""
        return tuple(self.row(float(value), self.speeds) for value in self.values)

    @cached_property
    def named_rows(self) -> tuple[GridRow, ...]:
        """The named points, a row of one scene for each."""
        return tuple(self.row(point.value, [point.belt_speed]) for point in self.points)

    def row(self, value: float, speeds: Sequence[float] | Floats) -> GridRow:
        """The scenes at any value and belt speeds."""
        along = tuple(float(speed) for speed in speeds)
        sweep: dict[str, tuple[GridValue, ...]] = {self.speed_path: along, self.quantity: (value,)}
        (curve,) = replace(self.study, sweep=sweep, ranges={}).curves()
        return GridRow(value, curve.scenes, curve.law)

    def ordinate(self, row: GridRow) -> float:
        """What a row is drawn at: its value, or friction over load where the quantity makes that vary."""
        return row.friction_to_load if self.quantity in OF_FRICTION_TO_LOAD else row.value


# --- what theory says of a map: lines where something changes ---------------------------------------------------


def free_velocities(drawn: FailureMap) -> tuple[Floats, Floats]:
    """V_lin at every value of the map, and the ordinates; infinite where the friction-free motion has no bound."""
    speeds = [friction_free_velocity(row.scenes[0], row.law) for row in drawn.rows]
    return np.array(speeds), np.array([drawn.ordinate(row) for row in drawn.rows])


def edges(drawn: FailureMap) -> dict[str, tuple[float, ...]]:
    """The ordinates at which a condition on the other quantity alone changes.

    unique: theorem T1 proves that the steady state is the only one and attracts every start. rest: static friction
    can hold the mass against the load on a belt at rest.
    """
    return {"unique": _edges(drawn, is_unique), "rest": _edges(drawn, can_hold)}


def _edges(drawn: FailureMap, condition: Callable[[Scene, FrictionLaw], bool]) -> tuple[float, ...]:
    def row(value: float) -> GridRow:
        return drawn.row(value, drawn.speeds[-1:])

    def true(value: float) -> bool:
        return condition(row(value).scenes[0], row(value).law)

    values = drawn.values.tolist()
    told = [true(value) for value in values]
    places = [i for i in range(len(told) - 1) if told[i] != told[i + 1]]
    return tuple(drawn.ordinate(row(_between(true, values[i], values[i + 1]))) for i in places)


def _between(true: Callable[[float], bool], low: float, high: float) -> float:
    """Where a condition changes between two values > 0, or between two of any sign."""
    at_low = true(low)
    for _ in range(_HALVINGS):
        middle = math.sqrt(low * high) if low > 0.0 else 0.5 * (low + high)
        low, high = (middle, high) if true(middle) == at_low else (low, middle)
    return low


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
