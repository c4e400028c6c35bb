"""Carrying of a mass by a slow belt: to the edge of the positions in which friction holds it all the time.

The positions whose holding force never exceeds friction are convex. A slow belt carries the mass to their far end,
where the mean of the spring tends to as the belt slows down, and loses it there once a period.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from frictionlab.compile.decorators import inner
from frictionlab.motion.equation import START, belt_advance, instant_at, load, normal_load, span
from frictionlab.motion.maps.case import Case

LOADS = 512
GOLDEN_SHARE = 0.5 * (math.sqrt(5.0) - 1.0)


class Plateau(NamedTuple):
    """A position near the far end and a time at which friction holds the mass there; found: whether there is one."""

    found: bool
    x: complex
    tau: float


class Edge(NamedTuple):
    """Largest force along the belt that friction holds all the time, beside one across; when it barely does."""

    along: float
    tau: float


@inner
def _edge(case: Case, across: float, limit: float) -> Edge:
    """By samples of the load l: the least of l.real + sqrt(limit^2 - (l.imag - across)^2)."""
    least, tau, period = math.inf, 0.0, span(case.body)
    for k in range(LOADS):
        now = instant_at(case.body, k * period / LOADS)
        push = load(case.body, now)
        room = limit * limit - (push.imag - across) ** 2
        along = push.real + math.sqrt(max(room, 0.0))
        if along < least:
            least, tau = along, now.tau
    return Edge(least, tau)


@inner
def _farthest(case: Case, room: float, limit: float) -> complex:
    """Force across the belt, up to this room, beside which the most is held along (golden section), and that."""
    low, high = -room, room
    first, second = high - GOLDEN_SHARE * (high - low), low + GOLDEN_SHARE * (high - low)
    at_first, at_second = _edge(case, first, limit).along, _edge(case, second, limit).along
    for _ in range(36):
        if at_first > at_second:
            high, second, at_second = second, first, at_first
            first = high - GOLDEN_SHARE * (high - low)
            at_first = _edge(case, first, limit).along
        else:
            low, first, at_first = first, second, at_second
            second = low + GOLDEN_SHARE * (high - low)
            at_second = _edge(case, second, limit).along
    return complex(max(at_first, at_second), 0.5 * (low + high))


@inner
def plateau(case: Case) -> Plateau:
    """Return the far end, and beyond it what slip needs to fall behind by the belt's way in a period.

    There the holding force exceeds friction for a moment, and the mass slips by excess * time^2 in about as long as
    the excess lasts: inertial slip, q/9 of the fourth power of half that time.
    """
    body, period, side = case.body, span(case.body), math.copysign(1.0, case.belt_speed)
    limit = normal_load(body, START) * case.law.static_friction()
    largest, highest = 0.0, 0.0
    for k in range(LOADS):
        push = load(body, instant_at(body, k * period / LOADS))
        largest, highest = max(largest, abs(push)), max(highest, abs(push.imag))
    if largest >= limit or case.belt_speed == 0.0:
        return Plateau(False, 0j, 0.0)
    held = _farthest(case, limit - highest, limit)
    touched = load(body, instant_at(body, _edge(case, held.imag, limit).tau))
    # both: of the loads' shape, which is the same from either side
    bend = body.frequency**2 * abs(((touched - held).conjugate() * touched).real) / limit
    stiffness = body.stiffness_mean + body.stiffness_split
    beyond = 0.5 * math.sqrt(bend * stiffness * abs(belt_advance(body, case.belt_speed)) / 1.125)
    held = side * complex(held.real + beyond, held.imag)
    drag = (body.damping_mean + body.damping_split) * case.belt_speed
    x = complex((held.real - drag) / stiffness, held.imag / (body.stiffness_mean - body.stiffness_split))
    return Plateau(True, x, _calmest(case, held))


@inner
def _calmest(case: Case, held: complex) -> float:
    """When the loads differ least from this force."""
    least, tau, period = math.inf, 0.0, span(case.body)
    for k in range(LOADS):
        now = instant_at(case.body, k * period / LOADS)
        force = abs(load(case.body, now) - held)
        if force < least:
            least, tau = force, now.tau
    return tau
