"""One step of a mass and its memory: its order at the end and between the ends."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np
import pytest
from profiles import deep

import frictionlab as fl
from frictionlab.compile.cache import compiled
from frictionlab.compile.decorators import njit
from frictionlab.compile.stack import count_of
from frictionlab.motion.equation import anchored
from frictionlab.motion.maps.linearization import linearize
from frictionlab.motion.maps.rates import MEMORY, workspace
from frictionlab.motion.maps.step import bend, step, within_step
from frictionlab.scene.body import in_the_plane, on_the_line

compiling = deep("more kernels to compile")
BELT_SPEED, START = 1.0, 0.1
SOFT = fl.LuGre(mu_kinetic=0.3, mu_static=0.5, stiffness=2, damping=0.01, stribeck_speed=0.5)


@njit
def steps(law: Any, body: Any, h: float, many: int, start: Any, zero: Any) -> Any:
    """So many steps from a state, and back into it."""
    work = workspace(law, zero, ())
    work.share[0] = 1.0
    n = count_of(law)
    for k in range(n):
        work.unit[k], work.size[k] = 1.0, 1e-2
    for row in range(MEMORY + n):
        work.start[row] = start[row]
    for turn in range(many):
        tau = START + turn * h
        flow = anchored(law, body, BELT_SPEED, -1.0, tau)
        linearize(flow, tau, work, zero)
        step(flow, tau, h, work, zero)
        for row in range(MEMORY + n):
            work.start[row] = work.end[row]
    for row in range(MEMORY + n):
        start[row] = work.start[row]


@njit
def inside(law: Any, body: Any, h: float, share: float, state: Any, zero: Any) -> Any:
    """The state a share into a step of h, from a state and back into it."""
    work = workspace(law, zero, ())
    work.share[0] = 1.0
    for k in range(count_of(law)):
        work.unit[k], work.size[k] = 1.0, 1e-2
    for row in range(state.size):
        work.start[row] = state[row]
    flow = anchored(law, body, BELT_SPEED, -1.0, START)
    linearize(flow, START, work, zero)
    step(flow, START, h, work, zero)
    bend(flow, work)
    within_step(flow, share, work)
    for row in range(state.size):
        state[row] = work.stage[row]


class System:
    """A mass on one bristle, and its steps."""

    def __init__(self, law: Any, planar: bool) -> None:
        across = fl.Transverse(natural_frequency=0.7, damping_ratio=0.1, load=fl.Load(unbalance=6))
        drive = fl.Drive(unbalance=10, frequency=1.5)
        scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=BELT_SPEED, drive=drive)
        mass = scene.model_copy(update={"transverse": across} if planar else {}).mass()
        self.law, self.planar, self.zero = law, planar, 0j if planar else 0.0
        self.body = in_the_plane(mass) if planar else on_the_line(mass)

    def start(self) -> Any:
        state = np.array([0.1 + 0.2j, -3.0 + 0.7j, 0.0, -3e-3 * (1.0 + 0.3j)])
        return state if self.planar else state.real.copy()

    def compiled(self, h: float, many: int) -> Any:
        state = self.start()
        compiled(steps, self.law)(self.body, h, many, state, self.zero)
        return state


@deep("kernels of its own")
@pytest.mark.parametrize("planar", [False, pytest.param(True, marks=compiling)], ids=["line", "plane"])
def test_a_step_is_of_order_five(planar: bool) -> None:
    span, errors = 0.1, []
    follow = partial(System(SOFT, planar).compiled)
    finest = follow(span / 256, 256)
    for many in (4, 8, 16):
        state = follow(span / many, many)
        errors.append(np.abs(state - finest).max())

    orders = np.log2(np.array(errors[:-1]) / np.array(errors[1:]))
    assert orders.min() > 4.5


@deep("kernels of its own")
@pytest.mark.parametrize("planar", [False, pytest.param(True, marks=compiling)], ids=["line", "plane"])
@pytest.mark.parametrize("share", [0.2, 0.7])
def test_a_step_is_known_to_order_four_between_its_ends(planar: bool, share: float) -> None:
    system, lengths, errors = System(SOFT, planar), np.array([1e-3, 2e-3, 4e-3]), []
    for h in lengths:
        exact = system.compiled(share * h / 64, 64)
        state = system.start()
        compiled(inside, SOFT)(system.body, h, share, state, system.zero)
        errors.append(np.abs(state - exact).max())

    orders = np.diff(np.log(errors)) / np.diff(np.log(lengths))
    assert orders.min() > 4.5
