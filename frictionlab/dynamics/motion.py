"""The equation of motion: what pushes, presses and carries the mass at an instant; slip, acceleration, force at rest.

Every map, march and reading of energies calls these functions. Load, normal load and belt are functions of time here
and nowhere else. One that changes otherwise (a waveform, a load that pulsates, a belt that swings) is written into
its group below: the function, and the rates, bounds and integrals beside it, which the time at rest asks for. Body
and Mass may get more numbers for it; ``body`` may be the numbers of a prescribed slip, too, for the belt. Maps follow
the deviation (y, u = y') from the body's harmonic reference.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from frictionlab.compile.decorators import fast, fast_embedded, inner
from frictionlab.compile.dispatch import by_dimension, compilable, length
from frictionlab.compile.law_lanes import friction_by_lane
from frictionlab.dynamics.events import reference_acceleration
from frictionlab.scene import body as _plain
from frictionlab.scene.body import Body

restoring_force = fast(_plain.restoring_force)
span = fast(_plain.span)
planar = inner(compilable(_plain.in_the_plane))
"""The body of a mass in the plane."""


class Instant(NamedTuple):
    """A time, with sine and cosine of Omega*tau."""

    tau: float
    sine: float
    cosine: float


@inner
def instant_at(body: Any, tau: float) -> Instant:
    """The instant; a body is whatever has a frequency."""
    angle = body.frequency * tau
    return Instant(tau, math.sin(angle), math.cos(angle))


START = Instant(0.0, 0.0, 1.0)
"""tau = 0, where whatever does not change may be asked for."""


# --- the load: of one harmonic ------------------------------------------------------------------------------------


@inner
def load(body: Any, now: Instant) -> Any:
    """What drives the mass; on the line a number, in the plane x1 + i x2.

    Not ``fast``: less what the reference balances it is zero to the last bit where that is all of it.
    """
    return body.load_sine * now.sine + body.load_cosine * now.cosine


@inner
def load_rates(body: Any, now: Instant) -> Any:
    """First and second derivative of the load: of a harmonic, what it is a quarter and half of a period later."""
    later = Instant(now.tau + 0.5 * math.pi / body.frequency, now.cosine, -now.sine)
    return body.frequency * load(body, later), -(body.frequency**2) * load(body, now)


@inner
def load_curvature(body: Any) -> float:
    """A bound on the second derivative of the load, at any time."""
    quarter = Instant(0.5 * math.pi / body.frequency, 1.0, 0.0)
    return body.frequency**2 * (abs(load(body, quarter)) + abs(load(body, START)))


@inner
def load_impulse(body: Any, start: float, end: float) -> Any:
    """The integral of the load: of a harmonic, its value half way, less the more of a period is passed."""
    half_angle = 0.5 * body.frequency * (end - start)
    mean = math.sin(half_angle) / half_angle if half_angle > 0.0 else 1.0
    return (end - start) * (mean * load(body, instant_at(body, 0.5 * (start + end))))


# --- the normal load: constant ------------------------------------------------------------------------------------


@fast
def normal_load(body: Any, now: Instant) -> float:
    """What presses the mass on the belt: friction is this times its coefficient."""
    return body.normal_load


@fast
def normal_load_rate(body: Any, now: Instant) -> float:
    """Its derivative."""
    return 0.0


@fast
def normal_load_curvature(body: Any) -> float:
    """A bound on its second derivative, at any time."""
    return 0.0


# --- the belt: of constant velocity -------------------------------------------------------------------------------


@fast
def belt_velocity(body: Any, belt_speed: float, now: Instant) -> float:
    """Of the belt, along x1; belt_speed: its mean."""
    return belt_speed


@fast
def belt_acceleration(body: Any, belt_speed: float, now: Instant) -> float:
    """Derivative of its velocity."""
    return 0.0


@fast
def belt_jerk(body: Any, belt_speed: float, now: Instant) -> float:
    """Derivative of its acceleration."""
    return 0.0


@fast
def belt_path(body: Any, belt_speed: float, start: float, end: float) -> float:
    """How far the belt goes between two times."""
    return (end - start) * belt_velocity(body, belt_speed, START)


@fast
def belt_path_integral(body: Any, belt_speed: float, start: float, end: float) -> float:
    """The integral of the way it has gone since the start."""
    return 0.5 * (end - start) * belt_path(body, belt_speed, start, end)


# --- the motion ---------------------------------------------------------------------------------------------------


SLIP_ROUNDING = 1e-15
"""A slip below this share of the velocity it is a difference of is rounding, and has no direction."""


@fast
def slip(body: Any, belt_speed: float, now: Instant, v: Any) -> Any:
    """Slip velocity: of the mass against the belt."""
    return v - belt_velocity(body, belt_speed, now)


@fast
def acceleration_under(body: Body, push: Any, pressed: float, x: Any, v: Any, rub: Any) -> Any:
    """Acceleration of the mass under a load and a normal load that are known; rub: coefficient of friction."""
    return push - restoring_force(body, x, v) - pressed * rub


@fast
def acceleration(body: Body, now: Instant, x: Any, v: Any, rub: Any) -> Any:
    """Acceleration of the mass; rub: coefficient of friction."""
    return acceleration_under(body, load(body, now), normal_load(body, now), x, v, rub)


@inner
def mean_friction(impulse: Any, time: float) -> Any:
    """The mean coefficient, positive where the belt drags the mass along x1, from the integral of what resists."""
    return -impulse / time


# --- the mass at rest on the belt ---------------------------------------------------------------------------------


@inner
def holding_force(body: Body, belt_speed: float, now: Instant, x: Any) -> Any:
    """The force of friction that keeps a mass at x with the belt, its rate and the rate of that.

    The second rate takes the belt's jerk as constant.
    """
    carried = belt_velocity(body, belt_speed, now) + 0.0 * x
    pushed = belt_acceleration(body, belt_speed, now) + 0.0 * x
    jerk = belt_jerk(body, belt_speed, now) + 0.0 * x
    rate, bend = load_rates(body, now)
    return (
        load(body, now) - restoring_force(body, x, carried) - pushed,
        rate - restoring_force(body, carried, pushed) - jerk,
        bend - restoring_force(body, pushed, jerk),
    )


@inner
def holding_curvature(body: Body, belt_speed: float) -> float:
    """A bound on the second derivative of that force; of a belt that swings it has a part, too."""
    return load_curvature(body)


@inner
def holding_impulse(body: Body, belt_speed: float, start: float, end: float, x: Any) -> Any:
    """Integral of that force; x at the start."""
    way = belt_path(body, belt_speed, start, end) + 0.0 * x
    positions = (end - start) * x + belt_path_integral(body, belt_speed, start, end)
    first, last = instant_at(body, start), instant_at(body, end)
    gained = belt_velocity(body, belt_speed, last) - belt_velocity(body, belt_speed, first)
    return load_impulse(body, start, end) - restoring_force(body, positions, way) - gained


@inner
def resting_friction(body: Body, belt_speed: float, start: float, end: float, x: Any) -> Any:
    """Integral of the coefficient at rest; of a normal load that changes it is a quadrature."""
    return holding_impulse(body, belt_speed, start, end, x) / normal_load(body, instant_at(body, start))


# --- the deviation from the friction-free response ----------------------------------------------------------------


class Flow(NamedTuple):
    """A law and a body on a belt; the side of slip on the line; sine and cosine at the anchor time."""

    law: Any
    body: Body
    belt_speed: float
    side: float
    anchor: float
    sine: float
    cosine: float


@fast
def turned(problem: Any, tau: float) -> Any:
    """Sine and cosine of Omega*tau from those at the anchor, at most one radian away (Taylor, to rounding)."""
    angle = problem.body.frequency * (tau - problem.anchor)
    q = angle * angle
    cosine = 1.0 - q / 2.0 * (
        1.0 - q / 12.0 * (1.0 - q / 30.0 * (1.0 - q / 56.0 * (1.0 - q / 90.0 * (1.0 - q / 132.0 * (
            1.0 - q / 182.0 * (1.0 - q / 240.0 * (1.0 - q / 306.0)))))))
    )  # fmt: skip
    sine = angle * (
        1.0 - q / 6.0 * (1.0 - q / 20.0 * (1.0 - q / 42.0 * (1.0 - q / 72.0 * (1.0 - q / 110.0 * (
            1.0 - q / 156.0 * (1.0 - q / 210.0 * (1.0 - q / 272.0)))))))
    )  # fmt: skip
    return (
        problem.sine * cosine + problem.cosine * sine,
        problem.cosine * cosine - problem.sine * sine,
    )


@fast
def instant_near(problem: Any, tau: float) -> Instant:
    """The instant, at most one radian from the anchor of the problem."""
    sine, cosine = turned(problem, tau)
    return Instant(tau, sine, cosine)


@inner
def anchored(law: Any, body: Body, belt_speed: float, side: float, tau: float) -> Flow:
    """The problem with its anchor at this time."""
    angle = body.frequency * tau
    return Flow(law, body, belt_speed, side, tau, math.sin(angle), math.cos(angle))


@inner
def reference_position(body: Body, tau: float) -> Any:
    """Of the friction-free response."""
    angle = body.frequency * tau
    return body.reference_sine * math.sin(angle) + body.reference_cosine * math.cos(angle)


@fast
def reference_velocity(body: Body, sine: float, cosine: float) -> Any:
    """Its derivative."""
    return body.frequency * (body.reference_sine * cosine - body.reference_cosine * sine)


@inner
def swing_of(body: Body) -> float:
    """The speed of the friction-free response; 1 where it has no bound."""
    swing = body.frequency * math.hypot(abs(body.reference_sine), abs(body.reference_cosine))
    return swing if swing > 0.0 else 1.0


@inner
def balanced_load(body: Body, now: Instant) -> Any:
    """The force that the reference motion takes."""
    return body.balanced_sine * now.sine + body.balanced_cosine * now.cosine


@fast
def unbalanced_load(body: Body, now: Instant) -> Any:
    """What of the load drives the deviation."""
    return load(body, now) - balanced_load(body, now)


@inner
def unbalanced_rate(body: Body, now: Instant) -> Any:
    """Its derivative."""
    rate, _bend = load_rates(body, now)
    return rate - body.frequency * (body.balanced_sine * now.cosine - body.balanced_cosine * now.sine)


@fast
def deviation_acceleration(body: Body, now: Instant, y: Any, u: Any, rub: Any) -> Any:
    """Acceleration of the deviation; rub: coefficient of friction."""
    return acceleration_under(body, unbalanced_load(body, now), normal_load(body, now), y, u, rub)


@fast
def deviation_slip(problem: Any, now: Instant, u: Any) -> Any:
    """Slip velocity of a mass whose deviation has this velocity."""
    v = u + reference_velocity(problem.body, now.sine, now.cosine)
    return slip(problem.body, problem.belt_speed, now, v)


@fast
def deviation_slip_rate(problem: Any, now: Instant, a: Any) -> Any:
    """Derivative of slip where the deviation has this acceleration."""
    rate = a + reference_acceleration(problem.body, now.sine, now.cosine)
    return rate - belt_acceleration(problem.body, problem.belt_speed, now)


def _friction_on_the_line(problem: Flow, w: float) -> Any:
    return problem.side * problem.law.sliding_friction(max(problem.side * w, 0.0))


def _friction_in_the_plane(problem: Flow, w: complex) -> Any:
    return problem.law.sliding_vector(w)


def _friction_in_lanes(problem: Flow, w: Any) -> Any:
    """Of a law whose vector is that of ``FrictionLaw``: along the slip."""
    speed = length(w)
    return (friction_by_lane(problem.law, speed) / speed) * w


_friction = by_dimension(_friction_on_the_line, _friction_in_the_plane, _friction_in_lanes)


@fast_embedded
def rates(problem: Flow, tau: float, y: Any, u: Any) -> Any:
    """Acceleration of the deviation, and the friction coefficient of a law without memory."""
    now = instant_near(problem, tau)
    rub = _friction(problem, deviation_slip(problem, now, u))
    return deviation_acceleration(problem.body, now, y, u, rub), rub


@fast
def slip_at(problem: Any, tau: float, u: Any) -> Any:
    """Slip velocity near the anchor of a problem; u: velocity of the deviation."""
    return deviation_slip(problem, instant_near(problem, tau), u)


@fast
def slip_rate(problem: Any, tau: float, a: Any) -> Any:
    """Its derivative; a: acceleration of the deviation."""
    return deviation_slip_rate(problem, instant_near(problem, tau), a)
