"""Fixed point of a period map, and a bound on the error of the mean friction of its orbit.

One search serves every law: quasi-Newton steps with maps a little more accurate than the next residual; where the
residual stops falling, a Newton step by difference quotients, then plain repetition of the map. Two estimators end
it. No two orbits of a monotone law without memory move apart in the norm of energy (Leine & van de Wouw, 2008), so a
distance of states bounds the mean. No theorem says so of laws with memory: there the mean's own change is measured.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from frictionlab.compile.decorators import inner
from frictionlab.methods.periodic.monodromy import PacedMap, inverse_of, monodromy_of, newton_inverse
from frictionlab.methods.periodic.period_map import size_of_deviation
from frictionlab.methods.periodic.setting import (
    Scales,
    Setting,
    SpanImage,
    guess_inverse,
    hidden_error_of_mean,
    kept_map,
    period_map,
    scales_of,
    spans_at_rest,
)
from frictionlab.motion.linalg import copy, multiply, norm, subtract
from frictionlab.motion.maps.case import MOST_KEPT, pace_of

MOST_MAPS = 600
MUCH_WORK = 500_000
"""Steps, some tenths of a second, after which an orbit that need not exist is no longer looked for."""
UTMOST_WORK = 10_000_000
"""Steps, half a minute of them, after which no orbit is looked for and no motion followed any longer."""
LITTLE_WORK = 100_000
"""Steps after which one that exists in the plane is left to the maps of implicit steps (near_rest.py)."""
FINER = 16.0
"""Ratio of accuracies of the last map; of order eight, its own error is then a small part of what it measures."""
ROUNDING = 2e-14
"""Rounding error of the sums of a period's friction, in the mean coefficient."""
SURE = 0.05
"""Share of the bound on the mean that a distance of states gives where no two orbits move apart: some hundred times
what the mean really moves, and a part of it stands in where two means agree by chance."""
LOOSE = 2.0
"""Accuracy of the maps of a law with memory, over the tolerance; the two that end the search are finer."""
PATIENCE = 3
"""Stalls of quasi-Newton steps before the maps of a law with memory are made finer."""
ALMOST_SINGULAR = 1e6
"""Size of an inverse of (monodromy - identity) that belongs to a line of orbits, not to one."""
MOST_CHECKS = 12
"""Disagreements of the last maps of a law with memory before the search gives up."""


class Goal(NamedTuple):
    """Purpose for which an orbit is closed: the tolerance on the mean, and whether no two motions ever move apart.

    check_attraction: whether the two cheap starts are followed to see that they converge to the orbit. constant:
    whether friction is the same at every speed of slip that never reverses, so that this is an orbit in closed form.
    work: steps that a search may take.
    """

    tolerance: float
    contracts: bool
    check_attraction: bool
    constant: bool
    work: int


class FixedPoint(NamedTuple):
    """A closed orbit's integral of friction [periods], error of the mean, and what it took; maps < 0: gave up."""

    friction_impulse: Any
    error: float
    maps: int
    stuck: float
    closest: float
    first: float  # residual of the guess


class Iterate(NamedTuple):
    """State, the inverse of (monodromy - identity), the residual, and room for vectors, all [n].

    monodromy: that of the orbit found, where the end of the search computes it.
    """

    z: Any
    inverse: Any
    monodromy: Any
    residual: Any
    trial: Any
    fresh: Any
    step: Any
    work: Any


class Progress(NamedTuple):
    """State of a search: its last map, the accuracy of that map and of the finest asked for, and what it took."""

    image: SpanImage
    accuracy: float
    finest: float
    maps: int
    stalls: int  # steps in a row without a fall of the residual
    checks: int  # ends tried
    newtons: int  # steps that were not quasi-Newton
    error: float  # of the mean once the search has ended, else -1; infinite where it cannot go on


@inner
def stated_error(changed: float, left_open: float, steps: float) -> float:
    """Return the error stated of a mean friction, whoever has found the orbit.

    changed: by how much a finer map moved the mean. left_open: what the orbit does not close by, carried to the mean
    by the distance of states, by the mean's own change or by its adjoint. steps: what steps and rounding of the last
    map may leave, however well two maps agree.

    Two maps show what the coarser has wrong less what the finer has, and the derivative that carries what is left
    open is as old as the search: both count twice.
    """
    return 2.0 * (changed + left_open) + steps + ROUNDING


@inner
def rounding_of(normal_load: float, z: Any, belt_speed: float) -> float:
    """Return what rounding makes of a state: no residual is asked to be below that.

    Rounding of slip moves the instants at which friction turns, and that matters in proportion to friction.
    """
    return 4e-15 * (size_of_deviation(normal_load, z) + min(1.0, normal_load) * abs(belt_speed))


@inner
def mean_error(scales: Scales, residual: Any, distance: float) -> float:
    """Bound on the error of the mean friction of an orbit that closes up to the residual.

    Integrate the equation of motion along x1 over the period for the orbit and for the true one: the friction
    impulses differ by the change of du + damping*dy, which the residual is, plus the integral of dx, which the
    distance of the states bounds because orbits of a monotone law never move apart.
    """
    ends = abs(residual[1]) + scales.damping * abs(residual[0])
    return (distance + ends / scales.period) / scales.normal_load


@inner
def mean_change(scales: Scales, one: SpanImage, other: SpanImage) -> float:
    """By how much the mean friction of two maps differs."""
    return abs(other.friction_impulse - one.friction_impulse) / scales.period


@inner
def mean_sensitivity(
    setting: Setting, search: Iterate, shift: Any, image: SpanImage, accuracy: float
) -> float:
    """By how much the mean changes where the state, whose map is the image, is shifted."""
    # At the accuracy of the image, so that the errors of the steps are much the same in both and cancel.
    trial, residual = np.empty(search.z.size), np.empty(search.z.size)
    subtract(search.z, shift, trial)
    moved = period_map(setting, trial, residual, accuracy)
    return mean_change(scales_of(setting), image, moved)


# --- steps of the search --------------------------------------------------------------------------------------------


@inner
def broyden(inverse: Any, step: Any, change: Any, work: Any) -> None:
    """Broyden's update of the inverse (1965, by the Sherman-Morrison formula)."""
    n = step.size
    # work: what the old inverse makes of the change of the residual. It should be the step; the update makes it so.
    multiply(inverse, change, work)
    scale = 0.0
    for i in range(n):
        scale += step[i] * work[i]
    # Nearly singular: the update would blow the inverse up, and the old one still serves.
    if abs(scale) < 1e-3 * norm(step) ** 2:
        return
    for column in range(n):
        row_sum = 0.0
        for i in range(n):
            row_sum += step[i] * inverse[i, column]
        change[column] = row_sum / scale
    for row in range(n):
        for column in range(n):
            inverse[row, column] = inverse[row, column] + (step[row] - work[row]) * change[column]


@inner
def line_search(setting: Setting, search: Iterate, accuracy: float) -> int:
    """Move the state along the Newton step, halved until the residual falls; the maps it took, 8 for no fall."""
    n, z = search.z.size, search.z
    step, trial, fresh = np.empty(n), np.empty(n), np.empty(n)
    multiply(search.inverse, search.residual, step)
    # A tenth of the fall that a linear map would promise is enough (Armijo): the onset of stick bends the map.
    length, part = norm(search.residual), 1.0
    for tried in range(1, 8):
        for i in range(n):
            trial[i] = z[i] - part * step[i]
        period_map(setting, trial, fresh, accuracy)
        if norm(fresh) < (1.0 - 0.1 * part) * length:
            copy(trial, z)
            return tried
        part *= 0.5
    return 8


@inner
def newton_step(setting: Setting, search: Iterate, accuracy: float, of_quotients: float) -> Any:
    """A Newton step with a line search, or where it fails three repetitions of the map: the image, and maps taken."""
    z, residual = search.z, search.residual
    # The derivative as it is here: where the motion sticks, Broyden's inverse is that of another pattern of events.
    regular = newton_inverse(setting, z, of_quotients, search.inverse)
    if not regular:
        guess_inverse(setting, setting.maps.per_drive.normal_load, search.inverse)
    tried = line_search(setting, search, accuracy)
    maps = 2 * z.size + tried + 1
    # The map never moves two orbits of monotone friction apart: it comes nearer, if slowly, where Newton fails.
    if not regular or tried == 8:
        for _ in range(3):
            period_map(setting, z, residual, accuracy)
            for i in range(z.size):
                z[i] = z[i] + residual[i]
        maps += 3
    return period_map(setting, z, residual, accuracy), maps


@inner
def quasi_newton_step(setting: Setting, search: Iterate, now: Progress) -> Progress:
    """One Broyden step, along ``search.step``; stalls counts those after which the residual has not fallen."""
    length = norm(search.residual)
    # A map need not be much more exact than what is left open.
    finer = max(now.finest, min(now.accuracy, 1e-4 * length))
    subtract(search.z, search.step, search.trial)
    image = period_map(setting, search.trial, search.fresh, finer)
    falls, usable = norm(search.fresh) < 0.7 * length, norm(search.fresh) <= 1.5 * length
    # A step that makes it somewhat worse is kept for what it says of the derivative; a worse one is not taken.
    if usable:
        for i in range(search.z.size):
            search.step[i] = -search.step[i]
            search.work[i] = search.fresh[i] - search.residual[i]
        copy(search.trial, search.z)
        copy(search.fresh, search.residual)
        if now.accuracy <= 0.05 * length:  # a coarser map's residual would spoil the inverse
            broyden(search.inverse, search.step, search.work.copy(), search.work)
    # Two stalls in a row, or a step that was not taken, call for a Newton step.
    stalls = 0 if falls else now.stalls + 1 if usable else max(now.stalls + 1, 2)
    return Progress(image, finer, now.finest, now.maps + 1, stalls, now.checks, now.newtons, -1.0)


@inner
def _recovered(setting: Setting, search: Iterate, now: Progress, length: float, floor: float) -> Progress:
    """Go on where quasi-Newton steps have stalled: by finer maps if their own error is left, else a Newton step."""
    remembers, finest, newtons = setting.maps.remembers, now.finest, now.newtons
    if not remembers and now.accuracy <= finest and length <= 30.0 * now.accuracy and finest > floor:
        finest = max(floor, finest / FINER)
        return Progress(now.image, now.accuracy, finest, now.maps, 1, now.checks, newtons, -1.0)
    image, took = newton_step(setting, search, now.accuracy, now.accuracy if remembers else finest)
    newtons += 1
    # with memory, after some of them, what is open is no more than what the steps of a map jump about by
    if remembers and newtons % PATIENCE == 0:
        finest = max(finest / FINER, floor)
    return Progress(image, now.accuracy, finest, now.maps + took, 1, now.checks, newtons, -1.0)


# --- the two estimators of the error --------------------------------------------------------------------------------


@inner
def _check_without_memory(
    setting: Setting, search: Iterate, goal: Goal, now: Progress, floor: float
) -> Progress:
    """End where a map much finer than those of the search leaves a residual whose bound is below the tolerance."""
    z, residual, work = search.z, search.residual, search.work
    # The last quasi-Newton step is still taken: it costs no map of its own.
    subtract(z, search.step, search.trial)
    copy(search.trial, z)
    accuracy = now.finest / FINER
    image = period_map(setting, z, residual, accuracy)
    maps, checks, doubt = now.maps + 1, now.checks + 1, 0.0
    # where the motion sticks, the map and its inverse jump with the events: both are taken anew
    if image.stuck > 0.0 or now.newtons > 0 or not goal.contracts:
        if not newton_inverse(setting, z, accuracy, search.inverse):
            return Progress(image, accuracy, now.finest, maps, 0, checks, now.newtons, np.inf)
        coarser = period_map(setting, z, search.fresh, FINER * accuracy)
        maps += 2 * z.size + 1
        subtract(search.fresh, residual, search.fresh)
        multiply(search.inverse, search.fresh, work)
        doubt = mean_error(scales_of(setting), search.fresh, norm(work)) + mean_change(
            scales_of(setting), coarser, image
        )
        if not goal.contracts:  # no theorem: measure how the mean moves with the state
            doubt += mean_sensitivity(setting, search, work, image, accuracy)
            multiply(search.inverse, residual, work)
            doubt += mean_sensitivity(setting, search, work, image, accuracy)
    multiply(search.inverse, residual, work)
    steps = (floor + 0.1 * accuracy) / setting.maps.per_drive.normal_load  # the finer map's own error, too
    error = stated_error(doubt, mean_error(scales_of(setting), residual, norm(work)), steps)
    ended = error <= goal.tolerance or (now.finest <= floor and checks > 3)
    newtons = now.newtons + 1 if checks > 2 else now.newtons
    return Progress(
        image, accuracy, max(floor, accuracy), maps, now.stalls, checks, newtons, error if ended else -1.0
    )


@inner
def _corrected(setting: Setting, search: Iterate, last: PacedMap, floor: float, before: float) -> Any:
    """A Newton step with the derivatives at the state, a finer map from there, its error and the maps taken.

    The inverse of the search is that of states passed long ago, and may say far too little of what is left open.
    last: the map from the state; before: the error before the step.
    """
    n, scales, residual = search.z.size, scales_of(setting), search.residual
    image, accuracy = last.image, last.accuracy
    gradient, inverse = np.empty(n, np.complex128), np.empty((n, n))
    took = monodromy_of(setting, search.z, last, search.monodromy, gradient)
    # On a line of orbits, as under a contact that stays elastic, no step leads to one of them.
    if not inverse_of(search.monodromy, inverse) or np.abs(inverse).max() > ALMOST_SINGULAR:
        return image, before, took
    for row in range(n):
        copy(inverse[row], search.inverse[row])
    multiply(search.inverse, residual, search.step)
    subtract(search.z, search.step, search.z)
    finer = max(accuracy / FINER, floor)
    better = period_map(setting, search.z, residual, finer)
    multiply(search.inverse, residual, search.step)
    left = 0.0j
    for i in range(n):
        left += gradient[i] * search.step[i]
    # Two maps of one accuracy agree however wrong they are.
    share = setting.maps.orders.share if finer < 0.5 * accuracy else 1.0
    # either of the two may be the one whose steps miss a corner of friction, after two that agreed
    changed = mean_change(scales, image, better) + 0.5 * share * before
    steps = (floor + 0.1 * finer) / scales.normal_load + hidden_error_of_mean(setting, finer)
    return better, stated_error(changed, abs(left), steps), took + 1


@inner
def _check_with_memory(
    setting: Setting, search: Iterate, goal: Goal, now: Progress, floor: float
) -> Progress:
    """End where two maps much finer than those of the search change the mean by less than the tolerance.

    One is taken from where the orbit was found, one from where the first says it is; what is left open in them is
    carried to the mean by how far the mean moved between the two.
    """
    z, residual, fresh, step = search.z, search.residual, search.fresh, search.step
    scales, coarse, accuracy, maps = scales_of(setting), now.image, now.accuracy, now.maps
    ratio = setting.maps.orders.finer
    if accuracy <= floor:  # two maps of one accuracy agree however wrong they are
        coarse = period_map(setting, z, residual, ratio * floor)
        maps += 1
    accuracy = max(accuracy / ratio, floor)
    fine = period_map(setting, z, fresh, accuracy)
    subtract(fresh, residual, search.work)  # what the coarser map has wrong
    multiply(search.inverse, search.work, search.trial)
    multiply(search.inverse, fresh, step)
    subtract(z, step, z)
    # its steps are kept: the derivatives at the orbit are taken over them
    pace = pace_of(MOST_KEPT)
    image = kept_map(setting, z, residual, accuracy, pace)
    maps, checks = maps + 2, now.checks + 1
    slope = mean_change(scales, fine, image) / (norm(step) + 1e-300)
    doubt = max(
        mean_change(scales, coarse, image), SURE * mean_error(scales, search.work, norm(search.trial))
    )
    multiply(search.inverse, residual, step)
    rest = slope * norm(step) + SURE * mean_error(scales, residual, norm(step))
    steps = floor / scales.normal_load + hidden_error_of_mean(setting, accuracy)
    # once, not twice: the maps compared are many times finer than the search's
    error = stated_error(0.5 * doubt, rest, steps)
    # The second map, from where the first says the orbit is, must be much nearer to closing, or within its own error.
    settles = norm(residual) <= 0.5 * norm(fresh) + 10.0 * accuracy
    if settles and (error <= goal.tolerance or (now.finest <= floor and checks > 3)):
        last = PacedMap(image, residual, pace, accuracy)
        image, error, took = _corrected(setting, search, last, floor, error)
        maps += took
        if error <= goal.tolerance or (now.finest <= floor and checks > 3):
            return Progress(image, accuracy, accuracy, maps, now.stalls, checks, now.newtons, error)
    # The state runs away from where the two maps say it is: the inverse is at fault, and is taken anew.
    if not settles or checks > 3:
        image, took = newton_step(setting, search, accuracy, accuracy)
        maps += took
    # Maps of stiff memory may jump about by more than the tolerance however fine they are.
    ended = np.inf if checks > MOST_CHECKS else -1.0
    return Progress(image, accuracy, accuracy, maps, now.stalls, checks, now.newtons, ended)


@inner
def first_accuracy_without_memory(asked: float) -> float:
    """Return the accuracy of maps for an error of the force of friction that is asked for."""
    return 0.5 * asked


@inner
def _first_accuracy(setting: Setting, tolerance: float) -> Any:
    """Accuracy of the maps that find an orbit, and how near [tolerances] it must be for its error to be asked."""
    asked = tolerance * setting.maps.per_drive.normal_load
    if setting.maps.remembers:
        return min(LOOSE * asked, setting.maps.coarsest), 3.0
    return first_accuracy_without_memory(asked), 10.0


# --- the search -----------------------------------------------------------------------------------------------------


@inner
def _carried_by_the_belt(setting: Setting, search: Iterate, now: Progress) -> Progress:
    """Return the mass rests on the belt all the time: go on by as many periods at once as it surely does."""
    many = spans_at_rest(setting, search.z)
    for i in range(search.z.size):
        search.z[i] = search.z[i] + many * search.residual[i]
    image = period_map(setting, search.z, search.residual, now.accuracy)
    return Progress(image, now.accuracy, now.finest, now.maps + 1, now.stalls, now.checks, now.newtons, -1.0)


@inner
def fixed_point(
    setting: Setting, z: Any, inverse: Any, matrix: Any, goal: Goal, expected: float
) -> FixedPoint:
    """Find the fixed point from the guess z with the guess of the inverse of (monodromy - identity).

    matrix: becomes the monodromy of an orbit of a law with memory.

    expected: the norm of the first residual; the maps are a little more accurate than the next one.
    """
    n, scales = z.size, scales_of(setting)
    search = Iterate(z, inverse, matrix, np.empty(n), np.empty(n), np.empty(n), np.empty(n), np.empty(n))
    floor = rounding_of(scales.normal_load, z, setting.belt_speed)
    finest, near = _first_accuracy(setting, goal.tolerance)
    finest = max(finest, floor)
    accuracy = min(max(finest, 1e-3 * expected), max(finest, 1e-4 * scales.normal_load))
    now = Progress(period_map(setting, z, search.residual, accuracy), accuracy, finest, 1, 0, 0, 0, -1.0)
    first = norm(search.residual)
    while now.maps < MOST_MAPS and now.error < 0.0:
        length = norm(search.residual)
        # The map failed, or the state has run away.
        if now.image.steps < 0 or not length < 1e300:
            break
        # what repels, or is not there, is not to be found: other starts, or other maps, will tell
        if now.maps * now.image.steps > goal.work:
            break
        # A period that is all stick says nothing of the orbit: its map is a shift by the way of the belt.
        if now.image.stuck >= scales.period * (1.0 - 1e-9):
            if setting.belt_speed == 0.0:  # at rest on a belt at rest
                error = floor / scales.normal_load + ROUNDING
                return FixedPoint(now.image.friction_impulse, error, now.maps, now.image.stuck, 0.0, first)
            now = _carried_by_the_belt(setting, search, now)
            continue
        # The error is asked for where maps are as fine as they get and the bound by the distance of states is near.
        multiply(inverse, search.residual, search.step)
        bound = mean_error(scales, search.residual, norm(search.step))
        if now.accuracy <= now.finest and bound <= near * goal.tolerance:
            if setting.maps.remembers:
                now = _check_with_memory(setting, search, goal, now, floor)
            else:
                now = _check_without_memory(setting, search, goal, now, floor)
            continue
        now = quasi_newton_step(setting, search, now)
        if now.stalls > 1:
            now = _recovered(setting, search, now, length, floor)
    ended = 0.0 <= now.error < 1e300
    error, maps = (now.error, now.maps) if ended else (1e300, -now.maps)
    return FixedPoint(now.image.friction_impulse, error, maps, now.image.stuck, now.image.closest, first)
