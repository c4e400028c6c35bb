"""SDIRK2: a singly diagonally implicit Runge-Kutta method of order 2 in two stages, L-stable and stiffly accurate.

R. Alexander, SIAM J. Numer. Anal. 14 (1977), 1006: gamma = 1 - 1/sqrt(2),

    Y1 = y + h gamma f(Y1),   Y2 = y + h (1 - gamma) f(Y1) + h gamma f(Y2),   y is Y2 at the end,

with y = (x, x', z): mass and bristles together, x eliminated. Each stage is solved by Newton's method with a
difference Jacobian of the rates; a step in which that fails is halved, repeatedly if necessary.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from frictionlab.compile.decorators import inner
from frictionlab.compile.dispatch import by_dimension, length
from frictionlab.numerics.steppers.rodas5p import factored, solved

GAMMA = 1.0 - math.sqrt(0.5)
MOST_TRIALS = 30
MOST_HALVINGS = 24
CLOSE = 1e-10
"""Relative size of the last Newton step; convergence is quadratic, so the remaining error is negligible."""
NUDGE = 1e-6
"""Relative step of the difference quotients."""


class Taken(NamedTuple):
    """The state after a step, and the integral of the friction coefficient over it."""

    x: Any
    v: Any
    z: Any
    rubbed: Any


class Stage(NamedTuple):
    """V = v + g x''(tau, x + g V, V, Z), Z = z + g z'(V, Z); quick, deep: scales of velocity and deflection."""

    tau: float
    g: float
    x: Any
    v: Any
    z: Any
    quick: float
    deep: float


class Met(NamedTuple):
    """The solution of a stage, and whether Newton's method converged."""

    v: Any
    z: Any
    found: bool


class Gap(NamedTuple):
    """The residual of the equations of a stage."""

    v: Any
    z: Any


def stepper(rates: Any) -> Any:
    """``step(problem, tau, x, v, z, h)`` for a kernel function ``rates(problem, tau, x, v, z)`` = (x'', mu, z').

    The problem has ``law`` and ``belt_speed``.
    """

    @inner
    def gap(problem: Any, stage: Stage, v: Any, z: Any) -> Gap:
        a, _, r = rates(problem, stage.tau, stage.x + stage.g * v, v, z)
        return Gap(v - stage.v - stage.g * a, z - stage.z - stage.g * r)

    @inner
    def nudges(stage: Stage) -> tuple[float, float]:
        """Steps of the difference quotients; that of velocity is small against full deflection in the stage, too."""
        return NUDGE * min(stage.quick, stage.deep / stage.g), NUDGE * stage.deep

    def change_on_the_line(problem: Any, stage: Stage, z: float, at: Gap, v: float) -> Gap:
        dv, dz = nudges(stage)
        one, two = gap(problem, stage, v + dv, z), gap(problem, stage, v, z + dz)
        a, b, c, d = (one.v - at.v) / dv, (two.v - at.v) / dz, (one.z - at.z) / dv, (two.z - at.z) / dz
        det = a * d - b * c
        return Gap((b * at.z - d * at.v) / det, (c * at.v - a * at.z) / det)

    def change_in_the_plane(problem: Any, stage: Stage, z: complex, at: Gap, v: complex) -> Gap:
        matrix, right, rows = np.empty((4, 4)), np.empty(4), np.empty(4, np.int64)
        dv, dz = nudges(stage)
        for column in range(4):
            turn = complex(0.0, 1.0) if column % 2 == 1 else complex(1.0, 0.0)
            step = dv if column < 2 else dz
            nudged = (
                gap(problem, stage, v + step * turn, z)
                if column < 2
                else gap(problem, stage, v, z + step * turn)
            )
            by_v, by_z = (nudged.v - at.v) / step, (nudged.z - at.z) / step
            matrix[0, column], matrix[1, column] = by_v.real, by_v.imag
            matrix[2, column], matrix[3, column] = by_z.real, by_z.imag
        right[0], right[1], right[2], right[3] = -at.v.real, -at.v.imag, -at.z.real, -at.z.imag
        factored(matrix, rows)
        solved(matrix, rows, right)
        return Gap(complex(right[0], right[1]), complex(right[2], right[3]))

    change = by_dimension(change_on_the_line, change_in_the_plane)

    @inner
    def size(stage: Stage, of: Gap) -> float:
        return length(of.v) / stage.quick + length(of.z) / stage.deep

    @inner
    def met(problem: Any, stage: Stage, v: Any, z: Any) -> Met:
        """Damped Newton's method from a guess: each step is halved until the residual decreases."""
        at = gap(problem, stage, v, z)
        missed = size(stage, at)
        for _ in range(MOST_TRIALS):
            way, part = change(problem, stage, z, at, v), 1.0
            # A singular Jacobian gives an infinite or undefined step.
            if not size(stage, way) < 1e300:
                return Met(v, z, False)
            ahead = gap(problem, stage, v + way.v, z + way.z)
            # Halve the Newton step until the residual decreases; at a thousandth it is taken as it is.
            while part > 1e-3 and not size(stage, ahead) < missed:
                part = 0.5 * part
                ahead = gap(problem, stage, v + part * way.v, z + part * way.z)
            v, z, at, missed = v + part * way.v, z + part * way.z, ahead, size(stage, ahead)
            if part * size(stage, way) <= CLOSE or missed == 0.0:
                return Met(v, z, True)
        return Met(v, z, False)

    @inner
    def tried(problem: Any, tau: float, start: Taken, h: float) -> tuple[Taken, bool]:
        """One step, and whether both of its stages converged."""
        # Scales of this step: of velocity from body and slip, of deflection from what slip can do within the step.
        g, late = GAMMA * h, (1.0 - GAMMA) * h
        x, v, z = start.x, start.v, start.z
        quick = length(v) + length(v - problem.belt_speed) + length(x) * 1e-3 + 1e-9
        deep = min(problem.law.largest_deflection(), length(z) + h * quick)
        first = met(problem, Stage(tau + g, g, x, v, z, quick, deep), v, z)
        # Stiffly accurate: the second stage is the state at the end of the step.
        a1, f1, r1 = rates(problem, tau + g, x + g * first.v, first.v, first.z)
        base = Stage(tau + h, g, x + late * first.v, v + late * a1, z + late * r1, quick, deep)
        last = met(problem, base, first.v, first.z)
        after = base.x + g * last.v
        f2 = rates(problem, tau + h, after, last.v, last.z)[1]
        rubbed = start.rubbed + late * f1 + g * f2
        return Taken(after, last.v, last.z, rubbed), first.found and last.found

    @inner
    def step(problem: Any, tau: float, x: Any, v: Any, z: Any, h: float) -> Taken:
        state, done, part = Taken(x, v, z, 0.0 * v), 0.0, h
        least = h * 0.5**MOST_HALVINGS
        while done < h * (1.0 - 1e-9):
            ahead, found = tried(problem, tau + done, state, part)
            # A failed step is halved; the state is NaN if even 2^-24 of the step fails.
            if not found and part <= least:
                return Taken(math.nan * x, math.nan * v, math.nan * z, math.nan * v)
            if not found:
                part = 0.5 * part
                continue
            state, done = ahead, done + part
        return state

    return step
