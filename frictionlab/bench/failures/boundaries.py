"""What theory says about a map: lines over belt speed and the other quantity where something changes."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from frictionlab.bench.failures.record import FailureMap
from frictionlab.laws.base import FrictionLaw
from frictionlab.quantities import Floats
from frictionlab.scene.scene import Scene
from frictionlab.theory import friction_free_velocity
from frictionlab.theory.rest import can_hold
from frictionlab.theory.uniqueness import is_unique

_HALVINGS = 30
"""Of the interval between two values of the grid in which an edge lies."""


class ConditionEdge(NamedTuple):
    """Where a condition on the other quantity alone changes: the ordinates at which it does, and where it holds.

    holds: ``everywhere``, ``nowhere``, ``above`` or ``below`` the edge; ``in part`` for several edges.
    """

    ordinates: tuple[float, ...]
    holds: str


def free_velocities(drawn: FailureMap) -> tuple[Floats, Floats]:
    """V_lin at every value of the map, and the ordinates; infinite where the friction-free motion has no bound."""
    speeds = [friction_free_velocity(row.scenes[0], row.law) for row in drawn.rows]
    return np.array(speeds), np.array([drawn.ordinate(row) for row in drawn.rows])


def uniqueness_edge(drawn: FailureMap) -> ConditionEdge:
    """Where theorem T1 proves that the steady state is the only one and attracts every start."""
    return _edge(drawn, is_unique)


def rest_edge(drawn: FailureMap) -> ConditionEdge:
    """Where static friction can hold the mass against the load on a belt at rest."""
    return _edge(drawn, can_hold)


def _edge(drawn: FailureMap, condition: Callable[[Scene, FrictionLaw], bool]) -> ConditionEdge:
    def true(value: float) -> bool:
        row = drawn.row(value, drawn.speeds[-1:])
        return condition(row.scenes[0], row.law)

    values = drawn.values.tolist()
    told = [true(value) for value in values]
    if len(set(told)) == 1:
        return ConditionEdge((), "everywhere" if told[0] else "nowhere")
    places = [i for i in range(len(told) - 1) if told[i] != told[i + 1]]
    found = [_between(true, values[i], values[i + 1]) for i in places]
    ordinates = tuple(drawn.ordinate(drawn.row(value, drawn.speeds[-1:])) for value in found)
    if len(found) > 1:
        return ConditionEdge(ordinates, "in part")
    rows = drawn.rows
    rises = drawn.ordinate(rows[-1]) > drawn.ordinate(rows[0])
    return ConditionEdge(ordinates, "above" if told[-1] == rises else "below")


def _between(true: Callable[[float], bool], low: float, high: float) -> float:
    """Where a condition changes between two values > 0, or between two of any sign."""
    at_low = true(low)
    for _ in range(_HALVINGS):
        middle = math.sqrt(low * high) if low > 0.0 else 0.5 * (low + high)
        low, high = (middle, high) if true(middle) == at_low else (low, middle)
    return low
