"""Period map of laws with memory, of one bristle or several numbers: mass and memory together by Rodas5P.

However stiff the contact, steps follow the motion. A step ends where a deflection meets or leaves its yield
surface or begins to be unloaded and, on the line, where slip reverses; between such events everything is
smooth. Scalars have no events: steps are as short as friction near rest is steep. If the slip is prescribed,
friction does not move the mass, and only the memory is followed.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from frictionlab.compile.decorators import inner
from frictionlab.compile.dispatch import by_dimension, by_law, by_scalars, length
from frictionlab.compile.stack import count_of
from frictionlab.motion.equation import (
    Flow,
    anchored,
    belt_path,
    instant_at,
    instant_near,
    is_free,
    load_share,
    piece_ends,
    pieces_of,
    quickest_of,
    runs_away,
    swing_of,
)
from frictionlab.motion.events import dips
from frictionlab.motion.linalg import block
from frictionlab.motion.maps.case import Case, Stepping, case_in_piece, keep_step
from frictionlab.motion.maps.creep import BELOW, SLOW, creeps, longest_while_slow, note_creep
from frictionlab.motion.maps.linearization import linearize
from frictionlab.motion.maps.modes import (
    OPEN,
    begin,
    change,
    hidden,
    locate,
    lowest,
    note_guards,
    rates_at_end,
    restore,
)
from frictionlab.motion.maps.rates import (
    IMPULSE,
    MEMORY,
    SMOOTH,
    U,
    Work,
    Y,
    deviation_held,
    fill_rates,
    held_velocity,
    rows_of,
    velocity_held,
)
from frictionlab.motion.maps.sliding import MOST_STEPS, Mapped
from frictionlab.motion.maps.step import bend, step, within_step
from frictionlab.motion.orbit.recorder import panel_writer
from frictionlab.motion.steppers.step import growth_factor, longest_step
from frictionlab.scene.body import BodyNumbers

COARSEST = 1e-4
"""Coarsest accuracy of a step, per unit of friction impulse in a radian; coarser steps jump over
reversals."""


def _at_rest(law: Any, body: BodyNumbers) -> float:
    return law.sliding_friction(0.0)


usual_friction = by_law(_at_rest, _at_rest, lambda law, body: law.sliding_friction(swing_of(body)))
"""usual_friction(law, body): coefficient of steady sliding, by which accuracies are measured."""


@inner
def coarsest(law: Any, body: BodyNumbers) -> float:
    """Return the coarsest accuracy of a map: two maps of coarser accuracies would be one and the same."""
    return COARSEST * body.normal_load * usual_friction(law, body) / quickest_of(body)


OF_EVENTS = 1e-9
"""Accuracy of events in steps that are to be repeated, since their error is divided by a small shift.

It is not so fine that rounding decides on which side of an event a step ends."""
LAYER = 40.0
"""Length of the layer behind a reversal, in bristle lengths slid."""


@inner
def _while_into(part: float, flow: Flow, h: float, work: Work, zero: Any) -> Any:
    """Return position, velocity and friction a time ``part`` into the last step, of length h."""
    body, now = flow.body, instant_near(flow, flow.anchor + part)
    within_step(flow, part / h, work)
    y, u = work.stage[Y], work.stage[U]
    fill_rates(flow, now, work, zero)
    at = instant_at(body, flow.anchor + part)
    x = y + body.reference_sine * at.sine + body.reference_cosine * at.cosine
    return x, velocity_held(flow, at, u), work.rates[IMPULSE]


_note = panel_writer(_while_into)

_side = by_dimension(
    # the direction in which slip goes on
    lambda w, a: 1.0 if w > 0.0 or (w == 0.0 and a >= 0.0) else -1.0,
    lambda w, a: 1.0,
)

_guarded = by_dimension(
    # on the line the guard of slip detects it
    lambda node, w, a, h, zero: False,
    lambda node, w, a, h, zero: dips(node.w, node.a, w, a, h),
)
_unguarded = by_dimension(
    lambda node, w, a, h, zero: node.w * w > 0.0 and dips(node.w, node.a, w, a, h),
    lambda node, w, a, h, zero: dips(node.w, node.a, w, a, h),
)

_dip = by_scalars(
    lambda law, node, w, a, h, zero: _guarded(node, w, a, h, zero),
    lambda law, node, w, a, h, zero: _unguarded(node, w, a, h, zero),
)
"""_dip(law, node, w, a, h, zero): whether slip comes much closer to rest within a step from a node than at
its ends."""


def _position_on_the_line(flow: Flow, y: float) -> float:
    """Return the position of the mass against the belt at the anchor, for differences within a piece."""
    body = flow.body
    swung = body.reference_sine * flow.sine + body.reference_cosine * flow.cosine
    return y + swung - belt_path(body, flow.belt_speed, 0.0, flow.anchor)


_position = by_dimension(
    _position_on_the_line,
    # only on the line does a reversal begin a layer
    lambda flow, y: 0.0,
)


def _layer_on_the_line(work: Work, covered: float, share: float, a: float, w: float) -> float:
    """Return the longest step that adds at most this share to the path since a reversal.

    Where the path is shorter than the bristle, the share is one of the bristle's length.

    A bristle bends over in a short layer behind a reversal. An L-stable step might pass that layer unseen.
    """
    size = work.size[0]
    if work.mode[0] != SMOOTH or covered >= LAYER * size:
        return OPEN
    ahead = share * max(size, covered)
    return 2.0 * ahead / (abs(w) + math.sqrt(w * w + 2.0 * abs(a) * ahead) + 1e-300)


_layer = by_dimension(_layer_on_the_line, lambda work, covered, share, a, w: OPEN)


@inner
def _at_start(flow: Flow, work: Work, zero: Any) -> Any:
    """Return slip and its rate at the start of the step."""
    for row in range(rows_of(flow)):
        work.end[row] = work.start[row]
    return rates_at_end(flow, flow.anchor, work, zero)


@inner
def _flow_of(case: Case, tau: float, work: Work) -> Flow:
    """Return the flow at this time, with the modes and the side of slip of the state in ``work.start``."""
    flow = anchored(case.law, case.body, case.belt_speed, 1.0, tau)
    # rates need the side of slip, and the side of a zero slip needs the rates
    w, a = _at_start(flow, work, case.zero)
    begin(flow, a, w, work)
    return anchored(case.law, case.body, case.belt_speed, _side(w, a), tau)


class MemoryNode(NamedTuple):
    """Start of a step: its time, slip and its rate.

    leaving: whether an event has just been passed.
    """

    tau: float
    w: Any
    a: Any
    leaving: bool


class MemoryStep(NamedTuple):
    """Verdict on a step: its length, whether it must be tried again, and whether it ends at an event."""

    h: float
    repeats: bool
    ends: bool


@inner
def _end_of_step(
    flow: Flow, node: MemoryNode, h: float, accuracy: float, work: Work, zero: Any
) -> MemoryStep:
    """Decide whether an accurate step of h ends at an event, must be repeated shorter, or stands."""
    w, a = rates_at_end(flow, node.tau + h, work, zero)
    # the step ends at its first event
    guard = lowest(flow, w, a, work)
    if guard.value <= 0.0:
        # just behind an event a guard is zero to rounding: the first step must leave the event, or none does
        stays = node.leaving and work.guards[2 * guard.number] <= -1e-3 * guard.value
        if stays and h * flow.body.frequency > 1e-12:
            return MemoryStep(0.25 * h, True, False)
        return MemoryStep(locate(flow, node.tau, h, accuracy, work, zero), False, True)
    if node.leaving:
        return MemoryStep(h, False, False)
    # between two ends without events a guard may have passed zero twice, or slip come close to rest
    shorter = hidden(flow, h, w, a, work)
    if shorter == h and min(length(node.w), length(w)) > 10.0 * accuracy:
        shorter = 0.5 * h if _dip(flow.law, node, w, a, h, zero) else h
    return MemoryStep(shorter, shorter < h, False)


@inner
def _depart(flow: Flow, leaving: bool, work: Work, zero: Any) -> MemoryNode:
    """Prepare steps from ``work.start``, at the anchor of the flow."""
    # guards at the start, to be compared with those at the end, and the blocks of all stages
    w, a = _at_start(flow, work, zero)
    note_guards(flow, w, a, work)
    note_creep(flow, w, a, work)
    linearize(flow, flow.anchor, work, zero)
    return MemoryNode(flow.anchor, w, a, leaving)


@inner
def _arrive(flow: Flow, tau: float, ends: bool, work: Work, zero: Any) -> float:
    """Make the end of a step the start of the next; return the side of slip there."""
    side = flow.side
    if ends:
        w, a = rates_at_end(flow, tau, work, zero)
        side = change(flow, w, a, work)
    for row in range(rows_of(flow)):
        work.start[row] = work.end[row]
    restore(flow, work)
    if flow.body.prescribed:  # the reference is the motion: no error of a step adds up
        work.start[Y] = 0.0 * zero
        work.start[U] = held_velocity(flow, instant_near(flow, tau), 0.0 * zero)
    return side


def _growth_on_the_line(flow: Flow, work: Work, zero: float) -> float:
    """Return the largest modulus of the eigenvalues at ``work.start`` that have a positive real part."""
    body, n = flow.body, count_of(flow.law)
    load, matrix = body.normal_load, np.zeros((n + 2, n + 2), np.complex128)
    matrix[0, 1] = 1.0
    matrix[1, 0] = -(body.stiffness_mean + body.stiffness_split)
    matrix[1, 1] = -(body.damping_mean + body.damping_split + load * block(work.jacobian, 3 * n, zero))
    for k in range(n):
        matrix[1, 2 + k] = -load * block(work.jacobian, 3 * k + 2, zero)
        matrix[2 + k, 1] = block(work.jacobian, 3 * k, zero)
        matrix[2 + k, 2 + k] = block(work.jacobian, 3 * k + 1, zero)
    fastest = 0.0
    for value in np.linalg.eigvals(matrix):
        if value.real > 0.0:
            fastest = max(fastest, abs(value))
    return fastest


_growth = by_dimension(_growth_on_the_line, lambda flow, work, zero: math.inf)


@inner
def follow(flow: Flow, end: float, stepping: Stepping, work: Work, zero: Any) -> Any:
    """Follow the motion from ``work.start`` until ``end``; return the smallest slip speed and the steps.

    The end is left in ``work.start``. Both times lie between two corners of the functions of time. Steps are
    -1 if the search gave up.
    """
    law, body, belt_speed = flow.law, flow.body, flow.belt_speed
    accuracy, track, pace = stepping.accuracy, stepping.track, stepping.pace
    friction = usual_friction(law, body)
    longest = longest_step(body, friction, accuracy)
    free = is_free(body)
    began, share = OPEN, min(1.0, 2.0 * (accuracy / (body.normal_load * friction)) ** 0.0625)
    node, h, steps = _depart(flow, True, work, zero), 0.1 * longest, 0
    closest = length(node.w)
    while end - node.tau > 4e-15 * end:
        if h > longest and free:
            h = min(h, max(longest, 1.0 / (_growth(flow, work, zero) + 1e-300)))
        else:
            h = min(h, longest)
        h = min(h, end - node.tau, longest_while_slow(law, work, node.a))
        # one step: too inaccurate, it is repeated shorter
        growth = growth_factor(step(flow, node.tau, h, work, zero) / accuracy, 5.0)
        steps += 1
        if steps > MOST_STEPS or runs_away(body, work.start[Y]):
            return closest, -1
        if growth < 1.0:
            h = h * growth
            continue
        # an event cuts a step short, but says nothing about how long the next may be
        usual, tried = h * growth, h
        within = min(accuracy, OF_EVENTS) if pace.lengths.size > 0 else accuracy
        ending = _end_of_step(flow, node, h, within, work, zero)
        h = ending.h
        if ending.repeats:
            continue
        tau = node.tau + h if end - node.tau > h else end
        # a step to the end goes there whenever it is repeated
        keep_step(pace, OPEN if tau == end and not ending.ends else tried, 1 if ending.ends else 0)
        if track.stick.size > 0:
            bend(flow, work)
            _note(track, node.tau, h, False, flow, h, work, zero)
        # sine and cosine within a step are expanded about its start
        flow = anchored(law, body, belt_speed, _arrive(flow, tau, ending.ends, work, zero), tau)
        node = _depart(flow, ending.ends, work, zero)
        closest = min(closest, length(node.w))
        # a reversal begins a layer, where steps grow with the path; at the start of the span no reversal is known
        began = _position(flow, work.start[Y]) if ending.ends else began
        h = min(
            usual,
            _layer(work, abs(_position(flow, work.start[Y]) - began), share, node.a, node.w),
        )
    return closest, steps


@inner
def repeat(flow: Flow, end: float, first: int, stepping: Stepping, work: Work, zero: Any) -> int:
    """Follow the motion from ``work.start`` until ``end`` by the steps of another motion close by.

    first: number of the first of these steps. Steps end at the events of their own motion, so that the
    numbers at the end are a smooth function of those at the start. The end is left in ``work.start``. Return
    the number of the step after the last; -1 if the events are not those of the other motion.
    """
    law, body, belt_speed = flow.law, flow.body, flow.belt_speed
    pace, within = stepping.pace, min(stepping.accuracy, OF_EVENTS)
    last, tau = pace.taken[0] - 1, flow.anchor
    _depart(flow, True, work, zero)
    for k in range(first, last + 1):
        if creeps(law, work):  # another motion's steps do not resolve the time in which slip comes to creep
            return -1
        # where events come earlier or later, the last step makes up for it
        h = end - tau if k == last else min(pace.lengths[k], end - tau)
        step(flow, tau, h, work, zero)
        w, a = rates_at_end(flow, tau + h, work, zero)
        if (lowest(flow, w, a, work).value <= 0.0) != (pace.endings[k] == 1):
            return -1
        if pace.endings[k] == 1:
            h = locate(flow, tau, h, within, work, zero)
        tau = tau + h if end - tau > h else end
        flow = anchored(law, body, belt_speed, _arrive(flow, tau, pace.endings[k] == 1, work, zero), tau)
        if end - tau <= 4e-15 * end:
            return k + 1
        _depart(flow, pace.endings[k] == 1, work, zero)
    return -1


@inner
def _over_jump(work: Work, law: Any, before: float, after: float) -> None:
    """Carry the memory over a corner where the normal load over its mean changes.

    A contact that keeps its stiffness keeps each deflection, whose share of the new load is another; one beyond
    yield springs back at once.
    """
    for k in range(count_of(law)):
        z = (before / after) * work.start[MEMORY + k]
        far = length(z)
        beyond = work.radius[k] > 0.0 and far > work.radius[k]
        work.start[MEMORY + k] = (work.radius[k] / far) * z if beyond else z


@inner
def _share_at(case: Case, k: int, tau: float) -> float:
    """Return the normal load over its mean, of the k-th piece of the span."""
    body = case_in_piece(case, k).body
    return load_share(body, instant_at(body, tau))


@inner
def memory_map(case: Case, y: Any, u: Any, work: Work, stepping: Stepping) -> Mapped:
    """Map one span from the deviation (y, u) and the memory at ``work.start``, which becomes that at the end.

    A map that repeats kept steps gives up where they do not fit.
    """
    law, body, zero = case.law, case.body, case.zero
    free = 0.0 if body.prescribed else 1.0  # the reference is the motion
    work.start[Y] = free * y
    work.start[IMPULSE] = 0.0 * zero
    stepping = Stepping(
        min(stepping.accuracy, coarsest(law, body)), stepping.track, stepping.pace, stepping.repeats
    )
    work.creep[SLOW] = free * BELOW * stepping.accuracy
    u, closest, steps = free * u, OPEN, 0
    for k in range(pieces_of(body)):
        here, (tau, end) = case_in_piece(case, k), piece_ends(body, k)
        # beside scalars a state holds slip, which jumps where the belt's velocity does
        start = anchored(law, here.body, case.belt_speed, 1.0, tau)
        work.start[U] = held_velocity(start, instant_near(start, tau), u)
        flow = _flow_of(here, tau, work)
        if stepping.repeats:
            closest, steps = 0.0, repeat(flow, end, steps, stepping, work, zero)
        else:
            near, taken = follow(flow, end, stepping, work, zero)
            closest, steps = min(closest, near), steps + taken if taken >= 0 else -1
        ended = anchored(law, here.body, case.belt_speed, 1.0, end)
        u = deviation_held(ended, instant_near(ended, end), work.start[U])
        if steps < 0:
            break
        # the last piece ends where the first of the next span begins
        if len(body.varying.keeps_stiffness) == 0:
            continue
        last = k == pieces_of(body) - 1
        after = _share_at(case, 0, 0.0) if last else _share_at(case, k + 1, end)
        _over_jump(work, law, _share_at(case, k, end), after)
    return Mapped(work.start[Y], u, work.start[IMPULSE], 0.0, closest, -1.0, steps)
