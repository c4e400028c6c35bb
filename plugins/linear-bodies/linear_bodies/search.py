"""Search from a guess of the instants of a motion to the motion, checked; what to change in a guess with others."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from frictionlab.tools import inner, solve_linear
from linear_bodies.locus import (
    MOST_INSTANTS,
    Instants,
    LocusSetting,
    length_of,
    mode_before,
    newton_system,
    slip_of_steps,
    steps_of_friction,
)
from linear_bodies.response import RATE, free_slip, side_lag, table_at
from linear_bodies.rest_rule import RestRule

MOST_NEWTONS, MOST_CUTS = 16, 5
"""Steps; those one after another that the same piece cuts."""
EXTREME_HALVINGS = 50
SLIP_SAMPLES, MOST_DIPS = 16, 6
"""Samples of a piece of slip, closer at its ends."""
END_SAMPLES = 3
"""Samples more at each of its ends, each four times as close as the one before."""
FINE, NO_ROOT, VANISHED, WRONG = range(4)


class Objection(NamedTuple):
    """Objection: the instant where the piece begins in which it is, the shares of it from where to where, and the
    mode that it should have there; where nothing is, the impulse of what was let pass."""

    kind: int
    piece: int
    start: float
    stop: float
    mode: float
    passed: float


@inner
def empty_motion(count: int, nodes: int) -> Instants:
    """Return so many instants, all still to be written, and zero friction at so many nodes of rests."""
    return Instants(np.empty(count), np.empty(count), np.zeros((count, nodes)))


@inner
def settle_instants(
    setting: LocusSetting, rule: RestRule, motion: Instants, derivatives: Any, left: Any
) -> Objection:
    """Move the instants by Newton's method until as good as nothing is left at any of them; else tell the piece that
    shrank."""
    n, period = motion.times.size, setting.response.period
    before, cuts, least = math.inf, 0, 0
    for _ in range(MOST_NEWTONS):
        rests = newton_system(setting, rule, motion, derivatives, left)
        work, move = derivatives.copy(), np.empty(n)
        for i in range(n):
            move[i] = -left[i]
        solve_linear(work, move)
        size = 0.0
        for i in range(n):
            size = max(size, abs(move[i])) if math.isfinite(move[i]) else math.inf
        if not size < math.inf:
            return verdict_of(NO_ROOT, least)
        # Friction in rests is still that of the instants before the step; that of slip follows them.
        if (before < 1e-9 * period and size < 1e-10 * period) or size < 1e-14 * period:
            return verdict_of(FINE, 0)
        if before < 1e-9 * period:
            return verdict_of(NO_ROOT, least)
        # No piece may vanish in a step: a share of its length is left.
        share, cut = 1.0, least
        for j in range(n):
            length = length_of(motion, period, j)
            shrinks = move[j] - move[j + 1 if j < n - 1 else 0]
            if shrinks * share > 0.6 * length:
                share, cut = 0.6 * length / shrinks, j
        cuts = 0 if share == 1.0 else cuts + 1 if cut == least else 1
        least = cut
        if cuts > MOST_CUTS:
            return verdict_of(VANISHED, least)
        share = min(share, 0.25 * period / size)
        for j in range(n):
            motion.times[j] = motion.times[j] + share * move[j]
        # Steps shrink with their squares, over a hundredth of the period at most: so small is the next one.
        after = size * size * max(size / (before * before), 100.0 / period)
        if rests == 0 and share == 1.0 and after < 1e-15 * period:
            for i in range(n):
                left[i] = 0.0
            return verdict_of(FINE, 0)
        before = size
    return verdict_of(NO_ROOT, least)


@inner
def checked(setting: LocusSetting, rule: RestRule, motion: Instants, scale: float) -> Objection:
    """Check whether slip keeps its sign in every piece of slip, and friction its limit in every rest."""
    of, limit = setting.response, setting.limit
    period, steps = of.period, steps_of_friction(setting, rule, motion)
    mass, passed = 1.0 / (table_at(of, RATE, 0.0) - table_at(of, RATE, period)), 0.0
    for j in range(motion.times.size):
        mode, length = motion.modes[j], length_of(motion, period, j)
        if mode == 0.0:
            friction = np.empty(rule.samples.size)
            for k in range(friction.size):
                friction[k] = 0.0
                for m in range(rule.nodes.size):
                    friction[k] = friction[k] + rule.of_samples[k, m] * motion.friction[j, m]
            for sign in (1.0, -1.0):
                start, stop, beyond = below(rule.samples, limit, -sign, friction, -1e-9 * limit)
                passed = passed + beyond * length
                if start < stop:
                    return Objection(WRONG, j, start, stop, sign, 0.0)
        else:
            shares = samples_of_slip(setting, motion.times[j], length)
            slips = np.empty(shares.size)
            for k in range(shares.size):
                slips[k] = slip_of_steps(setting, steps, motion.times[j] + shares[k] * length)
            start, stop, beyond = below(shares, 0.0, mode, slips, -1e-10 * scale)
            passed = passed + beyond * mass
            for k in range(1, shares.size - 1):
                if start == stop and mode * slips[k] <= min(mode * slips[k - 1], mode * slips[k + 1]):
                    piece = motion.times[j], length, mode
                    start, stop = dip(setting, steps, piece, (shares, slips, k), -1e-10 * scale)
            if start < stop:
                return Objection(WRONG, j, start, stop, 0.0, 0.0)
    return Objection(FINE, 0, 0.0, 1.0, 0.0, passed)


@inner
def samples_of_slip(setting: LocusSetting, begun: float, length: float) -> Any:
    """Return shares of a piece of slip: closer at its ends, where slip is small, and at corners of the load."""
    of, corners = setting.response, setting.forcing.corners
    count = SLIP_SAMPLES + int(4.0 * length * of.panels / of.period)
    shares, n = np.empty(count + 2 * END_SAMPLES + corners.shape[0]), count
    for k in range(count):
        shares[k] = 0.5 * (1.0 - math.cos(math.pi * (k + 0.5) / count))
    nearest = shares[0]
    for _ in range(END_SAMPLES):  # a short rest that was taken for a reversal shows right behind it
        nearest = 0.25 * nearest
        shares[n], shares[n + 1] = nearest, 1.0 - nearest
        n += 2
    for c in range(corners.shape[0]):
        since = side_lag(of, corners[c, 0] - begun, False)
        if 0.0 < since < length:
            shares[n] = since / length
            n += 1
    return np.sort(shares[:n])


@inner
def dip(setting: LocusSetting, steps: Any, piece: Any, sampled: Any, least: float) -> tuple[float, float]:
    """Return from where to where slip has the wrong sign about a sample nearer to zero than its neighbours.

    Parabolas go through it; two zeros where it does not.

    piece: its beginning, its length and its mode. sampled: shares, slips, and which.
    """
    (shares, slips, k), (begun, length, mode) = sampled, piece
    x, y, bend = shares[k], mode * slips[k], 0.0
    left, right = shares[k - 1], shares[k + 1]
    at_left, at_right = mode * slips[k - 1], mode * slips[k + 1]
    for _ in range(MOST_DIPS):
        down, up = (y - at_left) / (x - left), (at_right - y) / (right - x)
        bend = (up - down) / (right - left)
        if not bend > 0.0:
            return 0.0, 0.0
        new = x - 0.5 * (down * (right - x) + up * (x - left)) / (right - left) / bend
        if not left < new < right or abs(new - x) < 1e-6 * (right - left):
            break
        value = mode * slip_of_steps(setting, steps, begun + new * length)
        if value < y:
            if new < x:
                right, at_right = x, y
            else:
                left, at_left = x, y
            x, y = new, value
        elif new < x:
            left, at_left = new, value
        else:
            right, at_right = new, value
    if y >= least:
        return 0.0, 0.0
    half = math.sqrt(-y / bend)
    return max(0.0, x - half), min(1.0, x + half)


@inner
def below(shares: Any, offset: float, sign: float, values: Any, least: float) -> tuple[float, float, float]:
    """From where to where offset + sign * values first lies below ``least``, at samples or between them, by the
    parabola through the lowest of three; two zeros where it does not. How far it is below zero anywhere."""
    n, first, last, deepest = shares.size, -1, -1, 0.0
    for k in range(n):
        now = offset + sign * values[k]
        low = now
        if 0 < k < n - 1:
            left, right = offset + sign * values[k - 1], offset + sign * values[k + 1]
            if now <= left and now <= right:
                before, after = shares[k] - shares[k - 1], shares[k + 1] - shares[k]
                down, up = (now - left) / before, (right - now) / after
                bend = (up - down) / (before + after)
                slope = (down * after + up * before) / (before + after)
                low = now - 0.25 * slope * slope / bend if bend > 0.0 else now
        deepest = max(deepest, -low)
        if low < least and (last < 0 or last == k - 1):
            first, last = k if first < 0 else first, k
    if first < 0:
        return 0.0, 0.0, deepest
    start = 0.0 if first == 0 else shares[first - 1]
    return start, (1.0 if last == n - 1 else shares[last + 1]), deepest


@inner
def verdict_of(kind: int, piece: int) -> Objection:
    """Return one that asks for no other mode."""
    return Objection(kind, piece, 0.0, 1.0, 0.0, 0.0)


@inner
def rewritten(period: float, motion: Instants, what: Objection) -> Instants:
    """Return the same with another mode in a share of a piece; where neighbours are alike they become one."""
    n, piece = motion.times.size, what.piece
    length = length_of(motion, period, piece)
    times, modes, count = np.empty(n + 2), np.empty(n + 2), 0
    for j in range(n):
        if j != piece or what.start > 0.0:
            times[count], modes[count] = motion.times[j], motion.modes[j]
            count += 1
        if j == piece:
            times[count], modes[count] = motion.times[j] + what.start * length, what.mode
            count += 1
            if what.stop < 1.0:
                times[count], modes[count] = motion.times[j] + what.stop * length, motion.modes[j]
                count += 1
    return distinct(times[:count], modes[:count])


@inner
def distinct(times: Any, modes: Any) -> Instants:
    """Return the motion of these instants without those at which the mode stays what it was."""
    n, count = times.size, 0
    for j in range(n):
        count += 1 if modes[j] != modes[j - 1 if j > 0 else n - 1] else 0
    out, k = empty_motion(count, 0), 0
    for j in range(n):
        if modes[j] != modes[j - 1 if j > 0 else n - 1]:
            out.times[k], out.modes[k] = times[j], modes[j]
            k += 1
    return out


@inner
def without_piece(period: float, motion: Instants, piece: int) -> Instants:
    """Return the same without what begins at this instant: neighbours meet, of a rest in parts the end stays."""
    n, k = motion.times.size, 0
    times, modes = np.empty(n - 1), np.empty(n - 1)
    part = motion.modes[piece] == 0.0 and mode_before(motion, piece) == 0.0
    for j in range(n):
        if j != piece:
            ends = part and j == (piece + 1 if piece < n - 1 else 0)
            times[k], modes[k] = motion.times[j], motion.modes[j]
            if ends:
                times[k] = motion.times[piece] + (period if j == 0 and piece > 0 else 0.0)
            k += 1
    return distinct(times, modes)


@inner
def frictionless(setting: LocusSetting, steps: int, rests: bool) -> Instants:
    """Return the reversals of slip without friction; or rests where it overtakes the belt."""
    times, modes, count = np.empty(MOST_INSTANTS), np.empty(MOST_INSTANTS), 0
    of, v, h = setting.response, setting.belt_speed, setting.response.period / steps
    left, left_rate = free_slip(of, setting.forcing, 0.0)
    for k in range(1, steps + 1):
        right, right_rate = free_slip(of, setting.forcing, k * h)
        start, stop, side = h * (k - 1), h * (k - 1), 0.0
        if (left < v) != (right < v):
            start = start + h * (v - left) / (right - left)
            side = math.copysign(1.0, right - v)
        elif math.copysign(1.0, v - left) * left_rate > 0.0 > math.copysign(1.0, v - left) * right_rate:
            # It turns back within the step, perhaps beyond the belt speed.
            near, far = start, start + h
            for _ in range(EXTREME_HALVINGS):
                middle = 0.5 * (near + far)
                _, rate = free_slip(of, setting.forcing, middle)
                if rate * left_rate > 0.0:
                    near = middle
                else:
                    far = middle
            top, _ = free_slip(of, setting.forcing, near)
            if (top < v) != (left < v):
                half = math.sqrt(2.0 * h * abs((top - v) / (right_rate - left_rate)))
                start, stop, side = near - half, near + half, math.copysign(1.0, top - v)
        if side != 0.0 and count < MOST_INSTANTS - 1:
            times[count], modes[count] = start, 0.0 if rests and side * v > 0.0 else side
            count += 1
            if stop > start:
                times[count], modes[count] = stop, -side
                count += 1
        left, left_rate = right, right_rate
    return distinct(times[:count], modes[:count])
