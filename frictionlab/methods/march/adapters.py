"""Steppers of march: the numbers of each, and its step for a mass, a contact and what the contact remembers.

A stepper is a record; kernels choose their step by its type, so that one march serves all of them.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from frictionlab.compile.decorators import embedded, fast, inner
from frictionlab.compile.dispatch import (
    as_argument,
    by_law,
    by_stepper,
    length,
)
from frictionlab.compile.stack import count_of, room
from frictionlab.motion import contact as smoothing
from frictionlab.motion.contact import (
    friction_of,
    project_to_yield,
    rate_of,
    resistance,
    resistance_at_share,
)
from frictionlab.motion.equation import (
    Acting,
    acceleration,
    acceleration_under,
    belt_swing,
    instant_at,
    linear_force,
    normal_load,
    restoring_force,
    slip,
    slopes_at,
)
from frictionlab.motion.maps.memory_state import pulled
from frictionlab.motion.orbit.recorder import panel_writer
from frictionlab.motion.steppers import dop853, rk4
from frictionlab.motion.steppers.moreau import moreau_step
from frictionlab.motion.steppers.rk4 import rk4_step
from frictionlab.motion.steppers.sdirk2 import sdirk2_step
from frictionlab.motion.steppers.step import (
    LAST,
    StepEnd,
    StepStart,
    belt_at,
    growth_of,
    load_at,
    normal_load_at,
)
from frictionlab.scene.body import BodyNumbers


class Moreau(NamedTuple):
    """theta: where in a step springs, dashpots and friction act, from its start (0) to its end (1)."""

    theta: float


class Rk4(NamedTuple):
    """decay: largest stable step times rate of decay."""

    decay: float = rk4.DECAY


class Smoothed(NamedTuple):
    """DOP853 on friction smoothed over a slip speed, by a shape; accuracy of a step, in the energy norm."""

    width: float
    shape: float
    accuracy: float


class Sdirk2(NamedTuple):
    """decay: stable for any step."""

    decay: float = math.inf


Stepper = Moreau | Rk4 | Smoothed | Sdirk2


class MarchProblem(NamedTuple):
    """Scene and law as a stepper sees them; memory, ahead: of the law where a step starts, and where it ends."""

    law: Any
    body: BodyNumbers
    belt_speed: float
    stepper: Any
    grid: Any  # motion/steppers/step.py
    memory: Any
    ahead: Any


class SmoothedFriction(NamedTuple):
    """A law, and over which slip speed and by which shape its jump at rest is smoothed."""

    law: Any
    width: float
    shape: float


# --- a normal load that changes -----------------------------------------------------------------------------------


@fast
def in_shares(body: BodyNumbers, pressed: float, mu: Any) -> Any:
    """Friction in shares of the mean normal load, from its coefficient."""
    return pressed / body.normal_load * mu


@fast
def bristle_resistance(body: BodyNumbers, law: Any, w: Any, z: Any, pressed: float) -> Any:
    """Return the rate of one bristle, and the friction coefficient."""
    if len(body.varying.keeps_stiffness) == 0:
        return resistance(law, w, z)
    return resistance_at_share(law, w, z, pressed / body.normal_load)


@fast
def bristle_within_yield(body: BodyNumbers, law: Any, z: Any, pressed: float) -> Any:
    """Return the deflection, not beyond yield."""
    n = pressed / body.normal_load if len(body.varying.keeps_stiffness) > 0 else 1.0
    return n * project_to_yield(law, z / n)


# --- friction of a stage ------------------------------------------------------------------------------------------


def _of_slip_alone(problem: MarchProblem, w: Any, memory: Any, moving: Any, pressed: float) -> Any:
    """Blind to stick: friction is along the slip wherever there is any."""
    return problem.law.sliding_vector(w) if length(w) > 0.0 else 0.0 * w


def _of_a_bristle(problem: MarchProblem, w: Any, memory: Any, moving: Any, pressed: float) -> Any:
    rate, mu = bristle_resistance(problem.body, problem.law, w, memory[0], pressed)
    moving[0] = rate
    return mu


@inner
def _of_several(problem: MarchProblem, w: Any, memory: Any, moving: Any) -> Any:
    law = problem.law
    for i in range(count_of(law)):
        moving[i] = rate_of(law, memory, i, w)
    return friction_of(law, memory, moving, w)


def _of_deflections(problem: MarchProblem, w: Any, memory: Any, moving: Any, pressed: float) -> Any:
    return _of_several(problem, w, memory, moving)


def _of_scalars(problem: MarchProblem, w: Any, memory: Any, moving: Any, pressed: float) -> Any:
    # A scalar that has left its set makes the motion not a number: the march ends as one that is lost.
    if not problem.law.within(memory):
        return math.nan * w
    return _of_several(problem, w, memory, moving)


contact_friction = by_law(_of_slip_alone, _of_a_bristle, _of_deflections, _of_scalars)
"""contact_friction(problem, w, memory, moving, pressed): the coefficient at a slip velocity under a normal load;
writes the memory's rates."""


def _nothing_to_project(problem: MarchProblem, pressed: float) -> None:
    return


def _project_bristle(problem: MarchProblem, pressed: float) -> None:
    problem.ahead[0] = bristle_within_yield(problem.body, problem.law, problem.ahead[0], pressed)


def _project_deflections(problem: MarchProblem, pressed: float) -> None:
    pulled(problem.law, problem.ahead, room(problem.law, 1, 0, problem.ahead[0]))


project_memory = by_law(_nothing_to_project, _project_bristle, _project_deflections, _nothing_to_project)
"""project_memory(problem, pressed): bring back what a step that ends under a normal load has left beyond the
deflections that slip can lead to."""


# --- steps --------------------------------------------------------------------------------------------------------


@as_argument
@embedded
def _rates_of_the_grid(
    problem: MarchProblem, k: int, part: int, x: Any, v: Any, memory: Any, moving: Any
) -> Any:
    """Acceleration and friction at a node of a step."""
    body, push, pressed = problem.body, load_at(problem, k, part), normal_load_at(problem, k, part)
    mu = contact_friction(problem, v - belt_at(problem, k, part), memory, moving, pressed)
    return acceleration_under(body, push, pressed, x, v, mu), in_shares(body, pressed, mu)


@embedded
def _smooth_rates(problem: MarchProblem, stage: int, tau: float, x: Any, v: Any) -> Any:
    """Acceleration and smoothed friction at any time."""
    body, now, stepper = problem.body, instant_at(problem.body, tau), problem.stepper
    smooth = SmoothedFriction(problem.law, stepper.width, stepper.shape)
    mu = smoothing.friction(smooth, slip(body, problem.belt_speed, now, v))
    return acceleration(body, now, x, v, mu), in_shares(body, normal_load(body, now), mu)


@as_argument
@embedded
def _rates_with_a_bristle(problem: MarchProblem, acts: Acting, x: Any, v: Any, z: Any) -> Any:
    """Acceleration, friction and rate of deflection."""
    body = problem.body
    rate, mu = bristle_resistance(body, problem.law, v - acts.belt, z, acts.pressed)
    a = acceleration_under(body, acts.push, acts.pressed, x, v, mu)
    return a, in_shares(body, acts.pressed, mu), rate


@as_argument
@fast
def _expanded_force(body: BodyNumbers, x: Any, v: Any, ahead: Any, later: Any) -> Any:
    """Return the restoring force on another motion, linear about x, v."""
    if len(body.bends.some) == 0:
        return linear_force(body, ahead, later)
    return restoring_force(body, x, v) + linear_force(slopes_at(body, x, v), ahead - x, later - v)


@as_argument
@fast
def _slopes_at(body: BodyNumbers, x: Any, v: Any) -> Any:
    return slopes_at(body, x, v)


_smooth_step = dop853.stepper(_smooth_rates, dop853.unprepared)


def _by_moreau(problem: MarchProblem, start: StepStart, h: float) -> StepEnd:
    return moreau_step(_expanded_force, _slopes_at, problem, start, h)


def _by_rk4(problem: MarchProblem, start: StepStart, h: float) -> StepEnd:
    # A step may leave a deflection beyond the set that slip leads to, where it would stay: it is brought back.
    end = rk4_step(_rates_of_the_grid, problem, start, h)
    project_memory(problem, normal_load_at(problem, start.k, LAST))
    return end


def _by_dop853(problem: MarchProblem, start: StepStart, h: float) -> StepEnd:
    """A step whose error decides how long it may be."""
    body, belt_speed = problem.body, problem.belt_speed
    # The slopes at the start are found anew: the last step may have been repeated, or ended at a zero of velocity.
    a, mu = _smooth_rates(problem, 0, start.tau, start.x, start.v)
    end = _smooth_step(problem, start.tau, dop853.State(start.x, start.v, a, mu), h)
    growth = growth_of(body, end, problem.stepper.accuracy)
    before = slip(body, belt_speed, instant_at(body, start.tau), start.v)
    # Slip may have come and gone within the step: the error estimate can be blind to that.
    if growth >= 1.0 and length(end.v - start.v) > 2.0 * length(before) + 8.0 * problem.stepper.width:
        growth = 0.5
    return StepEnd(end.x, end.v, end.friction_impulse, False, growth)


def _by_sdirk2(problem: MarchProblem, start: StepStart, h: float) -> StepEnd:
    body = problem.body
    end = sdirk2_step(_rates_with_a_bristle, problem, start, h, belt_swing(body))
    project_memory(problem, normal_load(body, instant_at(body, start.tau + h)))
    return end


advance = by_stepper(
    {
        Moreau: _by_moreau,
        Rk4: _by_rk4,
        Smoothed: _by_dop853,
        Sdirk2: _by_sdirk2,
    }
)
"""advance(problem, start, h): the end of a step."""


# --- the record of an orbit ---------------------------------------------------------------------------------------


@inner
def _on_a_parabola(problem: MarchProblem, part: float, start: StepStart, end: StepEnd, h: float) -> Any:
    """Between ends that alone are known: velocity changes evenly, friction is its mean."""
    # Position is the integral of that velocity, and what it misses of the step's end spread evenly.
    share, stray = part / h, end.x - start.x - 0.5 * h * (start.v + end.v)
    x = start.x + share * (h * (start.v + 0.5 * share * (end.v - start.v)) + stray)
    return x, start.v + share * (end.v - start.v), end.impulse / h


def _by_another_step(problem: MarchProblem, part: float, start: StepStart, end: StepEnd, h: float) -> Any:
    """A step of high order is taken anew to there."""
    between = advance(problem, start, part)
    _, mu = _smooth_rates(problem, 0, start.tau + part, between.x, between.v)
    return between.x, between.v, mu


state_within = by_stepper(dict.fromkeys((Moreau, Rk4, Sdirk2), _on_a_parabola) | {Smoothed: _by_another_step})


@inner
def _state_at(part: float, problem: MarchProblem, start: StepStart, end: StepEnd, h: float) -> Any:
    """Position, velocity and friction a while into a step."""
    return state_within(problem, part, start, end, h)


note_step = panel_writer(_state_at)
"""note_step(track, tau, h, stick, problem, start, end, h): write a step down as a panel of an orbit."""
