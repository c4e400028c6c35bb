"""Exponential decay from 1 to 0.

Stribeck friction decays so over speed, the initial deflection of a bristle over slip.
"""

from __future__ import annotations

import math


def exp_power_decay(u: float, power: float) -> float:
    """Compute exp(-u^power) at speed u [Stribeck speeds] (Bo & Pavelescu, 1982)."""
    if power == 2.0:  # a product is faster than a power
        return exp_decay(u * u)
    if u <= 0.0:
        return 1.0
    logarithm = power * math.log(u)
    return exp_decay(math.exp(logarithm)) if logarithm < 5.0 else 0.0  # the power itself may overflow


def steepest_slope(power: float) -> float:
    """Return the largest slope of ``exp_power_decay``, that at its inflection.

    It is infinite, at rest, for powers below one.
    """
    if power < 1.0:
        return math.inf
    bend = 1.0 - 1.0 / power  # u^power there
    return power * bend**bend * math.exp(-bend)


def exp_decay(lengths: float) -> float:
    """Compute exp(-lengths) for a number of decay lengths >= 0; 0 if it is far below rounding."""
    # an exponential that underflows takes ten times as long
    return math.exp(-lengths) if lengths < 60.0 else 0.0
