"""Steady states of a body with relaxing elements under Coulomb friction, by following the motion in time.

Written for tests alone, from the equations, in another way than the package: the state is (x, v, z_1 ... z_n) with

    x'' + damping x' + x + sum of w_j z_j = P sin(Omega t) - friction,    z_j' = x' - r_j z_j,

linear between events, its flow by eigenvectors; events on a grid of times, refined; the period is closed by Newton's
method with derivatives carried through the events. D^q is a sum of such elements: s^q is sin(pi q)/pi times the
integral of r^(q - 1) s/(s + r) dr, by the trapezoidal rule in log r, beyond the last r (s/r - s^2/r^2) and below the
first a spring that feels x less its mean.
"""

from __future__ import annotations

import itertools
import math

import numpy as np
from scipy.optimize import brentq


def elements_of_order(q, coefficient, step=0.35, low=1e-10, high=1e4):
    """Rates, weights, dashpot, mass and spring (of x less its mean) that make coefficient*D^q."""
    rates = np.exp(np.arange(math.log(low), math.log(high), step))
    scale = coefficient * math.sin(math.pi * q) / math.pi * step
    beyond, ratio = rates[-1] * math.exp(step), math.exp(step)
    dashpot = scale * beyond ** (q - 1.0) / (1.0 - ratio ** (q - 1.0))
    mass = -scale * beyond ** (q - 2.0) / (1.0 - ratio ** (q - 2.0))
    spring = scale * (rates[0] / ratio) ** q / (1.0 - ratio**-q)
    return rates, scale * rates**q, dashpot, mass, spring


class Body:
    """Elements with rates and weights beside mass, spring 1 and dashpot."""

    def __init__(self, damping, rates, weights, dashpot=0.0, mass=0.0, spring=0.0):
        self.rates, self.weights = np.atleast_1d(rates), np.atleast_1d(weights)
        self.damping, self.mass, self.spring = damping + dashpot, 1.0 + mass, spring
        n = len(self.rates)
        slip = np.zeros((n + 2, n + 2))
        slip[0, 1] = 1.0
        slip[1, 0], slip[1, 1], slip[1, 2:] = -(1.0 + spring), -self.damping, -self.weights
        slip[1] /= self.mass
        slip[2:, 1], slip[2:, 2:] = 1.0, -np.diag(self.rates)
        self.flow = slip
        self.values, self.vectors = np.linalg.eig(slip)
        self.inverse = np.linalg.inv(self.vectors)


class Scene:
    """A body, the load P sin(Omega t), the limit of friction and the belt."""

    def __init__(self, body, load, frequency, limit, belt_speed):
        self.body, self.load, self.frequency = body, load, frequency
        self.limit, self.belt_speed = limit, belt_speed
        self.period = 2.0 * math.pi / frequency
        n = len(body.flow)
        push = np.zeros(n)
        push[1] = load / body.mass
        self.answer = np.linalg.solve(1j * frequency * np.eye(n) - body.flow, push)
        self.mean = 0.0  # of x, which the spring of slow elements leaves out

    def steady(self, t):
        return np.imag(self.answer * np.exp(1j * self.frequency * t))

    def held(self, sign):
        """Rest position under friction of this sign; only x is not zero."""
        rest = np.zeros(len(self.body.flow))
        rest[0] = (self.body.spring * self.mean - sign * self.limit) / (1.0 + self.body.spring)
        return rest

    def slip(self, start, t0, sign):
        """Return the state a time r later, and its derivative by the start."""
        b, rest = self.body, self.held(sign)
        parts = b.inverse @ (start - self.steady(t0) - rest)

        def at(r):
            return (b.vectors @ (np.exp(b.values * r) * parts)).real + self.steady(t0 + r) + rest

        def by_start(r):
            return (b.vectors * np.exp(b.values * r) @ b.inverse).real

        return at, by_start

    def rest(self, start, t0):
        b, v = self.body, self.belt_speed

        def at(r):
            state = start.copy()
            fade = np.exp(-b.rates * r)
            state[0] += v * r
            state[1] = v
            state[2:] = start[2:] * fade + v * -np.expm1(-b.rates * r) / b.rates
            return state

        def by_start(r):
            made = np.eye(len(start))
            made[1, 1] = 0.0
            made[2:, 2:] = np.diag(np.exp(-b.rates * r))
            return made

        return at, by_start

    def rate(self, t, state, sign):
        b = self.body
        force = self.load * math.sin(self.frequency * t) - sign * self.limit + b.spring * self.mean
        made = b.flow @ state
        made[1] += force / b.mass
        return made

    def holding(self, t, state):
        """Friction that keeps the body on the belt."""
        return self.rate(t, state, 0.0)[1] * self.body.mass

    def period_map(self, start):
        """State after a period, its derivative, impulse of friction, integral of x, share of rest."""
        t, state, by, impulse, way, rested = 0.0, start.copy(), np.eye(len(start)), 0.0, 0.0, 0.0
        w, hold = state[1] - self.belt_speed, self.holding(0.0, state)
        at_rest = abs(w) < 1e-12 * max(1.0, abs(self.belt_speed)) and abs(hold) <= self.limit
        mode = 0.0 if at_rest else math.copysign(1.0, w)
        nodes, weights = np.polynomial.legendre.leggauss(8)
        for _ in range(100):
            at, by_start = self.rest(state, t) if mode == 0.0 else self.slip(state, t, mode)
            left, step = self.period - t, self.period / 400.0

            def margin(r, at=at, t=t, mode=mode):
                now = at(r)
                if mode == 0.0:
                    return self.limit - abs(self.holding(t + r, now))
                return mode * (now[1] - self.belt_speed)

            r, end, event = 0.0, left, False
            while r < left:
                far = min(left, r + step)
                # Just after an event the margin is zero.
                inside = [
                    low for low in (r, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3) if r <= low < far and margin(low) > 0.0
                ]
                if margin(far) < 0.0 and inside:
                    end, event = brentq(margin, inside[0], far, xtol=1e-15, rtol=1e-15), True
                    break
                r = far
            cuts = np.linspace(0.0, end, max(2, math.ceil(end / (self.period / 60.0)) + 1))
            for a, b in itertools.pairwise(cuts):
                for node, weight in zip(nodes, weights, strict=True):
                    r = 0.5 * (a + b) + 0.5 * (b - a) * node
                    now = at(r)
                    rub = self.holding(t + r, now) if mode == 0.0 else mode * self.limit
                    impulse += 0.5 * (b - a) * weight * rub
                    way += 0.5 * (b - a) * weight * now[0]
            rested += end if mode == 0.0 else 0.0
            state, by, t = at(end), by_start(end) @ by, t + end
            if not event:
                return state, by, impulse, way, rested / self.period
            if mode == 0.0:
                mode = math.copysign(1.0, self.holding(t, state))
                continue
            state[1] = self.belt_speed
            before, hold = self.rate(t, state, mode), self.holding(t, state)
            mode = 0.0 if abs(hold) <= self.limit else math.copysign(1.0, hold)
            if mode == 0.0:
                after = np.zeros(len(state))
                after[0] = self.belt_speed
                after[2:] = self.belt_speed - self.body.rates * state[2:]
            else:
                after = self.rate(t, state, mode)
            jump = np.outer(after - before, np.eye(len(state))[1] / before[1])
            by = (np.eye(len(state)) + jump) @ by
        raise ValueError("too many events")

    def solved(self):
        """Mean friction over its limit, and the share of rest, of the steady state."""
        n = len(self.body.flow)
        state = self.steady(0.0) + self.held(-1.0)
        for _ in range(60):
            way = 0.0
            for _ in range(60):
                end, by, impulse, way, rested = self.period_map(state)
                gap = end - state
                if np.abs(gap).max() < 1e-12:
                    break
                move = np.linalg.solve(np.eye(n) - by, gap)
                state = state + move if np.abs(move).max() < 1e3 else end
            mean = way / self.period
            if abs(mean - self.mean) < 1e-11:
                break
            self.mean = mean
        return -impulse / self.period / self.limit, rested


CASES = ((1.0, 10.0, 4.0, 10.0), (0.7, 4.9, 1.0, 3.0), (1.0, 1.0, 0.9, 0.3), (0.5, 1.0, 0.6, 0.1))
"""Frequency, load, limit of friction, belt speed: without rest, with a short one, and with two longer ones."""


def fractional(damping, q, coefficient, case):
    """Mean friction over its limit, and share of rest, of a body with coefficient*D^q."""
    rates, weights, dashpot, mass, spring = elements_of_order(q, coefficient)
    frequency, load, limit, belt_speed = case
    return Scene(
        Body(damping, rates, weights, dashpot, mass, spring), load, frequency, limit, belt_speed
    ).solved()


if __name__ == "__main__":
    # python outside_memory.py > fractional_bodies.csv
    print("q,frequency,load,limit,belt_speed,mean,stick_fraction")
    for q in (0.1, 0.3, 0.5, 0.7, 0.9):
        for case in CASES:
            print(q, *case, *(f"{value:.12g}" for value in fractional(0.2, q, 0.2, case)), sep=",")
