"""Motions along a curve in belt speed, each sought from its neighbour's."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from frictionlab.compile.decorators import inner, njit
from frictionlab.methods.relay_locus.locus import (
    MOST_INSTANTS,
    Instants,
    LocusSetting,
    jump,
    length_of,
    mean_of_friction,
    mode_before,
)
from frictionlab.methods.relay_locus.response import StepAnswer
from frictionlab.methods.relay_locus.search import (
    FINE,
    NO_ROOT,
    VANISHED,
    WRONG,
    Objection,
    checked,
    distinct,
    empty_motion,
    frictionless,
    guessed,
    rewritten,
    settle_instants,
    verdict_of,
    without_piece,
)
from frictionlab.numerics.linalg import solve_linear
from frictionlab.quantities import EPSILON

IMPULSE, ERROR, COUNT, DEGREE, VERDICT, GUESSES, COLUMNS = range(7)
STEPS, TIMES_FINER, FREE_STEPS = 64, 3, 256
"""Of the coarsest guess in steps; how often it is doubled; those in which reversals of the motion without friction
are sought, the first guess."""
REPAIRS = 12
LONGEST_REST = 6.0
"""Radians of the quickest free motion in a part of a rest."""
ENOUGH = 1e-13
"""Share of the limit that friction in a rest may be off for a polynomial of too low a degree."""


@njit
def follow_curve(
    response: StepAnswer, rules: Any, waves: Any, given: Any, curve: Any, out: Any, found: Any
) -> None:
    """Row i of ``out``: IMPULSE, the integral of friction over a period, to GUESSES for the belt speed i.

    rules: of ascending degree. given: limit of friction, scale of velocities, quickest free motion, error of the
    response. curve: belt speeds, and the places i in the order in which each is sought from the one before.
    found [i]: times and modes of the instants and friction at the nodes of every rest, one row an instant.
    """
    belt_speeds, order = curve
    times, modes, before, speed = np.empty(0), np.empty(0), np.empty(0), 0.0
    for k in range(order.size):
        i = order[k]
        setting = LocusSetting(response, rules[0], waves, given[0], belt_speeds[i])
        start = times
        if before.size == times.size and k > 1:
            step = belt_speeds[order[k - 1]] - speed
            start = foreseen(
                times, before, (belt_speeds[i] - belt_speeds[order[k - 1]]) / step, response.period
            )
        guesses, sought = 0, mended_motion(setting, rules, moved_to(setting, start, modes), given)
        if sought.verdict.kind != FINE:
            sought = mended_motion(setting, rules, frictionless(setting, FREE_STEPS), given)
        while sought.verdict.kind != FINE and guesses <= TIMES_FINER:
            sought = mended_motion(setting, rules, guessed(setting, STEPS * 2**guesses), given)
            guesses += 1
        motion = sought.motion
        out[i, VERDICT], out[i, GUESSES], out[i, COUNT] = sought.verdict.kind, guesses, motion.times.size
        if sought.verdict.kind == FINE:
            write_motion(sought, given, out[i], found[i])
            out[i, DEGREE] = sought.degree
            bare = distinct(setting, motion.times, motion.modes)
            same = bare.modes.size == modes.size
            for j in range(bare.modes.size):
                same = same and bare.modes[j] == modes[j]
            before = times if same else np.empty(0)
            speed = belt_speeds[order[k - 1]] if k > 0 else 0.0
            times, modes = bare.times, bare.modes


@inner
def foreseen(times: Any, before: Any, steps: float, period: float) -> Any:
    """The instants so many steps on, if they keep their order and go on as from the motion before to this one."""
    n = times.size
    ahead = np.empty(n)
    for j in range(n):
        ahead[j] = times[j] + steps * (times[j] - before[j])
    for j in range(n):
        after = ahead[j + 1] if j < n - 1 else ahead[0] + period
        if not 0.0 < steps < 3.0 or after - ahead[j] < 1e-6 * period:
            return times
    return ahead


class Sought(NamedTuple):
    """A motion, the place of the rule of its rests, what is wrong with it, and the derivatives by its instants of
    what is left at each."""

    setting: LocusSetting
    degree: int
    motion: Instants
    verdict: Objection
    derivatives: Any


@inner
def moved_to(setting: LocusSetting, times: Any, modes: Any) -> Instants:
    """Instants, with room for friction of the setting's degree."""
    motion = empty_motion(setting, times.size)
    for j in range(times.size):
        motion.times[j], motion.modes[j] = times[j], modes[j]
    return motion


@inner
def mended_motion(setting: LocusSetting, rules: Any, motion: Instants, given: Any) -> Sought:
    """The motion from a guess, after changes of its pieces that their own check asks for."""
    verdict, least, derivatives = verdict_of(NO_ROOT, 0), 0, np.empty((0, 0))
    for _ in range(REPAIRS):
        motion = with_joints(setting, distinct(setting, motion.times, motion.modes), LONGEST_REST / given[2])
        n = motion.times.size
        if n < 2 or n >= MOST_INSTANTS:
            return Sought(setting, 0, motion, verdict_of(NO_ROOT, 0), derivatives)
        degree = max(least, degree_for(setting, motion, rules, given[2]))
        setting = LocusSetting(
            setting.response, rules[degree], setting.waves, setting.limit, setting.belt_speed
        )
        motion = moved_to(setting, motion.times, motion.modes)
        derivatives, left = np.empty((n, n)), np.empty(n)
        verdict = settle_instants(setting, motion, derivatives, left)
        rough = verdict.kind == FINE and misfit_of_rests(setting, motion) > ENOUGH * setting.limit
        if rough and degree < len(rules) - 1:
            least = degree + 1
            continue
        if verdict.kind == FINE:
            verdict = checked(setting, motion, given[1])
        if verdict.kind == FINE:
            return Sought(setting, degree, motion, verdict, derivatives)
        if verdict.kind == VANISHED:
            motion = without_piece(setting, motion, verdict.piece)
        elif verdict.kind == WRONG:
            motion = rewritten(setting, motion, verdict)
        else:
            return Sought(setting, degree, motion, verdict, derivatives)
    return Sought(setting, 0, motion, verdict_of(NO_ROOT, 0), derivatives)


@inner
def with_joints(setting: LocusSetting, motion: Instants, longest: float) -> Instants:
    """The motion with its rests in parts no longer than this."""
    period, count = setting.response.period, 0
    for j in range(motion.times.size):
        rests = motion.modes[j] == 0.0
        count += max(1, math.ceil(length_of(motion, period, j) / longest)) if rests else 1
    out, k = empty_motion(setting, count), 0
    for j in range(motion.times.size):
        length = length_of(motion, period, j)
        parts = max(1, math.ceil(length / longest)) if motion.modes[j] == 0.0 else 1
        for part in range(parts):
            out.times[k], out.modes[k] = motion.times[j] + part * (length / parts), motion.modes[j]
            k += 1
    return out


@inner
def degree_for(setting: LocusSetting, motion: Instants, rules: Any, fastest: float) -> int:
    """The place of the rule that a sine of the quickest free motion asks for in the longest rest."""
    longest = 0.0
    for j in range(motion.times.size):
        if motion.modes[j] == 0.0:
            longest = max(longest, length_of(motion, setting.response.period, j))
    turn = 0.5 * longest * fastest
    enough = 8.0 + 5.0 * math.sqrt(turn) + 1.5 * turn
    for k in range(len(rules)):
        if rules[k].nodes.size - 1 >= enough:
            return k
    return len(rules) - 1


@inner
def misfit_of_rests(setting: LocusSetting, motion: Instants) -> float:
    """The largest of the last two coefficients of the polynomials of friction in rests, and of its jumps at
    joints."""
    rule, worst = setting.rule, 0.0
    for j in range(motion.times.size):
        if motion.modes[j] == 0.0:
            if mode_before(motion, j) == 0.0:
                worst = max(worst, abs(jump(motion, setting.limit, j)))
            for m in range(rule.nodes.size - 2, rule.nodes.size):
                part = 0.0
                for k in range(rule.nodes.size):
                    part = part + rule.to_polynomials[m, k] * motion.friction[j, k]
                worst = max(worst, abs(part))
    return worst


@inner
def write_motion(sought: Sought, given: Any, row: Any, found: Any) -> None:
    """The impulse of friction and its error; the motion itself."""
    setting, motion, rule = sought.setting, sought.motion, sought.setting.rule
    for j in range(motion.times.size):
        found[j, 0], found[j, 1] = motion.times[j], motion.modes[j]
        for k in range(rule.nodes.size):
            found[j, 2 + k] = motion.friction[j, k]
    row[IMPULSE] = mean_of_friction(setting, motion) * setting.response.period
    row[ERROR] = impulse_bound(sought, given)


@inner
def impulse_bound(sought: Sought, given: Any) -> float:
    """Of friction over a period: from that of the response and of rounding in what is left at every instant, carried
    to the instants and times twice the jumps there, and from the degree of friction in rests."""
    setting, motion = sought.setting, sought.motion
    n, jumps = motion.times.size, 0.0
    for j in range(n):
        jumps = jumps + abs(jump(motion, setting.limit, j))
    rough = misfit_of_rests(setting, motion)
    of_slip = (
        given[3] * jumps
        + 8.0 * EPSILON * (given[1] + abs(setting.belt_speed))
        + rough * setting.response.period
    )
    of_friction = 256.0 * EPSILON * setting.limit + rough
    error = (4.0 * rough + 256.0 * EPSILON * n * setting.limit) * setting.response.period
    for i in range(n):
        work, moved = sought.derivatives.copy(), np.zeros(n)
        moved[i] = of_friction if mode_before(motion, i) == 0.0 else of_slip
        solve_linear(work, moved)
        for j in range(n):
            error = error + 2.0 * abs(moved[j] * jump(motion, setting.limit, j))
    return error
