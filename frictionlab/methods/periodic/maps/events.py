"""Where the motion of a law with memory has corners: slip reverses, a deflection yields."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from frictionlab.compile.decorators import inner
from frictionlab.compile.dispatch import by_dimension, length
from frictionlab.dynamics.events import dips
from frictionlab.methods.periodic.maps.memory_rates import BEYOND, YIELDS, Problem, Work
from frictionlab.methods.periodic.maps.memory_state import Scales, filled, spilled
from frictionlab.methods.periodic.maps.memory_step import stepped
from frictionlab.numerics.vectors import dimension, taken

ROUNDED = 1e-13
"""Of a reach: a smaller excess is rounding."""


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


def _along_on_the_line(w: float, z: float) -> float:
    return w * z


def _along_in_the_plane(w: complex, z: complex) -> float:
    return w.real * z.real + w.imag * z.imag


_along = by_dimension(_along_on_the_line, _along_in_the_plane)


class Begun(NamedTuple):
    """Whether a deflection has begun to yield within a step, how far it went on (energy), how long ago that was."""

    yields: bool
    over: float
    ago: float


@inner
def _excess(law: Any, w: Any, k: int, work: Work) -> float:
    """By how much of its reach the k-th of ``work.memory`` is beyond it; -1 where it is not, nor has begun to lag.

    Told by what the law says of slip straight outward: beyond its reach a deflection may come back by its excess. Of
    one that only stays where it is the excess is unknown: 0.
    """
    z = work.memory[k]
    size, speed = length(z), length(w)
    if work.follows[k] == 0.0 or size == 0.0 or speed == 0.0:
        return -1.0
    followed = _along(law.rate(z * (speed / size), work.memory, k), z) / (speed * size)
    if followed >= 1.0 - YIELDS:
        return -1.0
    return -followed if -followed > ROUNDED else 0.0


@inner
def begun_to_yield(law: Any, scales: Scales, work: Work, like: Any) -> Begun:
    """Which deflections that move with the slip from ``work.at`` should not do so at ``work.end`` any more."""
    first, w = 3 * dimension(like), taken(work.end, 1, like)
    filled(work.memory, work.at, first, work.memory[0])
    for k in range(work.memory.size):
        work.moving[k] = work.memory[k]
    filled(work.memory, work.end, first, work.memory[0])
    yields, over, ago = False, 0.0, 0.0
    for k in range(work.memory.size):
        z = work.memory[k]
        outward = _along(w, z)
        if outward <= 0.0 and length(z) <= length(work.moving[k]):
            continue
        excess = _excess(law, w, k, work)
        if excess < 0.0:
            continue
        beyond = length(z) * excess / (1.0 + excess)
        yields, over = True, max(over, scales.unit[k] * beyond)
        if outward > 0.0:
            ago = max(ago, beyond * length(z) / outward)
    return Begun(yields, over, ago)


@inner
def _set_back(law: Any, work: Work, like: Any) -> None:
    """Put what has just begun to yield where it did, and not a rounding error inside."""
    w = taken(work.end, 1, like)
    filled(work.memory, work.end, 3 * dimension(like), work.memory[0])
    for k in range(work.memory.size):
        excess = _excess(law, w, k, work)
        if excess > 0.0:
            work.memory[k] = work.memory[k] * (BEYOND / (1.0 + excess))
    spilled(work.memory, work.end, 3 * dimension(like), work.memory[0])


@inner
def yield_point(
    problem: Problem, tau: float, high: float, scales: Scales, accuracy: float, work: Work, like: Any
) -> Any:
    """The step at whose end a deflection has just begun to yield, left in ``work.end``; its error, and how many were
    tried.
    """
    low, tries, close, steepest = 0.0, 0, 1e-2 * accuracy, 0.0
    for k in range(scales.unit.size):
        steepest = max(steepest, scales.unit[k])
    last = begun_to_yield(problem.law, scales, work, like)
    error, at = 0.0, high
    while tries < 60 and high - low > 2e-15 * (tau + high):
        speed = steepest * length(taken(work.end, 1, like))
        if (last.over > 0.0 and last.over <= close) or (high - low) * speed <= close:
            break
        h = 0.5 * (low + high)
        if tries % 4 < 3 and last.over > 0.0:
            aimed = high - last.ago * (1.0 - 0.5 * close / last.over)
            h = aimed if low < aimed < high else h
        error, at = stepped(problem, tau, h, scales, work, like), h
        tries += 1
        found = begun_to_yield(problem.law, scales, work, like)
        if found.yields:
            high, last = h, found
        else:
            low = h
    if at != high or tries == 0:
        error = stepped(problem, tau, high, scales, work, like)
    _set_back(problem.law, work, like)
    return high, error, tries + 1


@inner
def located(
    problem: Problem, tau: float, high: float, scales: Scales, accuracy: float, work: Work, like: Any
) -> Any:
    """Where in a step a rate jumps that is not accurate for it: the step up to there, left in ``work.end``, and the
    short one that passes the jump; and how many were tried. Without a sharp jump there is nothing to pass.
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
    if high - low > 0.01 * high:
        h = low if low > 0.0 else high
        stepped(problem, tau, h, scales, work, like)
        return h, 0.0, tries + 1
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
