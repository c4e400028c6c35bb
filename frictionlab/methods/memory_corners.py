"""Where the motion of a law with memory has corners: slip reverses, a deflection yields."""

from __future__ import annotations

import math
from typing import Any

from frictionlab.kernel import by_dimension, inner
from frictionlab.methods.memory_motion import Problem, Work
from frictionlab.methods.memory_state import Scales
from frictionlab.methods.memory_step import stepped
from frictionlab.methods.sliding_map import dips


def _ahead_on_the_line(values: Any, work: Any, like: float) -> float:
    """Positive until slip reverses: a law may have a corner there."""
    return math.copysign(1.0, work.at[1]) * values[1]


def _ahead_in_the_plane(values: Any, work: Any, like: complex) -> float:
    """Positive until a deflection that yields is unloaded."""
    w, least = complex(values[2], values[3]), 1e300
    for k in range(work.memory.size):
        if work.radius[k] > 0.0:
            z = complex(values[6 + 2 * k], values[7 + 2 * k])
            least = min(least, (w * z.conjugate()).real / work.radius[k])
    return least


_ahead = by_dimension(_ahead_on_the_line, _ahead_in_the_plane)


@inner
def turns(work: Work, least: float, like: Any) -> bool:
    """Whether slip has turned round, not only crept, or in the plane begun to unload what yields."""
    return _ahead(work.at, work, like) > 0.0 and _ahead(work.end, work, like) < -least


@inner
def turning_point(
    problem: Problem, tau: float, high: float, scales: Scales, accuracy: float, work: Work, like: Any
) -> Any:
    """The step at whose end slip has just turned, left in ``work.end``; its error, and how many were tried."""
    low, at_low, at_high = 0.0, _ahead(work.at, work, like), _ahead(work.end, work, like)
    tries = 0
    while tries < 60 and high - low > 2e-15 * (tau + high) and at_high < -1e-6 * accuracy:
        h = 0.5 * (low + high)
        if tries % 3 < 2:
            h = low + (high - low) * (at_low / (at_low - at_high))
        stepped(problem, tau, h, scales, work, like)
        value = _ahead(work.end, work, like)
        tries += 1
        if value > 0.0:
            low, at_low = h, value
        else:
            high, at_high = h, value
    error = stepped(problem, tau, high, scales, work, like)
    return high, error, tries + 1


@inner
def located(
    problem: Problem, tau: float, high: float, scales: Scales, accuracy: float, work: Work, like: Any
) -> Any:
    """Where in a step a rate jumps that is not accurate for it: the step up to there, left in ``work.end``, and the
    short one that passes the jump; and how many were tried.
    """
    low, tries, close = 0.0, 0, 1e-3 * accuracy
    missed = stepped(problem, tau, high, scales, work, like) / high
    while tries < 60 and (high - low) * missed > close and high - low > 2e-15 * (tau + high):
        middle = 0.5 * (low + high)
        error = stepped(problem, tau, middle, scales, work, like)
        tries += 1
        if error <= close:
            low = middle
        else:
            high, missed = middle, error / middle
    if low > 0.0:
        stepped(problem, tau, low, scales, work, like)
    return low, 2.0 * max(high - low, close / missed), tries + 1


def _passed_on_the_line(w0: float, rate0: float, w1: float, rate1: float, h: float) -> bool:
    """Whether slip may have come to rest and gone on within a step."""
    return w0 * w1 > 0.0 and dips(
        complex(w0, 0.0), complex(rate0, 0.0), complex(w1, 0.0), complex(rate1, 0.0), h
    )


def _passed_in_the_plane(w0: complex, rate0: complex, w1: complex, rate1: complex, h: complex) -> bool:
    return dips(w0, rate0, w1, rate1, h.real)


passed = by_dimension(_passed_on_the_line, _passed_in_the_plane)
