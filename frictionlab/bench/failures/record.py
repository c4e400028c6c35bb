"""The record of a failure map: belt speed against one other number of a scene or law, and what theory says of it."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np

from frictionlab.bench.record import ReferenceSource
from frictionlab.laws.base import FrictionLaw
from frictionlab.quantities import Floats
from frictionlab.scene.scene import Scene
from frictionlab.scene.scenes import Scenes
from frictionlab.study import GridValue, Study
from frictionlab.theory import friction_free_velocity
from frictionlab.theory.rest import can_hold, friction_at_rest
from frictionlab.theory.uniqueness import is_unique

OF_FRICTION_TO_LOAD = ("scene.normal_load", "scene.drive.amplitude", "scene.drive.unbalance")
"""Quantities that are drawn as friction over load."""
_HALVINGS = 30
"""Of the interval between two values of the grid in which an edge lies."""


class NamedPoint(NamedTuple):
    """A point of a map with a name: its belt speed [scene velocity] and the value of the other quantity."""

    name: str
    belt_speed: float
    value: float


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
