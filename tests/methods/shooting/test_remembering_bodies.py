"""Bodies that remember, by springs that relax: against integrations and a balance of harmonics of the tests' own."""

from __future__ import annotations

import cmath
import math
from typing import Any

import numpy as np
import pytest
from profiles import deep
from scipy.integrate import solve_ivp
from scipy.optimize import root

import frictionlab as fl

LINE = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1))
pytestmark = deep("more kernels to compile")
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


SQUEAKS = fl.Scene(damping_ratio=0.02, normal_load=2, belt_speed=0.3, body=SOLID)
FALLS = {"mu_kinetic": 0.2, "mu_static": 0.6, "stribeck_speed": 0.5}


def falling(speed: float) -> float:
    """The coefficient of steady sliding."""
    return 0.2 + 0.4 * math.exp(-((speed / 0.5) ** 2))


def test_an_undriven_standard_linear_solid_swings_as_another_integration_does() -> None:
    def rates(tau: float, state: Any) -> list[float]:
        x, v, q, z, _ = state
        slips = v - 1.0
        bends = slips - 40.0 * abs(slips) / falling(abs(slips)) * z
        rub = 40.0 * z + 0.1 * bends
        return [v, -0.04 * v - x - q - 2.0 * rub, 0.5 * v - q / 2.0, bends, rub]

    def largest(tau: float, state: Any) -> float:
        return float(state[1])

    turned: Any = largest
    turned.direction = -1.0
    way = solve_ivp(
        rates, (0.0, 160.0), [0.0, 1.0, 0.0, 0.0, 0.0], "DOP853", events=turned, rtol=1e-9, atol=1e-11
    )
    tau, states = way.t_events[0], way.y_events[0]
    found = fl.steady_state(
        SQUEAKS.at(1.0), fl.LuGre(**FALLS, stiffness=40, damping=0.1), method="shooting", tolerance=1e-8
    )

    assert (found.status, found.model) == ("ok", "undriven stick-slip")
    assert 2.0 * math.pi * found.period == pytest.approx(tau[-1] - tau[-2], rel=1e-6)
    assert found.mean_friction == pytest.approx(
        -(states[-1, -1] - states[-2, -1]) / (tau[-1] - tau[-2]), abs=1e-6
    )
    assert found.energy_viscous + found.energy_friction == pytest.approx(0.0, abs=1e-9)


def test_an_undriven_standard_linear_solid_sticks_and_slips_as_another_integration_does() -> None:
    def slips(tau: float, state: Any) -> list[float]:
        x, v, q, _ = state
        rub = math.copysign(falling(abs(v - 0.3)), v - 0.3)
        return [v, -0.04 * v - x - q - 2.0 * rub, 0.5 * v - q / 2.0, rub]

    def stuck(tau: float, state: Any) -> list[float]:
        x, _, q, _ = state
        return [0.3, 0.0, 0.15 - q / 2.0, -(0.04 * 0.3 + x + q) / 2.0]

    ends: list[Any] = [
        lambda tau, state: state[1] - 0.3,
        lambda tau, state: 0.04 * 0.3 + state[0] + state[2] - 2.0 * 0.6,
    ]
    for each in ends:
        each.terminal, each.direction = True, 1.0
    tau, state, releases = 0.0, np.array([0.0, 0.3, 0.0, 0.0]), []
    for _ in range(12):
        rest = solve_ivp(stuck, (tau, tau + 99.0), state, "DOP853", events=ends[1], rtol=1e-11, atol=1e-12)
        releases.append((rest.t[-1], rest.y[-1, -1]))
        start = rest.y[:, -1] - [0.0, 1e-11, 0.0, 0.0]
        slip = solve_ivp(
            slips, (rest.t[-1], rest.t[-1] + 99.0), start, "DOP853", events=ends[0], rtol=1e-11, atol=1e-12
        )
        tau, state = slip.t[-1], slip.y[:, -1]
        state[1] = 0.3
    (before, some), (last, more) = releases[-2:]
    found = fl.steady_state(SQUEAKS, fl.Stribeck(**FALLS), method="shooting", tolerance=1e-9)

    assert (found.status, found.model) == ("ok", "undriven stick-slip")
    assert 2.0 * math.pi * found.period == pytest.approx(last - before, rel=1e-7)
    assert found.mean_friction == pytest.approx(-(more - some) / (last - before), abs=1e-7)


@pytest.mark.parametrize("time", [0.3, 2.0, 8.0])
def test_an_undriven_standard_linear_solid_slides_where_its_roots_decay(time: float) -> None:
    """From next to steady sliding, on belts so fast that friction falls a little less, or more, than they bear."""
    body = fl.Body(relaxation=fl.Relaxation(stiffness=0.5, time=time))

    def grows(speed: float) -> float:
        slope = 2.0 * (falling(speed + 1e-6) - falling(speed - 1e-6)) / 2e-6
        flow = [[0.0, 1.0, 0.0], [-1.0, -0.04 - slope, -1.0], [0.0, 0.5, -1.0 / time]]
        return float(np.linalg.eigvals(np.array(flow)).real.max())

    slow, fast = 0.5, 3.0  # where they begin to bear it
    for _ in range(40):
        slow, fast = (
            (0.5 * (slow + fast), fast) if grows(0.5 * (slow + fast)) > 0.0 else (slow, 0.5 * (slow + fast))
        )
    found = []
    for share in (0.97, 1.03):
        scene = SQUEAKS.with_(body=body, belt_speed=share * slow)
        x = 2.0 * falling(share * slow) + 1e-3
        found.append(
            fl.steady_state(
                scene.with_(initial={"x": x, "velocity": 0}), fl.Stribeck(**FALLS), method="shooting"
            )
        )

    assert [each.status for each in found] == ["ok", "ok"]
    assert found[0].model != "undriven sliding" == found[1].model


@pytest.mark.parametrize(
    ("numbers", "speed", "turns", "mean"),
    [
        # the cycle of one swing, to which the start comes near, repels: it has a multiplier of -1.27
        (
            (0.0163264, 0.9474185, 4.7008915, 0.0689912, 0.3759744, 0.5505735, 15.1942704, 0.0247521),
            1.5627169,
            12.18564,
            0.2435037,
        ),
        # three swings come back more nearly than one, on the way
        (
            (0.0218132, 2.0383511, 1.2876737, 0.0957784, 0.6096817, 0.5082522, 22.7973423, 0.0532792),
            0.1771012,
            8.46727,
            0.4173390,
        ),
    ],
)
def test_an_undriven_cycle_is_one_that_attracts_once_round(
    numbers: tuple[float, ...], speed: float, turns: float, mean: float
) -> None:
    """Periods and means of LSODA and DOP853 of scipy, of the last of 600 time units and more."""
    damping, load, time, stiffness, fall, static, bristle, loss = numbers
    body = fl.Body(relaxation=fl.Relaxation(stiffness=stiffness, time=time))
    law = fl.LuGre(mu_kinetic=0.2, mu_static=static, stribeck_speed=fall, stiffness=bristle, damping=loss)
    scene = fl.Scene(damping_ratio=damping, normal_load=load, belt_speed=speed, body=body)
    found = fl.steady_state(scene, law, method="shooting")

    assert found.status == "ok"
    assert found.floquet < 1.0
    assert 2.0 * math.pi * found.period == pytest.approx(turns, rel=1e-5)
    assert found.mean_friction == pytest.approx(mean, abs=2e-6)


def test_an_undriven_body_is_refused_where_its_memory_has_no_end() -> None:
    power = SQUEAKS.with_(body=fl.Body(fractional=fl.Fractional(coefficient=0.2, order=0.5)))
    at_rest = SQUEAKS.with_(belt_speed=0, initial={"x": 1, "velocity": 0})

    for scene, said in ((power, "needs a drive"), (at_rest, "as long as that relaxes")):
        state = fl.steady_state(scene, COULOMB, method="shooting")
        assert state.status == "refused"
        assert said in state.reason
    assert fl.steady_state(SQUEAKS.at(0.0), COULOMB, method="shooting").mean_friction == 0.0
