"""Complete elliptic integrals by the arithmetic-geometric mean, where nothing cancels."""

from __future__ import annotations

import numpy as np

from frictionlab.quantities import Floats


def _ladder(modulus: Floats, complement: Floats) -> tuple[Floats, Floats]:
    """The arithmetic-geometric mean of 1 and k', and the sum of 2^(n-1) c_n^2 from n = 1 on.

    Abramowitz & Stegun 17.6: converges quadratically once the two means are of one size.
    """
    mean, geometric, gap = np.ones_like(complement), complement, modulus
    total, weight = np.zeros_like(complement), 1.0
    while np.any(gap > 1e-9 * mean):
        gap = gap**2 / (2.0 * (mean + geometric))  # half the distance of the two means, without a difference
        mean, geometric = 0.5 * (mean + geometric), np.sqrt(mean * geometric)
        total, weight = total + weight * gap**2, 2.0 * weight
    return mean, total


def first_integral(complement: Floats) -> Floats:
    """K by its complementary modulus k' > 0, where its logarithm loses no digits (A&S 17.6.3)."""
    mean, _ = _ladder(np.sqrt((1.0 - complement) * (1.0 + complement)), complement)
    return np.asarray(np.pi / (2.0 * mean))


def second_integral(modulus: Floats) -> Floats:
    """E by its modulus k < 1 (A&S 17.6.4)."""
    mean, total = _ladder(modulus, np.sqrt((1.0 - modulus) * (1.0 + modulus)))
    return np.asarray(np.pi / (2.0 * mean) * (1.0 - 0.5 * modulus**2 - total))


def second_less_first(modulus: Floats) -> Floats:
    """E - (1 - k^2) K by its modulus k < 1, without the cancellation at small k."""
    mean, total = _ladder(modulus, np.sqrt((1.0 - modulus) * (1.0 + modulus)))
    return np.asarray(np.pi / (2.0 * mean) * (0.5 * modulus**2 - total))
