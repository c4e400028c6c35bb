"""A mass at rest on the belt: the force that holds it, and when slip begins."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from frictionlab.compile.decorators import inner
from frictionlab.compile.dispatch import by_dimension
from frictionlab.dynamics.motion import restoring_force, span
from frictionlab.scene.body import Body

# --- at rest on the belt ------------------------------------------------------------------------------------------


class LoadAtRest(NamedTuple):
    """What friction must hold at rest: sine*sin + cosine*cos - restoring force of the belt's motion."""

    sine: Any
    cosine: Any


@inner
def load_at_rest(body: Body) -> LoadAtRest:
    square = body.frequency**2
    s, c = body.reference_sine, body.reference_cosine
    return LoadAtRest(
        body.force_sine + restoring_force(body, s, -body.frequency * c) - square * s,
        body.force_cosine + restoring_force(body, c, body.frequency * s) - square * c,
    )


@inner
def holding_force(body: Body, pull: LoadAtRest, tau: float, x: Any, belt: Any) -> Any:
    """The force of friction at rest, its rate and the rate of that; x absolute position, belt the velocity."""
    sine, cosine = math.sin(body.frequency * tau), math.cos(body.frequency * tau)
    wave = pull.sine * sine + pull.cosine * cosine
    rate = body.frequency * (pull.sine * cosine - pull.cosine * sine)
    return (
        wave - restoring_force(body, x, belt),
        rate - restoring_force(body, belt, 0.0 * belt),
        -(body.frequency**2) * wave,
    )


@inner
def holding_impulse(body: Body, pull: LoadAtRest, tau: float, end: float, x: Any, belt: Any) -> Any:
    """Integral of the force of friction at rest from tau to end; x at tau."""
    middle = 0.5 * (tau + end)
    half_angle = 0.5 * body.frequency * (end - tau)
    mean = math.sin(half_angle) / half_angle if half_angle > 0.0 else 1.0
    wave = pull.sine * math.sin(body.frequency * middle) + pull.cosine * math.cos(body.frequency * middle)
    return (end - tau) * (mean * wave - restoring_force(body, x + (middle - tau) * belt, belt))


@inner
def _stick_end(
    body: Body, pull: LoadAtRest, tau: float, x: Any, belt: Any, limit: float, end: float
) -> float:
    """First time the held force reaches the limit, or end: every step stays below a parabola that bounds it."""
    curvature = body.frequency**2 * (abs(pull.sine) + abs(pull.cosine))
    start = tau
    for _ in range(10_000):
        held, rate, _bend = holding_force(body, pull, tau, x + (tau - start) * belt, belt)
        size = abs(held)
        gap = limit - size
        if gap <= 1e-14 * limit or tau >= end:
            break
        if size > 0.5 * limit:
            slope = (rate * held.conjugate()).real / size
            bend = curvature + abs(rate) ** 2 / size
        else:
            slope, bend = abs(rate), curvature
        root = math.sqrt(slope * slope + 2.0 * bend * gap)
        tau = tau + (2.0 * gap / (slope + root) if slope + root > 0.0 else end)
    return min(tau, end)


@inner
def periods_at_rest(law: Any, body: Body, belt_speed: float, y: Any) -> float:
    """How many whole periods, at least one, a mass at rest at tau = 0 is sure to be carried on without slip."""
    pull, limit = load_at_rest(body), body.normal_load * law.static_friction()
    belt = belt_speed + 0.0 * y
    period = span(body)
    drift = abs(restoring_force(body, belt, 0.0 * belt)) * period
    x, largest, samples = y + body.reference_cosine, 0.0, int(128 * max(1.0, body.periods))
    for k in range(samples):
        tau = k * period / samples
        held, _rate, _bend = holding_force(body, pull, tau, x + tau * belt, belt)
        largest = max(largest, abs(held))
    curvature = body.frequency**2 * (abs(pull.sine) + abs(pull.cosine))
    largest += 0.125 * curvature * (period / samples) ** 2
    return max(1.0, math.floor((limit - largest) / drift))


class Start(NamedTuple):
    """Time, slip and path shortly after slip began, relative to the belt."""

    t: float
    w: Any
    path: Any


def _start_on_the_line(law: Any, body: Body, accuracy: float, rate: float, bend: float, held: float) -> Start:
    """Nothing is singular on the line: the leg starts from rest."""
    return Start(0.0, 0.0, 0.0)


def _start_in_the_plane(
    law: Any, body: Body, accuracy: float, rate: complex, bend: complex, held: complex
) -> Start:
    """Slip sets off along the held force; where that is at the limit of slip, it grows with the square of time.

    Then it lags behind the force that turns: slip = b2 t^2 + b3 t^3 + ..., from the expansion of the equation
    of motion; the series carries the step control beyond the singular instant. It takes friction as constant,
    and ends before a law that falls has fallen by more than the accuracy bears.
    """
    limit = body.normal_load * law.sliding_friction(0.0)
    excess = abs(held) - limit
    along = held / abs(held)
    if excess > 1e-6 * limit:
        t = min(1e-3, math.sqrt(0.01 * accuracy * excess) / (excess + abs(rate) + limit * body.frequency))
        while (
            t > 1e-12
            and t * abs(limit - body.normal_load * law.sliding_friction(excess * t)) > 0.1 * accuracy
        ):
            t *= 0.5
        return Start(t, along * excess * t, 0.5 * along * excess * t * t)
    first = rate * along.conjugate()
    b2 = 0.5 * first.real
    if not b2 > 0.0:  # the force falls back below the limit at once: what slip there is stays below rounding
        return Start(1e-6 / body.frequency, along * 1e-3 * accuracy, 0.0 * held)
    turn = first.imag / limit
    second = (0.5 * bend - restoring_force(body, 0.0 * held, b2 * along)) * along.conjugate()
    b3 = complex((second.real + 0.5 * limit * turn * turn) / 3.0, b2 * turn)
    b4 = complex(0.0, b2 * (second.imag - 3.0 * b3.imag) / limit + b3.real * turn)
    quick = body.frequency + math.sqrt(body.stiffness_mean + abs(body.stiffness_split))
    t = min(0.01 / quick, (0.1 * accuracy / (b2 * quick**2)) ** 0.25)
    while t > 1e-12 and t * abs(limit - body.normal_load * law.sliding_friction(b2 * t * t)) > 0.1 * accuracy:
        t *= 0.5
    w = along * (t * (excess + t * (b2 + t * (b3 + t * b4))))
    return Start(t, w, along * (t * t * (excess / 2.0 + t * (b2 / 3.0 + t * (b3 / 4.0 + t * b4 / 5.0)))))


_start = by_dimension(_start_on_the_line, _start_in_the_plane)


class StickPhase(NamedTuple):
    """How a time at rest ended: when, where, with which slip and side, and what friction did meanwhile."""

    tau: float
    x: Any
    w: Any
    side: float
    rubbed: Any
    stuck: float
    pulled: Any  # of rubbed: after release


@inner
def stick_phase(
    law: Any, body: Body, belt_speed: float, tau: float, x: Any, accuracy: float, end: float
) -> StickPhase:
    """From rest at tau, x until slip begins, or until the end of the period."""
    belt = belt_speed + 0.0 * x
    pull = load_at_rest(body)
    limit = body.normal_load * law.static_friction()
    held, rate, bend = holding_force(body, pull, tau, x, belt)
    start, stuck, rubbed = tau, 0.0, 0.0 * x
    rising = (rate * held.conjugate()).real > 0.0
    if abs(held) < limit * (1.0 - 1e-13) or (abs(held) <= limit * (1.0 + 1e-13) and not rising):
        begin = tau if abs(held) < limit * (1.0 - 1e-13) else min(end, tau + 1e-9 / body.frequency)
        tau = _stick_end(body, pull, begin, x + (begin - tau) * belt, belt, limit, end)
        stuck = tau - start
        rubbed = holding_impulse(body, pull, start, tau, x, belt) / body.normal_load
        x = x + stuck * belt
        held, rate, bend = holding_force(body, pull, tau, x, belt)
        if tau >= end:
            return StickPhase(tau, x, 0.0 * x, 0.0, rubbed, stuck, 0.0 * x)
    side = 1.0 if held.real > 0.0 else -1.0
    t, w, path = _start(law, body, accuracy, rate, bend, held)
    pulled = holding_impulse(body, pull, tau, tau + t, x, belt) - restoring_force(body, 0.0 * x, path) - w
    pulled = pulled / body.normal_load
    return StickPhase(tau + t, x + t * belt + path, w, side, rubbed + pulled, stuck, pulled)
