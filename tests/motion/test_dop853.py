"""The eighth-order step: its order conditions by what it does, and its order on planar Coulomb friction."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import pytest

from frictionlab.compile.decorators import fast, njit
from frictionlab.motion.steppers.dop853 import State, interpolant, motion_within, stepper, unprepared


class Power(NamedTuple):
    """x'' = tau^power - stiffness*x; friction tau^power."""

    power: int
    stiffness: float


@fast
def _power_rates(problem, _stage, tau, x, v):
    return tau**problem.power - problem.stiffness * x, tau**problem.power


_power_step = stepper(_power_rates, unprepared)


@njit
def power_step(problem, tau, x, v, h):
    a, f = _power_rates(problem, 0, tau, x, v)
    return _power_step(problem, tau, State(x, v, a, f), h)


class Belt(NamedTuple):
    """A circularly driven mass on a belt: x'' = load e^(i tau) - x - 0.2 x' - friction w/|w|, w = x' - belt."""

    load: float
    friction: float
    belt: float


@fast
def _belt_rates(problem, _stage, tau, x, v):
    return _belt_rates_at(problem, tau, x, v)


@fast
def _belt_rates_at(problem, tau, x, v):
    w = v - problem.belt
    rub = w / math.sqrt(w.real * w.real + w.imag * w.imag)
    turn = complex(math.cos(tau), math.sin(tau))
    return problem.load * turn - x - 0.2 * v - problem.friction * rub, rub


_belt_step = stepper(_belt_rates, unprepared)
_belt_dense = interpolant(_belt_rates, unprepared, _belt_rates_at)


@njit
def belt_run(problem, x, v, end, steps):
    """Position, velocity and friction impulse after so many equal steps."""
    h, friction_impulse = end / steps, 0j
    for i in range(steps):
        a, f = _belt_rates_at(problem, i * h, x, v)
        taken = _belt_step(problem, i * h, State(x, v, a, f), h)
        x, v, friction_impulse = taken.x, taken.v, friction_impulse + taken.friction_impulse
    return x, v, friction_impulse


@njit
def belt_within(problem, x, v, h, share):
    """Position and velocity a share into one step from tau = 0."""
    a, f = _belt_rates_at(problem, 0.0, x, v)
    dense = _belt_dense(problem, 0.0, State(x, v, a, f), h)
    return motion_within(dense, share * h)


@njit
def belt_errors(problem, x, v, h):
    """The error estimates of one step of the velocity, of order 5 and 3."""
    a, f = _belt_rates_at(problem, 0.0, x, v)
    taken = _belt_step(problem, 0.0, State(x, v, a, f), h)
    return abs(taken.v_error5), abs(taken.v_error3)


@pytest.mark.parametrize("power", range(8))
def test_powers_of_time_below_the_eighth_are_integrated_exactly(power):
    tau, h = 0.7, 0.9
    taken = power_step(Power(power, 0.0), tau, 0.3, -0.2, h)
    first = ((tau + h) ** (power + 1) - tau ** (power + 1)) / (power + 1)
    second = ((tau + h) ** (power + 2) - tau ** (power + 2)) / ((power + 1) * (power + 2))
    second -= h * tau ** (power + 1) / (power + 1)
    assert taken.v == pytest.approx(-0.2 + first, rel=1e-13, abs=1e-14)
    assert taken.friction_impulse == pytest.approx(first, rel=1e-13, abs=1e-14)
    if power < 7:  # a position is a double integral: one order more
        assert taken.x == pytest.approx(0.3 - 0.2 * h + second, rel=1e-13, abs=1e-14)


def test_planar_coulomb_friction_is_integrated_to_order_eight():
    problem, start = Belt(10.0, 4.0, 5.0), (0.4 - 9.0j, 9.0 + 1.0j)
    end = 2.0 * math.pi
    fine = belt_run(problem, *start, end, 4000)
    counts = np.array([32, 40, 48, 64])
    for part in range(3):
        errors = [abs(belt_run(problem, *start, end, n)[part] - fine[part]) for n in counts]
        assert errors[-1] > 1e-13
        slope = -np.polyfit(np.log(counts), np.log(errors), 1)[0]
        assert 7.5 <= slope <= 9.0, part


@pytest.mark.parametrize("share", [0.04, 0.3, 0.74])
def test_a_step_is_known_to_order_seven_between_its_ends(share):
    problem, start = Belt(10.0, 4.0, 5.0), (0.4 - 9.0j, 9.0 + 1.0j)
    steps = np.array([0.08, 0.1, 0.15, 0.2])
    for part in range(2):
        exact = [belt_run(problem, *start, share * h, 50)[part] for h in steps]
        found = [belt_within(problem, *start, h, share)[part] for h in steps]
        errors = np.abs(np.subtract(found, exact))
        slope = np.polyfit(np.log(steps), np.log(errors), 1)[0]
        assert 7.2 <= slope <= 8.7, part
        assert errors[0] < 2e-11


def test_the_error_estimates_shrink_with_their_order():
    problem, start = Belt(10.0, 2.0, 1.5), (0.4 - 9.0j, 9.0 + 1.0j)
    steps = np.array([0.05, 0.1, 0.2])
    fifth, third = np.array([belt_errors(problem, *start, h) for h in steps]).T
    assert 5.5 <= np.polyfit(np.log(steps), np.log(fifth), 1)[0] <= 7.0
    assert 3.5 <= np.polyfit(np.log(steps), np.log(third), 1)[0] <= 5.0
