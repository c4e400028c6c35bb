"""Equation of motion: loads, normal load and belt at an instant; slip, acceleration, force at rest.

Every map, every march and every reading of energies calls these functions. Only here are load, normal load
and belt functions of time: each has its group below, with the rates, bounds and integrals that the time at
rest needs. They are sums of waves and straight lines between corners, whose numbers stand in one table.

A step of slip takes them from polynomials about its anchor: ``expand_about`` fills these into the head of the table,
and ``note_instants`` their values at all stages of a step, so that a rate reads one number a stage. The head belongs
to one motion at a time: the maps of every problem have a table of their own.

Functions of the belt also accept the numbers of a prescribed slip as ``body``. Maps follow the deviation
(y, u = y') from the harmonic reference motion of the body. Eight motions in lanes know one sine alone, whose body has
no table: where two functions are given by variation, the first is theirs.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from frictionlab.compile.decorators import fast, fast_embedded, inner
from frictionlab.compile.dispatch import (
    EMBEDDED,
    by_dimension,
    by_nearness,
    by_variation,
    compilable,
    length,
)
from frictionlab.compile.lane_arrays import friction_by_lane
from frictionlab.compile.stack import items_of
from frictionlab.motion.events import reference_acceleration
from frictionlab.motion.waves import (
    add_line,
    begin_expansion,
    belt_course,
    bend_near,
    clear,
    expand,
    integrate,
    load_course,
    note,
    noted,
    polynomial,
    polynomial_bend,
    polynomial_slope,
    press_course,
    slope_near,
    value_near,
    wave_at,
    wave_bound,
    wave_impulse,
    wave_path_integral,
    wave_rate,
)
from frictionlab.scene import body as _plain
from frictionlab.scene.body import BodyNumbers
from frictionlab.scene.varying import (
    AT_PLACE,
    AT_PUSH,
    AT_SHARE,
    AT_SWING,
    BELT_SWING,
    EDGES,
    FASTEST,
    FREE_VELOCITY,
    FREE_X,
    LINES,
    PER_PIECE,
    PERIODS,
    PIECES,
    PLACE,
    PRESSES,
    PUSH,
    PUSHES,
    QUICKEST,
    REST_FIRST,
    REST_TERMS,
    SHARE,
    SWING,
    WAVES,
    Packed,
)

linear_force = fast(_plain.restoring_force)
restoring_force = fast(compilable(_plain.bent_force))
"""restoring_force(body, x, v): force of springs and dashpots, per unit mass."""


@fast
def dissipated(body: BodyNumbers, x: Any, v: Any) -> Any:
    """Return the force of the dashpots alone, per unit mass."""
    bends = body.bends
    return linear_force(body, 0.0 * v, v) + (bends.dashpot_1 + bends.dashpot_2 * x.real) * x.real * v.real


slopes_at = fast(compilable(_plain.bent_slopes))
"""slopes_at(body, x, v): linear body whose ``restoring_force`` is that of small changes of this motion."""
span = fast(_plain.span)
planar = inner(compilable(_plain.planar_numbers))
"""planar(mass, periods): numbers of a mass as kernels have it, in the plane."""


class Instant(NamedTuple):
    """Instant of time, with sine and cosine of Omega*tau."""

    tau: float
    sine: float
    cosine: float


class Near(NamedTuple):
    """Time near the anchor of a step; part: angle of the quickest wave since then."""

    tau: float
    part: float


class Noted(NamedTuple):
    """Stage of a step: what ``note_instants`` left in the table.

    swing: slip of the reference. push: load that the reference leaves. share: normal load over its mean. place:
    way that the reference has slid since the anchor.
    """

    tau: float
    swing: Any
    push: Any
    share: float
    place: float


@inner
def instant_at(body: Any, tau: float) -> Instant:
    """Return the instant at time tau; ``body`` is any record with a frequency."""
    angle = body.frequency * tau
    return Instant(tau, math.sin(angle), math.cos(angle))


START = Instant(0.0, 0.0, 1.0)
"""Instant tau = 0, at which constants are evaluated."""


# --- the load -----------------------------------------------------------------------------------------------------


@inner
def load(body: Any, now: Instant) -> Any:
    """Return the driving force on the mass; on the line a number, in the plane x1 + i x2."""
    return wave_at(body.varying.table, load_course(body), body.varying.begins, now.tau)


@inner
def load_rates(body: Any, now: Instant) -> Any:
    """Return the first and the second derivative of the load."""
    table, course = body.varying.table, load_course(body)
    return wave_rate(table, course, now.tau, 1), wave_rate(table, course, now.tau, 2)


@inner
def load_curvature(body: Any) -> float:
    """Return a bound on the second derivative of the load, at any time."""
    return wave_bound(body.varying.table, load_course(body), 2)


@inner
def load_impulse(body: Any, start: float, end: float) -> Any:
    """Return the integral of the load."""
    return wave_impulse(body.varying.table, load_course(body), body.varying.begins, start, end)


# --- the normal load ----------------------------------------------------------------------------------------------


def _share_at(body: Any, now: Instant) -> float:
    added = wave_at(body.varying.table, press_course(body), body.varying.begins, now.tau)
    return 1.0 + added / body.normal_load


_share_at_any_time = by_variation(lambda body, now: 1.0, _share_at)


def _share_near(body: Any, now: Near) -> float:
    return polynomial(body.varying.table, SHARE, now.part) if body.varying.table[PRESSES] != 0.0 else 1.0


load_share = by_nearness(
    _share_near, lambda body, now: now.share, lambda body, now: _share_at_any_time(body, now)
)
"""load_share(body, now): normal load over its mean."""


@fast_embedded
def normal_load(body: Any, now: Any) -> float:
    """Return the force that presses the mass on the belt; friction is this times its coefficient."""
    return body.normal_load * load_share(body, now)


def _share_rate_near(body: Any, now: Near) -> float:
    table = body.varying.table
    slope = polynomial_slope(table, SHARE, now.part) if table[PRESSES] != 0.0 else 0.0
    return body.normal_load * table[QUICKEST] * slope


def _share_bend_near(body: Any, now: Near) -> float:
    table = body.varying.table
    bend = polynomial_bend(table, SHARE, now.part) if table[PRESSES] != 0.0 else 0.0
    return body.normal_load * table[QUICKEST] ** 2 * bend


normal_load_rate = by_nearness(
    _share_rate_near,
    of_any=lambda body, now: wave_rate(body.varying.table, press_course(body), now.tau, 1),
)
"""normal_load_rate(body, now): derivative of the normal load."""

normal_load_bend = by_nearness(
    _share_bend_near,
    of_any=lambda body, now: wave_rate(body.varying.table, press_course(body), now.tau, 2),
)
"""normal_load_bend(body, now): second derivative of the normal load."""


@inner
def normal_load_curvature(body: Any) -> float:
    """Return a bound on the second derivative of the normal load, at any time."""
    return wave_bound(body.varying.table, press_course(body), 2)


# --- the belt -----------------------------------------------------------------------------------------------------


@inner
def belt_velocity(body: Any, belt_speed: float, now: Instant) -> Any:
    """Return the velocity of the belt; belt_speed: its mean, along x1."""
    return belt_speed + wave_at(body.varying.table, belt_course(body), body.varying.begins, now.tau)


@inner
def belt_rate(body: Any, now: Instant, order: int) -> Any:
    """Return the derivative of this order of the belt's velocity."""
    return wave_rate(body.varying.table, belt_course(body), now.tau, order)


@inner
def belt_path(body: Any, belt_speed: float, start: float, end: float) -> Any:
    """Return the distance that the belt travels between two times of one piece."""
    swung = wave_impulse(body.varying.table, belt_course(body), body.varying.begins, start, end)
    return (end - start) * belt_speed + swung


@inner
def belt_path_integral(body: Any, belt_speed: float, start: float, end: float) -> Any:
    """Return the integral of the distance travelled since the start."""
    swung = wave_path_integral(body.varying.table, belt_course(body), body.varying.begins, start, end)
    return 0.5 * (end - start) * ((end - start) * belt_speed) + swung


@inner
def belt_advance(body: Any, belt_speed: float) -> float:
    """Return the distance that the belt travels in a span; its vibration adds nothing."""
    return span(body) * belt_speed


belt_swing = by_variation(lambda body: 0.0, lambda body: body.varying.table[BELT_SWING])
"""belt_swing(body): largest difference between the belt's speed and its mean."""


# --- pieces between corners ---------------------------------------------------------------------------------------


@inner
def pieces_of(body: Any) -> int:
    """Return the number of pieces in one span of the body; within a piece everything is smooth in time."""
    table = body.varying.table
    laps = max(1, math.floor(body.periods / table[PERIODS] + 0.5))
    return laps * int(table[PIECES])


@inner
def _edge(varying: Any, k: int) -> float:
    """Return the time at which the k-th piece since the start begins."""
    pieces, first = int(varying.table[PIECES]), int(varying.table[EDGES])
    return k // pieces * varying.table[first + pieces] + varying.table[first + k % pieces]


@inner
def piece_ends(body: Any, k: int) -> Any:
    """Return the times at which the k-th piece of a span begins and ends."""
    last = k == pieces_of(body) - 1
    return _edge(body.varying, k), span(body) if last else _edge(body.varying, k + 1)


@inner
def changed(body: BodyNumbers, periods: float, varying: Any) -> BodyNumbers:
    """Return the body with another span and other functions of time."""
    return BodyNumbers(
        body.damping_mean, body.damping_split, body.stiffness_mean, body.stiffness_split, body.normal_load,
        body.frequency, body.load_sine, body.load_cosine, body.balanced_sine, body.balanced_cosine,
        body.reference_sine, body.reference_cosine, periods, body.prescribed, varying, body.bends,
    )  # fmt: skip


@inner
def in_piece(body: BodyNumbers, k: int) -> BodyNumbers:
    """Return the body with the functions of time that hold in the k-th piece of its span."""
    old = body.varying
    at = int(old.table[LINES]) + PER_PIECE * (k % int(old.table[PIECES]))
    return changed(body, body.periods, Packed(old.table, _edge(old, k), at, old.keeps_stiffness))


@inner
def body_at(body: BodyNumbers, tau: float) -> BodyNumbers:
    """Return the body with the functions of time that hold in the piece at this time."""
    varying, pieces = body.varying, int(body.varying.table[PIECES])
    k = pieces * math.floor(tau / varying.table[int(varying.table[EDGES]) + pieces])
    while tau >= _edge(varying, k + 1):
        k += 1
    return in_piece(body, k)


@inner
def bare(body: Any, table: Any) -> Any:
    """Return the body with a bare pointer to a table, which must outlive it."""
    old = body.varying
    return changed(body, body.periods, Packed(items_of(table), old.begins, old.at, old.keeps_stiffness))


quickest_of = by_variation(lambda body: body.frequency, lambda body: body.varying.table[QUICKEST])
"""quickest_of(body): highest circular frequency of all functions of time."""


@inner
def is_free(body: BodyNumbers) -> bool:
    """Check whether nothing changes in time."""
    reference = abs(body.reference_sine) + abs(body.reference_cosine)
    return body.varying.table[WAVES] == 0.0 and body.varying.table[PIECES] == 1.0 and reference == 0.0


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


class Acting(NamedTuple):
    """Load, normal load and velocity of the belt at one time."""

    push: Any
    pressed: float
    belt: Any


@inner
def acting_at(body: BodyNumbers, belt_speed: float, tau: float) -> Acting:
    """Return what acts on the mass at time tau."""
    now = instant_at(body, tau)
    return Acting(load(body, now), normal_load(body, now), belt_velocity(body, belt_speed, now))


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
    pushed, jerk = belt_rate(body, now, 1) + 0.0 * x, belt_rate(body, now, 2) + 0.0 * x
    rate, bend = load_rates(body, now)
    beside = slopes_at(body, x, carried)
    bend = bend - _turning(body, x, carried, pushed)
    return (
        load(body, now) - restoring_force(body, x, carried) - pushed,
        rate - restoring_force(beside, carried, pushed) - jerk,
        bend - restoring_force(beside, pushed, jerk) - belt_rate(body, now, 3),
    )


@inner
def _belt_bound(body: Any, order: int) -> float:
    """Return a bound on the derivative of this order of the belt's velocity, at any time."""
    return wave_bound(body.varying.table, belt_course(body), order)


@fast
def _turning(body: BodyNumbers, x: Any, v: Any, a: Any) -> float:
    """Return the second derivative of the restoring force less that of constant slopes.

    The change of the slopes along the motion causes it.
    """
    x1, v1, bends = x.real, v.real, body.bends
    spring = 2.0 * bends.spring_2 + 6.0 * bends.spring_3 * x1 + 2.0 * bends.dashpot_2 * v1
    return (spring * v1 + 2.0 * (bends.dashpot_1 + 2.0 * bends.dashpot_2 * x1) * a.real) * v1


@inner
def look_ahead(body: BodyNumbers) -> float:
    """Return the time at rest within which ``holding_curvature`` at a position is valid."""
    return 0.25 / quickest_of(body) if len(body.bends.some) > 0 else 1e300


@inner
def _more(body: BodyNumbers, belt_speed: float, x: Any) -> float:
    """Bound the share of bends in the curvature.

    The bound uses the largest position and derivatives within ``look_ahead``.
    """
    if len(body.bends.some) == 0:
        return 0.0
    bends, v = body.bends, abs(belt_speed) + belt_swing(body)
    most, a, jerk = abs(x.real) + v * look_ahead(body), _belt_bound(body, 1), _belt_bound(body, 2)
    first, second = abs(bends.dashpot_1), abs(bends.dashpot_2)
    spring_2, spring_3 = abs(bends.spring_2), abs(bends.spring_3)
    turning = (2.0 * spring_2 + 6.0 * spring_3 * most + 2.0 * second * v) * v
    turning = (turning + 2.0 * (first + 2.0 * second * most) * a) * v
    by_spring = (2.0 * spring_2 + 3.0 * spring_3 * most) * most + (first + 2.0 * second * most) * v
    return turning + by_spring * a + (first + second * most) * most * jerk


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


@inner
def _bent_impulse(body: BodyNumbers, belt_speed: float, start: float, end: float, x: Any) -> float:
    """Integrate the nonlinear force: dashpots as functions of the path, springs by Gauss quadrature.

    This is exact on a belt that does not vibrate, else accurate to rounding.
    """
    if len(body.bends.some) == 0:
        return 0.0
    bends, first, last = body.bends, x.real, (x + belt_path(body, belt_speed, start, end)).real
    half, third = 0.5 * bends.dashpot_1, bends.dashpot_2 / 3.0
    impulse = (half + third * last) * last * last - (half + third * first) * first * first
    parts = 1 + int(8.0 * quickest_of(body) * (end - start)) if belt_swing(body) > 0.0 else 1
    step = 0.5 * (end - start) / parts
    for k in range(parts):
        middle = start + (2 * k + 1) * step
        for i in range(GAUSS.size):
            share = GAUSS_WEIGHTS[i] * step * (0.5 if i == 0 else 1.0)
            for side in (-1.0, 1.0):
                impulse += share * _bent_spring(body, belt_speed, start, middle + side * GAUSS[i] * step, x)
    return impulse


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


def _instant_by_turning(problem: Any, tau: float) -> Instant:
    sine, cosine = turned(problem, tau)
    return Instant(tau, sine, cosine)


def _instant_of_waves(problem: Any, tau: float) -> Near:
    return Near(tau, problem.body.varying.table[QUICKEST] * (tau - problem.anchor))


instant_near = by_variation(_instant_by_turning, _instant_of_waves, **EMBEDDED)
"""instant_near(problem, tau): instant at most one radian of the quickest wave from the anchor of the problem."""


def _noted_instant(problem: Any, stage: int, tau: float) -> Noted:
    table, zero = problem.body.varying.table, problem.body.reference_sine
    swing, push = noted(table, AT_SWING, stage, zero), noted(table, AT_PUSH, stage, zero)
    return Noted(tau, swing, push, table[AT_SHARE + stage], table[AT_PLACE + stage])


instant_of_stage = by_variation(
    lambda problem, stage, tau: instant_near(problem, tau), _noted_instant, **EMBEDDED
)
"""instant_of_stage(problem, stage, tau): instant of a stage of the step for which ``note_instants`` was called."""


def _note_instants(problem: Any, tau: float, h: float) -> None:
    table, zero = problem.body.varying.table, problem.body.reference_sine
    begin, step = table[QUICKEST] * (tau - problem.anchor), table[QUICKEST] * h
    note(table, SWING, AT_SWING, begin, step, zero)
    if table[PUSHES] != 0.0:
        note(table, PUSH, AT_PUSH, begin, step, zero)
    if table[PRESSES] != 0.0:
        note(table, SHARE, AT_SHARE, begin, step, 0.0)


note_instants = by_variation(lambda problem, tau, h: None, _note_instants, **EMBEDDED)
"""note_instants(problem, tau, h): leave in the table what varies, at all stages of a step."""


@fast_embedded
def note_places(problem: Any, tau: float, h: float) -> None:
    """Leave in the table how far the reference has slid, at all stages of a step."""
    table = problem.body.varying.table
    note(table, PLACE, AT_PLACE, table[QUICKEST] * (tau - problem.anchor), table[QUICKEST] * h, 0.0)


@fast_embedded
def expand_about(body: BodyNumbers, belt_speed: float, tau: float, sine: float, cosine: float) -> None:
    """Leave in the table what varies, as polynomials about a time with this sine and cosine of Omega*tau."""
    varying, zero, turn = body.varying, body.reference_sine, complex(cosine, sine)
    table, omega = varying.table, body.frequency
    unit, since = 1.0 / table[QUICKEST], tau - varying.begins
    here, rate = reference_velocity(body, sine, cosine), reference_acceleration(body, sine, cosine)
    begin_expansion(table, SWING, here, rate / omega)
    table[SWING] = table[SWING] - belt_speed
    if table[BELT_SWING] != 0.0:
        belt = belt_course(body)
        expand(table, SWING, belt.first, belt.terms, -1.0, tau, turn, zero)
        add_line(table, SWING, -(belt.value + since * belt.slope), -unit * belt.slope)
    if table[PUSHES] != 0.0:
        load = load_course(body)
        clear(table, PUSH, zero)
        expand(table, PUSH, int(table[REST_FIRST]), int(table[REST_TERMS]), 1.0, tau, turn, zero)
        add_line(table, PUSH, load.value + since * load.slope, unit * load.slope)
    if table[PRESSES] != 0.0:
        press = press_course(body)
        clear(table, SHARE, 0.0)
        expand(table, SHARE, press.first, press.terms, 1.0 / body.normal_load, tau, turn, 0.0)
        line, slope = press.value + since * press.slope, unit * press.slope
        add_line(table, SHARE, 1.0 + line / body.normal_load, slope / body.normal_load)


@inner
def expand_places(body: BodyNumbers) -> None:
    """Leave in the table the way that the reference has slid since the anchor."""
    integrate(body.varying.table, SWING, PLACE, 1.0 / body.varying.table[QUICKEST])


@fast_embedded
def anchored(law: Any, body: BodyNumbers, belt_speed: float, side: float, tau: float) -> Flow:
    """Return the problem with its anchor at this time."""
    angle = body.frequency * tau
    sine, cosine = math.sin(angle), math.cos(angle)
    expand_about(body, belt_speed, tau, sine, cosine)
    return Flow(law, body, belt_speed, side, tau, sine, cosine)


@inner
def reference_position(body: BodyNumbers, tau: float) -> Any:
    """Return the position of the friction-free response."""
    angle = body.frequency * tau
    return body.reference_sine * math.sin(angle) + body.reference_cosine * math.cos(angle)


@fast
def reference_velocity(body: BodyNumbers, sine: float, cosine: float) -> Any:
    """Return the velocity of the friction-free response."""
    return body.frequency * (body.reference_sine * cosine - body.reference_cosine * sine)


@inner
def free_sine(body: BodyNumbers) -> Any:
    """Return the amplitude of the sine in the motion without friction, approximate for bodies that bend."""
    return body.reference_sine + body.bends.sine


@inner
def free_cosine(body: BodyNumbers) -> Any:
    """Return the amplitude of the cosine."""
    return body.reference_cosine + body.bends.cosine


@inner
def swing_of(body: BodyNumbers) -> float:
    """Return the speed of the friction-free response against the belt's mean; 1 where it has no bound."""
    swing = body.frequency * math.hypot(abs(free_sine(body)), abs(free_cosine(body))) + belt_swing(body)
    return swing if swing > 0.0 else 1.0


@inner
def free_state(body: BodyNumbers) -> Any:
    """Return position and velocity of the motion without friction at tau = 0.

    If several waves drive it, those of the first unless more is known.
    """
    x, v, table = free_cosine(body), body.frequency * free_sine(body), body.varying.table
    is_known = 0.0 <= table[FASTEST] < math.inf
    return (table[FREE_X] + 0.0 * x, table[FREE_VELOCITY] + 0.0 * v) if is_known else (x, v)


@inner
def fastest_slip(body: BodyNumbers) -> float:
    """Return the speed of the belt above which slip without friction keeps its side; infinite if not known."""
    return swing_of(body) if body.varying.table[FASTEST] < 0.0 else body.varying.table[FASTEST]


@inner
def runs_away(body: BodyNumbers, x: Any) -> bool:
    """Check whether springs push outward a million times as hard as the linear one would pull back."""
    x1 = x.real
    return (body.bends.spring_2 + body.bends.spring_3 * x1) * x1 < -1e6 * body.stiffness_mean


@inner
def equilibrium(body: BodyNumbers, force: float, v: float) -> float:
    """Return the position at which springs along x1, and dashpots at this velocity, hold a force.

    It is on the side where springs stretch; if there are several, it is the first one.
    """
    missing = force - linear_force(body, 0.0, v).real
    if len(body.bends.some) == 0:
        return missing / (body.stiffness_mean + body.stiffness_split)
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


def _push_of_one_sine(body: BodyNumbers, now: Instant) -> Any:
    sine, cosine = body.load_sine - body.balanced_sine, body.load_cosine - body.balanced_cosine
    return sine * now.sine + cosine * now.cosine


def _push_near(body: Any, now: Any) -> Any:
    table, zero = body.varying.table, body.reference_sine
    return value_near(table, PUSH, now.part, zero) if table[PUSHES] != 0.0 else 0.0 * zero


unbalanced_load = by_nearness(_push_near, lambda body, now: now.push, _push_of_one_sine)
"""unbalanced_load(body, now): part of the load that drives the deviation."""


@fast
def unbalanced_rate(body: BodyNumbers, now: Near) -> Any:
    """Return the derivative of ``unbalanced_load``."""
    table, zero = body.varying.table, body.reference_sine
    return table[QUICKEST] * slope_near(table, PUSH, now.part, zero) if table[PUSHES] != 0.0 else 0.0 * zero


@fast
def deviation_acceleration(body: BodyNumbers, now: Instant, y: Any, u: Any, rub: Any) -> Any:
    """Return the acceleration of the deviation; rub: coefficient of friction."""
    return acceleration_under(body, unbalanced_load(body, now), normal_load(body, now), y, u, rub)


def _slip_of_one_sine(problem: Any, now: Instant, u: Any) -> Any:
    return u + reference_velocity(problem.body, now.sine, now.cosine) - problem.belt_speed


def _slip_near(problem: Any, now: Near, u: Any) -> Any:
    return u + value_near(problem.body.varying.table, SWING, now.part, u)


deviation_slip = by_nearness(_slip_near, lambda problem, now, u: u + now.swing, _slip_of_one_sine)
"""deviation_slip(problem, now, u): slip velocity of a mass whose deviation has velocity u."""


def _slip_rate_near(problem: Any, now: Near, a: Any) -> Any:
    table = problem.body.varying.table
    return a + table[QUICKEST] * slope_near(table, SWING, now.part, a)


deviation_slip_rate = by_nearness(
    _slip_rate_near,
    of_any=lambda problem, now, a: a + reference_acceleration(problem.body, now.sine, now.cosine),
)
"""deviation_slip_rate(problem, now, a): derivative of the slip where the deviation has acceleration a."""


@fast
def reference_jerk(problem: Any, now: Near) -> Any:
    """Return the second derivative of the slip of the reference."""
    table, zero = problem.body.varying.table, problem.body.reference_sine
    return table[QUICKEST] ** 2 * bend_near(table, SWING, now.part, zero)


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
    return rates_at(problem, instant_near(problem, tau), y, u)


@fast_embedded
def rates_at(problem: Flow, now: Any, y: Any, u: Any) -> Any:
    """Return the same at an instant."""
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
