"""One step of a mass and the memory of its friction, of any size: Rodas5P, and Euler's method across a jump."""

from __future__ import annotations

import math
from typing import Any

from frictionlab.compile.decorators import inner
from frictionlab.dynamics.motion import instant_near
from frictionlab.methods.periodic.maps.memory_rates import Problem, Work, pushed, rates
from frictionlab.methods.periodic.maps.memory_state import Scales, parts
from frictionlab.numerics.steppers.rodas5p import (
    COUPLINGS,
    GAMMA,
    INCREMENTS,
    SLOPES,
    STAGES,
    TIMES,
    factored,
    solved,
)


@inner
def _factor(pressed: float, h: float, work: Work) -> None:
    """The matrix of a step for slip and memory; position and friction's integral follow from them."""
    d = work.drag.shape[1]
    n = work.right.size
    m = n - d
    diagonal = 1.0 / (GAMMA * h)
    for row in range(d):
        for column in range(n):
            work.matrix[row, column] = pressed * work.by[m + row, column]
        drag = work.drag[0, row] + GAMMA * h * work.drag[1, row]
        work.matrix[row, row] = work.matrix[row, row] + diagonal + drag
    for row in range(m):
        for column in range(n):
            work.matrix[d + row, column] = -work.by[row, column]
        work.matrix[d + row, d + row] = work.matrix[d + row, d + row] + diagonal
    factored(work.matrix, work.rows)


@inner
def stepped(problem: Problem, tau: float, h: float, scales: Scales, work: Work, like: Any) -> float:
    """One step from ``work.at`` to ``work.end``; returns its error in the norm of energy, with friction's impulse."""
    body, d = problem.body, work.drag.shape[1]
    n, m = work.at.size, work.at.size - 3 * d
    _factor(pushed(body, instant_near(problem, tau)), h, work)
    for i in range(STAGES):
        for row in range(n):
            total = work.at[row]
            for j in range(i):
                total += INCREMENTS[i, j] * work.k[j, row]
            work.stage[row] = total
        rates(problem, tau + TIMES[i] * h, work.stage, work, work.rates, like)
        for row in range(n):
            total = 0.0
            for j in range(i):
                total += COUPLINGS[i, j] * work.k[j, row]
            work.rates[row] = work.rates[row] + h * SLOPES[i] * work.slope[row] + total / h
        for row in range(d):
            work.right[row] = work.rates[d + row] - GAMMA * h * work.drag[1, row] * work.rates[row]
        for row in range(m):
            work.right[d + row] = work.rates[3 * d + row]
        solved(work.matrix, work.rows, work.right)
        for row in range(d):
            rub = work.rates[2 * d + row]
            for column in range(d + m):
                rub += work.by[m + row, column] * work.right[column]
            work.k[i, row] = GAMMA * h * (work.rates[row] + work.right[row])
            work.k[i, d + row] = work.right[row]
            work.k[i, 2 * d + row] = GAMMA * h * rub
        for row in range(m):
            work.k[i, 3 * d + row] = work.right[d + row]
    for row in range(n):
        work.end[row] = work.stage[row] + work.k[STAGES - 1, row]
    return _error(problem, scales, work, like)


@inner
def crossed(problem: Problem, tau: float, h: float, work: Work, like: Any) -> None:
    """A short step as the start has it (linearly implicit Euler): where a rate jumps, it passes the jump.

    Steps of many stages, some before the jump and some behind it, may end before it for ever.
    """
    body, d = problem.body, work.drag.shape[1]
    m = work.at.size - 3 * d
    _factor(pushed(body, instant_near(problem, tau)), h / GAMMA, work)
    rates(problem, tau, work.at, work, work.rates, like)
    for row in range(d):
        work.right[row] = work.rates[d + row] - h * work.drag[1, row] * work.rates[row]
    for row in range(m):
        work.right[d + row] = work.rates[3 * d + row]
    solved(work.matrix, work.rows, work.right)
    for row in range(d):
        rub = work.rates[2 * d + row]
        for column in range(d + m):
            rub += work.by[m + row, column] * work.right[column]
        work.end[row] = work.at[row] + h * (work.rates[row] + work.right[row])
        work.end[d + row] = work.at[d + row] + work.right[row]
        work.end[2 * d + row] = work.at[2 * d + row] + h * rub
    for row in range(m):
        work.end[3 * d + row] = work.at[3 * d + row] + work.right[d + row]


@inner
def _error(problem: Problem, scales: Scales, work: Work, like: Any) -> float:
    """Of deflections the energy, of scalars what they change in friction, for a radian."""
    body, d, last = problem.body, work.drag.shape[1], work.k[STAGES - 1]
    each, total = parts(work.memory[0]), 0.0
    m = work.at.size - 3 * d
    for row in range(d):
        total += work.drag[1, row] * last[row] ** 2 + last[d + row] ** 2
        total += (body.normal_load * last[2 * d + row]) ** 2
    for row in range(m):
        weight = scales.unit[row // each]
        if problem.law.turning == 0.0:
            weight = 0.0
            for along in range(d):
                weight += abs(work.by[m + along, d + row]) * body.normal_load / body.frequency
        total += (weight * last[3 * d + row]) ** 2
    return math.sqrt(total)
