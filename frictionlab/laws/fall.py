"""How friction falls from rest to quick slip along the exponential Stribeck curve, from 1 to 0."""

from __future__ import annotations

import math


def fallen(u: float, power: float) -> float:
    """What is left of the fall at speed u [Stribeck speeds]: exp(-u^power) (Bo & Pavelescu, 1982)."""
    return math.exp(-(u**power))


def steepest_fall(power: float) -> float:
    """The largest slope of the fall over u, at its point of inflection; infinite at rest for powers below one."""
    if power < 1.0:
        return math.inf
    bend = 1.0 - 1.0 / power  # u^power there
    return power * bend**bend * math.exp(-bend)
