"""Rest of the mass on the belt: the force that holds it, and the time at which slip begins."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from frictionlab.compile.decorators import inner
from frictionlab.compile.dispatch import by_dimension
from frictionlab.motion.equation import (
    Instant,
    belt_path,
    belt_swing,
    belt_velocity,
    holding_curvature,
    holding_force,
    in_piece,
    instant_at,
    look_ahead,
    normal_load,
    normal_load_bend,
    normal_load_curvature,
    normal_load_rate,
    piece_ends,
    pieces_of,
    quickest_of,
    resting_friction,
    restoring_force,
    slopes_at,
    span,
)
from frictionlab.motion.maps.case import Case
from frictionlab.scene.body import BodyNumbers


@inner
def _stick_end(law: Any, body: BodyNumbers, belt_speed: float, tau: float, x: Any, end: float) -> float:
    """Return the first time at which the holding force reaches its limit, or end.

    The distance to the limit stays above a parabola that bounds it.
    """
    holds = law.static_friction()
    swell, longest, start = holds * normal_load_curvature(body), look_ahead(body), tau
    for _ in range(10_000):
        now, there = instant_at(body, tau), x + belt_path(body, belt_speed, start, tau)
        held, rate, _bend = holding_force(body, belt_speed, now, there)
        curvature = holding_curvature(body, belt_speed, there) + swell
        limit, rise = holds * normal_load(body, now), holds * normal_load_rate(body, now)
        size = abs(held)
        gap = limit - size
        if gap <= 1e-14 * limit or tau >= end:
            break
        # The size of a force has a corner where the force is zero: there its rate bounds it from both sides.
        if size > 0.5 * limit:
            slope = (rate * held.conjugate()).real / size - rise
            bend = curvature + abs(rate) ** 2 / size
        else:
            slope, bend = abs(rate) - rise, curvature
        root = math.sqrt(slope * slope + 2.0 * bend * gap)
        # The first zero of gap - slope*t - bend*t^2/2, without cancellation.
        tau = tau + min(2.0 * gap / (slope + root) if slope + root > 0.0 else end, longest)
    return min(tau, end)


@inner
def periods_at_rest(law: Any, body: BodyNumbers, belt_speed: float, y: Any) -> float:
    """Return the number of whole periods for which a mass at rest at tau = 0 surely does not slip.

    It is at least one.
    """
    if look_ahead(body) < 1e300:  # the growth of the force of such springs is not bounded here
        return 1.0
    x, travel, room, pieces = y + body.reference_cosine, 0.0 * y, 1e300, pieces_of(body)
    last = _velocity_at(in_piece(body, pieces - 1), belt_speed, span(body))
    for k in range(pieces):
        piece = in_piece(body, k)
        start, end = piece_ends(body, k)
        # a belt whose velocity jumps leaves the mass behind
        if abs(_velocity_at(piece, belt_speed, start) - last) > 1e-12 * (abs(last) + belt_swing(body)):
            return 1.0
        room = min(room, _room_at_rest(law, piece, belt_speed, x + travel, start, end))
        travel, last = travel + belt_path(piece, belt_speed, start, end), _velocity_at(piece, belt_speed, end)
    return max(1.0, math.floor(room / abs(restoring_force(body, travel, 0.0 * travel))))


@inner
def _velocity_at(body: BodyNumbers, belt_speed: float, tau: float) -> Any:
    return belt_velocity(body, belt_speed, instant_at(body, tau))


@inner
def _room_at_rest(law: Any, body: BodyNumbers, belt_speed: float, x: Any, start: float, end: float) -> float:
    """Return the least excess of static friction over the holding force, between two corners of time.

    x: position of the mass at the first corner.
    """
    holds, period, room, samples = (
        law.static_friction(),
        end - start,
        1e300,
        int(128 * max(1.0, body.periods)),
    )
    for k in range(samples):
        tau = start + k * period / samples
        now = instant_at(body, tau)
        held, _rate, _bend = holding_force(body, belt_speed, now, x + belt_path(body, belt_speed, start, tau))
        room = min(room, holds * normal_load(body, now) - abs(held))
    # Between two samples the held force may exceed the straight line by curvature/8 times their distance squared.
    curvature = holding_curvature(body, belt_speed, x) + holds * normal_load_curvature(body)
    return room - 0.125 * curvature * (period / samples) ** 2


class Start(NamedTuple):
    """Time, slip and path shortly after slip began, relative to the belt."""

    t: float
    w: Any
    path: Any


def _start_in_the_plane(
    case: Case,
    now: Instant,
    accuracy: float,
    beside: BodyNumbers,
    rate: complex,
    bend: complex,
    held: complex,
) -> Start:
    """Start slip along the holding force.

    If that force is at the limit of slip, slip grows with the square of time.

    Slip then lags behind the force that turns: slip = b2 t^2 + b3 t^3 + ..., from the expansion of the
    equation of motion. The series carries the step control beyond the singular instant. It takes friction as
    constant, and ends before a falling law has fallen by more than the accuracy allows.
    """
    law, body = case.law, case.body
    pressed = normal_load(body, now)
    limit = pressed * law.sliding_friction(0.0)
    excess = abs(held) - limit
    along = held / abs(held)
    # beyond the limit friction leaves a net force at once: slip grows evenly
    holds = law.sliding_friction(0.0)
    rise, swell = holds * normal_load_rate(body, now), holds * normal_load_bend(body, now)
    if excess > 1e-6 * limit:
        brisk = excess + abs(rate) + abs(rise) + limit * quickest_of(body)
        t = min(1e-3, math.sqrt(0.01 * accuracy * excess) / brisk)
        while t > 1e-12 and t * abs(limit - pressed * law.sliding_friction(excess * t)) > 0.1 * accuracy:
            t *= 0.5
        return Start(t, along * excess * t, 0.5 * along * excess * t * t)
    # at the limit the force must first grow: the series in time, turned so that the held force is real
    first = rate * along.conjugate()
    b2 = 0.5 * (first.real - rise)
    if not b2 > 0.0:  # the force falls back below the limit at once: slip stays below rounding
        return Start(1e-6 / body.frequency, along * 1e-3 * accuracy, 0.0 * held)
    turn = first.imag / limit
    second = (0.5 * bend - restoring_force(beside, 0.0 * held, b2 * along)) * along.conjugate()
    b3 = complex((second.real - 0.5 * swell + 0.5 * limit * turn * turn) / 3.0, b2 * turn)
    b4 = complex(0.0, b2 * (second.imag - 3.0 * b3.imag - rise * turn) / limit + b3.real * turn)
    quick = quickest_of(body) + math.sqrt(abs(beside.stiffness_mean) + abs(beside.stiffness_split))
    t = min(0.01 / quick, (0.1 * accuracy / (b2 * quick**2)) ** 0.25)
    while t > 1e-12 and t * abs(limit - pressed * law.sliding_friction(b2 * t * t)) > 0.1 * accuracy:
        t *= 0.5
    w = along * (t * (excess + t * (b2 + t * (b3 + t * b4))))
    return Start(t, w, along * (t * t * (excess / 2.0 + t * (b2 / 3.0 + t * (b3 / 4.0 + t * b4 / 5.0)))))


_start = by_dimension(
    # nothing is singular on the line: the leg starts from rest
    lambda case, now, accuracy, beside, rate, bend, held: Start(0.0, 0.0, 0.0),
    _start_in_the_plane,
)


class StickPhase(NamedTuple):
    """End of a time at rest: its time, position, slip and side, and the impulse of friction meanwhile."""

    tau: float
    x: Any
    w: Any
    side: float
    friction_impulse: Any
    stuck: float
    pulled: Any  # of friction_impulse: after release


@inner
def end_of_rest(case: Case, tau: float, x: Any, end: float) -> float:
    """Return the time at which a mass at rest at tau, x begins to slip, end at the latest.

    It is tau itself if friction cannot hold the mass.
    """
    law, body, belt_speed = case.law, case.body, case.belt_speed
    now, holds = instant_at(body, tau), law.static_friction()
    limit, rise = normal_load(body, now) * holds, normal_load_rate(body, now) * holds
    held, rate, _bend = holding_force(body, belt_speed, now, x)
    rising = (rate * held.conjugate()).real > rise * abs(held)
    below = abs(held) < limit * (1.0 - 1e-13)
    if not below and (rising or abs(held) > limit * (1.0 + 1e-13)):
        return tau
    # At the limit itself the search would end where it begins: it begins a moment later.
    begin = tau if below else min(end, tau + 1e-9 / body.frequency)
    return _stick_end(law, body, belt_speed, begin, x + belt_path(body, belt_speed, tau, begin), end)


@inner
def stick_phase(case: Case, tau: float, x: Any, accuracy: float, end: float) -> StickPhase:
    """Follow rest at tau, x until slip begins, or until the end of the period."""
    body, belt_speed = case.body, case.belt_speed
    start, until = tau, end_of_rest(case, tau, x, end)
    stuck, friction_impulse = until - start, 0.0 * x
    if stuck > 0.0:
        friction_impulse, tau = resting_friction(body, belt_speed, start, until, x), until
        x = x + belt_path(body, belt_speed, start, tau)
        if tau >= end:
            return StickPhase(tau, x, 0.0 * x, 0.0, friction_impulse, stuck, 0.0 * x)
    now = instant_at(body, tau)
    held, rate, bend = holding_force(body, belt_speed, now, x)
    side = 1.0 if held.real > 0.0 else -1.0
    beside = slopes_at(body, x, belt_velocity(body, belt_speed, now) + 0.0 * x)
    t, w, path = _start(case, now, accuracy, beside, rate, bend, held)
    # Balance of momentum over the start: friction has the impulse that neither spring nor slip has taken.
    pulled = resting_friction(body, belt_speed, tau, tau + t, x)
    pulled = pulled - (restoring_force(beside, 0.0 * x, path) + w) / body.normal_load
    x = x + belt_path(body, belt_speed, tau, tau + t) + path
    return StickPhase(tau + t, x, w, side, friction_impulse + pulled, stuck, pulled)
