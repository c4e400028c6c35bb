"""The bounds of gap.py along the friction-free motion of one harmonic, in closed form: one number tells its fault.

Friction along the harmonic slip w~ moves the slip of the linear response by at most ``fault``: |w_y - w~| <= fault.
The integrand of the bound is then largest where w_y is as far from w~ as it can be towards the other sign, and

    <lambda> - <lambda~> <= 2 theta <(fault + 1/theta - |w~|)_+ over w~ < 0>,  theta fault <= 1,

with the other sign over w~ > 0: both are arcsines. Halves of this module's functions are for w~ < 0 and w~ > 0.
"""

from __future__ import annotations

import math

import numpy as np

from frictionlab.methods.reduced.reversals import Driven
from frictionlab.methods.reduced.switching import Jumps
from frictionlab.quantities import EPSILON, Floats

LEVELS = (2.0, 3.0, 5.0)
"""fault + 1/theta, in faults: two for reversals passed at speed, more for those that barely happen."""
SERIES = 0.1
"""Angle below which differences of an angle and its sine are summed as series."""


def closed_bound(body: Driven, belt_speeds: Floats) -> Floats:
    """The largest error of (2/pi) arcsin(v_b/V_lin) at belt speeds 0 <= v_b < V_lin, rounding included.

    Relative to mu; of a body driven by one harmonic.
    """
    free = float(abs(body.free[0]))
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        reversal = _angle(np.minimum(belt_speeds / free, 1.0), np.maximum(1.0 - belt_speeds / free, 0.0))
        fault = largest_fault(body, reversal)
        found = [_error(free, belt_speeds, reversal, fault, level) for level in LEVELS]
    least = np.fmin.reduce(found)
    return np.where(np.isnan(least), 2.0, np.minimum(least, 2.0)) + 32.0 * EPSILON


def largest_fault(body: Driven, reversal: Floats) -> Floats:
    """How far the velocity answers two switches of friction 2*reversal/frequency apart at most, and its rounding."""
    jumps = Jumps.of(body.damping_ratio, body.frequency)
    apart = 2.0 * reversal / body.frequency
    swing = np.minimum(jumps.largest_rise(), apart * jumps.steepest_slope())
    return 2.0 * body.friction * swing * (1.0 + 1e-8) + body.unsure() * abs(body.free[0])


def _error(free: float, belt_speeds: Floats, reversal: Floats, fault: Floats, level: float) -> Floats:
    """From one theta; relative to mu."""
    reach = level * fault
    slow, fast = (belt_speeds - reach) / free, (belt_speeds + reach) / free
    back = _angle(np.maximum(slow, -1.0), 1.0 - np.maximum(slow, -1.0))
    below = _below(reversal, back) + np.where(slow < -1.0, (-1.0 - slow) * (back - reversal), 0.0)
    ahead = _angle(np.minimum(fast, 1.0), np.maximum(1.0 - fast, 0.0))
    above = _above(ahead, reversal) + np.where(fast > 1.0, (fast - 1.0) * reversal, 0.0)
    return 2.0 * free / ((level - 1.0) * fault) * np.maximum(below, above) / math.pi * (1.0 + 1e-12)


def _angle(cosine: Floats, below_one: Floats) -> Floats:
    """arccos, without cancellation near 1."""
    return np.where(
        cosine > 0.5, 2.0 * np.arcsin(np.sqrt(0.5 * np.minimum(below_one, 1.0))), np.arccos(cosine)
    )


def _below(start: Floats, end: Floats) -> Floats:
    """The integral of cos(angle) - cos(end) from start to end."""
    middle, half = 0.5 * (start + end), 0.5 * (end - start)
    return 2.0 * (np.cos(middle) * _less_cosine(half) + half * np.sin(middle) * np.sin(half))


def _above(start: Floats, end: Floats) -> Floats:
    """The integral of cos(start) - cos(angle) from start to end."""
    middle, half = 0.5 * (start + end), 0.5 * (end - start)
    return 2.0 * (half * np.sin(middle) * np.sin(half) - np.cos(middle) * _less_cosine(half))


def _less_cosine(angle: Floats) -> Floats:
    """Sine less angle times cosine."""
    square = angle * angle
    series = angle * square * (1.0 / 3.0 - square * (1.0 / 30.0 - square * (1.0 / 840.0 - square / 45360.0)))
    return np.where(angle < SERIES, series, np.sin(angle) - angle * np.cos(angle))
