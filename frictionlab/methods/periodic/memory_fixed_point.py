"""Closing an orbit of a law with memory: the fixed point of its period map, and how far from it the answer is.

Bristles never stick, and their maps are smooth: quasi-Newton steps close the orbit, Newton's by difference quotients
where those stall, and plain repetition where nothing else moves on. But no theorem turns a distance of states into a
bound on the mean: how far the mean moves with the state is measured on the way.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from frictionlab.compile.decorators import inner
from frictionlab.dynamics.motion import span
from frictionlab.methods.periodic.fixed_point import (
    FINER,
    MOST_MAPS,
    MUCH_WORK,
    ROUNDING,
    FixedPoint,
    Goal,
    broyden,
    line_search,
    mean_error,
)
from frictionlab.methods.periodic.monodromy import free_inverse, newton_inverse
from frictionlab.methods.periodic.period_map import coarsest_of, grain_of, period_map
from frictionlab.numerics.linalg import copy, multiply, norm, subtract
from frictionlab.orbit.recorder import track_of
from frictionlab.scene.body import Body

SURE = 0.05
"""Of the bound on the mean that a distance of states gives where no two orbits move apart: it is some hundred times
what the mean really moves, and a part of it stands in where two means agree by chance."""
LOOSE = 2.0
"""How much coarser than the tolerance the maps are that an orbit is found with; the two that end it are finer."""

PATIENCE = 3
"""How often quasi-Newton steps stall before the maps that an orbit is found with are made finer."""


@inner
def _moved_on(
    law: Any, body: Body, belt_speed: float, z: Any, residual: Any, inverse: Any, accuracy: float, like: Any
) -> Any:
    """From where quasi-Newton steps stall: a searched Newton step, or three periods of the motion; (image, maps)."""
    regular = newton_inverse(law, body, belt_speed, z, accuracy, inverse, like)
    maps = 2 * z.size
    if not regular:
        free_inverse(body, body.normal_load, inverse, like)
    tried = line_search(law, body, belt_speed, z, residual, inverse, accuracy, like)
    maps += tried + 1
    if not regular or tried == 8:
        for _ in range(3):
            period_map(law, body, belt_speed, z, residual, accuracy, track_of(0), like)
            for i in range(z.size):
                z[i] = z[i] + residual[i]
        maps += 3
    return period_map(law, body, belt_speed, z, residual, accuracy, track_of(0), like), maps


@inner
def fixed_point_with_memory(
    law: Any,
    body: Body,
    belt_speed: float,
    z: Any,
    inverse: Any,
    goal: Goal,
    expected: float,
    like: Any,
) -> FixedPoint:
    """Find the fixed point from the guess z with the guess of the inverse of (monodromy - identity).

    One criterion ends it: two maps much finer than those the orbit was found with, one from where it was found and
    one from where the first says it is, change the mean by less than the tolerance, with what is left open in them.
    """
    n, tolerance, period = z.size, goal.tolerance, span(body)
    residual, trial, fresh, step, work = np.empty(n), np.empty(n), np.empty(n), np.empty(n), np.empty(n)
    floor = 4e-15 * (1.0 + norm(z) + abs(belt_speed))
    finest = max(min(LOOSE * tolerance * body.normal_load, coarsest_of(law, body)), floor)
    accuracy = min(max(finest, 1e-3 * expected), max(finest, 1e-4 * body.normal_load))
    image = period_map(law, body, belt_speed, z, residual, accuracy, track_of(0), like)
    maps, checks, first, stalls, stuck = 1, 0, norm(residual), 0, 0
    while maps < MOST_MAPS:
        length = norm(residual)
        if image.steps < 0 or not length < 1e300 or maps * image.steps > MUCH_WORK:
            break
        multiply(inverse, residual, step)
        if accuracy <= finest and mean_error(body, residual, norm(step)) <= 3.0 * tolerance:
            if accuracy <= floor:  # two maps of one accuracy agree however wrong they are
                image = period_map(law, body, belt_speed, z, residual, FINER * floor, track_of(0), like)
                maps += 1
            accuracy = max(accuracy / FINER, floor)
            coarse = image
            fine = period_map(law, body, belt_speed, z, fresh, accuracy, track_of(0), like)
            subtract(fresh, residual, work)  # what the coarser map has wrong
            multiply(inverse, work, trial)
            multiply(inverse, fresh, step)
            subtract(z, step, z)
            image = period_map(law, body, belt_speed, z, residual, accuracy, track_of(0), like)
            maps, checks = maps + 2, checks + 1
            slope = abs(image.rubbed - fine.rubbed) / period / (norm(step) + 1e-300)
            doubt = max(
                abs(image.rubbed - coarse.rubbed) / period, SURE * mean_error(body, work, norm(trial))
            )
            multiply(inverse, residual, step)
            rest = slope * norm(step) + SURE * mean_error(body, residual, norm(step))
            error = 2.0 * rest + doubt + floor / body.normal_load + ROUNDING
            error += grain_of(law, body, accuracy, like)
            settled = norm(residual) <= 0.5 * norm(fresh) + 10.0 * accuracy
            if settled and (error <= tolerance or (finest <= floor and checks > 3)):
                return FixedPoint(image.rubbed, error, maps, 0.0, image.closest, first)
            finest = accuracy
            if not settled or checks > 3:
                image, took = _moved_on(law, body, belt_speed, z, residual, inverse, accuracy, like)
                maps += took
            if checks > 12:
                break
            continue
        finer = max(finest, min(accuracy, 1e-4 * length))
        subtract(z, step, trial)
        image = period_map(law, body, belt_speed, trial, fresh, finer, track_of(0), like)
        maps += 1
        falls, usable = norm(fresh) < 0.7 * length, norm(fresh) <= 1.5 * length
        if usable:
            for i in range(n):
                step[i] = -step[i]
                work[i] = fresh[i] - residual[i]
            copy(trial, z)
            copy(fresh, residual)
            if accuracy <= 0.05 * length:
                broyden(inverse, step, work.copy(), work)
        accuracy = finer
        stalls = 0 if falls else stalls + 1
        if stalls == 0 or (stalls == 1 and usable):
            continue
        image, took = _moved_on(law, body, belt_speed, z, residual, inverse, max(accuracy, finest), like)
        maps += took
        stalls, stuck = 1, stuck + 1
        if stuck % PATIENCE == 0:  # what is open is no more than what the steps of a map jump about by
            finest = max(finest / FINER, floor)
    return FixedPoint(image.rubbed, 1e300, -maps, 0.0, image.closest, first)
