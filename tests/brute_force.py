"""A mass under Coulomb friction by brute force: small steps with matrix exponentials, events by binary descent.

Written for tests alone; it shares no formula and no code with the methods it checks. Every mode of motion is a
linear system in (x, v, sin, cos, friction impulse, 1); its matrix exponentials over a step, half a step, a quarter
... move the state to an event bit by bit. It can miss what begins and ends within one step: halve the step and
compare.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numba
import numpy as np
from scipy.linalg import expm

HALVINGS = 48


class Numbers(NamedTuple):
    """x'' + 2 damping x' + x + friction Sgn(x' - belt_speed) = load sin(frequency tau)."""

    damping: float
    frequency: float
    load: float
    friction: float
    belt_speed: float


class Found(NamedTuple):
    """The friction impulse over the last period, how far that period was from closing, and the state at its end."""

    impulse: float
    closing: float
    x: float
    v: float


def propagators(scene: Numbers, step: float) -> np.ndarray:
    """Matrix exponentials [mode, halving, 6, 6] over step/2^halving; modes: slip -, stick, slip +."""
    b, omega, p, f, vb = scene
    free = np.zeros((3, 6, 6))
    for mode, sign in enumerate((-1.0, 0.0, 1.0)):
        a = free[mode]
        a[0, 1] = 1.0
        a[2, 3], a[3, 2] = omega, -omega
        if sign == 0.0:
            a[4] = [-1.0, 0.0, p, 0.0, 0.0, -2.0 * b * vb]
        else:
            a[1] = [-1.0, -2.0 * b, p, 0.0, 0.0, -sign * f]
            a[4, 5] = sign * f
    return np.array([[expm(a * step / 2.0**k) for k in range(HALVINGS)] for a in free])


@numba.njit
def _times(matrix, state):
    out = np.zeros(6)
    for i in range(6):
        for j in range(6):
            out[i] += matrix[i, j] * state[j]
    return out


@numba.njit
def _net(state, scene):
    return scene.load * state[2] - 2.0 * scene.damping * scene.belt_speed - state[0]


@numba.njit
def _margin(mode, state, scene):
    """What must stay positive for the mode to hold, and the sign of its rate."""
    if mode == 1:
        net = _net(state, scene)
        rate = scene.load * scene.frequency * state[3] - scene.belt_speed
        return scene.friction - abs(net), -rate if net > 0.0 else rate
    side = mode - 1
    acceleration = scene.load * state[2] - 2.0 * scene.damping * state[1] - state[0] - side * scene.friction
    return side * (state[1] - scene.belt_speed), side * acceleration


@numba.njit
def _mode_at_rest(state, scene):
    net = _net(state, scene)
    if abs(net) <= scene.friction:
        return 1
    return 2 if net > 0.0 else 0


@numba.njit
def _bottom(matrices, mode, state, scene, halving):
    """The least margin within a step whose margin first falls and then rises."""
    for k in range(halving + 1, HALVINGS):
        trial = _times(matrices[mode, k], state)
        if _margin(mode, trial, scene)[1] < 0.0:
            state = trial
    return _margin(mode, state, scene)[0]


@numba.njit
def _descend(matrices, mode, state, scene, halving):
    """Up to the event within a step, bit by bit; the time it took, in steps."""
    taken = 0.0
    for k in range(halving + 1, HALVINGS):
        trial = _times(matrices[mode, k], state)
        margin, rate = _margin(mode, trial, scene)
        before = _margin(mode, state, scene)[1]
        if margin >= 0.0 and not (before < 0.0 <= rate):
            state, taken = trial, taken + 0.5**k
    return _times(matrices[mode, HALVINGS - 1], state), taken + 0.5 ** (HALVINGS - 1)


@numba.njit
def _period(matrices, scene, state, steps):
    """One period from tau = 0; every event restarts the steps, the last one is cut into binary parts."""
    state[2], state[3], state[4] = 0.0, 1.0, 0.0
    w = state[1] - scene.belt_speed
    size = abs(state[1]) + scene.belt_speed + 1e-300
    mode = _mode_at_rest(state, scene) if abs(w) < 1e-15 * size else (2 if w > 0.0 else 0)
    left = float(steps)  # in steps
    while left > 2.0 ** (1 - HALVINGS):
        halving = max(0, math.ceil(-math.log2(left)))
        if halving >= HALVINGS:
            break
        trial = _times(matrices[mode, halving], state)
        rate_before = _margin(mode, state, scene)[1]
        margin, rate = _margin(mode, trial, scene)
        holds = margin >= 0.0
        if holds and rate_before < 0.0 < rate:
            holds = _bottom(matrices, mode, state, scene, halving) >= -1e-14 * size
        if holds:
            state, left = trial, left - 0.5**halving
            continue
        state, taken = _descend(matrices, mode, state, scene, halving)
        left = left - taken
        state[1] = scene.belt_speed
        mode = (2 if _net(state, scene) > 0.0 else 0) if mode == 1 else _mode_at_rest(state, scene)
    return state


@numba.njit
def _periods(matrices, scene, start, steps, periods):
    state = start.copy()
    before = state.copy()
    for _ in range(periods):
        before = state.copy()
        state = _period(matrices, scene, state, steps)
    return state, math.hypot(state[0] - before[0], state[1] - before[1])


def follow(scene: Numbers, start: tuple[float, float], periods: int, steps: int) -> Found:
    """So many periods from start = (x, v) at tau = 0, with so many steps per period."""
    matrices = propagators(scene, 2.0 * math.pi / scene.frequency / steps)
    state = np.array([start[0], start[1], 0.0, 1.0, 0.0, 1.0])
    state, closing = _periods(matrices, scene, state, steps, periods)
    return Found(float(state[4]), float(closing), float(state[0]), float(state[1]))


def steps_per_period(scene: Numbers, fineness: int) -> int:
    """``fineness`` steps per period, per free oscillation and per time of the fastest decay."""
    period = 2.0 * math.pi / scene.frequency
    fast = max(1.0, 2.0 * scene.damping)
    return math.ceil(fineness * max(1.0, period * fast / (2.0 * math.pi)))
