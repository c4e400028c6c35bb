"""Orbits of a curve in the plane, closed eight belt speeds at a time.

The first lanes lie evenly along the curve and start from a harmonic motion. Then come the middles of all gaps, with
guesses interpolated from both sides, again and again: most of them need one map, which tells their error, too. What
meets rest, or does not converge by quasi-Newton steps alone, is left to the search for one belt speed.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from frictionlab.compile.decorators import inner
from frictionlab.compile.lane_arrays import room_for
from frictionlab.methods.periodic.continuation import COLUMNS, ClosedOrbits, write_orbit
from frictionlab.methods.periodic.first_guess import first_guess, free_inverse
from frictionlab.methods.periodic.fixed_point import (
    Goal,
    broyden,
    first_accuracy_without_memory,
    mean_error,
    rounding_of,
    stated_error,
)
from frictionlab.methods.periodic.lane_map import LaneRows, lane_map, rows_for
from frictionlab.methods.periodic.setting import scales_on
from frictionlab.motion.equation import mean_friction, span
from frictionlab.motion.linalg import copy, multiply, norm
from frictionlab.scene.body import BodyNumbers

MOST_LANE_MAPS = 12
FINER_IN_LANES = 4.0
"""Ratio of accuracies of the first map and the last, whose whole accuracy is in the error stated."""
_BESIDE = 3
"""Known states on either side that a guess is interpolated from."""
MAP_NOISE = 0.3
"""Share of a map's accuracy below which a residual says nothing of the state."""
NOT_YET, LEFT, CLOSED_ORBIT = 0, 1, 2


class LaneCurve(NamedTuple):
    """Belt speeds [n], states [n, 4], results [n, COLUMNS] of ``ClosedOrbits``, NaN where left; what became of each
    point [n]."""

    belt_speeds: Any
    states: Any
    results: Any
    fate: Any
    inverses: Any
    first: Any  # residual of each guess

    @property
    def closed(self) -> ClosedOrbits:
        """Return what is known of each orbit."""
        return ClosedOrbits.of(self.results)


class GroupProgress(NamedTuple):
    """Count of maps of a group, the last one's accuracy, that before, and the coarsest for an error."""

    maps: int
    accuracy: float
    before: float
    enough: float


class Group(NamedTuple):
    """Points that go through maps together [count], their rows, and vectors of each lane [lanes, 4].

    step: the next quasi-Newton step. before: the residual that it comes from. active: what still goes on [lanes].
    """

    places: Any
    rows: LaneRows
    step: Any
    before: Any
    fresh: Any
    work: Any
    active: Any


@inner
def _middles(fate: Any, places: Any) -> int:
    """Write the middles of all gaps between points that were tried; returns how many."""
    count, last = 0, -1
    for i in range(fate.size):
        if fate[i] == NOT_YET:
            continue
        if last >= 0 and i - last > 1:
            places[count] = (last + i) // 2
            count += 1
        last = i
    return count


@inner
def _beside(fate: Any, i: int, places: Any) -> int:
    """Write the nearest points on either side whose orbits are closed, the nearest first; returns how many."""
    count, below, above = 0, i - 1, i + 1
    for side in range(2 * _BESIDE):
        if side % 2 == 0:
            while below >= 0 and fate[below] != CLOSED_ORBIT:
                below -= 1
            if below >= 0:
                places[count] = below
                count, below = count + 1, below - 1
        else:
            while above < fate.size and fate[above] != CLOSED_ORBIT:
                above += 1
            if above < fate.size:
                places[count] = above
                count, above = count + 1, above + 1
    return count


@inner
def _interpolate(curve: LaneCurve, places: Any, count: int, i: int, z: Any) -> None:
    """Extrapolate the polynomial through the states at the first places to i."""
    belt_speeds = curve.belt_speeds
    for row in range(z.size):
        z[row] = 0.0
    # Lagrange's weights; two points of one belt speed are told apart by neither
    for a in range(count):
        weight = 1.0
        for b in range(count):
            if a != b:
                there, here = belt_speeds[places[b]], belt_speeds[places[a]]
                weight *= (belt_speeds[i] - there) / (here - there) if here != there else 0.0
        for row in range(z.size):
            z[row] = z[row] + weight * curve.states[places[a], row]


@inner
def _guess(law: Any, body: BodyNumbers, curve: LaneCurve, i: int, z: Any) -> None:
    """Write a guess of the state at i and of its inverse."""
    places = np.empty(2 * _BESIDE, np.int64)
    count = _beside(curve.fate, i, places)
    if count == 0:
        zero = body.reference_sine - body.reference_sine
        free_inverse(body, first_guess(law, body, curve.belt_speeds[i], z), curve.inverses[i], zero)
        return
    _interpolate(curve, places, count, i, z)
    nearest = curve.inverses[places[0]]
    for row in range(z.size):
        copy(nearest[row], curve.inverses[i, row])


@inner
def _judged(
    body: BodyNumbers, goal: Goal, curve: LaneCurve, group: Group, k: int, now: GroupProgress
) -> bool:
    """Look at the map of lane k: keep its orbit, leave it, or move its state; whether it goes on."""
    i, rows, fresh, step, before = group.places[k], group.rows, group.fresh[k], group.step[k], group.before[k]
    inverse = curve.inverses[i]
    for row in range(4):
        fresh[row] = rows.residual[row, k]
    length, curve.fate[i] = norm(fresh), LEFT
    if rows.arrived[k] == 0.0 or not length < 1e300:
        return False
    if now.maps == 1:
        curve.first[i] = length
    else:
        if length > 1.5 * norm(before) + now.before:
            return False
        if now.before <= 0.05 * norm(before):  # a coarser map's residual would spoil the inverse
            for row in range(4):
                step[row], before[row] = -step[row], fresh[row] - before[row]
            broyden(inverse, step, before, group.work)
    copy(fresh, before)
    multiply(inverse, fresh, step)
    # no finer map follows: what this one has wrong counts whole
    floor = rounding_of(body.normal_load, curve.states[i], rows.belt_speed[k])
    error = stated_error(
        0.0, mean_error(scales_on(body), fresh, norm(step)), (floor + now.accuracy) / body.normal_load
    )
    closes = error <= goal.tolerance and now.accuracy <= now.enough
    if closes:
        mean = mean_friction(complex(rows.impulse[0, k], rows.impulse[1, k]), span(body))
        curve.fate[i] = CLOSED_ORBIT
        write_orbit(curve.results[i], mean, error, now.maps, (0.0, rows.closest[k]))
    if length > MAP_NOISE * now.accuracy:  # what a map has wrong is no reason to move
        for row in range(4):
            curve.states[i, row] = curve.states[i, row] - step[row]
    return not closes


@inner
def _write_rows(curve: LaneCurve, group: Group, count: int) -> bool:
    """Write what the next map starts from; a lane with nothing to do repeats another. False where all have none."""
    other = -1
    for k in range(count):
        if group.active[k]:
            other = k
    if other < 0:
        return False
    rows = group.rows
    for k in range(rows.belt_speed.size):
        i = group.places[k if k < count and group.active[k] else other]
        rows.belt_speed[k] = curve.belt_speeds[i]
        for row in range(4):
            rows.state[row, k] = curve.states[i, row]
    return True


@inner
def _expected(curve: LaneCurve, i: int) -> float:
    """Residual of a guess at i, from those of the points beside it, whose guesses came from twice as far."""
    least = 1e300
    for side in (-1, 1):
        j = i + side
        while 0 <= j < curve.fate.size and curve.fate[j] == NOT_YET:
            j += side
        if 0 <= j < curve.fate.size and curve.fate[j] == CLOSED_ORBIT:
            least = min(least, curve.first[j] / 16.0)
    return least


@inner
def _close_group(law: Any, body: BodyNumbers, goal: Goal, curve: LaneCurve, group: Group, count: int) -> None:
    """Close the orbits of the first ``count`` places."""
    floor, expected = 0.0, 0.0
    for k in range(count):
        i = group.places[k]
        _guess(law, body, curve, i, curve.states[i])
        group.active[k], expected = True, max(expected, _expected(curve, i))
        floor = max(floor, rounding_of(body.normal_load, curve.states[i], curve.belt_speeds[i]))
    finest = first_accuracy_without_memory(goal.tolerance * body.normal_load)
    # points beside known ones begin with maps as fine as the residual that is expected of their guess
    last = max(finest, floor) / FINER_IN_LANES
    accuracy, before = max(last, 1e-4 * min(expected, body.normal_load)), 0.0
    for maps in range(1, MOST_LANE_MAPS + 1):
        if not _write_rows(curve, group, count):
            break
        lane_map(law, body, group.rows, accuracy, False)
        length = 0.0
        now = GroupProgress(maps, accuracy, before, finest)
        for k in range(count):
            if group.active[k]:
                group.active[k] = _judged(body, goal, curve, group, k, now)
                if group.active[k]:
                    length = max(length, norm(group.before[k]))
        # a map need not be much more exact than what is left open
        before, accuracy = accuracy, max(last, min(accuracy, 1e-4 * length))


@inner
def _first_places(n: int, lanes: int, places: Any) -> int:
    """Write places evenly along the curve, both ends included, as many as there are lanes; returns how many."""
    count = min(n, lanes)
    for k in range(count):
        places[k] = (k * (n - 1) + (count - 1) // 2) // max(count - 1, 1)
    return count


@inner
def answer_lanes(law: Any, body: BodyNumbers, belt_speeds: Any, goal: Goal) -> LaneCurve:
    """Close the orbits of planar slip that never comes next to rest, of a law whose motions converge."""
    n = belt_speeds.size
    lanes = room_for(n)
    curve = LaneCurve(
        belt_speeds,
        np.zeros((n, 4)),
        np.full((n, COLUMNS), np.nan),
        np.zeros(n, np.int64),
        np.empty((n, 4, 4)),
        np.full(n, np.nan),
    )
    vectors = np.empty((3, lanes, 4))
    group = Group(
        np.zeros(lanes, np.int64),
        rows_for(lanes),
        vectors[0],
        vectors[1],
        vectors[2],
        np.empty(4),
        np.zeros(lanes, np.bool_),
    )
    places = np.zeros(n, np.int64)
    count = _first_places(n, lanes, places)
    while count > 0:
        for begin in range(0, count, lanes):
            filled = 0
            for k in range(begin, min(begin + lanes, count)):
                group.places[filled] = places[k]
                filled += 1
            _close_group(law, body, goal, curve, group, filled)
        count = _middles(curve.fate, places)
    return curve
