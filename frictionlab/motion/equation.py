"""Equation of motion: loads, normal load and belt at an instant; slip, acceleration, force at rest.

Every map, every march and every reading of energies calls these functions. Only here are load, normal load
and belt functions of time: each has its group below, with the rates, bounds and integrals that the time at
rest needs. Where two functions are given for one name, the first is for a body on which one sine is all that
changes in time. The second is for a ``varying`` body, within the current piece between two corners. Functions
of the belt also accept the numbers of a prescribed slip as ``body``. Maps follow the deviation (y, u = y')
from the harmonic reference motion of the body.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from frictionlab.compile.decorators import fast, fast_embedded, inner
from frictionlab.compile.dispatch import (
    by_dimension,
    by_springs,
    by_variation,
    compilable,
    length,
)
from frictionlab.compile.lane_arrays import friction_by_lane
from frictionlab.compile.stack import items_of
from frictionlab.motion.events import reference_acceleration
from frictionlab.motion.waves import (
    number_at,
    wave_at,
    wave_bound,
    wave_impulse,
    wave_path_integral,
    wave_rate,
)
from frictionlab.scene import body as _plain
from frictionlab.scene.body import BodyNumbers
from frictionlab.scene.varying import PER_PIECE, Course, Packed

linear_force = fast(_plain.restoring_force)
_bent_force = fast(compilable(_plain.bent_force))
restoring_force = by_springs(_plain.restoring_force, _bent_force)
"""restoring_force(body, x, v): force of springs and dashpots, per unit mass."""
dissipated = by_springs(
    lambda body, x, v: linear_force(body, 0.0 * v, v),
    lambda body, x, v: _bent_force(body, x, v) - _bent_force(body, x, 0.0 * v),
)
"""dissipated(body, x, v): force of the dashpots alone, per unit mass."""
slopes_at = by_springs(lambda body, x, v: body, _plain.bent_slopes)
"""slopes_at(body, x, v): linear body whose ``restoring_force`` is that of small changes of this motion."""
span = fast(_plain.span)
planar = inner(compilable(_plain.in_the_plane))
"""planar(body): numbers of a body on the line as those of a mass in the plane."""


class Instant(NamedTuple):
    """Instant of time, with sine and cosine of Omega*tau."""

    tau: float
    sine: float
    cosine: float


@inner
def instant_at(body: Any, tau: float) -> Instant:
    """Return the instant at time tau; ``body`` is any record with a frequency."""
    angle = body.frequency * tau
    return Instant(tau, math.sin(angle), math.cos(angle))


START = Instant(0.0, 0.0, 1.0)
"""Instant tau = 0, at which constants are evaluated."""


# --- the load -----------------------------------------------------------------------------------------------------

load = by_variation(
    lambda body, now: body.load_sine * now.sine + body.load_cosine * now.cosine,
    lambda body, now: wave_at(body.varying.table, body.varying.load, body.varying.begins, now.tau),
)
"""load(body, now): driving force on the mass; on the line a number, in the plane x1 + i x2.

Not ``fast``: where the reference balances all of the load, the difference must be zero to the last bit."""


def _rates_of_one_sine(body: Any, now: Instant) -> Any:
    """Return the first and the second derivative of the load.

    They are omega times the load a quarter of a period later, and minus omega^2 times the load.
    """
    later = Instant(now.tau + 0.5 * math.pi / body.frequency, now.cosine, -now.sine)
    return body.frequency * load(body, later), -(body.frequency**2) * load(body, now)


def _rates_of_waves(body: Any, now: Instant) -> Any:
    return wave_rate(body.varying.table, body.varying.load, now.tau, 1), wave_rate(
        body.varying.table, body.varying.load, now.tau, 2
    )


load_rates = by_variation(_rates_of_one_sine, _rates_of_waves)
"""load_rates(body, now): first and second derivative of the load."""


def _curvature_of_one_sine(body: Any) -> float:
    quarter = Instant(0.5 * math.pi / body.frequency, 1.0, 0.0)
    return body.frequency**2 * (abs(load(body, quarter)) + abs(load(body, START)))


load_curvature = by_variation(
    _curvature_of_one_sine, lambda body: wave_bound(body.varying.table, body.varying.load, 2)
)
"""load_curvature(body): bound on the second derivative of the load, at any time."""


def _impulse_of_one_sine(body: Any, start: float, end: float) -> Any:
    """Return the integral of the load.

    It is the length of the interval times the load half way, times sin(a)/a with half the angle passed as a.
    """
    half_angle = 0.5 * body.frequency * (end - start)
    mean = math.sin(half_angle) / half_angle if half_angle > 0.0 else 1.0
    return (end - start) * (mean * load(body, instant_at(body, 0.5 * (start + end))))


def _impulse_of_waves(body: Any, start: float, end: float) -> Any:
    return wave_impulse(body.varying.table, body.varying.load, body.varying.begins, start, end)


load_impulse = by_variation(_impulse_of_one_sine, _impulse_of_waves)
"""load_impulse(body, start, end): integral of the load."""


# --- the normal load ----------------------------------------------------------------------------------------------


def _varying_load(body: Any, now: Instant) -> float:
    return body.normal_load + wave_at(
        body.varying.table, body.varying.normal_load, body.varying.begins, now.tau
    )


normal_load = by_variation(lambda body, now: body.normal_load, _varying_load)
"""normal_load(body, now): force that presses the mass on the belt; friction is this times its coefficient."""


def _varying_share(body: Any, now: Instant) -> float:
    return (
        1.0
        + wave_at(body.varying.table, body.varying.normal_load, body.varying.begins, now.tau)
        / body.normal_load
    )


load_share = by_variation(lambda body, now: 1.0, _varying_share)
"""load_share(body, now): normal load over its mean."""

normal_load_rate = by_variation(
    lambda body, now: 0.0,
    lambda body, now: wave_rate(body.varying.table, body.varying.normal_load, now.tau, 1),
)
"""normal_load_rate(body, now): derivative of the normal load."""

normal_load_bend = by_variation(
    lambda body, now: 0.0,
    lambda body, now: wave_rate(body.varying.table, body.varying.normal_load, now.tau, 2),
)
"""normal_load_bend(body, now): second derivative of the normal load."""

normal_load_curvature = by_variation(
    lambda body: 0.0, lambda body: wave_bound(body.varying.table, body.varying.normal_load, 2)
)
"""normal_load_curvature(body): bound on the second derivative of the normal load, at any time."""


# --- the belt -----------------------------------------------------------------------------------------------------


def _vibrating_speed(body: Any, belt_speed: float, now: Instant) -> Any:
    return belt_speed + wave_at(body.varying.table, body.varying.belt, body.varying.begins, now.tau)


belt_velocity = by_variation(lambda body, belt_speed, now: belt_speed, _vibrating_speed)
"""belt_velocity(body, belt_speed, now): velocity of the belt; belt_speed: its mean, along x1."""

belt_acceleration = by_variation(
    lambda body, belt_speed, now: 0.0,
    lambda body, belt_speed, now: wave_rate(body.varying.table, body.varying.belt, now.tau, 1),
)
"""belt_acceleration(body, belt_speed, now): derivative of the belt's velocity."""

belt_jerk = by_variation(
    lambda body, belt_speed, now: 0.0,
    lambda body, belt_speed, now: wave_rate(body.varying.table, body.varying.belt, now.tau, 2),
)
"""belt_jerk(body, belt_speed, now): derivative of the belt's acceleration."""

belt_snap = by_variation(
    lambda body, belt_speed, now: 0.0,
    lambda body, belt_speed, now: wave_rate(body.varying.table, body.varying.belt, now.tau, 3),
)
"""belt_snap(body, belt_speed, now): derivative of the belt's jerk."""


def _vibrating_path(body: Any, belt_speed: float, start: float, end: float) -> Any:
    return (end - start) * belt_speed + wave_impulse(
        body.varying.table, body.varying.belt, body.varying.begins, start, end
    )


belt_path = by_variation(
    lambda body, belt_speed, start, end: (end - start) * belt_velocity(body, belt_speed, START),
    _vibrating_path,
)
"""belt_path(body, belt_speed, start, end): distance that the belt travels between two times of one piece."""


def _integral_of_vibrating_path(body: Any, belt_speed: float, start: float, end: float) -> Any:
    swung = wave_path_integral(body.varying.table, body.varying.belt, body.varying.begins, start, end)
    return 0.5 * (end - start) * ((end - start) * belt_speed) + swung


belt_path_integral = by_variation(
    lambda body, belt_speed, start, end: 0.5 * (end - start) * belt_path(body, belt_speed, start, end),
    _integral_of_vibrating_path,
)
"""belt_path_integral(body, belt_speed, start, end): integral of the distance travelled since the start."""

belt_advance = by_variation(
    lambda body, belt_speed: belt_path(body, belt_speed, 0.0, span(body)),
    lambda body, belt_speed: span(body) * belt_speed,
)
"""belt_advance(body, belt_speed): distance that the belt travels in a span; its vibration adds nothing."""

belt_swing = by_variation(lambda body: 0.0, lambda body: body.varying.whole.belt_swing)
"""belt_swing(body): largest difference between the belt's speed and its mean."""


# --- pieces between corners ---------------------------------------------------------------------------------------


def _pieces_of_a_span(body: Any) -> int:
    whole = body.varying.whole
    laps = math.floor(body.periods / whole.periods + 0.5)
    return laps * whole.pieces


pieces_of = by_variation(lambda body: 1, _pieces_of_a_span)
"""pieces_of(body): number of pieces in one span of the body; within a piece everything is smooth in time."""


@inner
def _edge(varying: Any, k: int) -> float:
    """Return the time at which the k-th piece since the start begins."""
    pieces, first = varying.whole.pieces, varying.whole.edges
    return k // pieces * varying.table[first + pieces] + varying.table[first + k % pieces]


def _piece_between_corners(body: Any, k: int) -> Any:
    last = k == pieces_of(body) - 1
    return _edge(body.varying, k), span(body) if last else _edge(body.varying, k + 1)


piece_ends = by_variation(lambda body, k: (0.0, span(body)), _piece_between_corners)
"""piece_ends(body, k): times at which the k-th piece of a span begins and ends."""


@inner
def _course_on_line(varying: Any, course: Course, place: int) -> Course:
    """Return the function of time whose line, value and slope, stands at this place of the table."""
    value = number_at(varying.table, place, course.value)
    slope = number_at(varying.table, place + 2, course.value)
    return Course(course.first, course.terms, value, slope)


@inner
def changed(body: BodyNumbers, periods: float, varying: Any) -> BodyNumbers:
    """Return the body with another span and other functions of time."""
    return BodyNumbers(
        body.damping_mean, body.damping_split, body.stiffness_mean, body.stiffness_split, body.normal_load,
        body.frequency, body.load_sine, body.load_cosine, body.balanced_sine, body.balanced_cosine,
        body.reference_sine, body.reference_cosine, periods, body.prescribed, varying, body.bends,
    )  # fmt: skip


def _body_of_piece(body: BodyNumbers, k: int) -> BodyNumbers:
    old = body.varying
    at = old.whole.lines + PER_PIECE * (k % old.whole.pieces)
    normal = Course(old.normal_load.first, old.normal_load.terms, old.table[at + 8], old.table[at + 9])
    varying = Packed(
        old.table,
        old.whole,
        _edge(old, k),
        _course_on_line(old, old.load, at),
        _course_on_line(old, old.belt, at + 4),
        normal,
        old.keeps_stiffness,
    )
    return changed(body, body.periods, varying)


in_piece = by_variation(lambda body, k: body, _body_of_piece)
"""in_piece(body, k): body with the functions of time that hold in the k-th piece of its span."""


def _body_at(body: BodyNumbers, tau: float) -> BodyNumbers:
    varying, whole = body.varying, body.varying.whole
    k = whole.pieces * math.floor(tau / varying.table[whole.edges + whole.pieces])
    while tau >= _edge(varying, k + 1):
        k += 1
    return in_piece(body, k)


body_at = by_variation(lambda body, tau: body, _body_at)
"""body_at(body, tau): body with the functions of time that hold in the piece at this time."""


def _with_bare_table(body: Any) -> Any:
    old = body.varying
    varying = Packed(
        items_of(old.table),
        old.whole,
        old.begins,
        old.load,
        old.belt,
        old.normal_load,
        old.keeps_stiffness,
    )
    return changed(body, body.periods, varying)


bare = by_variation(lambda body: body, _with_bare_table)
"""bare(body): body with a bare pointer in place of the table. The memory lives as long as the array that
Python holds."""

quickest_of = by_variation(lambda body: body.frequency, lambda body: body.varying.whole.quickest)
"""quickest_of(body): highest circular frequency of all functions of time."""


def _without_loads(body: BodyNumbers, zero: float) -> bool:
    loads = abs(body.load_sine) + abs(body.load_cosine)
    return loads + abs(body.reference_sine) + abs(body.reference_cosine) == 0.0


_free_on_the_line = by_dimension(_without_loads, lambda body, zero: False)
is_free = by_variation(lambda body, zero: _free_on_the_line(body, zero), lambda body, zero: False)
"""is_free(body, zero): whether nothing changes in time."""


# --- the motion ---------------------------------------------------------------------------------------------------


SLIP_ROUNDING = 1e-15
"""Relative size below which slip is rounding and has no direction, as share of the velocities it is a
difference of."""


@fast
def slip(body: Any, belt_speed: float, now: Instant, v: Any) -> Any:
    """Return the slip velocity: velocity of the mass minus that of the belt."""
    return v - belt_velocity(body, belt_speed, now)


@fast
def acceleration_under(body: BodyNumbers, push: Any, pressed: float, x: Any, v: Any, rub: Any) -> Any:
    """Return the acceleration of the mass under a known load and normal load.

    rub: coefficient of friction.
    """
    return push - restoring_force(body, x, v) - pressed * rub


@fast
def acceleration(body: BodyNumbers, now: Instant, x: Any, v: Any, rub: Any) -> Any:
    """Return the acceleration of the mass; rub: coefficient of friction."""
    return acceleration_under(body, load(body, now), normal_load(body, now), x, v, rub)


@inner
def mean_friction(impulse: Any, time: float) -> Any:
    """Return the mean coefficient from the integral of the resisting friction, over the time.

    It is positive where the belt drags the mass along x1.
    """
    return -impulse / time


# --- the mass at rest on the belt ---------------------------------------------------------------------------------


@inner
def holding_force(body: BodyNumbers, belt_speed: float, now: Instant, x: Any) -> Any:
    """Return the force of friction that keeps a mass at x at rest on the belt, its first and second derivative."""
    carried = belt_velocity(body, belt_speed, now) + 0.0 * x
    pushed = belt_acceleration(body, belt_speed, now) + 0.0 * x
    jerk = belt_jerk(body, belt_speed, now) + 0.0 * x
    rate, bend = load_rates(body, now)
    beside = slopes_at(body, x, carried)
    bend = bend - _turning(body, x, carried, pushed)
    return (
        load(body, now) - restoring_force(body, x, carried) - pushed,
        rate - restoring_force(beside, carried, pushed) - jerk,
        bend - restoring_force(beside, pushed, jerk) - belt_snap(body, belt_speed, now),
    )


_belt_bound = by_variation(
    lambda body, order: 0.0, lambda body, order: wave_bound(body.varying.table, body.varying.belt, order)
)
"""_belt_bound(body, order): bound on the derivative of this order of the belt's velocity, at any time."""


def _turning_of_bends(body: BodyNumbers, x: Any, v: Any, a: Any) -> Any:
    x1, v1, bends = x.real, v.real, body.bends
    spring = 2.0 * bends.spring_2 + 6.0 * bends.spring_3 * x1 + 2.0 * bends.dashpot_2 * v1
    return (spring * v1 + 2.0 * (bends.dashpot_1 + 2.0 * bends.dashpot_2 * x1) * a.real) * v1


_turning = by_springs(lambda body, x, v, a: 0.0, _turning_of_bends)
"""_turning(body, x, v, a): second derivative of the restoring force less that of constant slopes, caused by
the change of the slopes along the motion."""

look_ahead = by_springs(lambda body: 1e300, lambda body: 0.25 / quickest_of(body))
"""look_ahead(body): time at rest within which ``holding_curvature`` at a position is valid."""


def _more_of_bends(body: BodyNumbers, belt_speed: float, x: Any) -> float:
    """Bound the share of bends in the curvature.

    The bound uses the largest position and derivatives within ``look_ahead``.
    """
    bends, v = body.bends, abs(belt_speed) + belt_swing(body)
    most, a, jerk = abs(x.real) + v * look_ahead(body), _belt_bound(body, 1), _belt_bound(body, 2)
    first, second = abs(bends.dashpot_1), abs(bends.dashpot_2)
    spring_2, spring_3 = abs(bends.spring_2), abs(bends.spring_3)
    turning = (2.0 * spring_2 + 6.0 * spring_3 * most + 2.0 * second * v) * v
    turning = (turning + 2.0 * (first + 2.0 * second * most) * a) * v
    by_spring = (2.0 * spring_2 + 3.0 * spring_3 * most) * most + (first + 2.0 * second * most) * v
    return turning + by_spring * a + (first + second * most) * most * jerk


_more = by_springs(lambda body, belt_speed, x: 0.0, _more_of_bends)


@inner
def holding_curvature(body: BodyNumbers, belt_speed: float, x: Any) -> float:
    """Return a bound on the second derivative of ``holding_force``, for a mass at x at the present time."""
    springs = (body.stiffness_mean + abs(body.stiffness_split)) * _belt_bound(body, 1)
    dashpots = (body.damping_mean + abs(body.damping_split)) * _belt_bound(body, 2)
    return load_curvature(body) + springs + dashpots + _belt_bound(body, 3) + _more(body, belt_speed, x)


GAUSS = np.array([0.0, 0.5384693101056831, 0.906179845938664])
GAUSS_WEIGHTS = np.array([0.5688888888888889, 0.47862867049936647, 0.23692688505618908])
"""Weights of Gauss quadrature with five nodes; nodes and weights from the middle on."""


@inner
def _bent_spring(body: BodyNumbers, belt_speed: float, start: float, tau: float, x: Any) -> float:
    x1 = (x + belt_path(body, belt_speed, start, tau)).real
    return (body.bends.spring_2 + body.bends.spring_3 * x1) * x1 * x1


def _impulse_of_bends(body: BodyNumbers, belt_speed: float, start: float, end: float, x: Any) -> Any:
    """Integrate dashpots as functions of the path, springs by Gauss quadrature.

    This is exact on a belt that does not vibrate, else accurate to rounding.
    """
    bends, first, last = body.bends, x.real, (x + belt_path(body, belt_speed, start, end)).real
    half, third = 0.5 * bends.dashpot_1, bends.dashpot_2 / 3.0
    impulse = (half + third * last) * last * last - (half + third * first) * first * first
    parts = _parts(body, end - start)
    step = 0.5 * (end - start) / parts
    for k in range(parts):
        middle = start + (2 * k + 1) * step
        for i in range(GAUSS.size):
            share = GAUSS_WEIGHTS[i] * step * (0.5 if i == 0 else 1.0)
            for side in (-1.0, 1.0):
                impulse += share * _bent_spring(body, belt_speed, start, middle + side * GAUSS[i] * step, x)
    return impulse


_parts = by_variation(lambda body, lasts: 1, lambda body, lasts: 1 + int(8.0 * quickest_of(body) * lasts))
_bent_impulse = by_springs(lambda body, belt_speed, start, end, x: 0.0 * x, _impulse_of_bends)
"""_bent_impulse(body, belt_speed, start, end, x): integral of the nonlinear part of the restoring force."""


@inner
def holding_impulse(body: BodyNumbers, belt_speed: float, start: float, end: float, x: Any) -> Any:
    """Return the integral of ``holding_force``; x: position at the start."""
    travel = belt_path(body, belt_speed, start, end) + 0.0 * x
    positions = (end - start) * x + belt_path_integral(body, belt_speed, start, end)
    first, last = instant_at(body, start), instant_at(body, end)
    gained = belt_velocity(body, belt_speed, last) - belt_velocity(body, belt_speed, first)
    springs = linear_force(body, positions, travel) + _bent_impulse(body, belt_speed, start, end, x)
    return load_impulse(body, start, end) - springs - gained


@inner
def resting_friction(body: BodyNumbers, belt_speed: float, start: float, end: float, x: Any) -> Any:
    """Return the integral of friction at rest, in shares of the mean normal load."""
    return holding_impulse(body, belt_speed, start, end, x) / body.normal_load


# --- the deviation from the friction-free response ----------------------------------------------------------------


class Flow(NamedTuple):
    """Law and body on a belt, side of slip on the line, sine and cosine at the anchor time."""

    law: Any
    body: BodyNumbers
    belt_speed: float
    side: float
    anchor: float
    sine: float
    cosine: float


@fast
def turned(problem: Any, tau: float) -> Any:
    """Return sine and cosine of Omega*tau from those at the anchor (Taylor, to rounding).

    The time is at most one radian from the anchor.
    """
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
    """Return the instant at time tau, at most one radian from the anchor of the problem."""
    sine, cosine = turned(problem, tau)
    return Instant(tau, sine, cosine)


@inner
def anchored(law: Any, body: BodyNumbers, belt_speed: float, side: float, tau: float) -> Flow:
    """Return the problem with its anchor at this time."""
    angle = body.frequency * tau
    return Flow(law, body, belt_speed, side, tau, math.sin(angle), math.cos(angle))


@inner
def reference_position(body: BodyNumbers, tau: float) -> Any:
    """Return the position of the friction-free response."""
    angle = body.frequency * tau
    return body.reference_sine * math.sin(angle) + body.reference_cosine * math.cos(angle)


@fast
def reference_velocity(body: BodyNumbers, sine: float, cosine: float) -> Any:
    """Return the velocity of the friction-free response."""
    return body.frequency * (body.reference_sine * cosine - body.reference_cosine * sine)


free_sine = by_springs(lambda body: body.reference_sine, lambda body: body.reference_sine + body.bends.sine)
free_cosine = by_springs(
    lambda body: body.reference_cosine, lambda body: body.reference_cosine + body.bends.cosine
)
"""free_sine(body), free_cosine(body): amplitudes of the motion without friction, approximate for bodies that
are not linear."""


@inner
def swing_of(body: BodyNumbers) -> float:
    """Return the speed of the friction-free response against the belt's mean; 1 where it has no bound."""
    swing = body.frequency * math.hypot(abs(free_sine(body)), abs(free_cosine(body))) + belt_swing(body)
    return swing if swing > 0.0 else 1.0


@inner
def _free_state_of_one_sine(body: BodyNumbers) -> Any:
    return free_cosine(body), body.frequency * free_sine(body)


def _free_state_of_waves(body: BodyNumbers) -> Any:
    x, v = _free_state_of_one_sine(body)
    whole = body.varying.whole
    return (whole.x + 0.0 * x, whole.velocity + 0.0 * v) if whole.fastest < math.inf else (x, v)


free_state = by_variation(_free_state_of_one_sine, _free_state_of_waves)
"""free_state(body): position and velocity of the motion without friction at tau = 0; if several waves drive it,
those of the first unless more is known."""
fastest_slip = by_variation(lambda body: swing_of(body), lambda body: body.varying.whole.fastest)
"""fastest_slip(body): speed of the belt above which slip without friction keeps its side; infinite if not known."""


def _pushed_away(body: BodyNumbers, x: Any) -> bool:
    """Check whether springs push outward a million times as hard as the linear one would pull back."""
    x1 = x.real
    return (body.bends.spring_2 + body.bends.spring_3 * x1) * x1 < -1e6 * body.stiffness_mean


runs_away = by_springs(lambda body, x: False, _pushed_away)
"""runs_away(body, x): whether a mass at x never comes back."""


def _bent_equilibrium(body: BodyNumbers, force: float, v: float) -> float:
    """Return the equilibrium on the side where springs stretch to hold the force.

    If there are several, it is the first one.
    """
    missing = force - linear_force(body, 0.0, v)
    side, low = math.copysign(1.0, missing), 0.0
    high = abs(missing) / (body.stiffness_mean + body.stiffness_split)
    for _ in range(120):
        if side * (restoring_force(body, side * high, v).real - force) >= 0.0:
            break
        low, high = high, 1.25 * high + 1e-300
    x = high
    for _ in range(100):
        beyond = side * (restoring_force(body, side * x, v).real - force)
        low, high = (low, x) if beyond >= 0.0 else (x, high)
        slopes = slopes_at(body, side * x, v)
        slope = slopes.stiffness_mean + slopes.stiffness_split
        trial = x - beyond / slope if slope > 0.0 else low
        trial = trial if low < trial < high else 0.5 * (low + high)
        if abs(trial - x) <= 2e-16 * x:
            break
        x = trial
    return side * x


def _linear_equilibrium(body: BodyNumbers, force: float, v: float) -> float:
    held = force - (body.damping_mean + body.damping_split) * v
    return held / (body.stiffness_mean + body.stiffness_split)


equilibrium = by_springs(_linear_equilibrium, _bent_equilibrium)
"""equilibrium(body, force, v): position at which springs along x1, and dashpots at this velocity, hold a
force."""


@inner
def balanced_load(body: BodyNumbers, now: Instant) -> Any:
    """Return the force that the reference motion takes."""
    return body.balanced_sine * now.sine + body.balanced_cosine * now.cosine


unbalanced_load = by_variation(
    lambda body, now: (
        (body.load_sine - body.balanced_sine) * now.sine
        + (body.load_cosine - body.balanced_cosine) * now.cosine
    ),
    lambda body, now: load(body, now) - balanced_load(body, now),
)
"""unbalanced_load(body, now): part of the load that drives the deviation, zero to the last bit if the reference
balances one sine."""


@inner
def unbalanced_rate(body: BodyNumbers, now: Instant) -> Any:
    """Return the derivative of ``unbalanced_load``."""
    rate, _bend = load_rates(body, now)
    return rate - body.frequency * (body.balanced_sine * now.cosine - body.balanced_cosine * now.sine)


@fast
def deviation_acceleration(body: BodyNumbers, now: Instant, y: Any, u: Any, rub: Any) -> Any:
    """Return the acceleration of the deviation; rub: coefficient of friction."""
    return acceleration_under(body, unbalanced_load(body, now), normal_load(body, now), y, u, rub)


@fast
def deviation_slip(problem: Any, now: Instant, u: Any) -> Any:
    """Return the slip velocity of a mass whose deviation has velocity u."""
    v = u + reference_velocity(problem.body, now.sine, now.cosine)
    return slip(problem.body, problem.belt_speed, now, v)


@fast
def deviation_slip_rate(problem: Any, now: Instant, a: Any) -> Any:
    """Return the derivative of the slip velocity where the deviation has acceleration a."""
    rate = a + reference_acceleration(problem.body, now.sine, now.cosine)
    return rate - belt_acceleration(problem.body, problem.belt_speed, now)


def _friction_in_lanes(problem: Flow, w: Any) -> Any:
    """Return the friction of a law with the vector of ``FrictionLaw``, along the slip."""
    speed = length(w)
    return (friction_by_lane(problem.law, speed) / speed) * w


_friction = by_dimension(
    lambda problem, w: problem.side * problem.law.sliding_friction(max(problem.side * w, 0.0)),
    lambda problem, w: problem.law.sliding_vector(w),
    _friction_in_lanes,
)


@fast_embedded
def rates(problem: Flow, tau: float, y: Any, u: Any) -> Any:
    """Return the acceleration of the deviation and the friction of a law without memory.

    Friction is in shares of the mean normal load.
    """
    now = instant_near(problem, tau)
    rub = _friction(problem, deviation_slip(problem, now, u))
    return deviation_acceleration(problem.body, now, y, u, rub), load_share(problem.body, now) * rub


@fast
def slip_at(problem: Any, tau: float, u: Any) -> Any:
    """Return the slip velocity near the anchor of a problem; u: velocity of the deviation."""
    return deviation_slip(problem, instant_near(problem, tau), u)


@fast
def slip_rate(problem: Any, tau: float, a: Any) -> Any:
    """Return the derivative of the slip velocity near the anchor; a: acceleration of the deviation."""
    return deviation_slip_rate(problem, instant_near(problem, tau), a)
