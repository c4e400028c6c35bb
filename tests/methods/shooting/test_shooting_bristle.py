"""Shooting on bristles along the belt: unrelated references, every stiffness, reversals, states not unique."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from answered import with_columns
from profiles import deep, some
from resonance import bristles_of

import frictionlab as fl
from frictionlab.laws.memory import BristleLaw
from frictionlab.methods.base import Answers
from frictionlab.methods.shooting.method import Shooting

REFERENCE = Path(__file__).parents[2] / "reference"
BENCHMARKS = Path(__file__).parents[2] / "benchmarks"
W4 = pd.read_csv(REFERENCE / "bristle_w4.csv")
MORE = pd.read_csv(REFERENCE / "bristle_more.csv")


def scenes(belt_speeds: np.ndarray, normal_load: float = 10.0, frequency: float = 1.0) -> list[fl.Scene]:
    drive = fl.Drive(unbalance=10.0, frequency=frequency)
    return [
        fl.Scene(damping_ratio=0.1, normal_load=normal_load, belt_speed=speed, drive=drive)
        for speed in belt_speeds
    ]


def compared(answers: Answers, expected: np.ndarray, accuracy: np.ndarray | float, tolerance: float) -> None:
    """Every answer is there, within its error, and its error within the tolerance."""
    assert set(answers.status) == {"ok"}
    errors = answers.columns["error"]
    assert (errors <= tolerance).all()
    assert (np.abs(answers.columns["mean_friction"] - expected) <= errors + accuracy).all()


@pytest.mark.parametrize("tolerance", [1e-4, 1e-6, 1e-8, 1e-9])
@pytest.mark.parametrize("workload", ["W4a", "W4b", "W4c", "W4d"])
def test_stiff_bristles_are_true_to_the_reference_at_every_tolerance(workload: str, tolerance: float) -> None:
    rows = W4[W4["workload"] == workload].sort_values("belt_speed")
    answers = with_columns(Shooting(), scenes(rows["belt_speed"]), bristles_of(rows.iloc[0]), tolerance)
    compared(answers, rows["mean_friction"].to_numpy(), rows["accuracy"].to_numpy(), tolerance)


def test_falling_and_elasto_plastic_bristles_are_true_to_the_reference() -> None:
    rows = MORE[MORE["omega_r"] == "none"].reset_index(drop=True)
    keys = ["kind", "mu_kinetic", "mu_static", "stribeck_speed", "presliding_length", "damping"]
    for _, curve in rows.groupby(keys, dropna=False):
        curve = curve.sort_values("belt_speed")
        law = bristles_of(curve.iloc[0])
        if isinstance(law, fl.LuGre) and law.stribeck_speed == 1.0:
            curve = curve.iloc[-1:]  # falls too fast for one start to do: every point asks four
        answers = with_columns(Shooting(), scenes(curve["belt_speed"]), law, 1e-8)
        ok = np.array([status == "ok" for status in answers.status])
        low, high = answers.columns["mean_low"], answers.columns["mean_high"]
        mean, error, expected = (
            answers.columns["mean_friction"],
            answers.columns["error"],
            curve["mean_friction"],
        )
        assert ((np.abs(mean - expected) <= error + 1e-11) | ~ok).all()
        # where starts disagree, the reference orbit is one of what they reach
        assert (((low - 1e-6 <= expected) & (expected <= high + 1e-6)) | ok).all()
        assert ok.all() or isinstance(law, fl.LuGre)


def test_no_stiffness_is_too_high_or_too_low() -> None:
    speeds = np.array([5.0, 20.0, 40.0])
    coulomb = [fl.steady_state(scene, fl.Coulomb(mu=0.4)).mean_friction for scene in scenes(speeds)]
    gaps = []
    for exponent in range(-8, 3):
        law = fl.Dahl(mu=0.4, presliding_length=10.0**exponent)
        answers = with_columns(Shooting(), scenes(speeds), law, 1e-7)
        assert set(answers.status) == {"ok"}
        gaps.append(float(np.abs(answers.columns["mean_friction"] - coulomb).max()))
    assert gaps[0] < 2e-6
    assert gaps[-1] > 0.04


def test_a_bristle_that_never_yields_on_a_belt_at_rest_has_no_mean_of_its_own() -> None:
    scene = fl.Scene(
        damping_ratio=0.1, normal_load=10.0, belt_speed=0.0, drive=fl.Drive(amplitude=1.0, frequency=0.5)
    )
    answers = with_columns(Shooting(), [scene], fl.Jenkins(mu=0.4, presliding_length=1.0), 1e-7)
    assert answers.status == ["not_unique"]
    stroke = 1.0 / abs(1.0 + 4.0 - 0.25 + 0.1j)  # that of a linear body that is stiffer by the bristle
    most = 0.4 * (1.0 - stroke)
    assert (answers.columns["mean_low"][0], answers.columns["mean_high"][0]) == pytest.approx((-most, most))
    assert answers.columns["velocity_amplitude"][0] == pytest.approx(0.5 * stroke, rel=1e-7)
    assert abs(answers.columns["energy_contact"][0]) <= answers.columns["energy_contact_error"][0] < 1e-5
    drifts = with_columns(Shooting(), [scene], fl.Dahl(mu=0.4, presliding_length=1.0), 1e-7)
    assert drifts.status == ["ok"]
    assert abs(drifts.columns["mean_friction"][0]) <= drifts.columns["error"][0]


@deep("eighteen starts on stiff bristles")
def test_a_steep_fall_on_stiff_bristles_responds_as_without_them() -> None:
    """S11: four drive periods."""
    scene = fl.Scene(
        damping_ratio=0.01,
        normal_load=10.0,
        belt_speed=0.3,
        drive=fl.Drive(amplitude=0.2 * 1.3**2, frequency=1.3),
    )
    law = fl.LuGre(mu_kinetic=0.2, mu_static=0.4, stribeck_exponent=1.0, presliding_length=1e-3, damping=0.01)
    answers = with_columns(Shooting(), [scene], law, 1e-7)
    assert answers.status == ["ok"]
    assert answers.columns["period"][0] == 4.0
    found = re.search(r"has means over one from (\S+) to (\S+),", answers.reason[0])
    low, high = float(found[1]), float(found[2])
    assert abs(low - 0.0727) < 2e-3  # the law without bristles: 0.0727 to 0.3165
    assert abs(high - 0.3165) < 3e-3


def test_soft_damped_bristles_can_double_the_period() -> None:
    frequency, damping_ratio = 2.94, 0.0058
    swing = frequency / abs(complex(1 - frequency**2, 2 * damping_ratio * frequency))
    scene = fl.Scene(
        damping_ratio=damping_ratio,
        normal_load=6.84,
        belt_speed=0.8575 * swing,
        drive=fl.Drive(amplitude=1.0, frequency=frequency),
    )
    answers = with_columns(
        Shooting(), [scene], fl.LuGre(mu_kinetic=0.4, presliding_length=1.37, damping=0.074), 1e-7
    )
    assert answers.status == ["ok"]
    assert answers.columns["period"][0] == 2.0
    assert answers.columns["floquet"][0] < 1.0


@deep("seconds of maps")
def test_a_motion_that_still_alternates_on_its_way_to_one_period_is_not_taken_for_two() -> None:
    """Close to doubling the multiplier is near -1: two periods ahead the motion looks the same long before it is."""
    law = fl.LuGre(mu_kinetic=0.4, presliding_length=10.0, contact_damping=2.0).under_load(10.0)
    answers = with_columns(Shooting(), scenes(np.array([11.0]), frequency=1.5), law, 1e-6)
    assert answers.status == ["ok"]
    assert answers.columns["period"][0] == 1.0
    assert answers.columns["floquet"][0] == pytest.approx(0.99372, abs=1e-5)


@some(2, "whole curves")
@pytest.mark.parametrize("workload", ["W4a", "W4b", "W4c", "W4d", "W4_0.5", "W4_5e-06"])
def test_errors_cover_along_whole_curves(workload: str) -> None:
    """Against collocation (tests/benchmarks), known to 1e-12."""
    curve = pd.read_csv(BENCHMARKS / f"bristle_{workload}.csv")
    kinds = {"W4a": 5e-2, "W4b": 5e-4, "W4c": 5e-2, "W4d": 5e-4, "W4_0.5": 0.5, "W4_5e-06": 5e-6}
    law: BristleLaw = fl.LuGre(mu_kinetic=0.4, damping=4e-4, presliding_length=kinds[workload])
    if workload in ("W4c", "W4d"):
        law = fl.Dahl(mu=0.4, presliding_length=kinds[workload])
    for tolerance in (1e-5, 1e-6, 1e-7):
        answers = with_columns(Shooting(), scenes(curve["belt_speed"].to_numpy()), law, tolerance)
        compared(answers, curve["mean_friction"].to_numpy(), 1e-12, tolerance)


def test_an_error_is_judged_with_the_derivative_at_the_orbit_and_not_one_of_states_passed_before() -> None:
    drive = fl.Drive(amplitude=2.7073789880102015, frequency=1.4771137152980933, phase=30.702428808464994)
    scene = fl.Scene(
        damping_ratio=0.3437022511713936,
        normal_load=26.32933412098672,
        belt_speed=0.7346841787119447,
        drive=drive,
    )
    law = fl.ElastoPlastic(
        mu_kinetic=0.4137753901361184, stiffness=221.76349900884185, breakaway_ratio=0.6220427078927453
    )
    brute_force = 0.37730518566

    for tolerance in (1e-3, 1e-4, 1e-5, 1e-6, 1e-7):
        state = fl.steady_state(scene, law, method="shooting", tolerance=tolerance)
        assert abs(state.mean_friction - brute_force) <= state.error + 1e-11
        assert state.error <= tolerance


@pytest.mark.parametrize(
    ("damping", "load", "speed", "amplitude", "frequency", "mu", "length"),
    [
        (
            0.18151428097248495,
            1.7353739724183828,
            0.342558546208412,
            18.210235200084423,
            1.3971204210263073,
            0.9320728078994559,
            0.05732553871494956,
        ),
        (
            0.31795923268800197,
            0.12209010559355726,
            0.14652891933343845,
            14.599267991291049,
            2.266956542623818,
            0.9508917191521107,
            1.2409786907162685,
        ),
    ],
)
def test_loose_tolerances_state_errors_that_cover_corners_of_friction_that_steps_miss(
    damping: float, load: float, speed: float, amplitude: float, frequency: float, mu: float, length: float
) -> None:
    """Found at random, one in a thousand: two maps agreed to less than either was off."""
    drive = fl.Drive(amplitude=amplitude, frequency=frequency)
    scene = fl.Scene(damping_ratio=damping, normal_load=load, belt_speed=speed, drive=drive)
    law = fl.ElastoPlastic(mu_kinetic=mu, presliding_length=length)
    fine = fl.steady_state(scene, law, method="shooting", tolerance=1e-10)

    for tolerance in (1e-3, 1e-4, 1e-5):
        state = fl.steady_state(scene, law, method="shooting", tolerance=tolerance)
        assert abs(state.mean_friction - fine.mean_friction) <= state.error + fine.error


def test_friction_that_begins_within_rounding_of_its_limit_reaches_it_once() -> None:
    drive = fl.Drive(amplitude=10.332913485240994, frequency=0.4716048960417302, phase=3.04427042833868)
    scene = fl.Scene(
        damping_ratio=0.019769936226340757,
        normal_load=1.0359981415202357,
        belt_speed=1.7300261101377998,
        drive=drive,
    )
    law = fl.Jenkins(mu=0.38048274228969603, stiffness=2.316657022174747)

    for tolerance in (1e-4, 6.576885527660651e-06, 1e-8):
        state = fl.steady_state(scene, law, method="shooting", tolerance=tolerance)
        assert state.status == "ok"
        assert state.mean_friction == pytest.approx(0.05392415, abs=tolerance + 1e-8)  # brute force


@deep("seconds of starts")
def test_an_orbit_that_repels_is_no_answer_of_a_body_that_may_move_across_the_belt() -> None:
    """Its largest multiplier is 3.1, and the multipliers across the belt, which are smaller, are not asked for."""
    scene = fl.Scene(
        damping_ratio=0.0866049399867431,
        normal_load=0.8774330354297314,
        belt_speed=-0.0030505382488509284,
        transverse={"natural_frequency": 0.8613522280868648, "damping_ratio": 0.21910837297108604},
        normal_load_variation={
            "waveform": "sawtooth",
            "phase": 12.429906663213956,
            "amplitude": 0.41443009736162306,
            "frequency": 3.7041712808142857,
            "contact": "constant",
        },
    )
    law = fl.ElastoPlastic(
        mu_kinetic=0.13769413718254842,
        breakaway_ratio=0.7031641756505305,
        presliding_length=7.551923770312644e-06,
        damping=4.513765307955565,
    )

    state = fl.steady_state(scene, law)

    assert abs(state.mean_friction - -0.118131108) > 10.0 * state.error  # the mean of that orbit


@pytest.mark.parametrize("tolerance", [1e-5, 1e-6, 5e-7, 1e-7])
def test_the_layer_after_a_reversal_is_not_passed_in_one_step_that_seems_exact(tolerance: float) -> None:
    """Found at random: maps of two accuracies agreed to 3e-10, both 4e-8 off in the layer."""
    scene = fl.Scene(
        damping_ratio=0.2487779453056568,
        normal_load=107.5938382561669,
        belt_speed=28.78139268177265,
        drive=fl.Drive(amplitude=68.96230366392348, phase=262.47097753883526, frequency=1.4455318085738338),
    )
    law = fl.Dahl(mu=0.21570801037813447, presliding_length=0.028157999408187733, exponent=1.9345098511021104)
    compared(
        with_columns(Shooting(), [scene], law, tolerance), 0.0745405342, 1e-10, tolerance
    )  # scipy's LSODA at 1e-11


def test_a_soft_contact_slides_on_or_reverses_on_one_belt() -> None:
    """Beyond the vibration speed constant friction lets slip go on without reversal; contact resonance may not."""
    scene = fl.Scene(
        damping_ratio=0.0348,
        normal_load=505.75868775,
        belt_speed=40.52301704501663,  # 1.047 times the friction-free velocity amplitude
        drive=fl.Drive(unbalance=10.0, frequency=3.567),
    )
    both = with_columns(
        Shooting(), [scene], fl.Dahl(mu=0.4, contact_stiffness=30.0).under_load(scene.normal_load), 1e-7
    )
    assert both.status == ["not_unique"]
    assert both.columns["mean_high"][0] == pytest.approx(0.4, abs=1e-9)
    assert both.columns["mean_low"][0] == pytest.approx(0.30541, abs=2e-5)  # Runge-Kutta steps, 1500 a period
    one = with_columns(
        Shooting(), [scene], fl.Dahl(mu=0.4, contact_stiffness=15.0).under_load(scene.normal_load), 1e-7
    )
    assert one.status == ["ok"]
    assert one.columns["mean_friction"][0] == pytest.approx(0.4, abs=1e-9)


def test_vectors_are_refused_where_they_mean_nothing() -> None:
    drive = fl.Drive(unbalance=10.0, frequency=1.0)
    across = fl.Transverse(natural_frequency=2.0, damping_ratio=0.1, load=fl.Load(unbalance=10.0))
    planar = fl.Scene(damping_ratio=0.1, normal_load=1.0, belt_speed=5.0, drive=drive, transverse=across)
    square = fl.Dahl(mu=0.4, presliding_length=1.0, exponent=2.0)
    assert "exponent 1" in str(Shooting().refusal(planar, square))
    assert Shooting().refusal(planar, square.model_copy(update={"planar": "per-axis"})) is None
    undriven = fl.Scene(damping_ratio=0.1, normal_load=1.0, belt_speed=5.0)
    assert Shooting().refusal(undriven, square) is None
