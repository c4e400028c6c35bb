"""Closed orbits next to rest: Newton's method on the map of implicit steps, and the error of their mean friction.

Where friction holds the mass for most of the period the map hardly brings two motions together (its multipliers come
as near to one as 1 - 1e-12), and what the search must find is small beside what the derivative makes of it. The
derivative is exact, Newton's steps are judged by the correction that they leave and not by the residual (the natural
test; Deuflhard, Newton Methods for Nonlinear Problems, 2011, section 3.3), and it is the mean that is to be found:
its adjoint says what residuals and errors of the map change in it.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from frictionlab.compile.decorators import inner
from frictionlab.methods.periodic.continuation import COLUMNS, MAPS, Curve, Wanted, write_orbit
from frictionlab.methods.periodic.first_guess import first_guess
from frictionlab.methods.periodic.fixed_point import Goal, stated_error
from frictionlab.methods.periodic.period_map import pack, unpack
from frictionlab.methods.periodic.plateau import plateau
from frictionlab.motion.equation import belt_path, reference_velocity, span, swing_of
from frictionlab.motion.linalg import copy, eliminate, multiply, norm
from frictionlab.motion.maps.case import Case, case_of
from frictionlab.motion.maps.polar import (
    FIRST_ACCURACY,
    LONGEST,
    MIDDLE,
    MIDWAY,
    POSITION,
    RESTED,
    Image,
    Workspace,
    polar_map,
    room_for_maps,
    root_across,
    root_along,
)
from frictionlab.motion.maps.polar_step import DIRECTIONS, SlipPlace
from frictionlab.motion.maps.stick import periods_at_rest
from frictionlab.motion.orbit.recorder import Track, grown, track_of
from frictionlab.scene.body import BodyNumbers

MOST_POLAR_MAPS = 60
MOST_MOVES = 4
MUCH_FINER = 100.0
FINEST_ACCURACY = 1e-13
PLENTY = 40_000
"""Corrections within steps, some tenths of a second, after which the search ends with what it has."""


class Search(NamedTuple):
    """State, residual, trial, residual there, step, gradient of the mean, its adjoint [4]; (1 - M)^-1 and M [4, 4].

    sums: the mean friction along the belt and across [first two of 4].
    """

    z: Any
    residual: Any
    trial: Any
    fresh: Any
    step: Any
    gradient: Any
    adjoint: Any
    inverse: Any
    matrix: Any
    sums: Any
    room: Workspace


class SearchState(NamedTuple):
    """State of a search: the time at which its maps begin, their accuracy, the last image, and what it took."""

    origin: float
    accuracy: float
    image: Image
    maps: int
    work: int
    moves: int
    stalls: int
    error: float  # of the mean once the search has ended, else -1; infinite where it cannot go on


@inner
def _map(case: Case, search: Search, z: Any, residual: Any, origin: float, accuracy: float) -> Image:
    """One period from a state; leaves the rest in the residual and the room."""
    x, w = unpack(case.body, z, case.zero)
    start = SlipPlace(origin, x, abs(w), math.atan2(w.imag, w.real))
    image = polar_map(case, start, origin + span(case.body), accuracy, search.room, track_of(0))
    pack(case.body, residual, image.x - x, image.w - w)
    return image


@inner
def _monodromy(case: Case, image: Image, room: Workspace, matrix: Any) -> None:
    """Update the derivative of the last map in the norm of energy."""
    # slip is known by size and angle: d(r exp(i theta)) = exp(i theta) (dr + i r dtheta)
    r, body, tangent = abs(image.w), case.body, room.tangent
    turned = image.w / r if r > 0.0 else 0j
    for k in range(DIRECTIONS):
        w = turned * complex(tangent.r[k], r * tangent.theta[k])
        matrix[0, k], matrix[1, k] = root_along(body) * tangent.x[k].real, w.real
        matrix[2, k], matrix[3, k] = root_across(body) * tangent.x[k].imag, w.imag


@inner
def _keep(case: Case, search: Search, image: Image) -> None:
    """Take over what the last map has left in its room: derivative, means and their gradient."""
    body, room = case.body, search.room
    _monodromy(case, image, room, search.matrix)
    # the balance of momentum over a period: springs carry what friction does, stiffness*mean(x) = load*mean(T)
    weight = 1.0 / (body.normal_load * span(body))
    search.sums[0] = root_along(body) ** 2 * weight * room.totals[POSITION].real
    search.sums[1] = root_across(body) ** 2 * weight * room.totals[POSITION].imag
    for k in range(DIRECTIONS):
        search.gradient[k] = root_along(body) ** 2 * weight * room.tangent.total[k].real


@inner
def _invert(search: Search, shift: float) -> bool:
    """(1 + shift - M)^-1; False where that is singular."""
    n = DIRECTIONS
    work = np.empty((n, n))
    for row in range(n):
        for column in range(n):
            same = 1.0 if row == column else 0.0
            work[row, column] = same * (1.0 + shift) - search.matrix[row, column]
            search.inverse[row, column] = same
    eliminate(work, search.inverse)
    largest = 0.0
    for row in range(n):
        for column in range(n):
            largest = max(largest, abs(search.inverse[row, column]))
    return largest < 1e15


@inner
def _adjoint(search: Search) -> None:
    """Change of the mean by a residual."""
    for column in range(DIRECTIONS):
        total = 0.0
        for row in range(DIRECTIONS):
            total += search.gradient[row] * search.inverse[row, column]
        search.adjoint[column] = total


@inner
def _dot(a: Any, b: Any) -> float:
    total = 0.0
    for k in range(a.size):
        total += a[k] * b[k]
    return total


# --- where the search begins ----------------------------------------------------------------------------------------


@inner
def _accept(search: Search, z: Any, now: SearchState, image: Image, case: Case) -> SearchState:
    """Go on from a state whose map is the last one made; its residual is the fresh one."""
    copy(z, search.z)
    copy(search.fresh, search.residual)
    _keep(case, search, image)
    return SearchState(
        now.origin, now.accuracy, image, now.maps + 1, now.work + image.work, now.moves, now.stalls, -1.0
    )


@inner
def _repeat(case: Case, search: Search, now: SearchState, periods: float) -> SearchState:
    """From so many of the residual further on."""
    for k in range(DIRECTIONS):
        search.trial[k] = search.z[k] + periods * search.residual[k]
    image = _map(case, search, search.trial, search.fresh, now.origin, now.accuracy)
    return _accept(search, search.trial, now, image, case)


@inner
def _remap(case: Case, search: Search, now: SearchState) -> SearchState:
    """Return the map of the same state anew: at another accuracy or origin."""
    image = _map(case, search, search.z, search.fresh, now.origin, now.accuracy)
    return _accept(search, search.z, now, image, case)


@inner
def _begin(case: Case, search: Search, from_plateau: bool) -> SearchState:
    """At the plateau, else two periods after a harmonic motion with the mean that friction gives it."""
    body, z = case.body, search.z
    none = Image(0j, 0j, 0)
    far = plateau(case)
    slower = abs(case.belt_speed) < swing_of(body)
    if from_plateau and far.found and slower:
        pack(body, z, far.x, 0j)
        return _remap(case, search, SearchState(far.tau, FIRST_ACCURACY, none, 0, 0, 0, 0, -1.0))
    first_guess(case.law, body, case.belt_speed, z)
    _as_slip(case, z)
    now = _remap(case, search, SearchState(0.0, FIRST_ACCURACY, none, 0, 0, 0, 0, -1.0))
    for _ in range(2):
        if now.image.work > 0:
            now = _repeat(case, search, now, 1.0)
    return now


@inner
def _as_slip(case: Case, z: Any) -> None:
    """Write the state of a deviation at tau = 0 as position and slip."""
    body = case.body
    z[0] += root_along(body) * body.reference_cosine.real
    z[2] += root_across(body) * body.reference_cosine.imag
    velocity = reference_velocity(body, 0.0, 1.0) - case.belt_speed
    z[1], z[3] = z[1] + velocity.real, z[3] + velocity.imag


@inner
def _move_origin(case: Case, search: Search, now: SearchState) -> SearchState:
    """Begin the maps in the middle of the longest rest: their unknowns are then positions alone."""
    times, period = search.room.times, span(case.body)
    origin = times[MIDDLE] - period if times[MIDDLE] >= period else times[MIDDLE]
    pack(case.body, search.z, search.room.totals[MIDWAY], 0j)
    moved = SearchState(origin, now.accuracy, now.image, now.maps, now.work, now.moves + 1, now.stalls, -1.0)
    return _remap(case, search, moved)


@inner
def _carried(case: Case, search: Search, now: SearchState) -> SearchState:
    """Rest for all of a period: go on by as many as it surely lasts."""
    body = case.body
    x, _w = unpack(body, search.z, case.zero)
    x += belt_path(body, case.belt_speed, now.origin, 2.0 * span(body))
    many = periods_at_rest(case.law, body, case.belt_speed, x - body.reference_cosine)
    return _repeat(case, search, now, many)


# --- steps ----------------------------------------------------------------------------------------------------------


@inner
def _newton(case: Case, search: Search, now: SearchState) -> SearchState:
    """Newton's step, halved until the correction that is left, by the same derivative, has become small enough."""
    size, length, part = norm(search.step), norm(search.residual), 1.0
    left = np.empty(DIRECTIONS)
    maps, work = now.maps, now.work
    while part > 0.01:
        for k in range(DIRECTIONS):
            search.trial[k] = search.z[k] + part * search.step[k]
        image = _map(case, search, search.trial, search.fresh, now.origin, now.accuracy)
        maps, work = maps + 1, work + max(image.work, 0)
        # the natural test: what is left of the correction by the derivative before, whatever the residual does
        multiply(search.inverse, search.fresh, left)
        falls = norm(left) <= (1.0 - 0.25 * part) * size or norm(search.fresh) <= 0.5 * length
        resting = search.room.times[RESTED] >= span(case.body) * (1.0 - 1e-9)
        if image.work > 0 and falls and not resting:
            tried = SearchState(
                now.origin, now.accuracy, now.image, maps - 1, work - image.work, now.moves, 0, -1.0
            )
            return _accept(search, search.trial, tried, image, case)
        part *= 0.5
    stalled = SearchState(now.origin, now.accuracy, now.image, maps, work, now.moves, now.stalls + 1, -1.0)
    return _unstall(case, search, stalled)


@inner
def _unstall(case: Case, search: Search, now: SearchState) -> SearchState:
    """Three periods on; the map of coarse steps jumps with them, so that after some stalls they become finer."""
    finer = now.stalls % 3 == 0
    accuracy = max(0.1 * now.accuracy, FINEST_ACCURACY) if finer else now.accuracy
    now = SearchState(now.origin, accuracy, now.image, now.maps, now.work, now.moves, now.stalls, -1.0)
    for _ in range(3):
        if now.image.work > 0:
            now = _repeat(case, search, now, 1.0)
    return now


@inner
def _judge(case: Case, search: Search, now: SearchState, goal: Goal) -> SearchState:
    """Error of the mean by the same state mapped with much finer steps; the end where it is small enough."""
    # to first order the mean of the closed orbit: that of this one and what its residual changes in it
    coarse = search.sums[0] + _dot(search.adjoint, search.residual)
    before, accuracy = search.residual.copy(), now.accuracy / MUCH_FINER
    finer = SearchState(now.origin, accuracy, now.image, now.maps, now.work, now.moves, now.stalls, -1.0)
    adjoint = search.adjoint.copy()
    finer = _remap(case, search, finer)
    if finer.image.work < 0:
        return finer
    open_ = _dot(adjoint, search.residual)
    mean = search.sums[0] + open_
    for k in range(DIRECTIONS):
        before[k] -= search.residual[k]
    steep = norm(adjoint)
    # the adjoint carries what the coarser map has wrong at the end of the period, and rounding, to the mean
    steps = steep * (norm(before) + 4e-15 * norm(search.z))
    error = stated_error(abs(mean - coarse), abs(open_), steps)
    ended = now.accuracy < FIRST_ACCURACY and (error <= goal.tolerance or accuracy <= FINEST_ACCURACY)
    if not ended:
        return finer
    search.sums[0] = mean
    return SearchState(
        now.origin, accuracy, finer.image, finer.maps, finer.work, now.moves, now.stalls, error
    )


@inner
def _search(case: Case, search: Search, goal: Goal, now: SearchState) -> SearchState:
    period, body = span(case.body), case.body
    while now.maps < MOST_POLAR_MAPS and now.work < PLENTY and now.error < 0.0:
        if now.image.work < 0:
            break
        if search.room.times[RESTED] >= period * (1.0 - 1e-9):
            if case.belt_speed == 0.0:
                break
            now = _carried(case, search, now)
            continue
        slips = search.z[1] != 0.0 or search.z[3] != 0.0
        if slips and search.room.times[LONGEST] > 0.0 and now.moves < MOST_MOVES:
            now = _move_origin(case, search, now)
            continue
        # multipliers may be one to rounding where rest lasts: then those of a map that damps a little more
        if not _invert(search, 0.0) and not _invert(search, 1e-9):
            now = _unstall(case, search, now)
            continue
        multiply(search.inverse, search.residual, search.step)
        _adjoint(search)
        closes = abs(_dot(search.adjoint, search.residual)) <= 0.05 * goal.tolerance
        if closes and norm(search.step) <= 50.0 * goal.tolerance * body.normal_load:
            now = _judge(case, search, now, goal)
        else:
            now = _newton(case, search, now)
    return now


# --- the orbits of a curve ------------------------------------------------------------------------------------------


@inner
def _search_room() -> Search:
    n = DIRECTIONS
    z = np.zeros(n)
    square = np.zeros((n, n))
    return Search(
        z, z.copy(), z.copy(), z.copy(), z.copy(), z.copy(), z.copy(), square, square.copy(), z.copy(),
        room_for_maps(),
    )  # fmt: skip


@inner
def _solve(case: Case, search: Search, goal: Goal, state: Any, row: Any) -> None:
    """Record the orbit of one scene: its state at tau = 0, and what ``solve_curve`` has of it."""
    body, period = case.body, span(case.body)
    now = _search(case, search, goal, _begin(case, search, True))
    if now.error < 0.0:
        now = _search(case, search, goal, _begin(case, search, False))
    stuck = search.room.times[RESTED] / period
    x, w = unpack(body, search.z, case.zero)
    start = SlipPlace(now.origin, x, abs(w), math.atan2(w.imag, w.real))
    if now.origin > 0.0 and now.error >= 0.0:
        image = polar_map(case, start, period, now.accuracy, search.room, track_of(0))
        x, w = image.x, image.w
    pack(body, state, x - body.reference_cosine, w + case.belt_speed - reference_velocity(body, 0.0, 1.0))
    error, maps = (now.error, now.maps) if now.error >= 0.0 else (math.inf, -now.maps)
    write_orbit(row, complex(search.sums[0], search.sums[1]), error, maps, (stuck, 0.0))


@inner
def _recorded(case: Case, search: Search, state: Any, track: Track) -> Track:
    """Return the track with the orbit from a state at tau = 0; the room has its derivative."""
    body = case.body
    y, u = unpack(body, state, case.zero)
    w = u + reference_velocity(body, 0.0, 1.0) - case.belt_speed
    start = SlipPlace(0.0, y + body.reference_cosine, abs(w), math.atan2(w.imag, w.real))
    first = track.filled[0]
    image = polar_map(case, start, span(body), 1e-4 * FIRST_ACCURACY, search.room, track)
    while track.stick.size > 0 and track.filled[0] == track.stick.size:
        track = grown(track, 4 * track.stick.size)
        track.filled[0] = first
        image = polar_map(case, start, span(body), 1e-4 * FIRST_ACCURACY, search.room, track)
    _monodromy(case, image, search.room, search.matrix)
    return track


@inner
def answer_near_rest(
    law: Any, body: BodyNumbers, belt_speeds: Any, guess: Any, goal: Goal, wanted: Wanted
) -> Curve:
    """As ``answer_curve``, each scene by itself; guess: the states of all orbits where nothing is to be closed."""
    n, search = belt_speeds.size, _search_room()
    states, results = np.zeros((n, DIRECTIONS)), np.ones((n, COLUMNS))
    matrices = np.zeros((n if wanted.matrices else 0, DIRECTIONS, DIRECTIONS))
    track, ends = track_of(128 if wanted.orbits else 0), np.zeros(n, np.int64)
    for i in range(n):
        case = case_of(law, body, belt_speeds[i])
        if wanted.closed:
            _solve(case, search, goal, states[i], results[i])
        else:
            copy(guess[i], states[i])
        if results[i, MAPS] > 0.0 and (wanted.orbits or wanted.matrices):
            track = _recorded(case, search, states[i], track)
            for row in range(DIRECTIONS if wanted.matrices else 0):
                copy(search.matrix[row], matrices[i, row])
        ends[i] = track.filled[0]
    return Curve(states, results, matrices, np.zeros(n, np.int64), track, ends)
