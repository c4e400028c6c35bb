"""Kernels of shooting: the orbits of one curve, closed by continuation in belt speed, and what is read from them."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from frictionlab.kernel import by_law, inner
from frictionlab.methods.bristle_closing import close_bristle
from frictionlab.methods.closing import (
    MUCH_WORK,
    Goal,
    close,
    free_inverse,
    less,
    monodromy,
    norm,
)
from frictionlab.methods.period import mapped, size_of, start_of
from frictionlab.methods.sliding_map import span
from frictionlab.methods.track import Track, track_of
from frictionlab.orbit import READ, read
from frictionlab.scene import Body, Mass


@inner
def _first_guess(law: Any, body: Body, belt_speed: float, z: Any) -> float:
    """The spring deflection by the mean friction of a harmonic slip; returns friction's coefficient as a dashpot."""
    swing = body.frequency * math.hypot(abs(body.reference_sine), abs(body.reference_cosine))
    ratio = abs(belt_speed) / (swing + 1e-300)
    mean = law.sliding_friction(swing + abs(belt_speed)) * (
        math.asin(ratio) * 2.0 / math.pi if ratio < 1.0 else 1.0
    )
    for i in range(z.size):
        z[i] = 0.0
    stiffness = body.stiffness_mean + body.stiffness_split
    z[0] = math.copysign(body.normal_load * mean / math.sqrt(stiffness), belt_speed)
    return body.normal_load * law.sliding_friction(swing) / (swing + abs(belt_speed) + 1e-3)


MOST_KNOWN = 6
MOST_PERIODS = 5000


@inner
def _extrapolated(states: Any, belt_speeds: Any, i: int, known: int, z: Any) -> None:
    """The polynomial through the known states before i, at i."""
    for row in range(z.size):
        z[row] = 0.0
    for a in range(i - known, i):
        weight = 1.0
        for b in range(i - known, i):
            if a != b:
                weight *= (belt_speeds[i] - belt_speeds[b]) / (belt_speeds[a] - belt_speeds[b])
        for row in range(z.size):
            z[row] = z[row] + weight * states[a, row]


@inner
def _best_order(states: Any, belt_speeds: Any, i: int, known: int, work: Any) -> int:
    """How many states before i would have predicted state i best: kinks of a curve want few, smooth parts many."""
    best, least = 1, 1e300
    for count in range(1, known + 1):
        _extrapolated(states, belt_speeds, i, count, work)
        miss = 0.0
        for row in range(work.size):
            miss += (work[row] - states[i, row]) ** 2
        if miss < least:
            best, least = count, miss
    return best


closed_by = by_law(close, close_bristle, None, close_bristle)
"""The fixed point of the period map from a guess, by the way that suits the law."""


@inner
def solve_curve(law: Any, body: Body, belt_speeds: Any, guess: Any, goal: Goal, like: Any) -> Any:
    """States [n, size] and results [n, 6]: mean friction, across, error, maps, share of stick, slowest slip."""
    size, n = size_of(law, like), belt_speeds.size
    states, results = np.zeros((n, size)), np.empty((n, 6))
    z, work, inverse = np.empty(size), np.empty(size), np.empty((size, size))
    period = span(body)
    known, order, expected = 0, 1, 1e300
    for i in range(n):
        if known == 0:
            free_inverse(body, _first_guess(law, body, belt_speeds[i], z), inverse, like)
            if i == 0 and guess.shape[0] > 0:
                for row in range(size):
                    z[row] = guess[0, row]
        else:
            _extrapolated(states, belt_speeds, i, min(order, known), z)
        closed = closed_by(law, body, belt_speeds[i], z, inverse, goal, expected, like)
        if closed.maps < 0 and (known > 0 or guess.shape[0] > 0):
            free_inverse(body, _first_guess(law, body, belt_speeds[i], z), inverse, like)
            closed = closed_by(law, body, belt_speeds[i], z, inverse, goal, 1e300, like)
        for row in range(size):
            states[i, row] = z[row]
        if closed.maps > 0 and known > 1:
            order = min(_best_order(states, belt_speeds, i, known, work) + 1, MOST_KNOWN)
        else:
            order = known + 1
        known = min(known + 1, MOST_KNOWN) if closed.maps > 0 else 0
        expected = closed.first if known > 1 else 1e300
        results[i, 0], results[i, 1] = -closed.rubbed.real / period, -closed.rubbed.imag / period
        results[i, 2], results[i, 3] = closed.error, closed.maps
        results[i, 4], results[i, 5] = closed.stuck / period, closed.closest
    return states, results


@inner
def tracked(law: Any, body: Body, belt_speed: float, z: Any, accuracy: float, like: Any) -> Track:
    """The closed orbit from z, piece by piece."""
    room, residual = 128, np.empty(z.size)
    track = track_of(room)
    mapped(law, body, belt_speed, z, residual, accuracy, track, like)
    while track.filled[0] == room:
        room *= 4
        track = track_of(room)
        mapped(law, body, belt_speed, z, residual, accuracy, track, like)
    n = track.filled[0]
    return Track(track.tau[:n], track.x[:n], track.v[:n], track.friction[:n], track.stick[:n], track.filled)


NEAR = 1e-3
"""Of the size of a state: how near to an orbit that attracts a motion must come to be said to end there."""
PATIENCE = 300
"""Periods it may take."""


@inner
def sliding_on(body: Body, friction: float, like: Any) -> Any:
    """Position and velocity at tau = 0 of the friction-free orbit, shifted by a constant friction; no deflection."""
    shift = body.normal_load * friction / (body.stiffness_mean + body.stiffness_split)
    return body.reference_cosine + shift + 0.0 * like, body.frequency * body.reference_sine, 0.0 * like


@inner
def _arrives(law: Any, body: Body, belt_speed: float, start: Any, target: Any, like: Any) -> bool:
    """Whether a motion comes near to a closed orbit within some hundred periods."""
    residual, size, steps = np.empty(start.size), 1.0 + norm(target), 0
    for _ in range(PATIENCE):
        image = mapped(law, body, belt_speed, start, residual, 1e-5 * body.normal_load, track_of(0), like)
        steps += image.steps
        if image.steps < 0 or steps > MUCH_WORK // 4:
            return False
        for row in range(start.size):
            start[row] = start[row] + residual[row]
        less(start, target, residual)
        if norm(residual) < NEAR * size:
            return True
    return False


def _reached_without_memory(law: Any, body: Body, belt_speed: float, target: Any, like: Any) -> bool:
    """Where it is not sure that all motions end there, four starts are followed to their ends instead."""
    return False


def _reached_with_a_bristle(law: Any, body: Body, belt_speed: float, target: Any, like: Any) -> bool:
    """Whether the mass ends on this orbit, set off at rest on the belt and sliding as if it never reversed.

    The second is an orbit of its own where the belt is faster than any vibration and sliding friction constant.
    """
    start, forward = np.empty(target.size), math.copysign(1.0, belt_speed)
    start_of(law, body, start, 0.0 * like, belt_speed + 0.0 * like, 0.0 * like)
    if not _arrives(law, body, belt_speed, start, target, like):
        return False
    x, v, z = sliding_on(body, forward * law.sliding_friction(abs(belt_speed)), like)
    start_of(law, body, start, x, v, z - forward * law.largest_deflection())
    return _arrives(law, body, belt_speed, start, target, like)


def _reached_with_memory(law: Any, body: Body, belt_speed: float, target: Any, like: Any) -> bool:
    """The same two starts, with the memory of a contact at rest, and of sliding on."""
    start, forward = np.empty(target.size), math.copysign(1.0, belt_speed)
    start_of(law, body, start, 0.0 * like, belt_speed + 0.0 * like, 0.0 * like)
    if not _arrives(law, body, belt_speed, start, target, like):
        return False
    x, v, z = sliding_on(body, forward * law.sliding_friction(abs(belt_speed)), like)
    start_of(law, body, start, x, v, z - belt_speed)
    return _arrives(law, body, belt_speed, start, target, like)


reached = by_law(_reached_without_memory, _reached_with_a_bristle, None, _reached_with_memory)


class Curve(NamedTuple):
    """States [n, size], results [n, 6] of ``solve_curve``, READ columns [n, 17], monodromies, whether the starts that
    are quick to ask end there [n], the last orbit."""

    states: Any
    results: Any
    columns: Any
    matrices: Any
    reached: Any
    last: Track


@inner
def answer_curve(
    law: Any, body: Body, mass: Mass, belt_speeds: Any, guess: Any, goal: Goal, like: Any
) -> Curve:
    """Close the orbits of a curve and read them; guess [0 or 1, size] is a state to start from."""
    states, results = solve_curve(law, body, belt_speeds, guess, goal, like)
    n, size = states.shape
    accuracy = max(0.1 * goal.tolerance * body.normal_load, 1e-13)
    columns, matrices = np.full((n, len(READ)), np.nan), np.zeros((n, size, size))
    ends_there = np.zeros(n, np.bool_)
    track = track_of(0)
    for i in range(n):
        if results[i, 3] < 0.0:
            continue
        track = tracked(law, body, belt_speeds[i], states[i], accuracy, like)
        row = read(track.tau, track.x, track.v, track.friction, track.stick, mass, belt_speeds[i])
        for k in range(row.size):
            columns[i, k] = row[k]
        monodromy(law, body, belt_speeds[i], states[i], 1.0, matrices[i], like)
        if goal.asks:
            ends_there[i] = reached(law, body, belt_speeds[i], states[i], like)
    return Curve(states, results, columns, matrices, ends_there, track)


@inner
def settle(law: Any, body: Body, x: Any, v: Any, accuracy: float) -> Any:
    """From position x and velocity v on a belt at rest: the state once the mass stays put, and the periods it took.

    Periods: -1 where after many periods the mass still creeps.
    """
    z, residual = np.empty(size_of(law, x)), np.empty(size_of(law, x))
    start_of(law, body, z, x, v, 0.0 * x)
    period = span(body)
    for count in range(1, MOST_PERIODS):
        image = mapped(law, body, 0.0, z, residual, accuracy, track_of(0), x)
        for row in range(z.size):
            z[row] = z[row] + residual[row]
        if image.stuck >= period * (1.0 - 1e-12):
            return z, count
    return z, -1


LONGEST_PERIOD = 8
"""Of a subharmonic response that is looked for [drive periods]."""


@inner
def _apart(states: Any, a: int, b: int) -> float:
    total, size = 0.0, 1.0
    for row in range(states.shape[1]):
        total += (states[a, row] - states[b, row]) ** 2
        size = max(size, abs(states[a, row]))
    return math.sqrt(total) / size


@inner
def begin(law: Any, body: Body, start: Any, state: Any) -> None:
    """Fill the state of a start (x, v, deflection); see ``start_of``."""
    x, v, deflection = start
    start_of(law, body, state, x, v, deflection)


@inner
def wander(
    law: Any, body: Body, belt_speed: float, accuracy: float, means: Any, states: Any, like: Any
) -> Any:
    """Follow the motion from ``states[0]``, period by period, until it repeats.

    Fills the one-period means [n] and the states [n + 1, size]; returns after how many periods it repeats (0 where
    it has not after n), and how many it was followed.
    """
    steps = 0
    alike = 1e-7 if accuracy <= 1e-8 * body.normal_load else 1e-5  # coarse maps wander on by their own error
    residual = np.empty(states.shape[1])
    for n in range(means.size):
        image = mapped(law, body, belt_speed, states[n], residual, accuracy, track_of(0), like)
        means[n] = -image.rubbed.real / span(body)
        steps += image.steps
        for row in range(residual.size):
            states[n + 1, row] = states[n, row] + residual[row]
        nearest = 1e300
        for k in range(1, min(LONGEST_PERIOD, n // 2) + 1):
            repeats = max(_apart(states, n + 1, n + 1 - k), _apart(states, n, n - k)) < alike
            # a spiral into an orbit of fewer periods looks like a longer one while it is still far out
            if repeats and nearest > 1e-4:
                return k, n + 1
            nearest = min(nearest, _apart(states, n + 1, n + 1 - k))
        if image.steps < 0 or steps > MUCH_WORK:
            return 0, n + 1
    return 0, means.size
