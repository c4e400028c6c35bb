"""Kernels of time stepping for laws with bristles: the laps of ``marching``, with a deflection to be stepped too."""

from __future__ import annotations

import math
from typing import Any

from frictionlab.compile.decorators import inner
from frictionlab.dynamics.contact import advance_bristle, project_to_yield, resistance
from frictionlab.dynamics.motion import restoring_force
from frictionlab.methods.march.laps import (
    Advance,
    Marcher,
    Node,
    Problem,
    keep_number,
    marcher,
    note_straight,
)
from frictionlab.numerics.steppers import bristle_rk4, exponential, sdirk2


@inner
def _rates(problem: Problem, load: Any, x: Any, v: Any, z: Any) -> Any:
    """Acceleration, friction coefficient and rate of deflection under a load."""
    rate, rub = resistance(problem.law, v - problem.belt_speed, z)
    return load - restoring_force(problem.body, x, v) - problem.body.normal_load * rub, rub, rate


@inner
def _rates_of_the_grid(problem: Problem, j: int, x: Any, v: Any, z: Any) -> Any:
    return _rates(problem, problem.loads[j], x, v, z)


@inner
def _rates_at(problem: Problem, tau: float, x: Any, v: Any, z: Any) -> Any:
    body, angle = problem.body, problem.body.frequency * tau
    return _rates(problem, body.force_sine * math.sin(angle) + body.force_cosine * math.cos(angle), x, v, z)


_rk4_step = bristle_rk4.stepper(_rates_of_the_grid)
_exponential_step = exponential.stepper(restoring_force, resistance, advance_bristle)
_sdirk2_step = sdirk2.stepper(_rates_at)


@inner
def _by_rk4(problem: Problem, node: Node, h: float) -> Advance:
    taken = _rk4_step(problem, node.k, node.x, node.v, node.z, h)
    return Advance(taken.x, taken.v, taken.rubbed, False, 1.0, project_to_yield(problem.law, taken.z))


@inner
def _by_exponential(problem: Problem, node: Node, h: float) -> Advance:
    taken = _exponential_step(problem, node.k, node.x, node.v, node.z, h)
    return Advance(taken.x, taken.v, taken.rubbed, False, 1.0, taken.z)


@inner
def _by_sdirk2(problem: Problem, node: Node, h: float) -> Advance:
    taken = _sdirk2_step(problem, node.tau, node.x, node.v, node.z, h)
    return Advance(taken.x, taken.v, taken.rubbed, False, 1.0, project_to_yield(problem.law, taken.z))


@inner
def nothing_held(law: Any) -> float:
    """A contact that gives never rests."""
    return 0.0


march_bristle_rk4 = marcher(Marcher("bristle_rk4", _by_rk4, note_straight, nothing_held, keep_number))
march_exponential = marcher(Marcher("exponential", _by_exponential, note_straight, nothing_held, keep_number))
march_sdirk2 = marcher(Marcher("sdirk2", _by_sdirk2, note_straight, nothing_held, keep_number))
