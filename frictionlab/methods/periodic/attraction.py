"""Test of motions from far starts, which may end on an orbit: transients followed period by period."""

from __future__ import annotations

import math
from itertools import product
from typing import Any, NamedTuple

import numpy as np

from frictionlab.compile.call import KernelCall
from frictionlab.compile.decorators import inner
from frictionlab.methods.periodic.fixed_point import MUCH_WORK, UTMOST_WORK
from frictionlab.methods.periodic.period_map import size_of_deviation
from frictionlab.methods.periodic.setting import (
    Maps,
    Setting,
    SpanImage,
    ends_in_sliding,
    period_map,
    scales_of,
    slip_keeps_its_side,
    spans_at_rest,
    write_sliding_state,
    write_state,
)
from frictionlab.methods.periodic.steady_sliding import NEAR, memory_of_sliding
from frictionlab.motion.equation import mean_friction
from frictionlab.motion.linalg import copy, multiply, norm, radius_bound, subtract
from frictionlab.values.quantities import Floats

MOST_PERIODS = 5000
PATIENCE = 300
"""Periods within which a motion must come near to an orbit."""
AGREED, ENOUGH = 0.1, 3
"""Distance of a period from what the monodromy says of it, and how many such periods in a row are enough."""


class Follow(NamedTuple):
    """Way to follow a motion: the accuracy of its maps, and whether friction is the same at every speed of slip.

    whole: all of its periods, each by itself, whether they repeat or not.
    """

    accuracy: float
    constant: bool
    whole: bool = False


class Trail(NamedTuple):
    """Mean friction of each period of a motion [n], the states before the first and after each [n + 1, size]."""

    means: Any
    states: Any


class KnownOrbit(NamedTuple):
    """A closed orbit that motions are to end on: its state, its monodromy, and one less the largest multiplier.

    gap: not positive, or NaN, where multipliers are not known to be below one. A state of NaN: no orbit is known.
    """

    state: Any
    monodromy: Any
    gap: float


@inner
def obeys(orbit: KnownOrbit, before: Any, after: Any, predicted: Any) -> bool:
    """Check whether a period from ``before`` (as what follows, a distance from the orbit) is as the monodromy says.

    That the distance falls by the largest multiplier is not enough: other attractors do so for some periods. The
    distance itself must be what is predicted, to a tenth of the change in the period, which another orbit would leave
    out, and to half of what makes all of them shrink.
    """
    multiply(orbit.monodromy, before, predicted)
    changed, missed = 0.0, 0.0
    for row in range(before.size):
        changed = math.hypot(changed, predicted[row] - before[row])
        missed = math.hypot(missed, predicted[row] - after[row])
    return orbit.gap > 0.0 and missed <= AGREED * changed and missed <= 0.5 * orbit.gap * norm(before)


@inner
def _arrives(setting: Setting, start: Any, orbit: KnownOrbit, constant: bool) -> int:
    """After how many periods a motion comes near to an orbit, or nears it as its monodromy says; 0 for never."""
    slides_on = constant and slip_keeps_its_side(setting)
    residual, steps, obeyed = np.empty(start.size), 0, 0
    size = size_of_deviation(setting.maps.per_drive.normal_load, orbit.state)
    before, after, predicted = np.empty(start.size), np.empty(start.size), np.empty(start.size)
    subtract(start, orbit.state, before)
    for n in range(1, PATIENCE + 1):
        image = period_map(setting, start, residual, 1e-5 * setting.maps.per_drive.normal_load)
        steps += image.steps
        # A motion that takes this long is no cheap one: the starts are then followed to their ends instead.
        if image.steps < 0 or steps > MUCH_WORK // 4:
            return 0
        # The next period starts where this one ends.
        for row in range(start.size):
            start[row] = start[row] + residual[row]
        if slides_on:
            ends_in_sliding(setting, start)
        subtract(start, orbit.state, after)
        obeyed = obeyed + 1 if obeys(orbit, before, after, predicted) else 0
        if obeyed == ENOUGH or norm(after) < NEAR * size:
            return n
        copy(after, before)
    return 0


@inner
def reached(setting: Setting, state: Any, matrix: Any, constant: bool) -> int:
    """For how many periods the two cheap starts were followed until they ended on this orbit; 0 where one did not.

    One is a mass set off at rest on the belt, one slides as if slip never reversed: an orbit of its own where the
    belt is faster than any vibration and sliding friction constant. matrix: the monodromy, NaN where it is not known.
    """
    orbit = KnownOrbit(state, matrix, 1.0 - radius_bound(matrix))
    # Set off at rest on the belt, where the contact remembers nothing.
    start = np.empty(state.size)
    write_state(setting.maps, start, 0j, complex(setting.belt_speed, 0.0), 0j)
    first = _arrives(setting, start, orbit, constant)
    if first == 0:
        return 0
    # Set off as in sliding that never reverses, with the memory of that.
    write_sliding_state(setting, start)
    return min(first, _arrives(setting, start, orbit, constant))


@inner
def settle(maps: Maps, periods: float, x: complex, v: complex, accuracy: float) -> Any:
    """From position x and velocity v on a belt at rest: the state once the mass stays put, and the spans it took.

    Spans of so many periods of the drive: negative where the mass still creeps after so many.
    """
    setting = Setting(maps, 0.0, periods)
    size, period, steps = maps.size, scales_of(setting).period, 0
    z, residual = np.empty(size), np.empty(size)
    write_state(maps, z, x, v, 0j)
    for count in range(1, MOST_PERIODS):
        image = period_map(setting, z, residual, accuracy)
        for row in range(z.size):
            z[row] = z[row] + residual[row]
        # Stuck for the whole of a period: the next ones repeat it.
        if image.stuck >= period * (1.0 - 1e-12):
            return z, count
        steps += image.steps
        if image.steps < 0 or steps > UTMOST_WORK:
            return z, -count
    return z, -MOST_PERIODS


LONGEST_PERIOD = 8
"""Longest period of a subharmonic response that is looked for [drive periods]."""


@inner
def _apart(states: Any, a: int, b: int, least: float) -> float:
    # Relative to the largest number of the state: memories may be far smaller than positions.
    total, size = 0.0, least
    for row in range(states.shape[1]):
        total += (states[a, row] - states[b, row]) ** 2
        size = max(size, abs(states[a, row]))
    return math.sqrt(total) / size


@inner
def write_start(maps: Maps, start: Any, state: Any) -> None:
    """Fill the state of a start (x, v, deflection); see ``write_state``."""
    x, v, deflection = start
    write_state(maps, state, x, v, deflection)


MOST_CORNERS = 4
"""Largest number of deflections that are combined in all directions.

If there are more, all deflections start in one direction, then all in the other."""


def corners(maps: Any, law: Any, size: int, place: tuple[complex, complex], speed: float) -> list[Floats]:
    """Return states at a place with deflections as in steady sliding in either direction; the last has none."""
    sides = np.empty((3, size))
    for row, z in enumerate((memory_of_sliding(law, speed), memory_of_sliding(law, -speed), 0.0)):
        KernelCall(write_start)(maps, (*place, complex(z)), sides[row])
    moved = sides[0] != sides[1]
    few = moved.sum() <= MOST_CORNERS
    choices = product(*((False, True)[: 1 + each] for each in moved.tolist())) if few else (moved, ~moved)
    return [*(np.where(choice, sides[0], sides[1]) for choice in choices), sides[2]]


ARRIVED, VERY_NEAR, FALLEN = -1, 1e-5, 0.1
"""Sign in place of a number of periods where a motion ends on a known orbit; how near is near enough, over its
size; and to what share the distance must have fallen while it obeyed. Three periods alone are no sign: the motion
turns about the orbit, and may meet stick, and leave, where it has not been yet."""


def unknown_orbit(size: int) -> KnownOrbit:
    """For motions that are to be followed whatever they end on."""
    return KnownOrbit(np.full(size, math.nan), np.full((size, size), math.nan), -1.0)


MANY = 8.0
"""Fewer periods at rest on the belt are followed one by one: orbits of several periods rest for some of them."""


@inner
def _periods_alike(setting: Setting, state: Any, image: SpanImage) -> float:
    """Return how many periods from this one on the belt is sure to carry a mass that rests on it all the time, or 1.

    From where it starts to the mean of its orbit a slow belt carries it for thousands of them.
    """
    if setting.belt_speed == 0.0 or image.stuck < scales_of(setting).period * (1.0 - 1e-9):
        return 1.0
    many = 1.0 + spans_at_rest(setting, state)
    return many if many > MANY else 1.0


@inner
def iterate_until_periodic(
    maps: Maps, belt_speed: float, periods: float, how: Follow, orbit: KnownOrbit, trail: Trail
) -> Any:
    """Follow the motion from the first state of a trail, period by period, until it repeats or is sure to end on the
    known orbit.

    Of the periods in which the belt carries it at rest one stands for many.

    Fills the trail; returns after how many periods it repeats (0 where it has not after n, ARRIVED on the known
    orbit), and how many it was followed.
    """
    setting = Setting(maps, belt_speed, periods)
    (means, states), scales, steps = trail, scales_of(setting), 0
    # Coarse maps wander on by their own error: what they repeat is less exact.
    alike = 1e-7 if how.accuracy <= 1e-8 * scales.normal_load else 1e-5
    residual, slides_on = np.empty(states.shape[1]), how.constant and slip_keeps_its_side(setting)
    # A bristle that nears its limit as a power of the way slid comes to move less than that long before it is there.
    alike *= 0.1 if slides_on else 1.0
    alike, least = 0.0 if how.whole else alike, min(1.0, scales.normal_load)
    before, after, predicted = np.empty(residual.size), np.empty(residual.size), np.empty(residual.size)
    subtract(states[0], orbit.state, before)
    near, obeyed, far = VERY_NEAR * norm(orbit.state), 0, 0.0
    passed = np.zeros(means.size + 1)  # periods until each state
    for n in range(means.size):
        image = period_map(setting, states[n], residual, how.accuracy)
        means[n] = mean_friction(image.friction_impulse.real, scales.period)
        steps += image.steps
        many = 1.0 if how.whole else _periods_alike(setting, states[n], image)
        for row in range(residual.size):
            states[n + 1, row] = states[n, row] + many * residual[row]
        passed[n + 1] = passed[n] + many
        if slides_on and ends_in_sliding(setting, states[n + 1]):
            return 1, n + 1, steps
        subtract(states[n + 1], orbit.state, after)
        far = norm(before) if obeyed == 0 else far
        obeyed = obeyed + 1 if many == 1.0 and obeys(orbit, before, after, predicted) else 0
        if (obeyed >= ENOUGH and norm(after) < FALLEN * far) or norm(after) < near:
            return ARRIVED, n + 1, steps
        copy(after, before)
        nearest = 1e300
        for k in range(1, min(LONGEST_PERIOD, n // 2) + 1):
            # Two states in a row must repeat: one alone may pass near an old one by chance.
            repeats = max(_apart(states, n + 1, n + 1 - k, least), _apart(states, n, n - k, least)) < alike
            # A spiral into an orbit of fewer periods looks like a longer one while it is still far out.
            if repeats and nearest > 1e-4:
                return int(passed[n + 1] - passed[n + 1 - k]), n + 1, steps
            nearest = min(nearest, _apart(states, n + 1, n + 1 - k, least))
        if image.steps < 0 or steps > MUCH_WORK:
            return 0, n + 1, steps
    return 0, means.size, steps
