"""SDIRK2: singly diagonally implicit Runge-Kutta method of order 2 in two stages.

It is L-stable and stiffly accurate. R. Alexander, SIAM J. Numer. Anal. 14 (1977), 1006:
gamma = 1 - 1/sqrt(2),

    Y1 = y + h gamma f(Y1),   Y2 = y + h (1 - gamma) f(Y1) + h gamma f(Y2),   y is Y2 at the end,

with y = (x, x', z): mass and bristles together, x eliminated. Newton's method with a difference Jacobian of
the rates solves each stage. A step in which it fails is halved, repeatedly if necessary.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from frictionlab.compile.decorators import inner
from frictionlab.compile.dispatch import by_dimension, length
from frictionlab.motion.equation import Acting, acting_at
from frictionlab.motion.linalg import solve_linear
from frictionlab.motion.steppers.step import StepEnd, StepStart

GAMMA = 1.0 - math.sqrt(0.5)
MOST_TRIALS = 30
MOST_HALVINGS = 24
MOST_PARTS = 10_000
"""Largest number of parts of one step that are tried; a contact that needs more is too stiff for the
method."""
_CLOSE = 1e-10
"""Relative size of the last Newton step; convergence is quadratic, so the remaining error is negligible."""
NUDGE = 1e-6
"""Relative step of the difference quotients."""


class DeflectedState(NamedTuple):
    """Position, velocity, deflection, and the integral of the friction coefficient since the step began."""

    x: Any
    v: Any
    z: Any
    impulse: Any


class Stage(NamedTuple):
    """Stage of a step: V = v + g x''(tau, x + g V, V, Z), Z = z + g z'(V, Z).

    acts: load, normal load and belt there. quick, deep: scales of velocity and deflection.
    """

    acts: Acting
    g: float
    x: Any
    v: Any
    z: Any
    quick: float
    deep: float


class StageSolution(NamedTuple):
    """Velocity and deflection of a stage, and whether Newton's method converged."""

    v: Any
    z: Any
    converged: bool


class Gap(NamedTuple):
    """Residual of the equations of a stage, or a change of velocity and deflection by Newton's method."""

    v: Any
    z: Any


@inner
def gap_of(rates: Any, problem: Any, stage: Stage, v: Any, z: Any) -> Gap:
    """Return the residual of the equations of a stage at this velocity and deflection."""
    a, _, r = rates(problem, stage.acts, stage.x + stage.g * v, v, z)
    return Gap(v - stage.v - stage.g * a, z - stage.z - stage.g * r)


@inner
def nudges(stage: Stage) -> tuple[float, float]:
    """Return the steps of the difference quotients.

    That of velocity is also small compared with full deflection in the stage.
    """
    return NUDGE * min(stage.quick, stage.deep / stage.g), NUDGE * stage.deep


def _change_on_the_line(rates: Any, problem: Any, stage: Stage, z: float, at: Gap, v: float) -> Gap:
    # Two equations in two unknowns, by Cramer's rule; quotients of differences are their derivatives.
    dv, dz = nudges(stage)
    one, two = gap_of(rates, problem, stage, v + dv, z), gap_of(rates, problem, stage, v, z + dz)
    a, b, c, d = (one.v - at.v) / dv, (two.v - at.v) / dz, (one.z - at.z) / dv, (two.z - at.z) / dz
    det = a * d - b * c
    return Gap((b * at.z - d * at.v) / det, (c * at.v - a * at.z) / det)


def _change_in_the_plane(rates: Any, problem: Any, stage: Stage, z: complex, at: Gap, v: complex) -> Gap:
    matrix, right = np.empty((4, 4)), np.empty(4)
    dv, dz = nudges(stage)
    # Complex numbers are two real ones here: friction need not be analytic in the slip. A column is the derivative
    # by one part of v, then of z.
    for column in range(4):
        turn = complex(0.0, 1.0) if column % 2 == 1 else complex(1.0, 0.0)
        step = dv if column < 2 else dz
        nudged = (
            gap_of(rates, problem, stage, v + step * turn, z)
            if column < 2
            else gap_of(rates, problem, stage, v, z + step * turn)
        )
        by_v, by_z = (nudged.v - at.v) / step, (nudged.z - at.z) / step
        matrix[0, column], matrix[1, column] = by_v.real, by_v.imag
        matrix[2, column], matrix[3, column] = by_z.real, by_z.imag
    right[0], right[1], right[2], right[3] = -at.v.real, -at.v.imag, -at.z.real, -at.z.imag
    solve_linear(matrix, right)
    return Gap(complex(right[0], right[1]), complex(right[2], right[3]))


newton_change = by_dimension(_change_on_the_line, _change_in_the_plane)
"""newton_change(rates, problem, stage, z, gap, v): full step of Newton's method from v, z."""


@inner
def size_of(stage: Stage, of: Gap) -> float:
    """Return a residual or a change, measured in the scales of velocity and deflection."""
    return length(of.v) / stage.quick + length(of.z) / stage.deep


@inner
def solve_stage(rates: Any, problem: Any, stage: Stage, v: Any, z: Any) -> StageSolution:
    """Solve the equations of a stage by damped Newton's method, from a guess."""
    at = gap_of(rates, problem, stage, v, z)
    missed = size_of(stage, at)
    for _ in range(MOST_TRIALS):
        change, part = newton_change(rates, problem, stage, z, at, v), 1.0
        # A singular Jacobian gives an infinite or undefined step.
        if not size_of(stage, change) < 1e300:
            return StageSolution(v, z, False)
        ahead = gap_of(rates, problem, stage, v + change.v, z + change.z)
        # Halve the Newton step until the residual decreases; at a thousandth it is taken as it is.
        while part > 1e-3 and not size_of(stage, ahead) < missed:
            part = 0.5 * part
            ahead = gap_of(rates, problem, stage, v + part * change.v, z + part * change.z)
        v, z, at, missed = v + part * change.v, z + part * change.z, ahead, size_of(stage, ahead)
        if part * size_of(stage, change) <= _CLOSE or missed == 0.0:
            return StageSolution(v, z, True)
    return StageSolution(v, z, False)


@inner
def two_stages(
    rates: Any, problem: Any, tau: float, start: DeflectedState, h: float, swing: float
) -> tuple[DeflectedState, bool]:
    """Take one step, and check whether both of its stages converged.

    swing: amplitude of the variation of the belt's velocity.
    """
    # Scales of this step: velocity from body and slip, deflection from the largest slip path in the step.
    g, late = GAMMA * h, (1.0 - GAMMA) * h
    x, v, z = start.x, start.v, start.z
    quick = length(v) + length(v - problem.belt_speed) + length(x) * 1e-3 + 1e-9 + swing
    deep = min(problem.law.largest_deflection(), length(z) + h * quick)
    acts = acting_at(problem.body, problem.belt_speed, tau + g)
    first = solve_stage(rates, problem, Stage(acts, g, x, v, z, quick, deep), v, z)
    # Stiffly accurate: the second stage is the state at the end of the step.
    a1, f1, r1 = rates(problem, acts, x + g * first.v, first.v, first.z)
    acts = acting_at(problem.body, problem.belt_speed, tau + h)
    base = Stage(acts, g, x + late * first.v, v + late * a1, z + late * r1, quick, deep)
    last = solve_stage(rates, problem, base, first.v, first.z)
    after = base.x + g * last.v
    f2 = rates(problem, acts, after, last.v, last.z)[1]
    impulse = start.impulse + late * f1 + g * f2
    return DeflectedState(after, last.v, last.z, impulse), first.converged and last.converged


@inner
def sdirk2_step(rates: Any, problem: Any, start: StepStart, h: float, swing: float) -> StepEnd:
    """Take one step over h, for a law of one deflection.

    ``rates(problem, acts, x, v, z)`` returns (x'', friction, z'). swing: amplitude of the variation of the
    belt's velocity. Steps in which Newton's method fails are halved. The state is NaN if even 2^-24 of the
    step fails, or if there are too many parts.
    """
    # Parts of the step, each half as long as the one that failed; accepted parts are kept.
    state = DeflectedState(start.x, start.v, problem.memory[0], 0.0 * start.v)
    done, part, least, tried = 0.0, h, h * 0.5**MOST_HALVINGS, 0
    while done < h * (1.0 - 1e-9):
        ahead, converged = two_stages(rates, problem, start.tau + done, state, part, swing)
        tried += 1
        if tried > MOST_PARTS or (not converged and part <= least):
            nothing = math.nan * start.v
            state = DeflectedState(math.nan * start.x, nothing, math.nan * state.z, nothing)
            break
        if not converged:
            part = 0.5 * part
            continue
        state, done = ahead, done + part
    problem.ahead[0] = state.z
    return StepEnd(state.x, state.v, state.impulse, False, 1.0)
