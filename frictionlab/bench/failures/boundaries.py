"""What theory says about a map: lines over belt speed and the other quantity where something changes."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from frictionlab.bench.failures.record import FailureMap, GridRow
from frictionlab.laws.base import FrictionLaw
from frictionlab.quantities import Floats
from frictionlab.scene.scene import Scene
from frictionlab.theory import friction_free_velocity
from frictionlab.theory.rest import can_hold
from frictionlab.theory.uniqueness import is_unique

_HALVINGS = 30
"""Of the interval between two values of the grid in which an edge lies."""


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
