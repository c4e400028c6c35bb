"""A body's receptance in SI units: that of its mass, spring and dashpot, and what does not go with it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import frictionlab as fl
from frictionlab.report.equation import equations
from frictionlab.scene.dimensional import Dimensional
from frictionlab.study.load import load_study
from frictionlab.values.notes import StudyError, WrongValues

MASS, DAMPING, STIFFNESS = 0.5, 5.0, 5000.0
SHARED: dict[str, Any] = {
    "normal_load": "20 N",
    "belt_speed": "2 cm/s",
    "drive": {"amplitude": "20 N", "frequency": "16 Hz"},
}
WITH_UNITS = "frequency_rad_per_s,real_m_per_N,imaginary_m_per_N"


def table(folder: Path, head: str = "frequency,real,imaginary") -> str:
    omega = np.linspace(0.0, 1200.0, 601)
    values = 1.0 / (STIFFNESS - MASS * omega**2 + 1j * DAMPING * omega)
    rows = [f"{a!r},{b.real!r},{b.imag!r}" for a, b in zip(omega.tolist(), values.tolist(), strict=True)]
    file = folder / "h.csv"
    file.write_text("\n".join([head, *rows]) + "\n")
    return str(file)


@pytest.mark.parametrize("head", ["frequency,real,imaginary", WITH_UNITS])
def test_a_table_is_the_scene_of_its_mass_spring_and_dashpot(tmp_path: Path, head: str) -> None:
    body = {"receptance": {"file": table(tmp_path, head), "free_mass": "500 g"}}
    springs = Dimensional(mass_kg=MASS, stiffness_N_per_m=STIFFNESS, damping_N_s_per_m=DAMPING, **SHARED)
    told = Dimensional(body=body, **SHARED)
    scene, other = fl.Scene(dimensional=told), fl.Scene(dimensional=springs)

    np.testing.assert_allclose(told.scales, springs.scales, rtol=1e-9)
    assert scene.normal_load == pytest.approx(other.normal_load)
    assert scene.belt_speed == pytest.approx(other.belt_speed)
    assert scene.drive is not None
    assert scene.drive.frequency == pytest.approx(16 * 2 * np.pi / 100)
    assert scene.body is not None
    assert scene.body.receptance is not None
    assert other.damping_ratio is not None
    omega = np.linspace(0.0, 20.0, 77)
    found = scene.body.receptance.body().receptance(omega[omega < 12])
    right = 1.0 / (1.0 - omega**2 + 2j * other.damping_ratio * omega)
    np.testing.assert_allclose(found, right[omega < 12], rtol=1e-9)
    assert scene.body.receptance.body().receptance(omega[-1:])[0] == pytest.approx(-1.0 / 400.0)
    assert fl.Scene(**scene.given()) == scene
    assert scene.at(0.05).dimensional is not None


def test_without_a_free_mass_time_is_that_of_the_drive(tmp_path: Path) -> None:
    told = Dimensional(body={"receptance": table(tmp_path)}, **SHARED)

    assert fl.Scene(dimensional=told).frequency == pytest.approx(1.0)
    assert fl.steady_state(fl.Scene(dimensional=told), fl.Coulomb(mu=0.3)).status == "refused"


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"mass_kg": 1}, "mass_kg: leave it out, body.receptance stands for the whole body"),
        ({"damping_ratio": 0.1}, "damping_ratio: leave it out, body.receptance stands"),
        ({"normal_load": None}, "required key is missing, body.receptance tells no weight"),
        ({"body": {"curvature_per_m": 2.0}}, "body.curvature_per_m: leave it out, body.receptance stands"),
        ({"body": {"receptance": "g.csv"}}, "body.receptance: there is no file g.csv"),
        ({"body": {"receptance": {"free_mass": "2 N"}}}, "free_mass: '2 N' is a force [N]; give a mass [kg]"),
    ],
)
def test_what_does_not_go_with_a_table_is_told(tmp_path: Path, change: dict[str, Any], said: str) -> None:
    receptance = {"file": table(tmp_path)}
    body = change.get("body", {})
    inside = body.get("receptance", {})
    body = {**body, "receptance": inside if isinstance(inside, str) else receptance | inside}

    with pytest.raises(WrongValues) as told:
        Dimensional(**(SHARED | change | {"body": body}))

    assert said in str(told.value)


def test_a_file_in_si_units_is_not_read_as_nondimensional(tmp_path: Path) -> None:
    with pytest.raises(WrongValues, match=r"h\.csv:1: no column frequency and real and imaginary"):
        fl.Receptance(file=table(tmp_path, WITH_UNITS))


def test_a_study_tells_where_the_table_is_wrong(tmp_path: Path) -> None:
    table(tmp_path)
    study = tmp_path / "study.yaml"
    study.write_text("""schema: 1
scene:
  dimensional:
    normal_load: 20 N
    belt_speed: 2 cm/s
    drive: {amplitude: 20 N, frequency: 16 Hz}
    body: {receptance: {file: h.csv, free_mass: 500 g}}
laws: [{kind: coulomb, mu: 0.4}]
""")
    assert "<i>H</i><sup>\N{MINUS SIGN}1</sup>" in equations(load_study(study))[0]

    (tmp_path / "h.csv").write_text("frequency,real,imaginary\n0,1e-3,0\n2,1e-3,-1e-5\n1,1e-3,-1e-5\n")
    with pytest.raises(StudyError, match=r"study.yaml:7:\d+: .*h.csv:4: frequency 1 after 2") as told:
        load_study(study)
    assert "scene.dimensional.body.receptance" in str(told.value)
