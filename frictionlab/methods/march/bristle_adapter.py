"""Kernels of time stepping for laws with bristles: the laps of ``marching``, with a deflection to be stepped too."""

from __future__ import annotations

from typing import Any

from frictionlab.compile.decorators import embedded, inner
from frictionlab.dynamics.contact import advance_bristle, project_to_yield, resistance
from frictionlab.dynamics.motion import acceleration, acceleration_under, instant_at, slip
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
from frictionlab.numerics.steppers.grid import BELT, LOAD, NORMAL_LOAD


@embedded
def _rates_of_the_grid(problem: Problem, j: int, x: Any, v: Any, z: Any) -> Any:
    """Acceleration, friction coefficient and rate of deflection at a half step."""
    rate, rub = resistance(problem.law, v - problem.grid[j, BELT].real, z)
    push, pressed = problem.grid[j, LOAD], problem.grid[j, NORMAL_LOAD].real
    return acceleration_under(problem.body, push, pressed, x, v, rub), rub, rate


@embedded
def _rates_at(problem: Problem, tau: float, x: Any, v: Any, z: Any) -> Any:
    """The same at any time."""
    body, now = problem.body, instant_at(problem.body, tau)
    rate, rub = resistance(problem.law, slip(body, problem.belt_speed, now, v), z)
    return acceleration(body, now, x, v, rub), rub, rate


_rk4_step = bristle_rk4.stepper(_rates_of_the_grid)
_exponential_step = exponential.stepper(acceleration_under, resistance, advance_bristle)
_sdirk2_step = sdirk2.stepper(_rates_at)


@inner
def _by_rk4(problem: Problem, node: Node, h: float) -> Advance:
    taken = _rk4_step(problem, node.k, node.x, node.v, node.z, h)
    return Advance(taken.x, taken.v, taken.rubbed, False, 1.0, project_to_yield(problem.law, taken.z))


@embedded
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
