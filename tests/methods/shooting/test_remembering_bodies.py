"""Bodies that remember, by springs that relax: against integrations and a balance of harmonics of the tests' own."""

from __future__ import annotations

import cmath
import math
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import root

import frictionlab as fl

LINE = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1))
SOLID = fl.Body(relaxation=fl.Relaxation(stiffness=0.5, time=2))
COULOMB, DAHL = fl.Coulomb(mu=0.4), fl.Dahl(mu=0.4, stiffness=4)
ACROSS = fl.Transverse(natural_frequency=0.5, damping_ratio=0.1, load=fl.Load(unbalance=10))


def mean_of(rates: Any, start: Any, period: float, periods: int) -> float:
    """Of the last number, which the rates integrate, over the last of so many periods."""
    state = np.array(start, dtype=float)
    for _ in range(periods):
        state[-1] = 0.0
        state = solve_ivp(rates, (0.0, period), state, method="DOP853", rtol=1e-10, atol=1e-11).y[:, -1]
    return float(-state[-1] / period)


def test_dahl_on_a_standard_linear_solid_is_that_of_another_integration() -> None:
    def rates(tau: float, state: Any) -> list[float]:
        x, v, q, z, _ = state
        slips = v - 5.0
        rub = 4.0 * z
        pull = 10.0 * math.sin(tau) - 0.2 * v - x - q - 10.0 * rub
        return [v, pull, 0.5 * v - q / 2.0, slips - 10.0 * abs(slips) * z, rub]

    state = fl.steady_state(LINE.with_(body=SOLID), DAHL, method="shooting", tolerance=1e-9)

    assert state.status == "ok"
    assert state.error < 1e-9
    assert abs(state.mean_friction - mean_of(rates, np.zeros(5), 2.0 * math.pi, 40)) < 1e-9 + state.error


def test_a_load_across_a_standard_linear_solid_is_that_of_another_integration() -> None:
    def rates(tau: float, state: Any) -> list[float]:
        x, y, v, w, q, _ = state
        speed = math.hypot(v - 5.0, w)
        rub, load = 0.4 * (v - 5.0) / speed, 10.0 * math.sin(tau)
        along = load - 0.2 * v - x - q - 10.0 * rub
        return [v, w, along, load - 0.1 * w - 0.25 * y - 4.0 * w / speed, 0.5 * v - q / 2.0, rub]

    scene = LINE.with_(body=SOLID, transverse=ACROSS)
    state = fl.steady_state(scene, COULOMB, method="shooting", tolerance=1e-9)

    assert state.status == "ok"
    assert state.error < 1e-9
    assert abs(state.mean_friction - mean_of(rates, np.zeros(6), 2.0 * math.pi, 40)) < 1e-9 + state.error


@pytest.mark.parametrize("shaken", [{}, {"belt_vibration": fl.BeltVibration(velocity_amplitude=3, phase=40)}])
def test_coulomb_friction_is_that_of_the_relay_locus(shaken: dict[str, Any]) -> None:
    scene = LINE.with_({"body": SOLID, "normal_load": 20, **shaken})
    speeds = np.array([0.3, 1.0, 4.0, 15.0])
    found, truth = (
        fl.curve(scene, COULOMB, belt_speed=speeds, method=method, tolerance=1e-9, columns="all")
        for method in ("shooting", "relay_locus")
    )

    assert (found["status"] == "ok").all()
    assert found["stick_fraction"].max() > 0.3
    off = np.abs(found["mean_friction"] - truth["mean_friction"])
    assert (off <= found["error"] + truth["error"]).all()
    assert found["error"].max() < 1e-9
    assert found["stick_fraction"].to_numpy() == pytest.approx(truth["stick_fraction"].to_numpy(), abs=1e-8)


@pytest.mark.parametrize("order", [0.1, 0.5, 0.95])
def test_what_a_sum_of_springs_misses_is_within_its_error(order: float) -> None:
    body = fl.Body(fractional=fl.Fractional(coefficient=0.2, order=order))
    speeds = np.array([0.5, 2.0, 8.0, 16.0])
    found, truth = (
        fl.curve(LINE.with_(body=body), COULOMB, belt_speed=speeds, method=method)
        for method in ("shooting", "relay_locus")
    )

    off = np.abs(found["mean_friction"] - truth["mean_friction"])
    assert (off <= found["error"] + truth["error"]).all()
    assert off.max() < 1e-9
    assert found["error"].max() < 1e-6


def balanced_mean(order: float, coefficient: float, harmonics: int = 40, samples: int = 4096) -> float:
    """Of Dahl friction on a fractional body by its receptance: harmonics of motion and friction balanced."""
    angles = 2.0 * np.pi * np.arange(samples) / samples
    k = np.arange(1, harmonics + 1)
    receptance = 1.0 / (1.0 - k**2 + 0.2j * k + coefficient * (1j * k) ** order)
    turns = np.exp(1j * np.outer(angles, k))

    def friction(phasors: Any) -> Any:
        x = (turns @ phasors).real
        way = np.diff(np.append(x, x[0])) - 5.0 * 2.0 * np.pi / samples
        z, deflections = 0.0, np.empty(samples)
        for _ in range(2):
            for i, step in enumerate(way):
                deflections[i] = z
                limit = math.copysign(0.1, step)
                z = limit + (z - limit) * math.exp(-abs(step) / 0.1)
        return 4.0 * deflections

    def missing(numbers: Any) -> Any:
        phasors = numbers[:harmonics] + 1j * numbers[harmonics:]
        forces = -20.0 / samples * (turns.conj().T @ friction(phasors))
        forces[0] += 10.0 * cmath.exp(-0.5j * math.pi)
        wrong = phasors - receptance * forces
        return np.concatenate([wrong.real, wrong.imag])

    free = np.where(k == 1, -10.0j * receptance, 0.0)
    found = root(missing, np.concatenate([free.real, free.imag]), tol=1e-11).x
    return float(-friction(found[:harmonics] + 1j * found[harmonics:]).mean())


def test_dahl_on_a_fractional_body_is_that_of_balanced_harmonics() -> None:
    body = fl.Body(fractional=fl.Fractional(coefficient=0.4, order=0.5))
    state = fl.steady_state(LINE.with_(body=body), DAHL, method="shooting")

    assert state.status == "ok"
    assert state.error < 1e-6
    # with 80 harmonics, or half the samples, the balance differs by about 1e-6
    assert state.mean_friction == pytest.approx(balanced_mean(0.5, 0.4), abs=2e-6)


def test_time_steps_lead_to_the_same_mean() -> None:
    scene = LINE.with_(body=SOLID)
    marched = fl.steady_state(scene, COULOMB, method=fl.March(steps=2000))
    closed = fl.steady_state(scene, COULOMB, method="shooting")

    assert marched.status == "ok"
    assert abs(marched.mean_friction - closed.mean_friction) <= marched.error + closed.error < 1e-3


def test_an_undriven_body_that_remembers_is_refused() -> None:
    scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, body=SOLID)
    state = fl.steady_state(scene, COULOMB, method="shooting")

    assert state.status == "refused"
    assert "needs a drive" in state.reason
