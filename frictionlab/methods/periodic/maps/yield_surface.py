"""The yield surface of each deflection: as a law declares it, or found by asking the rates of a law that does not.

A plugin may drag a slider without saying where: its rate then jumps inside a step, and a step of many stages, some
before the jump and some behind it, may end before it for ever. Deflections have no preferred direction and one moves
by slip and itself alone, so that one ray tells all: where along it the deflection stops following the slip.
"""

from __future__ import annotations

import math
from typing import Any

from frictionlab.compile.decorators import inner
from frictionlab.compile.dispatch import by_law, length
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
    if not _follows(law, work, k, v, -radius * way):
        return False
    work.memory[k] = radius * way
    return length(law.rate(v, work.memory, k)) <= ALIKE * speed


@inner
def _found_radius(law: Any, work: Work, k: int, like: Any) -> float:
    """The radius that rates tell, the same at slips of any speed; 0 where they tell none."""
    along = 1.0 + 0.0 * like
    radius = _first_yield(law, work, k, along)
    for exponent in (-4.0, 2.0):
        if radius > 0.0 and not _yields_at(law, work, k, 10.0**exponent * along, radius):
            radius = 0.0
    work.memory[k] = 0.0 * along
    return radius


def _radius_of_a_bristle(law: Any, work: Work, like: Any) -> None:
    radius = law.yield_deflection()
    work.radius[0] = radius if radius < math.inf and law.form == VECTORIAL else 0.0


def _radii_of_deflections(law: Any, work: Work, like: Any) -> None:
    for k in range(count_of(law)):
        work.memory[k] = 0.0 * like
    for k in range(count_of(law)):
        radius = law.yield_deflection(k)
        work.radius[k] = radius if radius < math.inf else 0.0
        if radius == math.inf and not law.remembers_stick() and not law.elastic_unloading():
            work.radius[k] = _found_radius(law, work, k, like)


def _no_radius(law: Any, work: Work, like: Any) -> None:
    """A scalar has no direction in which to yield."""


measure_yield = by_law(_radius_of_a_bristle, _radius_of_a_bristle, None, _radii_of_deflections, _no_radius)
"""measure_yield(law, work, like): fill the radius of each yield surface, 0 for none."""
