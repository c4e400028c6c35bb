"""Time stepping of scenes that vary in time: waveforms, belts, normal loads; steps that end at every corner."""

from __future__ import annotations

import math

import numpy as np
import pytest
from answered import with_columns
from hypothesis import given
from hypothesis import strategies as st
from profiles import deep
from strategies import sizes

from frictionlab.compile.interpret import interpreted
from frictionlab.laws.coulomb import Coulomb
from frictionlab.laws.dahl import Dahl
from frictionlab.laws.lugre import LuGre
from frictionlab.laws.stribeck import Stribeck
from frictionlab.methods.march.lap import MarchSettings, steps_in
from frictionlab.methods.march.method import March
from frictionlab.methods.shooting.method import Shooting
from frictionlab.scene.scene import Scene

COULOMB, DAHL = Coulomb(mu=0.4), Dahl(mu=0.4, presliding_length=1.0)
LINE = {"damping_ratio": 0.1, "normal_load": 10.0, "belt_speed": 2.0}
DRIVE = {"amplitude": 10.0, "frequency": 1.3}
SCENES = {
    "sawtooth belt, square load": LINE
    | {
        "drive": DRIVE,
        "belt_vibration": {"velocity_amplitude": 3.0, "waveform": "sawtooth", "phase": 30.0},
        "normal_load_variation": {"amplitude": 0.5, "waveform": "square", "frequency_ratio": "3/2"},
    },
}
compiling = deep("more kernels to compile")


def solve(keys, law=COULOMB, tolerance=1e-3, **given_keys):
    return with_columns(March(**given_keys), Scene(**keys), law, tolerance)


def mean_and_error(answers):
    """Of the only scene."""
    assert answers.status == ["ok"], answers.reason
    return float(answers.columns["mean_friction"][0]), float(answers.columns["error"][0])


# --- against methods that step nothing ----------------------------------------------------------------------------


@deep("more kernels to compile")
def test_columns_of_an_orbit_are_those_of_shooting():
    name = "sawtooth belt, square load"
    found = solve(SCENES[name], DAHL, steps=400).columns
    expected = with_columns(Shooting(), [Scene(**SCENES[name])], DAHL, 1e-8).columns
    for column in (
        "velocity_amplitude",
        "energy_input",
        "energy_viscous",
        "energy_friction",
        "energy_contact",
    ):
        assert found[column] == pytest.approx(expected[column], rel=5e-3), column


# --- corners ------------------------------------------------------------------------------------------------------


@given(first=sizes(1e-3, 1.0), lasts=sizes(1e-4, 10.0), refined=st.sampled_from([1, 2, 16]))
def test_equal_steps_fill_a_piece_and_halved_ones_halve_every_step_of_it(first, lasts, refined):
    count = interpreted(steps_in)
    plain = MarchSettings(2.0, True, 100, 9.0, first, 0.5, first, 0.0, 1, 1, 0.0, 1, 1, 0, refined=1)
    halved = plain._replace(first=first / refined, refined=refined)
    assert count(halved, lasts) == refined * count(plain, lasts)
    assert lasts / count(plain, lasts) <= first * (1.0 + 1e-8)


SLIDING = {
    **LINE,
    "belt_speed": 30.0,
    "drive": DRIVE | {"waveform": "square", "phase": 17.0},
    "belt_vibration": {"velocity_amplitude": 6.0, "waveform": "sawtooth", "frequency_ratio": 2},
    "normal_load_variation": {"amplitude": 0.5, "waveform": "square", "phase": 50.0},
}
RISING = Stribeck(mu_kinetic=0.2, mu_static=0.2, viscosity=0.01)
FOLLOWING = LuGre(mu_kinetic=0.2, presliding_length=3.0, viscosity=0.01)


@pytest.mark.parametrize(
    ("keys", "law", "order", "coarsest"),
    [
        ({}, RISING, 2, 20),
        ({"theta": 1}, RISING, 1, 80),
        pytest.param({"stepper": "rk4"}, RISING, 4, 20, marks=compiling),
        pytest.param({"stepper": "rk4"}, FOLLOWING, 4, 40, marks=compiling),
        pytest.param({"stepper": "sdirk2"}, FOLLOWING, 2, 20, marks=compiling),
    ],
    ids=lambda each: str(each),
)
def test_jumps_of_belt_and_loads_cost_no_order(keys, law, order, coarsest):
    means = [
        mean_and_error(solve(SLIDING, law, 1e-9, steps=coarsest * part, **keys))[0] for part in (1, 2, 4)
    ]
    ratio = (means[1] - means[0]) / (means[2] - means[1])
    assert math.log2(ratio) == pytest.approx(order, abs=0.25)


def test_a_stuck_mass_leaves_stick_where_the_velocity_of_the_belt_jumps():
    vibration = {"velocity_amplitude": 0.3, "waveform": "square", "frequency": 0.5, "phase": 25.0}
    keys = LINE | {"belt_speed": 0.1, "belt_vibration": vibration}
    scene, orbit = Scene(**keys), solve(keys, steps=200).orbit(0)
    belt, starts, left = scene.signals().belt[0], orbit.tau[:, 0], 0
    for tau in belt.corners(scene.signals().period):
        after = int(np.argmin(np.abs(starts - tau)))
        assert abs(starts[after] - tau) <= 1e-12  # a step begins there
        assert orbit.v[after, 0] == orbit.v[after - 1, -1]  # the slip jumps, the mass goes on
        assert not orbit.stick[after]
        left += int(orbit.stick[after - 1])
    assert left == 1
    middle = 0.5 * (orbit.tau[:, 0] + orbit.tau[:, -1])
    carried = 0.1 + belt(middle)
    assert orbit.v.real[:, -1][orbit.stick] == pytest.approx(carried[orbit.stick], abs=1e-14)


def test_a_mass_that_never_slips_on_a_vibrating_belt_has_a_range_of_means():
    keys = LINE | {"belt_speed": 0.0, "belt_vibration": {"velocity_amplitude": 0.3, "frequency": 0.5}}
    found = with_columns(March(), [Scene(**keys)], COULOMB, 1e-3)
    expected = with_columns(Shooting(), [Scene(**keys)], COULOMB, 1e-9)
    assert found.status == expected.status == ["not_unique"]
    for name in ("mean_low", "mean_high"):
        assert found.columns[name] == pytest.approx(expected.columns[name], abs=1e-9)


# --- a contact of constant stiffness ------------------------------------------------------------------------------


def pressed(contact, amplitude=0.6):
    """A changing load."""
    return {"normal_load_variation": {"amplitude": amplitude, "waveform": "sine", "contact": contact}}
