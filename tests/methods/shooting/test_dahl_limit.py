"""Steady states on Dahl bristles: balances of any law, and how they tend to those of Coulomb friction."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.optimize import fsolve

import frictionlab as fl
from frictionlab.laws.dahl import Dahl
from frictionlab.theory import reversal_kick

DAMPING, LOAD, MU, UNBALANCE, FREQUENCY, BELT = 0.1, 10.0, 0.4, 10.0, 1.5, 15.0
SCENE = fl.Scene(
    damping_ratio=DAMPING,
    normal_load=LOAD,
    belt_speed=BELT,
    drive=fl.Drive(unbalance=UNBALANCE, frequency=FREQUENCY),
)


def coulomb_mean(root: float) -> float:
    """Mean Coulomb friction at two reversals a period, each kicked as by Dahl bristles; root of presliding length.

    Unknowns: the instants of both reversals and the positions there; between them the motion is linear.
    """
    period, force, friction = 2 * math.pi / FREQUENCY, UNBALANCE * FREQUENCY**2, MU * LOAD
    forced = force / complex(1 - FREQUENCY**2, 2 * DAMPING * FREQUENCY)
    pole = complex(-DAMPING, math.sqrt(1 - DAMPING**2))

    def linear(t: float) -> tuple[float, float]:
        turn = forced * complex(math.cos(FREQUENCY * t), math.sin(FREQUENCY * t))
        return turn.imag, (1j * FREQUENCY * turn).imag

    def flow(begin: float, end: float, state: tuple[float, float], side: float) -> tuple[float, float]:
        x, v = (a - b for a, b in zip(state, linear(begin), strict=True))
        x = x + side * friction
        free = (v - pole.conjugate() * x) / (2j * pole.imag) * np.exp(pole * (end - begin))
        at_end = linear(end)
        return at_end[0] - side * friction + 2 * free.real, at_end[1] + 2 * (pole * free).real

    def kick(t: float, x: float, side: float) -> float:
        net = side * (force * math.sin(FREQUENCY * t) - 2 * DAMPING * BELT - x) - friction
        return root * reversal_kick(friction, net)

    def misses(unknown: np.ndarray) -> list[float]:
        up, x, down = unknown
        there, speed = flow(up, down, (x, BELT + kick(up, x, 1.0)), 1.0)
        back = flow(down, up + period, (there, BELT - kick(down, there, -1.0)), -1.0)
        return [speed - BELT, back[0] - x, back[1] - BELT]

    orbit = fl.steady_state(SCENE, fl.Coulomb(mu=MU), tolerance=1e-9).orbit(2000)
    slips = orbit.v1 > BELT
    first = int(np.flatnonzero(slips & ~np.roll(slips, 1))[0])
    length = int(np.count_nonzero(slips))
    guess = [orbit.tau[first], orbit.x1[first], orbit.tau[first] + length * period / 2000]
    up, x, down = fsolve(misses, guess, xtol=1e-13)
    there = flow(up, down, (x, BELT + kick(up, x, 1.0)), 1.0)[0]
    pushed = kick(up, x, 1.0) - kick(down, there, -1.0) - friction * (2 * (down - up) - period)
    return float(pushed / period / LOAD)


def dahl_mean(presliding: float) -> float:
    law = Dahl(mu=MU, presliding_length=presliding)
    return fl.steady_state(SCENE, law, method="shooting", tolerance=1e-9).mean_friction


def test_means_tend_to_coulombs_as_the_root_of_the_presliding_length_by_the_kicks_of_the_reversals() -> None:
    rigid = fl.steady_state(SCENE, fl.Coulomb(mu=MU), tolerance=1e-10).mean_friction
    lengths = np.array([1e-2, 1e-3, 1e-4, 1e-6])
    gaps = np.array([rigid - dahl_mean(length) for length in lengths.tolist()])
    slopes = np.diff(np.log(gaps)) / np.diff(np.log(lengths))

    assert np.all((slopes[:2] > 0.46) & (slopes[:2] < 0.5))  # not one
    assert coulomb_mean(0.0) == pytest.approx(rigid, abs=1e-9)
    predicted = (coulomb_mean(0.0) - coulomb_mean(1e-4)) / 1e-4
    assert gaps[-1] / math.sqrt(lengths[-1]) == pytest.approx(predicted, rel=3e-3)


@pytest.mark.parametrize("presliding", [1.0, 1e-3])
def test_the_mean_position_carries_the_mean_friction_and_the_energies_close(presliding: float) -> None:
    state = fl.steady_state(
        SCENE, Dahl(mu=MU, presliding_length=presliding), method="shooting", tolerance=1e-9
    )
    orbit, period = state.orbit(4000), 2 * math.pi / FREQUENCY

    assert orbit.x1.mean() == pytest.approx(LOAD * state.mean_friction, abs=1e-6)
    assert state.energy_input == pytest.approx(state.energy_viscous + state.energy_friction, rel=1e-7)
    belt = BELT * LOAD * state.mean_friction * period
    assert state.energy_contact == pytest.approx(state.energy_friction + belt, rel=1e-7)
    assert state.energy_contact > 0


def on_a_fast_belt(times_the_vibration: float, frequency: float = 0.5) -> fl.Scene:
    """A belt so many times as fast as the vibration without friction."""
    peak = UNBALANCE * frequency**3 / math.hypot(1.0 - frequency**2, 2.0 * DAMPING * frequency)
    drive = fl.Drive(unbalance=UNBALANCE, frequency=frequency)
    return fl.Scene(
        damping_ratio=DAMPING, normal_load=LOAD, belt_speed=times_the_vibration * peak, drive=drive
    )


@pytest.mark.parametrize("exponent", [1.0, 1.5, 2.0, 3.0])
@pytest.mark.parametrize("times", [1.001, 1.05, 1.3, -1.3])
def test_where_slip_never_reverses_the_mean_is_mu_however_slowly_bristles_saturate(
    times: float, exponent: float
) -> None:
    law = Dahl(mu=MU, stiffness=40.0, exponent=exponent)
    state = fl.steady_state(on_a_fast_belt(times), law, method="shooting", tolerance=1e-6)

    assert state.status == "ok"
    assert abs(state.mean_friction) == pytest.approx(MU, abs=state.error)
    assert state.error < 1e-12


@pytest.mark.parametrize("exponent", [1.0, 1.5, 2.0])
@pytest.mark.parametrize("times", [1.0, 1.00001])
def test_a_belt_just_as_fast_as_the_vibration_has_the_mean_of_sliding(times: float, exponent: float) -> None:
    law = Dahl(mu=MU, stiffness=40.0, exponent=exponent)
    state = fl.steady_state(on_a_fast_belt(times), law, method="shooting")

    assert (state.status, state.mean_friction) == ("ok", pytest.approx(MU, abs=1e-12))


@pytest.mark.parametrize(("exponent", "second"), [(2.0, 0.379791832), (3.0, 0.349295841)])
def test_a_second_orbit_beside_sliding_that_never_reverses_is_found(exponent: float, second: float) -> None:
    law = Dahl(mu=MU, stiffness=4.0, exponent=exponent)
    state = fl.steady_state(on_a_fast_belt(1.001, frequency=1.5), law, method="shooting")

    assert state.status == "not_unique"
    assert (state.mean_low, state.mean_high) == pytest.approx((second, MU), abs=2e-8)
