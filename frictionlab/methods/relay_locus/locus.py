"""Instants of stick and reversal of a linear body under Coulomb friction, by Newton's method.

Friction is +-limit while the body slips and a polynomial while it rests (rest_rule.py). With the jumps J_j of
friction at the instants t_j and V of theory/periodic_response.py the slip velocity is

    w(t) = free slip(t) - sum over j of J_j V(t - t_j) - integral over every rest of V(t - s) dF(s).

At an instant at which the body reverses or comes to rest w = 0; from a rest it parts where friction is at its limit;
in a rest w' = 0 at every node, a linear system for the values of friction, of the second kind as V' jumps by 1/mass.
The first part alone is Tsypkin's and Hamel's condition for relays. Newton's matrix follows from it: an instant moved
by d takes an impulse J d from the body there, and every rest answers so that its w' stays zero.

Sources: Tsypkin, Relay Control Systems (1984); Den Hartog (1931), who has friction with two reversals.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from frictionlab.compile.decorators import inner
from frictionlab.methods.relay_locus.response import (
    StepAnswer,
    bend_at,
    free_slip,
    rate_at,
    response_value,
    wrapped,
)
from frictionlab.methods.relay_locus.rest_rule import RestRule
from frictionlab.numerics.linalg import eliminate

MOST_INSTANTS = 96


class LocusSetting(NamedTuple):
    """The body, what moves it, friction and the belt's mean velocity."""

    response: StepAnswer
    rule: RestRule
    waves: Any
    limit: float
    belt_speed: float


class Instants(NamedTuple):
    """A motion of one period: at times[j] the mode of motion becomes modes[j], 1.0 and -1.0 of slip, 0.0 of rest.
    Long rests have joints, at which rest follows rest.

    friction [instants, N + 1]: its values at the nodes of the rest that begins at instant j; pushes [instants, g]:
    what it grows by at the places of the rule.
    """

    times: Any
    modes: Any
    friction: Any
    pushes: Any


@inner
def mode_before(motion: Instants, j: int) -> float:
    """The mode that ends at instant j."""
    return motion.modes[j - 1] if j > 0 else motion.modes[motion.modes.size - 1]


@inner
def length_of(motion: Instants, period: float, j: int) -> float:
    """Of the piece that begins at instant j."""
    n = motion.times.size
    return motion.times[j + 1] - motion.times[j] if j < n - 1 else motion.times[0] + period - motion.times[j]


@inner
def known_jump(motion: Instants, limit: float, j: int) -> float:
    """Of friction at instant j, the part of slip alone."""
    return limit * (motion.modes[j] - mode_before(motion, j))


@inner
def jump(motion: Instants, limit: float, j: int) -> float:
    """Of friction at instant j."""
    n, last = motion.times.size, motion.friction.shape[1] - 1
    total = known_jump(motion, limit, j)
    if motion.modes[j] == 0.0:
        total = total + motion.friction[j, 0]
    if mode_before(motion, j) == 0.0:
        total = total - motion.friction[j - 1 if j > 0 else n - 1, last]
    return total


@inner
def locus_slip(setting: LocusSetting, motion: Instants, t: float) -> float:
    """Slip velocity at a time t in no rest."""
    of, rule = setting.response, setting.rule
    w, _ = free_slip(setting.waves, t)
    w = w - setting.belt_speed
    for j in range(motion.times.size):
        since = t - motion.times[j]
        w = w - jump(motion, setting.limit, j) * response_value(of, since)
        if motion.modes[j] == 0.0:
            length = length_of(motion, of.period, j)
            for g in range(rule.places.size):
                w = w - motion.pushes[j, g] * response_value(of, since - length * rule.places[g])
    return w


@inner
def slip_rate_before(setting: LocusSetting, motion: Instants, i: int) -> float:
    """Rate of the slip velocity just before instant i, at which no rest ends, less what instant i itself adds."""
    of, rule, t = setting.response, setting.rule, motion.times[i]
    _, rate = free_slip(setting.waves, t)
    for j in range(motion.times.size):
        if j != i:
            rate = rate - jump(motion, setting.limit, j) * rate_at(of, wrapped(of, t - motion.times[j]))
        if motion.modes[j] == 0.0:
            length = length_of(motion, of.period, j)
            for g in range(rule.places.size):
                u = wrapped(of, t - motion.times[j] - length * rule.places[g])
                rate = rate - motion.pushes[j, g] * rate_at(of, u)
    return rate


@inner
def mean_of_friction(setting: LocusSetting, motion: Instants) -> float:
    """Over the period."""
    total, rule = 0.0, setting.rule
    for j in range(motion.times.size):
        mean = setting.limit * motion.modes[j]
        if motion.modes[j] == 0.0:
            for k in range(rule.nodes.size):
                mean = mean + rule.mean[k] * motion.friction[j, k]
        total = total + mean * length_of(motion, setting.response.period, j)
    return total / setting.response.period


@inner
def side_lag(of: StepAnswer, since: float, same: bool, before: bool) -> float:
    """A time after an instant in [0, period]; at the same instant 0 just after it and the period just before it."""
    if same:
        return of.period if before else 0.0
    return wrapped(of, since)


@inner
def rest_rows(setting: LocusSetting, motion: Instants, rests: Any, matrix: Any, right: Any) -> None:
    """The linear system of friction at the nodes of all rests, and on its right the motion without it [:, 0] and what
    an impulse J d does that instant j takes, per d [:, 1 + j]."""
    of, rule, n = setting.response, setting.rule, setting.rule.nodes.size
    for p in range(rests.size):
        a, length = motion.times[rests[p]], length_of(motion, of.period, rests[p])
        first, second = rests[p], (rests[p] + 1) % motion.times.size
        rows_of_own_rest(setting, length, matrix, p * n)
        for i in range(n):
            row, t = p * n + i, a + length * rule.nodes[i]
            for q in range(rests.size):
                if q != p:
                    begins = rests[q] == second and i == n - 1
                    ends = (rests[q] + 1) % motion.times.size == first and i == 0
                    row_of_rest(setting, motion, rests[q], (t, begins, ends), matrix[row], q * n)
            _, rate = free_slip(setting.waves, t)
            right[row, 0] = rate
            for j in range(motion.times.size):
                same = (j == first and i == 0) or (j == second and i == n - 1)
                u = side_lag(of, t - motion.times[j], same, j == second and i == n - 1)
                right[row, 0] = right[row, 0] - known_jump(motion, setting.limit, j) * rate_at(of, u)
                right[row, 1 + j] = bend_at(of, u)


@inner
def rows_of_own_rest(setting: LocusSetting, length: float, matrix: Any, first: int) -> None:
    """Weights in w' at the nodes of a rest of this length of its own friction there."""
    of, rule, n = setting.response, setting.rule, setting.rule.nodes.size
    forward, backward = np.empty(n), np.empty(n)
    for m in range(n):
        forward[m] = rate_at(of, length * rule.lags[m])
        backward[m] = rate_at(of, of.period - length * rule.leads[m])
    row = np.empty(n)
    for i in range(n):
        for k in range(n):
            row[k] = 0.0
        for m in range(n):
            lag, lead = forward[m], backward[m]
            for k in range(n):
                row[k] = row[k] + (lag * rule.of_before[i, m, k] + lead * rule.of_after[i, m, k])
        for k in range(n):
            matrix[first + i, first + k] = row[k]
        matrix[first + i, first] = matrix[first + i, first] + forward[i]
        left = rate_at(of, of.period - length * (1.0 - rule.nodes[i]))
        matrix[first + i, first + n - 1] = matrix[first + i, first + n - 1] - left


@inner
def row_of_rest(setting: LocusSetting, motion: Instants, j: int, where: Any, row: Any, first: int) -> None:
    """Weights in w' at a time t outside it of friction at the nodes of the rest that begins at instant j.

    where: t, whether this rest begins at t, whether it ends there.
    """
    of, rule, n = setting.response, setting.rule, setting.rule.nodes.size
    (t, begins, ends), length = where, length_of(motion, of.period, j)
    for k in range(n):
        row[first + k] = 0.0
    for g in range(rule.places.size):
        rate = rate_at(of, wrapped(of, t - motion.times[j] - length * rule.places[g]))
        for k in range(n):
            row[first + k] = row[first + k] + rate * rule.of_all[g, k]
    row[first] = row[first] + rate_at(of, side_lag(of, t - motion.times[j], begins, True))
    row[first + n - 1] = row[first + n - 1] - rate_at(
        of, side_lag(of, t - motion.times[j] - length, ends, False)
    )


@inner
def newton_system(setting: LocusSetting, motion: Instants, matrix: Any, residual: Any) -> None:
    """Friction in all rests, for these instants; what is left at every instant, and its derivatives by them."""
    of, rule, n, count = setting.response, setting.rule, setting.rule.nodes.size, motion.times.size
    resting = 0
    for j in range(count):
        resting += 1 if motion.modes[j] == 0.0 else 0
    rests, k = np.empty(resting, np.int64), 0
    for j in range(count):
        if motion.modes[j] == 0.0:
            rests[k] = j
            k += 1
    answer = np.zeros((resting * n, 1 + count))
    if resting > 0:
        rows = np.empty((resting * n, resting * n))
        rest_rows(setting, motion, rests, rows, answer)
        eliminate(rows, answer)
        for p in range(resting):
            for i in range(n):
                motion.friction[rests[p], i] = answer[p * n + i, 0]
            for g in range(rule.places.size):
                total = 0.0
                for i in range(n):
                    total = total + rule.of_all[g, i] * answer[p * n + i, 0]
                motion.pushes[rests[p], g] = total
    for i in range(count):
        from_rest = mode_before(motion, i) == 0.0
        t = motion.times[i]
        if from_rest and motion.modes[i] == 0.0:
            # A joint stays where it is.
            residual[i] = 0.0
            for j in range(count):
                matrix[i, j] = 1.0 if i == j else 0.0
        elif from_rest:
            k = 0
            for p in range(resting):
                if rests[p] == (i - 1 if i > 0 else count - 1):
                    k = p
            start = rests[k]
            residual[i] = motion.friction[start, n - 1] - setting.limit * motion.modes[i]
            for j in range(count):
                matrix[i, j] = jump(motion, setting.limit, j) * answer[k * n + n - 1, 1 + j]
            slope = 0.0
            for m in range(n):
                slope = slope + rule.end[m] * motion.friction[start, m]
            matrix[i, i] = matrix[i, i] + slope / length_of(motion, of.period, start)
        else:
            residual[i], rate = locus_slip(setting, motion, t), slip_rate_before(setting, motion, i)
            for j in range(count):
                step = jump(motion, setting.limit, j)
                matrix[i, j] = rate if i == j else step * rate_at(of, wrapped(of, t - motion.times[j]))
                if resting > 0:
                    matrix[i, j] = matrix[i, j] - step * velocity_of_rests(
                        setting, motion, rests, answer, (t, 1 + j)
                    )


@inner
def velocity_of_rests(setting: LocusSetting, motion: Instants, rests: Any, answer: Any, at: Any) -> float:
    """What friction of a column of the answer does to the slip velocity at a time, with its sign turned."""
    of, rule, n, total = setting.response, setting.rule, setting.rule.nodes.size, 0.0
    t, column = at
    for p in range(rests.size):
        since, length = t - motion.times[rests[p]], length_of(motion, of.period, rests[p])
        total = total + answer[p * n, column] * response_value(of, since)
        total = total - answer[p * n + n - 1, column] * response_value(of, since - length)
        for g in range(rule.places.size):
            weight = 0.0
            for k in range(n):
                weight = weight + rule.of_all[g, k] * answer[p * n + k, column]
            total = total + weight * response_value(of, since - length * rule.places[g])
    return total
