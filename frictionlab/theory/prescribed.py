"""Mean Coulomb friction under prescribed slip."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from frictionlab.quantities import Floats


def mean_prescribed_longitudinal(ratio: ArrayLike) -> Floats:
    """Mean Coulomb friction under a sinusoidal slip along the belt: (2/pi) arcsin(ratio), then 1.

    ratio [-]: belt speed over the amplitude of the slip velocity, any sign.
    Source: Sulollari, van Dalen & Cabboi, Eq. 5.
    """
    return np.asarray(2.0 / np.pi * np.arcsin(np.clip(ratio, -1.0, 1.0)))


def mean_prescribed_transverse(ratio: ArrayLike) -> Floats:
    """Mean Coulomb friction along the belt under a sinusoidal slip across it.

    (2/pi) k' K(k), with k = 1/sqrt(1 + ratio^2) the modulus and k' = ratio k the complementary one. It starts
    with an infinite slope and tends to 1.

    ratio [-]: belt speed over the amplitude of the slip velocity, any sign.
    Source: the mean of ratio/sqrt(ratio^2 + sin^2), by Byrd & Friedman (1971).
    """
    from scipy.special import ellipkm1

    size = np.abs(np.asarray(ratio, dtype=np.float64))
    complement = size / np.hypot(1.0, size)
    first = ellipkm1(np.maximum(complement, 1e-150) ** 2)  # the square of less is zero, where K is infinite
    return np.copysign(2.0 / np.pi * complement * first, ratio)


def mean_prescribed_circular(ratio: ArrayLike) -> Floats:
    """Mean Coulomb friction along the belt under circular slip: constant speed, direction turning at a constant rate.

    (2/pi) [E(k) - (1 - k^2) K(k)]/k with modulus k = ratio up to 1, (2/pi) E(1/ratio) from there on: Landen's
    transformation of [(1 + r) E(m) - (1 - r) K(m)]/(pi r), m = 4r/(1 + r)^2, which loses digits at small r. The
    difference up to 1 is k^2 (1 - k^2) R_D(0, 1, 1 - k^2)/3 (DLMF 19.25.1), where nothing cancels.

    ratio [-]: belt speed over the speed of the circular slip, any sign.
    Source: gradient of the mean slip speed; elliptic integrals in the notation of Byrd & Friedman (1971).
    """
    from scipy.special import ellipe, elliprd

    size = np.abs(np.asarray(ratio, dtype=np.float64))
    slow = np.where(size < 1.0, size, 0.0)
    fast = 1.0 / np.where(size > 1.0, size, np.inf)
    complement = (1.0 - slow) * (1.0 + slow)
    below = slow * complement * elliprd(0.0, 1.0, complement) / 3.0
    mean = np.where(size < 1.0, below, np.where(size > 1.0, ellipe(fast**2), 1.0))
    return np.copysign(2.0 / np.pi * mean, ratio)
