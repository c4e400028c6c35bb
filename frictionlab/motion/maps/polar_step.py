"""Step of slip in polar coordinates by five-stage Radau IIA collocation (order 9, L-stable).

The step also gives its derivative.

Slip w = r exp(i theta) of a mass at x under the force a of loads, springs and dashpots obeys r' = a.e - f(r)
and r theta' = a.n, with e along the slip and n across. Near rest friction turns slip towards the force at the
rate f/r; explicit steps must follow that, this one need not. Multiplied by r, the second equation also holds
at r = 0, so that a step may start from rest: theta is then the direction of the force.

Source: Hairer & Wanner, Solving Ordinary Differential Equations II (1996), sections IV.5 and IV.8.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from frictionlab.compile.decorators import inner
from frictionlab.motion.equation import (
    belt_rate,
    belt_velocity,
    instant_at,
    load,
    normal_load,
    restoring_force,
    swing_of,
)
from frictionlab.motion.linalg import eliminate
from frictionlab.motion.maps.case import Case
from frictionlab.values.quantities import Floats

RADAU_STAGES = 5
"""Number of stages of a step by Radau IIA (order 9, L-stable; Hairer & Wanner 1996, IV.5)."""


def _radau() -> tuple[Floats, Floats]:
    """Return nodes in (0, 1] and the matrix that integrates the polynomial through them from 0 to each."""
    legendre = np.polynomial.legendre.Legendre.basis
    # The nodes of Radau IIA are the zeros of P_s - P_(s-1), the right end 1 among them: it is divided out.
    inside = (legendre(RADAU_STAGES) - legendre(RADAU_STAGES - 1)) // np.polynomial.Polynomial(
        [-1.0, 1.0]
    ).convert(kind=np.polynomial.Legendre)
    nodes = np.concatenate((0.5 * (1.0 + np.sort(inside.roots().real)), [1.0]))
    # Row i integrates every monomial up to node i; the inverse turns values at the nodes into monomials.
    powers = np.arange(RADAU_STAGES)
    values = nodes[:, None] ** powers
    sums = nodes[:, None] ** (powers + 1) / (powers + 1)
    return nodes, sums @ np.linalg.inv(values)


NODES, MATRIX = _radau()
WEIGHTS: Floats = MATRIX[-1].copy()
DIRECTIONS = 4
"""Number of directions of the state: positions and slip, along and across."""
MOST_TRIES = 10
CONVERGED = 1e-8
"""Relative change of a step's unknowns after which the next change is rounding, since Newton's steps converge
fast."""
ALL_NODES: Floats = np.concatenate(([0.0], NODES))
INVERSE: Floats = np.ascontiguousarray(np.linalg.inv(MATRIX))
LEAVING: Floats = INVERSE.sum(axis=1)
_gaps = ALL_NODES[:, None] - ALL_NODES[None, :] + np.eye(RADAU_STAGES + 1)
LAGRANGE: Floats = 1.0 / _gaps.prod(axis=1)
HIGHEST: Floats = LAGRANGE / 252.0
"""Weights that turn values at the nodes into the coefficient of the highest Legendre polynomial; 252 x^5
leads it on [0, 1]."""


class SlipPlace(NamedTuple):
    """Start of a step of slip: time, position, slip."""

    tau: float
    x: complex
    r: float
    theta: float


class Tangent(NamedTuple):
    """Derivative of the state with respect to that at the start of the map, a column for each direction [4].

    The state is r and theta of slip, and x; ``total`` is the derivative of the integral of the position.
    """

    r: Any
    theta: Any
    x: Any
    total: Any


class StepRoom(NamedTuple):
    """Arrays for one step.

    They hold slip at its start and stages [6], x, e, f and forces at the stages [5], and linear systems.

    corrections: of Newton's method, in all steps [1].
    """

    r: Any
    theta: Any
    x: Any
    v: Any
    along: Any
    force: Any
    pushed: Any
    carried: Any
    pressed: Any
    rub: Any
    slope: Any
    matrix: Any
    right: Any
    ahead: Any
    corrections: Any


@inner
def step_room() -> StepRoom:
    """Return arrays for steps."""
    n, kind = RADAU_STAGES, np.zeros(RADAU_STAGES, np.complex128)
    real = np.zeros(n)
    return StepRoom(
        np.zeros(n + 1),
        np.zeros(n + 1),
        kind,
        kind.copy(),
        kind.copy(),
        kind.copy(),
        kind.copy(),
        kind.copy(),
        real,
        real.copy(),
        real.copy(),
        np.empty((2 * n, 2 * n)),
        np.empty((2 * n, 1)),
        np.empty((2 * n, DIRECTIONS)),
        np.zeros(1),
    )


@inner
def begin_step(case: Case, place: SlipPlace, h: float, room: StepRoom) -> None:
    """Write loads and belt at the stages."""
    room.r[0], room.theta[0] = place.r, place.theta
    for j in range(RADAU_STAGES):
        now = instant_at(case.body, place.tau + NODES[j] * h)
        room.pushed[j] = load(case.body, now) - belt_rate(case.body, now, 1)
        room.carried[j] = belt_velocity(case.body, case.belt_speed, now)
        room.pressed[j] = normal_load(case.body, now)


@inner
def friction_slope(case: Case, r: float) -> float:
    """Return the slope of friction over the speed of slip: a difference quotient of the law's own curve."""
    shift = 1e-5 * r + 1e-9 * (swing_of(case.body) + abs(case.belt_speed))
    low = max(r - shift, 0.0)
    return (case.law.sliding_friction(r + shift) - case.law.sliding_friction(low)) / (r + shift - low)


@inner
def _forces(case: Case, place: SlipPlace, h: float, room: StepRoom) -> None:
    """Write positions, friction, and forces turned so that the slip is real, at the stages."""
    # slip w = r exp(i theta): friction acts against r alone, the force across the slip turns it
    for j in range(RADAU_STAGES):
        room.along[j] = complex(math.cos(room.theta[j + 1]), math.sin(room.theta[j + 1]))
        room.v[j] = room.carried[j] + room.r[j + 1] * room.along[j]
        room.rub[j] = room.pressed[j] * case.law.sliding_friction(room.r[j + 1])
        room.slope[j] = room.pressed[j] * friction_slope(case, room.r[j + 1])
    # x at a stage is the integral of v by the collocation polynomial through the stages
    for j in range(RADAU_STAGES):
        increment = 0.0 * place.x
        for k in range(RADAU_STAGES):
            increment += MATRIX[j, k] * room.v[k]
        room.x[j] = place.x + h * increment
        force = room.pushed[j] - restoring_force(case.body, room.x[j], room.v[j])
        room.force[j] = force * room.along[j].conjugate()


@inner
def _turning(j: int, room: StepRoom) -> float:
    """Return the derivative of theta at a stage, times the step."""
    total = 0.0
    for k in range(RADAU_STAGES):
        total += INVERSE[j, k] * (room.theta[k + 1] - room.theta[0])
    return total


@inner
def _assemble(case: Case, h: float, room: StepRoom) -> None:
    """Write the Jacobian of the stages' equations: rows and columns first of r, then of theta."""
    # r' = Re(force) - friction(r) and r theta' = Im(force), each times h; the inverse of the collocation matrix gives
    # the derivatives at the stages from the values there
    n = RADAU_STAGES
    for j in range(n):
        back = room.along[j].conjugate()
        for k in range(n):
            same = 1.0 if j == k else 0.0
            # w = r exp(i theta) moves along itself with r, and across itself with theta
            by_r = room.along[k]
            by_theta = room.r[k + 1] * complex(-by_r.imag, by_r.real)
            pull = back * restoring_force(case.body, h * MATRIX[j, k] * by_r, same * by_r)
            room.matrix[j, k] = INVERSE[j, k] + h * pull.real
            room.matrix[n + j, k] = h * pull.imag
            pull = back * restoring_force(case.body, h * MATRIX[j, k] * by_theta, same * by_theta)
            room.matrix[j, n + k] = h * pull.real
            room.matrix[n + j, n + k] = room.r[j + 1] * INVERSE[j, k] + h * pull.imag
        # the force is turned by -theta of its own stage
        room.matrix[j, j] += h * room.slope[j]
        room.matrix[j, n + j] -= h * room.force[j].imag
        room.matrix[n + j, j] += _turning(j, room)
        room.matrix[n + j, n + j] += h * room.force[j].real


@inner
def _lack(h: float, room: StepRoom) -> None:
    """Write the right side: the residuals of the stages' equations."""
    for j in range(RADAU_STAGES):
        growth = 0.0
        for k in range(RADAU_STAGES):
            growth += INVERSE[j, k] * (room.r[k + 1] - room.r[0])
        room.right[j, 0] = h * (room.force[j].real - room.rub[j]) - growth
        room.right[RADAU_STAGES + j, 0] = h * room.force[j].imag - room.r[j + 1] * _turning(j, room)


@inner
def _move(room: StepRoom) -> float:
    """Take Newton's step, or a part of it that keeps slip at the stages and turns it by less than a radian.

    Return the part taken.
    """
    part = 1.0
    for j in range(RADAU_STAGES):
        if room.r[j + 1] + part * room.right[j, 0] < 0.1 * room.r[j + 1]:
            part = -0.9 * room.r[j + 1] / room.right[j, 0]
        turn = abs(room.right[RADAU_STAGES + j, 0])
        if part * turn > 1.0:
            part = 1.0 / turn
    for j in range(RADAU_STAGES):
        room.r[j + 1] += part * room.right[j, 0]
        room.theta[j + 1] += part * room.right[RADAU_STAGES + j, 0]
    return part


@inner
def solve_step(case: Case, place: SlipPlace, h: float, room: StepRoom) -> bool:
    """Solve for slip at the stages, from the guess there, by Newton's method; return False if that fails."""
    for _ in range(MOST_TRIES):
        room.corrections[0] += 1.0
        _forces(case, place, h, room)
        _assemble(case, h, room)
        _lack(h, room)
        eliminate(room.matrix, room.right)
        change, turn, largest, force = 0.0, 0.0, 0.0, 0.0
        for j in range(RADAU_STAGES):
            change, turn = max(change, abs(room.right[j, 0])), max(turn, abs(room.right[RADAU_STAGES + j, 0]))
            force = max(force, abs(room.force[j]))
        if not change + turn < math.inf:
            return False
        part = _move(room)
        for j in range(RADAU_STAGES):
            largest = max(largest, room.r[j + 1])
        if part == 1.0 and turn <= CONVERGED and change <= max(CONVERGED * largest, 4e-15 * h * force):
            _forces(case, place, h, room)
            return True
    return False


@inner
def step_error(h: float, accuracy: float, room: StepRoom) -> float:
    """Return the highest Legendre coefficients of slip over their tolerance.

    Below one the step is accurate.
    """
    growth, turn, largest = 0.0, 0.0, 0.0
    for k in range(RADAU_STAGES + 1):
        growth += HIGHEST[k] * room.r[k]
        turn += HIGHEST[k] * (room.theta[k] - room.theta[0])
        largest = max(largest, room.r[k])
    growth, turn = abs(growth), abs(turn)
    return max(max(growth, largest * turn) / accuracy, 50.0 * turn)


@inner
def end_step(case: Case, place: SlipPlace, h: float, room: StepRoom, tangent: Tangent) -> complex:
    """Carry the tangent over a solved step, and return the integral of the position."""
    n, body = RADAU_STAGES, case.body
    _assemble(case, h, room)
    for j in range(n):
        back = room.along[j].conjugate()
        for column in range(DIRECTIONS):
            pull = back * restoring_force(body, tangent.x[column], 0.0 * tangent.x[column])
            room.ahead[j, column] = LEAVING[j] * tangent.r[column] - h * pull.real
            room.ahead[n + j, column] = room.r[j + 1] * LEAVING[j] * tangent.theta[column] - h * pull.imag
    eliminate(room.matrix, room.ahead)
    total = 0.0 * place.x
    for j in range(n):
        total += h * WEIGHTS[j] * room.x[j]
    for column in range(DIRECTIONS):
        start = tangent.x[column]
        gained = 0.0 * start
        for j in range(n):
            x = start
            for k in range(n):
                turn = complex(room.ahead[k, column], room.r[k + 1] * room.ahead[n + k, column])
                x += h * MATRIX[j, k] * (turn * room.along[k])
            gained += h * WEIGHTS[j] * x
            tangent.x[column] = x  # the last stage is the end
        tangent.total[column] += gained
        tangent.r[column], tangent.theta[column] = room.ahead[n - 1, column], room.ahead[2 * n - 1, column]
    return total


# --- guesses of a step ----------------------------------------------------------------------------------------------


@inner
def _polynomial(values: Any, at: float) -> float:
    """Evaluate the polynomial through start and stages of a step at a share of it, also beyond its end."""
    total = 0.0
    for k in range(RADAU_STAGES + 1):
        weight = LAGRANGE[k]
        for m in range(RADAU_STAGES + 1):
            if m != k:
                weight *= at - ALL_NODES[m]
        total += weight * values[k]
    return total


@inner
def guess_on(place: SlipPlace, first: float, last: float, room: StepRoom) -> None:
    """Guess slip as the last solved step continues, between these two shares of it."""
    r, theta = np.empty(RADAU_STAGES), np.empty(RADAU_STAGES)
    for j in range(RADAU_STAGES):
        at = first + NODES[j] * (last - first)
        r[j], theta[j] = max(_polynomial(room.r, at), 0.05 * place.r), _polynomial(room.theta, at)
    for j in range(RADAU_STAGES):
        room.r[j + 1], room.theta[j + 1] = r[j], theta[j]


@inner
def guess_afresh(
    place: SlipPlace, h: float, held: complex, rate: complex, limit: float, room: StepRoom
) -> None:
    """Guess slip that goes straight on, or starts along the force that held the mass."""
    along = complex(math.cos(place.theta), math.sin(place.theta))
    excess, rise = (held * along.conjugate()).real - limit, (rate * along.conjugate()).real
    turn = (rate * along.conjugate()).imag / (limit + abs(excess))
    for j in range(RADAU_STAGES):
        t = NODES[j] * h
        if place.r > 0.0:
            room.r[j + 1], room.theta[j + 1] = max(place.r + excess * t, 0.1 * place.r), place.theta
        else:
            room.r[j + 1] = max(t * (max(excess, 0.0) + 0.5 * rise * t), 1e-3 * abs(rise) * t * t)
            room.theta[j + 1] = place.theta + turn * t
