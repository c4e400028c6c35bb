"""Closing an orbit of a law without memory: the fixed point of a period map, and how far from it the answer is.

No two orbits of a monotone law move apart in the norm of energy (Leine & van de Wouw, 2008), which makes a Picard
step always safe and turns a distance of states into a bound on the mean friction.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from frictionlab.kernel import by_law, inner
from frictionlab.methods.bristle_map import dimension
from frictionlab.methods.period import mapped, rest_of, unpack
from frictionlab.methods.sliding_map import Mapped, span
from frictionlab.methods.track import track_of
from frictionlab.scene import Body

MOST_MAPS = 600
MUCH_WORK = 500_000
"""Steps, some tenths of a second, after which an orbit that need not exist is no longer looked for."""
FINER = 16.0
"""How much finer the last map is; of order eight, its own error is then a small part of what it measures."""


@inner
def norm(z: Any) -> float:
    total = 0.0
    for value in z:
        total += value * value
    return math.sqrt(total)


@inner
def times(matrix: Any, z: Any, out: Any) -> None:
    for row in range(z.size):
        total = 0.0
        for column in range(z.size):
            total += matrix[row, column] * z[column]
        out[row] = total


@inner
def inverted(matrix: Any, inverse: Any) -> bool:
    """Gauss-Jordan elimination with row pivots; False where the matrix is singular to rounding."""
    n = matrix.shape[0]
    work = matrix.copy()
    for row in range(n):
        for column in range(n):
            inverse[row, column] = 1.0 if row == column else 0.0
    for pivot in range(n):
        best = pivot
        for row in range(pivot + 1, n):
            if abs(work[row, pivot]) > abs(work[best, pivot]):
                best = row
        if not abs(work[best, pivot]) > 1e-9:
            return False
        for column in range(n):
            work[pivot, column], work[best, column] = work[best, column], work[pivot, column]
            inverse[pivot, column], inverse[best, column] = inverse[best, column], inverse[pivot, column]
        scale = 1.0 / work[pivot, pivot]
        for column in range(n):
            work[pivot, column] = work[pivot, column] * scale
            inverse[pivot, column] = inverse[pivot, column] * scale
        for row in range(n):
            if row != pivot:
                factor = work[row, pivot]
                for column in range(n):
                    work[row, column] = work[row, column] - factor * work[pivot, column]
                    inverse[row, column] = inverse[row, column] - factor * inverse[pivot, column]
    return True


@inner
def _free_block(damping: float, stiffness: float, period: float, jacobian: Any, at: int) -> None:
    """Monodromy minus identity of one friction-free direction, in the norm of energy."""
    s, half = math.sqrt(stiffness), 0.5 * damping
    square = stiffness - half * half
    root = math.sqrt(abs(square)) * period
    if square > 0.0:
        c, sn = math.cos(root), period * (math.sin(root) / root if root > 0.0 else 1.0)
    else:
        c, sn = (
            math.cosh(min(root, 300.0)),
            period * (math.sinh(min(root, 300.0)) / root if root > 0.0 else 1.0),
        )
    decay = math.exp(-half * period)
    jacobian[at, at] = decay * (c + sn * half) - 1.0
    jacobian[at, at + 1] = decay * sn * s
    jacobian[at + 1, at] = -decay * sn * s
    jacobian[at + 1, at + 1] = decay * (c - sn * half) - 1.0


@inner
def free_inverse(body: Body, rubbing: float, inverse: Any, like: Any) -> None:
    """Inverse of (monodromy - identity) of the body with friction as a dashpot of this coefficient."""
    n, d = inverse.shape[0], dimension(like)
    period = span(body)
    jacobian = np.zeros((n, n))
    damping, stiffness = body.damping_mean + body.damping_split, body.stiffness_mean + body.stiffness_split
    _free_block(damping + rubbing, stiffness, period, jacobian, 0)
    if d == 2:
        damping, stiffness = (
            body.damping_mean - body.damping_split,
            body.stiffness_mean - body.stiffness_split,
        )
        _free_block(damping + rubbing, stiffness, period, jacobian, 2)
    for row in range(2 * d, n):
        jacobian[row, row] = -1.0  # a bristle remembers nothing of a period ago
    inverted(jacobian, inverse)


def _shift_without_memory(law: Any, n: int) -> float:
    return 1e-5


def _shift_with_a_bristle(law: Any, n: int) -> float:
    """Bristles never stick: their maps bend less, and cost more."""
    return 1e-4


shift_of = by_law(_shift_without_memory, _shift_with_a_bristle, None, _shift_with_a_bristle)
"""Relative shift of a state for a difference quotient, and accuracy of the maps relative to the shift."""


@inner
def monodromy(
    law: Any, body: Body, belt_speed: float, z: Any, accuracy: float, matrix: Any, like: Any
) -> int:
    """The derivative of the period map by central differences [n, n]; returns the maps it took.

    The shift stays below the way the belt moves in a period: that much slip ends a period that was all stick.
    The maps are at least as accurate as asked, and always much finer than the shift.
    """
    n = z.size
    carried = abs(belt_speed) * span(body)
    relative = shift_of(law, n)
    shift = relative * (1.0 + norm(z))
    shift = min(shift, max(0.01 * carried, 1e-3 * shift)) if carried > 0.0 else shift
    accuracy = min(accuracy, relative * shift)
    ahead, behind, trial = np.empty(n), np.empty(n), np.empty(n)
    for column in range(n):
        for row in range(n):
            trial[row] = z[row] + (shift if row == column else 0.0)
        mapped(law, body, belt_speed, trial, ahead, accuracy, track_of(0), like)
        trial[column] = z[column] - shift
        mapped(law, body, belt_speed, trial, behind, accuracy, track_of(0), like)
        for row in range(n):
            matrix[row, column] = (ahead[row] - behind[row]) / (2.0 * shift) + (1.0 if row == column else 0.0)
    return 2 * n


@inner
def newton_inverse(
    law: Any, body: Body, belt_speed: float, z: Any, accuracy: float, inverse: Any, like: Any
) -> bool:
    n = z.size
    matrix = np.empty((n, n))
    monodromy(law, body, belt_speed, z, accuracy, matrix, like)
    for row in range(n):
        matrix[row, row] = matrix[row, row] - 1.0
    return inverted(matrix, inverse)


@inner
def broyden(inverse: Any, step: Any, change: Any, work: Any) -> None:
    """Broyden's update of the inverse (1965, by the Sherman-Morrison formula)."""
    n = step.size
    times(inverse, change, work)
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


class Closed(NamedTuple):
    """A closed orbit's integral of friction [periods], error of the mean, and what it took; maps < 0: gave up."""

    rubbed: Any
    error: float
    maps: int
    stuck: float
    closest: float
    first: float  # residual of the guess


@inner
def felt(
    law: Any, body: Body, belt_speed: float, z: Any, shift: Any, image: Mapped, accuracy: float, like: Any
) -> float:
    """By how much the mean changes where the state z, whose map is the image, is shifted."""
    trial, residual = np.empty(z.size), np.empty(z.size)
    less(z, shift, trial)
    moved = mapped(law, body, belt_speed, trial, residual, accuracy, track_of(0), like)
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
def less(z: Any, step: Any, out: Any) -> None:
    for i in range(z.size):
        out[i] = z[i] - step[i]


@inner
def copy(source: Any, out: Any) -> None:
    for i in range(source.size):
        out[i] = source[i]


@inner
def searched(
    law: Any, body: Body, belt_speed: float, z: Any, residual: Any, inverse: Any, accuracy: float, like: Any
) -> int:
    """Move z along the Newton step, halved until the residual falls; returns the maps it took, 8 for no fall."""
    n = z.size
    step, trial, fresh = np.empty(n), np.empty(n), np.empty(n)
    times(inverse, residual, step)
    length, part = norm(residual), 1.0
    for tried in range(1, 8):
        for i in range(n):
            trial[i] = z[i] - part * step[i]
        mapped(law, body, belt_speed, trial, fresh, accuracy, track_of(0), like)
        if norm(fresh) < (1.0 - 0.1 * part) * length:
            copy(trial, z)
            return tried
        part *= 0.5
    return 8


@inner
def close(
    law: Any,
    body: Body,
    belt_speed: float,
    z: Any,
    inverse: Any,
    goal: Goal,
    expected: float,
    like: Any,
) -> Closed:
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
    image = mapped(law, body, belt_speed, z, residual, accuracy, track_of(0), like)
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
            image = mapped(law, body, belt_speed, z, residual, accuracy, track_of(0), like)
            maps += 1
            continue
        if image.stuck >= period * (1.0 - 1e-9):  # at rest on a belt at rest
            return Closed(image.rubbed, floor / body.normal_load + ROUNDING, maps, image.stuck, 0.0, first)
        times(inverse, residual, step)
        if accuracy <= finest and mean_error(body, residual, norm(step)) <= 10.0 * tolerance:
            less(z, step, trial)
            copy(trial, z)
            accuracy = finest / FINER
            image = mapped(law, body, belt_speed, z, residual, accuracy, track_of(0), like)
            maps += 1
            checks += 1
            doubt = 0.0
            if (
                image.stuck > 0.0 or troubled or not goal.contracts
            ):  # both jump with the events: take them anew
                if not newton_inverse(law, body, belt_speed, z, accuracy, inverse, like):
                    break
                coarser = mapped(law, body, belt_speed, z, fresh, FINER * accuracy, track_of(0), like)
                maps += 2 * n + 1
                less(fresh, residual, fresh)
                times(inverse, fresh, work)
                doubt = mean_error(body, fresh, norm(work)) + abs(coarser.rubbed - image.rubbed) / period
                if not goal.contracts:
                    doubt += felt(law, body, belt_speed, z, work, image, accuracy, like)
                    times(inverse, residual, work)
                    doubt += felt(law, body, belt_speed, z, work, image, accuracy, like)
            times(inverse, residual, work)
            error = 2.0 * (mean_error(body, residual, norm(work)) + doubt)
            error += (floor + 0.1 * accuracy) / body.normal_load + ROUNDING  # and the finer map's own error
            if error <= tolerance or (finest <= floor and checks > 3):
                return Closed(image.rubbed, error, maps, image.stuck, image.closest, first)
            finest, troubled = max(floor, accuracy), troubled or checks > 2
            continue
        finer = max(finest, min(accuracy, 1e-4 * length))
        less(z, step, trial)
        image = mapped(law, body, belt_speed, trial, fresh, finer, track_of(0), like)
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
            tried = searched(law, body, belt_speed, z, residual, inverse, accuracy, like)
            maps += tried
            for _ in range(0 if regular and tried < 8 else 3):
                image = mapped(law, body, belt_speed, z, residual, accuracy, track_of(0), like)
                maps += 1
                for i in range(n):
                    z[i] = z[i] + residual[i]
            image = mapped(law, body, belt_speed, z, residual, accuracy, track_of(0), like)
            maps += 1
        stalls = 1
    return Closed(image.rubbed, 1e300, -maps, image.stuck, image.closest, first)
