"""How a mean friction is found, in plain Python: one scene, Coulomb friction, steps, Newton on the period, the mean.

A mass on a spring and a dashpot lies on a belt that moves, and is shaken along it:

    x'' + 2 zeta x' + x = P sin(Omega t) - N mu sign(x' - v_b)

Between reversals of slip friction is constant and the motion smooth, so a step is cut where slip reverses. A
period of the drive takes the state (x, x') to another one; the steady state is the one that it takes to itself.
``frictionlab/methods/periodic`` finds the same by steps of order eight in machine code, for every law, with stick, in
the plane, and with a bound that holds where a difference of two accuracies would not.
"""

import math

import numpy as np

ZETA, N, MU, V_B = 0.1, 10.0, 0.4, 5.0
P, OMEGA = 10.0, 1.0
PERIOD = 2.0 * math.pi / OMEGA


def rate(t, state, sign):
    """Return the derivative of (x, x', friction's impulse per unit load) while slip has this sign."""
    x, v, _ = state
    force = P * math.sin(OMEGA * t) - 2.0 * ZETA * v - x - N * MU * sign
    return np.array([v, force, MU * -sign])


def step(t, state, sign, h):
    """Take one step of Runge and Kutta's fourth order."""
    k1 = rate(t, state, sign)
    k2 = rate(t + h / 2, state + h / 2 * k1, sign)
    k3 = rate(t + h / 2, state + h / 2 * k2, sign)
    k4 = rate(t + h, state + h * k3, sign)
    return state + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)


def until_reversal(t, state, sign, h):
    """Bisect the length of the step at whose end slip is zero."""
    low, high = 0.0, h
    while high - low > 1e-15:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if sign * (step(t, state, sign, middle)[1] - V_B) > 0.0 else (low, middle)
    return high


def period_map(x, v, steps):
    """Follow the motion for one period; the state at its end and the impulse of friction per unit load."""
    t, state, sign = 0.0, np.array([x, v, 0.0]), math.copysign(1.0, v - V_B)
    while t < PERIOD - 1e-12:
        h = min(PERIOD / steps, PERIOD - t)
        after = step(t, state, sign, h)
        if sign * (after[1] - V_B) < 0.0:
            h = until_reversal(t, state, sign, h)
            after = step(t, state, sign, h)
            pull = P * math.sin(OMEGA * (t + h)) - 2.0 * ZETA * V_B - after[0]
            assert abs(pull) > N * MU, "the mass would stick to the belt here"
            sign = math.copysign(1.0, pull)
        t, state = t + h, after
    return state


def steady_state(steps):
    """Find the state that a period takes to itself, by Newton's method; the mean of friction over that period."""
    start = np.array([-P / (2.0 * ZETA), 0.0])  # of the motion without friction, at resonance
    for _ in range(20):
        end = period_map(*start, steps)
        gap, shift = end[:2] - start, 1e-6
        if np.abs(gap).max() < 1e-12:
            break
        moved = [period_map(*(start + shift * unit), steps)[:2] for unit in np.eye(2)]
        slopes = np.array([(each - end[:2]) / shift for each in moved]).T
        start = start - np.linalg.solve(slopes - np.eye(2), gap)
    return end[2] / PERIOD


mean = steady_state(800)
error = 2.0 * abs(mean - steady_state(400))  # steps half as long are sixteen times as accurate

if __name__ == "__main__":
    print(f"mean friction {mean:.9f} +- {error:.1e} per unit load")
