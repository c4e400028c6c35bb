"""Motions under Coulomb friction along the belt that reverse their slip twice a period, in all harmonics.

Friction is +-1 and known from the instants at which it reverses. A linear mass answers unit steps of it by the same
velocity each, so that a motion of two reversals is known once the half of its forward slip is: that slip vanishes at
both ends gives the phase of the middle, explicitly, and the belt speed to which they belong.

Source: Den Hartog, Trans. ASME 53 (1931) for the belt at rest; with a moving belt this derivation.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from frictionlab.scene.body import Mass
from frictionlab.values.quantities import Floats

_COALESCED = 1e-5
"""Smallest distance kept between the two free exponents: critical damping is approached, never met."""
_SHORTEST = 1e-9
"""Half of forward slip [rad] below which none is looked for."""
_MOST_STEPS = 80
_FOUND = 1e-13
"""Change of the half of forward slip [rad] at which the search ends."""


class Around(NamedTuple):
    """Values of the velocity u after a unit step of force, at phases p in [0, 2 pi] after it and before it.

    both: u(p) + u(-p) - 2 u(0); apart: u(p) - u(-p); and their derivatives by p.
    """

    both: Floats
    apart: Floats
    both_slope: Floats
    apart_slope: Floats


StepResponse = Callable[[Floats], Around]


def exact_response(mass: Mass) -> StepResponse:
    """Sum of weight*exp(exponent t), 0 <= t < period, of the free oscillation; not finite in undamped resonance."""
    period, damping_ratio = math.tau / mass.frequency, 0.5 * mass.damping
    root = np.sqrt(complex(damping_ratio**2 - mass.stiffness))
    root = root if abs(root) > _COALESCED else _COALESCED
    exponents = np.array([root - damping_ratio, -root - damping_ratio])
    if damping_ratio**2 > mass.stiffness:
        exponents[0] = mass.stiffness / exponents[1]  # no cancellation in the slow one
    with np.errstate(divide="ignore", invalid="ignore"):
        weights = np.array([1.0, -1.0]) / (-2.0 * root * np.expm1(exponents * period))

    def around(phase: Floats) -> Around:
        since = phase[..., None] / mass.frequency * exponents
        until = np.exp(period * exponents - since)
        after, before = weights * np.expm1(since), -weights * until * np.expm1(since)
        rising, falling = weights * exponents * np.exp(since), weights * exponents * until
        sums = after + before, after - before, rising - falling, rising + falling
        shares = 1.0, 1.0, 1.0 / mass.frequency, 1.0 / mass.frequency
        return Around(*(share * each.sum(axis=-1).real for share, each in zip(shares, sums, strict=True)))

    return around


class DrivenLine(NamedTuple):
    """Mass along the belt: how it answers friction that switches, the friction force and V_lin."""

    response: StepResponse
    friction: float
    friction_free: float


class Reversals(NamedTuple):
    """Motions by the halves of their forward slip, which lasts from ``middle - half`` to ``middle + half``.

    Phases are those of the friction-free velocity. slope: of the belt speed by the half. Belt speed and middle are
    NaN where friction allows no such motion. Whether slip has the direction of friction in between is another matter.
    """

    half: Floats
    middle: Floats
    belt_speed: Floats
    slope: Floats


def reversals(line: DrivenLine, half: Floats) -> Reversals:
    """Return the motions of these halves, in (0, pi/2]."""
    u, free, friction = line.response(2.0 * half), line.friction_free, line.friction
    # Slip vanishes at both ends: the difference of the two equations, then their sum.
    cosine = friction * u.both / (free * np.sin(half))
    sine = np.sqrt(np.maximum(0.0, (1.0 - cosine) * (1.0 + cosine)))
    speed = free * sine * np.cos(half) - friction * u.apart
    turning = 2.0 * friction * u.both_slope / (free * np.sin(half)) - cosine / np.tan(half)
    with np.errstate(divide="ignore", invalid="ignore"):
        slope = -free * (cosine * turning / sine * np.cos(half) + sine * np.sin(half))
    slope = slope - 2.0 * friction * u.apart_slope
    middle = np.where(np.abs(cosine) <= 1.0, np.arctan2(sine, cosine), np.nan)
    return Reversals(half, middle, np.where(np.isnan(middle), np.nan, speed), slope)


def reversals_at(line: DrivenLine, belt_speeds: Floats) -> Reversals:
    """Return the motions at belt speeds in [0, V_lin), which rise as the half of forward slip falls.

    Newton's method between two ends, on all belt speeds at once; cut in two where a step leaves them.
    """
    low, high = np.full_like(belt_speeds, _SHORTEST), np.full_like(belt_speeds, 0.5 * math.pi)
    half = np.arccos(np.minimum(belt_speeds / line.friction_free, 1.0))
    half = np.where(belt_speeds == 0.0, high, np.maximum(half, low))
    for _ in range(_MOST_STEPS):
        found = reversals(line, half)
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
    return reversals(line, np.where(belt_speeds == 0.0, 0.5 * math.pi, half))
