"""Where the rate of each deflection has corners: its yield surface, and whether it is unloaded elastically.

As a law declares it, or found from the rates of a law that does not. A plugin may drag a slider without saying where:
its rate then jumps inside a step, and a step of many stages, some before the jump and some behind it, may end before
it for ever. Deflections have no preferred direction and one moves by slip and itself alone, so that one ray tells
all: where along it the deflection stops following the slip, and whether it follows a slip that makes it smaller.
"""

from __future__ import annotations

import math
from typing import Any

from frictionlab.compile.decorators import inner
from frictionlab.compile.dispatch import by_dimension, by_law, length
from frictionlab.compile.stack import count_of
from frictionlab.laws.memory import VECTORIAL
from frictionlab.methods.periodic.maps.rates import Work

ALIKE = 1e-9
"""Of slip: a rate that differs by less from it follows it; what is stretched by less is not stretched."""
SHARES = 4
"""Of the radius found, at which a deflection must follow the slip, loaded and unloaded."""


@inner
def _follows(law: Any, work: Work, k: int, v: Any, z: Any) -> bool:
    work.memory[k] = z
    return length(law.rate(v, work.memory, k) - v) <= ALIKE * length(v)


@inner
def _first_yield(law: Any, work: Work, k: int, v: Any) -> float:
    """The deflection along v from which on it does not follow the slip v any more; 0 for none."""
    way = v / length(v)
    usual = work.size[k]  # in steady sliding: mostly where it yields
    if _follows(law, work, k, v, (1.0 - 1e-12) * usual * way) and not _follows(law, work, k, v, usual * way):
        return usual
    low, high = 0.0, 1e3 * usual
    if not _follows(law, work, k, v, 1e-9 * usual * way) or _follows(law, work, k, v, high * way):
        return 0.0
    while True:
        middle = 0.5 * (low + high)
        if not low < middle < high:
            return high
        if _follows(law, work, k, v, middle * way):
            low = middle
        else:
            high = middle


@inner
def _yields_at(law: Any, work: Work, k: int, v: Any, radius: float) -> bool:
    """Whether the deflection follows the slip v everywhere below the radius and is not stretched at it."""
    speed = length(v)
    way = v / speed
    for part in range(1, SHARES + 1):
        share = (1.0 - 1e-9) * radius * part / SHARES
        if not (_follows(law, work, k, v, share * way) and _follows(law, work, k, v, -share * way)):
            return False
    # unloaded from the surface, too, it follows the slip
    if not _follows(law, work, k, v, -radius * way):
        return False
    # at the surface slip turns it, but stretches it no further
    work.memory[k] = radius * way
    return length(law.rate(v, work.memory, k)) <= ALIKE * speed


@inner
def _found_radius(law: Any, work: Work, k: int, like: Any) -> float:
    """The radius that rates tell, the same at slips of any speed; 0 where they tell none."""
    along = 1.0 + 0.0 * like
    radius = _first_yield(law, work, k, along)
    # a surface that moves with the speed of slip is none
    for exponent in (-4.0, 2.0):
        if radius > 0.0 and not _yields_at(law, work, k, 10.0**exponent * along, radius):
            radius = 0.0
    work.memory[k] = 0.0 * along
    return radius


def _found_unloaded_in_the_plane(law: Any, work: Work, k: int, like: complex) -> bool:
    """Whether rates follow a slip that makes a deflection smaller or turns it, and not one that stretches it."""
    if law.elastic_unloading():
        return True
    stretched = True
    for part in range(1, SHARES + 1):
        z = complex(work.size[k] * part / SHARES, 0.0)
        for v in (complex(-1.0, 0.0), complex(0.0, 1.0), complex(0.0, -1.0), complex(-1e-3, 1.0)):
            if not _follows(law, work, k, v, z):
                return False
        stretched = stretched and _follows(law, work, k, complex(1.0, 0.0), z)
    return not stretched


_found_unloaded = by_dimension(
    # on the line the corner is where slip reverses: the law's own rate is kept up to there
    lambda law, work, k, like: False,
    _found_unloaded_in_the_plane,
)


def _bristle_on_the_line(law: Any, work: Work, like: float) -> None:
    work.radius[0], work.unloads[0] = law.yield_deflection(), 0.0


def _bristle_in_the_plane(law: Any, work: Work, like: complex) -> None:
    vectorial = law.form == VECTORIAL
    work.radius[0] = law.yield_deflection() if vectorial else math.inf
    work.unloads[0] = 1.0 if vectorial and law.elastic_unloading() else 0.0


_corners_of_bristle = by_dimension(_bristle_on_the_line, _bristle_in_the_plane)


def _bristle(law: Any, work: Work, like: Any) -> None:
    _corners_of_bristle(law, work, like)
    work.radius[0] = work.radius[0] if work.radius[0] < math.inf else 0.0


def _deflections(law: Any, work: Work, like: Any) -> None:
    for k in range(count_of(law)):
        work.memory[k] = 0.0 * like
    for k in range(count_of(law)):
        radius = law.yield_deflection(k)
        work.radius[k], work.unloads[k] = radius if radius < math.inf else 0.0, 0.0
        # what remembers its mode has a breakaway in place of both
        if radius == math.inf and not law.remembers_stick():
            work.radius[k] = 0.0 if law.elastic_unloading() else _found_radius(law, work, k, like)
            if work.radius[k] == 0.0:
                work.unloads[k] = 1.0 if _found_unloaded(law, work, k, like) else 0.0
        work.memory[k] = 0.0 * like


measure_yield = by_law(
    _bristle,
    _bristle,
    _deflections,
    # a scalar has no direction in which to yield
    lambda law, work, like: None,
)
"""measure_yield(law, work, like): fill the radius of each yield surface, 0 for none, and ``unloads``: 1 for what has
none and follows the slip wherever that makes it smaller. On the line a reversal of slip serves for that."""
