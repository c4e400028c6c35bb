"""Numbers of scenes in SI units as text with a unit: what they are, and what is said of those that are none."""

from __future__ import annotations

import math
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

import frictionlab as fl
from frictionlab.scene.dimensional import Dimensional
from frictionlab.study.load import parse_study
from frictionlab.study.reader import read_values
from frictionlab.study.yaml_source import read_text
from frictionlab.values.notes import StudyError, Unfit, WrongValues
from frictionlab.values.units import in_units

NUMBERS: dict[str, Any] = {
    "mass_kg": 0.5,
    "stiffness_N_per_m": 5000,
    "damping_N_s_per_m": 5,
    "length_m": 5e-6,
    "normal_load_N": 20,
    "belt_speed_m_per_s": 0.002,
    "drive": {"unbalance_kg_m": 3e-6, "frequency_rad_per_s": 376.9911184307752},
    "transverse": {
        "stiffness_N_per_m": 7000,
        "damping_N_s_per_m": 1,
        "load": {"amplitude_N": 2, "phase": 90},
    },
    "belt_vibration": {"velocity_amplitude_m_per_s": 0.001},
    "normal_load_variation": {"amplitude": 0.3},
    "initial": {"x_m": -1e-6, "velocity2_m_per_s": 0.001},
}
TEXTS: dict[str, Any] = {
    "mass": "500 g",
    "stiffness_N_per_m": "5 kN/m",
    "damping": "5 N*s/m",
    "length": "5 um",
    "normal_load": "0.02 kN",
    "belt_speed": "2 mm/s",
    "drive": {"unbalance": "3 g mm", "frequency": "60 Hz"},
    "transverse": {
        "stiffness": "7 N/mm",
        "damping": "1 N s/m",
        "load": {"amplitude": "2 N", "phase": "90 deg"},
    },
    "belt_vibration": {"velocity_amplitude": "1 mm/s"},
    "normal_load_variation": {"amplitude": "30 %"},
    "initial": {"x": "-1 µm", "velocity2": "1e-3 m/s"},
}


def test_a_scene_of_texts_is_that_of_its_numbers_in_python_and_in_a_study() -> None:
    numbers, texts = Dimensional(**NUMBERS), Dimensional(**TEXTS)
    told = [
        parse_study({"schema": 1, "scene": {"dimensional": tree}, "laws": [{"kind": "coulomb", "mu": 0.3}]})
        for tree in (NUMBERS, TEXTS)
    ]

    assert repr(texts) == repr(numbers)
    assert texts == numbers
    assert told[0].digest() == told[1].digest()
    assert told[0] == told[1]


@given(
    st.floats(-1e6, -1e-200) | st.floats(1e-200, 1e6),
    st.sampled_from([("nm", 1e-9), ("um", 1e-6), ("mm", 1e-3), ("cm", 0.01), ("km", 1e3)]),
)
def test_a_prefix_multiplies_to_rounding(value: float, prefixed: tuple[str, float]) -> None:
    unit, factor = prefixed

    assert in_units(f"{value!r} {unit}/s", "m/s") == pytest.approx(value * factor, rel=1e-15, abs=0.0)


@pytest.mark.parametrize(
    ("text", "turns_per_second"),
    [
        ("60 Hz", 60),
        ("0.06 kHz", 60),
        ("3600 rpm", 60),
        (f"{120 * math.pi} rad/s", 60),
        ("60 rad/s", 30 / math.pi),
    ],
)
def test_a_frequency_counts_cycles_or_is_an_angle_per_time(text: str, turns_per_second: float) -> None:
    assert in_units(text, "rad/s") == pytest.approx(2 * math.pi * turns_per_second, rel=1e-15)


@pytest.mark.parametrize("unit", ["m/s^2", "m/s2", "m/s²", "m/s**2", "m/s/s", "m s^-2", "m·s⁻²", "N/kg"])
def test_powers_are_written_as_people_write_them(unit: str) -> None:
    assert in_units(f"9.81 {unit}", "m/s^2") == 9.81


@pytest.mark.parametrize(
    "text",
    [
        "",
        "2",
        "nan m",
        "inf m",
        "1e400 m",
        "1e9999 m",
        "2 m**9**9**9",
        "2 m m m/",
        "m",
        "2 (m)",
        "2 3 m",
        "2 m^10",
    ],
)
def test_what_is_no_number_with_a_unit_is_refused_and_nothing_is_evaluated(text: str) -> None:
    assert isinstance(in_units(text, "m"), Unfit)


STUDY = """schema: 1
scene:
  dimensional:
    mass: 0.5 kg
    stiffness: 5 kN/m
    damping_N_s_per_m: 5
    length: 5 um
    belt_speed: 2 mm/s
    drive: {amplitude: 20 N, frequency: 60 Hz}
laws: [{kind: coulomb, mu: 0.3}]
"""


@pytest.mark.parametrize(
    ("right", "wrong", "said"),
    [
        ("2 mm/s", "2 mm", "8:17: scene.dimensional.belt_speed: '2 mm' is a length [m]; give a speed [m/s] such as"),
        ("60 Hz", "60 1/s", "9:41: scene.dimensional.drive.frequency: '60 1/s' is one over a time"),
        ("20 N", "20 NN", "9:24: scene.dimensional.drive.amplitude: '20 NN' has the unknown unit 'NN'; allowed: m,"),
        ("0.5 kg", "0.5", "4:11: scene.dimensional.mass: 0.5 has no unit; give a mass [kg] such as '0.5 kg', or the"),
        ("0.5 kg", "-1 g", "4:11: scene.dimensional.mass: must be > 0, got -1 g"),
        ("5 um", "five", "7:13: scene.dimensional.length: must be a number, or text with a unit such as 5 um, got"),
        ("5 um", "", "7:5: scene.dimensional.length: must be a number, got null"),
        ("length: 5 um", "length: 5 um\n    length_m: 1", "8:15: scene.dimensional.length_m: is given as length,"),
        ("length: 5 um", "lenght: 5 um", "7:5: scene.dimensional.lenght: unknown key"),
        ("length:", "gravity: 1 N/kg\n    normal_load: 2 N\n    length:", "7:14: scene.dimensional.gravity: leave"),
    ],
)  # fmt: skip
def test_a_mistake_is_told_where_it_is_with_what_is_allowed(right: str, wrong: str, said: str) -> None:
    with pytest.raises(StudyError) as caught:
        read_values(read_text(STUDY.replace(right, wrong), "a.yaml"))

    assert str(caught.value).startswith(f"a.yaml:{said}")
    assert len(caught.value.mistakes) == 1


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("0,5 N/m", "; write 0.5 N/m"),
        ("5,000 N/m", "; write 5000 N/m or 5.000 N/m"),
        ("12 500 N/m", "; write 12500 N/m"),
        ("1,200.5 N/m", "; write 1200.5 N/m"),
        ("five N/m", "such as 5 kN/m"),
    ],
)
def test_digits_apart_are_told_how_to_write_them(text: str, meant: str) -> None:
    found = in_units(text, "N/m")

    assert isinstance(found, Unfit)
    assert found.what.endswith(meant)


@pytest.mark.parametrize(
    ("text", "unit", "number"),
    [
        ("5 Ns/m", "N s/m", 5.0),
        ("2 Nm", "J", 2.0),
        ("3 micron", "m", 3e-6),
        ("3 microns", "m", 3e-6),
        ("3 \u00b5m", "m", 3e-6),
        ("3 \u03bcm", "m", 3e-6),
        ("3 mm/sec", "m/s", 3e-3),
    ],
)
def test_units_as_people_write_them(text: str, unit: str, number: float) -> None:
    assert in_units(text, unit) == number


def test_a_scene_is_changed_under_a_key_without_a_unit() -> None:
    scene = fl.Scene(dimensional=TEXTS)

    assert scene.with_({"dimensional.belt_speed": "3 mm/s"}).dimensional == Dimensional(
        **{**NUMBERS, "belt_speed_m_per_s": 0.003}
    )
    with pytest.raises(WrongValues, match="3 has no unit; give a speed"):
        scene.with_(belt_speed=3)


def test_a_weight_that_was_not_given_gives_way_to_a_load() -> None:
    body = {key: value for key, value in TEXTS.items() if key != "normal_load"}

    loaded = fl.Scene(dimensional=body).with_(normal_load="20 N")
    assert loaded.dimensional == Dimensional(**NUMBERS)
    assert Dimensional(**body).gravity_m_per_s2 == 9.81
