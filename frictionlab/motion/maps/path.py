"""Period map of a bristle law whose deflection is known along a straight slip path, in one direction.

Between two reversals of slip the deflection is a function of the path slid since the last reversal. Friction
is evaluated with that function, so that only the mass is integrated, by DOP853, without the stiffness of the
bristles. A leg ends where slip does, or where friction saturates for good. Through the layer after a
reversal, steps at most double the path, so that no tolerance can jump over it.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from frictionlab.compile.decorators import fast, fast_embedded, inner
from frictionlab.compile.dispatch import by_nearness
from frictionlab.motion.equation import (
    belt_path,
    deviation_acceleration,
    deviation_slip,
    expand_about,
    expand_places,
    instant_near,
    instant_of_stage,
    load_share,
    note_instants,
    note_places,
    piece_ends,
    pieces_of,
    reference_position,
    reference_velocity,
    runs_away,
    slip_at,
    slip_rate,
    turned,
)
from frictionlab.motion.events import slip_events
from frictionlab.motion.maps.case import Case, Pace, Stepping, case_in_piece, keep_step
from frictionlab.motion.maps.sliding import MOST_STEPS
from frictionlab.motion.orbit.recorder import panel_writer
from frictionlab.motion.steppers.dop853 import (
    LAST_STAGE,
    Dense,
    State,
    interpolant,
    motion_within,
    stepper,
)
from frictionlab.motion.steppers.step import growth_of, longest_step, wary_growth_of
from frictionlab.motion.waves import polynomial
from frictionlab.scene.body import BodyNumbers
from frictionlab.scene.varying import PLACE


class LegStart(NamedTuple):
    """Start of a leg: deflection, position of the deviation and of the reference, and time.

    swung: way that the reference slid from there to the anchor.
    """

    z: float
    y: float
    tau: float
    reference: float
    swung: float


class Leg(NamedTuple):
    """Slip in one direction: its start, and sine and cosine at the anchor time."""

    law: Any
    body: BodyNumbers
    belt_speed: float
    side: float
    anchor: float
    sine: float
    cosine: float
    start: LegStart
    moves: float  # 0 if the motion is prescribed, else 1


class Carried(NamedTuple):
    """State with its deflection after the span of the body, with sums and extremes on the way."""

    y: Any
    u: Any
    z: Any
    friction_impulse: Any  # integral of friction, in shares of the mean normal load
    closest: float  # smallest slip speed at a node
    steps: int  # -1: gave up


@inner
def _anchored(leg: Leg, tau: float) -> Leg:
    body, angle = leg.body, leg.body.frequency * tau
    sine, cosine = math.sin(angle), math.cos(angle)
    z, y, begin, reference, _ = leg.start
    swung = body.reference_sine * sine + body.reference_cosine * cosine - reference
    swung = swung - belt_path(body, leg.belt_speed, begin, tau)
    expand_about(body, leg.belt_speed, tau, sine, cosine)
    expand_places(body)
    start = LegStart(z, y, begin, reference, swung)
    return Leg(leg.law, body, leg.belt_speed, leg.side, tau, sine, cosine, start, leg.moves)


@inner
def _leg(case: Case, side: float, tau: float, y: float, z: float) -> Leg:
    start = LegStart(z, y, tau, reference_position(case.body, tau), 0.0)
    moves = 0.0 if case.body.prescribed else 1.0
    return _anchored(Leg(case.law, case.body, case.belt_speed, side, tau, 0.0, 1.0, start, moves), tau)


@fast_embedded
def _moving(leg: Leg, deviation: float) -> float:
    """Return a deviation, or its rate, as far as it is a motion.

    Where the motion is prescribed, the deviation is none: it is driven by friction as that of a free mass, so that
    steps are as accurate.
    """
    return leg.moves * deviation


@fast
def _slip_at(leg: Leg, tau: float, u: float) -> float:
    return slip_at(leg, tau, _moving(leg, u))


@fast
def _slip_rate(leg: Leg, tau: float, a: float) -> float:
    return slip_rate(leg, tau, _moving(leg, a))


_place = by_nearness(
    lambda body, now: polynomial(body.varying.table, PLACE, now.part), lambda body, now: now.place
)
"""_place(body, now): way that the reference has slid since the anchor."""


@fast_embedded
def _path_of(leg: Leg, now: Any, y: float) -> float:
    """Return the path that the leg has slid, in its direction."""
    return max(leg.side * (_moving(leg, y - leg.start.y) + leg.start.swung + _place(leg.body, now)), 0.0)


@fast_embedded
def path_rates(leg: Leg, tau: float, y: float, u: float) -> Any:
    """Return the acceleration of the deviation, and friction in shares of the mean normal load."""
    return _path_rates(leg, instant_near(leg, tau), y, u)


@fast_embedded
def _path_rates(leg: Leg, now: Any, y: float, u: float) -> Any:
    side, law = leg.side, leg.law
    # Trial steps go beyond the end of the leg: there its law is continued as at rest, so that it stays smooth.
    w = side * max(side * deviation_slip(leg, now, _moving(leg, u)), 0.0)
    z = law.deflected(leg.start.z, side * _path_of(leg, now, y))
    rub = law.friction(w, z, law.rate(w, z))
    return deviation_acceleration(leg.body, now, y, u, rub), load_share(leg.body, now) * rub


@fast_embedded
def _rates(leg: Leg, stage: int, tau: float, y: float, u: float) -> Any:
    return _path_rates(leg, instant_of_stage(leg, stage, tau), y, u)


@fast_embedded
def _prepare(leg: Leg, tau: float, h: float) -> None:
    note_instants(leg, tau, h)
    note_places(leg, tau, h)


step, dense = stepper(_rates, _prepare), interpolant(_rates, _prepare, path_rates)


@fast
def _acceleration_after(leg: Leg, tau: float, end: Any) -> float:
    a, _rub = path_rates(leg, tau, end.x, end.v)
    return a


stop, lowest = slip_events(step, _acceleration_after, _slip_at, _slip_rate)


@inner
def _path_at(leg: Leg, tau: float, y: float) -> float:
    return _path_of(leg, instant_near(leg, tau), y)


@inner
def share_of_path(law: Any, body: BodyNumbers, accuracy: float) -> float:
    """Return the share of the path since a reversal by which a step may lengthen it.

    It is less for finer maps: with one share for all, two maps could agree because of it.
    """
    impulse = body.normal_load * law.sliding_friction(0.0)
    return min(1.0, 2.0 * (accuracy / impulse) ** 0.0625)


@inner
def _longest(leg: Leg, path: float, share: float, w: float, rate: float) -> float:
    """Return the longest step that adds at most this share of the path, or of the bristle's own length."""
    law = leg.law
    length = law.largest_deflection()
    here, next_ = (
        law.deflected(leg.start.z, leg.side * path),
        law.deflected(leg.start.z, leg.side * (path + length)),
    )
    if abs(next_ - here) <= 1e-13 * length:
        return 1e300
    ahead = share * max(length, path)
    return 2.0 * ahead / (abs(w) + math.sqrt(w * w + 2.0 * abs(rate) * ahead) + 1e-300)


@inner
def _until_path(leg: Leg, tau: float, state: State, high: float, path: float) -> Any:
    """Return the step at whose end the leg has slid this path, and that end (safeguarded Newton)."""
    low, h = 0.0, high
    taken = step(leg, tau, state, h)
    for _ in range(60):
        beyond = _path_at(leg, tau + h, taken.x) - path
        low, high = (low, h) if beyond > 0.0 else (h, high)
        speed = leg.side * _slip_at(leg, tau + h, taken.v)
        trial = h - beyond / speed if speed > 0.0 else low
        if not low < trial < high:
            trial = 0.5 * (low + high)
        done = abs(trial - h) <= 4e-16 * (tau + h)
        h = trial
        taken = step(leg, tau, state, h)
        if done or high - low <= 4e-16 * (tau + h):
            break
    return h, taken


@inner
def _slipping(part: float, leg: Leg, tau: float, taken: Dense) -> Any:
    """Return position, velocity and friction at the time ``part`` after the start of a step."""
    body, (y, u), (sine, cosine) = leg.body, motion_within(taken, part), turned(leg, tau + part)
    _a, rub = path_rates(leg, tau + part, y, u)
    x = _moving(leg, y) + body.reference_sine * sine + body.reference_cosine * cosine
    return x, _moving(leg, u) + reference_velocity(body, sine, cosine), rub


_note_slip = panel_writer(_slipping)


@inner
def _side(case: Case, tau: float, y: float, u: float, z: float) -> float:
    """Return the direction in which slip goes on from here."""
    leg = _leg(case, 1.0, tau, y, z)
    w = _slip_at(leg, tau, u)
    if w == 0.0:
        a, _rub = path_rates(leg, tau, y, u)
        w = _slip_rate(leg, tau, a)
    return 1.0 if w >= 0.0 else -1.0


REPEAT, ACCEPT, TURN, SATURATE = 0, 1, 2, 3


class PathStep(NamedTuple):
    """Verdict on a step: repeat it with h, accept it, or end it where slip turns or friction saturates."""

    verdict: int
    h: float
    taken: Any


class PathNode(NamedTuple):
    """Start of a step: its leg, anchored there, the path slid on it, and the path until saturation.

    leaving: whether slip has just turned round.
    """

    leg: Leg
    tau: float
    state: State
    path: float
    corner: float
    leaving: bool


@inner
def _node_of(leg: Leg, tau: float, y: float, u: float) -> PathNode:
    """Return the node at the start of a leg."""
    a, rub = path_rates(leg, tau, y, u)
    return PathNode(leg, tau, State(y, u, a, rub), 0.0, leg.law.saturation_path(leg.start.z, leg.side), True)


@inner
def _until_turn(node: PathNode, taken: Any, h: float) -> PathStep:
    """Decide on an accurate step of h: whether slip turned round in it, between its ends included."""
    leg, tau, state = node.leg, node.tau, node.state
    there = instant_of_stage(leg, LAST_STAGE, tau + h)
    after, limit = leg.side * deviation_slip(leg, there, _moving(leg, taken.v)), h
    if leg.body.prescribed and after == 0.0 and _slip_at(leg, tau, state.v) == 0.0:
        return PathStep(ACCEPT, h, taken)  # such a slip may rest, whatever friction does
    if after <= 0.0 and node.leaving:
        # just behind a reversal slip is zero to rounding: the first step must leave the reversal, or slip never does
        if h * leg.body.frequency > 1e-12:
            return PathStep(REPEAT, 0.25 * h, taken)
        return PathStep(TURN, h, taken)
    a, _rub = _path_rates(leg, there, taken.x, taken.v)
    falls, rises = leg.side * _slip_rate(leg, tau, state.a), leg.side * _slip_rate(leg, tau + h, a)
    # slip that falls first and rises last may have passed zero twice between the ends
    if after > 0.0 and not node.leaving and falls < 0.0 < rises:
        limit = lowest(leg, tau, state, falls, h)
        after = leg.side * _slip_at(leg, tau + limit, step(leg, tau, state, limit).v)
    if after > 0.0:
        return PathStep(ACCEPT, h, taken)
    h, taken = stop(leg, tau, state, 0.0, limit)
    return PathStep(TURN, h, taken)


@inner
def _until_event(node: PathNode, taken: Any, h: float) -> PathStep:
    """Decide on an accurate step of h: whether it ends earlier, where slip turns or friction saturates."""
    leg, tau, corner = node.leg, node.tau, node.corner
    ending = _until_turn(node, taken, h)
    if ending.verdict == REPEAT:
        return ending
    # friction has a corner at its final saturation
    beyond = _path_at(leg, tau + ending.h, ending.taken.x) > corner * (1.0 + 1e-14)
    if node.path < corner < math.inf and beyond:
        h, taken = _until_path(leg, tau, node.state, ending.h, corner)
        return PathStep(SATURATE, h, taken)
    return ending


@inner
def _attempt(node: PathNode, h: float, in_a_layer: bool, accuracy: float) -> Any:
    """Try one step of h from a node, and return its verdict and the growth of the next step."""
    leg = node.leg
    taken = step(leg, node.tau, node.state, h)
    growth = wary_growth_of(leg.body, taken, accuracy) if in_a_layer else growth_of(leg.body, taken, accuracy)
    if growth < 1.0:
        return PathStep(REPEAT, h * growth, taken), growth
    return _until_event(node, taken, h), growth


@inner
def _next_node(case: Case, node: PathNode, ending: PathStep, tau: float) -> PathNode:
    """Return the node after an accepted step: on the same leg, or on the next one.

    The next leg begins with the deflection at the end of this one.
    """
    leg, taken = node.leg, ending.taken
    # Rounding may shorten a path: the corner at its end, once passed, would then be met again for ever.
    path = max(node.path, _path_at(leg, node.tau + ending.h, taken.x))
    path = node.corner if ending.verdict == SATURATE else path
    if ending.verdict == TURN:
        z = leg.law.deflected(leg.start.z, leg.side * path)
        return _node_of(_leg(case, -leg.side, tau, taken.x, z), tau, taken.x, taken.v)
    leg = _anchored(leg, tau)
    a, rub = path_rates(leg, tau, taken.x, taken.v)
    return PathNode(leg, tau, State(taken.x, taken.v, a, rub), path, node.corner, False)


@inner
def _first_node(case: Case, tau: float, y: float, u: float, z: float) -> PathNode:
    return _node_of(_leg(case, _side(case, tau, y, u, z), tau, y, z), tau, y, u)


@inner
def _deflection_at(node: PathNode) -> float:
    leg = node.leg
    return leg.law.deflected(leg.start.z, leg.side * _path_at(leg, node.tau, node.state.x))


@inner
def _repeated_piece(case: Case, tau: float, end: float, image: Carried, pace: Pace) -> Carried:
    """Map one piece by kept steps; image: state at its first corner, and the steps so far."""
    y, u, z, friction_impulse, last = image.y, image.u, image.z, image.friction_impulse, pace.taken[0] - 1
    node = _first_node(case, tau, y, u, z)
    for k in range(image.steps, last + 1):
        # where events come earlier or later, the last step makes up for it
        left = end - node.tau
        h = left if k == last else min(pace.lengths[k], left)
        ending = _until_event(node, step(node.leg, node.tau, node.state, h), h)
        if ending.verdict != pace.endings[k]:
            return Carried(y, u, z, friction_impulse, 0.0, -1)
        friction_impulse = friction_impulse + ending.taken.friction_impulse
        node = _next_node(case, node, ending, node.tau + ending.h if left > ending.h else end)
        if end - node.tau <= 4e-15 * end:
            return Carried(node.state.x, node.state.v, _deflection_at(node), friction_impulse, 0.0, k + 1)
    return Carried(y, u, z, friction_impulse, 0.0, -1)


@inner
def path_map(case: Case, y: float, u: float, z: float, stepping: Stepping) -> Carried:
    """Map one span from the deviation (y, u) and deflection z at tau = 0.

    A map by the steps of another motion close by gives up where the events are not those of that motion.
    Steps end at the events of their own motion, so that the end is a smooth function of the start.
    """
    image = Carried(y, u, z, 0.0, 1e300, 0)
    for k in range(pieces_of(case.body)):
        here, (tau, end) = case_in_piece(case, k), piece_ends(case.body, k)
        if stepping.repeats:
            image = _repeated_piece(here, tau, end, image, stepping.pace)
        else:
            image = _path_piece(here, tau, end, image, stepping)
        if image.steps < 0:
            break
    return image


@inner
def _path_piece(case: Case, tau: float, end: float, image: Carried, stepping: Stepping) -> Carried:
    """Map one piece of the span.

    image: state at its first corner, with sums and extremes so far.
    """
    law, body, accuracy = case.law, case.body, stepping.accuracy
    longest = longest_step(body, law.sliding_friction(0.0), accuracy)
    share = share_of_path(law, body, accuracy)
    y, u, z, friction_impulse, closest, steps = image
    node = _first_node(case, tau, y, u, z)
    h = 0.1 * longest
    while end - node.tau > 4e-15 * end:
        leg, tau, state = node.leg, node.tau, node.state
        w, rate = _slip_at(leg, tau, state.v), _slip_rate(leg, tau, state.a)
        closest = min(closest, abs(w))
        # in the layer behind a reversal steps grow with the path, so that no tolerance jumps over it
        layered = node.corner > node.path or node.corner == math.inf
        ahead = _longest(leg, node.path, share, w, rate) if layered else 1e300
        h = min(h, ahead, longest, end - tau)
        ending, growth = _attempt(node, h, ahead < 1e300, accuracy)
        tried, h, steps = h, ending.h, steps + 1
        if steps > MOST_STEPS or runs_away(body, state.x):
            return Carried(state.x, state.v, z, friction_impulse, closest, -1)
        if ending.verdict == REPEAT:
            continue
        # a step to the end goes there whenever it is repeated
        last = ending.verdict == ACCEPT and end - tau <= h
        keep_step(stepping.pace, 1e300 if last else tried, ending.verdict)
        if stepping.track.stick.size > 0:
            _note_slip(stepping.track, tau, h, False, leg, tau, dense(leg, tau, state, h))
        friction_impulse = friction_impulse + ending.taken.friction_impulse
        node = _next_node(case, node, ending, tau + h if end - tau > h else end)
        h = h * growth if ending.verdict != TURN else longest
    return Carried(node.state.x, node.state.v, _deflection_at(node), friction_impulse, closest, steps)
