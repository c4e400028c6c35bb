"""The period map of deflections that follow the slip until they yield: mass and memory together by Rodas5P.

However stiff the contact, steps follow the motion. A step ends where a deflection meets or leaves its yield surface
and, on the line, where slip reverses; between such events everything is smooth.
"""

from __future__ import annotations

from typing import Any

from frictionlab.compile.decorators import inner
from frictionlab.compile.dispatch import by_dimension, length
from frictionlab.compile.stack import count_of
from frictionlab.dynamics.events import dips
from frictionlab.dynamics.motion import instant_near, reference_velocity, span
from frictionlab.dynamics.step_size import growth_factor, longest_step
from frictionlab.methods.periodic.maps.bristle import COARSEST
from frictionlab.methods.periodic.maps.linearization import linearize
from frictionlab.methods.periodic.maps.memory_state import scales_of, swing_of
from frictionlab.methods.periodic.maps.modes import (
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


@inner
def _measure(law: Any, body: Body, work: Work, like: Any) -> None:
    """Of every deflection: its size in steady sliding, and what it is multiplied by in the norm of energy."""
    scales = scales_of(law, body, like)
    for k in range(count_of(law)):
        work.unit[k], work.size[k] = scales.unit[k], scales.size[k]


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


@inner
def follow(flow: Flow, accuracy: float, track: Track, work: Work, like: Any) -> Any:
    """One span of the motion from ``work.start``, and back into it; returns the smallest slip speed and the steps.

    accuracy is each step's, in the norm of energy; steps are -1 where it gave up. On a track with room every piece of
    the way is noted.
    """
    law, body, belt_speed, end = flow.law, flow.body, flow.belt_speed, span(flow.body)
    longest = longest_step(body, law.sliding_friction(swing_of(body)), accuracy)
    tau, h, side, steps, closest = 0.0, 0.1 * longest, flow.side, 0, 1e300
    fresh, leaving, usual = True, True, longest
    least = 1e-9 * (swing_of(body) + abs(belt_speed))
    w0, a0 = _at_start(flow, work, like)
    while end - tau > 4e-15 * end:
        if fresh:
            flow = anchored(law, body, belt_speed, side, tau)
            w0, a0 = _at_start(flow, work, like)
            closest = min(closest, length(w0))
            note_guards(flow, w0, a0, work)
            linearize(flow, tau, 1e-5 * length(w0) + least, work, like)
            fresh = False
        h = min(h, longest, end - tau)
        growth = growth_factor(step(flow, tau, h, work, like) / accuracy, 5.0)
        steps += 1
        if steps > MOST_STEPS:
            return closest, -1
        if growth < 1.0:
            h = h * growth
            continue
        w1, a1 = rates_at_end(flow, tau + h, work, like)
        guard, usual = lowest(flow, w1, a1, work), h * growth
        ends = guard.value <= 0.0
        if ends:
            # just behind an event a guard is zero to rounding: a step must first get away from it, or never does
            stays = leaving and work.guards[2 * guard.number] <= -1e-3 * guard.value
            if stays and h * body.frequency > 1e-12:
                h = 0.25 * h
                continue
            h = locate(flow, tau, h, accuracy, work, like)
            w1, a1 = rates_at_end(flow, tau + h, work, like)
        elif not leaving:
            # between two steps without events a guard may have passed zero twice, or slip come close to rest
            shorter = hidden(flow, h, w1, a1, work)
            if shorter == h and min(length(w0), length(w1)) > 10.0 * accuracy:
                shorter = 0.5 * h if _dips(w0, a0, w1, a1, h, like) else h
            if shorter < h:
                h = shorter
                continue
        if track.stick.size > 0:
            _note(track, tau, h, False, flow, tau, work, like)
            step(flow, tau, h, work, like)
            w1, a1 = rates_at_end(flow, tau + h, work, like)
        if ends:
            side = change(flow, w1, a1, work)
        leaving, fresh = ends, True
        tau = tau + h if end - tau > h else end
        for row in range(MEMORY + count_of(law)):
            work.start[row] = work.end[row]
        restore(flow, work)
        h = usual
    return closest, steps


@inner
def deflection_map(
    law: Any, body: Body, belt_speed: float, y: Any, u: Any, z: Any, accuracy: float, track: Track
) -> Mapped:
    """One span from the deviation (y, u) and the deflections z at tau = 0, which become those at its end.

    accuracy is each step's, in the norm of energy. On a track with room every piece of the way is noted.
    """
    work = workspace(law, y)
    _measure(law, body, work, y)
    work.start[Y], work.start[U] = y, u
    if body.prescribed:  # the reference is the motion
        work.start[Y], work.start[U] = 0.0 * y, 0.0 * y
    for k in range(count_of(law)):
        work.start[MEMORY + k] = z[k]
    accuracy = min(
        accuracy, COARSEST * body.normal_load * law.sliding_friction(swing_of(body)) / body.frequency
    )
    closest, steps = follow(_begun(law, body, belt_speed, work, y), accuracy, track, work, y)
    for k in range(count_of(law)):
        z[k] = work.start[MEMORY + k]
    return Mapped(work.start[Y], work.start[U], work.start[IMPULSE], 0.0, closest, -1.0, steps)
