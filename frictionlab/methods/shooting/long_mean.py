"""The mean friction of motions that do not repeat, over a long time, with an error from its own scatter.

Averages weighted by a bump that vanishes with all its derivatives at both ends (Birkhoff averages) converge faster
than any power of the time where a motion is quasi-periodic, and as slowly as plain ones where it is chaotic. That
tells the two apart (Das, Sander, Saiki & Yorke 2017, Nonlinearity 30, 4111).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from frictionlab.laws.base import FrictionLaw
from frictionlab.theory.rest import friction_at_rest
from frictionlab.values.quantities import Floats

BLOCKS = 8
"""Parts of each motion whose means are compared; each long against the time in which motions forget."""
WINDOWS = 4
"""Halves of a motion, overlapping, whose weighted means are compared."""
REGULAR, SETTLED = 0.1, 1e-3
"""How far apart weighted means of a quasi-periodic motion are, over what chaos would leave plain ones, and over how
much those of single periods scatter: chaos comes below the first alone now and then."""
TWO_SIGMA = (math.inf, 13.97, 4.527, 3.307, 2.869, 2.649, 2.517, 2.429, 2.366, 2.320, 2.284, 2.255, 2.231)
"""Student's t of two standard deviations (95.45 %), by degrees of freedom; beyond, 2 (1 + 1.3/n) is within .01."""
MOST_ALIKE = 0.9
"""Largest correlation of neighbouring blocks that is believed: beyond, the time is too short to tell it."""
SAME_MEAN, LEAST_APART = 1.5, 1e-6
"""Difference of two means, over what their errors together allow at two standard errors, that keeps them one; and the
smallest that tells them apart."""
EARNED = 1e-3
"""Largest error of a mean that is told, over friction at rest."""
DRIVEN, FREE = "drive periods", "periods of the free mass"
"""What it is taken over."""
SHARED = "states that differ have this mean: "
"""Said before a description of them."""


class LongMean(NamedTuple):
    """A mean over a long time, two standard errors of it, and whether the motion is quasi-periodic (else chaotic)."""

    mean: float
    error: float
    quasi_periodic: bool

    def sentence(self, window: float, of: str) -> str:
        """What it is a mean of."""
        named = "quasi-periodic" if self.quasi_periodic else "chaotic"
        return f"the motion does not repeat ({named}): its mean over {window:.0f} {of}"


def is_earned(error: float, law: FrictionLaw, tolerance: float) -> bool:
    """Check that a long mean is known well enough: to the tolerance, or to a thousandth of friction at rest."""
    return error <= max(tolerance, EARNED * friction_at_rest(law))


def too_wide(mean: float, error: float) -> str:
    """Return why a long mean is not told."""
    return f"is known to be {mean:.4g} +- {error:.2g} only, which is no answer"


def birkhoff_mean(values: Floats) -> float:
    """The average of evenly spaced values with the weight exp(-1/(s (1 - s))), s from 0 to 1.

    >>> import numpy as np
    >>> turns = np.cos(2.0 * np.pi * 0.618034 * np.arange(1000) + 1.0)
    >>> bool(abs(birkhoff_mean(turns)) < 1e-12 < abs(turns.mean()))
    True
    """
    s = (np.arange(len(values)) + 0.5) / len(values)
    weights = np.exp(-1.0 / (s * (1.0 - s)))
    return float(weights @ values / weights.sum())


def long_mean(motions: Sequence[Floats]) -> LongMean:
    """The mean friction over all of several motions on one attractor, from the means of their periods [n] each."""
    by_blocks = [np.array([part.mean() for part in np.array_split(each, BLOCKS)]) for each in motions]
    error = _error_of_blocks(by_blocks)
    weighted = [birkhoff_mean(each) for each in motions]
    halves = max(
        abs(birkhoff_mean(half) - whole)
        for each, whole in zip(motions, weighted, strict=True)
        for half in _halves(each)
    )
    apart = max(halves, max(weighted) - min(weighted))
    if apart <= min(REGULAR * error, SETTLED * float(np.concatenate(motions).std())):
        return LongMean(float(np.mean(weighted)), 2.0 * apart, True)
    return LongMean(float(np.mean(by_blocks)), error, False)


def near_each_other(one: LongMean, other: LongMean) -> bool:
    """Whether two means may be those of one attractor."""
    return abs(one.mean - other.mean) <= SAME_MEAN * math.hypot(one.error, other.error) + LEAST_APART


def spread_of_one_mean(means: Sequence[float], errors: Sequence[float], tolerance: float) -> float:
    """By how much the means of states differ that pass for one number, within the tolerance; else NaN.

    Motions next to a doubling, or that close in on an orbit slower than they are followed, differ without a
    difference in their means. tolerance: 0 where one of them is a long mean, known to no more than its error.
    """
    spread, doubt = float(np.ptp(means)), float(np.max(errors))
    known = tolerance - doubt if tolerance else SAME_MEAN * math.sqrt(2.0) * doubt + LEAST_APART
    return spread if spread <= known else math.nan


def _halves(values: Floats) -> list[Floats]:
    """Parts half as long, from evenly spread beginnings."""
    half = len(values) // 2
    return [values[first : first + half] for first in np.linspace(0, half, WINDOWS).astype(int)]


def _error_of_blocks(motions: Sequence[Floats]) -> float:
    """Two standard errors of the mean of all blocks, of which neighbours in time may be alike."""
    values = np.concatenate(motions)
    scatter = values - values.mean()
    variance = float(scatter @ scatter)
    if variance == 0.0:
        return 0.0
    parts = np.split(scatter, len(motions))
    neighbours = sum(float(part[1:] @ part[:-1]) for part in parts)
    pairs = len(values) - len(motions)
    # few blocks say little of their correlation, and their own mean takes some of it away
    alike = min(max(neighbours / pairs * len(values) / variance + 1.0 / BLOCKS, 0.0), MOST_ALIKE)
    freedom = max(int((len(values) - 1) * (1.0 - alike) / (1.0 + alike)), 1)
    student = TWO_SIGMA[freedom] if freedom < len(TWO_SIGMA) else 2.0 * (1.0 + 1.3 / freedom)
    deviation = math.sqrt(variance / (len(values) - 1))
    return student * deviation / math.sqrt(len(values)) * math.sqrt((1.0 + alike) / (1.0 - alike))
