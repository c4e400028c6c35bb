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


def one_harmonic_velocity(scene: Scene, friction: float, ratio: ArrayLike) -> Floats:
    """Velocity amplitude of x1 by balancing one harmonic of Coulomb friction, explicit in belt speed over amplitude.

    With A = 1 - Omega^2, a = 2 beta Omega, c = 4 friction/pi and s = sqrt(1 - ratio^2),
    V = Omega (P^2 - c^2 s^2) / (a c s + sqrt(P^2 (A^2 + a^2) - A^2 c^2 s^2)): the positive root of Eq. 8, written
    without cancellation. The belt speed is then ratio*V and the mean (2/pi) arcsin(ratio): a curve without a search.

    friction = mu*normal_load [K_1 L]; ratio [-] in [0, 1]. Zero where the load cannot overcome the friction's first
    harmonic, P <= c s. Source: Sulollari, van Dalen & Cabboi, Eqs. 8-9, solved for V.
    """
    mass = scene.mass()
    stiffness, damping = mass.stiffness - mass.frequency**2, mass.damping * mass.frequency
    force = abs(mass.force)
    held = 4.0 / np.pi * friction * np.sqrt(1.0 - np.asarray(ratio, dtype=np.float64) ** 2)
    surplus = np.maximum(0.0, (force - held) * (force + held))
    below = stiffness**2 * surplus + (damping * force) ** 2
    velocity = mass.frequency * surplus / np.where(surplus > 0.0, damping * held + np.sqrt(below), 1.0)
    return np.asarray(velocity)


def one_harmonic_least_ratio(scene: Scene, friction: float) -> float:
    """The ratio of belt speed to velocity amplitude at which the one-harmonic curve starts: 0 for P >= 4 friction/pi.

    Below that load the first harmonic of friction holds the mass at a vanishing belt speed, and the curve of the
    mean starts at (2/pi) arcsin of sqrt(1 - (pi P/(4 friction))^2). friction = mu*normal_load [K_1 L].
    Source: Sulollari, van Dalen & Cabboi, Eq. 8 at V -> 0.
    """
    share = 0.25 * math.pi * abs(scene.mass().force) / friction
    return math.sqrt(max(0.0, (1.0 - share) * (1.0 + share)))


CONCAVE_BY_INITIAL_CURVATURE = math.pi / 16.0
"""Friction force over unbalance from which on a curve at resonance starts concave, by one harmonic."""
CONCAVE_BY_AREA = math.pi / 4.0 * (2.0 - math.pi / 2.0)
"""The same by chord area: ``chord_area_at_resonance`` is zero there."""


def chord_area_at_resonance(ratio: ArrayLike) -> Floats:
    """The signed area between a curve at resonance and its chord, by one harmonic: 1 - 4/pi + 8 ratio/pi^2.

    Twice the integral over v_b/V_lin in [0, 1] of the mean friction, relative to the friction coefficient, less
    v_b/V_lin; > 0 where the curve is concave. Independent of damping.

    ratio [-]: friction force over unbalance, mu gamma^2/alpha, from 0 to pi/4, where the body still slides on a
    belt at rest. Source: integral of Sulollari, van Dalen & Cabboi, Eqs. 5 and 8, at Omega = 1.
    """
    return np.asarray(1.0 - 4.0 / np.pi + 8.0 / np.pi**2 * np.asarray(ratio, dtype=np.float64))


def initial_concavity(scene: Scene, friction: float) -> float:
    """How far the curve of a scene starts concave, by one harmonic: 4 c (c + a V_0)/P^2 - 1, > 0 if it does.

    Forces of one harmonic at frequency Omega: P of the drive, c = (4/pi) friction, a V of the dashpot; V_0 is the
    velocity amplitude on a belt at rest. At resonance the sign changes at friction = (pi/16) unbalance, whatever
    the damping. NaN where the body then sticks, P <= c.

    friction [K_1 L]: friction force, coefficient times normal_load. Raises ValueError without a drive.
    Source: expansion of Sulollari, van Dalen & Cabboi, Eqs. 5, 8 and 9, for small v_b.
    """
    if scene.degrees_of_freedom == 0 or not scene.mass().force:
        raise ValueError("a curve starts concave or convex by its drive: this scene has none")
    mass, harmonic = scene.mass(), 4.0 / math.pi * friction
    force = abs(mass.force)
    if force <= harmonic:
        return math.nan
    at_rest = float(one_harmonic_velocity(scene, friction, 0.0))
    return 4.0 * harmonic * (harmonic + mass.damping * at_rest) / force**2 - 1.0
