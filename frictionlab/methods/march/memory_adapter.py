"""The kernel of time stepping for laws with several memories or scalars: the laps of ``marching`` with an array."""

from __future__ import annotations

import math
from typing import Any

from frictionlab.compile.decorators import inner
from frictionlab.dynamics.motion import acceleration_under
from frictionlab.methods.march.bristle_adapter import nothing_held
from frictionlab.methods.march.laps import Advance, Marcher, Node, Problem, marcher, note_straight
from frictionlab.methods.periodic.maps.memory_state import memory_of, pulled
from frictionlab.numerics.steppers import memory_rk4
from frictionlab.numerics.steppers.grid import BELT, LOAD, NORMAL_LOAD


@inner
def _rates(problem: Problem, j: int, x: Any, v: Any, memory: Any, moving: Any) -> Any:
    """Acceleration and friction coefficient; a scalar that has left its set makes the motion not a number."""
    law, w = problem.law, v - problem.grid[j, BELT].real
    if law.turning == 0.0 and not law.within(memory):
        return math.nan * x, math.nan * x
    for k in range(memory.size):
        moving[k] = law.rate(w, memory, k)
    rub = law.friction(w, memory, moving)
    push, pressed = problem.grid[j, LOAD], problem.grid[j, NORMAL_LOAD].real
    return acceleration_under(problem.body, push, pressed, x, v, rub), rub


_step = memory_rk4.stepper(_rates)


@inner
def _by_rk4(problem: Problem, node: Node, h: float) -> Advance:
    """A step after which every deflection that it has left beyond its reach is brought back."""
    taken = _step(problem, node.k, node.x, node.v, node.z, h)
    pulled(problem.law, taken.z, memory_of(problem.law, node.x))
    return Advance(taken.x, taken.v, taken.rubbed, False, 1.0, taken.z)


@inner
def _keep(kept: Any, row: int, z: Any) -> None:
    for k in range(z.size):
        kept[row, k] = z[k]


march_memory_rk4 = marcher(Marcher("memory_rk4", _by_rk4, note_straight, nothing_held, _keep))
