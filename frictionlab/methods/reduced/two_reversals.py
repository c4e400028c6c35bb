"""Motions under Coulomb friction along a line whose slip reverses twice a period and never rests.

Between two reversals the mass is a linear oscillator, so a steady motion whose slip is forward for a part of the
period and backward for the rest is known in closed form once that share is chosen, with all its harmonics; the
belt speed it belongs to follows. Where such a motion is consistent (no stick, no further reversal) it is the
steady state: Coulomb friction has one (Leine & van de Wouw, Stability and Convergence of Mechanical Systems with
Unilateral Constraints, 2008).

Source: Den Hartog, Trans. ASME 53 (1931) for the belt at rest; with a moving belt this derivation.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from frictionlab.methods.reduced.switching import Jumps
from frictionlab.numerics.roots import monotone_root
from frictionlab.quantities import Floats


class Line(NamedTuple):
    """A 1DOF scene in the numbers needed: friction = mu*normal_load and V_lin, the friction-free amplitude."""

    damping_ratio: float
    frequency: float
    friction: float
    friction_free: float


class Motions(NamedTuple):
    """Motions of two reversals, one for each share of forward slip: belt speed and the middle of forward slip.

    middle: phase of the friction-free velocity there, in [0, pi]; NaN where no such motion exists.
    """

    share: Floats
    belt_speed: Floats
    middle: Floats


def motions(line: Line, share: Floats) -> Motions:
    """The motions whose slip is forward for these shares of the period, in (0, 1/2].

    With jumps of friction at the ends of forward slip, the slip vanishes at both: their difference gives where
    in the period forward slip lies, their mean the belt speed.
    """
    free = Jumps.of(line.damping_ratio, line.frequency)
    time, half = share * free.period, math.pi * share
    after, before = -free.rise(time), -free.rise_before(time)
    cosine = -line.friction * (after + before) / (line.friction_free * np.sin(half))
    sine = np.sqrt(np.maximum(0.0, 1.0 - cosine**2))
    speed = line.friction_free * sine * np.cos(half) + line.friction * (after - before)
    middle = np.where(np.abs(cosine) <= 1.0, np.arctan2(sine, cosine), np.nan)
    return Motions(share, np.where(np.isnan(middle), np.nan, speed), middle)


def consistent(line: Line, found: Motions) -> NDArray[np.bool_]:
    """Whether slip reverses at the two ends of forward slip and nowhere else, and the mass never sticks."""
    start, end = _accelerations_after_reversal(line, found)
    inside = _extreme_slip(line, found, 0.0)
    outside = _extreme_slip(line, found, 1.0)
    with np.errstate(invalid="ignore"):
        return (start > 0.0) & (end < 0.0) & (inside > 0.0) & (outside < 0.0)


def _accelerations_after_reversal(line: Line, found: Motions) -> tuple[Floats, Floats]:
    """Just after forward slip starts and just after it ends; of the other sign where the mass sticks."""
    free, half = Jumps.of(line.damping_ratio, line.frequency), math.pi * found.share
    time, peak = found.share * free.period, line.friction_free * line.frequency
    here = free.slope(np.zeros(1))
    start = peak * np.cos(found.middle - half) - 2.0 * line.friction * (here - free.slope(free.period - time))
    end = peak * np.cos(found.middle + half) - 2.0 * line.friction * (free.slope(time) - here)
    return start, end


def _extreme_slip(line: Line, found: Motions, leg: float) -> Floats:
    """The slip nearest to reversal inside forward slip (leg 0) or, negative, inside backward slip (leg 1).

    Slip is smooth inside a leg and sampled finely against drive and free motion; between samples a parabola.
    """
    free, half = Jumps.of(line.damping_ratio, line.frequency), math.pi * found.share
    time = found.share * free.period
    length = time if leg == 0.0 else free.period - time
    count = 24 + 24 * math.ceil(max(1.0, line.damping_ratio) / line.frequency)
    inner = (np.arange(count) + 1.0) / (count + 1.0)
    since = length[:, None] * inner  # since the last reversal
    other = since + (free.period - length)[:, None]  # since the one before
    start = (found.middle - half if leg == 0.0 else found.middle + half)[:, None]
    drive = line.friction_free * np.sin(start + line.frequency * since)
    sign = 1.0 if leg == 0.0 else -1.0
    rub = 2.0 * line.friction * sign * (free.rise(since) - free.rise(other))
    slip = sign * (drive - rub - found.belt_speed[:, None])
    return sign * _least(slip)


def _least(slip: Floats) -> Floats:
    """The minimum of each row, that of the parabola through three samples included."""
    left, at, right = slip[:, :-2], slip[:, 1:-1], slip[:, 2:]
    bend = left - 2.0 * at + right
    dip = (at <= left) & (at <= right) & (bend > 0.0)
    depth = np.where(dip, at - (right - left) ** 2 / (8.0 * np.where(dip, bend, 1.0)), np.inf)
    return np.minimum(slip.min(axis=1), depth.min(axis=1))


def motions_at(line: Line, belt_speeds: Floats) -> Motions:
    """The motions at belt speeds below ``line.friction_free``, which rise as the share of forward slip falls."""

    def excess(share: Floats, belt_speed: Floats) -> Floats:
        speed = motions(line, share).belt_speed
        return np.where(np.isnan(speed), line.friction_free, speed) - belt_speed

    size = np.full(len(belt_speeds), 1.0)
    return motions(line, monotone_root(excess, 1e-9 * size, 0.5 * size, belt_speeds))
