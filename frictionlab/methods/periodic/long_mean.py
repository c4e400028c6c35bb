"""Mean friction of motions that do not repeat, over a long time, with an error from its own scatter.

A Birkhoff average has a weight that vanishes with all its derivatives at both ends. It converges faster than
any power of the time if the motion is quasi-periodic, and as slowly as a plain average if it is chaotic. This
difference distinguishes the two (Das, Sander, Saiki & Yorke 2017, Nonlinearity 30, 4111).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from frictionlab.laws.base import FrictionLaw
from frictionlab.scene.scene import Scene
from frictionlab.theory.rest import size_of_friction
from frictionlab.values.quantities import Floats

BLOCKS = 8
"""Number of parts of each motion whose means are compared.

Each part is long against the time in which a motion forgets its past."""
WINDOWS = 4
"""Number of overlapping halves of a motion whose weighted means are compared."""
REGULAR, SETTLED = 0.1, 1e-3
"""Largest difference of weighted means of a quasi-periodic motion, for two criteria that must both hold.

The first is relative to the error of the plain mean, the second to the standard deviation of the means of
single periods. Chaotic motion sometimes meets the first alone."""
TWO_SIGMA = (math.inf, 13.97, 4.527, 3.307, 2.869, 2.649, 2.517, 2.429, 2.366, 2.320, 2.284, 2.255, 2.231)
"""Student's t of two standard deviations (95.45 %), by degrees of freedom.

For more degrees of freedom n, 2 (1 + 1.3/n) is within 0.01."""
MOST_ALIKE = 0.9
"""Largest correlation of neighbouring blocks that is used: above it the time is too short to measure it."""
SAME_MEAN, LEAST_APART = 1.5, 1e-6
"""Largest difference of two means that count as one: SAME_MEAN times their joint error, plus LEAST_APART.

The errors of the means are two standard errors."""
EARNED = 1e-3
"""Largest error of a mean that is reported, over friction at rest."""
DRIVEN, FREE = "drive periods", "periods of the free mass"
"""Units of the time over which the mean is taken."""
SHARED = "states that differ have this mean: "
"""Text before a description of these states."""


class LongMean(NamedTuple):
    """Mean over a long time.

    error: two standard errors of a chaotic mean, twice the difference of weighted means of a quasi-periodic
    one. quasi_periodic: True if the motion is quasi-periodic, else it is chaotic.
    """

    mean: float
    error: float
    quasi_periodic: bool

    def sentence(self, window: float, of: str) -> str:
        """Return a sentence on the motion and the time over which the mean is taken."""
        named = "quasi-periodic" if self.quasi_periodic else "chaotic"
        return f"the motion does not repeat ({named}): its mean over {window:.0f} {of}"


def is_earned(error: float, scene: Scene, law: FrictionLaw, tolerance: float) -> bool:
    """Check that the error of a long mean is within the tolerance or a thousandth of friction at rest.

    Of a law that has none at rest it is that of quick slip.
    """
    return error <= max(tolerance, EARNED * size_of_friction(scene, law))


def too_wide(mean: float, error: float) -> str:
    """Return why a long mean is not reported."""
    return f"the mean is known to be {mean:.4g} +- {error:.2g} only, which is no answer"


def birkhoff_mean(values: Floats) -> float:
    """Return the average of evenly spaced values with the weight exp(-1/(s (1 - s))), s from 0 to 1.

    >>> import numpy as np
    >>> turns = np.cos(2.0 * np.pi * 0.618034 * np.arange(1000) + 1.0)
    >>> bool(abs(birkhoff_mean(turns)) < 1e-12 < abs(turns.mean()))
    True
    """
    s = (np.arange(len(values)) + 0.5) / len(values)
    weights = np.exp(-1.0 / (s * (1.0 - s)))
    return float(weights @ values / weights.sum())


def long_mean(motions: Sequence[Floats]) -> LongMean:
    """Return the mean friction over all of several motions on one attractor.

    motions: for each motion the means of its periods [n].
    """
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
    """Check whether two means may be those of one attractor."""
    return abs(one.mean - other.mean) <= SAME_MEAN * math.hypot(one.error, other.error) + LEAST_APART


def spread_of_one_mean(means: Sequence[float], errors: Sequence[float], tolerance: float) -> float:
    """Return the range of the means of several states if they count as one number; else NaN.

    Motions next to a period doubling differ without a difference in their means, as do motions that approach
    an orbit more slowly than they are followed. tolerance: largest range plus error; 0 if one of the means is
    a long mean, for which the joint error of two means is the limit.
    """
    spread, doubt = float(np.ptp(means)), float(np.max(errors))
    known = tolerance - doubt if tolerance else SAME_MEAN * math.sqrt(2.0) * doubt + LEAST_APART
    return spread if spread <= known else math.nan


def _halves(values: Floats) -> list[Floats]:
    """Return parts half as long, with evenly spaced beginnings."""
    half = len(values) // 2
    return [values[first : first + half] for first in np.linspace(0, half, WINDOWS).astype(int)]


def _error_of_blocks(motions: Sequence[Floats]) -> float:
    """Return two standard errors of the mean of all blocks, whose neighbours in time may be correlated."""
    values = np.concatenate(motions)
    scatter = values - values.mean()
    variance = float(scatter @ scatter)
    if variance == 0.0:
        return 0.0
    parts = np.split(scatter, len(motions))
    neighbours = sum(float(part[1:] @ part[:-1]) for part in parts)
    pairs = len(values) - len(motions)
    # few blocks show little of their correlation, and subtracting their own mean reduces it
    alike = min(max(neighbours / pairs * len(values) / variance + 1.0 / BLOCKS, 0.0), MOST_ALIKE)
    freedom = max(int((len(values) - 1) * (1.0 - alike) / (1.0 + alike)), 1)
    student = TWO_SIGMA[freedom] if freedom < len(TWO_SIGMA) else 2.0 * (1.0 + 1.3 / freedom)
    deviation = math.sqrt(variance / (len(values) - 1))
    return student * deviation / math.sqrt(len(values)) * math.sqrt((1.0 + alike) / (1.0 - alike))
