"""Smoothed dry friction: the jump at rest replaced by a steep slope, for steppers that need smooth rates.

friction = phi(|v|/width) * sliding_vector(v), with phi(u) = tanh u, u/sqrt(1 + u^2) or (2/pi) arctan u. The mass then
creeps where it should stick, and the mean is biased by an amount that falls with the width - in proportion to it,
or to its square root where slip nearly vanishes without reversing; arctan, with its long tail, even where slip
never comes near to rest. The width belongs to the method: no law knows of it.
"""

from __future__ import annotations

import math
from typing import Any

from frictionlab.compile.decorators import inner
from frictionlab.compile.dispatch import length

TANH, SQUARE_ROOT, ARCTAN = 0.0, 1.0, 2.0


@inner
def share(shape: float, u: float) -> float:
    """phi(u): the share of the sliding friction that acts at a speed of u widths, u >= 0."""
    if shape == TANH:
        return math.tanh(u)
    if shape == SQUARE_ROOT:
        return u / math.sqrt(1.0 + u * u)
    return 2.0 / math.pi * math.atan(u)


@inner
def friction(problem: Any, w: Any) -> Any:
    """Coefficient along the slip velocity w; the problem has ``law``, ``width`` and ``shape``."""
    speed = length(w)
    if speed == 0.0:
        return 0.0 * w
    return share(problem.shape, speed / problem.width) * problem.law.sliding_vector(w)
