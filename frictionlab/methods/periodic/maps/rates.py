"""The equation of motion of a mass and of what its friction remembers, a deflection or several.

On the line every quantity is a float, in the plane a complex number. The mass moves by its deviation y from the
harmonic reference and by u = y'; friction's impulse is integrated along. A deflection goes by its law's own rate, but
for two kinds that have corners: one that follows the slip and one that yields are held so to the end of a step.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from frictionlab.compile.decorators import fast, inlined, inner
from frictionlab.compile.dispatch import by_dimension, by_law
from frictionlab.compile.stack import count_of, room
from frictionlab.dynamics.motion import (
    Instant,
    acceleration_under,
    deviation_slip,
    deviation_slip_rate,
    normal_load,
    unbalanced_load,
)
from frictionlab.laws.memory import PER_AXIS, VECTORIAL
from frictionlab.scene.body import Body

Y, U, IMPULSE, MEMORY = 0, 1, 2, 3
"""Places of the mass: its deviation, the velocity of that, the integral of the friction coefficient; then memory."""

FOLLOWS, SMOOTH, YIELDS = -1.0, 0.0, 1.0
"""Modes of a deflection: it moves with the slip; by its law's rate; on its yield surface, or gives way before it."""


class Flow(NamedTuple):
    """A law and a body on a belt; the sign of slip on the line; sine and cosine of the drive at the anchor time."""

    law: Any
    body: Body
    belt_speed: float
    side: float
    anchor: float
    sine: float
    cosine: float


class Work(NamedTuple):
    """Room for one step; a state is the mass (Y, U, IMPULSE) and, from MEMORY on, n deflections."""

    start: Any  # where the step starts
    end: Any  # where it ends
    stage: Any  # at which rates are asked for
    rates: Any
    slope: Any  # derivative of the rates by time
    increments: Any  # of every stage
    memory: Any  # [n] as the law sees it
    moving: Any  # [n] its rates
    jacobian: (
        Any  # blocks, of each deflection: its rate by slip, by itself, friction by it; last friction by slip
    )
    factors: Any  # blocks, of each: E, C of the elimination; last the inverse for the mass, friction by slip in all
    columns: Any  # [3 n + 2] of difference quotients
    guards: Any  # [2 (n + 1)] of the modes at the start, each with its rate
    unit: Any  # [n] what a deflection is multiplied by in the norm of energy
    size: Any  # [n] of a deflection in steady sliding
    radius: Any  # [n] of its yield surface, 0 for none
    mode: Any  # [n] FOLLOWS, SMOOTH or YIELDS


@inlined
def workspace(law: Any, like: Any) -> Work:
    """Room on the caller's stack, at zero: it lives as long as the caller."""
    return Work(
        start=room(law, 1, 3, like),
        end=room(law, 1, 3, like),
        stage=room(law, 1, 3, like),
        rates=room(law, 1, 3, like),
        slope=room(law, 1, 3, like),
        increments=room(law, 8, 24, like),
        memory=room(law, 1, 0, like),
        moving=room(law, 1, 0, like),
        jacobian=room(law, 6, 2, like),
        factors=room(law, 4, 4, like),
        columns=room(law, 3, 5, like),
        guards=room(law, 2, 2, 0.0),
        unit=room(law, 1, 0, 0.0),
        size=room(law, 1, 0, 0.0),
        radius=room(law, 1, 0, 0.0),
        mode=room(law, 1, 0, 0.0),
    )


@inner
def anchored(law: Any, body: Body, belt_speed: float, side: float, tau: float) -> Flow:
    """The flow with its sine and cosine at this time."""
    angle = body.frequency * tau
    return Flow(law, body, belt_speed, side, tau, math.sin(angle), math.cos(angle))


# --- what a law says of one of its deflections --------------------------------------------------------------------


def _rate_of_a_bristle_on_the_line(law: Any, memory: Any, k: int, w: float) -> float:
    return law.rate(w, memory[0])


def _rate_of_a_bristle_in_the_plane(law: Any, memory: Any, k: int, w: complex) -> complex:
    z = memory[0]
    if law.form == VECTORIAL:
        return law.rate(w, z)
    if law.form == PER_AXIS:
        return complex(law.rate(w.real, z.real), law.rate(w.imag, z.imag))
    return complex(law.rate(abs(w), z.real), 0.0)


_rate_of_a_bristle = by_dimension(_rate_of_a_bristle_on_the_line, _rate_of_a_bristle_in_the_plane)


def _bristle_rate(law: Any, memory: Any, k: int, w: Any) -> Any:
    return _rate_of_a_bristle(law, memory, k, w)


def _memory_rate(law: Any, memory: Any, k: int, w: Any) -> Any:
    return law.rate(w, memory, k)


rate_of = by_law(_bristle_rate, _bristle_rate, None, _memory_rate)
"""rate_of(law, memory, k, w): the rate of the k-th deflection at slip velocity w."""


def _friction_of_a_bristle_on_the_line(law: Any, memory: Any, moving: Any, w: float) -> float:
    return law.friction(w, memory[0], moving[0])


def _friction_of_a_bristle_in_the_plane(law: Any, memory: Any, moving: Any, w: complex) -> complex:
    z, dz = memory[0], moving[0]
    if law.form == VECTORIAL:
        return law.friction(w, z, dz)
    if law.form == PER_AXIS:
        across = law.friction(w.imag, z.imag, dz.imag)
        return complex(law.friction(w.real, z.real, dz.real), across)
    speed = abs(w)
    if speed == 0.0:
        return complex(0.0, 0.0)
    return (law.friction(speed, z.real, dz.real) / speed) * w


_friction_of_a_bristle = by_dimension(_friction_of_a_bristle_on_the_line, _friction_of_a_bristle_in_the_plane)


def _bristle_friction(law: Any, memory: Any, moving: Any, w: Any) -> Any:
    return _friction_of_a_bristle(law, memory, moving, w)


def _memory_friction(law: Any, memory: Any, moving: Any, w: Any) -> Any:
    return law.friction(w, memory, moving)


friction_of = by_law(_bristle_friction, _bristle_friction, None, _memory_friction)
"""friction_of(law, memory, moving, w): the friction coefficient at deflections that move at these rates."""


# --- rates --------------------------------------------------------------------------------------------------------


def _on_circle_on_the_line(radius: float, z: float) -> float:
    return math.copysign(radius, z)


def _on_circle_in_the_plane(radius: float, z: complex) -> complex:
    """Not a rounding error inside it, where the law would let it follow the slip."""
    return (radius * (1.0 + 1e-15) / math.sqrt(z.real * z.real + z.imag * z.imag)) * z


on_circle = by_dimension(_on_circle_on_the_line, _on_circle_in_the_plane)
"""on_circle(radius, z): a deflection put on its yield surface."""


def _yielding_on_the_line(law: Any, memory: Any, k: int, w: float) -> float:
    """What yields on a line stays where it is: no rounding of the law's own rate."""
    return 0.0


def _yielding_in_the_plane(law: Any, memory: Any, k: int, w: complex) -> complex:
    """It turns on its circle, as the law says."""
    return rate_of(law, memory, k, w)


_yielding = by_dimension(_yielding_on_the_line, _yielding_in_the_plane)


@fast
def rate_in_mode(law: Any, work: Work, k: int, w: Any) -> Any:
    """The rate of one of ``work.memory``, which is put on its yield surface first if it yields."""
    if work.mode[k] < 0.0:  # difference quotients at a corner must not see what comes after
        return w
    if work.radius[k] > 0.0 and work.mode[k] > 0.0:
        work.memory[k] = on_circle(work.radius[k], work.memory[k])
        return _yielding(law, work.memory, k, w)
    return rate_of(law, work.memory, k, w)


@fast
def friction_in_mode(law: Any, work: Work, w: Any) -> Any:
    """The friction coefficient of ``work.memory``; leaves the rates of that in ``work.moving``."""
    for k in range(count_of(law)):
        work.moving[k] = rate_in_mode(law, work, k, w)
    return friction_of(law, work.memory, work.moving, w)


@fast
def load_on(body: Body, now: Instant) -> float:
    """The normal load by which friction moves the mass: none where its motion is prescribed."""
    return 0.0 if body.prescribed else normal_load(body, now)


@fast
def rates(flow: Flow, now: Instant, work: Work, like: Any) -> Any:
    """Fill ``work.rates`` at ``work.stage``; returns slip and its rate."""
    body, n = flow.body, count_of(flow.law)
    for k in range(n):
        work.memory[k] = work.stage[MEMORY + k]
    y, u = work.stage[Y], work.stage[U]
    w = deviation_slip(flow, now, u)
    friction = friction_in_mode(flow.law, work, w)
    a = acceleration_under(body, unbalanced_load(body, now), load_on(body, now), y, u, friction)
    work.rates[Y], work.rates[U], work.rates[IMPULSE] = u, a, friction
    for k in range(n):
        work.rates[MEMORY + k] = work.moving[k]
    return w, deviation_slip_rate(flow, now, a)
