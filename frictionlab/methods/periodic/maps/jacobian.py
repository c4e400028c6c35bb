"""Derivatives of a law with any memory: difference quotients, of steps that follow the size of what they are of."""

from __future__ import annotations

from typing import Any

from frictionlab.compile.decorators import inner
from frictionlab.compile.dispatch import by_dimension, length
from frictionlab.dynamics.events import reference_acceleration
from frictionlab.dynamics.motion import (
    belt_acceleration,
    belt_jerk,
    instant_near,
    reference_velocity,
    restoring_force,
    unbalanced_rate,
)
from frictionlab.methods.periodic.maps.memory_rates import Problem, Work, begin_step, felt
from frictionlab.methods.periodic.maps.memory_state import Scales, filled, parts, spilled, swing_of
from frictionlab.numerics.vectors import dimension, put, taken, unit

NUDGE = 1e-5
"""Of a slip velocity or a scalar, for a difference quotient."""
FINE = 1e-7
"""Of a deflection: laws have corners there, and little else that bends."""
LOST = 1e-9
"""Of friction: a smaller difference is lost to rounding, and of the motion's speed, a slip too slow to matter."""


@inner
def _tried(law: Any, w: Any, work: Work, row: int, like: Any) -> Any:
    """Rates of memory and friction as one row of ``work.trial``; returns friction."""
    rub = felt(law, w, work)
    m = work.trial.shape[1] - dimension(like)
    spilled(work.moving, work.trial[row], 0, work.moving[0])
    put(work.trial[row, m:], 0, rub)
    return rub


def _away_on_the_line(w: float, least: float) -> float:
    """Slip far enough from its reversal for a quotient on its own side."""
    return max(w, least) if w >= 0.0 else min(w, -least)


def _away_in_the_plane(w: complex, least: complex) -> complex:
    return w


_away = by_dimension(_away_on_the_line, _away_in_the_plane)


@inner
def _by_slip(law: Any, w: Any, swing: float, work: Work, like: Any) -> None:
    """Quotients by slip: of friction on the scale of the slip itself, however slow, if rounding leaves any."""
    d = dimension(like)
    m = work.trial.shape[1] - d
    least = LOST * swing
    for column in range(d):
        h = max(NUDGE * length(w), 1e-30 * swing)
        while True:
            shift = h * unit(column, like)
            ahead, behind = _tried(law, w + shift, work, 0, like), _tried(law, w - shift, work, 1, like)
            for row in range(m, m + d):
                work.by[row, column] = (work.trial[0, row] - work.trial[1, row]) / (2.0 * h)
            if h >= least or length(ahead - behind) > LOST * (length(ahead) + length(behind)):
                break
            h = min(1e3 * h, least)
        if h < least:
            h = least
            shift, there = h * unit(column, like), _away(w, 2.0 * least + 0.0 * w)
            _tried(law, there + shift, work, 0, like)
            _tried(law, there - shift, work, 1, like)
        for row in range(m):
            work.by[row, column] = (work.trial[0, row] - work.trial[1, row]) / (2.0 * h)


@inner
def _by_memory(law: Any, w: Any, scales: Scales, work: Work, like: Any) -> None:
    """Quotients by memory; where the two sides of one disagree there is a corner, and the flatter side counts."""
    d, each, first = dimension(like), parts(work.memory[0]), 3 * dimension(like)
    _tried(law, w, work, 2, like)
    for column in range(work.trial.shape[1] - d):
        k, here = column // each, work.at[first + column]
        h = FINE * scales.size[k]
        if law.turning == 0.0:
            h = NUDGE * abs(here) if scales.positive[k] else max(NUDGE * abs(here), LOST * scales.size[k])
        work.at[first + column] = here + h
        filled(work.memory, work.at, first, work.memory[0])
        _tried(law, w, work, 0, like)
        work.at[first + column] = here - h
        filled(work.memory, work.at, first, work.memory[0])
        _tried(law, w, work, 1, like)
        work.at[first + column] = here
        for row in range(work.trial.shape[1]):
            ahead = (work.trial[0, row] - work.trial[2, row]) / h
            behind = (work.trial[2, row] - work.trial[1, row]) / h
            corner = abs(ahead - behind) > 0.1 * (abs(ahead) + abs(behind))
            flatter = ahead if abs(ahead) < abs(behind) else behind
            work.by[row, d + column] = flatter if corner else 0.5 * (ahead + behind)
    filled(work.memory, work.at, first, work.memory[0])


@inner
def differentiate(problem: Problem, tau: float, scales: Scales, work: Work, like: Any) -> None:
    """The law's quotients at the start of the step, and the slope of the rates in time."""
    body = problem.body
    w = taken(work.at, 1, like)
    begin_step(problem.law, w, work, like)
    _by_slip(problem.law, w, swing_of(body) + abs(problem.belt_speed), work, like)
    _by_memory(problem.law, w, scales, work, like)
    now = instant_near(problem, tau)
    turn = reference_acceleration(body, now.sine, now.cosine) + 0.0 * like
    turn = turn - belt_acceleration(body, problem.belt_speed, now)
    jerk = -(body.frequency**2) * reference_velocity(body, now.sine, now.cosine)
    jerk = jerk - belt_jerk(body, problem.belt_speed, now)
    put(work.slope, 0, -turn)
    put(work.slope, 1, unbalanced_rate(body, now) + jerk + restoring_force(body, 0.0 * turn, turn))
