"""Section 2.3 of the paper says that internal resonance can feed a motion across the belt: here it never does.

A scan of starts by an integrator of its own: the linear motion in closed form, friction as an impulse at each
step that takes from the slip velocity along its direction and stops at zero.
"""

from __future__ import annotations

import itertools

import numpy as np
from numpy.typing import NDArray
from profiles import DEEP

MU, BETA, UNBALANCE, BELT_SPEED = 0.4, 0.1, 10.0, 5.0
SETTINGS = list(itertools.product((0.5, 1.0, 2.0, 4.0), (0.5, 1.0, 2.0), (1.0, 10.0)))
"""Of the drive's frequency, the natural frequency across and the normal load; 2 to 1 and 1 to 1 are among them."""
STARTS, PERIODS, STEPS = 420 if DEEP else 12, 60, 256


def _flow(omega: NDArray[np.float64], damping_ratio: float, step: NDArray[np.float64]) -> NDArray[np.float64]:
    """The free motion of x'' + 2 zeta omega x' + omega^2 x = 0 over a step, a matrix for each."""
    rate = damping_ratio * omega
    turning = omega * np.sqrt(1.0 - damping_ratio**2)
    decay, c, s = np.exp(-rate * step), np.cos(turning * step), np.sin(turning * step)
    rows = [[c + rate / turning * s, s / turning], [-(omega**2) / turning * s, c - rate / turning * s]]
    return np.asarray(decay * np.array(rows))


def test_from_every_start_the_motion_across_dies_out() -> None:
    rng = np.random.default_rng(20261126)
    omega, across, load = (np.repeat(column, STARTS) for column in np.array(SETTINGS).T)
    size = 10.0 ** rng.uniform(-6.0, 2.0, omega.size)
    x, v, x2, v2 = (size * part for part in rng.normal(size=(4, omega.size)))
    step = 2.0 * np.pi / omega / STEPS
    flow, flow_2 = _flow(np.ones_like(omega), BETA, step), _flow(across, BETA, step)
    phasor = UNBALANCE * omega**2 / (1.0 - omega**2 + 2j * BETA * omega)
    first = energy = 0.5 * (v2**2 + across**2 * x2**2)
    for at in range(PERIODS * STEPS):
        free, next_free = (phasor * np.exp(2j * np.pi * k / STEPS) for k in (at, at + 1))
        y, u = x - free.imag, v - (1j * omega * free).imag
        y, u = flow[0, 0] * y + flow[0, 1] * u, flow[1, 0] * y + flow[1, 1] * u
        x, v = y + next_free.imag, u + (1j * omega * next_free).imag
        x2, v2 = flow_2[0, 0] * x2 + flow_2[0, 1] * v2, flow_2[1, 0] * x2 + flow_2[1, 1] * v2
        slip = v - BELT_SPEED + 1j * v2
        left = np.maximum(0.0, 1.0 - MU * load * step / np.maximum(np.abs(slip), 1e-300)) * slip
        v, v2 = left.real + BELT_SPEED, left.imag
        if at % STEPS == STEPS - 1:
            now = 0.5 * (v2**2 + across**2 * x2**2)
            assert (now <= energy * (1.0 + 1e-12)).all()
            energy = now
    # the dashpot alone would leave exp(-2 beta omega_r T) after a time T, and friction takes more
    slowest = np.exp(-2.0 * BETA * across * 2.0 * np.pi / omega * PERIODS * (1.0 - 0.05))
    assert (energy <= 2.0 * slowest * first).all()
