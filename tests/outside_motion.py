"""One period of any scene, from corner to corner and from event to event, by Runge-Kutta steps of order 8.

Written for tests alone; it shares no code with the package, and writes the laws down once more. Signals of time come
from ``outside_forcing``. The state is (x1, w1, x2, w2, z1, z2) with w the slip velocity; work and impulses are
integrated with it. Within a span of time no signal has a corner, and within a phase the right-hand side is smooth: a
phase ends where its margin ceases to be positive, which is found on the length of a step, to rounding.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numba
import numpy as np
from outside_forcing import BELT1, BELT2, LOAD1, LOAD2, NORMAL
from scipy.integrate import DOP853

COULOMB, STRIBECK, DAHL, LUGRE, ELASTO_PLASTIC = range(5)
EXPONENTIAL, HYPERBOLIC, HESS_SOOM, CUBIC = range(4)
X1, W1, X2, W2, Z1, Z2, IMPULSE1, IMPULSE2, INPUT, VISCOUS, FRICTION, CONTACT = range(12)
STATES, SIZE = 6, 12
A, B, E3, E5, C = (
    np.ascontiguousarray(table) for table in (DOP853.A, DOP853.B, DOP853.E3, DOP853.E5, DOP853.C)
)
STAGES = len(B)
MOST_STEPS_OF_A_PERIOD = 200_000


class Body(NamedTuple):
    """x_i'' + damping_i x_i' + stiffness_i x_i = load_i - normal load * friction_i; held still if not free.

    Along x1 spring and dashpot follow the strain x + curvature x^2; cubic and amplitude: k x^3 and c x^2 x' besides.
    """

    free: bool
    planar: bool
    damping1: float
    stiffness1: float
    damping2: float
    stiffness2: float
    quickest: float
    cubic: float = 0.0
    amplitude: float = 0.0
    curvature: float = 0.0


class Friction(NamedTuple):
    """Parameters of any law; what a law lacks is zero."""

    kind: int
    mu: float
    mu_static: float
    speed: float
    exponent: float
    viscosity: float
    stiffness: float
    damping: float
    breakaway_ratio: float
    curve: int
    constant_contact: bool
    normal_load: float


class Phase(NamedTuple):
    """side: sign of slip on the line, 1 in the plane, 0 at rest; whether elasto-plastic bristles break away."""

    side: int
    breaking: bool


class Signals(NamedTuple):
    """Of one span: start, pieces [5, 2], sines."""

    start: float
    pieces: np.ndarray
    which: np.ndarray
    sines: np.ndarray


@numba.njit(cache=True)
def signals_at(now, t):
    """Loads, belt velocity and normal load at t, in their order, and the belt's acceleration."""
    after, p = t - now.start, now.pieces
    load1, load2 = p[LOAD1, 0] + p[LOAD1, 1] * after, p[LOAD2, 0] + p[LOAD2, 1] * after
    belt1, belt2 = p[BELT1, 0] + p[BELT1, 1] * after, p[BELT2, 0] + p[BELT2, 1] * after
    normal, pull1, pull2 = p[NORMAL, 0] + p[NORMAL, 1] * after, p[BELT1, 1], p[BELT2, 1]
    for j in range(len(now.which)):
        rate, angle, size = now.sines[j, 0], now.sines[j, 0] * t + now.sines[j, 1], now.sines[j, 2]
        value, kind = size * math.sin(angle), now.which[j]
        if kind == LOAD1:
            load1 += value
        elif kind == LOAD2:
            load2 += value
        elif kind == BELT1:
            belt1, pull1 = belt1 + value, pull1 + size * rate * math.cos(angle)
        elif kind == BELT2:
            belt2, pull2 = belt2 + value, pull2 + size * rate * math.cos(angle)
        else:
            normal += value
    return (load1, load2, belt1, belt2, normal), pull1, pull2


@numba.njit(cache=True)
def sliding(law, speed):
    """Coefficient of a sliding law at this speed; of bristle laws the curve without viscosity."""
    drop = law.mu_static - law.mu
    u = speed / law.speed
    if law.kind == COULOMB or law.kind == DAHL:
        return law.mu
    if law.kind != STRIBECK or law.curve == EXPONENTIAL:
        fall = math.exp(-(u**law.exponent)) if u > 0.0 else 1.0
    elif law.curve == HYPERBOLIC:
        fall = 1.0 / (1.0 + u)
    elif law.curve == HESS_SOOM:
        fall = 1.0 / (1.0 + u * u)
    else:
        fall = 1.0 - 1.5 * u + 0.5 * u**3
    return law.mu + drop * fall + (law.viscosity * speed if law.kind == STRIBECK else 0.0)


@numba.njit(cache=True)
def bristle(law, phase, w1, w2, z1, z2, line):
    """Rate of the deflection and friction coefficient of a bristle law, in a phase."""
    speed = phase.side * w1 if line else math.hypot(w1, w2)
    if law.kind == DAHL and law.exponent != 1.0:
        left = 1.0 - phase.side * z1 * law.stiffness / law.mu
        return w1 * math.copysign(abs(left) ** law.exponent, left), 0.0, law.stiffness * z1, 0.0
    ends = sliding(law, abs(speed)) / law.stiffness
    share = 1.0
    if law.kind == ELASTO_PLASTIC:
        begins, size = law.breakaway_ratio * law.mu / law.stiffness, math.hypot(z1, z2)
        inside = min(max((size - begins) / (ends - begins), 0.0), 1.0)
        share = 0.5 - 0.5 * math.cos(math.pi * inside) if phase.breaking else 0.0
    dz1, dz2 = w1 - share * speed / ends * z1, w2 - share * speed / ends * z2
    c1 = law.stiffness * z1 + law.damping * dz1 + law.viscosity * w1
    c2 = law.stiffness * z2 + law.damping * dz2 + law.viscosity * w2
    return dz1, dz2, c1, c2


@numba.njit(cache=True)
def dashed(body, x, v):
    """Force of the dashpots along x1."""
    stretch = 1.0 + 2.0 * body.curvature * x
    return (body.damping1 * stretch * stretch + body.amplitude * x * x) * v


@numba.njit(cache=True)
def sprung(body, x):
    """Force of the springs along x1."""
    strain, stretch = x + body.curvature * x * x, 1.0 + 2.0 * body.curvature * x
    return body.stiffness1 * strain * stretch + body.cubic * x**3


@numba.njit(cache=True)
def needed(body, now, t, y):
    """What accelerates the mass beyond the belt if friction does not: its two components."""
    s, pull1, pull2 = signals_at(now, t)
    one = s[LOAD1] - dashed(body, y[X1], y[W1] + s[BELT1]) - sprung(body, y[X1]) - pull1
    two = s[LOAD2] - body.damping2 * (y[W2] + s[BELT2]) - body.stiffness2 * y[X2] - pull2
    return one, two, s[NORMAL]


@numba.njit(cache=True)
def rates(body, law, now, phase, t, y, out):
    """d/dt of the state and of the integrals, into ``out``; returns the friction coefficient along x1."""
    s, pull1, pull2 = signals_at(now, t)
    w1, w2, line = y[W1], y[W2], not body.planar
    if not body.free:
        w1, w2 = -s[BELT1], -s[BELT2]
    n = s[NORMAL]
    net1 = s[LOAD1] - dashed(body, y[X1], w1 + s[BELT1]) - sprung(body, y[X1]) - pull1
    net2 = s[LOAD2] - body.damping2 * (w2 + s[BELT2]) - body.stiffness2 * y[X2] - pull2
    dz1, dz2 = 0.0, 0.0
    if law.kind >= DAHL:
        part = n / law.normal_load if law.constant_contact else 1.0
        dz1, dz2, c1, c2 = bristle(law, phase, w1, w2, y[Z1] / part, y[Z2] / part, line)
        # a contact whose stiffness does not follow the load: the law is that of the deflection over the load
        c1, c2 = c1 + law.damping * (dz1 / part - dz1), c2 + law.damping * (dz2 / part - dz2)
    elif phase.side == 0:
        c1, c2 = net1 / n, net2 / n
    elif line:
        c1, c2 = phase.side * sliding(law, abs(w1)), 0.0
    else:
        speed = math.hypot(w1, w2)
        share = sliding(law, speed) / speed if speed > 0.0 else 0.0
        c1, c2 = share * w1, share * w2
    v1, v2 = (w1 + s[BELT1], w2 + s[BELT2]) if body.free else (0.0, 0.0)
    resting = law.kind < DAHL and phase.side == 0
    out[X1], out[X2] = v1, v2
    out[W1], out[W2] = (0.0, 0.0) if resting or not body.free else (net1 - n * c1, net2 - n * c2)
    out[Z1], out[Z2] = dz1, dz2
    out[IMPULSE1], out[IMPULSE2] = n * c1, n * c2
    out[INPUT] = s[LOAD1] * v1 + s[LOAD2] * v2
    out[VISCOUS] = dashed(body, y[X1], v1) * v1 + body.damping2 * v2 * v2
    out[FRICTION] = n * (c1 * v1 + c2 * v2)
    out[CONTACT] = n * (c1 * w1 + c2 * w2)
    return c1


@numba.njit(cache=True)
def step(body, law, now, phase, t, h, y, size, stages):
    """One step of order 8: the new state and its error, in units of ``size``."""
    point = np.empty(SIZE)
    for i in range(STAGES):
        for k in range(SIZE):
            total = 0.0
            for j in range(i):
                total += A[i, j] * stages[j, k]
            point[k] = y[k] + h * total
        rates(body, law, now, phase, t + C[i] * h, point, stages[i])
    fine, coarse = 0.0, 0.0
    for k in range(SIZE):
        total, third, fifth = 0.0, 0.0, 0.0
        for i in range(STAGES):
            total += B[i] * stages[i, k]
            third += E3[i] * stages[i, k]
            fifth += E5[i] * stages[i, k]
        point[k] = y[k] + h * total
        if k < INPUT:
            fine += (h * fifth / size[k]) ** 2
            coarse += (h * third / size[k]) ** 2
    if fine == 0.0 or not math.isfinite(coarse):
        return point, coarse
    return point, fine / math.sqrt(8.0 * (fine + 0.01 * coarse))


@numba.njit(cache=True)
def margin(body, law, now, phase, t, y):
    """Positive as long as the phase lasts."""
    if law.kind < DAHL and phase.side == 0:
        one, two, n = needed(body, now, t, y)
        return law.mu_static * n - math.hypot(one, two)
    s, _, _ = signals_at(now, t)
    w1, w2 = (y[W1], y[W2]) if body.free else (-s[BELT1], -s[BELT2])
    line = not body.planar
    if law.kind < ELASTO_PLASTIC:
        return phase.side * w1 if line else 1.0
    share = s[NORMAL] / law.normal_load if law.constant_contact else 1.0
    begins = law.breakaway_ratio * law.mu / law.stiffness
    loading = phase.side * w1 if line else (w1 * y[Z1] + w2 * y[Z2]) / (share * begins)
    stretch = phase.side * y[Z1] / share if line else math.hypot(y[Z1], y[Z2]) / share
    if phase.breaking:
        return min(loading, stretch - begins)
    return min(loading, begins - stretch) if line else max(-loading, begins - stretch)


@numba.njit(cache=True)
def phase_at(body, law, now, t, y, side):
    """The phase at t; ``side`` is that of slip on the line where w1 does not say."""
    s, pull1, _ = signals_at(now, t)
    w1, w2 = (y[W1], y[W2]) if body.free else (-s[BELT1], -s[BELT2])
    line = not body.planar
    if law.kind < DAHL:
        if not body.free and w1 == 0.0:
            w1 = -pull1
        elif w1 == 0.0 and w2 == 0.0:
            one, two, n = needed(body, now, t, y)
            if math.hypot(one, two) <= law.mu_static * n:
                return Phase(0, False)
            w1 = one
        return Phase((1 if w1 > 0.0 else -1) if line else 1, False)
    if line and abs(w1) > 0.0:
        side = 1 if w1 > 0.0 else -1
    if law.kind < ELASTO_PLASTIC:
        return Phase(side if line else 1, False)
    share = s[NORMAL] / law.normal_load if law.constant_contact else 1.0
    begins = law.breakaway_ratio * law.mu / law.stiffness
    loaded = side * y[Z1] > 0.0 if line else w1 * y[Z1] + w2 * y[Z2] > 0.0
    return Phase(side if line else 1, loaded and math.hypot(y[Z1], y[Z2]) >= begins * share)


@numba.njit(cache=True)
def decay(body, law, now, t, y):
    """The rate at which bristles near their limit approach it."""
    s, _, _ = signals_at(now, t)
    speed = math.hypot(y[W1], y[W2]) if body.free else math.hypot(s[BELT1], s[BELT2])
    return law.stiffness * speed / sliding(law, speed)


@numba.njit(cache=True)
def trend(body, law, now, phase, t, y, nudge):
    """The change of the margin over a moment."""
    out = np.empty(SIZE)
    rates(body, law, now, phase, t, y, out)
    return margin(body, law, now, phase, t + nudge, y + nudge * out) - margin(body, law, now, phase, t, y)


@numba.njit(cache=True)
def dips(body, law, now, phase, t, h, y, there, size, stages):
    """Where within a step a margin that is positive at both ends is negative: its lowest point; 0 for nowhere."""
    nudge = 1e-6 * h
    if (
        trend(body, law, now, phase, t, y, nudge) >= 0.0
        or trend(body, law, now, phase, t + h, there, nudge) <= 0.0
    ):
        return 0.0
    low, high = 0.0, h
    for _ in range(45):
        middle = 0.5 * (low + high)
        there, _ = step(body, law, now, phase, t, middle, y, size, stages)
        if trend(body, law, now, phase, t + middle, there, nudge) < 0.0:
            low = middle
        else:
            high = middle
    there, _ = step(body, law, now, phase, t, high, y, size, stages)
    return high if margin(body, law, now, phase, t + high, there) < 0.0 else 0.0


@numba.njit(cache=True)
def end_of_phase(body, law, now, phase, t, h, y, size, stages):
    """The length of step after which the margin is negative by rounding alone; after h it is negative."""
    low, high = 0.0, h
    f_low = margin(body, law, now, phase, t, y)
    there, _ = step(body, law, now, phase, t, h, y, size, stages)
    f_high = margin(body, law, now, phase, t + h, there)
    tries = 0
    while f_low <= 0.0 and tries < 60:  # a phase that has just begun: its margin must first become positive
        tries += 1
        low = h * 0.5**tries
        there, _ = step(body, law, now, phase, t, low, y, size, stages)
        f_low = margin(body, law, now, phase, t + low, there)
        if f_low < 0.0:
            high, f_high = low, f_low
    if f_low <= 0.0:
        return high
    last = 0
    for tries in range(200):
        if high - low <= 4e-16 * (abs(t) + h):
            break
        middle = (low * f_high - high * f_low) / (f_high - f_low)
        if tries % 6 == 5 or not low < middle < high:
            middle = 0.5 * (low + high)
        there, _ = step(body, law, now, phase, t, middle, y, size, stages)
        f = margin(body, law, now, phase, t + middle, there)
        if f < 0.0:
            high, f_high, f_low = middle, f, 0.5 * f_low if last == -1 else f_low
            last = -1
        else:
            low, f_low, f_high = middle, f, 0.5 * f_high if last == 1 else f_high
            last = 1
    return high


@numba.njit(cache=True)
def beyond_rest(body, law, now, t, y, duration, gain, growth):
    """After a first moment of slip from y: what is left of the force over friction, and its direction."""
    there = y.copy()
    for axis in range(2):
        there[W1 + 2 * axis] = gain[axis]
        there[X1 + 2 * axis] += duration / growth * gain[axis]
    one, two, n = needed(body, now, t, there)
    force = math.hypot(one, two)
    return force - n * sliding(law, math.hypot(gain[0], gain[1])), np.array([one, two]) / force


@numba.njit(cache=True)
def set_off(body, law, now, t, left, y, size, stages, tolerance):
    """A first moment of slip in the plane from rest: the state after it, and its duration.

    The speed is the integral of the force over friction; slip follows the force, behind it by speed/friction times
    the rate at which it turns. A force that exceeds friction by a jump leaves that lag open: the moment is shorter.
    """
    gain = np.zeros((3, 2))
    excess, _ = beyond_rest(body, law, now, t, y, 0.0, gain[0], 3.0)
    _, _, n = needed(body, now, t, y)
    sudden = excess > 1e-9 * n * law.mu
    growth = 2.0 if sudden else 3.0
    h = min((0.3 * tolerance**0.5 if sudden else 0.5 * tolerance**0.25) / body.quickest, left)
    middle, _ = step(body, law, now, Phase(0, False), t, 0.5 * h, y, size, stages)
    end, _ = step(body, law, now, Phase(0, False), t, h, y, size, stages)
    for _ in range(5):
        f0, d0 = beyond_rest(body, law, now, t, y, 0.0, gain[0], growth)
        f1, d1 = beyond_rest(body, law, now, t + 0.5 * h, middle, 0.5 * h, gain[1], growth)
        f2, d2 = beyond_rest(body, law, now, t + h, end, h, gain[2], growth)
        speed1, speed2 = h / 24.0 * (5.0 * f0 + 8.0 * f1 - f2), h / 6.0 * (f0 + 4.0 * f1 + f2)
        turn = (3.0 * d2 - 4.0 * d1 + d0) / h
        gain[1] = max(speed1, 0.0) * (d1 - speed1 / (n * law.mu) * turn)
        gain[2] = max(speed2, 0.0) * (d2 - speed2 / (n * law.mu) * turn)
    for axis in range(2):
        end[W1 + 2 * axis] = gain[2, axis]
        end[X1 + 2 * axis] += h / growth * gain[2, axis]
        end[IMPULSE1 + axis] -= gain[2, axis]
    return end, h


@numba.njit(cache=True)
def span(body, law, now, end, y, side, tolerance, largest, longest, tally, signs):
    """From the start of a span to its end; returns the state and the side of slip. NaN where it takes too long.

    tally: time at rest, sign changes of w1 and of the friction force, steps; signs: of the two last seen.
    """
    t, h, stages = now.start, longest, np.empty((STAGES, SIZE))
    phase = phase_at(body, law, now, t, y, side)
    slides, in_plane = law.kind < DAHL, body.planar and law.kind < DAHL and body.free
    while t < end:
        tally[3] += 1.0
        if tally[3] > MOST_STEPS_OF_A_PERIOD:
            y[X1] = math.nan
            break
        size = tolerance * largest
        left = end - t
        if in_plane and phase.side == 1:
            one, two, n = needed(body, now, t, y)
            speed = math.hypot(y[W1], y[W2])
            if speed == 0.0:
                y, done = set_off(body, law, now, t, left, y, size, stages, tolerance)
                t = end if done >= left else t + done
                continue
            if speed < 1e-13 * largest[W1] and math.hypot(one, two) < law.mu_static * n:
                y[W1], y[W2], phase = 0.0, 0.0, Phase(0, False)
                continue
            slows = one * y[W1] + two * y[W2] < law.mu * n * speed
            h = min(h, (0.3 if slows else 2.0) * speed / (law.mu * n + math.hypot(one, two)))
        if law.kind >= DAHL:  # no step longer than bristles next to their limit bear
            h = min(h, 4.5 / (decay(body, law, now, t, y) + 1e-300))
        reach = min(h, left)
        there, error = step(body, law, now, phase, t, reach, y, size, stages)
        if law.kind >= DAHL and not reach * decay(body, law, now, t + reach, there) < 5.5:
            h = 0.7 * reach
            continue
        if not error <= 1.0:
            h = reach * (max(0.2, 0.9 * error**-0.125) if error < 1e300 else 0.1)
            continue
        grown = h if reach < h else reach * min(5.0, 0.9 * max(error, 1e-12) ** -0.125)
        ends = margin(body, law, now, phase, t + reach, there) < 0.0
        if not ends and margin(body, law, now, phase, t, y) > 0.0:
            dip = dips(body, law, now, phase, t, reach, y, there, size, stages)
            ends, reach = dip > 0.0, dip if dip > 0.0 else reach
        if ends:
            reach = end_of_phase(body, law, now, phase, t, reach, y, size, stages)
            there, _ = step(body, law, now, phase, t, reach, y, size, stages)
        if slides and phase.side == 0:
            tally[0] += reach
        t = end if reach == left else t + reach
        y, h = there, min(grown, longest)
        for k in range(STATES):
            largest[k] = max(largest[k], abs(y[k]))
        if ends and slides:
            y[W1], y[W2] = 0.0, 0.0
        count(body, law, now, phase, t, y, tally, signs)
        if ends:
            phase = phase_at(body, law, now, t, y, -phase.side)
    return y, phase.side


@numba.njit(cache=True)
def count(body, law, now, phase, t, y, tally, signs):
    """Changes of sign of the slip velocity and of the friction force along x1."""
    force = rates(body, law, now, phase, t, y, np.empty(SIZE))
    s, _, _ = signals_at(now, t)
    for k, value in enumerate((y[W1] if body.free else -s[BELT1], force)):
        if value != 0.0:
            sign = 1.0 if value > 0.0 else -1.0
            if sign == -signs[k]:
                tally[1 + k] += 1.0
            signs[k] = sign


@numba.njit(cache=True)
def period(body, law, edges, pieces, which, sines, start, side, tolerance, largest, longest, signs):
    """From tau = 0-, just before a corner that may be there, to a period later; tally as in ``span``."""
    y, tally = np.zeros(SIZE), np.zeros(4)
    y[:STATES] = start
    last = len(edges) - 2
    for k in range(last + 1):
        before = last if k == 0 else k - 1
        lasted = edges[before + 1] - edges[before]
        for axis, signal in ((W1, BELT1), (W2, BELT2)):
            was = pieces[before, signal, 0] + pieces[before, signal, 1] * lasted
            jump = pieces[k, signal, 0] - was
            if abs(jump) > 1e-12 * (abs(was) + abs(pieces[k, signal, 0])):
                y[axis] -= jump
        now = Signals(edges[k], pieces[k], which, sines)
        y, side = span(body, law, now, edges[k + 1], y, side, tolerance, largest, longest, tally, signs)
        if math.isnan(y[X1]):
            break
    return y, side, tally
