# ruff: noqa: RUF001
# Pages have Greek letters, minus and multiplication signs, as here.
"""The equations of a study, in the letters of its inputs."""

from __future__ import annotations

from typing import Any

import pytest
from fig_4b import GIVEN, over_speeds

from frictionlab.report import sentences as say
from frictionlab.report.equation import equations
from frictionlab.study.load import parse_study
from frictionlab.study.study import Study

LINE = GIVEN | {"drive": {"unbalance": 10, "frequency": 1.5}}
ACROSS = {"natural_frequency": 0.5, "damping_ratio": 0.1}
TURNED = {"amplitude": 2, "frequency": 1, "direction": 30, "waveform": "square", "offset": 1}
BODY = {"mass_kg": 3, "normal_load_N": 25, "belt_speed_m_per_s": 0.1}
IN_SI = BODY | {"stiffness_N_per_m": 300, "damping_N_s_per_m": 2, "length_m": 0.01}
IN_SI |= {"drive": {"amplitude_N": 5, "frequency_rad_per_s": 10}}


BELT = {"displacement_amplitude_m": 0.01, "frequency_rad_per_s": 20}
PUSHED = {"acceleration_amplitude_m_per_s2": 4, "frequency_rad_per_s": 20}
SLIP = {"velocity_amplitude": 2, "frequency": 1}
FREE = {"belt_speed": 1, "normal_load": 2, "damping_ratio": 0.1, "spring": False, "drive": {"offset": 0.5}}
FREE_IN_SI = {"mass": "3 kg", "stiffness": "0 N/m", "belt_speed": "1 m/s", "drive": {"offset": "1 N"}}
BENT = {"cubic_stiffness": 0.2, "amplitude_damping": 0.3, "curvature": 0.05}
REMEMBERS = {"fractional": {"coefficient": 0.2, "order": 0.5}, "curvature": 0}
ALONG = "ẍ1 + 2 β1 ẋ1 + x1 + γ2 T1 = α Ω2 sin(Ω τ)"
EQUATIONS: dict[str, dict[str, Any]] = {
    f"{ALONG}; v1 = ẋ1 − vb": LINE,
    # across the belt there is an equation of its own
    f"{ALONG}; ẍ2 + 2 β2 ωr ẋ2 + ωr2 x2 + γ2 T2 = P2 sin(Ω τ + φ2); v1 = ẋ1 − vb, v2 = ẋ2": (
        LINE | {"transverse": ACROSS | {"load": {"amplitude": 3, "phase": 90}}}
    ),
    # a load that is turned pushes in both directions, with its mean
    (
        "ẍ1 + 2 β1 ẋ1 + x1 + γ2 T1 = (P w(Ω τ) + P0) cos χ; ẍ2 + ωr2 x2 + γ2 T2 = (P w(Ω τ) + P0) sin χ; "
        "v1 = ẋ1 − vb, v2 = ẋ2"
    ): LINE | {"drive": TURNED, "transverse": ACROSS | {"damping_ratio": 0}},
    # springs and dashpots that are not linear, and one that remembers
    (
        "ẍ1 + 2 β1 (1 + 2 κ x1)2 ẋ1 + (1 + κ x1) (1 + 2 κ x1) x1 + k3 x13 + c3 x12 ẋ1 + γ2 T1 = α Ω2 sin(Ω τ); "
        "v1 = ẋ1 − vb"
    ): LINE | {"body": BENT},
    "ẍ1 + 2 β1 ẋ1 + x1 + cq Dq x1 + γ2 T1 = α Ω2 sin(Ω τ); v1 = ẋ1 − vb": LINE | {"body": REMEMBERS},
    # a normal load and a belt that vary
    (
        "ẍ1 + 2 β1 ẋ1 + x1 + N(τ) T1 = α Ω2 sin(Ω τ); v1 = ẋ1 − vb − v̂b sin(Ω τ + φb); "
        "N(τ) = γ2 (1 + n sin(rn Ω τ))"
    ): LINE
    | {"normal_load_variation": {"amplitude": 0.5, "frequency_ratio": 2}}
    | {"belt_vibration": {"velocity_amplitude": 2, "phase": -90}},
    # a body that nothing shakes, and one that no spring holds
    "ẍ1 + x1 + γ2 T1 = 0; v1 = ẋ1 − vb": {"damping_ratio": 0, "normal_load": 1, "belt_speed": 0.2},
    "ẍ1 + 2 β1 ẋ1 + N(τ) T1 = P0; v1 = ẋ1 − vb; N(τ) = γ2 (1 + n sin(Ω τ))": (
        FREE | {"normal_load_variation": {"amplitude": 0.1, "frequency": 1}}
    ),
    # SI units, in which springs, dashpots and vibrations are given in several ways
    "M Ẍ1 + C1 Ẋ1 + K1 X1 + N T1 = F1 sin(ω t); v1 = Ẋ1 − Vb": {"dimensional": IN_SI},
    "M Ẍ1 + 2 β1 M ω1 Ẋ1 + M ω12 X1 + N T1 = 0; v1 = Ẋ1 − Vb − X̂b ω sin(ω t)": {
        "dimensional": BODY
        | {"natural_frequency_rad_per_s": 10, "damping_ratio": 0.1, "belt_vibration": BELT}
    },
    "M Ẍ1 + 2 β1 √(K1 M) Ẋ1 + K1 X1 + N T1 = 0; v1 = Ẋ1 − Vb − A\u0302b / (ω) sin(ω t)": {
        "dimensional": BODY | {"stiffness_N_per_m": 300, "damping_ratio": 0.1, "belt_vibration": PUSHED}
    },
    "M Ẍ1 + M g T1 = F0; v1 = Ẋ1 − Vb − X̂b ω sin(ω t)": {
        "dimensional": FREE_IN_SI | {"belt_vibration": BELT}
    },
    # a prescribed slip
    "v1 = V1 sin(Ω τ) − vb": {"belt_speed": 0.5, "slip": SLIP},
    "v1 = V1 sin(Ω τ) cos χ − vb; v2 = V1 sin(Ω τ) sin χ": {
        "belt_speed": 1,
        "slip": SLIP | {"direction": 30},
    },
    "v1 = − vb; v2 = V2 sin(Ω τ)": {"belt_speed": -0.5, "transverse_slip": SLIP},
    "v1 = X̂1 ω sin(ω t) − Vb": {"dimensional": {"belt_speed": "1 m/s", "slip": BELT}},
}


def study_of(scene: dict[str, Any], **sweep: Any) -> Study:
    """A study of a scene."""
    paths = {f"scene.{name.replace('__', '.')}": values for name, values in sweep.items()}
    return parse_study(over_speeds([], scene=scene, methods=["auto"], sweep=paths))


def told(study: Study) -> str:
    """The equations as text."""
    return "; ".join(" ".join(str(each.striptags()).split()) for each in equations(study))


@pytest.mark.parametrize("wanted", EQUATIONS)
def test_equations_have_a_letter_for_each_input_that_is_not_zero(wanted: str) -> None:
    study = study_of(EQUATIONS[wanted])

    assert told(study) == wanted
    assert ("Forces" in say.tell(say.ON_LETTERS, " ".join(equations(study)))) == bool(study.scene.dimensional)


def test_what_is_swept_has_its_letter_where_the_study_has_zero() -> None:
    swept = study_of(LINE | {"damping_ratio": 0}, damping_ratio=[0, 1], drive__waveform=["sine", "square"])

    assert told(swept).startswith(ALONG.replace("sin", "w"))
