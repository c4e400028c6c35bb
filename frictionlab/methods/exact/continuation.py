"""Steady states of a mass under Coulomb friction along a curve in belt speed, by continuation."""

from __future__ import annotations

import math
from typing import Any

from frictionlab.compile.decorators import inner, njit
from frictionlab.compile.dispatch import by_variation
from frictionlab.methods.exact.oscillator import ForcedOscillator, canonical, count_pieces, free_rate
from frictionlab.methods.exact.return_map import (
    LEGS_IN_ALL,
    Fixed,
    friction_free_start,
    impulse_error,
    largest_multiplier,
    passage,
    periodic_state,
    rounding,
)
from frictionlab.quantities import EPSILON
from frictionlab.scene.body import Mass

MEAN, ERROR, FLOQUET, STATE_X, STATE_W, LEGS, RESIDUAL, ROUNDING, FOUND, COLUMNS = range(10)
MOST_MAPS = 2000
MOST_PERIODS = 100_000


@njit
def continue_in_speed(mass: Mass, coefficient: float, belt_speeds: Any, out: Any) -> None:
    """Row i of ``out``: MEAN to FOUND for belt_speeds[i], ascending; FOUND: 1 without slip reversal, else 2.

    One sine: for belt speeds >= 0. Else mass.varying is a ``Forcing``.
    """
    x, w, last = 0.0, 0.0, math.inf
    for i in range(belt_speeds.size):
        body = oscillator_at(mass, coefficient, belt_speeds[i])
        # Above V_lin slip never reverses and the motion is linear: no search. Without damping a free oscillation
        # would remain.
        if exceeds_friction_free_speed(mass, belt_speeds[i]) and body.damping > 0.0:
            x, w = friction_free_start(body)
            write_reversal_free(body, coefficient, x, w, out[i])
        else:
            # Start from the neighbour's state with the same velocity: w = x' - belt_speed.
            x, w = friction_free_start(body) if last == math.inf else (x, w + (last - belt_speeds[i]))
            fixed = periodic_state(body, x, w, MOST_MAPS)
            x, w = fixed.x, fixed.w
            if slips_one_way(body, fixed):
                write_reversal_free(body, coefficient, x, w, out[i])
            else:
                write_fixed(body, fixed, mass.normal_load, out[i])
        last = belt_speeds[i]


def _body_of_one_sine(mass: Mass, coefficient: float, belt_speed: float) -> Any:
    friction = coefficient * mass.normal_load
    return canonical(0.5 * mass.damping, mass.frequency, abs(mass.force), friction, belt_speed)


def _body_of_pieces(mass: Mass, coefficient: float, belt_speed: float) -> Any:
    forcing, damping = mass.varying, 0.5 * mass.damping
    rate = free_rate(damping)
    numbers = damping, rate, forcing.period, coefficient * mass.normal_load, belt_speed
    return ForcedOscillator(*numbers, forcing.size, forcing.load, forcing.jolt, 0, forcing)


oscillator_at = by_variation(_body_of_one_sine, _body_of_pieces)
"""(mass, coefficient, belt_speed): the canonical scene at this belt speed."""


exceeds_friction_free_speed = by_variation(
    lambda mass, belt_speed: belt_speed >= friction_free_speed(mass), lambda mass, belt_speed: False
)
"""(mass, belt_speed): whether the belt is known to be so fast that slip never reverses."""


slips_one_way = by_variation(
    lambda body, fixed: False,
    lambda body, fixed: fixed.map.alike != 0.0 and fixed.residual <= 16.0 * rounding(body, fixed.x, fixed.w),
)
"""(body, fixed): whether this fixed point turns out to have slip of one sign, which no step can have passed."""


@inner
def friction_free_speed(mass: Mass) -> float:
    """V_lin, the velocity amplitude without friction; infinite at undamped resonance."""
    stiffness = (1.0 - mass.frequency) * (1.0 + mass.frequency)
    return abs(mass.force) * mass.frequency / math.hypot(stiffness, mass.damping * mass.frequency)


@inner
def write_reversal_free(body: Any, coefficient: float, x: float, w: float, row: Any) -> None:
    """The results where slip never reverses: friction is constant, the motion linear."""
    rate = body.damping if body.damping <= 1.0 else 1.0 / (body.damping + body.rate)
    row[MEAN], row[ERROR] = math.copysign(coefficient, body.belt_speed), 8.0 * EPSILON * coefficient
    row[FLOQUET] = math.exp(-rate * body.period)
    row[STATE_X], row[STATE_W], row[LEGS] = x, w, 1.0 + count_pieces(body)
    row[RESIDUAL], row[ROUNDING], row[FOUND] = 0.0, rounding(body, x, w), 1.0


@inner
def write_fixed(body: Any, fixed: Fixed, normal_load: float, row: Any) -> None:
    """The results at a fixed point of the return map."""
    unit = normal_load * body.period
    row[MEAN], row[ERROR] = -fixed.map.friction / unit, impulse_error(body, fixed) / unit
    row[FLOQUET] = largest_multiplier(fixed.map)
    row[STATE_X], row[STATE_W], row[LEGS] = fixed.x, fixed.w, fixed.map.legs
    row[RESIDUAL], row[ROUNDING], row[FOUND] = fixed.residual, rounding(body, fixed.x, fixed.w), 2.0


@njit
def iterate_until_fixed(mass: Mass, coefficient: float, belt_speed: float, start: Any, row: Any) -> int:
    """Iterate the map from start = (x, w, canonical time) until a period changes nothing; -1 where it never does.

    Writes MEAN to ROUNDING (ERROR: rounding alone) and returns the number of periods.
    """
    body = oscillator_at(mass, coefficient, belt_speed)
    first = passage(body, start[0], start[1], start[2], body.period)
    x, w, work = first.x, first.w, 0
    for periods in range(MOST_PERIODS):
        here = passage(body, x, w, 0.0, body.period)
        residual = math.hypot(here.x - x, here.w - w)
        if residual <= rounding(body, x, w):
            write_fixed(body, Fixed(x, w, here, residual, periods), mass.normal_load, row)
            return periods
        x, w, work = here.x, here.w, work + here.legs
        if work > LEGS_IN_ALL:
            break
    return -1
