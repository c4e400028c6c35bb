"""Mean friction of a driven mass by scipy alone: DOP853 over a period, closed by scipy's root."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import root

import frictionlab as fl


def mean_by_integration(scene: fl.Scene, coefficient: Callable[[float], float]) -> float:
    """Return the mean friction along the belt of a mass that is shaken along and, with ``transverse``, across it.

    Friction is ``coefficient`` of the slip speed, along the slip; its impulse is integrated beside the motion.
    """
    drive, across = scene.drive, scene.transverse
    period, damping = 2 * math.pi / drive.frequency, 2 * scene.damping_ratio
    load, belt = scene.normal_load, scene.belt_speed
    stiffness_2 = across.natural_frequency**2 if across else 1.0
    damping_2 = 2 * across.damping_ratio * across.natural_frequency if across else damping
    amplitude_2 = across.load.amplitude if across else 0.0
    size = 4 if across else 2

    def rates(tau: float, y: Sequence[float]) -> tuple[float, ...]:
        slip = complex(y[1] - belt, y[3])
        friction = coefficient(abs(slip)) * slip / abs(slip) if slip else 0j
        shape = math.sin(drive.frequency * tau)
        a = drive.amplitude * shape - damping * y[1] - y[0] - load * friction.real
        a_2 = amplitude_2 * shape - damping_2 * y[3] - stiffness_2 * y[2] - load * friction.imag
        return y[1], a, y[3], a_2, -friction.real

    def after_a_period(start: np.ndarray) -> np.ndarray:
        begin = np.zeros(5)
        begin[:size] = start[:size]
        return solve_ivp(rates, (0, period), begin, rtol=1e-12, atol=1e-13, method="DOP853").y[:, -1]

    start = np.zeros(size)
    for _ in range(6):
        start = after_a_period(start)[:size]
    closed = root(lambda y: after_a_period(y)[:size] - y, start, tol=1e-13, options={"eps": 1e-7}).x
    end = after_a_period(closed)
    assert np.abs(end[:size] - closed).max() < 1e-10
    return float(end[4] / period)
