"""Period map of a sliding law in the plane by implicit steps in polar slip, with its exact derivative.

The map takes some ten steps where slip starts from rest. Explicit steps must follow friction that turns slip
towards the force at the rate f/r: up to millions of them. The derivative is that of the steps themselves.
Slip starts and ends at rest with the velocity of the belt, so that no event adds to the derivative; at rest
the columns of slip vanish.
"""

from __future__ import annotations

import cmath
import math
from typing import Any, NamedTuple

import numpy as np

from frictionlab.compile.decorators import inner
from frictionlab.motion.equation import (
    Flow,
    belt_path,
    belt_path_integral,
    belt_velocity,
    holding_force,
    instant_at,
    normal_load,
    restoring_force,
    span,
    swing_of,
)
from frictionlab.motion.maps.case import Case
from frictionlab.motion.maps.polar_step import (
    DIRECTIONS,
    SlipPlace,
    StepRoom,
    Tangent,
    begin_step,
    end_step,
    guess_afresh,
    guess_on,
    solve_step,
    step_error,
    step_room,
)
from frictionlab.motion.maps.sliding import Hop, note_hop, note_stick
from frictionlab.motion.maps.stick import end_of_rest
from frictionlab.motion.orbit.recorder import Track, panel_writer
from frictionlab.scene.body import BodyNumbers

MOST_CORRECTIONS_A_MAP = 8_000
"""Largest number of Newton corrections in the steps of one map; a thousand take about a hundredth of a
second."""
FIRST_ACCURACY = 1e-5
"""Accuracy of the first maps: of slip in a step, relative to the effect of friction on it in the shortest
time."""
SHORTEST_SLIP = 1e-13
"""Share of the span below which a failing step of slip is left out."""
MOST_LEFT_OUT = 20
REST_TAKES = 20.0
"""Time that a rest may take, in corrections."""


POSITION, MIDWAY = 0, 1
RESTED, LONGEST, MIDDLE, LEFT_OUT = 0, 1, 2, 3


class Workspace(NamedTuple):
    """Arrays for a map: those of its steps, the tangent, and sums on the way.

    totals [2]: POSITION, its integral, and MIDWAY, the position half way through the longest rest. times [4]:
    sum of all rests (RESTED), the LONGEST rest and its MIDDLE; number of times that slip was LEFT_OUT.
    """

    step: StepRoom
    tangent: Tangent
    totals: Any
    times: Any


class Progress(NamedTuple):
    """Progress of a map: place, whether at rest, whether slip has just begun, the next step.

    before: > 0 length of the previous step, < 0 length of an inaccurate step tried from here, 0 for neither.
    """

    place: SlipPlace
    resting: bool
    leaving: bool
    h: float
    before: float


class Image(NamedTuple):
    """Position and slip after a map, and the number of corrections in its steps; -1: gave up."""

    x: complex
    w: complex
    work: int


@inner
def room_for_maps() -> Workspace:
    """Return arrays for maps, one after another."""
    kind = np.zeros(DIRECTIONS, np.complex128)
    tangent = Tangent(np.zeros(DIRECTIONS), np.zeros(DIRECTIONS), kind, kind.copy())
    return Workspace(step_room(), tangent, np.zeros(2, np.complex128), np.zeros(4))


@inner
def root_along(body: BodyNumbers) -> float:
    """Return the root of the stiffness along the belt, which turns position into root of energy."""
    return math.sqrt(body.stiffness_mean + body.stiffness_split)


@inner
def root_across(body: BodyNumbers) -> float:
    """Return the root of the stiffness across the belt."""
    return math.sqrt(body.stiffness_mean - body.stiffness_split)


@inner
def quickest(body: BodyNumbers) -> float:
    """Return the largest rate of loads and body."""
    return max(body.frequency, math.sqrt(body.stiffness_mean + abs(body.stiffness_split)))


@inner
def _set_out(case: Case, tau: float, x: complex, w: complex, room: Workspace) -> Progress:
    """Begin a map, with the tangent at the identity in the norm of energy."""
    tangent, r, body = room.tangent, abs(w), case.body
    resting = r <= 1e-14 * (swing_of(body) + abs(case.belt_speed))
    unit = w.conjugate() / r if not resting else 0j
    # 0 and 2 move the position along and across, 1 and 3 the slip w = r exp(i theta), each by one in energy
    for k in range(DIRECTIONS):
        tangent.x[k], tangent.total[k], tangent.r[k], tangent.theta[k] = 0j, 0j, 0.0, 0.0
    tangent.x[0], tangent.x[2] = 1.0 / root_along(body) + 0j, 1j / root_across(body)
    # dr + i r dtheta = dw exp(-i theta); a mass at rest has no direction of slip to move
    if not resting:
        tangent.r[1], tangent.theta[1] = unit.real, unit.imag / r
        tangent.r[3], tangent.theta[3] = -unit.imag, unit.real / r
    room.totals[POSITION], room.totals[MIDWAY] = 0j, 0j
    for k in range(4):
        room.times[k] = 0.0
    place = SlipPlace(tau, x, 0.0, 0.0) if resting else SlipPlace(tau, x, r, cmath.phase(w))
    return Progress(place, resting, False, 0.1 / quickest(body), 0.0)


@inner
def _flow(case: Case) -> Flow:
    """Return the case as records of rest take it, which know no anchor."""
    return Flow(case.law, case.body, case.belt_speed, 1.0, 0.0, 0.0, 1.0)


# --- rest -----------------------------------------------------------------------------------------------------------


@inner
def _rest(case: Case, at: Progress, end: float, room: Workspace, track: Track) -> Progress:
    """Rest until slip begins or the map ends."""
    body, belt_speed, place, tangent = case.body, case.belt_speed, at.place, room.tangent
    tau, until = place.tau, end_of_rest(case, place.tau, place.x, end)
    lasts = until - tau
    if track.stick.size > 0 and lasts > 0.0:
        note_stick(track, _flow(case), tau, lasts, place.x)
    room.times[RESTED] += lasts
    if lasts > room.times[LONGEST]:
        room.times[LONGEST], room.times[MIDDLE] = lasts, tau + 0.5 * lasts
        room.totals[MIDWAY] = place.x + belt_path(body, belt_speed, tau, tau + 0.5 * lasts)
    room.totals[POSITION] += lasts * place.x + belt_path_integral(body, belt_speed, tau, until)
    x = place.x + belt_path(body, belt_speed, tau, until)
    held, _rate, _bend = holding_force(body, belt_speed, instant_at(body, until), x)
    # The belt carries a shifted mass as far as this one. Slip starts along the holding force, which the shift turns
    # by Im(dF conj(F))/|F|^2. A change of the starting time has no effect of first order: slip begins from zero.
    for k in range(DIRECTIONS):
        shift = tangent.x[k]
        tangent.total[k] += lasts * shift
        pulled = restoring_force(body, shift, 0j) * held.conjugate()
        tangent.r[k], tangent.theta[k] = 0.0, -pulled.imag / (abs(held) ** 2 + 1e-300)
    return Progress(
        SlipPlace(until, x, 0.0, cmath.phase(held)), until >= end, True, 0.1 / quickest(body), 0.0
    )


@inner
def _land(case: Case, place: SlipPlace, wait: float, room: Workspace, track: Track) -> Progress:
    """Go the short way to rest, on which slip falls evenly."""
    body, belt_speed, tangent = case.body, case.belt_speed, room.tangent
    tau, turned = place.tau + wait, cmath.exp(1j * place.theta)
    w = place.r * turned
    # slip falls from w to zero at an even rate: half of w on the way, a third of that in the integral of position
    if track.stick.size > 0 and wait > 0.0:
        pressed = normal_load(body, instant_at(body, place.tau))
        held, _rate, _bend = holding_force(body, belt_speed, instant_at(body, place.tau), place.x)
        hop = Hop(place.tau, wait, place.x, w, -w, (held + w / wait) / pressed)
        note_hop(track, place.tau, wait, False, _flow(case), hop)
    room.totals[POSITION] += wait * (place.x + wait * w / 3.0) + belt_path_integral(
        body, belt_speed, place.tau, tau
    )
    x = place.x + belt_path(body, belt_speed, place.tau, tau) + 0.5 * wait * w
    for k in range(DIRECTIONS):
        tangent.total[k] += wait * tangent.x[k]
        # the wait grows with slip
        moved = complex(tangent.r[k], 0.5 * place.r * tangent.theta[k])
        tangent.x[k] += wait * moved * turned
        tangent.r[k], tangent.theta[k] = 0.0, 0.0
    return Progress(SlipPlace(tau, x, 0.0, 0.0), True, False, 0.0, 0.0)


# --- slip -----------------------------------------------------------------------------------------------------------


class Approach(NamedTuple):
    """Forces on a mass as if at rest here: holding force, its rate, and the limit of friction.

    wait: time to rest.
    """

    held: complex
    rate: complex
    limit: float
    wait: float


@inner
def _approach(case: Case, place: SlipPlace) -> Approach:
    body, now = case.body, instant_at(case.body, place.tau)
    held, rate, _bend = holding_force(body, case.belt_speed, now, place.x)
    pressed = normal_load(body, now)
    limit = pressed * case.law.sliding_friction(0.0)
    turned = cmath.exp(1j * place.theta)
    # r' = a.e - f(r): the force along the slip, dashpots included, less friction
    force = held - restoring_force(body, 0j, place.r * turned)
    closing = pressed * case.law.sliding_friction(place.r) - (force * turned.conjugate()).real
    wait = place.r / closing if closing > 0.0 and place.r > 0.0 else math.inf
    return Approach(held, rate, limit, wait)


@inner
def _lands(case: Case, place: SlipPlace, near: Approach, accuracy: float) -> bool:
    """Check whether rest is so near that slip may fall to it evenly.

    Within the rounding of time it always is.
    """
    margin = near.limit - abs(near.held)
    if margin <= 0.0:
        return False
    sure = place.r * near.wait * quickest(case.body) < 0.01 * accuracy
    return (sure and 10.0 * near.wait * abs(near.rate) < margin) or near.wait < 3e-14 * span(case.body)


@inner
def _give_way(case: Case, place: SlipPlace, near: Approach, room: Workspace, track: Track) -> Progress:
    """Treat slip that no step resolves as rest: leave it out, and let time go on a moment."""
    if abs(near.held) < near.limit:
        return _land(case, place, 0.0, room, track)
    room.times[LEFT_OUT] += 1.0
    at = _land(case, place, 1e-10 / case.body.frequency, room, track)
    return Progress(at.place, True, False, 0.0, 0.0)


@inner
def _slip(case: Case, at: Progress, end: float, accuracy: float, room: Workspace, track: Track) -> Progress:
    """Take one step of slip, or the end of it.

    If the step is not accurate, return the same place with a shorter step.
    """
    place, step = at.place, room.step
    near = _approach(case, place)
    if not at.leaving and _lands(case, place, near, accuracy):
        return _land(case, place, near.wait, room, track)
    # the longest step falls with the accuracy: else two maps may agree because both are limited by it
    finer = (accuracy / _unit(case) / FIRST_ACCURACY) ** 0.08
    h = min(min(at.h, finer / quickest(case.body)), end - place.tau)
    if not at.leaving:
        h = min(h, 0.8 * near.wait)
    if h < SHORTEST_SLIP * span(case.body) and end - place.tau > h:
        return _give_way(case, place, near, room, track)
    # guess by the polynomial of the previous step, continued; a step tried shorter is a part of its own polynomial
    if at.before > 0.0 and h < 2.0 * at.before:
        guess_on(place, 1.0, 1.0 + h / at.before, step)
    elif at.before < 0.0:
        guess_on(place, 0.0, -h / at.before, step)
    else:
        guess_afresh(place, h, near.held, near.rate, near.limit, step)
    begin_step(case, place, h, step)
    if not solve_step(case, place, h, step):
        return Progress(place, False, at.leaving, 0.3 * h, 0.0)
    error = step_error(h, accuracy, step)
    # five stages: the coefficient of the highest Legendre polynomial, the measure of the error, falls as h^5
    growth = min(4.0, 0.9 / (error + 1e-300) ** 0.2)
    if error > 1.0:
        return Progress(place, False, at.leaving, max(0.2, growth) * h, -h)
    if track.stick.size > 0:
        _note_slip(track, place.tau, h, False, case, place, h, step)
    room.totals[POSITION] += end_step(case, place, h, step, room.tangent)
    tau = place.tau + h if end - place.tau > h else end
    place = SlipPlace(tau, step.x[step.x.size - 1], step.r[step.x.size], step.theta[step.x.size])
    return Progress(place, False, False, growth * h, h)


@inner
def _within(part: float, case: Case, place: SlipPlace, h: float, step: StepRoom) -> Any:
    """Return position, velocity and friction a time ``part`` into a solved step, by a new step to there."""
    r, turned = place.r, cmath.exp(1j * place.theta)
    x, now = place.x, instant_at(case.body, place.tau + part)
    if part > 0.0:
        anew, last = step_room(), step.x.size
        for k in range(last + 1):
            anew.r[k], anew.theta[k] = step.r[k], step.theta[k]
        guess_on(place, 0.0, part / h, anew)
        begin_step(case, place, part, anew)
        solve_step(case, place, part, anew)
        r, turned, x = anew.r[last], anew.along[last - 1], anew.x[last - 1]
    v = belt_velocity(case.body, case.belt_speed, now) + r * turned
    return x, v, case.law.sliding_friction(r) * turned


_note_slip = panel_writer(_within)


# --- the map --------------------------------------------------------------------------------------------------------


@inner
def _unit(case: Case) -> float:
    """Return the slip that accuracies are relative to."""
    body = case.body
    return body.normal_load * case.law.sliding_friction(0.0) / quickest(body)


@inner
def polar_map(
    case: Case, start: SlipPlace, end: float, accuracy: float, room: Workspace, track: Track
) -> Image:
    """Map from a place until the end; the workspace holds tangent and sums.

    theta of the place is not read for r = 0. accuracy: of slip in each step, relative to ``_unit``. A track
    with room records every piece of the motion.
    """
    finest = accuracy * _unit(case)
    at = _set_out(case, start.tau, start.x, start.r * cmath.exp(1j * start.theta), room)
    corrections, gap = room.step.corrections, 4e-15 * (abs(end) + span(case.body))
    corrections[0] = 0.0
    while end - at.place.tau > gap:
        corrections[0] += REST_TAKES if at.resting else 1.0
        if corrections[0] > MOST_CORRECTIONS_A_MAP or room.times[LEFT_OUT] > MOST_LEFT_OUT:
            return Image(at.place.x, 0j, -1)
        at_rest = at.resting
        at = _rest(case, at, end, room, track) if at_rest else _slip(case, at, end, finest, room, track)
    place = at.place
    return Image(place.x, place.r * cmath.exp(1j * place.theta), int(corrections[0]))
