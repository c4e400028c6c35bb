"""Exponential decay from 1 to 0: of Stribeck friction over speed, of a bristle's initial deflection over slip."""

from __future__ import annotations

import math


def exp_power_decay(u: float, power: float) -> float:
    """exp(-u^power) at speed u [Stribeck speeds] (Bo & Pavelescu, 1982)."""
    if power == 2.0:  # a product is faster than a power
        return exp_decay(u * u)
    if u <= 0.0:
        return 1.0
    way = power * math.log(u)
    return exp_decay(math.exp(way)) if way < 5.0 else 0.0  # the power itself may overflow


def steepest_slope(power: float) -> float:
    """The largest slope of ``exp_power_decay``, at its point of inflection; infinite at rest for powers below one."""
    if power < 1.0:
        return math.inf
    bend = 1.0 - 1.0 / power  # u^power there
    return power * bend**bend * math.exp(-bend)


def exp_decay(ways: float) -> float:
    """exp(-ways), ways >= 0 being a number of decay lengths; 0 where that is far below rounding."""
    return math.exp(-ways) if ways < 60.0 else 0.0  # an exponential that underflows takes ten times as long
