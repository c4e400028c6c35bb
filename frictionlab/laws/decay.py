"""Exponential falls from 1 to 0: of friction over speed, of what a bristle remembers over the way slid."""

from __future__ import annotations

import math


def fallen(u: float, power: float) -> float:
    """What is left of the fall at speed u [Stribeck speeds]: exp(-u^power) (Bo & Pavelescu, 1982)."""
    if power == 2.0:  # a product is quicker than a power
        return faded(u * u)
    if u <= 0.0:
        return 1.0
    way = power * math.log(u)
    return faded(math.exp(way)) if way < 5.0 else 0.0  # the power itself may overflow


def steepest_fall(power: float) -> float:
    """The largest slope of the fall over u, at its point of inflection; infinite at rest for powers below one."""
    if power < 1.0:
        return math.inf
    bend = 1.0 - 1.0 / power  # u^power there
    return power * bend**bend * math.exp(-bend)


def faded(ways: float) -> float:
    """exp(-ways): what is left after so many lengths slid; nothing at once where that is far below rounding."""
    return math.exp(-ways) if ways < 60.0 else 0.0  # an exponential that underflows takes ten times as long
