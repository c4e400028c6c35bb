"""What the mean Coulomb friction along a line can be at most and at least: motions that reverse twice a period.

Between two reversals the mass is a linear oscillator, so a steady motion whose slip is forward for a part of the
period and backward for the rest is known in closed form once that share is chosen, with all its harmonics; the
belt speed it belongs to follows. Where such a motion is consistent (no stick, no further reversal) it is the
steady state: Coulomb friction has one (Leine & van de Wouw, Stability and Convergence of Mechanical Systems with
Unilateral Constraints, 2008). Elsewhere its neighbours bound it, for the mean friction never falls as the belt
speeds up: for two belt speeds v, w with steady motions x, y, the difference of their equations times the
difference of their slips averages to (v - w)(mean_v - mean_w) friction >= 2 beta <(x' - y')^2>.

Source: Den Hartog, Trans. ASME 53 (1931) for the belt at rest; with a moving belt this derivation.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from frictionlab.numerics.roots import monotone_root
from frictionlab.quantities import Floats

SHARES: Floats = 0.5 * 10.0 ** np.linspace(-5.0, 0.0, 101)
"""Shares of forward slip looked at where neighbours must bound a mean, down to grazing."""
COALESCED = 1e-5
"""Smallest distance kept between the two free exponents: critical damping is approached, never met."""


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


class _Free(NamedTuple):
    """The free oscillation after jumps that repeat every period: sum of weight*exp(exponent t), 0 <= t < period."""

    exponents: NDArray[np.complex128]
    weights: NDArray[np.complex128]
    period: float

    def rise(self, t: Floats) -> Floats:
        """Green's function at t less that at 0, without cancellation."""
        return self._sum(self.weights, np.expm1(self._powers(t)))

    def rise_before(self, t: Floats) -> Floats:
        """The same at period - t."""
        powers = self._powers(t)
        ends = np.exp(self._powers(self.period - t))
        return self._sum(-self.weights, ends * np.expm1(powers))

    def slope(self, t: Floats) -> Floats:
        """Its time derivative, at 0 that after the jump."""
        return self._sum(self.weights * self.exponents, np.exp(self._powers(t)))

    def _powers(self, t: Floats) -> NDArray[np.complex128]:
        return np.asarray(t)[..., None] * self.exponents

    def _sum(self, weights: NDArray[np.complex128], values: NDArray[np.complex128]) -> Floats:
        return (values @ weights).real


def _free(line: Line) -> _Free:
    """Periodic Green's function of x'' + 2 beta x' + x."""
    period = 2.0 * math.pi / line.frequency
    root = np.sqrt(complex(line.damping_ratio**2 - 1.0))
    root = root if abs(root) > COALESCED else COALESCED
    exponents = np.array([root - line.damping_ratio, -root - line.damping_ratio])
    if line.damping_ratio > 1.0:
        exponents[0] = 1.0 / exponents[1]  # their product is 1: no cancellation in the slow one
    signs = np.array([1.0, -1.0], np.complex128)
    return _Free(exponents, signs / (-2.0 * root * np.expm1(exponents * period)), period)


def motions(line: Line, share: Floats) -> Motions:
    """The motions whose slip is forward for these shares of the period, in (0, 1/2].

    With jumps of friction at the ends of forward slip, the slip vanishes at both: their difference gives where
    in the period forward slip lies, their mean the belt speed.
    """
    free = _free(line)
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
    free, half = _free(line), math.pi * found.share
    time, peak = found.share * free.period, line.friction_free * line.frequency
    here = free.slope(np.zeros(1))
    start = peak * np.cos(found.middle - half) - 2.0 * line.friction * (here - free.slope(free.period - time))
    end = peak * np.cos(found.middle + half) - 2.0 * line.friction * (free.slope(time) - here)
    return start, end


def _extreme_slip(line: Line, found: Motions, leg: float) -> Floats:
    """The slip nearest to reversal inside forward slip (leg 0) or, negative, inside backward slip (leg 1).

    Slip is smooth inside a leg and sampled finely against drive and free motion; between samples a parabola.
    """
    free, half = _free(line), math.pi * found.share
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


def bounds(line: Line, belt_speeds: Floats) -> tuple[Floats, Floats]:
    """Least and largest mean friction, relative to mu, at these belt speeds >= 0."""
    low, high = np.zeros(len(belt_speeds)), np.ones(len(belt_speeds))
    beyond = belt_speeds >= line.friction_free
    low[beyond] = 1.0
    high[belt_speeds == 0.0] = 0.0
    open_points = np.flatnonzero(~beyond & (belt_speeds > 0.0))
    if len(open_points):
        low[open_points], high[open_points] = _bounds_in_reversal(line, belt_speeds[open_points])
    return low, high


def _bounds_in_reversal(line: Line, belt_speeds: Floats) -> tuple[Floats, Floats]:
    found = _at(line, belt_speeds)
    mean = 1.0 - 2.0 * found.share
    settled = consistent(line, found) & (np.abs(found.belt_speed - belt_speeds) <= 1e-9 * line.friction_free)
    low, high = mean.copy(), mean.copy()
    if not settled.all():
        near = _sure_points(line)
        for i in np.flatnonzero(~settled):
            low[i], high[i] = _between(near, belt_speeds[i])
    return low, high


def _at(line: Line, belt_speeds: Floats) -> Motions:
    """The motions at these belt speeds; the belt speed rises as the share of forward slip falls."""

    def excess(share: Floats, belt_speed: Floats) -> Floats:
        speed = motions(line, share).belt_speed
        return np.where(np.isnan(speed), line.friction_free, speed) - belt_speed

    size = np.full(len(belt_speeds), 1.0)
    return motions(line, monotone_root(excess, 1e-9 * size, 0.5 * size, belt_speeds))


def _sure_points(line: Line) -> Motions:
    """Consistent motions along the curve, the end of each consistent stretch located more closely."""
    found = motions(line, SHARES)
    sure = consistent(line, found)
    edges = np.flatnonzero(sure[1:] != sure[:-1])
    inside, outside = np.where(sure[edges], edges, edges + 1), np.where(sure[edges], edges + 1, edges)
    good, bad = SHARES[inside], SHARES[outside]
    for _ in range(12):
        middle = 0.5 * (good + bad)
        holds = consistent(line, motions(line, middle))
        good, bad = np.where(holds, middle, good), np.where(holds, bad, middle)
    return motions(line, np.concatenate([SHARES[sure], good]))


def _between(sure: Motions, belt_speed: float) -> tuple[float, float]:
    """The closest means known on either side: 0 for a belt at rest, 1 from V_lin on."""
    mean = 1.0 - 2.0 * sure.share
    below, above = mean[sure.belt_speed <= belt_speed], mean[sure.belt_speed >= belt_speed]
    return float(below.max(initial=0.0)), float(above.min(initial=1.0))
