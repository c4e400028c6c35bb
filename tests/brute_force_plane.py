"""A mass in the plane under Coulomb friction by brute force: Runge-Kutta steps as short as slip is slow.

Written for tests alone; it shares no formula and no code with the methods it checks. Slip that is next to rest turns
towards the force at the rate friction/slip: steps follow that, however many it takes. Rest is walked through in small
steps, its end found by bisection. The mean of a periodic motion comes from one near it by a Newton step whose
derivative is a difference quotient.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numba
import numpy as np

RESTS = 20_000
"""Steps of a period at rest."""


class PlaneNumbers(NamedTuple):
    """x'' + damping x' + stiffness x + friction w/|w| = sine sin + cosine cos, of frequency tau; w = x' - belt."""

    damping: tuple[float, float]
    stiffness: tuple[float, float]
    sine: tuple[float, float]
    cosine: tuple[float, float]
    frequency: float
    friction: float
    belt_speed: float


class Lap(NamedTuple):
    """A period later: the state, the integral of x along, when and where the longest rest was half over."""

    state: np.ndarray
    integral: float
    middle: float
    at: tuple[float, float]
    longest: float


@numba.njit
def _push(scene, tau, state, axis):
    turn = scene.frequency * tau
    v = state[2 + axis] + (scene.belt_speed if axis == 0 else 0.0)
    load = scene.sine[axis] * math.sin(turn) + scene.cosine[axis] * math.cos(turn)
    return load - scene.damping[axis] * v - scene.stiffness[axis] * state[axis]


@numba.njit
def _held(scene, tau, x, y):
    """The force at rest: its size and direction."""
    state = np.array([x, y, 0.0, 0.0])
    a, b = _push(scene, tau, state, 0), _push(scene, tau, state, 1)
    return math.hypot(a, b), math.atan2(b, a)


@numba.njit
def _wait(scene, tau, state, end):
    """Rest until the force exceeds friction; returns when."""
    h, start, x = 2.0 * math.pi / scene.frequency / RESTS, tau, state[0]
    while tau < end:
        there = min(tau + h, end)
        if _held(scene, there, x + scene.belt_speed * (there - start), state[1])[0] > scene.friction:
            low, high = tau, there
            for _ in range(60):
                middle = 0.5 * (low + high)
                size = _held(scene, middle, x + scene.belt_speed * (middle - start), state[1])[0]
                low, high = (middle, high) if size <= scene.friction else (low, middle)
            there, tau = high, end
        else:
            tau = there
    lasts = there - start
    state[4] += lasts * (x + 0.5 * scene.belt_speed * lasts)
    state[0] = x + scene.belt_speed * lasts
    state[2] = state[3] = 0.0
    return there


@numba.njit
def _set_off(scene, tau, state, h):
    """A first moment of slip, along the force, by the excess that it grows to; returns when."""
    x, y = state[0], state[1]
    before, _ = _held(scene, tau, x, y)
    half, _ = _held(scene, tau + 0.5 * h, x + 0.5 * scene.belt_speed * h, y)
    after, angle = _held(scene, tau + h, x + scene.belt_speed * h, y)
    speed = max(h * ((before + 4.0 * half + after) / 6.0 - scene.friction), 1e-300)
    state[4] += h * (x + 0.5 * scene.belt_speed * h)
    state[2], state[3] = speed * math.cos(angle), speed * math.sin(angle)
    state[0] += h * scene.belt_speed + h / 3.0 * state[2]
    state[1] += h / 3.0 * state[3]
    return tau + h


@numba.njit
def _step(scene, tau, h, state):
    """One Runge-Kutta step of order 4, in place."""
    x, y, u, v, total = state
    du, dv, dx, dy, dt = 0.0, 0.0, 0.0, 0.0, 0.0
    sums = (0.0, 0.0, 0.0, 0.0, 0.0)
    for share, weight in ((0.0, 1.0), (0.5, 2.0), (0.5, 2.0), (1.0, 1.0)):
        part = share * h
        x_, y_, u_, v_ = x + part * dx, y + part * dy, u + part * du, v + part * dv
        turn, size = scene.frequency * (tau + part), math.sqrt(u_ * u_ + v_ * v_)
        sine, cosine = math.sin(turn), math.cos(turn)
        dx, dy, dt = u_ + scene.belt_speed, v_, x_
        du = scene.sine[0] * sine + scene.cosine[0] * cosine - scene.damping[0] * dx - scene.stiffness[0] * x_
        dv = scene.sine[1] * sine + scene.cosine[1] * cosine - scene.damping[1] * dy - scene.stiffness[1] * y_
        du, dv = du - scene.friction * u_ / size, dv - scene.friction * v_ / size
        w = weight * h / 6.0
        sums = (sums[0] + w * dx, sums[1] + w * dy, sums[2] + w * du, sums[3] + w * dv, sums[4] + w * dt)
    state[0], state[1], state[2] = x + sums[0], y + sums[1], u + sums[2]
    state[3], state[4] = v + sums[3], total + sums[4]


@numba.njit
def _lap(scene, begin, start, fineness):
    tau, end = begin, begin + 2.0 * math.pi / scene.frequency
    quick = max(scene.frequency, math.sqrt(max(scene.stiffness[0], scene.stiffness[1])))
    state = np.zeros(5)
    state[:4] = start
    longest, middle, at, resting = 0.0, begin, (0.0, 0.0), math.hypot(start[2], start[3]) == 0.0
    while tau < end * (1.0 - 1e-15):
        if resting:
            since, x, y = tau, state[0], state[1]
            tau = _wait(scene, tau, state, end)
            if tau - since > longest:
                longest, middle = tau - since, 0.5 * (tau + since)
                at = (x + 0.5 * scene.belt_speed * (tau - since), y)
            if tau < end:
                tau = _set_off(scene, tau, state, min(2e-3 * fineness / quick, end - tau))
            resting = False
            continue
        speed = math.hypot(state[2], state[3])
        h = min(0.1 * fineness / quick, fineness * speed / scene.friction, end - tau)
        _step(scene, tau, h, state)
        tau += h
        after = math.hypot(state[2], state[3])
        if after < speed:
            size, _ = _held(scene, tau, state[0], state[1])
            # slip that slow is at rest before it has gone a rounding of the way
            if size < scene.friction and after * after < 1e-13 * (scene.friction - size):
                state[0] += 0.5 * state[2] * after / (scene.friction - size)
                resting = True
    return state, longest, middle, at


def lap(scene: PlaneNumbers, begin: float, start: np.ndarray, fineness: float) -> Lap:
    """One period from (x, y, slip along, slip across); fineness: of steps, as a share of slip's own time."""
    state, longest, middle, at = _lap(scene, begin, start, fineness)
    return Lap(state[:4], float(state[4]), float(middle), at, float(longest))


class MeanPosition(NamedTuple):
    """Of x along, how much of it is a correction of the motion it was found from, and what its steps leave open."""

    value: float
    corrected: float
    error: float


def mean_position(scene: PlaneNumbers, start: np.ndarray, fineness: float = 0.5) -> MeanPosition:
    """In the periodic motion near the one from start at tau = 0.

    From the middle of the longest rest, where two positions are all that is unknown; once with steps twice as long.
    """
    first = lap(scene, 0.0, start, 2.0 * fineness)
    assert first.longest > 0.0
    begin, z = first.middle, np.array([*first.at, 0.0, 0.0])
    period = 2.0 * math.pi / scene.frequency
    shift = 1e-3 * min(abs(scene.belt_speed) * period, math.hypot(*first.at))
    matrix, slope = np.zeros((2, 2)), np.zeros(2)
    for k in range(2):
        ahead = lap(scene, begin, z + shift * np.eye(4)[k], 2.0 * fineness)
        behind = lap(scene, begin, z - shift * np.eye(4)[k], 2.0 * fineness)
        matrix[:, k] = (ahead.state[:2] - behind.state[:2]) / (2.0 * shift)
        slope[k] = (ahead.integral - behind.integral) / (2.0 * shift * period)
    adjoint = np.linalg.solve((np.eye(2) - matrix).T, slope)
    fine, coarse = lap(scene, begin, z, fineness), lap(scene, begin, z, 2.0 * fineness)
    corrected, before = (float(adjoint @ (one.state[:2] - z[:2])) for one in (fine, coarse))
    value = fine.integral / period + corrected
    return MeanPosition(value, corrected, abs(value - coarse.integral / period - before))
