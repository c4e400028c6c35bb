"""Derivatives of the mean friction against differences of steady states, on scenes that auto answers quickly.

Of each scene NUMBERS numbers are drawn. The reference is the difference of two steady states over each of four
offsets, extrapolated from each to the next; its doubt is the least change from one to the next. A derivative agrees
where it is within its error and the doubt of the reference; it is doubtful where that is larger than the derivative,
blunt where the stated error is. There is no reference where steady states beside this one have no mean, or an onset
lies between them and it.
"""

from __future__ import annotations

import random
from itertools import pairwise
from typing import Any

import numpy as np
from campaign import WRONG, Campaign, Drawn, Verdicts

import frictionlab as fl
from drawers import driven
from frictionlab.analysis.quotients import Pair

NUMBERS, SLOWEST = 3, 0.3
OFFSETS = 1e-2, 2e-3, 4e-4, 8e-5
"""Of the size of a number."""
ONE_SIDED = 0.05
"""Difference of the one-sided slopes over an offset, of the slope, from which on an onset may lie within it."""
TOLERANCE = 1e-11


def draw(rng: np.random.Generator) -> Drawn | None:
    """A scene whose answer takes no more than SLOWEST seconds of kernels."""
    one = driven.draw(rng)
    return one if one is not None and fl.steady_state(*one.made()).seconds < SLOWEST else None


def slope(pair: Pair, path: str, number: float, offset: float) -> tuple[float, float]:
    """The difference of steady states on both sides, and its noise; NaN without two, or across an onset."""
    try:
        sides = [pair.with_(path, number + side * offset) for side in (1.0, -1.0)]
    except ValueError:
        return np.nan, np.nan
    states = [fl.steady_state(*each, tolerance=TOLERANCE) for each in sides]
    if not all(state.status == "ok" or state.error < 1e-6 for state in states):
        return np.nan, np.nan
    middle = fl.steady_state(*pair, tolerance=TOLERANCE).mean_friction
    means = [state.mean_friction for state in states]
    found = (means[0] - means[1]) / (2.0 * offset)
    noise = (states[0].error + states[1].error + 1e-15) / (2.0 * offset)
    bent = abs(means[0] - 2.0 * middle + means[1]) / offset > ONE_SIDED * abs(found) + 2.0 * noise
    return (np.nan if bent else found), noise


def reference(pair: Pair, path: str, number: float) -> tuple[float, float]:
    """The derivative by differences of steady states, and its doubt; NaN where there is no reference."""
    size = 90.0 if path.endswith("phase") else abs(number) or 1.0
    found = [slope(pair, path, number, offset * size) for offset in OFFSETS]
    ratio = (OFFSETS[0] / OFFSETS[1]) ** 2
    better = [(ratio * b - a) / (ratio - 1.0) for (a, _), (b, _) in pairwise(found)]
    doubts = [abs(b - a) + noise for (a, _), (b, noise) in pairwise(found)]
    if np.isnan(found[-1][0]) or not np.isfinite(doubts).any():
        return np.nan, np.nan
    best = int(np.nanargmin(doubts))
    return better[best], doubts[best]


def judge(one: Drawn) -> Verdicts:
    """Some derivatives."""
    pair = Pair(*one.made())
    paths = sorted(pair.numbers())
    chosen = random.Random(repr(one)).sample(paths, min(NUMBERS, len(paths)))
    for row in fl.sensitivities(*pair, chosen).itertuples():
        yield _verdict(row, *reference(pair, row.parameter, row.value))


def _verdict(row: Any, value: float, doubt: float) -> tuple[str, Any]:
    off = abs(row.derivative - value)
    if row.reason:
        return f"refused: {row.reason[:60]}", ""
    if np.isnan(value):
        return "no reference", ""
    if off > row.error + doubt:
        return f"{WRONG}: uncovered", (row, value, doubt)
    if row.error > abs(row.derivative) + 1e-6 / max(abs(row.value), 1e-6):
        return "blunt", ""
    return ("doubtful" if doubt > abs(value) and not off < 1e-9 else "agrees"), ""


CAMPAIGN = Campaign(draw, judge, scenes=300)
