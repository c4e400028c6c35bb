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


def follows_the_way(law: Any) -> bool:
    """Whether a bristle is a linear spring, perhaps with a dashpot, whose deflection hangs on the way slid alone."""
    if not slides_saturated(law):
        return False
    limit, friction = law.largest_deflection(), law.sliding_friction(1.0)
    damping = law.friction(0.0, 0.0, 1.0)
    return all(
        math.isclose(law.rate(2.0, z), 2.0 * law.rate(1.0, z), rel_tol=1e-9, abs_tol=1e-9)
        and math.isclose(law.rate(-1.0, -z), -law.rate(1.0, z), rel_tol=1e-9, abs_tol=1e-9)
        and math.isclose(
            law.friction(3.0, z, 1.0), friction * z / limit + damping, rel_tol=1e-9, abs_tol=1e-12
        )
        for z in (limit * _NODES[::8]).tolist()
    )


def lost_on_reversal(law: Any) -> float:
    """What bristles lose on a reversal from slip at their limit to slip at the other limit [scene length].

    The integral over the way slid of 1 - spring force/friction in sliding: the work that this friction would have
    done beyond that of the springs. Of bristles that follow the way; infinite where their limit is approached more
    slowly than exponentially.
    """
    limit = law.largest_deflection()
    if law.rate(1.0, (1.0 - SHORT) * limit) < (1.0 - 1e-3) * SHORT:
        return math.inf
    parts = [(1.0 - z / limit) / law.rate(1.0, z) for z in (limit * _NODES).tolist()]
    return float(limit * (_WEIGHTS @ parts))


_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(64)
