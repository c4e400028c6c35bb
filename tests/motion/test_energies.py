"""Energies of one period: they close within their errors, and agree with integration that shares no code."""

from __future__ import annotations

import math
import random

import numpy as np
import pytest
from profiles import deep, some
from scipy.integrate import solve_ivp

import frictionlab as fl
from frictionlab.values.columns import columns_of

ENERGIES = [name for name in columns_of("energies") if not name.endswith("_error")]

HELD = fl.Scene(  # in presliding: the mean friction force is forty times the load
    damping_ratio=0.0487, normal_load=3914.0, belt_speed=4.31, drive=fl.Drive(amplitude=26.3, frequency=2.16)
)
SOFT = fl.Dahl(mu=0.4, presliding_length=0.146)
SMOOTH = fl.Scene(
    damping_ratio=0.1, normal_load=5, belt_speed=1.5, drive=fl.Drive(amplitude=3, frequency=0.7)
)


def closes(state: fl.SteadyState) -> bool:
    missing = state.energy_input - state.energy_viscous - state.energy_friction
    return abs(missing) <= state.energy_input_error + state.energy_viscous_error + state.energy_friction_error


def test_what_an_orbit_leaves_open_costs_no_work_of_the_mean_friction() -> None:
    state = fl.steady_state(HELD, SOFT, tolerance=1e-5)
    missing = state.energy_input - state.energy_viscous - state.energy_friction

    assert abs(missing) < 2e-4 * state.energy_input  # with the mean velocity of the orbit left in it: 5e-3
    assert closes(state)


@some(2, "maps of every law")
@pytest.mark.parametrize("tolerance", [1e-4, 1e-6])
@pytest.mark.parametrize(("scene", "law"), [(HELD, SOFT), (SMOOTH, fl.Coulomb(mu=0.4))])
def test_energies_differ_from_more_exact_ones_by_no_more_than_their_errors(
    scene: fl.Scene, law: fl.FrictionLaw, tolerance: float
) -> None:
    rough, fine = (fl.steady_state(scene, law, "shooting", each) for each in (tolerance, 1e-9))

    for name in ENERGIES:
        assert abs(getattr(rough, name) - getattr(fine, name)) <= getattr(rough, f"{name}_error")
        assert getattr(fine, f"{name}_error") < 1e-5 * max(fine.energy_input, fine.energy_contact)


@pytest.mark.parametrize("method", ["mdsm", "harmonic_balance"])
def test_a_model_that_bounds_the_mean_alone_states_no_errors_of_energies(method: str) -> None:
    state = fl.steady_state(SMOOTH.with_(belt_speed=0.5), fl.Coulomb(mu=0.04), method)

    assert state.status == "ok"
    assert all(math.isnan(getattr(state, f"{name}_error")) for name in ENERGIES)


def test_of_a_prescribed_slip_friction_and_heat_have_errors() -> None:
    scene = fl.Scene(belt_speed=1, slip={"velocity_amplitude": 2, "frequency": 1})  # type: ignore[arg-type]
    state = fl.steady_state(scene, fl.Coulomb(mu=0.4))
    # 2 * 0.4 * integral of 2 |cos| between the reversals at sin = 1/2, less what the belt pays for the mean
    worked = 0.4 * 2.0 * 2.0 * 2.0 * math.cos(math.asin(0.5))

    assert state.energy_friction == pytest.approx(worked, abs=state.energy_friction_error)
    assert 0.0 < state.energy_friction_error < 1e-6
    assert math.isnan(state.energy_input_error)


def test_no_loads_put_nothing_in_and_there_is_no_doubt_of_it() -> None:
    law = fl.Stribeck(mu_kinetic=0.3, mu_static=0.6, stribeck_speed=0.5)
    state = fl.steady_state(fl.Scene(damping_ratio=0.05, normal_load=5, belt_speed=0.3), law)

    assert (state.energy_input, state.energy_input_error) == (0.0, 0.0)
    assert closes(state)


# --- against unrelated integration ----------------------------------------------------------------------------------


SEEDS = [0, 1, *(pytest.param(seed, marks=deep("seconds of integration")) for seed in range(2, 50))]


def _drawn(seed: int) -> tuple[fl.Scene, fl.Dahl]:
    """A mass on Dahl's bristles, held or swinging, that forgets its start within some twenty periods."""
    rng = random.Random(seed)

    def between(low: float, high: float) -> float:
        return math.exp(rng.uniform(math.log(low), math.log(high)))

    frequency, damping, load = between(0.3, 3.0), between(0.1, 1.0), between(0.5, 20.0)
    swing = load * frequency / math.hypot(1.0 - frequency**2, 2.0 * damping * frequency)
    drive = fl.Drive(amplitude=load, frequency=frequency)
    pressed = load * between(0.05, 20.0) / 0.4
    scene = fl.Scene(
        damping_ratio=damping, normal_load=pressed, belt_speed=swing * between(0.01, 1.2), drive=drive
    )
    return scene, fl.Dahl(mu=0.4, presliding_length=swing / frequency * between(0.02, 1.0))


def _integrated(scene: fl.Scene, law: fl.Dahl, start: fl.SteadyState) -> np.ndarray:
    """The four energies by an implicit Runge-Kutta method of scipy, once the motion repeats."""
    body, stiffness = scene.mass(), law.mu / (law.presliding_length or 1.0)
    period, at = 2.0 * math.pi / scene.frequency, start.orbit(1)

    def slope(tau: float, y: np.ndarray) -> list[float]:
        x, v, z = y[:3]
        w = v - scene.belt_speed
        rub = body.normal_load * stiffness * z
        push = body.force.real * math.sin(scene.frequency * tau)
        rate = w - stiffness / law.mu * abs(w) * z
        viscous = body.damping * v * v
        return [v, push - body.damping * v - x - rub, rate, push * v, viscous, rub * v, rub * w]

    y = np.array([at.x1[0], at.v1[0], at.friction[0] / stiffness, 0.0, 0.0, 0.0, 0.0])
    scale = np.array([abs(y[0]) + 1e-3, abs(y[1]) + scene.belt_speed, law.mu / stiffness, 1.0, 1.0, 1.0, 1.0])
    for _ in range(400):
        y[3:] = 0.0
        before = y.copy()
        y = solve_ivp(slope, (0.0, period), y, "Radau", rtol=1e-9, atol=1e-11 * scale).y[:, -1]
        if np.abs((y - before)[:3] / scale[:3]).max() < 1e-6:  # its own noise is up to 4e-7
            return y[3:]
    raise AssertionError("the motion does not repeat")


@pytest.mark.parametrize("seed", SEEDS)
def test_energies_agree_with_an_integration_that_shares_no_code(seed: int) -> None:
    scene, law = _drawn(seed)
    state = fl.steady_state(scene, law, tolerance=1e-6)
    known = _integrated(scene, law, state)

    assert state.status == "ok"
    for name, value in zip(ENERGIES, known, strict=True):
        rounding = 1e-6 * np.abs(known).max()  # of the integration
        assert abs(getattr(state, name) - value) <= getattr(state, f"{name}_error") + rounding, name
    assert closes(state)


# --- long stick ---------------------------------------------------------------------------------------------------

QUICK = {
    "harmonics": [
        {"order": 1, "amplitude": 1, "phase": 0},
        {"order": 20, "amplitude": 0.3, "phase": math.degrees(0.5)},
    ]
}
LONG_STICK = fl.Scene(
    damping_ratio=0.1,
    normal_load=3,
    belt_speed=0.05,
    drive=fl.Drive(amplitude=1, frequency=0.5, waveform=QUICK),
)
"""A mass that rests for three quarters of the period while a load of twenty times the frequency shakes it."""


def test_a_load_that_is_quick_within_a_long_rest_is_resolved() -> None:
    """Dormand-Prince 5(4) with events at tolerances of 1e-11 and 1e-12; one panel for the rest gave 7 % more."""
    state = fl.steady_state(LONG_STICK, fl.Coulomb(mu=0.4, mu_static=0.5))

    assert abs(state.mean_friction - 0.1023554435) < 1e-9
    for name, value in (("input", 0.5862770898), ("friction", 0.5610467710), ("contact", 0.7539822366)):
        error = getattr(state, f"energy_{name}_error")
        assert abs(getattr(state, f"energy_{name}") - value) <= error + 1e-9
        assert error < 1e-7
    assert abs(state.harmonics(25).friction_amplitude[0] + state.mean_friction) < 1e-10


@pytest.mark.parametrize("law", [fl.Coulomb(mu=0.4, mu_static=0.5), fl.Dahl(mu=0.4, presliding_length=0.01)])
def test_energies_of_body_and_contact_balance(law: fl.FrictionLaw) -> None:
    """E_in = E_v + E_f, and E_f = E_c less the work of the belt, v_b N mean T."""
    state = fl.steady_state(LONG_STICK, law)
    error = sum(getattr(state, f"{name}_error") for name in ENERGIES)
    belt = 0.05 * 3 * state.mean_friction * state.period * 2 * math.pi / 0.5

    assert abs(state.energy_input - state.energy_viscous - state.energy_friction) <= error
    assert abs(state.energy_contact - state.energy_friction - belt) <= error
    assert error < 1e-6
