"""Bodies by their receptance under friction that remembers: against integrations and the maps of known bodies."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from profiles import deep, some
from scipy.integrate import solve_ivp

import frictionlab as fl
from frictionlab.methods.periodic.problem import PeriodicProblem, largest_modulus
from frictionlab.methods.shooting import by_receptance, pseudo_force
from frictionlab.methods.shooting.by_receptance import (
    ATTRACTS,
    FALLS,
    HALF_UNBALANCED,
    RESTS,
    UNBALANCED,
    UNSTABLE,
    BalancedCurve,
)
from frictionlab.scene.receptance import linear_body

DAHL = fl.Dahl(mu=0.4, stiffness=4)
LUGRE = fl.LuGre(mu_kinetic=0.4, stiffness=4, damping=0.05)
FALLING = fl.LuGre(mu_kinetic=0.4, mu_static=0.6, stribeck_speed=10, stiffness=4)
DUPONT = fl.ElastoPlastic(mu_kinetic=0.4, stiffness=4)
MASS, SPRING, DASHPOT = 0.5, 1.0, 0.3
"""Of a second body on the one that rubs, on a spring and a dashpot like this."""
LINE = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1))


def one_mode(omega: Any) -> Any:
    return 1.0 / (1.0 - omega**2 + 0.2j * omega)


def two_modes(omega: Any) -> Any:
    p = 1j * omega
    held = SPRING + DASHPOT * p
    return 1.0 / (p**2 + DASHPOT * p + 1.0 + held - held**2 / (MASS * p**2 + held))


def measured(folder: Path, answer: Callable[[Any], Any], count: int, last: float = 300.0) -> fl.Scene:
    omega = np.concatenate([np.linspace(0.0, 6.0, count), np.geomspace(6.0, last, count)[1:]])
    rows = [
        f"{a!r},{b.real!r},{b.imag!r}" for a, b in zip(omega.tolist(), answer(omega).tolist(), strict=True)
    ]
    file = folder / "h.csv"
    file.write_text("\n".join(["frequency,real,imaginary", *rows]) + "\n")
    body = fl.Body(receptance=fl.Receptance(file=str(file), free_mass=1))
    return fl.Scene(normal_load=10, belt_speed=5, drive=fl.Drive(amplitude=10, frequency=1), body=body)


def integrated(law: Any, belt_speed: float, periods: int = 30) -> float:
    """The mean friction on two bodies, by time steps of the tests' own."""

    def rates(tau: float, state: Any) -> list[float]:
        x, v, y, w, z, _ = state
        dz = law.rate(v - belt_speed, z)
        rub = law.friction(v - belt_speed, z, dz)
        held = SPRING * (x - y) + DASHPOT * (v - w)
        return [v, 10.0 * math.sin(tau) - DASHPOT * v - x - held - 10.0 * rub, w, held / MASS, dz, rub]

    state = np.zeros(6)
    for _ in range(periods):
        state[-1] = 0.0
        state = solve_ivp(rates, (0.0, math.tau), state, method="DOP853", rtol=1e-10, atol=1e-12).y[:, -1]
    return float(-state[-1] / math.tau)


@deep("seconds of balances")
@pytest.mark.parametrize(("law", "belt_speed"), [(DAHL, 2.0), (LUGRE, 5.0)])
def test_two_bodies_by_a_table_are_those_of_another_integration(
    tmp_path: Path, law: fl.FrictionLaw, belt_speed: float
) -> None:
    state = fl.steady_state(measured(tmp_path, two_modes, 1500).with_(belt_speed=belt_speed), law)

    assert state.status == "ok"
    assert state.error < 1e-8
    assert "balanced force (auto: shooting, beyond relay locus)" in state.model
    assert abs(state.mean_friction - integrated(law, belt_speed)) < 1e-9 + state.error


@some(1, "a second each")
@pytest.mark.parametrize("law", [DAHL, LUGRE, DUPONT])
def test_a_table_of_a_mass_on_a_spring_is_that_of_its_maps(tmp_path: Path, law: fl.FrictionLaw) -> None:
    scene = measured(tmp_path, one_mode, 60)
    found = fl.steady_state(scene, law, method="shooting")
    truth = fl.steady_state(LINE, law, method="shooting")

    assert found.status == truth.status == "ok"
    assert found.error < 1e-8
    assert abs(found.mean_friction - truth.mean_friction) <= found.error + truth.error
    ours, theirs = found.orbit(64), truth.orbit(64)
    for name in ("x1", "v1"):
        assert ours[name].to_numpy() == pytest.approx(theirs[name].to_numpy(), abs=1e-5)


@deep("more kernels to compile")
def test_springs_fitted_to_a_fractional_element_are_as_far_from_it_as_they_say() -> None:
    scene = LINE.with_(body=fl.Body(fractional=fl.Fractional(coefficient=0.4, order=0.5)))
    springs = fl.steady_state(scene, DAHL, method="shooting")
    (mean,), (error,) = (
        np.asarray(each) for each in _mean_and_error(BalancedCurve([scene], DAHL, 1e-8, linear_body(scene)))
    )

    assert error < 1e-8
    assert abs(springs.mean_friction - mean) <= springs.error + error < 1e-6


def _mean_and_error(curve: BalancedCurve) -> tuple[Any, Any]:
    return curve.answers().mean, curve.answers().error


@deep("seconds of balances")
def test_a_coarse_table_is_as_far_from_the_body_as_it_says(tmp_path: Path) -> None:
    found = fl.steady_state(measured(tmp_path, two_modes, 150), DAHL, method="shooting")
    fine = fl.steady_state(measured(tmp_path, two_modes, 1500), DAHL, method="shooting")

    assert found.status == "ok"
    assert "the table is too coarse for less" in found.reason
    off = abs(found.mean_friction - fine.mean_friction)
    assert 1e-8 < off <= found.error + fine.error < 1e-3


@deep("seconds of balances")
def test_only_a_motion_that_attracts_is_an_answer_where_friction_falls() -> None:
    drive = fl.Drive(amplitude=10, frequency=0.6)
    scene = fl.Scene(damping_ratio=0.01, normal_load=10, belt_speed=3, drive=drive)
    scenes = [scene, scene.at(15.0), scene.at(40.0)]
    found = BalancedCurve(scenes, FALLING, 1e-7, linear_body(scene)).answers()
    problem = PeriodicProblem(scene, FALLING, 1e-7)
    closed = [problem.close([each])[0] for each in scenes]

    leave = [bool(largest_modulus(each.matrices)[0] > 1.0) for each in closed]
    assert leave == [False, True, False]
    assert found.status == ["ok", "failed", "ok"]
    assert found.reason == [ATTRACTS, UNSTABLE, ATTRACTS]
    means = np.array([each.closed.mean[0] for each in closed])
    assert found.mean[[0, 2]] == pytest.approx(means[[0, 2]], abs=1e-7)


def test_where_one_start_leads_nowhere_another_is_taken(monkeypatch: pytest.MonkeyPatch) -> None:
    balanced = pseudo_force.Balancing.found

    def found(self: Any, start: Any) -> Any:
        free = isinstance(start, np.ndarray) and np.array_equal(start, self.without_friction())
        return None if free else balanced(self, start)

    monkeypatch.setattr(pseudo_force.Balancing, "found", found)
    answers = BalancedCurve([LINE], DAHL, 1e-6, linear_body(LINE)).answers()

    assert answers.status == ["ok"]


@deep("seconds of balances")
@pytest.mark.parametrize(("told", "status"), [((0.77, 0.02), "ok"), ((0.77, 0.98), "failed")])
def test_stability_is_told_by_as_many_harmonics_as_tell_it(
    monkeypatch: pytest.MonkeyPatch, told: tuple[float, ...], status: str
) -> None:
    answers = iter(told)
    monkeypatch.setattr(by_receptance, "growing_changes", lambda *given: next(answers))

    assert BalancedCurve([LINE], DAHL, 1e-6, linear_body(LINE)).answers().status == [status]


@deep("seconds of balances")
def test_a_mean_that_hangs_on_the_start_is_left_open() -> None:
    drive = fl.Drive(unbalance=10, frequency=3.567)
    scene = fl.Scene(damping_ratio=0.0348, normal_load=505.75868775, belt_speed=35, drive=drive)
    law = fl.Dahl(mu=0.4, contact_stiffness=30).under_load(505.75868775)
    found = BalancedCurve([scene, scene.at(40.5)], law, 1e-6, linear_body(scene)).answers()

    assert found.status == ["ok", "not_unique"]
    assert found.mean[0] == pytest.approx(0.25035922, abs=1e-6)
    assert found.mean_low is not None
    assert found.mean_high is not None
    # an orbit of the body's own maps, and sliding on
    assert (found.mean_low[1], found.mean_high[1]) == pytest.approx((0.3050024, 0.4), abs=1e-4)


@pytest.mark.parametrize(
    ("change", "law", "said"),
    [
        ({}, fl.Stribeck(mu_kinetic=0.4, mu_static=0.5), FALLS),
        ({"normal_load_variation": fl.NormalLoadVariation(amplitude=0.1)}, FALLING, FALLS),
        ({"belt_speed": 0}, DAHL, RESTS),
        ({"drive.frequency": 0.005}, DAHL, "swings by itself up to harmonic"),
        ({"drive": None}, DAHL, "needs a drive"),
        ({"body.receptance.free_mass": None}, DAHL, "give body.receptance.free_mass"),
        ({"transverse": fl.Transverse(natural_frequency=1, damping_ratio=0.1)}, DAHL, "along one line"),
    ],
)
def test_what_a_receptance_does_not_tell_is_refused(
    tmp_path: Path, change: dict[str, Any], law: fl.FrictionLaw, said: str
) -> None:
    reason = fl.Shooting().refusal(measured(tmp_path, one_mode, 60).with_(change), law)

    assert reason is not None
    assert said in reason


@deep("seconds of balances")
@pytest.mark.parametrize(("halved", "said"), [(False, UNBALANCED), (True, HALF_UNBALANCED)])
def test_where_nothing_balances_there_is_no_number(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, halved: bool, said: str
) -> None:
    balanced = pseudo_force.Balancing.found

    def found(self: Any, start: Any) -> Any:
        every_other = len(self.mass.body.frequency) < 100
        return None if every_other is halved else balanced(self, start)

    monkeypatch.setattr(pseudo_force.Balancing, "found", found)
    state = fl.steady_state(measured(tmp_path, one_mode, 60), DAHL, method="shooting")

    assert (state.status, state.reason) == ("failed", said)
    assert math.isnan(state.mean_friction)
