"""The velocity that a stiff bristle contact adds at a reversal of slip, compared with Coulomb friction."""

from __future__ import annotations

import numpy as np


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
