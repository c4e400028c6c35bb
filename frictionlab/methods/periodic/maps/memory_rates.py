"""The motion of a mass and of the memory of its friction, of any size, as one array of numbers.

They are the deviation y from the harmonic reference, the slip w itself, friction's integral and the memory. A law may
creep at 1e-26 of the belt speed in stick: as a difference of two velocities such a slip would be lost.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from frictionlab.compile.decorators import inner
from frictionlab.compile.dispatch import by_dimension, length
from frictionlab.dynamics.motion import (
    Instant,
    acceleration_under,
    belt_velocity,
    deviation_slip_rate,
    instant_near,
    normal_load,
    reference_velocity,
    unbalanced_load,
)
from frictionlab.methods.periodic.maps.memory_state import filled, memory_of, parts, spilled
from frictionlab.numerics.steppers.rodas5p import STAGES
from frictionlab.numerics.vectors import dimension, put, taken
from frictionlab.scene.body import Body

YIELDS = 1e-9
"""Of the slip along a deflection: one that is stretched by less yields, one that lags by less moves with it."""

BEYOND = 1.0 + 1e-12
"""Of a deflection on the line that yields: so far out its rate is told, beyond what rounding leaves of it."""


class Problem(NamedTuple):
    """A law and a body on a belt; sine and cosine at the anchor time."""

    law: Any
    body: Body
    belt_speed: float
    anchor: float
    sine: float
    cosine: float


class Work(NamedTuple):
    """Room for one step; values are [y, w, friction's integral, memory], the first three of d numbers each."""

    at: Any  # where the step starts
    k: Any  # [stages, n] increments
    stage: Any
    rates: Any
    slope: Any  # derivative of the rates with respect to time
    end: Any  # where the step ends
    kept: Any  # the same, while the way there is noted
    matrix: Any  # [d + m, d + m]
    right: Any
    rows: Any
    by: Any  # [m + d, d + m] rates of memory and friction by slip and memory
    drag: Any  # [2, d] damping and stiffness of the body
    memory: Any  # as the law knows it
    moving: Any  # its rates
    trial: Any  # [3, m + d] rates of memory and friction, for quotients
    radius: Any  # at which a deflection yields, 0 where it does not
    follows: Any  # 1 for a deflection that moves with the slip, else 0


@inner
def work_of(law: Any, body: Body, like: Any) -> Work:
    """Room for the steps of a law."""
    d, memory = dimension(like), memory_of(law, like)
    m = memory.size * parts(memory[0])
    n = 3 * d + m
    drag = np.empty((2, d))
    drag[0, 0] = body.damping_mean + body.damping_split
    drag[1, 0] = body.stiffness_mean + body.stiffness_split
    if d == 2:
        drag[0, 1] = body.damping_mean - body.damping_split
        drag[1, 1] = body.stiffness_mean - body.stiffness_split
    return Work(
        np.zeros(n),
        np.zeros((STAGES, n)),
        np.zeros(n),
        np.zeros(n),
        np.zeros(n),
        np.zeros(n),
        np.zeros(n),
        np.zeros((d + m, d + m)),
        np.zeros(d + m),
        np.zeros(d + m, np.int64),
        np.zeros((m + d, d + m)),
        drag,
        memory,
        memory_of(law, like),
        np.zeros((3, m + d)),
        np.zeros(memory.size),
        np.zeros(memory.size),
    )


@inner
def anchored(law: Any, body: Body, belt_speed: float, tau: float) -> Problem:
    """The problem with its sine and cosine at this time."""
    angle = body.frequency * tau
    return Problem(law, body, belt_speed, tau, math.sin(angle), math.cos(angle))


def _rounded_on_the_line(memory: Any, radius: Any, item: float) -> None:
    """Put what yields just beyond where it does, not a rounding error inside."""
    for k in range(memory.size):
        if radius[k] > 0.0:
            memory[k] = math.copysign(radius[k] * BEYOND, memory[k])


def _held_on_the_line(w: float, work: Any, item: float) -> None:
    """What yields stays what it is, what moves with the slip goes on to: corners are met by the ends of steps."""
    for k in range(work.memory.size):
        if work.radius[k] > 0.0:
            work.moving[k] = 0.0
        elif work.follows[k] > 0.0:
            work.moving[k] = w


def _held_in_the_plane(w: complex, work: Any, item: complex) -> None:
    """The same; but what yields turns on its circle as the law says."""
    for k in range(work.memory.size):
        if work.follows[k] > 0.0:
            work.moving[k] = w


_held = by_dimension(_held_on_the_line, _held_in_the_plane)


def _pushed_out_on_the_line(memory: Any, item: float) -> None:
    """A rounding error inside, what yields would seem to bend on."""
    for k in range(memory.size):
        memory[k] = memory[k] * BEYOND


def _pushed_out_in_the_plane(memory: Any, item: complex) -> None:
    """Left where it is."""


_pushed_out = by_dimension(_pushed_out_on_the_line, _pushed_out_in_the_plane)


def _rounded_in_the_plane(memory: Any, radius: Any, item: complex) -> None:
    """Put what yields on its circle, not a rounding error inside it."""
    for k in range(memory.size):
        if radius[k] > 0.0:
            memory[k] = memory[k] * (radius[k] * (1.0 + 1e-15) / abs(memory[k]))


rounded = by_dimension(_rounded_on_the_line, _rounded_in_the_plane)


def _yielding_on_the_line(w: float, work: Any, item: float) -> None:
    """Tell from ``work.moving``, the rates just beyond, which deflections slip loads without stretching them."""
    for k in range(work.memory.size):
        yields = w * work.memory[k] > 0.0 and abs(work.moving[k]) <= YIELDS * abs(w)
        work.radius[k] = abs(work.memory[k]) / BEYOND if yields else 0.0


def _yielding_in_the_plane(w: complex, work: Any, item: complex) -> None:
    """Tell from ``work.moving`` which deflections slip loads without stretching them."""
    for k in range(work.memory.size):
        z = work.memory[k]
        loaded = (w * z.conjugate()).real
        stretched = abs((work.moving[k] * z.conjugate()).real)
        work.radius[k] = abs(z) if loaded > 0.0 and stretched <= YIELDS * loaded else 0.0


_yielding = by_dimension(_yielding_on_the_line, _yielding_in_the_plane)


@inner
def begin_step(law: Any, w: Any, work: Work, like: Any) -> None:
    """Tell at the start of a step which deflections yield, which are put on their circles, and which follow the slip.

    Each goes on so to the end of the step, which is smooth for that.
    """
    filled(work.memory, work.at, 3 * dimension(like), work.memory[0])
    work.radius[:] = 0.0
    work.follows[:] = 0.0
    if law.turning > 0.0:
        _pushed_out(work.memory, work.memory[0])
        felt(law, w, work)
        _yielding(w, work, work.memory[0])
        for k in range(work.memory.size):
            alike = length(work.moving[k] - w) <= YIELDS * length(w)
            work.follows[k] = 1.0 if alike and work.radius[k] == 0.0 else 0.0


def _settled_on_the_line(work: Work, like: float) -> None:
    """On the line nothing has moved it."""


def _settled_in_the_plane(work: Work, like: complex) -> None:
    filled(work.memory, work.at, 6, work.memory[0])
    rounded(work.memory, work.radius, work.memory[0])
    spilled(work.memory, work.at, 6, work.memory[0])


settled = by_dimension(_settled_on_the_line, _settled_in_the_plane)
"""Put what yielded in the step that led to ``work.at`` back on its circle, which errors of the step lead off."""


@inner
def felt(law: Any, w: Any, work: Work) -> Any:
    """Friction of ``work.memory`` at a slip velocity; leaves the memory's rates in ``work.moving``."""
    rounded(work.memory, work.radius, work.memory[0])
    for k in range(work.memory.size):
        work.moving[k] = law.rate(w, work.memory, k)
    _held(w, work, work.memory[0])
    return law.friction(w, work.memory, work.moving)


@inner
def pushed(body: Body, now: Instant) -> float:
    """The normal load by which friction moves the mass."""
    return 0.0 if body.prescribed else normal_load(body, now)


@inner
def rates(problem: Problem, tau: float, values: Any, work: Work, out: Any, like: Any) -> Any:
    """The rate of the values; returns the slip's."""
    body, now = problem.body, instant_near(problem, tau)
    y, w = taken(values, 0, like), taken(values, 1, like)
    u = w + belt_velocity(body, problem.belt_speed, now) - reference_velocity(body, now.sine, now.cosine)
    filled(work.memory, values, 3 * dimension(like), work.memory[0])
    rub = felt(problem.law, w, work)
    a = acceleration_under(body, unbalanced_load(body, now), pushed(body, now), y, u, rub)
    a = deviation_slip_rate(problem, now, a)
    put(out, 0, u)
    put(out, 1, a)
    put(out, 2, rub)
    spilled(work.moving, out, 3 * dimension(like), work.moving[0])
    return a
