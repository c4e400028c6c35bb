"""Closing an orbit of a law without memory: the fixed point of a period map, and how far from it the answer is.

No two orbits of a monotone law move apart in the norm of energy (Leine & van de Wouw, 2008), which makes a Picard
step always safe and turns a distance of states into a bound on the mean friction.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from frictionlab.compile.decorators import inner
from frictionlab.dynamics.motion import span
from frictionlab.methods.periodic.maps.sliding import Mapped
from frictionlab.methods.periodic.monodromy import free_inverse, newton_inverse
from frictionlab.methods.periodic.period_map import period_map, rest_of, unpack
from frictionlab.numerics.linalg import copy, multiply, norm, subtract
from frictionlab.orbit.recorder import track_of
from frictionlab.scene.body import Body

MOST_MAPS = 600
MUCH_WORK = 500_000
"""Steps, some tenths of a second, after which an orbit that need not exist is no longer looked for."""
FINER = 16.0
"""How much finer the last map is; of order eight, its own error is then a small part of what it measures."""


@inner
def broyden(inverse: Any, step: Any, change: Any, work: Any) -> None:
    """Broyden's update of the inverse (1965, by the Sherman-Morrison formula)."""
    n = step.size
    multiply(inverse, change, work)
    scale = 0.0
    for i in range(n):
        scale += step[i] * work[i]
    if abs(scale) < 1e-3 * norm(step) ** 2:
        return
    for column in range(n):
        row_sum = 0.0
        for i in range(n):
            row_sum += step[i] * inverse[i, column]
        change[column] = row_sum / scale
    for row in range(n):
        for column in range(n):
            inverse[row, column] = inverse[row, column] + (step[row] - work[row]) * change[column]


class Goal(NamedTuple):
    """What an orbit is closed for: the tolerance on the mean, and whether no two motions ever move apart.

    asks: whether starts that are quick to ask are to be followed until they come near.
    """

    tolerance: float
    contracts: bool
    asks: bool


ROUNDING = 2e-14
"""What the sums of a period's friction lose to rounding, in the mean coefficient."""


class FixedPoint(NamedTuple):
    """A closed orbit's integral of friction [periods], error of the mean, and what it took; maps < 0: gave up."""

    rubbed: Any
    error: float
    maps: int
    stuck: float
    closest: float
    first: float  # residual of the guess


@inner
def mean_sensitivity(
    law: Any, body: Body, belt_speed: float, z: Any, shift: Any, image: Mapped, accuracy: float, like: Any
) -> float:
    """By how much the mean changes where the state z, whose map is the image, is shifted."""
    trial, residual = np.empty(z.size), np.empty(z.size)
    subtract(z, shift, trial)
    moved = period_map(law, body, belt_speed, trial, residual, accuracy, track_of(0), like)
    return abs(moved.rubbed - image.rubbed) / span(body)


@inner
def mean_error(body: Body, residual: Any, distance: float) -> float:
    """Bound on the error of the mean friction of an orbit that closes up to the residual.

    Integrate the equation of motion along x1 over the period for the orbit and for the true one: the friction
    impulses differ by the change of du + damping*dy, which the residual is, plus the integral of dx, which the
    distance of the states bounds because orbits of a monotone law never move apart.
    """
    period = span(body)
    ends = abs(residual[1]) + (body.damping_mean + body.damping_split) * abs(residual[0])
    return (distance + ends / period) / body.normal_load


@inner
def line_search(
    law: Any, body: Body, belt_speed: float, z: Any, residual: Any, inverse: Any, accuracy: float, like: Any
) -> int:
    """Move z along the Newton step, halved until the residual falls; returns the maps it took, 8 for no fall."""
    n = z.size
    step, trial, fresh = np.empty(n), np.empty(n), np.empty(n)
    multiply(inverse, residual, step)
    length, part = norm(residual), 1.0
    for tried in range(1, 8):
        for i in range(n):
            trial[i] = z[i] - part * step[i]
        period_map(law, body, belt_speed, trial, fresh, accuracy, track_of(0), like)
        if norm(fresh) < (1.0 - 0.1 * part) * length:
            copy(trial, z)
            return tried
        part *= 0.5
    return 8


@inner
def fixed_point(
    law: Any,
    body: Body,
    belt_speed: float,
    z: Any,
    inverse: Any,
    goal: Goal,
    expected: float,
    like: Any,
) -> FixedPoint:
    """Find the fixed point from the guess z with the guess of the inverse of (monodromy - identity).

    Broyden steps with maps a little more accurate than the next residual (expected: the first one); where the
    residual stops falling, Newton with a difference Jacobian, then Picard. One criterion ends it: a map much
    finer than those the orbit was found with leaves a residual whose bound on the mean is below the tolerance.
    """
    n, tolerance = z.size, goal.tolerance
    residual, trial, fresh, step, work = np.empty(n), np.empty(n), np.empty(n), np.empty(n), np.empty(n)
    floor = 4e-15 * (1.0 + norm(z) + abs(belt_speed))
    finest = max(0.5 * tolerance * body.normal_load, floor)
    accuracy = min(max(finest, 1e-3 * expected), max(finest, 1e-4 * body.normal_load))
    period = span(body)
    image = period_map(law, body, belt_speed, z, residual, accuracy, track_of(0), like)
    maps, stalls, checks, first, troubled = 1, 0, 0, norm(residual), False
    while maps < MOST_MAPS:
        length = norm(residual)
        if image.steps < 0 or not length < 1e300:
            break
        if not goal.contracts and maps * image.steps > MUCH_WORK:
            break  # what repels, or is not there, is not to be found: other starts will tell
        if image.stuck >= period * (1.0 - 1e-9) and belt_speed != 0.0:
            y, _u = unpack(body, z, like)
            many = rest_of(law, body, belt_speed, y + period * belt_speed)
            for i in range(n):  # carried by the belt all the time: go on by many periods at once
                z[i] = z[i] + many * residual[i]
            image = period_map(law, body, belt_speed, z, residual, accuracy, track_of(0), like)
            maps += 1
            continue
        if image.stuck >= period * (1.0 - 1e-9):  # at rest on a belt at rest
            return FixedPoint(
                image.rubbed, floor / body.normal_load + ROUNDING, maps, image.stuck, 0.0, first
            )
        multiply(inverse, residual, step)
        if accuracy <= finest and mean_error(body, residual, norm(step)) <= 10.0 * tolerance:
            subtract(z, step, trial)
            copy(trial, z)
            accuracy = finest / FINER
            image = period_map(law, body, belt_speed, z, residual, accuracy, track_of(0), like)
            maps += 1
            checks += 1
            doubt = 0.0
            if (
                image.stuck > 0.0 or troubled or not goal.contracts
            ):  # both jump with the events: take them anew
                if not newton_inverse(law, body, belt_speed, z, accuracy, inverse, like):
                    break
                coarser = period_map(law, body, belt_speed, z, fresh, FINER * accuracy, track_of(0), like)
                maps += 2 * n + 1
                subtract(fresh, residual, fresh)
                multiply(inverse, fresh, work)
                doubt = mean_error(body, fresh, norm(work)) + abs(coarser.rubbed - image.rubbed) / period
                if not goal.contracts:
                    doubt += mean_sensitivity(law, body, belt_speed, z, work, image, accuracy, like)
                    multiply(inverse, residual, work)
                    doubt += mean_sensitivity(law, body, belt_speed, z, work, image, accuracy, like)
            multiply(inverse, residual, work)
            error = 2.0 * (mean_error(body, residual, norm(work)) + doubt)
            error += (floor + 0.1 * accuracy) / body.normal_load + ROUNDING  # and the finer map's own error
            if error <= tolerance or (finest <= floor and checks > 3):
                return FixedPoint(image.rubbed, error, maps, image.stuck, image.closest, first)
            finest, troubled = max(floor, accuracy), troubled or checks > 2
            continue
        finer = max(finest, min(accuracy, 1e-4 * length))
        subtract(z, step, trial)
        image = period_map(law, body, belt_speed, trial, fresh, finer, track_of(0), like)
        maps += 1
        falls, usable = norm(fresh) < 0.7 * length, norm(fresh) <= 1.5 * length
        if usable:
            for i in range(n):
                step[i] = -step[i]
                work[i] = fresh[i] - residual[i]
            copy(trial, z)
            copy(fresh, residual)
            if accuracy <= 0.05 * length:
                broyden(inverse, step, work.copy(), work)
        accuracy = finer
        stalls = 0 if falls else stalls + 1
        if stalls == 0 or (stalls == 1 and usable):
            continue
        if accuracy <= finest and length <= 30.0 * accuracy and finest > floor:
            finest = max(floor, finest / FINER)  # what is left is the error of the map itself
        else:
            troubled = True
            regular = newton_inverse(law, body, belt_speed, z, finest, inverse, like)
            maps += 2 * n
            if not regular:
                free_inverse(body, body.normal_load, inverse, like)
            tried = line_search(law, body, belt_speed, z, residual, inverse, accuracy, like)
            maps += tried
            for _ in range(0 if regular and tried < 8 else 3):
                image = period_map(law, body, belt_speed, z, residual, accuracy, track_of(0), like)
                maps += 1
                for i in range(n):
                    z[i] = z[i] + residual[i]
            image = period_map(law, body, belt_speed, z, residual, accuracy, track_of(0), like)
            maps += 1
        stalls = 1
    return FixedPoint(image.rubbed, 1e300, -maps, image.stuck, image.closest, first)
