"""What a law remembers as coordinates of a state, and the scales that those are measured by.

In a state a deflection is measured by the square root of its stiffness, as energy is; a positive scalar by its
logarithm as long as it is small, for it may range over decades, and by itself where it is large: what decays there
then nears its orbit period by period. A law whose deflections remember whether they stick has one more coordinate
for each of them, zero for stick; it comes back exactly or not at all.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from frictionlab.compile.decorators import inner
from frictionlab.compile.dispatch import by_dimension, by_law, by_scalars, length
from frictionlab.compile.stack import count_of
from frictionlab.dynamics.motion import swing_of
from frictionlab.methods.periodic.maps.rates import FOLLOWS, MEMORY, YIELDS, Work, as_memory, remembers_stick
from frictionlab.methods.periodic.maps.yield_surface import measure_yield
from frictionlab.numerics.vectors import dimension, put, taken
from frictionlab.scene.body import BodyNumbers

_by_direction = by_dimension(
    lambda law, like: np.zeros(law.count()), lambda law, like: np.zeros(law.count(), np.complex128)
)

memory_of = by_scalars(lambda law, like: _by_direction(law, like), lambda law, like: np.zeros(law.count()))
"""memory_of(law, like): an array for the memory of a law, at zero."""


# --- scales ---------------------------------------------------------------------------------------------------------


def _measure_bristle(law: Any, body: BodyNumbers, work: Work, like: Any) -> None:
    """The stiffness of the contact about the undeflected bristle."""
    size = law.largest_deflection()
    size = size if size < 1e300 else 1.0
    work.size[0] = size
    work.unit[0] = math.sqrt(body.normal_load * abs(law.friction(0.0, size, 0.0)) / size)


LEAST_EFFECT, LEAST_OF_SCALARS = 1e-6, 1e-3
"""Of friction, that a number of the size it has in steady sliding is taken to change; of a scalar, whose logarithm is
shifted by as much as any other coordinate."""


@inner
def _effects(law: Any, body: BodyNumbers, work: Work, like: Any, least: float) -> None:
    """Sizes in steady sliding as fast as the friction-free motion; into units, the slope of friction by each."""
    v, n = swing_of(body) + 0.0 * like, count_of(law)
    for k in range(n):
        work.memory[k] = law.steady(v, k)
        work.moving[k] = 0.0 * work.memory[k]
    most = law.sliding_friction(length(v))
    for k in range(n):
        here = work.memory[k]
        far = length(here)
        work.size[k] = far if far > 0.0 else 1.0
        # how much friction in steady sliding changes with one number, the others as they are
        shift = 1e-3 * work.size[k]
        work.memory[k] = here + shift
        ahead = law.friction(v, work.memory, work.moving)
        work.memory[k] = here - shift
        slope = length(ahead - law.friction(v, work.memory, work.moving)) / (2.0 * shift)
        work.memory[k] = here
        work.unit[k] = max(slope, least * most / work.size[k])


def _measure_deflections(law: Any, body: BodyNumbers, work: Work, like: Any) -> None:
    _effects(law, body, work, like, LEAST_EFFECT)
    for k in range(count_of(law)):
        work.unit[k] = math.sqrt(body.normal_load * work.unit[k])


def _measure_scalars(law: Any, body: BodyNumbers, work: Work, like: Any) -> None:
    _effects(law, body, work, like, LEAST_OF_SCALARS)
    for k in range(count_of(law)):
        work.unit[k] = body.normal_load * work.unit[k] * work.size[k] / body.frequency
        here = work.memory[k]
        # a law that does not allow the negative of it takes the number for positive
        work.memory[k] = -here
        work.positive[k] = 0.0 if law.within(work.memory) else 1.0
        work.memory[k] = here


_measure_sizes = by_law(_measure_bristle, _measure_bristle, _measure_deflections, _measure_scalars)


@inner
def measure_scales(law: Any, body: BodyNumbers, work: Work, like: Any) -> None:
    """Fill of each number its size in steady sliding, its unit in the norm of energy and where it yields."""
    _measure_sizes(law, body, work, like)
    measure_yield(law, work, like)


# --- into a state and out of it -------------------------------------------------------------------------------------

coordinates = by_scalars(
    lambda law, like: count_of(law) * (dimension(like) + (1 if remembers_stick(law) else 0)),
    lambda law, like: count_of(law),
)
"""coordinates(law, like): how many numbers of a state hold the memory."""


@inner
def _unit_of_stick(body: BodyNumbers) -> float:
    """What a state has stick or slip multiplied by: no quotient shifts a state by half of that."""
    return 1.0 + swing_of(body) + body.normal_load


def _pack_deflections(law: Any, body: BodyNumbers, work: Work, state: Any, like: Any) -> None:
    d, n = dimension(like), count_of(law)
    for k in range(n):
        put(state, 2 + k, work.unit[k] * work.start[MEMORY + k])
        if remembers_stick(law):
            slips = 1.0 if work.mode[k] == YIELDS else 0.0
            state[(2 + n) * d + k] = slips * _unit_of_stick(body)


def _pack_scalars(law: Any, body: BodyNumbers, work: Work, state: Any, like: Any) -> None:
    first = 2 * dimension(like)
    for k in range(count_of(law)):
        value = as_memory(law, work.start[MEMORY + k])
        state[first + k] = work.unit[k] * scalar_coordinate(value / work.size[k], work.positive[k])


pack_memory = by_scalars(_pack_deflections, _pack_scalars)
"""pack_memory(law, body, work, state, like): write the memory at ``work.start`` into a state."""


@inner
def scalar_coordinate(share: float, positive: float) -> float:
    """Of a scalar, as a share of its usual size."""
    if positive == 0.0:
        return share
    return math.log(max(share, 1e-300)) if share < 1.0 else share - 1.0


@inner
def scalar_share(coordinate: float, positive: float) -> float:
    """The other way round."""
    if positive == 0.0:
        return coordinate
    return math.exp(coordinate) if coordinate < 0.0 else 1.0 + coordinate


def _unpack_deflections(law: Any, body: BodyNumbers, work: Work, state: Any, like: Any) -> None:
    d, n = dimension(like), count_of(law)
    for k in range(n):
        work.start[MEMORY + k] = taken(state, 2 + k, like) / work.unit[k]
        if remembers_stick(law):
            slips = state[(2 + n) * d + k] > 0.5 * _unit_of_stick(body)
            work.mode[k] = YIELDS if slips else FOLLOWS


def _unpack_scalars(law: Any, body: BodyNumbers, work: Work, state: Any, like: Any) -> None:
    first = 2 * dimension(like)
    for k in range(count_of(law)):
        share = scalar_share(state[first + k] / work.unit[k], work.positive[k])
        work.start[MEMORY + k] = work.size[k] * share + 0.0 * like


unpack_memory = by_scalars(_unpack_deflections, _unpack_scalars)
"""unpack_memory(law, body, work, state, like): read the memory of a state into ``work.start``."""


# --- the set of memories that slip leads to -------------------------------------------------------------------------


@inner
def pulled(law: Any, memory: Any, alone: Any) -> None:
    """Cut back each deflection that no slip history leads to: beyond its reach it would stay for ever.

    alone: room for a memory.
    """
    if law.turning == 0.0 or law.within(memory):
        return
    for k in range(count_of(law)):
        # each deflection by itself: the set that slip leads to is a product of theirs
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
    """The state of a bristle, or of scalars, is what it is."""


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
    """The memory of steady sliding at a slip velocity; at rest no deflection, and scalars as in free motion."""
    v = slip if length(slip) > 0.0 else swing_of(body) + 0.0 * slip
    rests = length(slip) == 0.0 and law.turning > 0.0
    for k in range(count_of(law)):
        work.start[MEMORY + k] = law.steady(v, k) * (0.0 if rests else 1.0) + 0.0 * slip
        work.mode[k] = FOLLOWS if rests else YIELDS
