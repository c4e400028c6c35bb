"""Motions along a curve in belt speed, each sought from its neighbour's."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from frictionlab.tools import eliminate, inner, njit
from linear_bodies.locus import (
    MOST_INSTANTS,
    Instants,
    LocusSetting,
    jump,
    length_of,
    mean_of_friction,
    mode_before,
)
from linear_bodies.response import EPSILON, FreeWaves, StepAnswer, side_lag
from linear_bodies.rest_rule import RestRule, RestRules, rule_at
from linear_bodies.search import (
    FINE,
    NO_ROOT,
    VANISHED,
    WRONG,
    Objection,
    checked,
    distinct,
    empty_motion,
    frictionless,
    rewritten,
    settle_instants,
    verdict_of,
    without_piece,
)

IMPULSE, ERROR, COUNT, DEGREE, VERDICT, COLUMNS = range(6)
FREE_STEPS = 256
"""Steps in which reversals of the motion without friction are sought."""
REPAIRS, WAY = 12, 100
"""Repairs of a motion; steps of belt speed on the way to one."""
ENOUGH, ENOUGH_ON_THE_WAY = 1e-13, 1e-6
"""Share ``enough`` of the detail of a motion, and of those on the way to one."""


class CurveScales(NamedTuple):
    """Scale of velocities, the longest part of a rest, the error of the response, how large loads with corners are
    beside jumps of friction, and the largest and the least slip without friction."""

    scale: float
    longest: float
    error: float
    corners: float
    high: float
    low: float


class Detail(NamedTuple):
    """Detail of friction in rests: the place of the rule, the longest part of a rest, and the share of the limit that
    friction may be off for a polynomial of too low a degree."""

    degree: int
    longest: float
    enough: float


class FoundMotion(NamedTuple):
    """Motion that was found: its instants without joints, how they move with the belt speed, and that; what its
    rests ask for."""

    times: Any
    modes: Any
    slopes: Any
    speed: float
    detail: Detail


class Sought(NamedTuple):
    """Motion, the detail of its rests, what is wrong with it, what is left at its instants and by how much they
    move for a unit of it."""

    setting: LocusSetting
    detail: Detail
    motion: Instants
    verdict: Objection
    left: Any
    inverse: Any


@njit
def follow_curve(
    response: StepAnswer,
    rules: RestRules,
    forcing: FreeWaves,
    limit: float,
    given: CurveScales,
    curve: Any,
    out: Any,
    found: Any,
) -> None:
    """Row i of ``out``: IMPULSE, the integral of friction over a period, to VERDICT for the belt speed i.

    rules: of ascending degree. curve: belt speeds, and the places i in the order in which each is sought from the one
    before. found [i]: times and modes of the instants and friction at the nodes of every rest, one row an instant.
    """
    belt_speeds, order = curve
    known = before = nothing_known(given.high, given)
    for k in range(order.size):
        i = order[k]
        setting = LocusSetting(response, forcing, limit, belt_speeds[i])
        if known.speed * belt_speeds[i] < 0.0 or k == 0:
            known = before = nothing_known(given.high if belt_speeds[i] >= 0.0 else given.low, given)
        sought = mended_motion(setting, rules, foreseen(setting, known, before), known.detail, given)
        if sought.verdict.kind != FINE:
            guess = frictionless(setting, FREE_STEPS, False)
            sought = mended_motion(setting, rules, guess, known.detail, given)
        if sought.verdict.kind != FINE:
            sought = approached(setting, rules, known, given)
        out[i, VERDICT], out[i, COUNT] = sought.verdict.kind, sought.motion.times.size
        if sought.verdict.kind == FINE:
            write_motion(sought, rule_at(rules, sought.detail.degree), given, out[i], found[i])
            out[i, DEGREE] = sought.detail.degree
            before, known = known, known_from(sought, rules)


@inner
def nothing_known(speed: float, given: CurveScales) -> FoundMotion:
    """Return no motion, from a belt that no slip overtakes."""
    return FoundMotion(np.empty(0), np.empty(0), np.empty(0), speed, Detail(1, given.longest, ENOUGH))


@inner
def known_from(sought: Sought, rules: RestRules) -> FoundMotion:
    """Return what was found."""
    motion, n = sought.motion, sought.motion.times.size
    times, modes, slopes, count = np.empty(n), np.empty(n), np.empty(n), 0
    for j in range(n):
        if motion.modes[j] != mode_before(motion, j):
            times[count], modes[count], slopes[count] = motion.times[j], motion.modes[j], 0.0
            for i in range(n):
                # what is left there is slip, less by the belt speed, where slip ends
                if mode_before(motion, i) != 0.0:
                    slopes[count] = slopes[count] + sought.inverse[j, i]
            count += 1
    detail = Detail(degree_seen(sought, rules), sought.detail.longest, ENOUGH)
    return FoundMotion(times[:count], modes[:count], slopes[:count], sought.setting.belt_speed, detail)


@inner
def foreseen(setting: LocusSetting, known: FoundMotion, before: FoundMotion) -> Instants:
    """Return the instants at another belt speed if they keep their order, from one motion or two."""
    n, period, step = known.times.size, setting.response.period, setting.belt_speed - known.speed
    motion, alike = empty_motion(n, 0), before.times.size == n
    for j in range(n):
        motion.modes[j] = known.modes[j]
        alike = alike and before.modes[j] == known.modes[j]
    h = known.speed - before.speed
    alike = alike and abs(step) < 3.0 * abs(h)
    for j in range(n):
        motion.times[j] = known.times[j] + known.slopes[j] * step
        if alike:
            # The cubic through both with its slopes; instants may have gone round the period.
            apart = before.times[j] - known.times[j]
            apart = apart - period * math.floor(apart / period + 0.5)
            bend = apart + known.slopes[j] * h
            twist = (before.slopes[j] - known.slopes[j]) * h + 2.0 * bend
            s = step / h
            motion.times[j] = motion.times[j] + s * s * (bend + twist + s * twist)
    for j in range(n):
        if length_of(motion, period, j) < 1e-6 * period:
            for k in range(n):
                motion.times[k] = known.times[k]
            return motion
    return motion


@inner
def approached(setting: LocusSetting, rules: RestRules, known: FoundMotion, given: CurveScales) -> Sought:
    """Return the motion at the setting's belt speed by motions on the way from the known one.

    Steps are as long as they can be.
    """
    end = setting.belt_speed
    step, before = end - known.speed, known
    sought = Sought(
        setting, known.detail, empty_motion(0, 0), verdict_of(NO_ROOT, 0), np.empty(0), np.empty((0, 0))
    )
    for _ in range(WAY):
        last = abs(step) >= abs(end - known.speed)
        speed = end if last else known.speed + step
        now = LocusSetting(setting.response, setting.forcing, setting.limit, speed)
        guess = foreseen(now, known, before) if known.times.size else frictionless(now, FREE_STEPS, True)
        enough = ENOUGH if last else ENOUGH_ON_THE_WAY
        detail = Detail(known.detail.degree, known.detail.longest, enough)
        sought = mended_motion(now, rules, guess, detail, given)
        if sought.verdict.kind == FINE:
            if last:
                return sought
            before, known = known, known_from(sought, rules)
            step = 2.0 * step
        else:
            step = 0.5 * min(abs(step), abs(end - known.speed)) * math.copysign(1.0, step)
    # what was found last is the motion at a belt speed on the way
    return Sought(setting, sought.detail, sought.motion, verdict_of(NO_ROOT, 0), sought.left, sought.inverse)


@inner
def mended_motion(
    setting: LocusSetting, rules: RestRules, motion: Instants, detail: Detail, given: CurveScales
) -> Sought:
    """Return the motion from a guess, after changes of its pieces that their own check asks for."""
    last, period, left, inverse = (
        verdict_of(NO_ROOT, 0),
        setting.response.period,
        np.empty(0),
        np.empty((0, 0)),
    )
    for _ in range(REPAIRS):
        motion = with_joints(setting, distinct(motion.times, motion.modes), detail.longest)
        n = motion.times.size
        if n < 2 or n >= MOST_INSTANTS:
            break
        rule, guess = rule_at(rules, detail.degree), motion
        motion = Instants(motion.times.copy(), motion.modes, np.zeros((n, rule.nodes.size)))
        derivatives, left = np.empty((n, n)), np.empty(n)
        verdict = settle_instants(setting, rule, motion, derivatives, left)
        rough = misfit_of_rests(setting, rule, motion) if verdict.kind == FINE else 0.0
        if rough > detail.enough * setting.limit and detail.longest > 0.1 * given.longest:
            higher = detail.degree < rules.sizes.shape[0] - 1
            longest = detail.longest if higher else 0.5 * detail.longest
            detail = Detail(detail.degree + 1 if higher else detail.degree, longest, detail.enough)
            continue
        if verdict.kind == FINE:
            verdict = checked(setting, rule, motion, given.scale)
        if verdict.kind == FINE:
            inverse = np.zeros((n, n))
            for j in range(n):
                inverse[j, j] = 1.0
            eliminate(derivatives, inverse)
            return Sought(setting, detail, motion, verdict, left, inverse)
        if verdict.kind == VANISHED or verdict.kind == NO_ROOT:
            motion = without_piece(period, guess, verdict.piece)
        elif verdict.kind == WRONG and verdict != last:
            motion, last = rewritten(period, motion, verdict), verdict
        else:
            break
    return Sought(setting, detail, motion, verdict_of(NO_ROOT, 0), left, inverse)


@inner
def with_joints(setting: LocusSetting, motion: Instants, longest: float) -> Instants:
    """Return the motion with its rests in parts no longer than this, and without corners of the load inside."""
    of, corners, n = setting.response, setting.forcing.corners, motion.times.size
    times, modes, count = np.empty(MOST_INSTANTS), np.empty(MOST_INSTANTS), 0
    for j in range(n):
        length, done = length_of(motion, of.period, j), 0.0
        if motion.modes[j] != 0.0 and count < MOST_INSTANTS:
            times[count], modes[count] = motion.times[j], motion.modes[j]
            count, done = count + 1, length
        while done < length:
            stop = length
            for c in range(corners.shape[0]):
                at = side_lag(of, corners[c, 0] - motion.times[j], False)
                if done + 1e-9 * of.period < at < stop - 1e-9 * of.period:
                    stop = at
            parts = math.ceil((stop - done) / longest)
            for part in range(parts):
                if count < MOST_INSTANTS:
                    times[count] = motion.times[j] + done + part * ((stop - done) / parts)
                    modes[count] = motion.modes[j]
                    count += 1
            done = stop
    return Instants(times[:count], modes[:count], np.empty((0, 0)))


@inner
def friction_term(rule: RestRule, motion: Instants, j: int, m: int) -> float:
    """Return the coefficient m of the polynomial in the rest that begins at instant j."""
    total = 0.0
    for k in range(rule.nodes.size):
        total = total + rule.to_polynomials[m, k] * motion.friction[j, k]
    return total


@inner
def misfit_of_rests(setting: LocusSetting, rule: RestRule, motion: Instants) -> float:
    """Return the largest of the last two coefficients of the polynomials of friction in rests, and of its jumps at
    joints."""
    n, worst = rule.nodes.size, 0.0
    for j in range(motion.times.size):
        if motion.modes[j] == 0.0:
            if mode_before(motion, j) == 0.0:
                worst = max(worst, abs(jump(motion, setting.limit, j)))
            for m in range(n - 2, n):
                worst = max(worst, abs(friction_term(rule, motion, j, m)))
    return worst


@inner
def degree_seen(sought: Sought, rules: RestRules) -> int:
    """Return the place of the rule beyond which there is nothing but rounding in any rest."""
    motion, rule, last = sought.motion, rule_at(rules, sought.detail.degree), 0
    rounding = 0.3 * sought.detail.enough * sought.setting.limit
    for j in range(motion.times.size):
        if motion.modes[j] == 0.0:
            m = rule.nodes.size - 1
            while m > last and abs(friction_term(rule, motion, j, m)) < rounding:
                m -= 1
            last = max(last, m)
    for k in range(sought.detail.degree):
        if rules.sizes[k, 0] - 1 >= last + 2:
            return k
    return sought.detail.degree


@inner
def write_motion(sought: Sought, rule: RestRule, given: CurveScales, row: Any, found: Any) -> None:
    """Write the impulse of friction and its error, and the motion itself."""
    setting, motion = sought.setting, sought.motion
    for j in range(motion.times.size):
        found[j, 0], found[j, 1] = motion.times[j], motion.modes[j]
        for k in range(rule.nodes.size):
            found[j, 2 + k] = motion.friction[j, k]
    row[IMPULSE] = mean_of_friction(setting, rule, motion) * setting.response.period
    row[ERROR] = impulse_bound(sought, rule, given)


@inner
def impulse_bound(sought: Sought, rule: RestRule, given: CurveScales) -> float:
    """Return the error of the impulse of a period.

    It is that of the response, of rounding and of Newton's method in what is left at every instant, carried to the
    instants and times twice the jumps there, from the degree of friction in rests and from what was let pass.
    """
    setting, motion, period = sought.setting, sought.motion, sought.setting.response.period
    n, jumps = motion.times.size, given.corners
    for j in range(n):
        jumps = jumps + abs(jump(motion, setting.limit, j))
    rough = misfit_of_rests(setting, rule, motion) + 256.0 * EPSILON * setting.limit
    rounding = 8.0 * EPSILON * (given.scale + abs(setting.belt_speed))
    of_slip = given.error * jumps + rounding + rough * period
    of_friction = 4.0 * rough
    error = (4.0 * rough + 256.0 * EPSILON * n * setting.limit) * period + 4.0 * sought.verdict.passed
    for j in range(n):
        moved = 0.0
        for i in range(n):
            allowed = of_friction if mode_before(motion, i) == 0.0 else of_slip
            moved = moved + (allowed + abs(sought.left[i])) * abs(sought.inverse[j, i])
        error = error + 2.0 * moved * abs(jump(motion, setting.limit, j))
    return error
