"""The memory of a law as kernels keep it: an array for the law, real numbers for a stepper, coordinates for a state.

In the plane a deflection is complex to its law and two numbers to a stepper. In a state a deflection is measured by
the square root of its stiffness, as energy is; a positive scalar by its logarithm as long as it is small, for it may
range over decades, and by itself where it is large: what decays there then nears its orbit period by period.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from frictionlab.compile.decorators import inner
from frictionlab.compile.dispatch import by_dimension, by_law, length
from frictionlab.scene.body import Body


def _numbers(law: Any, like: Any) -> Any:
    return np.zeros(law.count())


def _vectors(law: Any, like: Any) -> Any:
    return np.zeros(law.count(), np.complex128)


memory_of = by_law(_numbers, _numbers, None, _numbers, _vectors)
"""An array for the memory of a law, at zero."""


def _parts_of_numbers(item: float) -> int:
    return 1


def _parts_of_vectors(item: complex) -> int:
    return 2


parts = by_dimension(_parts_of_numbers, _parts_of_vectors)
"""How many real numbers one memory is."""


def _filled_numbers(memory: Any, values: Any, at: int, item: float) -> None:
    for k in range(memory.size):
        memory[k] = values[at + k]


def _filled_vectors(memory: Any, values: Any, at: int, item: complex) -> None:
    for k in range(memory.size):
        memory[k] = complex(values[at + 2 * k], values[at + 2 * k + 1])


filled = by_dimension(_filled_numbers, _filled_vectors)
"""Fill a memory from real numbers that begin at a place; the last argument is one of its items."""


def _spilled_numbers(memory: Any, values: Any, at: int, item: float) -> None:
    for k in range(memory.size):
        values[at + k] = memory[k]


def _spilled_vectors(memory: Any, values: Any, at: int, item: complex) -> None:
    for k in range(memory.size):
        values[at + 2 * k], values[at + 2 * k + 1] = memory[k].real, memory[k].imag


spilled = by_dimension(_spilled_numbers, _spilled_vectors)
"""The other way round."""


class Scales(NamedTuple):
    """Of each memory: what a state has it multiplied by, its size in steady sliding, whether it is never negative."""

    unit: Any
    size: Any
    positive: Any


@inner
def swing_of(body: Body) -> float:
    """The speed of the friction-free motion; 1 where it has no bound."""
    swing = body.frequency * math.hypot(abs(body.reference_sine), abs(body.reference_cosine))
    return swing if swing > 0.0 else 1.0


@inner
def scales_of(law: Any, body: Body, like: Any) -> Scales:
    """Told by steady sliding as fast as the friction-free motion."""
    v = swing_of(body) + 0.0 * like
    memory, still = memory_of(law, like), memory_of(law, like)
    n = memory.size
    scales = Scales(np.ones(n), np.ones(n), np.zeros(n, np.bool_))
    for k in range(n):
        memory[k] = law.steady(v, k)
        scales.size[k] = length(memory[k])
    most = law.sliding_friction(length(v))
    for k in range(n):
        here = memory[k]
        if scales.size[k] == 0.0:
            scales.size[k] = 1.0
        shift = 1e-3 * scales.size[k]
        memory[k] = here + shift
        ahead = law.friction(v, memory, still)
        memory[k] = here - shift
        slope = length(ahead - law.friction(v, memory, still)) / (2.0 * shift)
        if law.turning > 0.0:
            scales.unit[k] = math.sqrt(body.normal_load * max(slope, 1e-6 * most / scales.size[k]))
        else:
            effect = max(slope * scales.size[k], 1e-6 * most)
            scales.unit[k] = body.normal_load * effect / body.frequency
            memory[k] = -here
            scales.positive[k] = not law.within(memory)
        memory[k] = here
    return scales


def _kept_numbers(memory: Any, law: Any, scales: Scales, state: Any, at: int, item: float) -> None:
    for k in range(memory.size):
        unit = scales.unit[k]
        if law.turning > 0.0:
            state[at + k] = unit * memory[k]
        elif scales.positive[k]:
            share = max(memory[k], 1e-300) / scales.size[k]
            state[at + k] = unit * (math.log(share) if share < 1.0 else share - 1.0)
        else:
            state[at + k] = unit * memory[k] / scales.size[k]


def _kept_vectors(memory: Any, law: Any, scales: Scales, state: Any, at: int, item: complex) -> None:
    for k in range(memory.size):
        z = scales.unit[k] * memory[k]
        state[at + 2 * k], state[at + 2 * k + 1] = z.real, z.imag


kept = by_dimension(_kept_numbers, _kept_vectors)
"""kept(memory, law, scales, state, at, memory[0]): write a memory into a state, from a place on."""


def _recalled_numbers(memory: Any, law: Any, scales: Scales, state: Any, at: int, item: float) -> None:
    for k in range(memory.size):
        value = state[at + k] / scales.unit[k]
        if law.turning > 0.0:
            memory[k] = value
        elif scales.positive[k]:
            memory[k] = scales.size[k] * (math.exp(value) if value < 0.0 else 1.0 + value)
        else:
            memory[k] = scales.size[k] * value


def _recalled_vectors(memory: Any, law: Any, scales: Scales, state: Any, at: int, item: complex) -> None:
    for k in range(memory.size):
        memory[k] = complex(state[at + 2 * k], state[at + 2 * k + 1]) / scales.unit[k]


recalled = by_dimension(_recalled_numbers, _recalled_vectors)
"""The other way round."""


@inner
def pulled(law: Any, memory: Any, alone: Any) -> None:
    """Cut back each deflection that no slip history leads to: beyond its reach it would stay for ever.

    alone: room for a memory.
    """
    if law.turning == 0.0 or law.within(memory):
        return
    for k in range(memory.size):
        for j in range(memory.size):
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


@inner
def slid(law: Any, body: Body, memory: Any, slip: Any) -> None:
    """The memory of steady sliding at a slip velocity; at rest no deflection, and scalars as in free motion."""
    v = slip if length(slip) > 0.0 else swing_of(body) + 0.0 * slip
    rests = length(slip) == 0.0 and law.turning > 0.0
    for k in range(memory.size):
        memory[k] = law.steady(v, k) * (0.0 if rests else 1.0)
