"""Steady states of a body with a fractional element under Coulomb friction, in steps of time by Grünwald's sum.

Written for tests alone, from the equations: x'' + damping x' + x + c D^q x = P sin(Omega t) - friction, D^q x the sum
of w_k x(t - k h) over all that has been, w_k the coefficients of ((1 - z)/h)^q. A step balances what acts over it on
average; the sum is D^q x a time q h/2 before, so that of the sums at its ends (1 + q)/2 and (1 - q)/2 are taken. Slip
that reaches zero within a step does so along a straight line; there it goes on, or rests where friction can hold the
body. A period begins as if the one before it had always been; periods follow each other until the mean repeats.
All of it is of second order in the step.

Source: Podlubny, Fractional Differential Equations (1999), chapter 7.
"""

from __future__ import annotations

import math

import numpy as np


def mean_over_limit(damping, q, coefficient, case, steps, periods=80):
    """Mean friction over its limit, in so many steps a period; case: frequency, load, limit, belt speed."""
    frequency, load, limit, belt = case
    h = 2.0 * math.pi / frequency / steps
    k = np.arange(1, steps)
    weights = coefficient * h**-q * np.concatenate([[1.0], np.cumprod((k - 1.0 - q) / k)])
    # of a motion that repeats, all periods together; of those before this one, by how long ago
    turned = 1.0 - np.exp(-2j * np.pi * np.arange(steps) / steps)
    repeated = coefficient * h**-q * np.fft.ifft(turned**q).real
    ago = np.arange(steps)[:, None] - np.arange(steps)[None, :] + steps
    before = np.concatenate([repeated, repeated - weights])[ago]
    backward, late = weights[::-1].copy(), 0.5 * (1.0 + q)
    ends = np.cos(frequency * h * np.arange(steps + 1))
    push = load * (ends[:-1] - ends[1:]) / (frequency * h)
    inertia = 1.0 / h + 0.5 * damping + 0.25 * h + 0.5 * h * late * weights[0]
    x, v, held, friction, last = np.zeros(steps), 0.0, 0.0, np.zeros(steps), math.inf
    for _ in range(periods):
        past, place, x = before @ x, x[-1], np.zeros(steps)
        for i in range(steps):
            memory, coasting = past[i] + backward[steps - 1 - i : -1] @ x[:i], place + 0.5 * h * v
            force = push[i] + v / h - 0.5 * damping * v - 0.5 * (place + coasting)
            force -= late * (memory + weights[0] * coasting) + (1.0 - late) * held
            stop, slip = force - inertia * belt, v - belt  # friction that would end the slip in this step
            side = math.copysign(1.0, slip if slip != 0.0 else stop)
            friction[i] = side * limit
            if side * stop <= limit and abs(stop - slip / h) <= limit:
                friction[i] = stop
            elif side * stop < limit and slip != 0.0:
                share = slip / (slip - (stop - side * limit) / inertia)
                friction[i] = side * limit * (2.0 * share - 1.0)
            v = belt if friction[i] == stop else (force - friction[i]) / inertia
            place = x[i] = coasting + 0.5 * h * v
            held = memory + weights[0] * place
        if abs(friction.mean() - last) < 1e-9 * limit:
            break
        last = friction.mean()
    return -friction.mean() / limit
