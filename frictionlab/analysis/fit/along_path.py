"""Friction of a law along a measured path of slip: no body, the law alone, whatever it remembers.

Between two samples the slip velocity is constant. A bristle whose path is exact, and deflections that yield, move
along it in one step, another bristle by exponential steps short against its presliding length; other memories by
classical Runge-Kutta steps, halved until two agree. An element that remembers whether it sticks follows the slip up
to its breakaway, and slips until slip reverses.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from frictionlab.compile.call import KernelCall
from frictionlab.compile.decorators import inner, njit
from frictionlab.laws.base import FrictionLaw
from frictionlab.laws.memory import BristleLaw, MemoryLaw
from frictionlab.motion.contact import advance_bristle, resistance
from frictionlab.values.quantities import Floats

BRISTLE_STEP = 0.05
"""Longest step of a bristle without an exact path, in presliding lengths."""
AGREEING = 1e-7
"""Two Runge-Kutta results agree where they differ by less, relative to the size of the memory."""
MOST_HALVED = 256
"""Runge-Kutta steps between two samples; a jump of the rate inside one then has no more effect than noise."""


@njit
def along_without_memory(law: Any, times: Any, slips: Any, friction: Any) -> None:
    """Friction at the end of each interval; where slip rests, what it was."""
    for i in range(1, times.size):
        v = (slips[i] - slips[i - 1]) / (times[i] - times[i - 1])
        friction[i] = friction[i - 1] if v == 0.0 else law.sliding_vector(v)


@njit
def along_with_a_bristle(law: Any, times: Any, slips: Any, friction: Any, start: float, short: float) -> None:
    """Compute friction along a path of one deflection, from this one. short: longest step [scene length]."""
    z = start
    for i in range(1, times.size):
        h = times[i] - times[i - 1]
        v = (slips[i] - slips[i - 1]) / h
        count = 1 if law.exact_path() else max(1, math.ceil(abs(v) * h / short))
        for _ in range(count):
            z = advance_bristle(law, h / count, v, z)
        _, friction[i] = resistance(law, v, z)


@inner
def _rates(law: Any, v: float, memory: Any, rates: Any) -> None:
    for k in range(memory.size):
        rates[k] = law.rate(v, memory, k)


@inner
def _runge_kutta(law: Any, v: float, h: float, memory: Any, count: int, work: Any) -> None:
    """Moves a memory in so many steps."""
    at, slope, total = work[0], work[1], work[2]
    step = h / count
    for _ in range(count):
        for stage in range(4):
            share = 0.0 if stage == 0 else 1.0 if stage == 3 else 0.5
            for k in range(memory.size):
                at[k] = memory[k] + share * step * slope[k] if stage else memory[k]
            _rates(law, v, at, slope)
            for k in range(memory.size):
                weight = 1.0 if stage in (0, 3) else 2.0
                total[k] = weight * slope[k] + (total[k] if stage else 0.0)
        for k in range(memory.size):
            memory[k] += step * total[k] / 6.0


@njit
def along_with_memory(law: Any, times: Any, slips: Any, friction: Any, memory: Any, most: int) -> None:
    """Compute friction along a path of several numbers, or of such without direction. memory: overwritten."""
    work, few, many = np.zeros((3, memory.size)), np.empty_like(memory), np.empty_like(memory)
    rates = np.zeros(memory.size)
    for i in range(1, times.size):
        h = times[i] - times[i - 1]
        v = (slips[i] - slips[i - 1]) / h
        few[:] = memory
        _runge_kutta(law, v, h, few, 1, work)
        count = 2
        while True:
            many[:] = memory
            _runge_kutta(law, v, h, many, count, work)
            apart, size = 0.0, 0.0
            for k in range(memory.size):
                apart, size = max(apart, abs(many[k] - few[k])), max(size, abs(many[k]))
            if not apart > AGREEING * size or count >= most:
                break
            few[:] = many
            count *= 2
        memory[:] = many
        _rates(law, v, memory, rates)
        friction[i] = law.friction(v, memory, rates)


@njit
def along_with_yield(law: Any, times: Any, slips: Any, friction: Any, memory: Any, reach: Any) -> None:
    """Compute friction along a path of deflections that follow the slip up to their reach, exactly."""
    rates = np.zeros(memory.size)
    for i in range(1, times.size):
        path = slips[i] - slips[i - 1]
        v = path / (times[i] - times[i - 1])
        for k in range(memory.size):
            moved = memory[k] + path
            held = min(max(moved, -reach[k]), reach[k])
            memory[k], rates[k] = held, v if held == moved else 0.0
        friction[i] = law.friction(v, memory, rates)


@njit
def along_with_stick(law: Any, times: Any, slips: Any, friction: Any, memory: Any) -> None:
    """Compute friction along a path of elements that remember whether they stick; all do at the start."""
    sticks, rates, work = np.ones(memory.size), np.zeros(memory.size), np.zeros((3, memory.size))
    own = np.empty_like(memory)
    for i in range(1, times.size):
        h = times[i] - times[i - 1]
        v = (slips[i] - slips[i - 1]) / h
        own[:] = memory
        _runge_kutta(law, v, h, own, 4, work)
        for k in range(memory.size):
            if sticks[k] == 0.0 and memory[k] * v <= 0.0:
                sticks[k] = 1.0
            if sticks[k] == 1.0:
                moved, limit = memory[k] + h * v, law.breakaway(v, k)
                if moved * v > 0.0 and abs(moved) >= limit:
                    sticks[k], moved = 0.0, math.copysign(limit, v)
                memory[k] = moved
            else:
                memory[k] = own[k]
        for k in range(memory.size):
            rates[k] = v if sticks[k] == 1.0 else law.rate(v, memory, k)
        friction[i] = law.friction(v, memory, rates)


def friction_along(law: FrictionLaw, times: Floats, slips: Floats, first: float) -> Floats:
    """Return the friction coefficient at each sample, along the slip between it and the one before.

    times [scene time], rising; slips [scene length]: how far the body has slipped. first: the measured coefficient at
    the first sample, from which the memory at the start is found.
    """
    friction = np.full(times.size, first)
    given = np.ascontiguousarray(times), np.ascontiguousarray(slips), friction
    if isinstance(law, BristleLaw):
        length = law.presliding() or 1.0
        KernelCall(along_with_a_bristle, law)(*given, _bent(law, first), BRISTLE_STEP * length)
    elif isinstance(law, MemoryLaw):
        memory = _memory_at_start(law, slips, times, first)
        reach = np.array([law.yield_deflection(k) for k in range(law.count())])
        if law.remembers_stick():
            KernelCall(along_with_stick, law)(*given, memory)
        elif law.memory_kind == "deflections" and np.isfinite(reach).all():
            KernelCall(along_with_yield, law)(*given, memory, reach)
        else:
            KernelCall(along_with_memory, law)(*given, memory, MOST_HALVED)
    else:
        KernelCall(along_without_memory, law)(*given)
    return friction


def _bent(law: BristleLaw, friction: float) -> float:
    """Return the deflection at which a bristle at rest carries this friction, within its reach."""
    per_length = float(law.friction(0.0, 1.0, 0.0))
    reach = min(law.largest_deflection(), law.yield_deflection(), abs(law.presliding()) or math.inf)
    bent = friction / per_length if per_length else 0.0
    return math.copysign(min(abs(bent), reach), bent)


def _memory_at_start(law: MemoryLaw, slips: Floats, times: Floats, first: float) -> Floats:
    """Deflections that share the friction as in steady sliding; numbers without direction as in steady sliding."""
    moving = np.flatnonzero(np.diff(slips))
    at = int(moving[0]) if moving.size else 0
    v = float((slips[at + 1] - slips[at]) / (times[at + 1] - times[at])) or 1.0
    steady = np.array([law.steady(v, k) for k in range(law.count())], dtype=float)
    if law.memory_kind == "scalars":
        return steady
    whole = float(law.friction(0.0, steady, np.zeros_like(steady)))
    share = first / whole if whole else 0.0
    return np.asarray(steady * max(-1.0, min(1.0, share)))
