"""Motions of H harmonics that reverse their slip twice a period, Coulomb friction balanced in all of them.

Forward slip lasts from ``middle - half`` to ``middle + half``, phases of the friction-free velocity. That slip
vanishes at both ends gives the middle from the half, explicitly, and the belt speed to which they belong.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from frictionlab.methods.reduced.switch_response import SwitchResponse
from frictionlab.quantities import Floats

_SHORTEST = 1e-6
"""Half of forward slip [rad] below which none is looked for."""
_MOST_STEPS = 80
_FOUND = 1e-13
"""Change of the half of forward slip [rad] at which the search ends."""
_SAMPLES_PER_HARMONIC = 8
_FEWEST_SAMPLES = 128
_UNSIGNED = 1e-10
"""Slip that is taken for none where its sign is looked at [friction-free velocity amplitude]."""


class DrivenLine(NamedTuple):
    """The mass along the belt: how it answers friction that switches, the friction force and V_lin."""

    response: SwitchResponse
    friction: float
    friction_free: float


class Reversals(NamedTuple):
    """One motion at each belt speed; settled: whether its slip has the direction that friction has, at all times."""

    half: Floats
    middle: Floats
    settled: NDArray[np.bool_]


def balanced_reversals(line: DrivenLine, belt_speeds: Floats) -> Reversals:
    """The motions at belt speeds in [0, V_lin)."""
    half = _halves(line, belt_speeds)
    middle = _of(line, half).middle
    found = Reversals(half, middle, np.isfinite(middle))
    return found._replace(settled=found.settled & _keeps_its_signs(line, found, belt_speeds))


class _Motions(NamedTuple):
    """Motions by their halves: belt speed, its derivative, and the middle; NaN where friction allows none."""

    belt_speed: Floats
    slope: Floats
    middle: Floats


def _of(line: DrivenLine, half: Floats) -> _Motions:
    u, free, friction = line.response, line.friction_free, line.friction
    both, apart, both_rise, apart_rise = u.around(2.0 * half)
    # Slip vanishes at both ends: the difference of the two equations, then their sum.
    cosine = friction * both / (free * np.sin(half))
    sine = np.sqrt(np.maximum(0.0, (1.0 - cosine) * (1.0 + cosine)))
    speed = free * sine * np.cos(half) - friction * apart
    turning = 2.0 * friction * both_rise / (free * np.sin(half)) - cosine / np.tan(half)
    with np.errstate(divide="ignore", invalid="ignore"):
        slope = -free * (cosine * turning / sine * np.cos(half) + sine * np.sin(half))
    slope = slope - 2.0 * friction * apart_rise
    middle = np.where(np.abs(cosine) <= 1.0, np.arctan2(sine, cosine), np.nan)
    return _Motions(np.where(np.isnan(middle), np.nan, speed), slope, middle)


def _halves(line: DrivenLine, belt_speeds: Floats) -> Floats:
    """Newton's method between two ends, on all belt speeds at once; cut in two where a step leaves them."""
    low, high = np.full_like(belt_speeds, _SHORTEST), np.full_like(belt_speeds, 0.5 * math.pi)
    fastest = _of(line, low[:1]).belt_speed
    half = np.arccos(np.minimum(belt_speeds / line.friction_free, 1.0))
    # On faster belts forward slip is no more than _SHORTEST, if there is such a motion at all.
    half = np.where(belt_speeds >= fastest, np.nan, half)
    half = np.where(belt_speeds == 0.0, high, half)
    for _ in range(_MOST_STEPS):
        found = _of(line, half)
        # Where friction allows no such motion it is too short: the belt would run faster than V_lin.
        excess = np.where(np.isnan(found.belt_speed), line.friction_free, found.belt_speed) - belt_speeds
        low, high = np.where(excess > 0.0, half, low), np.where(excess > 0.0, high, half)
        with np.errstate(divide="ignore", invalid="ignore"):
            following = half - excess / found.slope
        inside = (following >= low) & (following <= high)
        following = np.where(inside, following, 0.5 * (low + high))
        moved, half = np.abs(following - half), following
        if not np.any(moved > _FOUND):
            break
    return np.where(belt_speeds == 0.0, 0.5 * math.pi, half)


def _keeps_its_signs(line: DrivenLine, found: Reversals, belt_speeds: Floats) -> NDArray[np.bool_]:
    """Whether slip goes on in its new direction after both reversals, and has the direction meant at every sample."""
    u, half, middle = line.response, found.half, found.middle
    start, end = middle - half, middle + half
    free, friction = line.friction_free, line.friction
    at_once = float(u.slope(np.zeros(1))[0])
    rises = free * np.cos(start) - 2.0 * friction * (at_once - u.slope(-2.0 * half))
    falls = free * np.cos(end) - 2.0 * friction * (u.slope(2.0 * half) - at_once)
    count = max(_FEWEST_SAMPLES, _SAMPLES_PER_HARMONIC * len(u.orders))
    phase = np.arange(count) * (math.tau / count)
    slip = slip_samples(line, found, belt_speeds, count)
    forward = np.cos(phase - middle[:, None]) > np.cos(half)[:, None]
    least = np.where(forward, slip, -slip).min(axis=1)
    with np.errstate(invalid="ignore"):
        return np.asarray((rises > 0.0) & (falls < 0.0) & (least > -_UNSIGNED * free))


def slip_samples(line: DrivenLine, found: Reversals, belt_speeds: Floats, count: int) -> Floats:
    """The slip velocity at ``count`` equal steps of the friction-free phase from 0 on, by one row a motion."""
    u = line.response
    ends = found.middle - found.half, found.middle + found.half
    orders = np.arange(1, len(u.orders) + 1)
    switched = u.turns(-ends[0]) - u.turns(-ends[1])
    spectrum = np.zeros((len(belt_speeds), count // 2 + 1), np.complex128)
    spectrum[:, 0] = -belt_speeds
    spectrum[:, orders] = -line.friction * u.coefficients * switched
    spectrum[:, 1] += -0.5j * line.friction_free
    slip = np.fft.irfft(spectrum * count, count, axis=1)
    if u.beyond:
        phase = np.arange(count) * (math.tau / count)
        after = [u.beyond_velocity(phase - end[:, None]) for end in ends]
        slip = slip - 2.0 * line.friction * (after[0] - after[1])
    return np.asarray(slip)
