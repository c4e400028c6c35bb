"""Compliant contacts in the limits of soft and of stiff bristles: means under a prescribed slip, kicks at reversals.

The slip is the sum of the belt's and a sine of displacement amplitude X; ratio is belt speed over velocity amplitude,
presliding the presliding length over X. A mean is relative to the friction coefficient of steady sliding.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from frictionlab.quantities import Floats
from frictionlab.theory.loops import moment


def slip_back_and_forth(ratio: ArrayLike) -> tuple[Floats, Floats]:
    """The slip against and along the belt's, per period [X], of a sine along the belt.

    2 (sin t - t cos t) and that plus 2 pi cos t, with cos t = ratioof either sign; from ratio 1 on the slip
    against the belt is 0.
    """
    size = np.abs(np.asarray(ratio, dtype=np.float64))
    angle = np.arccos(np.minimum(size, 1.0))
    small = moment(np.where(angle < 1.0, angle, 0.0), -1.0)
    back = 2.0 * np.where(angle < 1.0, small, np.sin(angle) - angle * np.cos(angle))
    return np.asarray(back), np.asarray(back + 2.0 * np.pi * size)


def _share_back(ratio: ArrayLike) -> Floats:
    back, forth = slip_back_and_forth(ratio)
    return np.asarray(back / forth)


def mean_soft_dahl(ratio: ArrayLike, exponent: float = 1.0) -> Floats:
    """Mean Dahl friction under a sine along the belt, where the bristles are soft: (1 - r)/(1 + r).

    r = (slip back/slip forth)^(1/exponent); for exponent 1 the mean velocity over the mean speed, which LuGre
    friction of constant g shares. The error at finite stiffness is of order presliding^-2.

    ratio [-]: belt speed over velocity amplitude, any sign; exponent [-] > 0.
    Source: averaging Dahl (1968) over a period in which friction hardly changes.
    """
    remains = _share_back(ratio) ** (1.0 / exponent)
    return np.copysign((1.0 - remains) / (1.0 + remains), ratio)


def mean_soft_transverse(ratio: ArrayLike) -> Floats:
    """Mean friction of soft vectorial Dahl or LuGre bristles along the belt, under a sine across it.

    Mean velocity over mean speed, ratio/[(2/pi) sqrt(1 + ratio^2) E(1/sqrt(1 + ratio^2))]: below Coulomb's.

    ratio [-]: belt speed over velocity amplitude, any sign. Source: averaging, as ``mean_soft_dahl``.
    """
    from scipy.special import ellipe

    size = np.asarray(ratio, dtype=np.float64)
    whole = np.hypot(1.0, size)
    return np.asarray(0.5 * np.pi * size / whole / ellipe(1.0 / whole**2))


def mean_soft_circular(ratio: ArrayLike) -> Floats:
    """Mean friction of soft vectorial Dahl or LuGre bristles along the belt, under a circular slip.

    Mean velocity over mean speed, ratio/[(2/pi) (1 + ratio) E(2 sqrt(ratio)/(1 + ratio))]: above Coulomb's.

    ratio [-]: belt speed over the speed of the circular slip, any sign. Source: averaging, as ``mean_soft_dahl``.
    """
    from scipy.special import ellipe

    size = np.abs(np.asarray(ratio, dtype=np.float64))
    whole = 1.0 + size
    mean = 0.5 * np.pi * size / whole / ellipe(4.0 * size / whole**2)
    return np.copysign(mean, ratio)


def mean_soft_elasto_plastic(ratio: ArrayLike, breakaway_ratio: float) -> Floats:
    """Mean elasto-plastic friction of constant g under a sine along the belt, where the bristles are soft.

    m solves m alpha(m) = 1 - slip back/slip forth, alpha rising from 0 at breakaway_ratio to 1 at 1: at least
    breakaway_ratio however slow the belt, since bristles are elastic below. m has the belt's sign.

    ratio [-]: belt speed over velocity amplitude, not 0; breakaway_ratio [-] in (0, 1).
    Source: averaging Dupont et al. (2002), IEEE TAC 47, 787, as ``mean_soft_dahl``.
    """
    from scipy.optimize.elementwise import find_root

    def excess(mean: Floats, wanted: Floats) -> Floats:
        turn = np.pi * (mean - 0.5 * (1.0 + breakaway_ratio)) / (1.0 - breakaway_ratio)
        return np.asarray(mean * (0.5 + 0.5 * np.sin(turn)) - wanted)

    found = find_root(excess, (breakaway_ratio, 1.0), args=(1.0 - _share_back(ratio),))
    return np.copysign(found.x, ratio)


def mean_soft_jenkins(ratio: ArrayLike, presliding: ArrayLike) -> Floats:
    """Mean Jenkins friction under a sine along the belt, exact where the slider never slips back.

    1 - (mean distance of the slip behind its running maximum)/presliding; NaN where the slip back is more than
    twice the presliding length. Tends to 1 where the spring is soft.

    ratio [-]: belt speed over velocity amplitude, > 0 or < 0; presliding [X] > 0.
    Source: the play operator of the spring in series with the slider.
    """
    from scipy.optimize.elementwise import find_root

    def gain(phase: Floats, size: Floats, most: Floats) -> Floats:
        return np.asarray(size * phase + np.sin(phase) - most)

    size = np.minimum(np.abs(np.asarray(ratio, dtype=np.float64)), 1.0)
    turn = np.arccos(-size)
    most = size * turn + np.sin(turn)
    again = find_root(gain, (2.0 * np.pi - turn, 2.0 * np.pi + turn), args=(size, most)).x
    behind = most * (again - turn) - 0.5 * size * (again**2 - turn**2) + np.cos(again) - np.cos(turn)
    back, length = slip_back_and_forth(ratio)[0], np.asarray(presliding, dtype=np.float64)
    mean = np.where(back <= 2.0 * length, 1.0 - behind / (2.0 * np.pi * length), np.nan)
    return np.copysign(mean, ratio)


def stiff_correction(ratio: ArrayLike, exponent: float = 1.0) -> Floats:
    """Mean friction of a stiff Dahl contact minus Coulomb's, under a sine along the belt, per presliding/X.

    (2/(3 pi)) H ratio/(1 - ratio^2), H = 2^(1 - i)/(2 - i) the path, in presliding lengths, over which the jump of
    friction at a reversal is spread: 1 for exponent i = 1 and for 0, an ideal spring that slips (Jenkins). The terms
    in sqrt(presliding) of the two reversals of a period cancel. Infinite for i >= 2, where it falls more slowly.

    ratio [-]: belt speed over velocity amplitude, in (-1, 1), not near its ends; exponent [-] >= 0.
    Source: expansion of ``dahl_path`` after both reversals.
    """
    felt = 2.0 ** (1.0 - exponent) / (2.0 - exponent) if exponent < 2.0 else math.inf
    size = np.asarray(ratio, dtype=np.float64)
    return np.asarray(2.0 / (3.0 * np.pi) * felt * size / ((1.0 - size) * (1.0 + size)))


def reversal_kick(friction: float, acceleration: float) -> float:
    """Velocity after a reversal minus that under Coulomb friction, per square root of the presliding length.

    After a reversal Dahl friction of exponent 1 changes its sign over a path of a presliding length d, and
    accelerates the body until then: with q = path/d, kick/sqrt(d) = integral over q > 0 of 2 f exp(-q)/sqrt(2 a q +
    4 f (1 - exp(-q))). So the steady state of a body tends to Coulomb's as the square root of d, under prescribed
    slip as d.

    friction f > 0: largest friction force per unit mass; acceleration a > 0: of the slip, after friction has
    reversed. Source: energy of x'' = a + 2 f exp(-x/d) from rest; by the trapezoidal rule in sqrt(q), exact to
    rounding.
    """
    root = 0.05 * np.arange(-140, 141) + 0.025
    square = root**2
    speed = np.sqrt(2.0 * acceleration - 4.0 * friction * np.expm1(-square) / square)
    return float(0.05 * np.sum(2.0 * friction * np.exp(-square) / speed))
