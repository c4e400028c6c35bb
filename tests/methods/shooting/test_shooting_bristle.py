"""Shooting on bristles: every stiffness, reversals, states that are not unique, and the forms of the plane."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest
from answered import with_columns
from profiles import deep
from resonance import at_resonance, in_the_plane

import frictionlab as fl
from frictionlab.bench.peers.equations import OnBristles, one_period
from frictionlab.laws.memory import BristleLaw
from frictionlab.methods.shooting.method import Shooting

compiling = deep("planar kernels take long to compile")
PLANE = in_the_plane(15.0, 4.0, 1.0, 0.5)


def test_no_stiffness_is_too_high_or_too_low() -> None:
    speeds = np.array([5.0, 20.0, 40.0])
    coulomb = [
        fl.steady_state(scene, fl.Coulomb(mu=0.4)).mean_friction
        for scene in [at_resonance(speed) for speed in speeds]
    ]
    gaps = []
    for exponent in range(-8, 3):
        law = fl.Dahl(mu=0.4, presliding_length=10.0**exponent)
        answers = with_columns(Shooting(), [at_resonance(speed) for speed in speeds], law, 1e-7)
        assert set(answers.status) == {"ok"}
        gaps.append(float(np.abs(answers.columns["mean_friction"] - coulomb).max()))
    assert gaps[0] < 2e-6
    assert gaps[-1] > 0.04


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
    answers = with_columns(Shooting(), at_resonance(11.0, 1.5), law, 1e-6)
    assert answers.status == ["ok"]
    assert answers.columns["period"][0] == 1.0
    assert answers.columns["floquet"][0] == pytest.approx(0.99372, abs=1e-5)


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


# --- in the plane ---


@compiling
def test_planar_jenkins_friction_moves_on_its_circle_and_tends_to_coulombs() -> None:
    gaps = []
    for length in (1.0, 1e-2, 1e-4):
        (answers,) = (with_columns(Shooting(), PLANE, fl.Jenkins(mu=0.4, presliding_length=length), 1e-7),)
        assert answers.status == ["ok"]
        orbit = answers.orbit(0)
        assert orbit is not None
        assert np.abs(orbit.friction).max() <= 0.4 * (1 + 1e-6)
        coulomb = with_columns(Shooting(), [PLANE], fl.Coulomb(mu=0.4), 1e-8).columns["mean_friction"][0]
        gaps.append(abs(answers.columns["mean_friction"][0] - coulomb))
    assert gaps[0] > 5e-3
    assert gaps[0] > 20 * gaps[1] > 400 * gaps[2] or gaps[2] < 1e-6


@compiling
def test_without_a_load_across_the_belt_planar_bristles_are_those_of_the_line() -> None:
    law = fl.Dahl(mu=0.4, presliding_length=0.1)
    planar = with_columns(Shooting(), in_the_plane(15.0, 4.0, 1.0, 0.5, unbalance=0.0), law, 1e-8)
    alone = with_columns(Shooting(), at_resonance(15.0, 4.0, normal_load=1.0), law, 1e-8)
    assert planar.columns["mean_friction"][0] == alone.columns["mean_friction"][0]
    assert "x2 decays" in planar.model[0]


@compiling
def test_the_two_planar_forms_are_two_laws() -> None:
    means = {}
    for form in ("vectorial", "per-axis"):
        law = fl.Dahl(mu=0.4, presliding_length=3.0, planar=form)
        answers = with_columns(Shooting(), [PLANE], law, 1e-6)
        assert answers.status == ["ok"]
        means[form] = float(answers.columns["mean_friction"][0])
    coulomb = with_columns(Shooting(), [PLANE], fl.Coulomb(mu=0.4), 1e-8).columns["mean_friction"][0]
    assert abs(means["per-axis"] - means["vectorial"]) > 1e-3
    assert abs(means["vectorial"] - coulomb) > 1e-3


# By axis: beside LSODA on the equations of motion, which does not know of them.
BY_AXIS = fl.Dahl(mu=0.4, presliding_length=0.3, planar="per-axis")


def beside(belt_speed: float, across: float = 8.0) -> fl.Scene:
    return fl.Scene(
        damping_ratio=0.1,
        normal_load=4.0,
        belt_speed=belt_speed,
        drive=fl.Drive(amplitude=10.0, frequency=1.3, phase=30.0),
        transverse=fl.Transverse(
            natural_frequency=2.1, damping_ratio=0.05, load=fl.Load(amplitude=across, phase=100.0)
        ),
    )


def solved(one: fl.Scene, law: BristleLaw, tolerance: float = 1e-8) -> tuple[dict[str, float], fl.Orbit]:
    answers = with_columns(Shooting(), [one], law, tolerance)
    orbit = answers.orbit(0)
    assert answers.status == ["ok"]
    assert orbit is not None
    return {name: float(values[0]) for name, values in answers.columns.items()}, orbit


def followed(one: fl.Scene, law: BristleLaw, state: list[float]) -> np.ndarray:
    """The state after a period, and the integral of friction."""
    return one_period(OnBristles(one, law, 1_000_000), np.array([*state, 0.0]), "odeint", 1e-12)


def start_of(orbit: fl.Orbit, deflection: complex) -> list[float]:
    x, v = complex(orbit.x[0, 0]), complex(orbit.v[0, 0])
    return [x.real, v.real, x.imag, v.imag, deflection.real, deflection.imag]


@pytest.mark.parametrize("belt_speed", [0.7, 4.0])
def test_bristles_by_axis_repeat_in_the_coupled_equations_of_motion(belt_speed: float) -> None:
    here = beside(belt_speed)
    row, orbit = solved(here, BY_AXIS)
    state = start_of(orbit, complex(orbit.friction[0, 0]) / BY_AXIS.bristle_stiffness)
    end = followed(here, BY_AXIS, state)
    assert end[:-1] == pytest.approx(state, abs=1e-6)
    mean = -end[-1] * here.mass().frequency / (2.0 * math.pi)
    assert abs(mean - row["mean_friction"]) <= row["error"] + 1e-9


def test_a_mass_held_elastically_across_the_belt_has_a_mean_along_it() -> None:
    law = fl.Jenkins(mu=0.4, presliding_length=2.0, planar="per-axis")
    here = beside(2.0, across=0.5)
    answers = with_columns(Shooting(), [here], law, 1e-8)
    assert answers.status == ["ok"]
    assert "elastic under this load: the mean there depends on the start" in answers.reason[0]
    assert math.isnan(answers.columns["mean_friction_transverse"][0])
    mass = here.mass()
    spring = mass.transverse_stiffness + mass.normal_load * law.bristle_stiffness
    dynamic = complex(spring - mass.frequency**2, mass.frequency * mass.transverse_damping)
    moved = mass.frequency * abs(mass.transverse_force / dynamic)
    assert answers.columns["transverse_velocity_amplitude"][0] == pytest.approx(moved, rel=1e-6)
    assert answers.columns["floquet"][0] == pytest.approx(1.0, abs=1e-6)
    alone = with_columns(Shooting(), [here.model_copy(update={"transverse": None})], law, 1e-8)
    assert answers.columns["mean_friction"][0] == alone.columns["mean_friction"][0]
