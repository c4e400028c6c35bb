"""Sliding that never reverses, under friction that is then the same at every speed: an orbit in closed form.

On a belt at least as fast as any vibration without friction, that vibration, shifted by the constant friction of a
bristle at its limit, is a steady state of any such law. Bristles may near their limit as a power of the way slid
(Dahl's with an exponent above one): no map of a period then has an inverse to close the orbit with, or to judge its
error by, and which starts end there is told by a bound on what is left of their motion.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from frictionlab.compile.decorators import inner
from frictionlab.compile.dispatch import by_dimension, by_law
from frictionlab.methods.periodic.period_map import size_of_deviation, start_of, unpack
from frictionlab.motion.equation import equilibrium, fastest_slip, free_state
from frictionlab.motion.linalg import norm, subtract
from frictionlab.motion.maps.case import Case
from frictionlab.motion.maps.memory_state import measure_scales, unpack_memory
from frictionlab.motion.maps.rates import MEMORY, workspace
from frictionlab.scene.body import BodyNumbers

NEAR = 1e-3
"""Distance to an orbit that attracts, over the size of a state, at which a motion is said to end there."""
GRAZING = 1e-5
"""Share of the vibration's speed by which the belt is faster where coming near is enough: no bound is left there."""


@inner
def state_of_sliding(body: BodyNumbers, friction: float, zero: Any) -> Any:
    """Position and velocity at tau = 0 of the friction-free orbit, shifted by a constant friction; no deflection."""
    shift = equilibrium(body, body.normal_load * friction, 0.0)
    x, v = free_state(body)
    return x + shift + 0.0 * zero, v, 0.0 * zero


memory_of_sliding = by_law(
    lambda law, belt_speed: 0.0,
    lambda law, belt_speed: math.copysign(1.0, belt_speed) * law.largest_deflection(),
    lambda law, belt_speed: belt_speed,
)
"""memory_of_sliding(law, belt_speed): what ``start_of`` is given, with the other sign, for a mass that slides on."""


@inner
def write_sliding(case: Case, state: Any) -> float:
    """State at tau = 0 of a mass that slides as if slip never reversed, under friction at the belt's speed.

    Returns the coefficient of that, with the sign of the belt.
    """
    law, body, belt_speed, zero = case
    friction = math.copysign(1.0, belt_speed) * law.sliding_friction(abs(belt_speed))
    x, v, z = state_of_sliding(body, friction, zero)
    start_of(law, body, state, x, v, z - memory_of_sliding(law, belt_speed))
    return friction


@inner
def _impulse_response(body: BodyNumbers) -> float:
    """Return the integral of the size of the position's response to an impulse."""
    stiffness, half = (
        body.stiffness_mean + body.stiffness_split,
        0.5 * (body.damping_mean + body.damping_split),
    )
    square = stiffness - half * half
    return 1.0 / (
        stiffness * math.tanh(0.5 * math.pi * half / math.sqrt(square)) if square > 0.0 else stiffness
    )


def _creep_on_the_line(case: Case, state: Any, zero: float) -> float:
    law, body, belt_speed, _like = case
    stiffness = body.stiffness_mean + body.stiffness_split
    y, u = unpack(body, state, zero)
    work = workspace(law, zero, body.varying.keeps_stiffness)
    measure_scales(law, body, work, zero)
    unpack_memory(law, body, work, state, zero)
    z, nudge, fastest = work.start[MEMORY], 1e-3 * law.largest_deflection(), -2.0 * belt_speed
    rate = law.rate(fastest, z)
    friction = law.friction(fastest, z, 0.0)
    if law.friction(fastest, z, rate) != friction:
        return math.inf
    # a deflection that lacks less of its limit grows more slowly
    slope = abs(law.friction(fastest, z + nudge, rate) - law.friction(fastest, z - nudge, rate)) / (
        2.0 * nudge
    )
    x, v = free_state(body)  # what is left is that beside the motion without friction
    y, u = y + (body.reference_cosine - x), u + (body.frequency * body.reference_sine - v)
    left = math.hypot(math.sqrt(stiffness) * (y + body.normal_load * friction / stiffness), u)
    return left + _impulse_response(body) * body.normal_load * slope * abs(rate)


_creep = by_dimension(_creep_on_the_line, lambda case, state, zero: math.inf)
"""A bound on the speed of the deviation from the vibration, from now on; none for bristles that are damped."""


def _ends_without_bristle(case: Case, state: Any) -> bool:
    return False


def _ends_with_a_bristle(case: Case, state: Any) -> bool:
    """Check whether a motion on so fast a belt surely slides on in one direction: it is then written as that orbit.

    Friction that only grows to its limit, no faster than at the fastest slip, moves the mass at its quasi-static
    place; off it, energy falls. While both together leave the mass slower than the belt no slip reverses.
    """
    _law, body, belt_speed, zero = case
    target = np.empty(state.size)
    write_sliding(case, target)
    subtract(target, state, target)
    distance = norm(target)
    write_sliding(case, target)
    margin = abs(belt_speed) - fastest_slip(body)
    ends = margin <= GRAZING * fastest_slip(body) and distance < NEAR * size_of_deviation(
        body.normal_load, target
    )
    ends = ends or _creep(case, state, zero) < margin
    for row in range(state.size if ends else 0):
        state[row] = target[row]
    return ends


ends_sliding = by_law(_ends_without_bristle, _ends_with_a_bristle, _ends_without_bristle)
"""ends_sliding(case, state): for bristles on a belt where slip need not reverse."""
