"""Steady states of a mass under Coulomb friction along a curve in belt speed, by continuation.

One period of Coulomb orbits as smooth panels.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from frictionlab.compile.decorators import inner, njit
from frictionlab.methods.exact.forcing import FASTEST, SHORTEST, Forcing
from frictionlab.methods.exact.legs import (
    STICK,
    cross_corner,
    free_motion,
    slip_leg,
    starting_mode,
    stick_leg,
)
from frictionlab.methods.exact.oscillator import (
    at_piece,
    next_corner,
    oscillator_at,
    response_at,
    vibration_at,
)
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
from frictionlab.motion.orbit.recorder import NODES, Track, grown, track_of
from frictionlab.values.quantities import EPSILON

MEAN, ERROR, FLOQUET, STATE_X, STATE_W, LEGS, RESIDUAL, ROUNDING, FOUND, COLUMNS = range(10)
MOST_MAPS = 2000
MOST_PERIODS = 100_000


@njit
def continue_in_speed(forcing: Forcing, belt_speeds: Any, out: Any) -> None:
    """Row i of ``out``: MEAN to FOUND for belt_speeds[i], ascending; FOUND: 1 without slip reversal, else 2."""
    x, w, last = 0.0, 0.0, math.inf
    for i in range(belt_speeds.size):
        body = oscillator_at(forcing, belt_speeds[i])
        # Above V_lin slip never reverses and the motion is linear: no search. Without damping a free oscillation
        # would remain.
        if abs(belt_speeds[i]) >= forcing.table[FASTEST] and body.damping > 0.0:
            x, w = friction_free_start(body)
            write_reversal_free(body, forcing.coefficient, x, w, out[i])
        else:
            # Start from the neighbour's state with the same velocity: w = x' - belt_speed.
            x, w = friction_free_start(body) if last == math.inf else (x, w + (last - belt_speeds[i]))
            fixed = periodic_state(body, x, w, MOST_MAPS)
            x, w = fixed.x, fixed.w
            # No step can have passed a reversal.
            if fixed.map.alike != 0.0 and fixed.residual <= 16.0 * rounding(body, x, w):
                write_reversal_free(body, forcing.coefficient, x, w, out[i])
            else:
                write_fixed(body, fixed, forcing.normal_load, out[i])
        last = belt_speeds[i]


@inner
def write_reversal_free(body: Any, coefficient: float, x: float, w: float, row: Any) -> None:
    """Write the results where slip never reverses: friction is constant, the motion linear."""
    rate = body.damping if body.damping <= 1.0 else 1.0 / (body.damping + body.rate)
    row[MEAN], row[ERROR] = math.copysign(coefficient, body.belt_speed), 8.0 * EPSILON * coefficient
    row[FLOQUET] = math.exp(-rate * body.period)
    row[STATE_X], row[STATE_W], row[LEGS] = x, w, 1.0 + body.varying.segments
    row[RESIDUAL], row[ROUNDING], row[FOUND] = 0.0, rounding(body, x, w), 1.0


@inner
def write_fixed(body: Any, fixed: Fixed, normal_load: float, row: Any) -> None:
    """Write the results at a fixed point of the return map."""
    unit = normal_load * body.period
    row[MEAN], row[ERROR] = -fixed.map.friction / unit, impulse_error(body, fixed) / unit
    row[FLOQUET] = largest_multiplier(fixed.map)
    row[STATE_X], row[STATE_W], row[LEGS] = fixed.x, fixed.w, fixed.map.legs
    row[RESIDUAL], row[ROUNDING], row[FOUND] = fixed.residual, rounding(body, fixed.x, fixed.w), 2.0


@njit
def iterate_until_fixed(forcing: Forcing, belt_speed: float, start: Any, row: Any) -> int:
    """Iterate the map from start = (x, w, canonical time) until a period changes nothing; -1 where it never does.

    Writes MEAN to ROUNDING (ERROR: rounding alone) and returns the number of periods.
    """
    body = oscillator_at(forcing, belt_speed)
    first = passage(body, start[0], start[1], start[2], body.period)
    x, w, work = first.x, first.w, 0
    for periods in range(MOST_PERIODS):
        here = passage(body, x, w, 0.0, body.period)
        residual = math.hypot(here.x - x, here.w - w)
        if residual <= rounding(body, x, w):
            write_fixed(body, Fixed(x, w, here, residual, periods), forcing.normal_load, row)
            return periods
        x, w, work = here.x, here.w, work + here.legs
        if work > LEGS_IN_ALL:
            break
    return -1


TAU, DURATION, X, W, MODE, PIECE, FACTS = 0, 1, 2, 3, 4, 5, 6


class LegTable(NamedTuple):
    """Legs of a period [rows, FACTS].

    rows: their count. before: the count of those that end before the orbit starts.
    """

    legs: Any
    rows: int
    before: int


@inner
def tabulate_legs(body: Any, state: Any, start: float, end: float, legs: Any, first: int) -> Any:
    """Write every leg from ``start`` to ``end`` to rows from ``first`` on; return the end state and the row after."""
    x, w = state
    tau, mode, row = start, starting_mode(body, start, x, w), first
    # The same legs as in the return map, so that orbit and fixed point agree to rounding.
    while tau < end and row < legs.shape[0]:
        stop = next_corner(body, end)
        left = stop - tau
        leg = stick_leg(body, tau, x, left) if mode == STICK else slip_leg(body, tau, x, w, mode, left)
        legs[row, TAU], legs[row, DURATION] = tau, leg.duration
        legs[row, X], legs[row, W], legs[row, MODE], legs[row, PIECE] = x, w, mode, body.piece
        row = row + 1
        tau = tau + leg.duration if leg.event != 0.0 else stop
        x, w, mode = leg.x, leg.w, leg.following
        if tau >= stop:
            body, w, mode, _ = cross_corner(body, x, w, mode)
    return (x, w), row


@inner
def panel_length(body: Any, r: float, left: float) -> float:
    """Return the length of the next panel, r into a leg.

    It is short against drive and free motion, and graded where a part decays.
    """
    # Overdamped motion has a fast and a slow exponential: panels start at 1/fast and grow in proportion to r. Once
    # the free motion has decayed (r * slow > 40) only the drive limits them.
    fast, slow = 1.0, body.damping
    if body.damping > 1.0:
        fast = body.damping + body.rate
        slow = 1.0 / fast
    free = 0.25 * math.pi if r * slow < 40.0 else body.period
    return min(min(0.125 * body.varying.table[SHORTEST], free), min(max(1.0 / fast, 0.5 * r), left))


@inner
def count_panels(body: Any, legs: Any, rows: int) -> int:
    """Count the panels of the legs; a leg of no duration has none."""
    panels = 0
    for row in range(rows):
        r = 0.0
        while r < legs[row, DURATION]:
            r = r + panel_length(body, r, legs[row, DURATION] - r)
            panels = panels + 1
    return panels


@inner
def free_start(body: Any, leg: Any) -> tuple[float, float]:
    """Return the state at the start of a leg of slip, less that of the response to load and friction."""
    _, _, u, speed, _ = response_at(body, leg[TAU], leg[MODE])
    return leg[X] - u + body.friction * leg[MODE], leg[W] + (body.belt_speed - speed)


@inner
def sample_leg(body: Any, leg: Any, start: Any, r: float) -> tuple[float, float, float]:
    """Return displacement, velocity and friction force a time r into a leg with this free start."""
    load, _, u, speed, limit = response_at(body, leg[TAU] + r, leg[MODE])
    path, vibration = vibration_at(body, leg[TAU] + r)
    if leg[MODE] == STICK:
        x = leg[X] + body.belt_speed * r
        force = load - 2.0 * body.damping * body.belt_speed - x
        return x + path, body.belt_speed + vibration, force
    y, z = start
    keep, turn, damp = free_motion(body, r)
    x = keep * y + turn * z + (u - body.friction * leg[MODE])
    return x + path, damp * z - turn * y + speed + vibration, limit * leg[MODE]


@inner
def legs_of_orbit(body: Any, x: float, w: float, shift: float, legs: int) -> LegTable:
    """Return a period from canonical time 0 as legs; the orbit starts at ``shift``."""
    # The state is known at canonical time 0, the orbit starts at ``shift``: the legs before it follow those after it.
    table = np.empty((2 * legs + 8, FACTS))
    state, before = tabulate_legs(body, (x, w), 0.0, shift, table, 0)
    state, rows = tabulate_legs(body, state, shift, body.period, table, before)
    return LegTable(table, rows, before)


@inner
def note_orbit(body: Any, table: LegTable, normal_load: float, side: float, track: Track) -> None:
    """Write the panels of one period, from the end of the first ``before`` legs on, to a track with room for them.

    side: -1.0 turns it round, for a belt that moves the other way.
    """
    panel, now = track.filled[0], 0.0
    for place in range(table.rows):
        leg, r = table.legs[(place + table.before) % table.rows], 0.0
        body = at_piece(body, int(leg[PIECE]), body.belt_speed)
        start = free_start(body, leg)
        while r < leg[DURATION]:
            length = panel_length(body, r, leg[DURATION] - r)
            for node in range(NODES.size):
                part = 0.5 * (1.0 + NODES[node]) * length
                a, b, force = sample_leg(body, leg, start, r + part)
                track.tau[panel, node] = now + part
                track.x[panel, node], track.v[panel, node] = complex(side * a, 0.0), complex(side * b, 0.0)
                track.friction[panel, node] = complex(side * force / normal_load, 0.0)
            track.stick[panel] = leg[MODE] == STICK
            r, now, panel = r + length, now + length, panel + 1
    track.filled[0] = panel


@njit
def make_orbits(forcing: Forcing, belt_speeds: Any, states: Any, ends: Any) -> Track:
    """Return the panels of all orbits, one orbit after another; that of belt speed i ends before panel ends[i].

    states [n, 5]: canonical (x, w), the legs of a period, 0 where there is no orbit, canonical time of tau = 0, and
    -1 where the mirror image of the scene was solved, else 1.
    """
    room, track = 64, track_of(64)
    for i in range(belt_speeds.size):
        x, w, legs, shift, side = states[i, 0], states[i, 1], int(states[i, 2]), states[i, 3], states[i, 4]
        if legs > 0:
            body = oscillator_at(forcing, side * belt_speeds[i])
            table = legs_of_orbit(body, x, w, shift, legs)
            needed = track.filled[0] + count_panels(body, table.legs, table.rows)
            if needed > room:
                room = 2 * needed
                track = grown(track, room)
            note_orbit(body, table, forcing.normal_load, side, track)
        ends[i] = track.filled[0]
    return track
