"""Kernels of shooting: the orbits of one curve, closed by continuation in belt speed, and what is read from them.

What is known of the closed orbits of a curve: a row of numbers for each, under names.

Kernels fill a table: an array each would make them compile for minutes. Python reads the columns of it.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from frictionlab.compile.decorators import inner
from frictionlab.methods.periodic.attraction import reached
from frictionlab.methods.periodic.fixed_point import ROUNDING, FixedPoint, Goal, fixed_point
from frictionlab.methods.periodic.monodromy import monodromy
from frictionlab.methods.periodic.period_map import size_of_deviation
from frictionlab.methods.periodic.setting import (
    Maps,
    Setting,
    guess_state,
    period_map,
    recorded_map,
    scales_of,
    slip_keeps_its_side,
    write_sliding_state,
)
from frictionlab.methods.periodic.steady_sliding import NEAR
from frictionlab.motion.equation import mean_friction
from frictionlab.motion.linalg import copy
from frictionlab.motion.orbit.recorder import Track, grown, track_of
from frictionlab.values.quantities import Floats

MEAN, ACROSS, ERROR, MAPS, STUCK, CLOSEST, COLUMNS = range(7)


class ClosedOrbits(NamedTuple):
    """Results of each orbit [n]: mean friction along the belt and across, its error, the maps it took, the share
    of the period at rest and the slowest slip.

    maps: 0 in closed form; negative where no orbit was found in so many. NaN all where none was looked for.
    """

    mean: Floats
    across: Floats
    error: Floats
    maps: Floats
    stuck: Floats
    closest: Floats

    @classmethod
    def of(cls, table: Any) -> ClosedOrbits:
        """Read the closed orbits of a table [n, COLUMNS]."""
        return cls(*np.asarray(table).T)

    @property
    def found(self) -> NDArray[np.bool_]:
        """Check whether each is known."""
        return np.asarray(self.maps >= 0.0)


@inner
def write_orbit(row: Any, mean: Any, error: float, maps: float, rests: Any) -> None:
    """Fill the row of an orbit; rests: the share of the period at rest, and the slowest slip."""
    row[MEAN], row[ACROSS] = mean.real, mean.imag
    row[ERROR], row[MAPS] = error, maps
    row[STUCK], row[CLOSEST] = rests


MOST_KNOWN = 6


@inner
def _extrapolated(states: Any, belt_speeds: Any, i: int, known: int, z: Any) -> None:
    """Extrapolate the polynomial through the known states before i to i."""
    for row in range(z.size):
        z[row] = 0.0
    for a in range(i - known, i):
        # Lagrange's weights: belt speeds need not be equally spaced.
        weight = 1.0
        for b in range(i - known, i):
            if a != b:
                weight *= (belt_speeds[i] - belt_speeds[b]) / (belt_speeds[a] - belt_speeds[b])
        for row in range(z.size):
            z[row] = z[row] + weight * states[a, row]


@inner
def _best_order(states: Any, belt_speeds: Any, i: int, known: int, work: Any) -> int:
    """Return how many states before i predict state i best: few at kinks of a curve, many on smooth parts."""
    best, least = 1, 1e300
    for count in range(1, known + 1):
        _extrapolated(states, belt_speeds, i, count, work)
        miss = 0.0
        for row in range(work.size):
            miss += (work[row] - states[i, row]) ** 2
        if miss < least:
            best, least = count, miss
    return best


@inner
def solve_curve(maps: Maps, periods: float, belt_speeds: Any, guess: Any, goal: Goal) -> Any:
    """States [n, size], results [n, COLUMNS] and monodromies [n, size, size], NaN where the search did without."""
    size, n = maps.size, belt_speeds.size
    states, results = np.zeros((n, size)), np.empty((n, COLUMNS))
    matrices = np.full((n, size, size), np.nan)
    z, work, inverse = np.empty(size), np.empty(size), np.empty((size, size))
    known, order, expected = 0, 1, 1e300
    for i in range(n):
        setting = Setting(maps, belt_speeds[i], periods)
        if goal.constant and _slides_on(setting, guess if i == 0 else guess[:0], states[i]):
            _write_results(setting, _sliding(setting, states[i]), results[i])
            known = 0
            continue
        # From the states before it by extrapolation, with the last inverse; the first one from a harmonic motion.
        if known == 0:
            guess_state(setting, z, inverse)
            if i == 0 and guess.shape[0] > 0:
                copy(guess[0], z)
        else:
            _extrapolated(states, belt_speeds, i, min(order, known), z)
        closed = fixed_point(setting, z, inverse, matrices[i], goal, expected)
        # Neighbours mislead where the curve has a jump: once more without them.
        if closed.maps < 0 and (known > 0 or guess.shape[0] > 0):
            guess_state(setting, z, inverse)
            closed = fixed_point(setting, z, inverse, matrices[i], goal, 1e300)
        copy(z, states[i])
        _write_results(setting, closed, results[i])
        # The order that would have predicted this state best, and one more: orders are not known where none is tried.
        if closed.maps > 0 and known > 1:
            order = min(_best_order(states, belt_speeds, i, known, work) + 1, MOST_KNOWN)
        else:
            order = known + 1
        known = min(known + 1, MOST_KNOWN) if closed.maps > 0 else 0
        expected = closed.first if known > 1 else 1e300
    return states, results, matrices


@inner
def _slides_on(setting: Setting, guess: Any, state: Any) -> bool:
    """Check whether the orbit looked for is that of slip that never reverses, written then to the state: closed form.

    It is where no guess says otherwise.
    """
    if not slip_keeps_its_side(setting):
        return False
    write_sliding_state(setting, state)
    apart = 0.0
    for row in range(state.size if guess.shape[0] > 0 else 0):
        apart = math.hypot(apart, guess[0, row] - state[row])
    return apart < NEAR * size_of_deviation(setting.maps.per_drive.normal_load, state)


@inner
def _sliding(setting: Setting, state: Any) -> FixedPoint:
    """Return the constant friction of slip that never reverses, from its state; it takes no map."""
    friction = write_sliding_state(setting, state)
    impulse = complex(-friction * scales_of(setting).period, 0.0)
    slowest = max(0.0, abs(setting.belt_speed) - setting.maps.fastest)
    return FixedPoint(impulse, ROUNDING * max(1.0, abs(friction)), 0, 0.0, slowest, 0.0)


@inner
def _write_results(setting: Setting, closed: FixedPoint, row: Any) -> None:
    period = scales_of(setting).period
    rests = closed.stuck / period, closed.closest
    write_orbit(row, mean_friction(closed.friction_impulse, period), closed.error, closed.maps, rests)


@inner
def record_orbit(setting: Setting, z: Any, accuracy: float, track: Track) -> Track:
    """Track with the closed orbit from z, piece by piece, after what it holds; on a larger one where needed."""
    first, residual = track.filled[0], np.empty(z.size)
    recorded_map(setting, z, residual, accuracy, track)
    # How many pieces an orbit has is known once it is written: a full track may lack some.
    while track.filled[0] == track.stick.size:
        track = grown(track, 4 * track.stick.size)
        track.filled[0] = first
        recorded_map(setting, z, residual, accuracy, track)
    return track


@inner
def recorded_accuracy(normal_load: float, goal: Goal) -> float:
    """Return the recorded motion is a map of its own, as exact as the mean was asked to be."""
    return max(0.1 * goal.tolerance * normal_load, 1e-13 * min(1.0, normal_load))


class Wanted(NamedTuple):
    """Kernels of a curve: its orbits closed from a guess, or of given states; recorded, and their monodromies.

    mapped: nothing else but the given states one period later, by fine maps.

    One kernel for all: each entry of its own would be compiled for seconds.
    """

    closed: bool
    orbits: bool
    matrices: bool
    mapped: bool = False


CLOSED, DIFFERENTIATED = Wanted(True, False, False), Wanted(True, False, True)
RECORDED, MULTIPLIERS = Wanted(False, True, False), Wanted(False, False, True)
MAPPED = Wanted(False, False, False, True)
FINE = 1e-10
"""Accuracy of fine maps, of the normal load."""


class Curve(NamedTuple):
    """States [n, size], results [n, COLUMNS] of ``ClosedOrbits``, monodromies [n or 0, size, size], after how many
    periods both cheap starts end there [n] (0: not both do), the orbits one after another and the panels before which
    each ends [n]."""

    states: Any
    results: Any
    matrices: Any
    reached: Any
    orbits: Track
    ends: Any

    @property
    def closed(self) -> ClosedOrbits:
        """Return what is known of each orbit."""
        return ClosedOrbits.of(self.results)


@inner
def answer_curve(
    maps: Maps, periods: float, belt_speeds: Any, guess: Any, goal: Goal, wanted: Wanted
) -> Curve:
    """Close the orbits of a curve, record them, differentiate their maps: what is wanted of it.

    periods: of the drive in one map. guess: a state to start from [0 or 1, size]; where nothing is to be closed, the
    states of all orbits [n, size].
    """
    if wanted.closed:
        states, results, matrices = solve_curve(maps, periods, belt_speeds, guess, goal)
    else:
        states, results = guess, np.ones((belt_speeds.size, COLUMNS))
        matrices = np.full((states.shape[0], states.shape[1], states.shape[1]), np.nan)
    n, size = states.shape
    normal_load = maps.per_drive.normal_load
    accuracy = recorded_accuracy(normal_load, goal)
    ends_there, gradient, work = np.zeros(n, np.int64), np.empty(size, np.complex128), np.empty(size)
    track, ends = track_of(128 if wanted.orbits else 0), np.zeros(n, np.int64)
    for i in range(n):
        setting = Setting(maps, belt_speeds[i], periods)
        if wanted.mapped:
            period_map(setting, states[i].copy(), work, FINE * normal_load)
            for row in range(size):
                states[i, row] = states[i, row] + work[row]
        # An orbit that was not found has a negative count of maps.
        elif results[i, MAPS] >= 0.0:
            if wanted.orbits:
                track = record_orbit(setting, states[i], accuracy, track)
            if wanted.matrices and math.isnan(matrices[i, 0, 0]):
                monodromy(setting, states[i], 1.0, matrices[i], gradient)
            if wanted.closed and goal.check_attraction:
                ends_there[i] = reached(setting, states[i], matrices[i], goal.constant)
        else:
            matrices[i] = 0.0
        ends[i] = track.filled[0]
    kept = matrices if wanted.matrices else matrices[:0]
    return Curve(states, results, kept, ends_there, track, ends)
