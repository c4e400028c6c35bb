"""Instants of stick and reversal of a linear body under Coulomb friction, by Newton's method.

Friction is +-limit while the body slips and a polynomial while it rests (rest_rule.py). With the jumps J_j of
friction at the instants t_j and V of theory/periodic_response.py the slip velocity is

    w(t) = free slip(t) - sum over j of J_j V(t - t_j) - integral over every rest of V(t - s) dF(s).

At an instant at which the body reverses or comes to rest w = 0; from a rest it parts where friction is at its limit;
in a rest w' = 0 at every node, a linear system for the values of friction, of the second kind as V' jumps by 1/mass.
The first part alone is Tsypkin's and Hamel's condition for relays. A rest that a jump of the load ends, ends there.
Newton's matrix follows: an instant moved by d takes an impulse J d from the body there, and every rest answers so
that its w' stays zero.

Sources: Tsypkin, Relay Control Systems (1984); Den Hartog (1931), who has friction with two reversals.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from frictionlab.tools import eliminate, embedded, fast, inner
from linear_bodies.response import (
    BEND,
    RATE,
    VALUE,
    FreeWaves,
    StepAnswer,
    free_slip,
    in_powers,
    place,
    side_lag,
    table_at,
    wrapped,
)
from linear_bodies.rest_rule import RestRule

MOST_INSTANTS = 96


class LocusSetting(NamedTuple):
    """Body, what moves it, the limit of friction and the belt's mean velocity."""

    response: StepAnswer
    forcing: FreeWaves
    limit: float
    belt_speed: float


class Instants(NamedTuple):
    """Motion of one period: at times[j] the mode of motion becomes modes[j], 1.0 and -1.0 of slip, 0.0 of rest.
    Long rests have joints, at which rest follows rest, and so have those in which the load has a corner.

    friction [instants, N + 1]: its values at the nodes of the rest that begins at instant j.
    """

    times: Any
    modes: Any
    friction: Any


@embedded
def mode_before(motion: Instants, j: int) -> float:
    """Return the mode that ends at instant j."""
    return motion.modes[j - 1] if j > 0 else motion.modes[motion.modes.size - 1]


@embedded
def length_of(motion: Instants, period: float, j: int) -> float:
    """Return the length of the piece that begins at instant j."""
    n = motion.times.size
    return motion.times[j + 1] - motion.times[j] if j < n - 1 else motion.times[0] + period - motion.times[j]


@embedded
def known_jump(motion: Instants, limit: float, j: int) -> float:
    """Return the jump of friction at instant j, the part of slip alone."""
    return limit * (motion.modes[j] - mode_before(motion, j))


@embedded
def jump(motion: Instants, limit: float, j: int) -> float:
    """Return the jump of friction at instant j."""
    n, last = motion.times.size, motion.friction.shape[1] - 1
    total = known_jump(motion, limit, j)
    if motion.modes[j] == 0.0:
        total = total + motion.friction[j, 0]
    if mode_before(motion, j) == 0.0:
        total = total - motion.friction[j - 1 if j > 0 else n - 1, last]
    return total


@inner
def steps_of_friction(setting: LocusSetting, rule: RestRule, motion: Instants) -> Any:
    """Return friction as steps [n, 2], when and how large: at instants, and in rests at the places of the rule."""
    period, g = setting.response.period, rule.places.size
    out, n = np.empty((motion.times.size * (1 + g), 2)), 0
    for j in range(motion.times.size):
        out[n, 0], out[n, 1] = motion.times[j], jump(motion, setting.limit, j)
        n += 1
        if motion.modes[j] == 0.0:
            length = length_of(motion, period, j)
            for place in range(g):
                total = 0.0
                for k in range(rule.nodes.size):
                    total = total + rule.of_all[place, k] * motion.friction[j, k]
                out[n, 0], out[n, 1] = motion.times[j] + length * rule.places[place], total
                n += 1
    return out[:n]


@inner
def slip_of_steps(setting: LocusSetting, steps: Any, t: float) -> float:
    """Return the slip velocity at a time t in no rest."""
    of = setting.response
    w, _ = free_slip(of, setting.forcing, t)
    w = w - setting.belt_speed
    for j in range(steps.shape[0]):
        w = w - steps[j, 1] * table_at(of, VALUE, wrapped(of, t - steps[j, 0]))
    return w


@inner
def mean_of_friction(setting: LocusSetting, rule: RestRule, motion: Instants) -> float:
    """Return the mean of friction over the period."""
    total = 0.0
    for j in range(motion.times.size):
        mean = setting.limit * motion.modes[j]
        if motion.modes[j] == 0.0:
            for k in range(rule.nodes.size):
                mean = mean + rule.mean[k] * motion.friction[j, k]
        total = total + mean * length_of(motion, setting.response.period, j)
    return total / setting.response.period


@inner
def rest_rows(
    setting: LocusSetting, rule: RestRule, motion: Instants, rests: Any, matrix: Any, right: Any
) -> None:
    """Write the linear system of friction at the nodes of all rests.

    On its right stand the motion without it [:, 0] and what an impulse J d at instant j does, per d [:, 1 + j].
    """
    of, n = setting.response, rule.nodes.size
    for p in range(rests.size):
        a, length = motion.times[rests[p]], length_of(motion, of.period, rests[p])
        rows_of_own_rest(of, rule, length, matrix, p * n)
        for i in range(n):
            row, t, last = p * n + i, a + length * rule.nodes[i], i == n - 1
            for q in range(rests.size):
                if q != p:
                    begun = motion.times[rests[q]], length_of(motion, of.period, rests[q])
                    row_of_rest(of, rule, begun, RATE, (t, last), matrix[row, q * n : (q + 1) * n])
            _, rate = free_slip(of, setting.forcing, t)
            right[row, 0] = rate
            for j in range(motion.times.size):
                u = side_lag(of, t - motion.times[j], last)
                right[row, 0] = right[row, 0] - known_jump(motion, setting.limit, j) * table_at(of, RATE, u)
                right[row, 1 + j] = table_at(of, BEND, u)


@inner
def rows_of_own_rest(of: StepAnswer, rule: RestRule, length: float, matrix: Any, first: int) -> None:
    """Write weights in w' at the nodes of a rest of this length of its own friction there."""
    n = rule.nodes.size
    square = np.zeros(n * n)
    for m in range(rule.lags.size):
        add_products(
            square,
            (table_at(of, RATE, length * rule.lags[m]), rule.of_before[m]),
            (table_at(of, RATE, of.period - length * rule.leads[m]), rule.of_after[m]),
        )
    for i in range(n):
        for k in range(n):
            matrix[first + i, first + k] = square[i * n + k]
        node = length * rule.nodes[i]
        matrix[first + i, first] = matrix[first + i, first] + table_at(of, RATE, node)
        left = table_at(of, RATE, of.period - (length - node))
        matrix[first + i, first + n - 1] = matrix[first + i, first + n - 1] - left


@fast
def add_products(total: Any, first: Any, second: Any) -> None:
    """Add two numbers times an array each to a third array."""
    (a, x), (b, y) = first, second
    for q in range(total.size):
        total[q] += a * x[q] + b * y[q]


@inner
def row_of_rest(of: StepAnswer, rule: RestRule, rest: Any, which: int, when: Any, row: Any) -> None:
    """Write weights in w or w', as the table is that of V or V', of friction at the nodes of a rest, at another time.

    rest: its beginning and its length. when: the time, and whether it is that before a jump there.
    """
    (begun, length), (t, before), last = rest, when, row.size - 1
    for k in range(row.size):
        row[k] = 0.0
    for g in range(rule.places.size):
        push = table_at(of, which, wrapped(of, t - begun - length * rule.places[g]))
        for k in range(row.size):
            row[k] = row[k] + push * rule.of_all[g, k]
    row[0] = row[0] + table_at(of, which, side_lag(of, t - begun, before))
    row[last] = row[last] - table_at(of, which, side_lag(of, t - begun - length, before))


@inner
def newton_system(setting: LocusSetting, rule: RestRule, motion: Instants, matrix: Any, residual: Any) -> int:
    """Write friction in all rests, for these instants; what is left at every instant, and its derivatives by them.

    Return how many rests there are.
    """
    of, n, count = setting.response, rule.nodes.size, motion.times.size
    resting = 0
    for j in range(count):
        resting += 1 if motion.modes[j] == 0.0 else 0
    rests, size = np.empty(resting, np.int64), resting * n
    k = 0
    for j in range(count):
        if motion.modes[j] == 0.0:
            rests[k] = j
            k += 1
    answer = np.zeros((size, 1 + count))
    if resting > 0:
        rows = np.empty((size, size))
        rest_rows(setting, rule, motion, rests, rows, answer)
        eliminate(rows, answer)
        for p in range(resting):
            for i in range(n):
                motion.friction[rests[p], i] = answer[p * n + i, 0]
    weights, slopes = np.empty(size), np.empty(size)
    for i in range(count):
        before = i - 1 if i > 0 else count - 1
        if motion.modes[before] == 0.0 and motion.modes[i] == 0.0:
            # It stays where it is.
            residual[i] = 0.0
            for j in range(count):
                matrix[i, j] = 1.0 if i == j else 0.0
        elif motion.modes[before] == 0.0:
            k, slope = 0, 0.0
            while rests[k] != before:
                k += 1
            residual[i] = motion.friction[before, n - 1] - setting.limit * motion.modes[i]
            for j in range(count):
                matrix[i, j] = jump(motion, setting.limit, j) * answer[k * n + n - 1, 1 + j]
            for m in range(n):
                slope = slope + rule.end[m] * motion.friction[before, m]
            matrix[i, i] = matrix[i, i] + slope / length_of(motion, of.period, before)
        else:
            for p in range(resting):
                rest, at = (
                    (motion.times[rests[p]], length_of(motion, of.period, rests[p])),
                    (motion.times[i], True),
                )
                row_of_rest(of, rule, rest, VALUE, at, weights[p * n : (p + 1) * n])
                row_of_rest(of, rule, rest, RATE, at, slopes[p * n : (p + 1) * n])
            newton_row(setting, motion, i, (answer, weights, slopes), matrix, residual)
    return resting


@embedded
def newton_row(
    setting: LocusSetting, motion: Instants, i: int, of_rests: Any, matrix: Any, residual: Any
) -> None:
    """Write the slip velocity at instant i, at which slip ends, and its derivatives.

    of_rests: friction in them [nodes, 0] and what moved instants do to it, and weights of friction at their nodes in
    the slip velocity there and in its rate just before."""
    of, count, t = setting.response, motion.times.size, motion.times[i]
    answer, weights, slopes = of_rests
    w, rate = free_slip(of, setting.forcing, t)
    w = w - setting.belt_speed
    for j in range(count):
        row, z = place(of, side_lag(of, t - motion.times[j], True))
        known = known_jump(motion, setting.limit, j)
        own = in_powers(of.tables, RATE, row, z)
        w = w - known * in_powers(of.tables, VALUE, row, z)
        matrix[i, j] = jump(motion, setting.limit, j) * own
        rate = rate - known * own if j != i else rate
    for k in range(weights.size):
        w = w - weights[k] * answer[k, 0]
        rate = rate - slopes[k] * answer[k, 0]
    if motion.modes[i] == 0.0:
        # The impulse that the body takes there is the jump's alone.
        rate = rate + motion.friction[i, 0] * table_at(of, RATE, of.period)
    matrix[i, i] = rate
    for j in range(count):
        total = 0.0
        for k in range(weights.size):
            total = total + weights[k] * answer[k, 1 + j]
        matrix[i, j] = matrix[i, j] - jump(motion, setting.limit, j) * total
    residual[i] = w
