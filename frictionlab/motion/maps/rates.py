"""Equation of motion of a mass and of the memory of its contact: deflections or scalars, one or several.

On the line every quantity is a float, in the plane a complex number; a scalar is real in both. The mass moves
by its deviation y from the harmonic reference and by u = y'. The impulse of friction is integrated with them.
With scalars the slip w itself takes the place of u: such a contact may creep at 1e-26 of the belt speed where
others stick, and a difference of two velocities would lose that. A deflection moves by its law's own rate,
except for two kinds that have corners: a deflection that follows the slip and one that yields are held so to
the end of a step.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from frictionlab.compile.decorators import fast, fast_embedded, inlined
from frictionlab.compile.dispatch import by_dimension, by_law, by_scalars
from frictionlab.compile.stack import count_of, room
from frictionlab.motion.contact import friction_of, rate_of
from frictionlab.motion.equation import (
    Flow,
    Instant,
    acceleration_under,
    belt_velocity,
    deviation_slip,
    deviation_slip_rate,
    instant_near,
    load_share,
    normal_load,
    normal_load_bend,
    normal_load_rate,
    reference_velocity,
    slopes_at,
    unbalanced_load,
)
from frictionlab.scene.body import BodyNumbers

Y, U, IMPULSE, MEMORY = 0, 1, 2, 3
"""Places of the mass in a state: its deviation; the velocity of that, with scalars the slip; the integral of
friction in shares of the mean normal load. The memory comes next."""

FOLLOWS, SMOOTH, YIELDS = -1.0, 0.0, 1.0
"""Modes of a deflection: it follows the slip; it moves by its law's rate; it is on its yield surface, or
gives way before it."""


class Work(NamedTuple):
    """Arrays for one step of a state.

    A state is the mass (Y, U, IMPULSE), and from MEMORY on the n numbers of the memory.
    """

    start: Any  # where the step starts
    end: Any  # where it ends
    stage: Any  # argument of the rates
    rates: Any
    slope: Any  # derivative of the rates by time
    increments: Any  # of every stage
    bends: Any  # of the step between its ends
    memory: Any  # [n] as the law sees it
    moving: Any  # [n] its rates
    jacobian: (
        Any  # blocks, of each number: its rate by slip, by itself, friction by it; last friction by slip
    )
    factors: Any  # blocks, of each: E, C of the elimination; last the inverse for the mass, friction by slip in all
    columns: Any  # [3 n + 2] of difference quotients
    guards: Any  # [2 (n + 1)] of the modes at the start, each with its rate
    unit: Any  # [n] what a number is multiplied by in the norm of energy
    size: Any  # [n] of a number in steady sliding
    positive: Any  # [n] 1 for a scalar that is never negative, else 0
    radius: Any  # [n] of its yield surface, 0 for none
    unloads: Any  # [n] 1 for a deflection without one that follows the slip wherever that makes it smaller
    mode: Any  # [n] FOLLOWS, SMOOTH or YIELDS
    creep: Any  # [2] the scale of the slip that creeps, where a step takes its logarithm, and how slow a slip does
    keeps_stiffness: Any  # filled where the contact keeps its stiffness while the normal load changes
    share: Any  # [3] there: the normal load over its mean, and its first and second derivative; else 1, 0, 0


kind_of_memory = by_scalars(lambda law, zero: zero, lambda law, zero: 0.0)
"""kind_of_memory(law, zero): zero of the type of the memory; zero: one of the type of a slip."""

as_memory = by_scalars(lambda law, value: value, lambda law, value: value.real)
"""as_memory(law, value): number of a state in the type that the law takes."""


@inlined
def workspace(law: Any, zero: Any, keeps_stiffness: Any) -> Work:
    """Return zeroed arrays on the caller's stack, which live as long as the caller.

    keeps_stiffness: as in ``Work``.
    """
    return Work(
        start=room(law, 1, 3, zero),
        end=room(law, 1, 3, zero),
        stage=room(law, 1, 3, zero),
        rates=room(law, 1, 3, zero),
        slope=room(law, 1, 3, zero),
        increments=room(law, 8, 24, zero),
        bends=room(law, 3, 9, zero),
        memory=room(law, 1, 0, kind_of_memory(law, zero)),
        moving=room(law, 1, 0, kind_of_memory(law, zero)),
        jacobian=room(law, 6, 2, zero),
        factors=room(law, 4, 4, zero),
        columns=room(law, 3, 5, zero),
        guards=room(law, 2, 2, 0.0),
        unit=room(law, 1, 0, 0.0),
        size=room(law, 1, 0, 0.0),
        positive=room(law, 1, 0, 0.0),
        radius=room(law, 1, 0, 0.0),
        unloads=room(law, 1, 0, 0.0),
        mode=room(law, 1, 0, 0.0),
        creep=room(law, 0, 2, 0.0),
        keeps_stiffness=keeps_stiffness,
        share=room(law, 0, 3, 0.0),
    )


# --- the velocity that a state holds --------------------------------------------------------------------------------

slip_held = by_scalars(lambda flow, now, u: deviation_slip(flow, now, u), lambda flow, now, w: w)
"""slip_held(flow, now, u): slip, from the velocity in a state."""


def _deviation_of_slip(flow: Flow, now: Instant, w: Any) -> Any:
    return w - deviation_slip(flow, now, 0.0 * w)


deviation_held = by_scalars(lambda flow, now, u: u, _deviation_of_slip)
"""deviation_held(flow, now, u): velocity of the deviation, from the velocity in a state."""

held_velocity = by_scalars(lambda flow, now, u: u, lambda flow, now, u: deviation_slip(flow, now, u))
"""held_velocity(flow, now, u): velocity in a state, from that of the deviation."""

velocity_held = by_scalars(
    lambda flow, now, u: u + reference_velocity(flow.body, now.sine, now.cosine),
    lambda flow, now, w: w + belt_velocity(flow.body, flow.belt_speed, now),
)
"""velocity_held(flow, now, u): velocity of the mass, from the velocity in a state."""

rate_held = by_scalars(lambda flow, now, a: a, lambda flow, now, a: deviation_slip_rate(flow, now, a))
"""rate_held(flow, now, a): rate of the velocity in a state, from the deviation's acceleration."""


@fast
def rows_of(flow: Flow) -> int:
    """Return the number of numbers in a state."""
    return MEMORY + count_of(flow.law)


@fast
def springs_at(flow: Flow, work: Work) -> Any:
    """Return the linear springs and dashpots of the body beside ``work.start``."""
    now = instant_near(flow, flow.anchor)
    return slopes_at(flow.body, work.start[Y], deviation_held(flow, now, work.start[U]))


# --- stick, modes and yield -----------------------------------------------------------------------------------------


def _never(law: Any) -> bool:
    return False


remembers_stick = by_law(_never, _never, lambda law: law.remembers_stick(), _never)
"""remembers_stick(law): whether the modes of its deflections, to follow the slip or to give way, are a
memory."""


# --- a contact that keeps its stiffness ---------------------------------------------------------------------------
#
# Under n times the mean normal load a bristle of that stiffness is to its law one deflected by z/n: this is what a
# state remembers, and what moves at z'/n - (n'/n) (z/n). The law is asked for z' and gives it n times too large.


@fast
def note_share(work: Work, body: BodyNumbers, now: Instant) -> None:
    """Keep the normal load of this instant, if the contact depends on it."""
    mean = body.normal_load
    if len(work.keeps_stiffness) > 0:
        work.share[0] = load_share(body, now)
        work.share[1], work.share[2] = normal_load_rate(body, now) / mean, normal_load_bend(body, now) / mean


@fast_embedded
def _per_share(work: Work, rate: Any) -> Any:
    """Return z'/n, from the rate of the law."""
    return rate / work.share[0] if len(work.keeps_stiffness) > 0 else rate


@fast_embedded
def stretching(work: Work, z: Any) -> Any:
    """Return z'/n of a deflection whose z/n is constant."""
    return (work.share[1] / work.share[0]) * z if len(work.keeps_stiffness) > 0 else 0.0 * z


@fast
def slip_to_yield(work: Work, k: int, w: Any) -> Any:
    """Return slip against the yield surface of a deflection, which moves with a growing load."""
    return w - work.share[1] * work.memory[k]


@fast
def slip_rate_to_yield(work: Work, k: int, a: Any) -> Any:
    """Return the rate of that slip."""
    moves = work.moving[k] - stretching(work, work.memory[k])
    return a - work.share[1] * moves - work.share[2] * work.memory[k]


# --- rates --------------------------------------------------------------------------------------------------------

on_circle = by_dimension(
    lambda radius, z: math.copysign(radius, z),
    # not a rounding error inside it, where the law would let it follow the slip
    lambda radius, z: (radius * (1.0 + 1e-15) / math.sqrt(z.real * z.real + z.imag * z.imag)) * z,
)
"""on_circle(radius, z): deflection put on its yield surface."""

_yielding = by_dimension(
    # what yields on a line stays where it is: no rounding of the law's own rate
    lambda law, memory, k, w: 0.0,
    # it turns on its circle, as the law says
    lambda law, memory, k, w: rate_of(law, memory, k, w),
)


@fast
def _deflection_rate(law: Any, work: Work, k: int, w: Any) -> Any:
    if work.mode[k] < 0.0:  # difference quotients at a corner must not see what comes after
        return _per_share(work, w)
    if work.radius[k] > 0.0 and work.mode[k] > 0.0:
        work.memory[k] = on_circle(work.radius[k], work.memory[k])
        turns = _per_share(work, _yielding(law, work.memory, k, w))
        return turns + stretching(work, work.memory[k])
    return _per_share(work, rate_of(law, work.memory, k, w))


rate_in_mode = by_scalars(
    lambda law, work, k, w: _deflection_rate(law, work, k, w),
    lambda law, work, k, w: law.rate(w, work.memory, k),
)
"""rate_in_mode(law, work, k, w): rate of the k-th number of ``work.memory``; a yielding one is put on its
yield surface first."""


@fast
def friction_in_mode(law: Any, work: Work, w: Any) -> Any:
    """Return the friction coefficient of ``work.memory``, and leave its rates in ``work.moving``."""
    for k in range(count_of(law)):
        work.moving[k] = rate_in_mode(law, work, k, w)
    return friction_of(law, work.memory, work.moving, w)


@fast
def load_on(body: BodyNumbers, now: Instant) -> float:
    """Return the normal load by which friction moves the mass: none if its motion is prescribed."""
    return 0.0 if body.prescribed else normal_load(body, now)


@fast
def fill_rates(flow: Flow, now: Instant, work: Work, zero: Any) -> Any:
    """Fill ``work.rates`` at ``work.stage``, and return slip and its rate."""
    body, n = flow.body, count_of(flow.law)
    note_share(work, body, now)
    for k in range(n):
        work.memory[k] = as_memory(flow.law, work.stage[MEMORY + k])
    y, held = work.stage[Y], work.stage[U]
    w, u = slip_held(flow, now, held), deviation_held(flow, now, held)
    # friction first: it may depend on the rates of what is remembered
    friction = friction_in_mode(flow.law, work, w)
    a = acceleration_under(body, unbalanced_load(body, now), load_on(body, now), y, u, friction)
    work.rates[Y], work.rates[U] = u, rate_held(flow, now, a)
    work.rates[IMPULSE] = load_share(body, now) * friction
    for k in range(n):
        work.rates[MEMORY + k] = work.moving[k] - stretching(work, work.memory[k]) + 0.0 * zero
    return w, a
