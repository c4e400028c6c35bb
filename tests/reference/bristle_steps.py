"""Bristle orbits by explicit steps of order eight, small enough for the bristle, and Newton's method on the period.

Written for the references alone. Brute force: no state is eliminated, no implicit stage, no closed form; steps end
where the slip reverses (along the line) or where elastic unloading begins or ends (elasto-plastic, in the plane),
so that every step sees a smooth right-hand side.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from scipy.integrate._ivp import dop853_coefficients as table

STAGES = 12
A = np.ascontiguousarray(table.A[:STAGES, :STAGES])
B, C = np.ascontiguousarray(table.B), np.ascontiguousarray(table.C[:STAGES])
E3, E5 = np.ascontiguousarray(table.E3), np.ascontiguousarray(table.E5)
TRANSIENT = 12


@njit
def alpha(n, size, curve):
    if n.elastic == 0.0:
        return 1.0
    top = curve / n.stiffness
    if size <= n.breaks_at:
        return 0.0
    if size >= top:
        return 1.0
    return 0.5 + 0.5 * math.sin(math.pi * (size - 0.5 * (top + n.breaks_at)) / (top - n.breaks_at))


@njit
def slope(n, t, y, mode, dy):
    """Rates of the state and of the integral of friction along x1; mode: sign of the slip, or whether z.w > 0."""
    drive = math.sin(n.frequency * t)
    if n.planar == 0.0:
        w, z = y[1] - n.belt_speed, y[2]
        speed = mode * w
        curve = n.mu_kinetic + (n.mu_static - n.mu_kinetic) * math.exp(-((w / n.stribeck_speed) ** 2))
        share = alpha(n, abs(z), curve) if z * mode > 0.0 or n.elastic == 0.0 else 0.0
        dy[2] = w - share * speed * z * n.stiffness / curve
        rub = n.stiffness * z + n.bristle_damping * dy[2] + n.viscosity * w
        dy[0] = y[1]
        dy[1] = n.load * drive - n.damping * y[1] - y[0] - n.normal_load * rub
        dy[3] = rub
        return
    w1, w2, z1, z2 = y[2] - n.belt_speed, y[3], y[4], y[5]
    speed = math.sqrt(w1 * w1 + w2 * w2)
    curve = n.mu_kinetic + (n.mu_static - n.mu_kinetic) * math.exp(-((speed / n.stribeck_speed) ** 2))
    share = alpha(n, math.sqrt(z1 * z1 + z2 * z2), curve) if mode > 0.0 else 0.0
    back = share * speed * n.stiffness / curve
    dy[0], dy[1] = y[2], y[3]
    dy[4], dy[5] = w1 - back * z1, w2 - back * z2
    rub1 = n.stiffness * z1 + n.bristle_damping * dy[4] + n.viscosity * w1
    rub2 = n.stiffness * z2 + n.bristle_damping * dy[5] + n.viscosity * w2
    dy[2] = n.load * drive - n.damping * y[2] - y[0] - n.normal_load * rub1
    across = n.transverse_damping * y[3] + n.transverse_stiffness * y[1] + n.normal_load * rub2
    dy[3] = n.transverse_load * drive - across
    dy[6] = rub1


@njit
def switch(n, y):
    """What changes sign where the right-hand side has a corner."""
    if n.planar == 0.0:
        return y[1] - n.belt_speed
    if n.elastic == 0.0:
        return 1.0
    return y[4] * (y[2] - n.belt_speed) + y[5] * y[3]


@njit
def step(n, t, y, h, mode, k, out, scale):
    """One step of DOP853 into ``out``; its error against the scale. k[0] and k[12] are its first and last slopes."""
    size = len(y)
    for i in range(1, STAGES):
        for c in range(size):
            total = 0.0
            for j in range(i):
                total += A[i, j] * k[j, c]
            out[c] = y[c] + h * total
        slope(n, t + C[i] * h, out, mode, k[i])
    for c in range(size):
        total = 0.0
        for j in range(STAGES):
            total += B[j] * k[j, c]
        out[c] = y[c] + h * total
    slope(n, t + h, out, mode, k[STAGES])
    fifth = third = 0.0
    for c in range(size):
        five = three = 0.0
        for j in range(STAGES + 1):
            five += E5[j] * k[j, c]
            three += E3[j] * k[j, c]
        fifth += (five / scale[c]) ** 2
        third += (three / scale[c]) ** 2
    if fifth == 0.0 and third == 0.0:
        return 0.0
    return abs(h) * fifth / math.sqrt((fifth + 0.01 * third) * size)


@njit
def first_mode(n, t, y, k):
    value = switch(n, y)
    if value == 0.0 and n.planar == 0.0:
        slope(n, t, y, 1.0, k[0])
        value = k[0, 1]
    return 1.0 if value > 0.0 else -1.0


@njit
def shortened(n, t, y, mode, k, out, scale, low, high):
    """The step that ends where the switch is zero, by bisection and secants; the sign is right at ``low``."""
    start = low
    step(n, t, y, low, mode, k, out, scale)
    below = mode * switch(n, out) if low > 0.0 else mode * switch(n, y)
    step(n, t, y, high, mode, k, out, scale)
    above = mode * switch(n, out)
    for i in range(200):
        middle = (
            low + (high - low) * below / (below - above) if i % 3 and below > above else 0.5 * (low + high)
        )
        if not low < middle < high:
            break
        step(n, t, y, middle, mode, k, out, scale)
        value = mode * switch(n, out)
        if value > 0.0:
            low, below = middle, value
        else:
            high, above = middle, value
    end = high if high > start else low
    step(n, t, y, end, mode, k, out, scale)
    return end


@njit
def one_period(n, state, scale, tolerance, track):
    """The state after a period and the integral of friction; steps into ``track`` (t, mode, state) while it has room.

    Returns the end and how many steps were tracked.
    """
    size = len(state)
    y, out = np.zeros(size + 1), np.zeros(size + 1)
    y[:size] = state
    k = np.zeros((STAGES + 1, size + 1))
    t, end = 0.0, 2.0 * math.pi / n.frequency
    mode = first_mode(n, t, y, k)
    h, kept = 1e-6 * end, 0
    while t < end:
        if kept < len(track):
            track[kept, 0], track[kept, 1] = t, mode
            track[kept, 2:] = y[:size]
            kept += 1
        slope(n, t, y, mode, k[0])
        last = h >= end - t
        h = min(h, end - t)
        error = step(n, t, y, h, mode, k, out, scale) / tolerance
        if not error <= 1.0:
            h *= max(0.2, 0.9 * error**-0.125) if error == error else 0.2
            continue
        grown = h * min(3.0, 0.9 * max(error, 1e-10) ** -0.125)
        turned = False
        if mode * switch(n, out) < 0.0 and mode * switch(n, y) >= 0.0:
            low = 0.0
            if switch(n, y) == 0.0:  # just turned: leave the zero behind
                low = 0.5 * h
                step(n, t, y, low, mode, k, out, scale)
                if not mode * switch(n, out) > 0.0:
                    h = low
                    continue
            h = shortened(n, t, y, mode, k, out, scale, low, h)
            turned, last = True, False
        elif n.planar == 0.0 and mode * k[0, 1] < 0.0 and mode * k[STAGES, 1] > 0.0 and switch(n, y) != 0.0:
            low, high = 0.0, h  # the slip has a minimum inside: does it reach zero?
            for _ in range(50):
                middle = 0.5 * (low + high)
                step(n, t, y, middle, mode, k, out, scale)
                if mode * k[STAGES, 1] < 0.0:
                    low = middle
                else:
                    high = middle
            step(n, t, y, high, mode, k, out, scale)
            if mode * switch(n, out) < 0.0:
                h = shortened(n, t, y, mode, k, out, scale, 0.0, high)
                turned, last = True, False
            else:
                step(n, t, y, h, mode, k, out, scale)
        t = end if last else t + h
        for c in range(size + 1):
            y[c] = out[c]
        if turned:
            mode = -mode
            if n.planar == 0.0:
                y[1] = n.belt_speed
        h = max(grown, 1e-12 * end) if not turned else min(grown, h + 1e-6 * end)
    return y, kept


def shoot(n, tolerance=1e-13):
    """The orbit's state at tau = 0, its mean friction coefficient, the gap left, and the steps of one period."""
    scale = n.scales()
    wide = np.append(scale, n.mu_kinetic * n.period)
    none = np.zeros((0, n.size + 2))
    state = _friction_free(n)
    for _ in range(TRANSIENT):
        state = one_period(n, state, wide, 1e-7, none)[0][:-1]
    for trial in range(25):
        if trial % 4 == 0:
            matrix = _monodromy(n, state, wide)
        end = one_period(n, state, wide, tolerance, none)[0][:-1]
        gap = np.abs((end - state) / scale).max()
        if gap < 3e-13:
            break
        state = state + np.linalg.solve(np.eye(n.size) - matrix, end - state)
    track = np.zeros((2_000_000, n.size + 2))
    end, kept = one_period(n, state, wide, tolerance, track)
    return state, -end[-1] / n.period, gap, track[:kept]


def confirm(n, state, tolerance=1e-13):
    """The mean friction coefficient of one period of steps from a state of the orbit, and the gap it leaves."""
    scale = n.scales()
    end, _ = one_period(
        n, state, np.append(scale, n.mu_kinetic * n.period), tolerance, np.zeros((0, n.size + 2))
    )
    return -end[-1] / n.period, np.abs((end[:-1] - state) / scale).max()


def _friction_free(n):
    state = np.zeros(n.size)
    turn = n.load / complex(1.0 - n.frequency**2, n.damping * n.frequency)
    half = n.size // 3
    state[0], state[half] = turn.imag, (1j * n.frequency * turn).imag
    if n.planar:
        across = complex(n.transverse_stiffness - n.frequency**2, n.transverse_damping * n.frequency)
        turn = n.transverse_load / across
        state[1], state[3] = turn.imag, (1j * n.frequency * turn).imag
    state[2 * half] = -n.mu_kinetic / n.stiffness
    return state


def _monodromy(n, state, wide):
    """By central differences."""
    none, matrix = np.zeros((0, n.size + 2)), np.zeros((n.size, n.size))
    for c in range(n.size):
        delta = 1e-5 * wide[c]
        ends = []
        for sign in (1.0, -1.0):
            moved = state.copy()
            moved[c] += sign * delta
            ends.append(one_period(n, moved, wide, 1e-11, none)[0][:-1])
        matrix[:, c] = (ends[0] - ends[1]) / (2.0 * delta)
    return matrix
