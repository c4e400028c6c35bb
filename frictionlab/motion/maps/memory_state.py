"""Memory of a law as coordinates of a state, the scales of these, and the corners of their rates.

In a state a deflection is multiplied by the square root of its stiffness, as in the norm of energy. A
positive scalar is replaced by its logarithm as long as it is small, for it may range over decades, and left
as it is where it is large: a large scalar that decays then nears its orbit period by period. A law whose
deflections remember whether they stick has one more coordinate for each of them, zero for stick; it comes
back exactly or not at all.

The rate of a deflection may have corners: at its yield surface, and where it begins to be unloaded
elastically. Laws declare these corners; else they are found from the rates. A plugin may drag a slider
without saying where: its rate then jumps inside a step. A step of many stages, some before the jump and some
behind it, may then end before it for ever. Deflections have no preferred direction, and each moves by slip
and itself alone. So one ray shows where the deflection stops following the slip, and whether it follows a
slip that makes it smaller.
"""

from __future__ import annotations

import math
from typing import Any

from frictionlab.compile.decorators import inner
from frictionlab.compile.dispatch import by_dimension, by_law, by_scalars, length
from frictionlab.compile.stack import count_of
from frictionlab.laws.memory import VECTORIAL
from frictionlab.motion.equation import swing_of
from frictionlab.motion.linalg import dimension, put, taken
from frictionlab.motion.maps.rates import FOLLOWS, MEMORY, YIELDS, Work, as_memory, remembers_stick
from frictionlab.scene.body import BodyNumbers

ALIKE = 1e-9
"""Tolerance relative to slip: a rate that differs by less follows the slip; a deflection stretched by less is
not stretched."""
SHARES = 4
"""Number of places below the radius found, at which a deflection must follow the slip, loaded and
unloaded."""


@inner
def _follows(law: Any, work: Work, k: int, v: Any, z: Any) -> bool:
    work.memory[k] = z
    return length(law.rate(v, work.memory, k) - v) <= ALIKE * length(v)


@inner
def _first_yield(law: Any, work: Work, k: int, v: Any) -> float:
    """Return the deflection along v from which on it no longer follows the slip v; 0 for none."""
    along = v / length(v)
    usual = work.size[k]  # deflection in steady sliding, mostly that at yield
    if _follows(law, work, k, v, (1.0 - 1e-12) * usual * along) and not _follows(
        law, work, k, v, usual * along
    ):
        return usual
    low, high = 0.0, 1e3 * usual
    if not _follows(law, work, k, v, 1e-9 * usual * along) or _follows(law, work, k, v, high * along):
        return 0.0
    while True:
        middle = 0.5 * (low + high)
        if not low < middle < high:
            return high
        if _follows(law, work, k, v, middle * along):
            low = middle
        else:
            high = middle


@inner
def _yields_at(law: Any, work: Work, k: int, v: Any, radius: float) -> bool:
    """Check whether the deflection follows the slip v below the radius and is not stretched at it."""
    speed = length(v)
    along = v / speed
    for part in range(1, SHARES + 1):
        share = (1.0 - 1e-9) * radius * part / SHARES
        if not (_follows(law, work, k, v, share * along) and _follows(law, work, k, v, -share * along)):
            return False
    # unloaded from the surface, it must follow the slip, too
    if not _follows(law, work, k, v, -radius * along):
        return False
    # at the surface slip may turn the deflection, but not stretch it
    work.memory[k] = radius * along
    return length(law.rate(v, work.memory, k)) <= ALIKE * speed


@inner
def _found_radius(law: Any, work: Work, k: int, zero: Any) -> float:
    """Return the radius found from the rates, if it is the same at slips of any speed; else 0."""
    along = 1.0 + 0.0 * zero
    radius = _first_yield(law, work, k, along)
    # a radius that depends on the speed of slip is no yield surface
    for exponent in (-4.0, 2.0):
        if radius > 0.0 and not _yields_at(law, work, k, 10.0**exponent * along, radius):
            radius = 0.0
    work.memory[k] = 0.0 * along
    return radius


def _found_unloaded_in_the_plane(law: Any, work: Work, k: int, zero: complex) -> bool:
    """Check whether rates follow slips that shrink or turn a deflection, but not one that stretches it."""
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
    # on the line the corner is at the reversal of slip; up to it the law's own rate holds
    lambda law, work, k, zero: False,
    _found_unloaded_in_the_plane,
)


def _bristle_on_the_line(law: Any, work: Work, zero: float) -> None:
    work.radius[0], work.unloads[0] = law.yield_deflection(), 0.0


def _bristle_in_the_plane(law: Any, work: Work, zero: complex) -> None:
    vectorial = law.form == VECTORIAL
    work.radius[0] = law.yield_deflection() if vectorial else math.inf
    work.unloads[0] = 1.0 if vectorial and law.elastic_unloading() else 0.0


_corners_of_bristle = by_dimension(_bristle_on_the_line, _bristle_in_the_plane)


def _bristle(law: Any, work: Work, zero: Any) -> None:
    _corners_of_bristle(law, work, zero)
    work.radius[0] = work.radius[0] if work.radius[0] < math.inf else 0.0


def _deflections(law: Any, work: Work, zero: Any) -> None:
    for k in range(count_of(law)):
        work.memory[k] = 0.0 * zero
    for k in range(count_of(law)):
        radius = law.yield_deflection(k)
        work.radius[k], work.unloads[k] = radius if radius < math.inf else 0.0, 0.0
        # a deflection that remembers its mode has a breakaway in place of both
        if radius == math.inf and not law.remembers_stick():
            work.radius[k] = 0.0 if law.elastic_unloading() else _found_radius(law, work, k, zero)
            if work.radius[k] == 0.0:
                work.unloads[k] = 1.0 if _found_unloaded(law, work, k, zero) else 0.0
        work.memory[k] = 0.0 * zero


measure_yield = by_law(
    _bristle,
    _bristle,
    _deflections,
    # a scalar has no direction in which to yield
    lambda law, work, zero: None,
)
"""measure_yield(law, work, zero): fill the radius of each yield surface, 0 for none, and ``unloads``. That is
1 for a deflection without a yield surface that follows every slip which makes it smaller. On the line a
reversal of slip takes its place."""


# --- scales ---------------------------------------------------------------------------------------------------------


def _measure_bristle(law: Any, body: BodyNumbers, work: Work, zero: Any) -> None:
    """Fill size and unit of a bristle, by the stiffness of the contact about the undeflected bristle."""
    size = law.largest_deflection()
    size = size if size < 1e300 else 1.0
    work.size[0] = size
    work.unit[0] = math.sqrt(body.normal_load * abs(law.friction(0.0, size, 0.0)) / size)


DECADES_SLOWER = 4
"""Decades below the speed of the friction-free motion over which the size of a deflection is the largest."""
LEAST_EFFECT, LEAST_OF_SCALARS = 1e-6, 1e-3
"""Smallest change of friction, as a share of it, that a number of its size in steady sliding is taken to
cause; second, the same for a scalar, whose logarithm is shifted by as much as any other coordinate."""


@inner
def _effects(law: Any, body: BodyNumbers, work: Work, zero: Any, least: float) -> None:
    """Fill sizes in steady sliding at the speed of the friction-free motion.

    The slope of friction by each number is left in its unit.
    """
    v, n = swing_of(body) + 0.0 * zero, count_of(law)
    for k in range(n):
        work.memory[k] = law.steady(v, k)
        work.moving[k] = 0.0 * work.memory[k]
    most = law.sliding_friction(length(v))
    for k in range(n):
        here = work.memory[k]
        far = length(here)
        work.size[k] = far if far > 0.0 else 1.0
        # slope of friction in steady sliding over one number, the others fixed
        shift = 1e-3 * work.size[k]
        work.memory[k] = here + shift
        ahead = law.friction(v, work.memory, work.moving)
        work.memory[k] = here - shift
        slope = length(ahead - law.friction(v, work.memory, work.moving)) / (2.0 * shift)
        work.memory[k] = here
        work.unit[k] = max(slope, least * most / work.size[k])


def _measure_deflections(law: Any, body: BodyNumbers, work: Work, zero: Any) -> None:
    _effects(law, body, work, zero, LEAST_EFFECT)
    slip = swing_of(body) + 0.0 * zero
    for k in range(count_of(law)):
        work.unit[k] = math.sqrt(body.normal_load * work.unit[k])
        for decade in range(1, DECADES_SLOWER + 1):  # what quick slip leaves next to nothing of
            work.size[k] = max(work.size[k], length(law.steady(0.1**decade * slip, k)))


def _measure_scalars(law: Any, body: BodyNumbers, work: Work, zero: Any) -> None:
    _effects(law, body, work, zero, LEAST_OF_SCALARS)
    for k in range(count_of(law)):
        work.unit[k] = body.normal_load * work.unit[k] * work.size[k] / body.frequency
        here = work.memory[k]
        # the number is positive if the law does not allow its negative
        work.memory[k] = -here
        work.positive[k] = 0.0 if law.within(work.memory) else 1.0
        work.memory[k] = here


_measure_sizes = by_law(_measure_bristle, _measure_bristle, _measure_deflections, _measure_scalars)


@inner
def measure_scales(law: Any, body: BodyNumbers, work: Work, zero: Any) -> None:
    """Fill size in steady sliding, unit in the norm of energy and corners of each number, and the mean load."""
    work.share[0] = 1.0
    _measure_sizes(law, body, work, zero)
    measure_yield(law, work, zero)


# --- into a state and out of it -------------------------------------------------------------------------------------

coordinates = by_scalars(
    lambda law, zero: count_of(law) * (dimension(zero) + (1 if remembers_stick(law) else 0)),
    lambda law, zero: count_of(law),
)
"""coordinates(law, zero): number of coordinates of the memory in a state."""


@inner
def _unit_of_stick(body: BodyNumbers) -> float:
    """Return the coordinate of a slipping deflection; no quotient shifts a state by half of it."""
    return 1.0 + swing_of(body) + body.normal_load


def _pack_deflections(law: Any, body: BodyNumbers, work: Work, state: Any, zero: Any) -> None:
    d, n = dimension(zero), count_of(law)
    for k in range(n):
        put(state, 2 + k, work.unit[k] * work.start[MEMORY + k])
        if remembers_stick(law):
            slips = 1.0 if work.mode[k] == YIELDS else 0.0
            state[(2 + n) * d + k] = slips * _unit_of_stick(body)


def _pack_scalars(law: Any, body: BodyNumbers, work: Work, state: Any, zero: Any) -> None:
    first = 2 * dimension(zero)
    for k in range(count_of(law)):
        value = as_memory(law, work.start[MEMORY + k])
        state[first + k] = work.unit[k] * scalar_coordinate(value / work.size[k], work.positive[k])


pack_memory = by_scalars(_pack_deflections, _pack_scalars)
"""pack_memory(law, body, work, state, zero): write the memory at ``work.start`` into a state."""


@inner
def scalar_coordinate(share: float, positive: float) -> float:
    """Return the coordinate of a scalar, given as a share of its usual size."""
    if positive == 0.0:
        return share
    return math.log(max(share, 1e-300)) if share < 1.0 else share - 1.0


@inner
def scalar_share(coordinate: float, positive: float) -> float:
    """Return a scalar as a share of its usual size, from its coordinate."""
    if positive == 0.0:
        return coordinate
    return math.exp(coordinate) if coordinate < 0.0 else 1.0 + coordinate


def _unpack_deflections(law: Any, body: BodyNumbers, work: Work, state: Any, zero: Any) -> None:
    d, n = dimension(zero), count_of(law)
    for k in range(n):
        work.start[MEMORY + k] = taken(state, 2 + k, zero) / work.unit[k]
        if remembers_stick(law):
            slips = state[(2 + n) * d + k] > 0.5 * _unit_of_stick(body)
            work.mode[k] = YIELDS if slips else FOLLOWS


def _unpack_scalars(law: Any, body: BodyNumbers, work: Work, state: Any, zero: Any) -> None:
    first = 2 * dimension(zero)
    for k in range(count_of(law)):
        share = scalar_share(state[first + k] / work.unit[k], work.positive[k])
        work.start[MEMORY + k] = work.size[k] * share + 0.0 * zero


unpack_memory = by_scalars(_unpack_deflections, _unpack_scalars)
"""unpack_memory(law, body, work, state, zero): read the memory of a state into ``work.start``."""


# --- the set of memories that slip leads to -------------------------------------------------------------------------


@inner
def pulled(law: Any, memory: Any, alone: Any) -> None:
    """Cut back each deflection that no slip history leads to: beyond its reach it would stay for ever.

    alone: room for a memory.
    """
    if law.turning == 0.0 or law.within(memory):
        return
    for k in range(count_of(law)):
        # each deflection separately: the set that slip leads to is the product of their sets
        for j in range(count_of(law)):
            alone[j] = 0.0 * memory[j]
        low, high = 0.0, 2.0
        while high - low > 1e-15:
            middle = 0.5 * (low + high)
            alone[k] = middle * memory[k]
            if law.within(alone):
                low = middle
            else:
                high = middle
        memory[k] = min(low, 1.0) * memory[k]


def _leave(law: Any, work: Work) -> None:
    """Leave the state of a bristle, or of scalars, as it is."""


def _cut_back(law: Any, work: Work) -> None:
    for k in range(count_of(law)):
        work.memory[k] = work.start[MEMORY + k]
    pulled(law, work.memory, work.moving)
    for k in range(count_of(law)):
        work.start[MEMORY + k] = work.memory[k]


cut_back = by_law(_leave, _leave, _cut_back, _leave)
"""cut_back(law, work): bring the deflections at ``work.start`` back into the set that slip leads to."""


@inner
def remember_sliding(law: Any, body: BodyNumbers, work: Work, slip: Any) -> None:
    """Write the memory of steady sliding at a slip velocity into ``work.start``.

    At rest there is no deflection, and scalars are those of free motion.
    """
    v = slip if length(slip) > 0.0 else swing_of(body) + 0.0 * slip
    rests = length(slip) == 0.0 and law.turning > 0.0
    for k in range(count_of(law)):
        work.start[MEMORY + k] = law.steady(v, k) * (0.0 if rests else 1.0) + 0.0 * slip
        work.mode[k] = FOLLOWS if rests else YIELDS
