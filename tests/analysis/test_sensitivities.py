"""Derivatives of the mean friction: against differences of steady states, and where there are none."""

from __future__ import annotations

import io
import re
from contextlib import redirect_stdout
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from profiles import deep, some

import frictionlab as fl
from frictionlab.analysis.quotients import Pair
from frictionlab.laws.base import FrictionLaw

SCENE = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1))
STICKS = fl.Scene(
    damping_ratio=0.1, normal_load=10, belt_speed=0.3, drive=fl.Drive(amplitude=6, frequency=0.5)
)
COULOMB, DAHL = fl.Coulomb(mu=0.4), fl.Dahl(mu=0.4, stiffness=4.0)


def _difference(scene: fl.Scene, law: FrictionLaw, path: str, value: float) -> float:
    """Of two steady states over each of three offsets, extrapolated."""
    slopes, size = [], abs(value) or 1.0
    for offset in (2e-3 * size, 1e-3 * size, 5e-4 * size):
        ends = [Pair(scene, law).with_(path, value + side * offset) for side in (1.0, -1.0)]
        means = [fl.steady_state(*end, tolerance=1e-11).mean_friction for end in ends]
        slopes.append((means[0] - means[1]) / (2.0 * offset))
    better = [(4.0 * fine - coarse) / 3.0 for coarse, fine in pairwise(slopes)]
    return (16.0 * better[1] - better[0]) / 15.0


@some(1, "whole curves")
@pytest.mark.parametrize(
    ("scene", "law"),
    [(SCENE, COULOMB), (STICKS, COULOMB), (SCENE, DAHL), (SCENE, fl.Jenkins(mu=0.4, stiffness=4.0))],
)
def test_they_are_the_differences_of_steady_states(scene: fl.Scene, law: FrictionLaw) -> None:
    table = fl.sensitivities(scene, law)
    named = {"scene.damping_ratio", "scene.belt_speed", "scene.drive.frequency", "law.mu"}
    assert named <= {*table.parameter}
    assert (table.reason == "").all()
    assert (table.error < 1e-6).all()
    for row in table.itertuples():
        off = abs(row.derivative - _difference(scene, law, row.parameter, row.value))
        assert off < 1e-6, row.parameter
        assert off <= row.error + 1e-7, row.parameter  # errors of the differences


def test_slip_that_never_reverses_leaves_friction_alone_to_decide() -> None:
    table = fl.sensitivities(SCENE.with_(belt_speed=60), COULOMB).set_index("parameter")
    assert table.derivative["law.mu"] == pytest.approx(1.0, abs=table.error["law.mu"])
    assert table.elasticity["law.mu"] == pytest.approx(1.0, abs=1e-9)
    assert (table.derivative.abs() <= table.error).drop("law.mu").all()
    assert table.error.max() < 1e-8


def test_scales_of_force_and_time_are_arbitrary() -> None:
    by = fl.sensitivities(STICKS, fl.Coulomb(mu=0.4, mu_static=0.5)).set_index("parameter").elasticity
    # the mean coefficient is one of its own scale times a function of coefficient times load ...
    assert by["law.mu"] + by["law.mu_static"] == pytest.approx(1.0 + by["scene.normal_load"], abs=1e-6)
    # ... and all forces and speeds ten times as large leave it as it is
    forces = by["scene.normal_load"] + by["scene.drive.amplitude"]
    assert forces == pytest.approx(-by["scene.belt_speed"], abs=1e-6)


@deep("more kernels to compile")
def test_a_square_load_is_differentiated_from_an_instant_at_which_it_does_not_jump() -> None:
    scene = SCENE.with_(**{"drive.waveform": "square"})
    table = fl.sensitivities(scene, COULOMB, ["scene.drive.phase", "law.mu"]).set_index("parameter")
    assert (table.reason == "").all()
    assert abs(table.derivative["scene.drive.phase"]) <= table.error["scene.drive.phase"] < 1e-9
    assert table.derivative["law.mu"] == pytest.approx(_difference(scene, COULOMB, "law.mu", 0.4), abs=1e-8)


def test_scenes_in_si_units_are_differentiated_by_their_own_numbers() -> None:
    mass = {"mass_kg": 2.0, "stiffness_N_per_m": 800.0, "damping_N_s_per_m": 8.0, "length_m": 0.01}
    drive = {"amplitude_N": 60.0, "frequency_rad_per_s": 25.0}
    si = fl.Scene.si(**mass, belt_speed_m_per_s=0.3, drive=drive)
    path = "scene.dimensional.mass_kg"
    (row,) = fl.sensitivities(si, COULOMB, [path]).itertuples()
    assert abs(row.derivative - _difference(si, COULOMB, path, 2.0)) <= row.error + 1e-8


def test_the_end_of_a_range_is_differentiated_from_within() -> None:
    falling = fl.Stribeck(mu_kinetic=0.4, mu_static=0.4)
    (row,) = fl.sensitivities(STICKS, falling, ["law.mu_static"]).itertuples()
    higher = fl.Stribeck(mu_kinetic=0.4, mu_static=0.4 + 1e-5)
    means = [fl.steady_state(STICKS, law, tolerance=1e-11).mean_friction for law in (falling, higher)]
    assert row.derivative == pytest.approx((means[1] - means[0]) / 1e-5, rel=1e-3)


@pytest.mark.parametrize(
    ("scene", "law"),
    [
        (fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=1), fl.Coulomb(mu=0.4, mu_static=0.5)),
        (fl.Scene(slip={"velocity_amplitude": 2, "frequency": 1}, belt_speed=1), DAHL),
        (SCENE.with_(body={"fractional": {"coefficient": 0.2, "order": 0.5}}), COULOMB),
        (SCENE.with_(damping_ratio=0.0, **{"drive.frequency": 1.3}), COULOMB),
        (SCENE.with_(spring=False, damping_ratio=0.0), COULOMB),
    ],
)
def test_whatever_has_one_mean_is_differentiated(scene: fl.Scene, law: FrictionLaw) -> None:
    (row,) = fl.sensitivities(scene, law, ["law.mu"]).itertuples()
    assert row.reason == ""
    assert abs(row.derivative - _difference(scene, law, "law.mu", 0.4)) <= row.error + 1e-6


def test_a_mass_that_may_rest_anywhere_has_none_and_a_load_across_that_is_zero_a_derivative_of_zero() -> None:
    held = STICKS.with_(belt_speed=0.0, **{"drive.amplitude": 1})
    scene = SCENE.with_(transverse={"natural_frequency": 2, "damping_ratio": 0.1, "load": {"unbalance": 0}})
    (open_one,) = fl.sensitivities(held, COULOMB, ["law.mu"]).itertuples()
    (across,) = fl.sensitivities(scene, COULOMB, ["scene.transverse.load.unbalance"]).itertuples()
    assert "no steady state with one mean" in open_one.reason
    assert np.isnan(open_one.derivative)
    assert abs(across.derivative) <= across.error < 1e-7


@pytest.mark.parametrize(
    ("parameters", "error", "told"),
    [
        (["law.my"], ValueError, "did you mean 'law.mu'"),
        (["scene.drive.amplitude"], ValueError, "no number 'scene.drive.amplitude'"),
        ("law.mu", TypeError, r"a list such as \['law.mu'"),
    ],
)
def test_mistakes_are_told(parameters: object, error: type[Exception], told: str) -> None:
    with pytest.raises(error, match=told):
        fl.sensitivities(SCENE, COULOMB, parameters)  # type: ignore[arg-type]


@deep("seconds of derivatives")
def test_the_page_shows_what_happens() -> None:
    page = (Path(__file__).parents[2] / "docs" / "needs.md").read_text()
    code, shown = re.findall(r"```(?:python|text)\n(.*?)```", page, re.DOTALL)[:2]
    printed = io.StringIO()
    with redirect_stdout(printed):
        exec(code, {})
    for line, told in zip(shown.splitlines(), printed.getvalue().splitlines(), strict=True):
        # the derivative by the phase is nothing but rounding
        assert line.split()[:3] == told.split()[:3] or "phase" in line
