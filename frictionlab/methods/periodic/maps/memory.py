"""The period map of laws with other memory than one bristle: mass and memory together, on the line and in the plane.

However stiff the contact, steps follow the motion (Rodas5P). Within a step what moves with the slip goes on to, and
what yields too; where an element begins to yield or slip reverses, the step ends. Other corners of a law are met by
steps that are repeated until they are short enough. Where the slip is prescribed, friction moves nothing: only the
memory is followed.
"""

from __future__ import annotations

from typing import Any

from frictionlab.compile.decorators import inner
from frictionlab.compile.dispatch import length
from frictionlab.dynamics.motion import (
    belt_velocity,
    instant_at,
    instant_near,
    reference_velocity,
    slip,
    slip_at,
    span,
    turned,
)
from frictionlab.dynamics.step_size import growth_factor, longest_step
from frictionlab.methods.periodic.maps.deflection import COARSEST
from frictionlab.methods.periodic.maps.events import (
    begun_to_yield,
    located,
    passed,
    turning_point,
    turns,
    yield_point,
)
from frictionlab.methods.periodic.maps.jacobian import differentiate
from frictionlab.methods.periodic.maps.memory_rates import Problem, Work, anchored, rates, settled
from frictionlab.methods.periodic.maps.memory_state import Scales, scales_of, swing_of
from frictionlab.methods.periodic.maps.memory_step import crossed, stepped
from frictionlab.methods.periodic.maps.sliding import MOST_STEPS
from frictionlab.numerics.vectors import put, taken
from frictionlab.orbit.panels import NODES
from frictionlab.orbit.recorder import Track
from frictionlab.scene.body import Body

JUMP = 2
"""Repetitions of a step after which a rate is taken to jump within it, if errors fall slower than smooth ones."""
MOST_REJECTED = 8
"""The same however errors fall."""
MEANT = 1e4
"""Times the accuracy: an error beyond which a step says nothing about where slip reverses."""


@inner
def usual_friction(law: Any, body: Body) -> float:
    """The coefficient of steady sliding as fast as the friction-free motion."""
    return law.sliding_friction(swing_of(body))


@inner
def coarsest_of_memory(law: Any, body: Body) -> float:
    """The coarsest accuracy a map is made with, whatever is asked: two coarser maps are one and the same."""
    return COARSEST * body.normal_load * usual_friction(law, body) / body.frequency


@inner
def _note(
    track: Track, problem: Problem, tau: float, h: float, scales: Scales, work: Work, like: Any
) -> None:
    row = track.filled[0]
    if row == track.stick.size:
        return
    body = problem.body
    for k in range(NODES.size):
        part = 0.5 * h * (1.0 + NODES[k])
        if part > 0.0:
            stepped(problem, tau, part, scales, work, like)
        values = work.end if part > 0.0 else work.at
        rates(problem, tau + part, values, work, work.rates, like)
        sine, cosine = turned(problem, tau + part)
        track.tau[row, k] = tau + part
        track.x[row, k] = taken(values, 0, like) + body.reference_sine * sine + body.reference_cosine * cosine
        now = instant_near(problem, tau + part)
        track.v[row, k] = taken(values, 1, like) + belt_velocity(body, problem.belt_speed, now)
        track.friction[row, k] = taken(work.rates, 2, like)
    track.stick[row] = False
    track.filled[0] = row + 1


@inner
def _held(problem: Problem, tau: float, work: Work, like: Any) -> None:
    """Put a slip that is prescribed where it belongs."""
    put(work.at, 0, 0.0 * like)
    put(work.at, 1, slip_at(problem, tau, 0.0 * like))


@inner
def follow(
    law: Any,
    body: Body,
    belt_speed: float,
    scales: Scales,
    accuracy: float,
    track: Track,
    work: Work,
    like: Any,
) -> Any:
    """One span of the motion from ``work.at``, and back into it; returns the smallest slip speed and the steps.

    accuracy is each step's, in the norm of energy; steps are -1 where it gave up. On a track with room every piece of
    the way is noted.
    """
    end = span(body)
    accuracy = min(accuracy, coarsest_of_memory(law, body))
    reach = longest_step(body, usual_friction(law, body), accuracy)
    tau, h, steps, rejected, closest = 0.0, 0.1 * reach, 0, 0, 1e300
    beyond, usual, fresh = 0.0, 0.1 * reach, True
    missed, tried = 0.0, 1.0
    problem = anchored(law, body, belt_speed, 0.0)
    if body.prescribed:
        _held(problem, 0.0, work, like)
    rate0 = rates(problem, 0.0, work.at, work, work.rates, like)
    while end - tau > 4e-15 * end:
        w0 = taken(work.at, 1, like)
        if fresh:
            closest = min(closest, length(w0))
            problem = anchored(law, body, belt_speed, tau)
            differentiate(problem, tau, scales, work, like)
            fresh = False
        if beyond > 0.0:
            h, growth = min(beyond, end - tau), usual / beyond
            crossed(problem, tau, h, work, like)
            beyond = 0.0
        else:
            h = min(h, reach, end - tau)
            error = stepped(problem, tau, h, scales, work, like)
            steps += 1
            cornered = law.turning > 0.0 and error < MEANT * accuracy
            if cornered and turns(work, 1e-3 * accuracy, like):
                h, error, tries = turning_point(problem, tau, h, scales, accuracy, work, like)
                steps += tries
            if cornered and begun_to_yield(law, scales, work, like).yields:
                h, error, tries = yield_point(problem, tau, h, scales, accuracy, work, like)
                steps += tries
            growth = growth_factor(error / accuracy, 5.0)
        if steps > MOST_STEPS:
            return closest, -1
        if growth < 1.0:
            usual = h if rejected == 0 else usual
            smooth = rejected > 0 and error <= missed * (h / tried) ** 3
            rejected, missed, tried = rejected + 1, error, h
            if law.turning == 0.0 or rejected < JUMP or (smooth and rejected < MOST_REJECTED):
                h = h * growth
                continue
            h, beyond, tries = located(problem, tau, h, scales, accuracy, work, like)
            steps, growth = steps + tries, 1.0
            if h == 0.0:
                rejected = 0
                continue
        rate1 = rates(problem, tau + h, work.end, work, work.rates, like)
        w1 = taken(work.end, 1, like)
        if min(length(w0), length(w1)) > 10.0 * accuracy and passed(w0, rate0, w1, rate1, h + 0.0 * like):
            h, rejected, beyond = 0.5 * h, 0, 0.0
            continue
        if track.stick.size > 0:
            for row in range(work.end.size):
                work.kept[row] = work.end[row]
            _note(track, problem, tau, h, scales, work, like)
            for row in range(work.end.size):
                work.end[row] = work.kept[row]
        for row in range(work.at.size):
            work.at[row] = work.end[row]
        settled(work, like)
        tau = tau + h if end - tau > h else end
        if body.prescribed:
            _held(problem, tau, work, like)
        rate0, fresh, rejected = rate1, True, 0
        h = h * growth
    return closest, steps


@inner
def grain_of_memory(law: Any, body: Body, accuracy: float, like: Any) -> float:
    """What the steps of a map, of this accuracy each, may leave in the mean: a yield within one, or their sum."""
    most, scales = 0.0, scales_of(law, body, like)
    for unit in scales.unit:
        most = max(most, unit if law.turning > 0.0 else 0.0)
    return accuracy / body.normal_load * (2.0 * most + 10.0 / span(body))


@inner
def begun(body: Body, belt_speed: float, y: Any, u: Any, work: Work) -> None:
    """Put the beginning of a span into ``work.at``, but for the memory."""
    work.at[:] = 0.0
    put(work.at, 0, y)
    now = instant_at(body, 0.0)
    put(work.at, 1, slip(body, belt_speed, now, u + reference_velocity(body, now.sine, now.cosine)))
