"""Mean friction over one period by scipy alone: DOP853 from kink to kink, Newton's method for the periodic state."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

Rates = Callable[[float, NDArray[np.float64]], Sequence[float]]
Kink = Callable[[float, NDArray[np.float64]], float]
BODY = {"damping_ratio": 0.1, "normal_load": 10, "belt_speed": 2}
DRIVE = {"unbalance": 10, "frequency": 1.5}
ACROSS = {"natural_frequency": 1.3, "damping_ratio": 0.1}
DIRECTION = 30.0
"""Mass on a belt and its drive; in the plane also its spring across the belt, and the direction of the drive."""


def pushed(tau: float, x: complex, u: complex, friction: complex, plane: bool) -> complex:
    """Return the acceleration of that mass at a friction coefficient along its slip."""
    load, beta, turn = 10.0 * friction, 0.1, math.radians(DIRECTION) if plane else 0.0
    force = 10.0 * 1.5**2 * math.cos(1.5 * tau) * complex(math.cos(turn), math.sin(turn))
    along = force.real - 2.0 * beta * u.real - x.real - load.real
    return complex(
        along, force.imag - 2.0 * beta * 1.3 * u.imag - 1.3**2 * x.imag - load.imag if plane else 0.0
    )


def mean_over_period(rates: Rates, size: int, period: float, kinks: Sequence[Kink] = ()) -> float:
    """Return the mean of the last of ``rates``, which is no state, over the periodic motion of ``size`` states.

    ``kinks`` are functions of time and state whose zeros are where rates have a kink.
    """
    state = np.zeros(size)
    for _ in range(15):
        state, _mean = _turn(rates, state, period, kinks)
    for _ in range(8):
        end, mean = _turn(rates, state, period, kinks)
        if np.abs(end - state).max() < 1e-10:
            return mean
        state = state - np.linalg.solve(_changes(rates, state, period, kinks) - np.eye(size), end - state)
    raise AssertionError(f"no periodic state: {np.abs(end - state).max():g} left")


def _changes(
    rates: Rates, state: NDArray[np.float64], period: float, kinks: Sequence[Kink]
) -> NDArray[np.float64]:
    columns = []
    for step in 1e-6 * np.eye(len(state)):
        ends = [_turn(rates, state + sign * step, period, kinks)[0] for sign in (1.0, -1.0)]
        columns.append((ends[0] - ends[1]) / 2e-6)
    return np.transpose(columns)


def _turn(
    rates: Rates, state: NDArray[np.float64], period: float, kinks: Sequence[Kink]
) -> tuple[NDArray[np.float64], float]:
    """Return the state after one period, and the mean of the last rate."""
    for kink in kinks:
        kink.terminal = True  # type: ignore[attr-defined]
    time, y = 0.0, np.append(state, 0.0)
    while time < period:
        found = solve_ivp(
            rates, (time, period), y, method="DOP853", rtol=1e-13, atol=1e-14, events=kinks or None
        )
        time, y = found.t[-1], found.y[:, -1]
        if found.status == 1:  # past the kink, by an explicit step so short that the kink is not felt
            step = min(1e-10 * period, period - time)
            middle = y + 0.5 * step * np.asarray(rates(time, y))
            time, y = time + step, y + step * np.asarray(rates(time + 0.5 * step, middle))
    return y[:-1], float(y[-1] / period)
