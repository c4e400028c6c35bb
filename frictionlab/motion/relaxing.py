"""Springs that relax, beside those of the body along x1: forces q' = stiffness x1' - rate q, each by itself.

As all that is linear they are followed as what deviates from the friction-free response. In the norm of energy a
force is measured by the root of its spring's stiffness. Maps by Rodas5P hold them as rows of a state; maps by DOP853
as one number, of eight lanes where there are eight.
"""

from __future__ import annotations

import math
from typing import Any

from frictionlab.compile.decorators import fast
from frictionlab.compile.dispatch import by_dimension, by_relaxing, by_variation
from frictionlab.compile.lane_arrays import as_one_number, lane, summed, with_lane
from frictionlab.motion.waves import number_at
from frictionlab.scene.body import BodyNumbers, Relaxing
from frictionlab.scene.varying import PER_WAVE

elements_of = by_relaxing(lambda body: 0, lambda body: len(body.relaxing.rate))
"""elements_of(body): how many there are, a constant to the compiler."""

hardest = by_relaxing(lambda body: 0.0, lambda body: body.relaxing.hardest)
"""hardest(body): the stiffness of all together."""

lasting = by_relaxing(lambda body: 0.0, lambda body: body.relaxing.lasting)
"""lasting(body): all together as a dashpot."""

stable_step = by_relaxing(lambda body: 1e300, lambda body: 4.0 / body.relaxing.fastest)
"""stable_step(body): for which DOP853 is stable on the fastest, however little the mass feels it."""

along_x1 = by_dimension(lambda force, example: force, lambda force, example: complex(force, 0.0))
"""along_x1(force, example): force along x1, float or complex as the example is."""


# --- as rows of a state -------------------------------------------------------------------------------------------


def _total(body: BodyNumbers, rows: Any, first: int) -> float:
    total = 0.0
    for k in range(elements_of(body)):
        total += rows[first + k].real
    return total


relaxing_force = by_relaxing(lambda body, rows, first: 0.0, _total)
"""relaxing_force(body, rows, first): of all together, from what the rows of a state hold from the first on."""


def _rate_of(body: BodyNumbers, k: int, q: Any, u: Any) -> float:
    return body.relaxing.stiffness[k] * u.real - body.relaxing.rate[k] * q.real


relaxing_rate = by_relaxing(lambda body, k, q, u: 0.0, _rate_of)
"""relaxing_rate(body, k, q, u): of one force, of a motion at velocity u."""

energy_unit = by_relaxing(lambda body, k: 1.0, lambda body, k: 1.0 / math.sqrt(body.relaxing.stiffness[k]))
"""energy_unit(body, k): what one force is multiplied by in the norm of energy."""


# --- as one number --------------------------------------------------------------------------------------------------


@fast
def _with_springs(body: BodyNumbers, relaxing: Relaxing) -> BodyNumbers:
    return BodyNumbers(
        body.damping_mean, body.damping_split, body.stiffness_mean, body.stiffness_split, body.normal_load,
        body.frequency, body.load_sine, body.load_cosine, body.balanced_sine, body.balanced_cosine,
        body.reference_sine, body.reference_cosine, body.periods, body.prescribed, body.varying, body.bends, relaxing,
    )  # fmt: skip


@fast
def with_force(body: BodyNumbers, force: Any, since: float) -> BodyNumbers:
    """The body which knows its relaxing forces at a time."""
    old = body.relaxing
    relaxing = Relaxing(old.stiffness, old.rate, force, since, old.hardest, old.lasting, old.fastest)
    return _with_springs(body, relaxing)


def _of_one_number(body: BodyNumbers) -> BodyNumbers:
    old = body.relaxing
    force = as_one_number(old.force)
    relaxing = Relaxing(
        as_one_number(old.stiffness),
        as_one_number(old.rate),
        force,
        old.since,
        old.hardest,
        old.lasting,
        old.fastest,
    )
    return _with_springs(body, relaxing)


in_one_number = by_relaxing(lambda body: body, _of_one_number)
"""in_one_number(body): the body with its relaxing springs so."""


def _read(body: BodyNumbers, state: Any) -> Any:
    force, m = as_one_number(body.relaxing.force), elements_of(body)
    for k in range(m):
        force = with_lane(force, k, state[state.size - m + k] / energy_unit(body, k))
    return force


read_forces = by_relaxing(lambda body, state: 0.0, _read)
"""read_forces(body, state): as one number, from a state; the body has its springs as tuples."""


def _write(body: BodyNumbers, state: Any, force: Any) -> None:
    m = elements_of(body)
    for k in range(m):
        state[state.size - m + k] = energy_unit(body, k) * lane(force, k)


write_forces = by_relaxing(lambda body, state, force: None, _write)
"""write_forces(body, state, force): the other way round."""


@fast
def _of_a_sine(body: BodyNumbers, frequency: float, sine: float, cosine: float, tau: float) -> Any:
    """Forces under the velocity sine*sin(frequency tau) + cosine*cos(frequency tau), gone on for ever."""
    stiffness, rate, angle = body.relaxing.stiffness, body.relaxing.rate, frequency * tau
    s, c = math.sin(angle), math.cos(angle)
    turned = sine * (rate * s - frequency * c) + cosine * (rate * c + frequency * s)
    return stiffness * turned / (rate * rate + frequency * frequency)


@fast
def reference_force(body: BodyNumbers, tau: float) -> Any:
    """Of the friction-free response, as one number."""
    omega = body.frequency
    sine, cosine = -omega * body.reference_cosine.real, omega * body.reference_sine.real
    return _of_a_sine(body, omega, sine, cosine, tau)


def _carrying(body: BodyNumbers, force: Any, tau: float) -> BodyNumbers:
    return with_force(body, force + reference_force(body, tau), tau)


carrying = by_relaxing(lambda body, force, tau: body, _carrying)
"""carrying(body, force, tau): the body which knows, from those of its deviation, its relaxing forces at this time."""

deviating_force = by_relaxing(
    lambda body, tau: 0.0, lambda body, tau: body.relaxing.force - reference_force(body, tau)
)
"""deviating_force(body, tau): those of its deviation, from the ones the body knows at this time."""


# --- at rest on the belt --------------------------------------------------------------------------------------------


def _on_a_varying_belt(body: BodyNumbers, belt_speed: float, tau: float) -> Any:
    varying, course = body.varying, body.varying.belt
    stiffness, rate, slope = body.relaxing.stiffness, body.relaxing.rate, course.slope.real
    line = belt_speed + course.value.real + (tau - varying.begins) * slope
    total = stiffness * (line - slope / rate) / rate
    for j in range(course.terms):
        place = course.first + PER_WAVE * j
        sine = number_at(varying.table, place + 1, course.value).real
        cosine = number_at(varying.table, place + 3, course.value).real
        total = total + _of_a_sine(body, varying.table[place], sine, cosine, tau)
    return total


_gone_on = by_variation(
    lambda body, belt_speed, tau: (belt_speed * body.relaxing.stiffness) / body.relaxing.rate,
    _on_a_varying_belt,
)
"""_gone_on(body, belt_speed, tau): forces on a mass at rest for ever."""


@fast
def _decayed(force: Any, rate: Any, lasts: float) -> Any:
    for k in range(int(summed(0.0 * rate + 1.0))):
        force = with_lane(force, k, lane(force, k) * math.exp(-lane(rate, k) * lasts))
    return force


@fast
def _forces_at_rest(body: BodyNumbers, belt_speed: float, tau: float) -> Any:
    since = body.relaxing.since
    left = body.relaxing.force - _gone_on(body, belt_speed, since)
    return _gone_on(body, belt_speed, tau) + _decayed(left, body.relaxing.rate, tau - since)


at_rest_until = by_relaxing(
    lambda body, belt_speed, tau: body,
    lambda body, belt_speed, tau: with_force(body, _forces_at_rest(body, belt_speed, tau), tau),
)
"""at_rest_until(body, belt_speed, tau): the body which knows its forces then, at rest since it last did."""


def _holding(body: BodyNumbers, belt_speed: float, tau: float, velocity: float, pushed: float) -> Any:
    stiffness, rate = body.relaxing.stiffness, body.relaxing.rate
    force = _forces_at_rest(body, belt_speed, tau)
    first = stiffness * velocity - rate * force
    return summed(force), summed(first), summed(stiffness * pushed - rate * first)


held_back = by_relaxing(lambda body, belt_speed, tau, velocity, pushed: (0.0, 0.0, 0.0), _holding)
"""held_back(body, belt_speed, tau, velocity, pushed): the force at rest, its rate and the rate of that; velocity and
acceleration are the belt's along x1."""


def _impulse_at_rest(body: BodyNumbers, belt_speed: float, start: float, end: float, travel: float) -> float:
    gained = _forces_at_rest(body, belt_speed, end) - _forces_at_rest(body, belt_speed, start)
    return summed((travel * body.relaxing.stiffness - gained) / body.relaxing.rate)


held_back_impulse = by_relaxing(lambda body, belt_speed, start, end, travel: 0.0, _impulse_at_rest)
"""held_back_impulse(body, belt_speed, start, end, travel): its integral; travel: of the belt along x1."""


@fast
def held_back_curvature(body: BodyNumbers, velocity: float, pushed: float) -> float:
    """A bound on its second derivative from the time on at which the body knows its forces.

    velocity: of the belt then, along x1; pushed: a bound on its acceleration.
    """
    rate = body.relaxing.rate
    falls = rate * (body.relaxing.stiffness * velocity - rate * body.relaxing.force)
    return math.sqrt(summed(0.0 * rate + 1.0) * summed(falls * falls)) + 2.0 * body.relaxing.hardest * pushed
