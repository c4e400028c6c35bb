"""Period map of a sliding law: slip by DOP853, coming to rest, stick, release; on the line and in the plane.

The map integrates the deviation (y, u = y') from the harmonic reference of the body. On the line a leg keeps
the sign of its slip, so that its law is smooth across the end of the leg; the end is found by secant steps.
In the plane friction turns with the slip and only rest itself is singular. A step there never goes further
than nine tenths of the way to rest, and the rest of the way, below the accuracy, is closed by the balance of
momentum.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from frictionlab.compile.decorators import fast, fast_embedded, inner
from frictionlab.compile.dispatch import by_dimension, length
from frictionlab.compile.lane_arrays import select
from frictionlab.motion.equation import (
    Flow,
    anchored,
    belt_path,
    belt_velocity,
    deviation_slip,
    holding_force,
    instant_at,
    instant_near,
    instant_of_stage,
    is_free,
    normal_load,
    note_instants,
    piece_ends,
    pieces_of,
    quickest_of,
    rates,
    rates_at,
    reference_position,
    reference_velocity,
    resting_friction,
    runs_away,
    slip_at,
    slip_rate,
    turned,
)
from frictionlab.motion.events import dips, slip_events
from frictionlab.motion.maps.case import Case, case_in_piece
from frictionlab.motion.maps.stick import StickPhase, stick_phase
from frictionlab.motion.orbit.recorder import Track, panel_writer
from frictionlab.motion.steppers.dop853 import (
    LAST_STAGE,
    Dense,
    State,
    Step,
    interpolant,
    motion_within,
    stepper,
)
from frictionlab.motion.steppers.step import growth_of, longest_step


class Mapped(NamedTuple):
    """State after the span of the body, with sums and extremes on the way."""

    y: Any
    u: Any
    friction_impulse: Any  # integral of friction, in shares of the mean normal load
    stuck: float  # time at rest
    closest: float  # smallest slip speed at a node
    released: float  # when rest ended last; -1: never
    steps: int  # -1: gave up


MOST_STEPS = 200_000


@fast_embedded
def _rates(problem: Flow, stage: int, tau: float, y: Any, u: Any) -> Any:
    return rates_at(problem, instant_of_stage(problem, stage, tau), y, u)


step, dense = stepper(_rates, note_instants), interpolant(_rates, note_instants, rates)


@inner
def state_at(problem: Flow, tau: float, y: Any, u: Any) -> State:
    """Return the state from which slip goes on."""
    a, f = rates(problem, tau, y, u)
    return State(y, u, a, f)


@inner
def _state_then(problem: Flow, now: Any, taken: Step) -> State:
    """Return the state at the end of a step."""
    a, f = rates_at(problem, now, taken.x, taken.v)
    return State(taken.x, taken.v, a, f)


@inner
def _still(y: Any, u: Any) -> State:
    """Return a state at rest, whose rates are not used."""
    return State(y, u, u, u)


# --- slip ---------------------------------------------------------------------------------------------------------


class Node(NamedTuple):
    """Start of a step: time, state, slip and its rate."""

    tau: float
    state: State
    w: Any
    speed: float
    rate: Any


class Landing(NamedTuple):
    """Verdict on a step (or on the wait until rest), and its end.

    Verdicts: repeat the step with h; accept it; rest after h; accept it, with slip still lost in the rounding
    of the velocity.
    """

    verdict: int
    h: float
    end: State
    friction_impulse: Any


REPEAT, ACCEPT, REST, STILL = 0, 1, 2, 3


@fast
def _acceleration_after(problem: Flow, tau: float, end: Any) -> Any:
    return state_at(problem, tau, end.x, end.v).a


stop, lowest = slip_events(step, _acceleration_after, slip_at, slip_rate)


@inner
def node_at(problem: Flow, tau: float, state: State) -> Node:
    """Return the node with this state, at most one radian from the anchor."""
    w = slip_at(problem, tau, state.v)
    return Node(tau, state, w, length(w), slip_rate(problem, tau, state.a))


@inner
def near_rest(accuracy: float, limit: float) -> float:
    """Return the speed of planar slip below which steps end; limit: force of friction at rest."""
    return max(math.sqrt(accuracy * limit), 1e-2 * accuracy)


@inner
def step_towards_rest(node: Node, limit: float, h: float) -> float:
    """Return the longest step of planar slip: at most nine tenths of the way to rest, and stable."""
    closing = -(node.rate * node.w.conjugate()).real / node.speed
    h = min(h, 4.0 * node.speed / limit)  # slip turns towards the force at the rate limit/speed
    return select(closing > 0.0, min(h, 0.9 * node.speed / max(closing, 1e-300)), h)


def _before_in_the_plane(problem: Flow, node: Node, accuracy: float, h: float, y: complex) -> Landing:
    """Limit a step towards rest, or go to rest at once if rest is nearer than the accuracy."""
    body, belt_speed, w = problem.body, problem.belt_speed, node.w
    speed, now = node.speed, instant_near(problem, node.tau)
    pressed = normal_load(body, now)
    limit = pressed * problem.law.sliding_friction(0.0)
    if speed < near_rest(accuracy, limit):
        x = y + reference_position(body, node.tau)
        held, rate, _bend = holding_force(body, belt_speed, instant_at(body, node.tau), x)
        margin = limit - abs(held)
        sure = speed * speed < 0.1 * accuracy * margin and 10.0 * speed * abs(rate) < margin * abs(margin)
        if sure or speed <= 1e-2 * accuracy:
            wait = speed / (limit - (held * w.conjugate()).real / speed) if sure else 0.0
            end = node.tau + wait
            path = 0.5 * wait * w
            friction_impulse = w / body.normal_load + resting_friction(body, belt_speed, node.tau, end, x)
            y = x + belt_path(body, belt_speed, node.tau, end) + path - reference_position(body, end)
            return Landing(REST, wait, _still(y, w), friction_impulse)
    return Landing(ACCEPT, step_towards_rest(node, limit, h), node.state, y)


_before = by_dimension(
    lambda problem, node, accuracy, h, y: Landing(ACCEPT, h, node.state, y), _before_in_the_plane
)


def _after_on_the_line(problem: Flow, node: Node, leaving: bool, taken: Any, h: float, y: float) -> Landing:
    """Decide whether slip passed through zero in the step, between its nodes included."""
    side, state, limit, now = problem.side, node.state, h, instant_of_stage(problem, LAST_STAGE, node.tau + h)
    after = side * deviation_slip(problem, now, taken.v)
    if after <= 0.0 and leaving and after >= -1e-15 * (abs(taken.v) + abs(problem.belt_speed)):
        return Landing(STILL, h, state_at(problem, node.tau + h, taken.x, taken.v), taken.friction_impulse)
    if after <= 0.0 and leaving:
        return Landing(REPEAT if h * problem.body.frequency > 1e-12 else REST, 0.25 * h, state, 0.0)
    there = _state_then(problem, now, taken)
    rises = side * slip_rate(problem, node.tau + h, there.a) > 0.0
    if after > 0.0 and not leaving and side * node.rate < 0.0 and rises:
        limit = lowest(problem, node.tau, state, side * node.rate, h)
        after = side * slip_at(problem, node.tau + limit, step(problem, node.tau, state, limit).v)
    if after <= 0.0:
        h, taken = stop(problem, node.tau, state, 0.0, limit)
        return Landing(REST, h, _still(taken.x, taken.v), taken.friction_impulse)
    return Landing(ACCEPT, h, there, taken.friction_impulse)


def _after_in_the_plane(
    problem: Flow, node: Node, leaving: bool, taken: Any, h: float, y: complex
) -> Landing:
    """Decide whether slip came close to rest between the nodes: then the step was too long."""
    now = instant_of_stage(problem, LAST_STAGE, node.tau + h)
    after, there = deviation_slip(problem, now, taken.v), _state_then(problem, now, taken)
    if dips(node.w, node.rate, after, slip_rate(problem, node.tau + h, there.a), h):
        return Landing(REPEAT, 0.5 * h, node.state, y)
    return Landing(ACCEPT, h, there, taken.friction_impulse)


_after = by_dimension(_after_on_the_line, _after_in_the_plane)


# --- the record of an orbit ---------------------------------------------------------------------------------------


@inner
def motion_in_slip(part: float, problem: Flow, node: Node, taken: Dense) -> Any:
    """Return position, velocity and friction at the time ``part`` after the start of a step."""
    body, tau = problem.body, node.tau + part
    (y, u), (sine, cosine) = motion_within(taken, part), turned(problem, tau)
    _a, f = rates(problem, tau, y, u)
    x = y + body.reference_sine * sine + body.reference_cosine * cosine
    return x, u + reference_velocity(body, sine, cosine), f


@inner
def _resting(part: float, problem: Flow, tau: float, x: Any) -> Any:
    """Return position, velocity and friction at the time ``part`` after the start of a rest at x."""
    body, belt_speed = problem.body, problem.belt_speed
    now = instant_at(body, tau + part)
    x = x + belt_path(body, belt_speed, tau, tau + part)
    held, _rate, _bend = holding_force(body, belt_speed, now, x)
    return x, belt_velocity(body, belt_speed, now) + 0.0 * x, held / body.normal_load


class Hop(NamedTuple):
    """Short time next to rest that the balance of momentum closes.

    Slip changes evenly, and friction is its mean.
    """

    tau: float
    lasts: float
    x: Any
    w: Any
    change: Any
    rub: Any


@inner
def _hopping(part: float, problem: Flow, hop: Hop) -> Any:
    body, belt_speed, share = problem.body, problem.belt_speed, part / hop.lasts
    carried = belt_path(body, belt_speed, hop.tau, hop.tau + part)
    x = hop.x + carried + part * (hop.w + 0.5 * share * hop.change)
    v = belt_velocity(body, belt_speed, instant_at(body, hop.tau + part)) + hop.w + share * hop.change
    return x, v, hop.rub


_note_slip, _note_stick, note_hop = (
    panel_writer(motion_in_slip),
    panel_writer(_resting),
    panel_writer(_hopping),
)


@inner
def note_stick(track: Track, problem: Flow, tau: float, lasts: float, x: Any) -> None:
    """Record a time at rest from x on, in panels of an eighth of the quickest period.

    The loads vary within a rest.
    """
    body, belt_speed = problem.body, problem.belt_speed
    quickest = 0.0 if is_free(body) else quickest_of(body)
    panels = 1 + int(4.0 / math.pi * quickest * lasts)
    for k in range(panels):
        start = tau + lasts * k / panels
        carried = x + belt_path(body, belt_speed, tau, start)
        _note_stick(track, start, lasts / panels, True, problem, start, carried)


@inner
def _note_rest(track: Track, problem: Flow, tau: float, x: Any, rest: StickPhase) -> None:
    """Record the time at rest from x on, and the short time after it that the balance of momentum closes."""
    slips = tau + rest.stuck
    if rest.stuck > 0.0:
        note_stick(track, problem, tau, rest.stuck, x)
    if rest.tau > slips:
        lasts = rest.tau - slips
        x = x + belt_path(problem.body, problem.belt_speed, tau, slips)
        hop = Hop(slips, lasts, x, 0.0 * rest.w, rest.w, rest.pulled / lasts)
        note_hop(track, slips, lasts, False, problem, hop)


@inner
def _after_rest(problem: Flow, state: State, rest: StickPhase, end: float) -> State:
    """Return the state of the deviation with which slip begins; that before, if it only turns."""
    body, tau = problem.body, rest.tau
    if rest.stuck == 0.0 and rest.w == 0.0:
        return state_at(problem, tau, state.x, state.v)
    # slip starts with the velocity from the balance of momentum
    u = rest.w + belt_velocity(body, problem.belt_speed, instant_at(body, tau))
    u = u - reference_velocity(body, problem.sine, problem.cosine)
    y = rest.x - reference_position(body, tau)
    return state_at(problem, tau, y, u) if tau < end else _still(y, u)


class Attempt(NamedTuple):
    """Result of a step: its landing, the length of the next step, and the number of steps tried."""

    landing: Landing
    next: float
    steps: int


@inner
def _slide(problem: Flow, node: Node, leaving: bool, accuracy: float, h: float, track: Track) -> Attempt:
    """Take a step of slip from a node, of h at most; record it if it is taken."""
    state, room = node.state, track.stick.size
    done = _before(problem, node, accuracy, h, state.x)
    if done.verdict == REST:
        if room > 0 and done.h > 0.0:
            x, rub = state.x + reference_position(problem.body, node.tau), done.friction_impulse / done.h
            hop = Hop(node.tau, done.h, x, node.w, -node.w, rub)
            note_hop(track, node.tau, done.h, False, problem, hop)
        return Attempt(done, h, 0)
    # a step of slip: too inaccurate, it is repeated shorter
    taken = step(problem, node.tau, state, done.h)
    growth = growth_of(problem.body, taken, accuracy)
    if growth < 1.0:
        return Attempt(Landing(REPEAT, done.h, state, taken.friction_impulse), done.h * growth, 1)
    landing = _after(problem, node, leaving, taken, done.h, state.x)
    if landing.verdict == REPEAT:
        return Attempt(landing, landing.h, 1)
    if room > 0:
        whole = dense(problem, node.tau, state, landing.h)
        _note_slip(track, node.tau, landing.h, False, problem, node, whole)
    return Attempt(landing, done.h * growth, 1)


@inner
def sliding_map(case: Case, y: Any, u: Any, accuracy: float, track: Track) -> Mapped:
    """Map one span from the deviation (y, u) at tau = 0.

    accuracy: of each step, in the norm of energy. A track with room records every piece of the motion.
    """
    image = Mapped(y, u, 0.0 * y, 0.0, 1e300, -1.0, 0)
    for k in range(pieces_of(case.body)):
        tau, end = piece_ends(case.body, k)
        image = _sliding_piece(case_in_piece(case, k), tau, end, image, accuracy, track)
        if image.steps < 0:
            break
    return image


@inner
def _sliding_piece(
    case: Case, tau: float, end: float, image: Mapped, accuracy: float, track: Track
) -> Mapped:
    """Map one piece between two corners of the functions of time.

    image: state at the first corner, with sums and extremes so far.
    """
    law, body, belt_speed, zero = case
    y, u, friction_impulse, stuck, closest, released, steps = image
    # the side of the first slip; a slip within the accuracy of zero is rest
    longest = longest_step(body, law.sliding_friction(0.0), accuracy)
    h = 0.1 * longest
    w = slip_at(anchored(law, body, belt_speed, 1.0, tau), tau, u)
    problem = anchored(law, body, belt_speed, 1.0 if w.real > 0.0 else -1.0, tau)
    resting, leaving = abs(w) <= 1e-2 * accuracy, False
    state = _still(y, u) if resting else state_at(problem, tau, y, u)
    while end - tau > 4e-15 * end:  # slip cannot get away from rest in less
        if resting:
            # at rest: until the belt has carried the mass to where friction no longer holds it
            x = state.x + reference_position(body, tau)
            rest = stick_phase(Case(law, body, belt_speed, zero), tau, x, accuracy, end)
            if track.stick.size > 0:
                _note_rest(track, problem, tau, x, rest)
            friction_impulse, stuck = friction_impulse + rest.friction_impulse, stuck + rest.stuck
            if rest.stuck > 0.0 and rest.tau < end:
                released = tau + rest.stuck
            tau, resting, leaving, closest, h = rest.tau, False, True, 0.0, 0.1 * longest
            steps += 1  # a rest of no length takes no step and no time, but counts
            problem = anchored(law, body, belt_speed, rest.side, tau)
            state = _after_rest(problem, state, rest, end)
            continue
        # the sine and cosine of a step are expanded about its start
        problem = anchored(law, body, belt_speed, problem.side, tau)
        node = node_at(problem, tau, state)
        closest = min(closest, node.speed)
        done, h, tried = _slide(problem, node, leaving, accuracy, min(h, longest, end - tau), track)
        steps += tried
        if steps > MOST_STEPS or runs_away(body, state.x):
            steps = -1
            break
        if done.verdict != REPEAT:
            resting, leaving = done.verdict == REST, done.verdict == STILL
            friction_impulse, state = friction_impulse + done.friction_impulse, done.end
            tau = tau + done.h if end - tau > done.h else end
    return Mapped(state.x, state.v, friction_impulse, stuck, closest, released, steps)
