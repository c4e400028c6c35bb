"""The period map of any bristle law, on the line and in the plane: mass and bristle together by Rodas5P.

However stiff the contact, steps follow the motion: the bristle is solved for implicitly, with difference quotients of
the law's own rate and friction. On the line a step ends where slip reverses, in the plane where unloading begins or
ends: there a law may have a corner. What is integrated is the deviation from the body's harmonic reference.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from frictionlab.compile.decorators import inner
from frictionlab.compile.dispatch import by_dimension
from frictionlab.dynamics.contact import resistance
from frictionlab.dynamics.events import dips, reference_acceleration
from frictionlab.dynamics.motion import (
    belt_acceleration,
    belt_path,
    deviation_acceleration,
    deviation_slip,
    deviation_slip_rate,
    instant_near,
    normal_load,
    reference_velocity,
    slip_at,
    span,
    turned,
    unbalanced_rate,
)
from frictionlab.dynamics.step_size import growth_factor, longest_step
from frictionlab.laws.memory import VECTORIAL
from frictionlab.methods.periodic.maps.path import Carried, share_of_the_way
from frictionlab.methods.periodic.maps.sliding import MOST_STEPS
from frictionlab.numerics.steppers.rodas5p import (
    COUPLINGS,
    GAMMA,
    INCREMENTS,
    SLOPES,
    STAGES,
    TIMES,
    factored,
    solved,
)
from frictionlab.orbit.panels import NODES
from frictionlab.orbit.recorder import Track
from frictionlab.scene.body import Body

COARSEST = 1e-4
"""Of a step, per unit of friction impulse in a radian: what is coarser jumps over reversals."""


@inner
def coarsest(law: Any, body: Body) -> float:
    """The coarsest accuracy a map is made with, whatever is asked: two coarser maps are one and the same."""
    return COARSEST * body.normal_load * law.sliding_friction(0.0) / body.frequency


class Problem(NamedTuple):
    """A law and a body on a belt; sine and cosine at the anchor time.

    side: of slip, on the line; in the plane -1 where the bristle only follows the slip, 1 where it gives way, 0 where
    a law has no corner between the two. limit: deflection at which the law yields, 0 for none; radius: of the circle
    the deflection moves on, 0 where it moves freely. No infinity is met where arithmetic is quick.
    """

    law: Any
    body: Body
    belt_speed: float
    side: float
    limit: float
    radius: float
    anchor: float
    sine: float
    cosine: float


class Work(NamedTuple):
    """Room for one step: states are [position, velocity, deflection, integral of friction], each of d numbers."""

    at: Any  # [4d] where the step starts
    k: Any  # [stages, 4d] increments
    stage: Any  # [4d]
    rates: Any  # [4d]
    slope: Any  # [4d] derivative of the rates with respect to time
    end: Any  # [4d] where the step ends
    matrix: Any  # [2d, 2d]
    right: Any  # [2d]
    rows: Any  # [2d]
    by: Any  # [4d, d] rate by slip and by deflection, friction by slip and by deflection
    drag: Any  # [2, d] damping and stiffness of the body
    weight: float  # stiffness of the contact, of a deflection in the norm of energy


@inner
def _work(body: Body, weight: float, d: int) -> Work:
    drag = np.empty((2, d))
    drag[0, 0] = body.damping_mean + body.damping_split
    drag[1, 0] = body.stiffness_mean + body.stiffness_split
    if d == 2:
        drag[0, 1] = body.damping_mean - body.damping_split
        drag[1, 1] = body.stiffness_mean - body.stiffness_split
    n = 4 * d
    return Work(
        np.zeros(n),
        np.zeros((STAGES, n)),
        np.zeros(n),
        np.zeros(n),
        np.zeros(n),
        np.zeros(n),
        np.zeros((2 * d, 2 * d)),
        np.zeros(2 * d),
        np.zeros(2 * d, np.int64),
        np.zeros((n, d)),
        drag,
        weight,
    )


def _dimension_of_the_line(like: float) -> int:
    return 1


def _dimension_of_the_plane(like: complex) -> int:
    return 2


dimension = by_dimension(_dimension_of_the_line, _dimension_of_the_plane)


def _taken_on_the_line(values: Any, place: int, like: float) -> float:
    return values[place]


def _taken_in_the_plane(values: Any, place: int, like: complex) -> complex:
    return complex(values[2 * place], values[2 * place + 1])


taken = by_dimension(_taken_on_the_line, _taken_in_the_plane)


def _put_on_the_line(values: Any, place: int, number: float) -> None:
    values[place] = number


def _put_in_the_plane(values: Any, place: int, number: complex) -> None:
    values[2 * place], values[2 * place + 1] = number.real, number.imag


put = by_dimension(_put_on_the_line, _put_in_the_plane)


@inner
def _anchored(law: Any, body: Body, belt_speed: float, side: float, radius: float, tau: float) -> Problem:
    angle, limit = body.frequency * tau, law.yield_deflection()
    limit = limit if limit < math.inf else 0.0
    return Problem(law, body, belt_speed, side, limit, radius, tau, math.sin(angle), math.cos(angle))


def _felt_on_the_line(problem: Problem, w: float, z: float) -> Any:
    return resistance(problem.law, w, z)


def _felt_in_the_plane(problem: Problem, w: complex, z: complex) -> Any:
    if problem.side < 0.0:  # difference quotients at its end must not see what comes after
        return w, problem.law.friction(w, z, w)
    if problem.radius > 0.0:  # on the circle, not a rounding error inside it
        z = z * (problem.radius * (1.0 + 1e-15) / abs(z))
    return resistance(problem.law, w, z)


felt = by_dimension(_felt_on_the_line, _felt_in_the_plane)


@inner
def _rates(problem: Problem, tau: float, state: Any, out: Any, like: Any) -> Any:
    """The rate of a state; returns its slip and the slip's rate."""
    now = instant_near(problem, tau)
    y, u = taken(state, 0, like), taken(state, 1, like)
    w = deviation_slip(problem, now, u)
    dz, rub = felt(problem, w, taken(state, 2, like))
    a = deviation_acceleration(problem.body, now, y, u, rub)
    put(out, 0, u)
    put(out, 1, a)
    put(out, 2, dz)
    put(out, 3, rub)
    return w, deviation_slip_rate(problem, now, a)


class Steps(NamedTuple):
    """How far slip and deflection are moved for a difference quotient."""

    slip: float
    deflection: float


def _away_on_the_line(problem: Problem, steps: Steps, z: float, w: float) -> float:
    """Slip far enough from its reversal for a quotient on its own side."""
    return problem.side * max(problem.side * w, 2.0 * steps.slip)


def _away_in_the_plane(problem: Problem, steps: Steps, z: complex, w: complex) -> complex:
    """Slip far enough from the corner where unloading begins."""
    size = abs(z)
    if problem.side <= 0.0 or size == 0.0:
        return w
    along = (z * w.conjugate()).real / size
    return w + max(2.0 * steps.slip - along, 0.0) * (z / size)


away = by_dimension(_away_on_the_line, _away_in_the_plane)


def _unit_on_the_line(column: int, like: float) -> float:
    return 1.0


def _unit_in_the_plane(column: int, like: complex) -> complex:
    return complex(1.0, 0.0) if column == 0 else complex(0.0, 1.0)


unit = by_dimension(_unit_on_the_line, _unit_in_the_plane)


@inner
def _differentiate(problem: Problem, tau: float, steps: Steps, work: Work, like: Any) -> None:
    """Central quotients of the law at the start of the step, and the slope of the rates in time."""
    d = dimension(like)
    body = problem.body
    z = taken(work.at, 2, like)
    w = away(problem, steps, z, slip_at(problem, tau, taken(work.at, 1, like)))
    pair = np.empty(2 * d)
    for column in range(d):
        shift = steps.slip * unit(column, like)
        ahead, behind = felt(problem, w + shift, z), felt(problem, w - shift, z)
        put(pair, 0, (ahead[0] - behind[0]) / (2.0 * steps.slip))
        put(pair, 1, (ahead[1] - behind[1]) / (2.0 * steps.slip))
        for row in range(d):
            work.by[row, column], work.by[2 * d + row, column] = pair[row], pair[d + row]
        shift = steps.deflection * unit(column, like)
        ahead, behind = felt(problem, w, z + shift), felt(problem, w, z - shift)
        put(pair, 0, (ahead[0] - behind[0]) / (2.0 * steps.deflection))
        put(pair, 1, (ahead[1] - behind[1]) / (2.0 * steps.deflection))
        for row in range(d):
            work.by[d + row, column], work.by[3 * d + row, column] = pair[row], pair[d + row]
    now = instant_near(problem, tau)
    carried = belt_acceleration(body, problem.belt_speed, now)
    put(pair, 0, reference_acceleration(body, now.sine, now.cosine) - carried + 0.0 * like)
    put(pair, 1, unbalanced_rate(body, now) + 0.0 * like)
    for row in range(d):
        by_slip, rub_by_slip = 0.0, 0.0
        for column in range(d):
            by_slip += work.by[row, column] * pair[column]
            rub_by_slip += work.by[2 * d + row, column] * pair[column]
        work.slope[row] = 0.0
        work.slope[d + row] = pair[d + row] - normal_load(body, now) * rub_by_slip
        work.slope[2 * d + row] = by_slip
        work.slope[3 * d + row] = rub_by_slip


@inner
def _factor(body: Body, pressed: float, h: float, work: Work) -> None:
    """The matrix of a step for velocity and deflection; position and friction's integral follow from them."""
    d = work.drag.shape[1]
    for row in range(d):
        for column in range(d):
            work.matrix[row, column] = pressed * work.by[2 * d + row, column]
            work.matrix[row, d + column] = pressed * work.by[3 * d + row, column]
            work.matrix[d + row, column] = -work.by[row, column]
            work.matrix[d + row, d + column] = -work.by[d + row, column]
        diagonal = 1.0 / (GAMMA * h)
        work.matrix[row, row] = (
            work.matrix[row, row] + diagonal + work.drag[0, row] + GAMMA * h * work.drag[1, row]
        )
        work.matrix[d + row, d + row] = work.matrix[d + row, d + row] + diagonal
    factored(work.matrix, work.rows)


@inner
def _stepped(problem: Problem, tau: float, h: float, work: Work, like: Any) -> float:
    """One step from ``work.at`` to ``work.end``; returns its error in the norm of energy, with friction's impulse."""
    body = problem.body
    d = work.drag.shape[1]
    n = 4 * d
    _factor(body, normal_load(body, instant_near(problem, tau)), h, work)
    for i in range(STAGES):
        for row in range(n):
            total = work.at[row]
            for j in range(i):
                total += INCREMENTS[i, j] * work.k[j, row]
            work.stage[row] = total
        _rates(problem, tau + TIMES[i] * h, work.stage, work.rates, like)
        for row in range(n):
            total = 0.0
            for j in range(i):
                total += COUPLINGS[i, j] * work.k[j, row]
            work.rates[row] = work.rates[row] + h * SLOPES[i] * work.slope[row] + total / h
        for row in range(d):
            work.right[row] = work.rates[d + row] - GAMMA * h * work.drag[1, row] * work.rates[row]
            work.right[d + row] = work.rates[2 * d + row]
        solved(work.matrix, work.rows, work.right)
        for row in range(d):
            rub = work.rates[3 * d + row]
            for column in range(d):
                rub += work.by[2 * d + row, column] * work.right[column]
                rub += work.by[3 * d + row, column] * work.right[d + column]
            work.k[i, row] = GAMMA * h * (work.rates[row] + work.right[row])
            work.k[i, d + row] = work.right[row]
            work.k[i, 2 * d + row] = work.right[d + row]
            work.k[i, 3 * d + row] = GAMMA * h * rub
    last = work.k[STAGES - 1]
    error = 0.0
    for row in range(d):
        error += work.drag[1, row] * last[row] ** 2 + last[d + row] ** 2
        error += work.weight * last[2 * d + row] ** 2
        error += (body.normal_load * last[3 * d + row]) ** 2
    for row in range(n):
        work.end[row] = work.stage[row] + last[row]
    return math.sqrt(error)


# --- corners ------------------------------------------------------------------------------------------------------


def _corner_on_the_line(problem: Problem, tau: float, state: Any, like: float) -> float:
    """Positive until slip reverses."""
    return problem.side * slip_at(problem, tau, state[1])


def _corner_in_the_plane(problem: Problem, tau: float, state: Any, like: complex) -> float:
    """Positive until unloading begins (side 1) or ends (-1), or until the deflection is as large as it may be."""
    z = taken(state, 2, like)
    if problem.side < 0.0 and problem.limit > 0.0:
        return problem.limit * (1.0 + 1e-12) - abs(z)  # past rounding: it has just left the circle
    w = slip_at(problem, tau, taken(state, 1, like))
    return problem.side * (z * w.conjugate()).real


corner = by_dimension(_corner_on_the_line, _corner_in_the_plane)


@inner
def _located(problem: Problem, tau: float, before: float, high: float, work: Work, like: Any) -> float:
    """Step size at which the corner lies that a step of ``high`` passes; leaves that step in ``work.end``."""
    low, h, at_low = 0.0, high, max(before, 0.0)
    at_high = corner(problem, tau + high, work.end, like)
    for turn in range(60):
        if high - low <= 4e-16 * (tau + high) or at_high == 0.0:
            break
        h = low + (high - low) * (at_low / (at_low - at_high) if at_low > at_high else 0.5)
        if turn % 3 == 2 or not low < h < high:
            h = 0.5 * (low + high)
        _stepped(problem, tau, h, work, like)
        value = corner(problem, tau + h, work.end, like)
        if value > 0.0:
            low, at_low = h, value
        else:
            high, at_high = h, value
    _stepped(problem, tau, high, work, like)
    return high


class Ends(NamedTuple):
    """Slip and its rate at both ends of a step."""

    w0: Any
    rate0: Any
    w1: Any
    rate1: Any


def _hidden_on_the_line(problem: Problem, tau: float, h: float, ends: Ends, work: Work, like: float) -> float:
    """A smaller step at whose end slip has passed zero, where it does so and comes back within h; else 0."""
    side = 1.0 if ends.w0 >= 0.0 else -1.0
    at_low, at_high = side * ends.rate0, side * ends.rate1
    if not at_low < 0.0 < at_high or ends.w0 == 0.0:
        return 0.0
    low, high, out = 0.0, h, np.empty(4)
    for turn in range(40):
        middle = 0.5 * (low + high)
        if turn % 3 < 2:
            middle = low + (high - low) * (at_low / (at_low - at_high))
        _stepped(problem, tau, middle, work, like)
        w, value = _rates(problem, tau + middle, work.end, out, like)
        if side * w <= 0.0:
            return middle
        if side * value > 0.0:
            high, at_high = middle, side * value
        else:
            low, at_low = middle, side * value
        if high - low < 1e-13 * h or side * w > 2.0 * (high - low) * max(-at_low, at_high):
            break  # at these slopes it cannot reach zero in what is left
    _stepped(problem, tau, h, work, like)
    return 0.0


def _hidden_in_the_plane(
    problem: Problem, tau: float, h: float, ends: Ends, work: Work, like: complex
) -> float:
    """Minus half the step, where slip comes much closer to rest within it than at its ends; else 0."""
    return -0.5 * h if dips(ends.w0, ends.rate0, ends.w1, ends.rate1, h) else 0.0


hidden = by_dimension(_hidden_on_the_line, _hidden_in_the_plane)


def _side_on_the_line(problem: Problem, tau: float, work: Work, like: float) -> float:
    """The direction in which slip goes on."""
    w, rate = _rates(problem, tau, work.at, work.rates, like)
    return 1.0 if w > 0.0 or (w == 0.0 and rate >= 0.0) else -1.0


def _side_in_the_plane(problem: Problem, tau: float, work: Work, like: complex) -> float:
    """1 where the bristle is being loaded (at its yield limit, where it has one), else -1; 0 without corners."""
    if not problem.law.elastic_unloading() or problem.law.form != VECTORIAL:
        return 0.0
    z = taken(work.at, 2, like)
    w, _rate = _rates(problem, tau, work.at, work.rates, like)
    loads = (z * w.conjugate()).real > 0.0
    return 1.0 if loads and abs(z) >= problem.limit * (1.0 - 1e-13) else -1.0


side_of = by_dimension(_side_on_the_line, _side_in_the_plane)


def _circle_on_the_line(problem: Problem, work: Work, like: float) -> float:
    return 0.0


def _circle_in_the_plane(problem: Problem, work: Work, like: complex) -> float:
    """Radius on which a bristle moves that is loaded at its yield limit; puts it there."""
    if not (problem.side > 0.0 and problem.limit > 0.0):
        return 0.0
    z = taken(work.at, 2, like)
    put(work.at, 2, z * (problem.limit / abs(z)))
    return problem.limit


circle = by_dimension(_circle_on_the_line, _circle_in_the_plane)


def _relative_on_the_line(problem: Problem, tau: float, work: Work, like: float) -> float:
    sine, cosine = turned(problem, tau)
    body = problem.body
    swung = work.at[0] + body.reference_sine * sine + body.reference_cosine * cosine
    return swung - belt_path(body, problem.belt_speed, 0.0, tau)


def _relative_in_the_plane(problem: Problem, tau: float, work: Work, like: complex) -> float:
    """Only on the line does a reversal begin a leg."""
    return 0.0


relative = by_dimension(_relative_on_the_line, _relative_in_the_plane)


def _longest_on_the_line(w: float, rate: float, ahead: float, like: float) -> float:
    """The longest step that does not slide further than this."""
    return 2.0 * ahead / (abs(w) + math.sqrt(w * w + 2.0 * abs(rate) * ahead) + 1e-300)


def _longest_in_the_plane(w: complex, rate: complex, ahead: float, like: complex) -> float:
    return 1e300


longest = by_dimension(_longest_on_the_line, _longest_in_the_plane)

# --- the way through a period -------------------------------------------------------------------------------------


@inner
def _note(track: Track, problem: Problem, tau: float, h: float, work: Work, like: Any) -> None:
    row = track.filled[0]
    if row == track.stick.size:
        return
    body = problem.body
    for k in range(NODES.size):
        part = 0.5 * h * (1.0 + NODES[k])
        if part > 0.0:
            _stepped(problem, tau, part, work, like)
        state = work.end if part > 0.0 else work.at
        _rates(problem, tau + part, state, work.rates, like)
        sine, cosine = turned(problem, tau + part)
        track.tau[row, k] = tau + part
        track.x[row, k] = taken(state, 0, like) + body.reference_sine * sine + body.reference_cosine * cosine
        track.v[row, k] = taken(state, 1, like) + reference_velocity(body, sine, cosine)
        track.friction[row, k] = taken(work.rates, 3, like)
    track.stick[row] = False
    track.filled[0] = row + 1


@inner
def bristle_map(
    law: Any, body: Body, belt_speed: float, y: Any, u: Any, z: Any, accuracy: float, track: Track
) -> Carried:
    """One span from the deviation (y, u) and deflection z at tau = 0; accuracy is each step's, in the energy norm.

    On a track with room every piece of the way is noted.
    """
    end, length = span(body), law.largest_deflection()
    accuracy = min(accuracy, coarsest(law, body))
    reach = longest_step(body, law.sliding_friction(0.0), accuracy)
    ahead = share_of_the_way(law, body, accuracy)
    swing = body.frequency * (abs(body.reference_sine) + abs(body.reference_cosine)) + abs(belt_speed)
    weight = body.normal_load * abs(law.friction(0.0, length, 0.0)) / length
    work = _work(body, weight, dimension(y))
    put(work.at, 0, y)
    put(work.at, 1, u)
    put(work.at, 2, z)
    problem = _anchored(law, body, belt_speed, 0.0, 0.0, 0.0)
    side = side_of(problem, 0.0, work, y)
    problem = _anchored(law, body, belt_speed, side, 0.0, 0.0)
    radius = circle(problem, work, y)
    tau, h, steps, closest = 0.0, 0.1 * reach, 0, 1e300
    leaving, fresh, began, covered = True, True, 0.0, math.inf
    w0, rate0 = _rates(problem, 0.0, work.at, work.rates, y)
    before = 0.0
    while end - tau > 4e-15 * end:
        if fresh:
            problem = _anchored(law, body, belt_speed, side, radius, tau)
            w0, rate0 = _rates(problem, tau, work.at, work.rates, y)
            closest = min(closest, abs(w0))
            away_from = Steps(1e-5 * abs(w0) + 1e-9 * (swing + abs(w0)), 1e-5 * length)
            _differentiate(problem, tau, away_from, work, y)
            before = corner(problem, tau, work.at, y)
            if covered < 40.0 * length:
                covered = abs(relative(problem, tau, work, y) - began)
                h = min(h, longest(w0, rate0, ahead * max(length, covered), y))
            fresh = False
        h = min(h, reach, end - tau)
        growth = growth_factor(_stepped(problem, tau, h, work, y) / accuracy, 5.0)
        steps += 1
        if steps > MOST_STEPS:
            return Carried(y, u, z, y, closest, -1)
        if growth < 1.0:
            h = h * growth
            continue
        turns = False
        after = corner(problem, tau + h, work.end, y) if side != 0.0 else 1.0
        if after <= 0.0 and leaving and before <= -1e-3 * after:
            if h * body.frequency > 1e-12:
                h = 0.25 * h
                continue
            turns = True  # it does not get away on this side
        elif after <= 0.0:
            h = _located(problem, tau, before, h, work, y)
            turns = True
        else:
            w1, rate1 = _rates(problem, tau + h, work.end, work.rates, y)
            inside = hidden(problem, tau, h, Ends(w0, rate0, w1, rate1), work, y) if not leaving else 0.0
            if inside < 0.0:
                h = -inside
                continue
            if inside > 0.0:
                _stepped(problem, tau, inside, work, y)
                h = _located(problem, tau, before, inside, work, y)
                turns = True
        if track.stick.size > 0:
            _note(track, problem, tau, h, work, y)
            _stepped(problem, tau, h, work, y)
        for row in range(work.at.size):
            work.at[row] = work.end[row]
        tau = tau + h if end - tau > h else end
        radius = circle(problem, work, y)
        leaving, fresh = turns, True
        h = h * growth
        if turns:
            side = -side
            problem = _anchored(law, body, belt_speed, side, 0.0, tau)
            radius = circle(problem, work, y)
            problem = _anchored(law, body, belt_speed, side, radius, tau)
            began, covered = relative(problem, tau, work, y), 0.0
            h = reach
    return Carried(
        taken(work.at, 0, y), taken(work.at, 1, y), taken(work.at, 2, y), taken(work.at, 3, y), closest, steps
    )
