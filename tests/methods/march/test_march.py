"""Time stepping to the steady state against unrelated methods and closed forms, and its error against the truth."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from answered import with_columns
from hypothesis import given
from hypothesis import strategies as st
from profiles import deep, some
from resonance import at_resonance as scene
from strategies import scenes_in_the_plane, scenes_on_the_line

from frictionlab.laws.coulomb import Coulomb
from frictionlab.laws.stribeck import Stribeck
from frictionlab.methods.base import refused
from frictionlab.methods.exact.method import Exact
from frictionlab.methods.march.method import March
from frictionlab.methods.march.run import MarchRun
from frictionlab.methods.march.steppers import Resolution
from frictionlab.methods.shooting.method import Shooting
from frictionlab.motion.orbit.read import read_columns
from frictionlab.scene.scene import Drive, Initial, Scene, Transverse
from frictionlab.values.notes import WrongValues

LAW = Coulomb(mu=0.4)
LEINE = Stribeck(curve="hyperbolic", mu_static=1.0, mu_kinetic=0.0, stribeck_speed=1.0 / 3.0)
BLOCK = Scene(damping_ratio=0.0, normal_load=1.0, belt_speed=0.2)
FALLING = Stribeck(mu_kinetic=0.2, mu_static=0.4, stribeck_speed=1.0, stribeck_exponent=1.0)
PERIOD = 12.001031294830
"""Of Leine's block [time]; ``period`` holds it over 2 pi."""


def solve(scenes, law=LAW, tolerance=1e-4, **keys):
    return with_columns(March(**keys), scenes, law, tolerance)


def covered(answers, expected, known_to=1e-10):
    """Whether every mean is as near to the truth as it says."""
    error = answers.columns["error"]
    return bool(np.all(np.abs(answers.columns["mean_friction"] - expected) <= error + known_to))


# --- against methods that step nothing ----------------------------------------------------------------------------


@pytest.mark.parametrize("smoothing", ["tanh", "arctan"])
@pytest.mark.parametrize("width", [0.5, 0.05])
def test_the_error_of_smoothed_friction_covers_its_bias(smoothing, width):
    scenes = [scene(v) for v in (2.0, 20.0, 40.0, 43.0, 49.5, 55.0)]
    answers = solve(scenes, stepper="smoothed", smoothing=smoothing, width=width)
    assert answers.status == ["ok"] * len(scenes)
    assert covered(answers, with_columns(Exact(), scenes, LAW, 1e-11).columns["mean_friction"])


# --- errors -------------------------------------------------------------------------------------------------------


@some(1, "seconds of steps")
@given(
    drawn=st.one_of(scenes_on_the_line(), scenes_in_the_plane()),
    keys=st.sampled_from(
        [{"steps": 256}, {"steps": 256, "theta": 1}, {"stepper": "smoothed", "width": 0.5}, {}]
    ),
)
def test_errors_are_distances_to_the_full_answer(drawn, keys):
    answers, full = March(**keys).solve([drawn], LAW, 1e-3), Shooting().solve([drawn], LAW, 1e-9)
    if answers.status == full.status == ["ok"]:
        apart = abs(answers.mean[0].real - full.mean[0].real)
        assert answers.error[0] == pytest.approx(apart, rel=1e-6, abs=2e-8)


def test_a_scene_without_a_full_answer_is_not_marched(monkeypatch):
    def nothing(scenes, law):
        return refused(["no such method"] * len(scenes))

    monkeypatch.setattr("frictionlab.methods.march.method.full_answers", nothing)
    answers = March(steps=400).solve([scene(20.0)], LAW, 1e-3)

    assert answers.status == ["refused"]
    assert "how far off time steps are is not known" in answers.reason[0]
    assert "no such method" in answers.reason[0]


def test_several_states_are_those_of_the_full_answer():
    law = Stribeck(mu_static=0.8, mu_kinetic=0.2, stribeck_speed=0.1, viscosity=0.01)
    quiet = {"damping_ratio": 0.01, "normal_load": 1.0, "drive": Drive(amplitude=0.05, frequency=3.0)}
    open_, full = solve(scene(0.6, **quiet), law), with_columns(Shooting(), [scene(0.6, **quiet)], law, 1e-8)
    sliding = solve(scene(0.6, **quiet, initial=Initial(x=law.sliding_friction(0.6))), law)

    assert open_.status == full.status == ["not_unique"]
    assert open_.columns["mean_high"] == pytest.approx(full.columns["mean_high"], abs=1e-6)
    assert sliding.status == ["ok"]
    assert "reached from scene.initial; an orbit of one drive period" in sliding.reason[0]


# --- what is read ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "keys", [{}, {"stepper": "rk4", "steps": 4000}, {"stepper": "smoothed", "width": 0.01}]
)
def test_the_other_columns_are_those_of_the_exact_method(keys):
    one = scene(20.0)
    found, expected = solve(one, **keys).columns, with_columns(Exact(), [one], LAW, 1e-10).columns
    for name in (
        "velocity_amplitude",
        "velocity_harmonic",
        "energy_viscous",
        "energy_friction",
        "energy_contact",
    ):
        assert found[name] == pytest.approx(expected[name], rel=5e-3), name
    assert found["energy_input"] == pytest.approx(
        found["energy_viscous"] + found["energy_friction"], rel=1e-4
    )
    assert found["reversals"] >= 2.0
    assert found["period"] == 1.0


def test_the_share_of_stick_is_that_of_the_exact_method_and_empty_for_steppers_that_never_rest():
    one = scene(0.5, drive=Drive(amplitude=2.5, frequency=0.5))
    expected = with_columns(Exact(), [one], LAW, 1e-10).columns["stick_fraction"]
    assert solve(one).columns["stick_fraction"] == pytest.approx(expected, abs=2e-3)
    assert np.isnan(solve(one, stepper="smoothed").columns["stick_fraction"][0])


def test_a_load_along_the_belt_alone_leaves_one_degree_of_freedom():
    across = Transverse(natural_frequency=2.0, damping_ratio=0.1)
    planar, line = solve(scene(20.0, transverse=across)), solve(scene(20.0))
    assert planar.columns["mean_friction"] == pytest.approx(line.columns["mean_friction"], abs=1e-12)
    start = Initial(x=1.0, x2=5.0)
    kicked = solve(scene(20.0, transverse=across, initial=start))
    assert abs(kicked.columns["mean_friction"] - line.columns["mean_friction"]) < 2e-4


@some(1, "seconds of steps")
@pytest.mark.parametrize(
    ("one", "steps"),
    [(scene(5.0), 400), (scene(5.0), 1000), (scene(0.5, drive=Drive(amplitude=2.5, frequency=0.5)), 4000)],
)
def test_chatter_of_steps_over_many_laps_is_read_as_one_drive_period(one, steps):
    answers = solve(one, stepper="rk4", steps=steps)
    found, expected = answers.columns, with_columns(Exact(), [one], LAW, 1e-10).columns
    assert found["period"][0] == 1.0
    orbit = answers.orbit(0)
    assert np.ptp(orbit.tau) / orbit.periods * one.frequency / (2.0 * math.pi) == pytest.approx(1.0)
    for name in ("velocity_harmonic", "energy_input", "energy_viscous", "energy_contact"):
        assert found[name] == pytest.approx(expected[name], rel=2e-2), name
    if expected["reversals"][0] == 2.0:
        assert found["reversals"] == pytest.approx(2.0, abs=0.5)
        assert found["force_reversals"] == pytest.approx(2.0, abs=0.5)


def test_several_periods_read_at_once_give_means_and_the_energies_of_one():
    one = scene(2.0, drive=Drive(unbalance=10.0, frequency=0.7))
    walker = MarchRun(one, LAW, "moreau")
    run = walker.run(Resolution(steps=2000, enough=1e-8, most=1000))
    single, whole = walker.track(run, 1), walker.track(run, 3)
    of_one, of_three, of_all = (
        read_columns([one], lambda i, orbit=orbit: orbit)
        for orbit in (single, replace(whole, periods=3), whole)
    )

    for name, (value,) in of_one.items():
        summed = "energy" in name or "reversals" in name
        assert of_three[name][0] == pytest.approx(value, rel=1e-6, nan_ok=True), name
        assert of_all[name][0] == pytest.approx(value * (3.0 if summed else 1.0), rel=1e-6, nan_ok=True), name


# --- nothing drives -------------------------------------------------------------------------------------------------


def test_the_period_of_leines_block_is_met_and_its_deflection():
    answers = solve(BLOCK, LEINE, 1e-6)
    assert answers.status == ["ok"]
    assert answers.columns["period"][0] * 2.0 * math.pi == pytest.approx(PERIOD, rel=1e-4)
    assert answers.orbit(0).x.real.max() == pytest.approx(1.133944676441, abs=2e-3)


@deep("seconds of steps")
@pytest.mark.parametrize(
    ("smoothing", "width", "percent"),
    [("arctan", 1e-3, -5.86), ("arctan", 1e-4, -1.61), ("tanh", 1e-2, -5.99), ("tanh", 1e-3, -0.837)],
)
def test_smoothing_shortens_the_period_of_leines_block_by_the_published_share(smoothing, width, percent):
    answers = solve(BLOCK, LEINE, 1e-4, stepper="smoothed", smoothing=smoothing, width=width)
    period = answers.columns["period"][0] * 2.0 * math.pi
    assert 100.0 * (period / PERIOD - 1.0) == pytest.approx(percent, abs=6e-3)
    exact = 0.31582076645  # of the unsmoothed block, by stepping a million times per unit of time
    assert covered(answers, exact)


@some(1, "seconds of steps")
@pytest.mark.parametrize("stepper", ["moreau", "rk4", "smoothed"])
def test_an_undriven_mass_on_a_belt_at_rest_stays_where_it_rests_from_the_default_start(stepper):
    one = Scene(damping_ratio=0.1, normal_load=1.0, belt_speed=0.0)
    answers = solve(one, stepper=stepper)
    assert answers.status == with_columns(Shooting(), [one], LAW, 1e-8).status == ["ok"]
    assert answers.columns["mean_friction"][0] == 0.0
    assert np.isnan(answers.columns["period"][0])


@pytest.mark.parametrize("damping", [0.05, 3.0])
def test_an_undriven_mass_that_comes_to_slide_steadily_has_no_period(damping):
    answers = solve(Scene(damping_ratio=damping, normal_load=1.0, belt_speed=-0.5))
    assert answers.columns["mean_friction"][0] == pytest.approx(-0.4, abs=1e-9)
    assert np.isnan(answers.columns["period"][0])
    assert answers.columns["energy_contact"][0] == pytest.approx(0.4 * 0.5 * 2.0 * math.pi, abs=1e-9)


# --- where there is no one number -----------------------------------------------------------------------------------


def test_too_few_periods_fail_with_how_much_the_motion_still_changes():
    answers = solve(scene(5.0), periods=4, steps=100)
    assert answers.status == ["failed"]
    assert "still changes by" in answers.reason[0]
    assert "give more periods" in answers.reason[0]


def test_a_belt_at_rest_that_can_hold_the_mass_needs_a_start():
    held = {"drive": Drive(amplitude=2.0, frequency=0.5)}
    answers = solve(scene(0.0, **held))
    assert answers.status == ["not_unique"]
    assert answers.columns["mean_high"][0] > 0.1
    started = solve(scene(0.0, initial=Initial(x=1.0), **held))
    assert started.status == ["ok"]
    assert started.columns["mean_friction"][0] == pytest.approx(0.1, abs=1e-6)


@some(1, "seconds of steps")
@pytest.mark.parametrize("start", [None, Initial(x=0.5)])
def test_a_response_of_several_drive_periods_has_its_mean_over_all_of_them(start):
    one = scene(0.3, damping_ratio=0.01, drive=Drive(amplitude=0.2, frequency=1.3), initial=start)
    answers, expected = solve(one, FALLING, 1e-4), with_columns(Shooting(), [one], FALLING, 1e-8)
    assert answers.status == expected.status == ["ok"]
    assert answers.columns["period"] == expected.columns["period"] == [6.0]
    assert covered(answers, expected.columns["mean_friction"])
    assert "an orbit of 6 drive periods has means over one from 0.1461" in expected.reason[0]
    assert "0.2528" in expected.reason[0]
    for name in ("energy_friction", "stick_fraction", "reversals"):
        assert answers.columns[name] == pytest.approx(expected.columns[name], rel=2e-2), name


# --- keys and refusals ----------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("keys", "said"),
    [
        ({"width": 0.1}, r"width: leave it out, stepper moreau knows theta, steps and periods"),
        ({"stepper": "rk4", "theta": 1}, r"theta: leave it out, stepper rk4 knows steps and periods"),
        (
            {"stepper": "smoothed", "steps": 100},
            r"steps: leave it out, stepper smoothed knows width, smoothing and periods",
        ),
        ({"theta": 0.7}, "must be 0.5 or 1"),
        ({"steps": 10.5}, "must be a whole number"),
        ({"steps": 2}, "steps: must be >= 4, got 2"),
        ({"stepper": "euler"}, "'smoothed' or 'sdirk2'"),
        ({"stepper": "exponential"}, "is gone: use sdirk2"),
        ({"stepper": "smoothed", "smoothing": "square_root"}, "is gone: use tanh or arctan"),
    ],
)
def test_keys_that_do_not_belong_are_refused_by_name(keys, said):
    with pytest.raises(WrongValues, match=said):
        March(**keys)


def test_a_key_that_does_not_belong_is_told_beside_a_value_that_is_bad():
    with pytest.raises(WrongValues) as caught:
        March(stepper="rk4", theta=1, steps=0, width=-1)
    told = {mistake.path: mistake.what for mistake in caught.value.mistakes}
    assert set(told) == {"theta", "steps", "width"}
    assert "leave it out, stepper rk4 knows steps and periods" in told["theta"]
    assert "leave it out" in told["width"]
    assert told["steps"] == "must be >= 4, got 0"
