"""From a guess of the instants of a motion to the motion, checked; where the guess has others, what to change."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from frictionlab.compile.decorators import inner
from frictionlab.methods.relay_locus.locus import (
    MOST_INSTANTS,
    Instants,
    LocusSetting,
    length_of,
    locus_slip,
    newton_system,
)
from frictionlab.methods.relay_locus.response import free_slip, response_value
from frictionlab.numerics.linalg import solve_linear

MOST_NEWTONS = 40
MOST_CHANGES, SPLITTINGS = 12, 1000
SLIP_SAMPLES, MOST_DIPS = 16, 6
"""Of a piece of slip, closer at its ends."""
FINE, NO_ROOT, VANISHED, WRONG = range(4)


class Objection(NamedTuple):
    """What is wrong, the instant where the piece begins in which it is, the shares of it from where to where, and the
    mode that it should have there."""

    kind: int
    piece: int = 0
    start: float = 0.0
    stop: float = 0.0
    mode: float = 0.0


@inner
def empty_motion(setting: LocusSetting, count: int) -> Instants:
    """So many instants, all still to be written."""
    rule = setting.rule
    friction, pushes = np.zeros((count, rule.nodes.size)), np.zeros((count, rule.places.size))
    return Instants(np.empty(count), np.empty(count), friction, pushes)


@inner
def settle_instants(setting: LocusSetting, motion: Instants, derivatives: Any, left: Any) -> Objection:
    """Move the instants by Newton's method until nothing is left at any of them."""
    n, period = motion.times.size, setting.response.period
    least = math.inf
    for _ in range(MOST_NEWTONS):
        newton_system(setting, motion, derivatives, left)
        work, move = derivatives.copy(), np.empty(n)
        for i in range(n):
            move[i] = -left[i]
        solve_linear(work, move)
        size = 0.0
        for i in range(n):
            size = max(size, abs(move[i])) if math.isfinite(move[i]) else math.inf
        if not size < math.inf:
            return verdict_of(NO_ROOT, 0)
        # The step after one so small is rounding, but friction in rests is still that of the instants before.
        if least < 1e-9 * period:
            return verdict_of(FINE, 0) if size < 1e-10 * period else verdict_of(NO_ROOT, 0)
        least = min(least, size)
        # No piece may vanish in a step: a share of its length is left.
        share, shortest = 1.0, 0
        for j in range(n):
            length = length_of(motion, period, j)
            shrinks = move[j] - move[j + 1 if j < n - 1 else 0]
            if shrinks * share > 0.8 * length:
                share, shortest = 0.8 * length / shrinks, j
        share = min(share, 0.25 * period / size)
        if length_of(motion, period, shortest) < 1e-7 * period and share < 1.0:
            return verdict_of(VANISHED, shortest)
        for j in range(n):
            motion.times[j] = motion.times[j] + share * move[j]
    return verdict_of(NO_ROOT, 0)


@inner
def checked(setting: LocusSetting, motion: Instants, scale: float) -> Objection:
    """Whether slip keeps its sign in every piece of slip, and friction its limit in every rest."""
    period, rule, limit = setting.response.period, setting.rule, setting.limit
    for j in range(motion.times.size):
        mode, length = motion.modes[j], length_of(motion, period, j)
        if mode == 0.0:
            friction = np.empty(rule.samples.size)
            for k in range(friction.size):
                friction[k] = 0.0
                for m in range(rule.nodes.size):
                    friction[k] = friction[k] + rule.of_samples[k, m] * motion.friction[j, m]
            for sign in (1.0, -1.0):
                start, stop = below(rule.samples, limit, -sign, friction, -1e-9 * limit)
                if start < stop:
                    return Objection(WRONG, j, start, stop, sign)
        else:
            samples = SLIP_SAMPLES + int(4.0 * length * setting.response.panels / period)
            shares, slips = np.empty(samples), np.empty(samples)
            for k in range(samples):  # closer at the ends, where slip is small
                shares[k] = 0.5 * (1.0 - math.cos(math.pi * (k + 0.5) / samples))
                slips[k] = locus_slip(setting, motion, motion.times[j] + shares[k] * length)
            start, stop = below(shares, 0.0, mode, slips, -1e-10 * scale)
            for k in range(1, samples - 1):
                if start == stop and mode * slips[k] <= min(mode * slips[k - 1], mode * slips[k + 1]):
                    start, stop = dip(setting, motion, j, (shares, slips, k), -1e-10 * scale)
            if start < stop:
                return Objection(WRONG, j, start, stop, 0.0)
    return verdict_of(FINE, 0)


@inner
def dip(setting: LocusSetting, motion: Instants, j: int, sampled: Any, least: float) -> tuple[float, float]:
    """From where to where slip has the wrong sign about a sample nearer to zero than its neighbours, by parabolas
    through it; two zeros where it does not."""
    (shares, slips, k), mode = sampled, motion.modes[j]
    length = length_of(motion, setting.response.period, j)
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
        value = mode * locus_slip(setting, motion, motion.times[j] + new * length)
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
def below(shares: Any, offset: float, sign: float, values: Any, least: float) -> tuple[float, float]:
    """From where to where offset + sign * values first lies below ``least``, at samples or between them, by the
    parabola through the lowest of three; two zeros where it does not."""
    n, first, last = shares.size, -1, -1
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
        if low < least and (last < 0 or last == k - 1):
            first, last = k if first < 0 else first, k
    if first < 0:
        return 0.0, 0.0
    start = 0.0 if first == 0 else shares[first - 1]
    return start, (1.0 if last == n - 1 else shares[last + 1])


@inner
def verdict_of(kind: int, piece: int) -> Objection:
    """One that asks for no other mode."""
    return Objection(kind, piece, 0.0, 1.0, 0.0)


@inner
def rewritten(setting: LocusSetting, motion: Instants, what: Objection) -> Instants:
    """The same with another mode in a share of a piece; where neighbours are alike they become one."""
    n, piece = motion.times.size, what.piece
    length = length_of(motion, setting.response.period, piece)
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
    return distinct(setting, times[:count], modes[:count])


@inner
def distinct(setting: LocusSetting, times: Any, modes: Any) -> Instants:
    """The motion of these instants without those at which the mode stays what it was."""
    n, count = times.size, 0
    for j in range(n):
        count += 1 if modes[j] != modes[j - 1 if j > 0 else n - 1] else 0
    out, k = empty_motion(setting, count), 0
    for j in range(n):
        if modes[j] != modes[j - 1 if j > 0 else n - 1]:
            out.times[k], out.modes[k] = times[j], modes[j]
            k += 1
    return out


@inner
def without_piece(setting: LocusSetting, motion: Instants, piece: int) -> Instants:
    """The same without what begins at this instant: its neighbours meet."""
    n, k = motion.times.size, 0
    times, modes = np.empty(n - 1), np.empty(n - 1)
    for j in range(n):
        if j != piece:
            times[k], modes[k] = motion.times[j], motion.modes[j]
            k += 1
    return distinct(setting, times, modes)


@inner
def frictionless(setting: LocusSetting, steps: int) -> Instants:
    """The reversals of slip without friction."""
    times, modes, count = np.empty(MOST_INSTANTS), np.empty(MOST_INSTANTS), 0
    h = setting.response.period / steps
    before, _ = free_slip(setting.waves, 0.0)
    for k in range(1, steps + 1):
        now, _ = free_slip(setting.waves, k * h)
        left, right = before - setting.belt_speed, now - setting.belt_speed
        if (left < 0.0) != (right < 0.0) and count < MOST_INSTANTS:
            times[count], modes[count] = h * (k - right / (right - left)), math.copysign(1.0, right)
            count += 1
        before = now
    return distinct(setting, times[:count], modes[:count])


@inner
def guessed(setting: LocusSetting, steps: int) -> Instants:
    """Instants of the motion in so many steps a period, friction constant in each and implicit (Moreau).

    In steps of slip friction is at its limit, in steps of rest the slip velocity is zero; a step of rest whose
    friction passes the limit slips, one whose slip has the wrong sign rests, until none changes. Where they never
    cease to, they begin anew from a splitting that converges."""
    of, limit = setting.response, setting.limit
    h = of.period / steps
    answer, free = np.empty(steps), np.empty(steps)
    modes, friction = np.empty(steps), np.empty(steps)
    for k in range(steps):
        answer[k] = response_value(of, (k + 1) * h if k < steps - 1 else 0.0) - response_value(of, k * h)
        slip, _ = free_slip(setting.waves, (k + 1) * h)
        free[k] = slip - setting.belt_speed
        modes[k] = math.copysign(1.0, free[k])
    if not exchanged(answer, free, modes, limit, friction):
        split(answer, free, modes, limit)
        exchanged(answer, free, modes, limit, friction)
    return read_off(setting, modes, friction, h)


@inner
def exchanged(answer: Any, free: Any, modes: Any, limit: float, friction: Any) -> bool:
    """Exchange modes until none changes, if that is soon."""
    for _ in range(MOST_CHANGES):
        rest_in_steps(answer, free, modes, limit, friction)
        changes = 0
        for k in range(modes.size):
            new = modes[k]
            if new == 0.0:
                new = math.copysign(1.0, friction[k]) if abs(friction[k]) > limit else 0.0
            elif new * slip_of_step(answer, free, friction, k) < 0.0:
                new = 0.0
            changes += 1 if new != modes[k] else 0
            modes[k] = new
        if changes == 0:
            return True
    return False


@inner
def split(answer: Any, free: Any, modes: Any, limit: float) -> None:
    """Modes of steps by the splitting of Douglas and Rachford, which converges wherever the body is passive.

    Slip is free - G friction, G monotone: friction is clipped to its limits, then led through (1 + weight G)^-1.
    """
    n = free.size
    weight = 1.0 / math.sqrt(answer[0] * largest_gain(answer))
    through = resolvent(answer, weight)
    z, ahead, moved = np.empty(n), np.empty(n), np.empty(n)
    for k in range(n):
        z[k] = limit * modes[k]
    for _ in range(SPLITTINGS):
        for k in range(n):
            ahead[k] = 2.0 * min(max(z[k], -limit), limit) - z[k] + weight * free[k]
        for k in range(n):
            total = 0.0
            for m in range(k + 1):
                total = total + through[k - m] * ahead[m]
            for m in range(k + 1, n):
                total = total + through[k - m + n] * ahead[m]
            moved[k] = total
        change = 0.0
        for k in range(n):
            step = moved[k] - min(max(z[k], -limit), limit)
            z[k] = z[k] + step
            change = max(change, abs(step))
        if change < 1e-6 * limit:
            break
    for k in range(n):
        modes[k] = 0.0 if abs(z[k]) < limit else math.copysign(1.0, z[k])


@inner
def largest_gain(answer: Any) -> float:
    """Of the circulant matrix with this first column, over all its harmonics."""
    n, largest = answer.size, 0.0
    for k in range(n // 2 + 1):
        real, imaginary = harmonic_of(answer, k)
        largest = max(largest, math.hypot(real, imaginary))
    return largest


@inner
def harmonic_of(column: Any, k: int) -> tuple[float, float]:
    """The sum of column[m] exp(-2 pi i k m/n)."""
    n, real, imaginary = column.size, 0.0, 0.0
    for m in range(n):
        angle = 2.0 * math.pi * ((k * m) % n) / n
        real, imaginary = real + column[m] * math.cos(angle), imaginary - column[m] * math.sin(angle)
    return real, imaginary


@inner
def resolvent(answer: Any, weight: float) -> Any:
    """The first column of (1 + weight G)^-1, G the circulant matrix with the first column ``answer``."""
    n = answer.size
    out = np.zeros(n)
    for k in range(n // 2 + 1):
        real, imaginary = harmonic_of(answer, k)
        real, imaginary = 1.0 + weight * real, weight * imaginary
        size, share = real * real + imaginary * imaginary, (1.0 if k == 0 or 2 * k == n else 2.0) / n
        for m in range(n):
            angle = 2.0 * math.pi * ((k * m) % n) / n
            out[m] = out[m] + share * (real * math.cos(angle) + imaginary * math.sin(angle)) / size
    return out


@inner
def slip_of_step(answer: Any, free: Any, friction: Any, k: int) -> float:
    """Slip velocity at the end of a step."""
    steps, total = free.size, free[k]
    for m in range(steps):
        total = total - answer[k - m if k >= m else k - m + steps] * friction[m]
    return total


@inner
def rest_in_steps(answer: Any, free: Any, modes: Any, limit: float, friction: Any) -> None:
    """Friction in every step: at its limit, or where modes are zero what holds the body."""
    steps, count = free.size, 0
    rests = np.empty(steps, np.int64)
    for k in range(steps):
        friction[k] = limit * modes[k]
        if modes[k] == 0.0:
            rests[count] = k
            count += 1
    if count == 0:
        return
    rows, right = np.empty((count, count)), np.empty(count)
    for i in range(count):
        right[i] = slip_of_step(answer, free, friction, rests[i])
        for j in range(count):
            lag = rests[i] - rests[j]
            rows[i, j] = answer[lag if lag >= 0 else lag + steps]
    solve_linear(rows, right)
    for i in range(count):
        friction[rests[i]] = right[i]


@inner
def read_off(setting: LocusSetting, modes: Any, friction: Any, h: float) -> Instants:
    """The instants at which the mode of steps changes; a rest of one step is a reversal, or nothing."""
    steps, limit = friction.size, setting.limit
    shares = np.ones(steps)
    for k in range(steps):
        before, after = modes[k - 1 if k > 0 else steps - 1], modes[k + 1 if k < steps - 1 else 0]
        if modes[k] == 0.0 and before != 0.0 and after != 0.0:
            modes[k] = after
            if before != after:
                shares[k] = min(1.0, 0.5 * abs(friction[k] - after * limit) / limit)
    times, found, count = np.empty(MOST_INSTANTS), np.empty(MOST_INSTANTS), 0
    for k in range(steps):
        before = modes[k - 1 if k > 0 else steps - 1]
        if modes[k] != before and count < MOST_INSTANTS:
            times[count], found[count] = (
                h * (k + (shares[k] if modes[k] != 0.0 and before != 0.0 else 0.5)),
                modes[k],
            )
            count += 1
    return distinct(setting, times[:count], found[:count])
