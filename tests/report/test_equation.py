# ruff: noqa: RUF001
# Pages have Greek letters, minus and multiplication signs, as here.
"""The equations of a study, with its numbers in them."""

from __future__ import annotations

from typing import Any

import pytest
from fig_4b import GIVEN, over_speeds

from frictionlab.report.equation import equations, letters_sentence
from frictionlab.study.load import parse_study

LINE = GIVEN | {"drive": {"unbalance": 10, "frequency": 1.5}}
ACROSS = {"natural_frequency": 0.5, "damping_ratio": 0.1, "load": {"amplitude": 3, "phase": 90}}
PLANE = LINE | {"transverse": ACROSS}
BODY = {"mass_kg": 3, "normal_load_N": 25, "belt_speed_m_per_s": 0.1}
IN_SI = BODY | {"stiffness_N_per_m": 300, "damping_N_s_per_m": 2, "length_m": 0.01}
IN_SI |= {"drive": {"amplitude_N": 5, "frequency_rad_per_s": 10}}


def told(scene: dict[str, Any], **sweep: Any) -> list[str]:
    """The equations as text."""
    return [" ".join(str(each.striptags()).split()) for each in equations(_study(scene, **sweep))]


def _study(scene: dict[str, Any], **sweep: Any) -> Any:
    paths = {f"scene.{name.replace('__', '.')}": values for name, values in sweep.items()}
    return parse_study(over_speeds([], scene=scene, methods=["auto"], sweep=paths))


def test_numbers_stand_in_the_equation_of_motion() -> None:
    assert told(LINE) == ["ẍ1 + 0.2 ẋ1 + x1 + 10 T1 = 22.5 sin(1.5 τ)", "v1 = ẋ1 − 5"]


def test_what_is_swept_stays_a_symbol() -> None:
    swept = {name: [1, 2] for name in ("drive__frequency", "damping_ratio", "normal_load", "belt_speed")}

    assert told(LINE, **swept) == ["ẍ1 + 2 β1 ẋ1 + x1 + γ2 T1 = 10 Ω2 sin(Ω τ)", "v1 = ẋ1 − vb"]


def test_springs_and_dashpots_that_are_not_linear_are_told() -> None:
    bent = {"cubic_stiffness": 0.2, "amplitude_damping": 0.3, "curvature": 0.05}
    assert told(LINE | {"body": bent})[0] == (
        "ẍ1 + 0.2 (1 + 0.1 x1)2 ẋ1 + (1 + 0.05 x1) (1 + 0.1 x1) x1 + 0.2 x13 + 0.3 x12 ẋ1 + 10 T1 = 22.5 sin(1.5 τ)"
    )
    swept = told(LINE | {"body": bent}, **{"body__cubic_stiffness": [0, 1]})[0]
    assert " + k3 x13 + " in swept


def test_the_plane_has_an_equation_for_each_direction() -> None:
    assert told(PLANE) == [
        "ẍ1 + 0.2 ẋ1 + x1 + 10 T1 = 22.5 sin(1.5 τ)",
        "ẍ2 + 0.1 ẋ2 + 0.25 x2 + 10 T2 = 3 sin(1.5 τ + 90°)",
        "v1 = ẋ1 − 5, v2 = ẋ2",
    ]


def test_a_turned_load_pushes_in_both_directions() -> None:
    drive = {"amplitude": 2, "frequency": 1, "direction": 30, "waveform": "square"}
    across = {"natural_frequency": 1, "damping_ratio": 0}
    first, second, _ = told(PLANE | {"drive": drive, "transverse": across})

    assert first.endswith(" = 2 square(τ) cos 30°")
    assert second.endswith(" = 2 square(τ) sin 30°")


def test_si_units_have_mass_and_springs_in_them() -> None:
    scene = {"dimensional": IN_SI}
    assert told(scene) == ["3 Ẍ1 + 2 Ẋ1 + 300 X1 + 25 T1 = 5 sin(10 t)", "v1 = Ẋ1 − 0.1"]
    assert letters_sentence(_study(scene)).endswith("forces are in N, lengths in m, t in s.")


def test_springs_and_vibrations_by_their_other_numbers_are_those_of_the_equation() -> None:
    body = BODY | {"damping_ratio": 0.1}
    natural, stiff = {"natural_frequency_rad_per_s": 10}, {"stiffness_N_per_m": 300}
    shaken = {"belt_vibration": {"displacement_amplitude_m": 0.01, "frequency_rad_per_s": 20}}
    pushed = {"belt_vibration": {"acceleration_amplitude_m_per_s2": 4, "frequency_rad_per_s": 20}}
    swept = {"dimensional__belt_vibration__frequency": ["1 Hz", "2 Hz"]}

    small = {"belt_vibration": {"displacement_amplitude": "5 um", "frequency_rad_per_s": 20}}

    assert told({"dimensional": body | stiff | small}, **swept)[1] == "v1 = Ẋ1 − 0.1 − 5·10−6 ω sin(ω t)"
    wanted = ["3 Ẍ1 + 6 Ẋ1 + 300 X1 + 25 T1 = 0", "v1 = Ẋ1 − 0.1 − 0.2 sin(20 t)"]
    assert told({"dimensional": body | natural | shaken}) == wanted
    assert told({"dimensional": body | stiff | pushed}) == wanted
    assert told({"dimensional": body | stiff | shaken}, **swept)[1] == "v1 = Ẋ1 − 0.1 − 0.01 ω sin(ω t)"
    assert told({"dimensional": body | stiff | pushed}, **swept)[1] == "v1 = Ẋ1 − 0.1 − (4) / (ω) sin(ω t)"


def test_a_normal_load_and_a_belt_that_vary_are_told() -> None:
    scene = LINE | {"normal_load_variation": {"amplitude": 0.5, "frequency_ratio": 2}}
    scene |= {"belt_vibration": {"velocity_amplitude": 2, "phase": -90}}

    assert told(scene) == [
        "ẍ1 + 0.2 ẋ1 + x1 + N T1 = 22.5 sin(1.5 τ)",
        "v1 = ẋ1 − 5 − 2 sin(1.5 τ − 90°)",
        "N = 10 (1 + 0.5 sin(3 τ))",
    ]


SLIP = {"velocity_amplitude": 2, "frequency": 1}
SLIP_IN_SI = {"displacement_amplitude": "2 m", "frequency": "3 rad/s"}


@pytest.mark.parametrize(
    ("scene", "wanted"),
    [
        ({"belt_speed": 0.5, "slip": SLIP}, ["v1 = 2 sin(τ) − 0.5"]),
        ({"belt_speed": -0.5, "transverse_slip": SLIP}, ["v1 = 0.5", "v2 = 2 sin(τ)"]),
        ({"dimensional": {"belt_speed": "1 m/s", "slip": SLIP_IN_SI}}, ["v1 = 6 sin(3 t) − 1"]),
    ],
)
def test_a_prescribed_slip_is_an_equation_of_its_own(scene: dict[str, Any], wanted: list[str]) -> None:
    assert told(scene) == wanted


def test_what_nothing_shakes_has_no_load() -> None:
    assert told({"damping_ratio": 0, "normal_load": 1, "belt_speed": 0.2})[0] == "ẍ1 + x1 + T1 = 0"
