"""The limit of a sequence of values from halved steps or halved smoothing widths, with an error bound."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

SURE = 0.25
"""Largest relative deviation of the observed ratio of two changes from that of the order."""
FEWEST = 4
"""Values needed to observe an order twice."""


class Limit(NamedTuple):
    """The limit of a sequence, a bound on its error, and the order used for extrapolation."""

    value: float
    error: float
    order: int  # 0: none was observed


SMOOTH, STICKING, REVERSING = 0.2, 1.0, math.inf
"""Smallest share of Richardson's correction that is added to the error: for smooth motion; for stick, which keeps the
order but not the regularity of the error; for reversals inside a step, where errors are irregular."""


def richardson(values: Sequence[float], order: int, least: float) -> Limit:
    """The limit of values from steps halved each time, of a method of this order on smooth motion.

    Where two consecutive ratios of changes agree with the order: Richardson's extrapolation (1911), with at least the
    share ``least`` of the correction as error. Otherwise the last value with an error of order one: 1.5 times the
    largest of the last three changes, each divided by 2 (without reversals 3) per halving since.
    """
    changes = np.diff(values)
    if len(values) >= FEWEST and least < math.inf and _seen(changes, order):
        rest = changes[-1] / (2.0**order - 1.0)
        doubt = 2.0 * abs(changes[-2] / changes[-1] / 2.0**order - 1.0)
        return Limit(float(values[-1] + rest), float(abs(rest) * max(least, doubt)), order)
    rate = 2.0 if least == REVERSING else 3.0
    recent = [abs(change) / rate**age for age, change in enumerate(changes[::-1][:3])]
    return Limit(float(values[-1]), 1.5 * float(max(recent)), 0)


def _seen(changes: np.ndarray, order: int) -> bool:
    """Whether the last three changes decrease in the ratio of the order."""
    if (changes[-3:] == 0.0).any():
        return False
    ratios = changes[-3:-1] / changes[-2:]
    return bool((np.abs(ratios / 2.0**order - 1.0) < SURE).all())


SLOWEST = 0.8
"""Largest ratio of a change to the one before at which errors of steps that are still too long are taken to fall."""


def first_error(values: Sequence[float]) -> float:
    """Bound on the distance of the first of three values to the limit, from those of steps halved once and twice.

    At order one with half as much again; where both changes go one way and the second is more than half the first,
    at the ratio that is seen: steps that are still too long converge more slowly than their order says.
    """
    first, last = values[1] - values[0], values[2] - values[1]
    seen = min(last / first, SLOWEST) if first * last > 0.0 else 0.0
    return max(1.5 * max(abs(first), abs(first + last)), abs(first + last / (1.0 - seen)))


def bias(wide: float, asked: float, narrow: float, narrowest: float) -> float:
    """Bound on the bias of smoothing at a width, from the values at twice, once, half and a quarter of that width.

    A bias of order q in the width is 1/(1 - 2^-q) times its change from the width to half of it, and 1/(1 - 4^-q)
    times that to a quarter: 3.4 and 2 for the square root, the slowest; the latter is taken as 3, for at the onset of
    stick the bias is slower to begin with, and as 6 where the changes still grow as the width shrinks. Where the bias
    changes sign with the width one of the changes may be small, so the largest counts.
    """
    still_growing = abs(narrow - narrowest) > abs(asked - narrow)
    far = 6.0 if still_growing else 3.0
    return max(3.5 * abs(asked - narrow), far * abs(asked - narrowest), 1.75 * abs(wide - asked))
