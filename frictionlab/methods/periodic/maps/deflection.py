"""The period map of a contact's deflections, one of a bristle law or several: mass and memory together by Rodas5P.

However stiff the contact, steps follow the motion. A step ends where a deflection meets or leaves its yield surface
or begins to be unloaded and, on the line, where slip reverses; between such events everything is smooth.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from frictionlab.compile.decorators import inner
from frictionlab.compile.dispatch import by_dimension, by_law, length
from frictionlab.compile.stack import count_of
from frictionlab.dynamics.events import dips
from frictionlab.dynamics.motion import belt_path, instant_near, reference_velocity, span
from frictionlab.dynamics.step_size import growth_factor, longest_step
from frictionlab.methods.periodic.maps.linearization import linearize
from frictionlab.methods.periodic.maps.memory_state import scales_of, swing_of
from frictionlab.methods.periodic.maps.modes import (
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
from frictionlab.methods.periodic.maps.rates import (
    IMPULSE,
    MEMORY,
    SMOOTH,
    Flow,
    U,
    Work,
    Y,
    anchored,
    workspace,
)
from frictionlab.methods.periodic.maps.sliding import MOST_STEPS, Mapped
from frictionlab.methods.periodic.maps.step import step
from frictionlab.orbit.recorder import Track, panel_writer
from frictionlab.scene.body import Body

COARSEST = 1e-4
"""Of a step, per unit of friction impulse in a radian: what is coarser jumps over reversals."""


@inner
def coarsest(law: Any, body: Body) -> float:
    """The coarsest accuracy a map is made with, whatever is asked: two coarser maps are one and the same."""
    return COARSEST * body.normal_load * law.sliding_friction(0.0) / body.frequency


LAYER = 40.0
"""Bristle lengths slid since a reversal after which its layer is over."""


@inner
def _while_into(part: float, flow: Flow, tau: float, work: Work, like: Any) -> Any:
    """A while into a step; the step is taken anew to there."""
    body, now = flow.body, instant_near(flow, tau + part)
    if part > 0.0:
        step(flow, tau, part, work, like)
    else:
        for place in range(MEMORY + count_of(flow.law)):
            work.end[place] = work.start[place]
    rates_at_end(flow, tau + part, work, like)
    x = work.end[Y] + body.reference_sine * now.sine + body.reference_cosine * now.cosine
    return x, work.end[U] + reference_velocity(body, now.sine, now.cosine), work.rates[IMPULSE]


_note = panel_writer(_while_into)


def _side_on_the_line(w: float, a: float) -> float:
    """The direction in which slip goes on."""
    return 1.0 if w > 0.0 or (w == 0.0 and a >= 0.0) else -1.0


def _side_in_the_plane(w: complex, a: complex) -> float:
    return 1.0


_side = by_dimension(_side_on_the_line, _side_in_the_plane)


def _dips_on_the_line(w0: float, a0: float, w1: float, a1: float, h: float, like: float) -> bool:
    """On the line the guard of slip sees to it."""
    return False


def _dips_in_the_plane(w0: complex, a0: complex, w1: complex, a1: complex, h: float, like: complex) -> bool:
    return dips(w0, a0, w1, a1, h)


_dips = by_dimension(_dips_on_the_line, _dips_in_the_plane)
"""Whether slip comes much closer to rest within a step than at its ends."""


def _position_on_the_line(flow: Flow, y: float) -> float:
    """Of the mass against the belt, at the anchor."""
    body = flow.body
    swung = body.reference_sine * flow.sine + body.reference_cosine * flow.cosine
    return y + swung - belt_path(body, flow.belt_speed, 0.0, flow.anchor)


def _position_in_the_plane(flow: Flow, y: complex) -> float:
    """Only on the line does a reversal begin a layer."""
    return 0.0


_position = by_dimension(_position_on_the_line, _position_in_the_plane)


def _layer_on_the_line(work: Work, covered: float, share: float, a: float, w: float) -> float:
    """The longest step that adds no more than this share to the way since a reversal, or to the bristle's length.

    Behind a reversal a bristle bends over in a short layer, which an L-stable step might pass unseen.
    """
    size = work.size[0]
    if work.mode[0] != SMOOTH or covered >= LAYER * size:
        return OPEN
    ahead = share * max(size, covered)
    return 2.0 * ahead / (abs(w) + math.sqrt(w * w + 2.0 * abs(a) * ahead) + 1e-300)


def _layer_in_the_plane(work: Work, covered: float, share: float, a: complex, w: complex) -> float:
    return OPEN


_layer = by_dimension(_layer_on_the_line, _layer_in_the_plane)


def _measure_memory(law: Any, body: Body, work: Work, like: Any) -> float:
    scales = scales_of(law, body, like)
    for k in range(count_of(law)):
        work.unit[k], work.size[k] = scales.unit[k], scales.size[k]
    return law.sliding_friction(swing_of(body))


def _measure_bristle(law: Any, body: Body, work: Work, like: Any) -> float:
    size = law.largest_deflection()
    size = size if size < 1e300 else 1.0
    work.size[0] = size
    work.unit[0] = math.sqrt(body.normal_load * abs(law.friction(0.0, size, 0.0)) / size)
    return law.sliding_friction(0.0)


_measure = by_law(_measure_bristle, _measure_bristle, None, _measure_memory)
"""Of every deflection: its size in steady sliding, and what it is multiplied by in the norm of energy; returns the
friction coefficient that accuracies are measured by."""


@inner
def _at_start(flow: Flow, work: Work, like: Any) -> Any:
    """Slip and its rate where the step starts."""
    for row in range(MEMORY + count_of(flow.law)):
        work.end[row] = work.start[row]
    return rates_at_end(flow, flow.anchor, work, like)


@inner
def _begun(law: Any, body: Body, belt_speed: float, work: Work, like: Any) -> Flow:
    """The flow at tau = 0 with the modes and the side that the state in ``work.start`` has."""
    flow = anchored(law, body, belt_speed, 1.0, 0.0)
    w, a = _at_start(flow, work, like)
    begin(flow, a, w, work)
    return anchored(law, body, belt_speed, _side(w, a), 0.0)


class Node(NamedTuple):
    """Where a step starts: slip and its rate, and whether an event has just been passed."""

    tau: float
    w: Any
    a: Any
    leaving: bool


class Landing(NamedTuple):
    """The step to take, whether it has to be tried first, and whether it ends at an event."""

    h: float
    repeats: bool
    ends: bool


@inner
def _landing(flow: Flow, node: Node, h: float, accuracy: float, work: Work, like: Any) -> Landing:
    """What becomes of a step of h that is accurate enough."""
    w, a = rates_at_end(flow, node.tau + h, work, like)
    guard = lowest(flow, w, a, work)
    if guard.value <= 0.0:
        # just behind an event a guard is zero to rounding: a step must first get away from it, or never does
        stays = node.leaving and work.guards[2 * guard.number] <= -1e-3 * guard.value
        if stays and h * flow.body.frequency > 1e-12:
            return Landing(0.25 * h, True, False)
        return Landing(locate(flow, node.tau, h, accuracy, work, like), False, True)
    if node.leaving:
        return Landing(h, False, False)
    # between two ends without events a guard may have passed zero twice, or slip come close to rest
    shorter = hidden(flow, h, w, a, work)
    if shorter == h and min(length(node.w), length(w)) > 10.0 * accuracy:
        shorter = 0.5 * h if _dips(node.w, node.a, w, a, h, like) else h
    return Landing(shorter, shorter < h, False)


@inner
def _depart(flow: Flow, leaving: bool, work: Work, like: Any) -> Node:
    """Get ready for steps from ``work.start``, at the anchor of the flow."""
    w, a = _at_start(flow, work, like)
    note_guards(flow, w, a, work)
    least = 1e-9 * (swing_of(flow.body) + abs(flow.belt_speed))
    linearize(flow, flow.anchor, 1e-5 * length(w) + least, work, like)
    return Node(flow.anchor, w, a, leaving)


@inner
def _arrive(flow: Flow, tau: float, ends: bool, work: Work, like: Any) -> float:
    """Let the end of a step be the start of the next; returns the side of slip there."""
    side = flow.side
    if ends:
        w, a = rates_at_end(flow, tau, work, like)
        side = change(flow, w, a, work)
    for row in range(MEMORY + count_of(flow.law)):
        work.start[row] = work.end[row]
    restore(flow, work)
    return side


@inner
def follow(flow: Flow, friction: float, accuracy: float, track: Track, work: Work, like: Any) -> Any:
    """One span of the motion from ``work.start``, and back into it; returns the smallest slip speed and the steps.

    friction: the usual coefficient; accuracy: each step's, in the norm of energy. Steps are -1 where it gave up. On a
    track with room every piece of the way is noted.
    """
    law, body, belt_speed, end = flow.law, flow.body, flow.belt_speed, span(flow.body)
    longest = longest_step(body, friction, accuracy)
    began, share = OPEN, min(1.0, 2.0 * (accuracy / (body.normal_load * friction)) ** 0.0625)
    node, h, steps = _depart(flow, True, work, like), 0.1 * longest, 0
    closest = length(node.w)
    while end - node.tau > 4e-15 * end:
        h = min(h, longest, end - node.tau)
        growth = growth_factor(step(flow, node.tau, h, work, like) / accuracy, 5.0)
        steps += 1
        if steps > MOST_STEPS:
            return closest, -1
        if growth < 1.0:
            h = h * growth
            continue
        # an event cuts a step short, but says nothing about how long the next may be
        usual = h * growth
        landing = _landing(flow, node, h, accuracy, work, like)
        h = landing.h
        if landing.repeats:
            continue
        tau = node.tau + h if end - node.tau > h else end
        if track.stick.size > 0:
            _note(track, node.tau, h, False, flow, node.tau, work, like)
            step(flow, node.tau, h, work, like)
        flow = anchored(law, body, belt_speed, _arrive(flow, tau, landing.ends, work, like), tau)
        node = _depart(flow, landing.ends, work, like)
        closest = min(closest, length(node.w))
        # a reversal begins a layer, where steps grow with the way; none is known behind the start of the span
        began = _position(flow, work.start[Y]) if landing.ends else began
        h = min(usual, _layer(work, abs(_position(flow, work.start[Y]) - began), share, node.a, node.w))
    return closest, steps


@inner
def deflection_map(
    law: Any, body: Body, belt_speed: float, y: Any, u: Any, z: Any, accuracy: float, track: Track
) -> Mapped:
    """One span from the deviation (y, u) and the deflections z at tau = 0, which become those at its end.

    accuracy is each step's, in the norm of energy. On a track with room every piece of the way is noted.
    """
    work = workspace(law, y)
    friction = _measure(law, body, work, y)
    work.start[Y], work.start[U] = y, u
    if body.prescribed:  # the reference is the motion
        work.start[Y], work.start[U] = 0.0 * y, 0.0 * y
    for k in range(count_of(law)):
        work.start[MEMORY + k] = z[k]
    accuracy = min(accuracy, COARSEST * body.normal_load * friction / body.frequency)
    closest, steps = follow(_begun(law, body, belt_speed, work, y), friction, accuracy, track, work, y)
    for k in range(count_of(law)):
        z[k] = work.start[MEMORY + k]
    return Mapped(work.start[Y], work.start[U], work.start[IMPULSE], 0.0, closest, -1.0, steps)
