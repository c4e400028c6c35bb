"""The period map of a sliding law: slip by DOP853, coming to rest, stick, release; on the line and in the plane.

What is integrated is the deviation (y, u = y') from the body's harmonic reference. On the line a leg keeps the
sign of its slip, so that its law is smooth across the end of the leg, and the end is found by secant steps. In
the plane friction turns with the slip and only rest itself is singular: a step never reaches further than nine
tenths of the way to rest, and what is left below the accuracy is closed by the balance of momentum.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from frictionlab.kernel import by_dimension, fast, inner, length
from frictionlab.methods.steppers.dop853 import State, stepper
from frictionlab.methods.track import Track
from frictionlab.methods.turning import reference_acceleration, turning
from frictionlab.orbit import NODES
from frictionlab.scene import Body
from frictionlab.scene import restoring_force as _restoring_force
from frictionlab.scene import span as _span

restoring_force = fast(_restoring_force)
span = fast(_span)


class Problem(NamedTuple):
    """A law and a body on a belt; the side of slip on the line; sine and cosine at the anchor time."""

    law: Any
    body: Body
    belt_speed: float
    side: float
    anchor: float
    sine: float
    cosine: float


class Mapped(NamedTuple):
    """A state after the span of the body, and what was met on the way."""

    y: Any
    u: Any
    rubbed: Any  # integral of the friction coefficient
    stuck: float  # time at rest
    closest: float  # smallest slip speed at a node
    released: float  # when rest ended last; -1: never
    steps: int  # -1: gave up


MOST_STEPS = 200_000


@fast
def turned(problem: Problem, tau: float) -> Any:
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


@inner
def _anchored(law: Any, body: Body, belt_speed: float, side: float, tau: float) -> Problem:
    angle = body.frequency * tau
    return Problem(law, body, belt_speed, side, tau, math.sin(angle), math.cos(angle))


@fast
def reference_velocity(body: Body, sine: float, cosine: float) -> Any:
    return body.frequency * (body.reference_sine * cosine - body.reference_cosine * sine)


@fast
def slip(problem: Problem, tau: float, u: Any) -> Any:
    """Slip velocity: of the mass against the belt."""
    sine, cosine = turned(problem, tau)
    return u + reference_velocity(problem.body, sine, cosine) - problem.belt_speed


def _friction_on_the_line(problem: Problem, w: float) -> Any:
    return problem.side * problem.law.sliding_friction(max(problem.side * w, 0.0))


def _friction_in_the_plane(problem: Problem, w: complex) -> Any:
    return problem.law.sliding_vector(w)


_friction = by_dimension(_friction_on_the_line, _friction_in_the_plane)


@fast
def rates(problem: Problem, tau: float, y: Any, u: Any) -> Any:
    """Acceleration of the deviation, and the friction coefficient."""
    body = problem.body
    sine, cosine = turned(problem, tau)
    rub = _friction(problem, u + reference_velocity(body, sine, cosine) - problem.belt_speed)
    force = body.force_sine * sine + body.force_cosine * cosine
    return force - restoring_force(body, y, u) - body.normal_load * rub, rub


step = stepper(rates)


@fast
def slip_rate(problem: Problem, tau: float, a: Any) -> Any:
    sine, cosine = turned(problem, tau)
    return a + reference_acceleration(problem.body, sine, cosine)


@fast
def squared(body: Body, x: Any, v: Any) -> float:
    """Twice the energy of a state."""
    elastic = body.stiffness_mean * x + body.stiffness_split * x.conjugate()
    return (elastic * x.conjugate()).real + (v * v.conjugate()).real


@inner
def growth_of(body: Body, taken: Any, accuracy: float) -> float:
    """By how much to change the step: below one, it is to be repeated (Hairer et al., 1993, II.10)."""
    fifth = squared(body, taken.x_error5, taken.v_error5)
    third = squared(body, taken.x_error3, taken.v_error3)
    if not fifth < 1e300:
        return 0.1
    if fifth == 0.0:
        return 6.0
    return _growth(fifth / math.sqrt(fifth + 0.01 * third) / accuracy)


@inner
def wary_growth_of(body: Body, taken: Any, accuracy: float) -> float:
    """The same by the fifth-order error alone: the mixture of orders does not see a layer passed in one step."""
    fifth = squared(body, taken.x_error5, taken.v_error5)
    if not fifth < 1e300:
        return 0.1
    return _growth(math.sqrt(fifth) / accuracy) if fifth > 0.0 else 6.0


@inner
def _growth(error: float) -> float:
    return min(6.0, max(0.1 if error > 1.0 else 1.0, 0.9 / math.sqrt(math.sqrt(math.sqrt(error)))))


# --- at rest on the belt ------------------------------------------------------------------------------------------


class Pull(NamedTuple):
    """What friction must hold at rest: sine*sin + cosine*cos - restoring force of the belt's motion."""

    sine: Any
    cosine: Any


@inner
def _pull(body: Body) -> Pull:
    square = body.frequency**2
    s, c = body.reference_sine, body.reference_cosine
    return Pull(
        body.force_sine + restoring_force(body, s, -body.frequency * c) - square * s,
        body.force_cosine + restoring_force(body, c, body.frequency * s) - square * c,
    )


@inner
def _held(body: Body, pull: Pull, tau: float, x: Any, belt: Any) -> Any:
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
def _held_impulse(body: Body, pull: Pull, tau: float, end: float, x: Any, belt: Any) -> Any:
    """Integral of the force of friction at rest from tau to end; x at tau."""
    middle = 0.5 * (tau + end)
    half_angle = 0.5 * body.frequency * (end - tau)
    mean = math.sin(half_angle) / half_angle if half_angle > 0.0 else 1.0
    wave = pull.sine * math.sin(body.frequency * middle) + pull.cosine * math.cos(body.frequency * middle)
    return (end - tau) * (mean * wave - restoring_force(body, x + (middle - tau) * belt, belt))


@inner
def _stick_end(body: Body, pull: Pull, tau: float, x: Any, belt: Any, limit: float, end: float) -> float:
    """First time the held force reaches the limit, or end: every step stays below a parabola that bounds it."""
    curvature = body.frequency**2 * (abs(pull.sine) + abs(pull.cosine))
    start = tau
    for _ in range(10_000):
        held, rate, _bend = _held(body, pull, tau, x + (tau - start) * belt, belt)
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
    pull, limit = _pull(body), body.normal_load * law.static_friction()
    belt = belt_speed + 0.0 * y
    period = span(body)
    drift = abs(restoring_force(body, belt, 0.0 * belt)) * period
    x, largest, samples = y + body.reference_cosine, 0.0, int(128 * max(1.0, body.periods))
    for k in range(samples):
        tau = k * period / samples
        held, _rate, _bend = _held(body, pull, tau, x + tau * belt, belt)
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


class Rest(NamedTuple):
    """How a time at rest ended: when, where, with which slip and side, and what friction did meanwhile."""

    tau: float
    x: Any
    w: Any
    side: float
    rubbed: Any
    stuck: float
    pulled: Any  # of rubbed: after release


@inner
def _rest(law: Any, body: Body, belt_speed: float, tau: float, x: Any, accuracy: float, end: float) -> Rest:
    """From rest at tau, x until slip begins, or until the end of the period."""
    belt = belt_speed + 0.0 * x
    pull = _pull(body)
    limit = body.normal_load * law.static_friction()
    held, rate, bend = _held(body, pull, tau, x, belt)
    start, stuck, rubbed = tau, 0.0, 0.0 * x
    rising = (rate * held.conjugate()).real > 0.0
    if abs(held) < limit * (1.0 - 1e-13) or (abs(held) <= limit * (1.0 + 1e-13) and not rising):
        begin = tau if abs(held) < limit * (1.0 - 1e-13) else min(end, tau + 1e-9 / body.frequency)
        tau = _stick_end(body, pull, begin, x + (begin - tau) * belt, belt, limit, end)
        stuck = tau - start
        rubbed = _held_impulse(body, pull, start, tau, x, belt) / body.normal_load
        x = x + stuck * belt
        held, rate, bend = _held(body, pull, tau, x, belt)
        if tau >= end:
            return Rest(tau, x, 0.0 * x, 0.0, rubbed, stuck, 0.0 * x)
    side = 1.0 if held.real > 0.0 else -1.0
    t, w, path = _start(law, body, accuracy, rate, bend, held)
    pulled = _held_impulse(body, pull, tau, tau + t, x, belt) - restoring_force(body, 0.0 * x, path) - w
    pulled = pulled / body.normal_load
    return Rest(tau + t, x + t * belt + path, w, side, rubbed + pulled, stuck, pulled)


# --- slip ---------------------------------------------------------------------------------------------------------


class Node(NamedTuple):
    """Where a step starts: time, state, slip and its rate."""

    tau: float
    state: State
    w: Any
    speed: float
    rate: Any


class Landing(NamedTuple):
    """A verdict on a step (or the wait until rest) and its end.

    Repeat it with h, accept it, rest after h, or accept it with the slip still lost in the rounding of the velocity.
    """

    verdict: int
    h: float
    end: State
    rubbed: Any


REPEAT, ACCEPT, REST, STILL = 0, 1, 2, 3


stop, lowest = turning(step, rates, slip, turned)


@inner
def dips(w0: complex, rate0: complex, w1: complex, rate1: complex, h: float) -> bool:
    """Whether the slip comes much closer to rest between two nodes than at either (cubic Hermite, in the plane)."""
    close = 0.0625 * min(w0.real**2 + w0.imag**2, w1.real**2 + w1.imag**2)
    for s in (0.25, 0.5, 0.75):
        r = 1.0 - s
        w = r * r * (1.0 + 2.0 * s) * w0 + s * s * (1.0 + 2.0 * r) * w1 + s * r * h * (r * rate0 - s * rate1)
        if w.real**2 + w.imag**2 < close:
            return True
    return False


@inner
def _state(problem: Problem, tau: float, y: Any, u: Any) -> State:
    a, f = rates(problem, tau, y, u)
    return State(y, u, a, f)


def _before_on_the_line(problem: Problem, node: Node, accuracy: float, h: float, y: float) -> Landing:
    return Landing(ACCEPT, h, node.state, y)


def _before_in_the_plane(problem: Problem, node: Node, accuracy: float, h: float, y: complex) -> Landing:
    """How far the step may go towards rest; where rest is nearer than the accuracy, go there."""
    body, w = problem.body, node.w
    speed = node.speed
    closing = -(node.rate * w.conjugate()).real / speed
    limit = body.normal_load * problem.law.sliding_friction(0.0)
    if speed < math.sqrt(accuracy * limit) or speed < 1e-2 * accuracy:
        pull, belt = _pull(body), complex(problem.belt_speed)
        x = y + reference(body, node.tau)
        held, rate, _bend = _held(body, pull, node.tau, x, belt)
        margin = limit - abs(held)
        sure = speed * speed < 0.1 * accuracy * margin and 10.0 * speed * abs(rate) < margin * abs(margin)
        if sure or speed <= 1e-2 * accuracy:
            wait = speed / (limit - (held * w.conjugate()).real / speed) if sure else 0.0
            end = node.tau + wait
            path = 0.5 * wait * w
            rubbed = (w + _held_impulse(body, pull, node.tau, end, x, belt)) / body.normal_load
            y = x + wait * belt + path - reference(body, end)
            return Landing(REST, wait, State(y, w, w, w), rubbed)
    h = min(h, 4.0 * speed / limit)  # slip turns towards the force at the rate limit/speed: stay stable
    return Landing(ACCEPT, min(h, 0.9 * speed / closing) if closing > 0.0 else h, node.state, y)


_before = by_dimension(_before_on_the_line, _before_in_the_plane)


def _after_on_the_line(
    problem: Problem, node: Node, leaving: bool, taken: Any, h: float, y: float
) -> Landing:
    """Whether the slip velocity passed through zero, between the nodes included."""
    side, state, limit = problem.side, node.state, h
    after = side * slip(problem, node.tau + h, taken.v)
    if after <= 0.0 and leaving and after >= -1e-15 * (abs(taken.v) + abs(problem.belt_speed)):
        return Landing(STILL, h, _state(problem, node.tau + h, taken.x, taken.v), taken.rubbed)
    if after <= 0.0 and leaving:
        return Landing(REPEAT if h * problem.body.frequency > 1e-12 else REST, 0.25 * h, state, 0.0)
    a, f = rates(problem, node.tau + h, taken.x, taken.v)
    if after > 0.0 and not leaving and side * node.rate < 0.0 < side * slip_rate(problem, node.tau + h, a):
        limit = lowest(problem, node.tau, state, side * node.rate, h)
        after = side * slip(problem, node.tau + limit, step(problem, node.tau, state, limit).v)
    if after <= 0.0:
        h, taken = stop(problem, node.tau, state, 0.0, limit)
        return Landing(REST, h, State(taken.x, taken.v, taken.v, taken.v), taken.rubbed)
    return Landing(ACCEPT, h, State(taken.x, taken.v, a, f), taken.rubbed)


def _after_in_the_plane(
    problem: Problem, node: Node, leaving: bool, taken: Any, h: float, y: complex
) -> Landing:
    """Whether the slip came close to rest between the nodes: then the step was too long."""
    after = slip(problem, node.tau + h, taken.v)
    a, f = rates(problem, node.tau + h, taken.x, taken.v)
    if dips(node.w, node.rate, after, slip_rate(problem, node.tau + h, a), h):
        return Landing(REPEAT, 0.5 * h, node.state, y)
    return Landing(ACCEPT, h, State(taken.x, taken.v, a, f), taken.rubbed)


_after = by_dimension(_after_on_the_line, _after_in_the_plane)


@inner
def reach_of(body: Body, sliding: float, accuracy: float) -> float:
    """The longest step: a radian of the loads or of the body's quickest oscillation, less for finer maps.

    Were it the same for all, two maps could agree because both are limited by it, and neither be accurate.
    """
    stiffest = body.stiffness_mean + abs(body.stiffness_split)
    radian = min(1.0 / body.frequency, 1.0 / math.sqrt(stiffest))
    return radian * min(1.0, 2.4 * (accuracy / (body.normal_load * sliding)) ** 0.125)


@inner
def reference(body: Body, tau: float) -> Any:
    angle = body.frequency * tau
    return body.reference_sine * math.sin(angle) + body.reference_cosine * math.cos(angle)


# --- the record of an orbit ---------------------------------------------------------------------------------------


@inner
def _note_slip(track: Track, problem: Problem, node: Node, h: float) -> None:
    row = track.filled[0]
    if row == track.stick.size:
        return
    for k in range(NODES.size):
        part = 0.5 * h * (1.0 + NODES[k])
        taken = step(problem, node.tau, node.state, part)
        tau = node.tau + part
        sine, cosine = turned(problem, tau)
        _a, f = rates(problem, tau, taken.x, taken.v)
        track.tau[row, k] = tau
        track.x[row, k] = (
            taken.x + problem.body.reference_sine * sine + problem.body.reference_cosine * cosine
        )
        track.v[row, k] = taken.v + reference_velocity(problem.body, sine, cosine)
        track.friction[row, k] = f
    track.stick[row] = False
    track.filled[0] = row + 1


@inner
def _note_stick(track: Track, problem: Problem, tau: float, end: float, x: Any) -> None:
    row = track.filled[0]
    if row == track.stick.size:
        return
    belt = problem.belt_speed + 0.0 * x
    pull = _pull(problem.body)
    for k in range(NODES.size):
        part = 0.5 * (end - tau) * (1.0 + NODES[k])
        held, _rate, _bend = _held(problem.body, pull, tau + part, x + part * belt, belt)
        track.tau[row, k] = tau + part
        track.x[row, k] = x + part * belt
        track.v[row, k] = belt
        track.friction[row, k] = held / problem.body.normal_load
    track.stick[row] = True
    track.filled[0] = row + 1


@inner
def _note_hop(
    track: Track, problem: Problem, tau: float, end: float, x: Any, w: Any, change: Any, rub: Any
) -> None:
    """The short while next to rest that is closed by momentum: slip w changes evenly, friction is its mean."""
    row = track.filled[0]
    if row == track.stick.size:
        return
    for k in range(NODES.size):
        share = 0.5 * (1.0 + NODES[k])
        part = (end - tau) * share
        track.tau[row, k] = tau + part
        track.x[row, k] = x + part * (problem.belt_speed + w + 0.5 * share * change)
        track.v[row, k] = problem.belt_speed + w + share * change
        track.friction[row, k] = rub
    track.stick[row] = False
    track.filled[0] = row + 1


@inner
def period_map(
    law: Any, body: Body, belt_speed: float, y: Any, u: Any, accuracy: float, track: Track
) -> Mapped:
    """One span from the deviation (y, u) at tau = 0; accuracy is each step's, in the norm of energy.

    On a track with room every piece of the way is noted.
    """
    end = span(body)
    room = track.stick.size
    reach = reach_of(body, law.sliding_friction(0.0), accuracy)
    tau, h, steps = 0.0, 0.1 * reach, 0
    rubbed, stuck, closest, released = 0.0 * y, 0.0, 1e300, -1.0
    w = slip(_anchored(law, body, belt_speed, 1.0, 0.0), 0.0, u)
    problem = _anchored(law, body, belt_speed, 1.0 if w.real > 0.0 else -1.0, 0.0)
    resting, leaving = abs(w) <= 1e-2 * accuracy, False
    state = State(y, u, u, u)
    if not resting:
        state = _state(problem, tau, y, u)
    while end - tau > 4e-15 * end:  # slip cannot get away from rest in less
        if resting:
            rest = _rest(law, body, belt_speed, tau, state.x + reference(body, tau), accuracy, end)
            rubbed = rubbed + rest.rubbed
            stuck += rest.stuck
            if room > 0:
                x, slips = state.x + reference(body, tau), tau + rest.stuck
                if rest.stuck > 0.0:
                    _note_stick(track, problem, tau, slips, x)
                if rest.tau > slips:
                    rub = rest.pulled / (rest.tau - slips)
                    x = x + rest.stuck * belt_speed
                    _note_hop(track, problem, slips, rest.tau, x, 0.0 * rest.w, rest.w, rub)
            if rest.stuck > 0.0 and rest.tau < end:
                released = tau + rest.stuck
            tau, resting, leaving, closest = rest.tau, False, True, 0.0
            problem = _anchored(law, body, belt_speed, rest.side, tau)
            u = rest.w + belt_speed - reference_velocity(body, problem.sine, problem.cosine)
            state = State(rest.x - reference(body, tau), u, u, u)
            if tau < end:
                state = _state(problem, tau, state.x, u)
            h = 0.1 * reach
            continue
        problem = _anchored(law, body, belt_speed, problem.side, tau)
        w = slip(problem, tau, state.v)
        node = Node(tau, state, w, length(w), slip_rate(problem, tau, state.a))
        closest = min(closest, node.speed)
        done = _before(problem, node, accuracy, min(h, reach, end - tau), state.x)
        if done.verdict == REST:
            if room > 0 and done.h > 0.0:
                x, rub = state.x + reference(body, tau), done.rubbed / done.h
                _note_hop(track, problem, tau, tau + done.h, x, node.w, -node.w, rub)
        else:
            h = done.h
            taken = step(problem, tau, state, h)
            steps += 1
            growth = growth_of(body, taken, accuracy)
            if steps > MOST_STEPS:
                return Mapped(state.x, state.v, rubbed, stuck, closest, released, -1)
            if growth < 1.0:
                h = h * growth
                continue
            done = _after(problem, node, leaving, taken, h, state.x)
            if done.verdict == REPEAT:
                h = done.h
                continue
            if room > 0:
                _note_slip(track, problem, node, done.h)
            h = h * growth
        resting, leaving = done.verdict == REST, done.verdict == STILL
        rubbed = rubbed + done.rubbed
        state = done.end
        tau = tau + done.h if end - tau > done.h else end
    return Mapped(state.x, state.v, rubbed, stuck, closest, released, steps)
