"""When a deflection that grows along the slip stays at its limit."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

SHORT = 1e-7
"""Share of the limit that a deflection lacks where its approach is measured."""


def saturates(law: Any) -> bool:
    """Whether slip that only turns leaves a deflection at its limit, with one friction at every speed.

    A ``rotated`` deflection moves with |v|: wherever the way slid has no end it grows until it stays at its limit.
    Friction is then that of sliding, along the slip.
    """
    if law.planar_form() != "rotated" or not law.constant_sliding_friction():
        return False
    limit, friction = law.largest_deflection(), law.sliding_friction(1.0)
    short = (1.0 - SHORT) * limit
    return (
        math.isfinite(limit)
        and math.isclose(law.friction(1.0, limit, 0.0), friction, rel_tol=1e-9)
        and math.isclose(law.rate(2.0, short), 2.0 * law.rate(1.0, short), rel_tol=1e-9)
    )


def slides_saturated(law: Any) -> bool:
    """Whether a bristle at its limit stays there in slip of any speed along a line, at one friction."""
    if law.memory_kind != "bristle" or not law.constant_sliding_friction():
        return False
    limit, friction = law.largest_deflection(), law.sliding_friction(1.0)
    return (
        math.isfinite(limit)
        and math.isclose(law.friction(1.0, limit, 0.0), friction, rel_tol=1e-12)
        and abs(law.rate(1.0, limit)) <= 1e-12
    )


def remaining_share(law: Any, path: Any) -> Any:
    """What is left of a small lack of deflection after a path slid [scene length], of what there was before."""
    limit = law.largest_deflection()
    return np.exp(-path * law.rate(1.0, (1.0 - SHORT) * limit) / (SHORT * limit))
