"""One step of a mass and its memory: against elimination in full and interpreted laws, and its order."""

from __future__ import annotations

import math
from functools import partial
from typing import Any

import numpy as np
import pytest
from maxwell_slip import MaxwellSlip
from profiles import deep

import frictionlab as fl
from frictionlab.compile.cache import compiled
from frictionlab.compile.decorators import njit
from frictionlab.compile.stack import count_of
from frictionlab.dynamics.motion import anchored
from frictionlab.methods.periodic.maps.linearization import linearize
from frictionlab.methods.periodic.maps.rates import MEMORY, workspace
from frictionlab.methods.periodic.maps.step import bend, step, within_step
from frictionlab.numerics.steppers.rodas5p import COUPLINGS, GAMMA, INCREMENTS, SLOPES, STAGES, TIMES
from frictionlab.scene.body import in_the_plane, on_the_line

compiling = deep("more kernels to compile")
BELT_SPEED, START = 1.0, 0.1
LUGRE = fl.LuGre(mu_kinetic=0.3, mu_static=0.5, stiffness=40, damping=0.01, stribeck_speed=0.5)


@njit
def steps(law: Any, body: Any, h: float, many: int, start: Any, jacobian: Any, like: Any) -> Any:
    """So many steps from a state, and back into it; the blocks of the last step."""
    work = workspace(law, like, ())
    n = count_of(law)
    for k in range(n):
        work.unit[k], work.size[k] = 1.0, 1e-2
    for row in range(MEMORY + n):
        work.start[row] = start[row]
    for turn in range(many):
        tau = START + turn * h
        flow = anchored(law, body, BELT_SPEED, -1.0, tau)
        linearize(flow, tau, work, like)
        step(flow, tau, h, work, like)
        for row in range(MEMORY + n):
            work.start[row] = work.end[row]
    for row in range(MEMORY + n):
        start[row] = work.start[row]
    for row in range(2 * (3 * n + 1)):
        jacobian[row] = work.jacobian[row]


@njit
def inside(law: Any, body: Any, h: float, share: float, state: Any, like: Any) -> Any:
    """The state a share into a step of h, from a state and back into it."""
    work = workspace(law, like, ())
    for k in range(count_of(law)):
        work.unit[k], work.size[k] = 1.0, 1e-2
    for row in range(state.size):
        work.start[row] = state[row]
    flow = anchored(law, body, BELT_SPEED, -1.0, START)
    linearize(flow, START, work, like)
    step(flow, START, h, work, like)
    bend(flow, work)
    within_step(flow, share, work)
    for row in range(state.size):
        state[row] = work.stage[row]


class System:
    """The same motion by numpy and the interpreted law, as real numbers."""

    def __init__(self, law: Any, planar: bool) -> None:
        across = fl.Transverse(natural_frequency=0.7, damping_ratio=0.1, load=fl.Load(unbalance=6))
        drive = fl.Drive(unbalance=10, frequency=1.5)
        scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=BELT_SPEED, drive=drive)
        mass = scene.model_copy(update={"transverse": across} if planar else {}).mass()
        self.law, self.planar, self.like = law, planar, 0j if planar else 0.0
        self.body = in_the_plane(mass) if planar else on_the_line(mass)
        self.n = law.count() if isinstance(law, MaxwellSlip) else 1
        self.d = 2 if planar else 1

    def start(self) -> Any:
        z = [-3e-3 / (k + 1) * (1.0 + 0.3j) for k in range(self.n)]
        state = np.array([0.1 + 0.2j, -3.0 + 0.7j, 0.0, *z])
        return state if self.planar else state.real.copy()

    def real(self, state: Any) -> Any:
        return np.column_stack([state.real, state.imag]).ravel() if self.planar else np.array(state)

    def own(self, values: Any) -> Any:
        """The state of real numbers."""
        return values[0::2] + 1j * values[1::2] if self.planar else values

    def compiled(self, h: float, many: int) -> tuple[Any, Any]:
        state = self.start()
        jacobian = np.zeros(2 * (3 * self.n + 1), state.dtype)
        compiled(steps, self.law)(self.body, h, many, state, jacobian, self.like)
        return state, jacobian

    def rates(self, tau: float, values: Any) -> Any:
        body, law, (y, u, _, *memory) = self.body, self.law, self.own(values).tolist()
        sine, cosine = math.sin(body.frequency * tau), math.cos(body.frequency * tau)
        w = u + body.frequency * (body.reference_sine * cosine - body.reference_cosine * sine) - BELT_SPEED
        several = isinstance(law, MaxwellSlip)
        moving = [law.rate(w, memory, k) if several else law.rate(w, memory[0]) for k in range(self.n)]
        friction = law.friction(w, memory, moving) if several else law.friction(w, memory[0], moving[0])
        springs = body.stiffness_mean * y + body.stiffness_split * y.conjugate()
        dashpots = body.damping_mean * u + body.damping_split * u.conjugate()
        return self.real(np.array([u, -springs - dashpots - body.normal_load * friction, friction, *moving]))

    def matrix(self, blocks: Any, place: int) -> Any:
        """The matrix of one of the blocks that the kernel left."""
        a, b = blocks[2 * place], blocks[2 * place + 1]
        if not self.planar:
            return np.array([[a]])
        return np.array([[a.real + b.real, b.imag - a.imag], [a.imag + b.imag, a.real - b.real]])

    def full_jacobian(self, blocks: Any) -> Any:
        """Of all rates by all numbers, from the blocks of the law."""
        d, body, one = self.d, self.body, np.eye(self.d)
        drags = body.damping_mean + body.damping_split, body.damping_mean - body.damping_split
        springs = body.stiffness_mean + body.stiffness_split, body.stiffness_mean - body.stiffness_split
        size = 3 + self.n
        full = np.zeros((size, d, size, d))
        full[0, :, 1, :] = one
        full[1, :, 0, :] = -np.diag(springs[:d])
        full[2, :, 1, :] = self.matrix(blocks, 3 * self.n)
        for k in range(self.n):
            full[3 + k, :, 1, :] = self.matrix(blocks, 3 * k)
            full[3 + k, :, 3 + k, :] = self.matrix(blocks, 3 * k + 1)
            full[2, :, 3 + k, :] = self.matrix(blocks, 3 * k + 2)
        full[1, :, 1:, :] = -body.normal_load * full[2, :, 1:, :]
        full[1, :, 1, :] -= np.diag(drags[:d])
        return full.reshape(size * d, size * d)

    def slope(self, full: Any, tau: float) -> Any:
        """The rates by time: the slip of a mass whose deviation stays changes with the reference."""
        body = self.body
        angle = body.frequency * tau
        turn = body.reference_sine * math.sin(angle) + body.reference_cosine * math.cos(angle)
        turn = self.real(np.array([-(body.frequency**2) * turn]))
        by_slip = full[:, self.d : 2 * self.d].copy()
        by_slip[: self.d] = 0.0  # a position knows the velocity alone
        drags = body.damping_mean + body.damping_split, body.damping_mean - body.damping_split
        by_slip[self.d : 2 * self.d] += np.diag(drags[: self.d])  # as a dashpot does
        return by_slip @ turn

    def step(self, h: float, blocks: Any) -> Any:
        full, start = self.full_jacobian(blocks), self.real(self.start())
        slope, increments = self.slope(full, START), np.zeros((STAGES, start.size))
        matrix = np.eye(start.size) / (GAMMA * h) - full
        argument = start
        for i in range(STAGES):
            argument = start + INCREMENTS[i, :i] @ increments[:i]
            right = self.rates(START + TIMES[i] * h, argument) + h * SLOPES[i] * slope
            increments[i] = np.linalg.solve(matrix, right + COUPLINGS[i, :i] @ increments[:i] / h)
        return argument + increments[-1]


def elements(n: int) -> MaxwellSlip:
    return MaxwellSlip(mu=[0.4 / n] * n, stiffness=[10.0 * (k + 1) for k in range(n)])


@pytest.mark.parametrize(
    ("law", "planar"),
    [
        pytest.param(LUGRE, False, id="lugre, line"),
        pytest.param(LUGRE, True, id="lugre, plane", marks=compiling),
        pytest.param(elements(3), False, id="three elements, line", marks=compiling),
        pytest.param(elements(3), True, id="three elements, plane", marks=compiling),
        pytest.param(elements(1), False, id="one element, line", marks=compiling),
        pytest.param(elements(1), True, id="one element, plane", marks=compiling),
        pytest.param(elements(10), False, id="ten elements, line", marks=compiling),
        pytest.param(elements(10), True, id="ten elements, plane", marks=compiling),
    ],
)
@pytest.mark.parametrize("h", [1e-3, 0.2])
def test_elimination_along_the_arrow_is_elimination_in_full(law: Any, planar: bool, h: float) -> None:
    system = System(law, planar)

    state, blocks = system.compiled(h, 1)

    known = system.step(h, blocks)
    assert np.abs(system.real(state) - known).max() <= 1e-12 * np.abs(known).max()


@pytest.mark.parametrize("planar", [False, pytest.param(True, marks=compiling)], ids=["line", "plane"])
def test_a_step_is_of_order_five(planar: bool) -> None:
    soft = LUGRE.model_copy(update={"stiffness": 2.0})
    span, errors = 0.1, []
    follow = partial(System(soft, planar).compiled)
    finest, _ = follow(span / 256, 256)
    for many in (4, 8, 16):
        state, _ = follow(span / many, many)
        errors.append(np.abs(state - finest).max())

    orders = np.log2(np.array(errors[:-1]) / np.array(errors[1:]))
    assert orders.min() > 4.5


@pytest.mark.parametrize("planar", [False, pytest.param(True, marks=compiling)], ids=["line", "plane"])
@pytest.mark.parametrize("share", [0.2, 0.7])
def test_a_step_is_known_to_order_four_between_its_ends(planar: bool, share: float) -> None:
    soft = LUGRE.model_copy(update={"stiffness": 2.0})
    system, lengths, errors = System(soft, planar), np.array([1e-3, 2e-3, 4e-3]), []
    for h in lengths:
        exact, _ = system.compiled(share * h / 64, 64)
        state = system.start()
        compiled(inside, soft)(system.body, h, share, state, system.like)
        errors.append(np.abs(state - exact).max())

    orders = np.diff(np.log(errors)) / np.diff(np.log(lengths))
    assert orders.min() > 4.5
