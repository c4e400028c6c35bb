"""Closed forms of vibrated friction, with the numbers of their equations.

Velocities are in the scene's scale (omega_1 L); a mean friction is given relative to the friction coefficient
of steady sliding.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from frictionlab.scene import Scene

Floats = NDArray[np.float64]


def friction_free_velocity(scene: Scene) -> float:
    """V_lin: the velocity amplitude of x1 without friction [omega_1 L], infinite at undamped resonance.

    Amplitude of the linear response to the load along x1; for a prescribed slip its own amplitude along x1.
    Above it a body of one degree of freedom never reverses its slip: the kink of the curve, for every law of
    constant sliding friction.

    Source: Sulollari, van Dalen & Cabboi, Eq. 6 (there the response where friction is a small perturbation).
    """
    if scene.degrees_of_freedom == 0:
        return abs(scene.motion().velocity)
    mass = scene.mass()
    stiffness = complex(mass.stiffness - mass.frequency**2, mass.damping * mass.frequency)
    force = abs(mass.force) * mass.frequency
    return force / abs(stiffness) if stiffness else math.inf


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
    size = np.abs(np.asarray(ratio, dtype=np.float64))
    complement = size / np.hypot(1.0, size)
    first = _first_integral(np.where(complement > 0.0, complement, 1.0))
    return np.copysign(2.0 / np.pi * complement * first, ratio)


def mean_prescribed_circular(ratio: ArrayLike) -> Floats:
    """Mean Coulomb friction along the belt under a slip of constant speed that turns at a constant rate.

    (2/pi) [E(k) - (1 - k^2) K(k)]/k with modulus k = ratio up to 1, (2/pi) E(1/ratio) from there on: Landen's
    transformation of [(1 + r) E(m) - (1 - r) K(m)]/(pi r), m = 4r/(1 + r)^2, which loses digits at small r.

    ratio [-]: belt speed over the speed of the turning slip, any sign.
    Source: gradient of the mean slip speed; elliptic integrals in the notation of Byrd & Friedman (1971).
    """
    size = np.abs(np.asarray(ratio, dtype=np.float64))
    slow = np.where(size < 1.0, size, 0.0)
    fast = 1.0 / np.where(size > 1.0, size, np.inf)
    below = _second_less_first(slow) / np.where(slow > 0.0, slow, 1.0)
    mean = np.where(size < 1.0, below, np.where(size > 1.0, _second_integral(fast), 1.0))
    return np.copysign(2.0 / np.pi * mean, ratio)


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


def _first_integral(complement: Floats) -> Floats:
    """K by its complementary modulus k' > 0, where its logarithm loses no digits (A&S 17.6.3)."""
    mean, _ = _ladder(np.sqrt((1.0 - complement) * (1.0 + complement)), complement)
    return np.asarray(np.pi / (2.0 * mean))


def _second_integral(modulus: Floats) -> Floats:
    """E by its modulus k < 1 (A&S 17.6.4)."""
    mean, total = _ladder(modulus, np.sqrt((1.0 - modulus) * (1.0 + modulus)))
    return np.asarray(np.pi / (2.0 * mean) * (1.0 - 0.5 * modulus**2 - total))


def _second_less_first(modulus: Floats) -> Floats:
    """E - (1 - k^2) K by its modulus k < 1, without the cancellation at small k."""
    mean, total = _ladder(modulus, np.sqrt((1.0 - modulus) * (1.0 + modulus)))
    return np.asarray(np.pi / (2.0 * mean) * (0.5 * modulus**2 - total))
