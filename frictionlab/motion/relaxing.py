"""Springs that relax, beside those of the body along x1: forces q' = stiffness x1' - rate q, each by itself.

These springs are linear, so maps follow the deviation of their forces from the friction-free response. In the
norm of energy a force is divided by the root of its spring's stiffness. Maps by Rodas5P hold the forces as
rows of a state. Maps by DOP853 hold them as one number, of eight lanes where there are eight.
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
"""elements_of(body): number of relaxing springs, a constant to the compiler."""

hardest = by_relaxing(lambda body: 0.0, lambda body: body.relaxing.hardest)
"""hardest(body): stiffness of all relaxing springs together."""

lasting = by_relaxing(lambda body: 0.0, lambda body: body.relaxing.lasting)
"""lasting(body): damping coefficient of all relaxing springs together, as one dashpot."""

stable_step = by_relaxing(lambda body: 1e300, lambda body: 4.0 / body.relaxing.fastest)
"""stable_step(body): longest step for which DOP853 is stable on the fastest relaxation, even if the mass
hardly feels it."""

along_x1 = by_dimension(lambda force, example: force, lambda force, example: complex(force, 0.0))
"""along_x1(force, example): force along x1, float or complex as the example is."""


# --- as rows of a state -------------------------------------------------------------------------------------------


def _total(body: BodyNumbers, rows: Any, first: int) -> float:
    total = 0.0
    for k in range(elements_of(body)):
        total += rows[first + k].real
    return total


relaxing_force = by_relaxing(lambda body, rows, first: 0.0, _total)
"""relaxing_force(body, rows, first): sum of the forces, which stand in the rows of a state from ``first``
on."""


def _rate_of(body: BodyNumbers, k: int, q: Any, u: Any) -> float:
    return body.relaxing.stiffness[k] * u.real - body.relaxing.rate[k] * q.real


relaxing_rate = by_relaxing(lambda body, k, q, u: 0.0, _rate_of)
"""relaxing_rate(body, k, q, u): rate of the k-th force q, of a motion at velocity u."""

energy_unit = by_relaxing(lambda body, k: 1.0, lambda body, k: 1.0 / math.sqrt(body.relaxing.stiffness[k]))
"""energy_unit(body, k): factor of the k-th force in the norm of energy."""


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
    """Return the body with these relaxing forces, known at the time ``since``."""
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
"""in_one_number(body): body with the numbers of its relaxing springs, and their forces, each as one
number."""


def _read(body: BodyNumbers, state: Any) -> Any:
    force, m = as_one_number(body.relaxing.force), elements_of(body)
    for k in range(m):
        force = with_lane(force, k, state[state.size - m + k] / energy_unit(body, k))
    return force


read_forces = by_relaxing(lambda body, state: 0.0, _read)
"""read_forces(body, state): relaxing forces of a state as one number; the body holds its springs as
tuples."""


def _write(body: BodyNumbers, state: Any, force: Any) -> None:
    m = elements_of(body)
    for k in range(m):
        state[state.size - m + k] = energy_unit(body, k) * lane(force, k)


write_forces = by_relaxing(lambda body, state, force: None, _write)
"""write_forces(body, state, force): write relaxing forces, given as one number, into a state."""


@fast
def _of_a_sine(body: BodyNumbers, frequency: float, sine: float, cosine: float, tau: float) -> Any:
    """Return the forces under a sinusoidal velocity that has always acted.

    The velocity is sine*sin(frequency tau) + cosine*cos(frequency tau).
    """
    stiffness, rate, angle = body.relaxing.stiffness, body.relaxing.rate, frequency * tau
    s, c = math.sin(angle), math.cos(angle)
    turned = sine * (rate * s - frequency * c) + cosine * (rate * c + frequency * s)
    return stiffness * turned / (rate * rate + frequency * frequency)


@fast
def reference_force(body: BodyNumbers, tau: float) -> Any:
    """Return the relaxing forces of the friction-free response, as one number."""
    omega = body.frequency
    sine, cosine = -omega * body.reference_cosine.real, omega * body.reference_sine.real
    return _of_a_sine(body, omega, sine, cosine, tau)


def _carrying(body: BodyNumbers, force: Any, tau: float) -> BodyNumbers:
    return with_force(body, force + reference_force(body, tau), tau)


carrying = by_relaxing(lambda body, force, tau: body, _carrying)
"""carrying(body, force, tau): body that knows its relaxing forces at this time, from those of its
deviation."""

deviating_force = by_relaxing(
    lambda body, tau: 0.0, lambda body, tau: body.relaxing.force - reference_force(body, tau)
)
"""deviating_force(body, tau): relaxing forces of the deviation, from those that the body knows at this
time."""


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
"""_gone_on(body, belt_speed, tau): relaxing forces on a mass that has been at rest on the belt for ever."""


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
"""at_rest_until(body, belt_speed, tau): body that knows its relaxing forces at this time, after rest on the
belt since the time at which it last knew them."""


def _holding(body: BodyNumbers, belt_speed: float, tau: float, velocity: float, pushed: float) -> Any:
    stiffness, rate = body.relaxing.stiffness, body.relaxing.rate
    force = _forces_at_rest(body, belt_speed, tau)
    first = stiffness * velocity - rate * force
    return summed(force), summed(first), summed(stiffness * pushed - rate * first)


held_back = by_relaxing(lambda body, belt_speed, tau, velocity, pushed: (0.0, 0.0, 0.0), _holding)
"""held_back(body, belt_speed, tau, velocity, pushed): relaxing force on a mass at rest on the belt, its first
and its second derivative; velocity, pushed: velocity and acceleration of the belt along x1."""


def _impulse_at_rest(body: BodyNumbers, belt_speed: float, start: float, end: float, travel: float) -> float:
    gained = _forces_at_rest(body, belt_speed, end) - _forces_at_rest(body, belt_speed, start)
    return summed((travel * body.relaxing.stiffness - gained) / body.relaxing.rate)


held_back_impulse = by_relaxing(lambda body, belt_speed, start, end, travel: 0.0, _impulse_at_rest)
"""held_back_impulse(body, belt_speed, start, end, travel): integral of this force; travel: distance that the
belt travels along x1."""


@fast
def held_back_curvature(body: BodyNumbers, velocity: float, pushed: float) -> float:
    """Return a bound on the second derivative of this force.

    It holds from the time on at which the body knows its forces.

    velocity: of the belt at that time, along x1; pushed: bound on its acceleration.
    """
    rate = body.relaxing.rate
    falls = rate * (body.relaxing.stiffness * velocity - rate * body.relaxing.force)
    return math.sqrt(summed(0.0 * rate + 1.0) * summed(falls * falls)) + 2.0 * body.relaxing.hardest * pushed
