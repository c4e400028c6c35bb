"""Sweeps, expectations, laws and ``--set`` of a study in SI units: texts with units, keys without."""

from __future__ import annotations

from typing import Any

import pytest
import ruamel.yaml

import frictionlab as fl
from frictionlab.study.load import parse_study
from frictionlab.values.notes import StudyError, WrongValues

HERE = "scene.dimensional."
BODY = {
    "mass": "0.5 kg",
    "stiffness": "5 kN/m",
    "damping": "5 N s/m",
    "length": "5 um",
    "normal_load": "20 N",
}
SHAKEN = {"velocity_amplitude": "2 mm/s"}


def study(**told: Any) -> dict[str, Any]:
    laws = [
        {"kind": "dahl", "mu": "30 %", "presliding_length": "1 um"},
        {
            "kind": "stribeck",
            "mu_kinetic": 0.3,
            "mu_static": 0.4,
            "stribeck_speed": "1 mm/s",
            "viscosity": "2 s/m",
        },
    ]
    scene = {"dimensional": {**BODY, "belt_vibration": SHAKEN}}
    sweep = {
        f"{HERE}belt_speed": {"start": "0.5 mm/s", "stop": "20 mm/s", "num": 40},
        "linked": [
            {
                f"{HERE}belt_vibration.frequency": ["60 Hz", "1 kHz"],
                f"{HERE}normal_load": ["20 N", "3e-2 kN"],
            },
            {"laws.dahl.presliding_length": ["1 um", "2 µm"], "laws.dahl.mu": [0.3, "40 %"]},
        ],
    }
    where = {f"{HERE}belt_speed": "1 mm/s", "law.presliding_length": "1 um"}
    expect = [{"where": where, "column": "mean_friction_N", "equals": "6000 mN", "within": "1 N"}]
    return {"schema": 1, "scene": scene, "laws": laws, "sweep": sweep, "expect": expect} | told


def in_numbers() -> dict[str, Any]:
    numbers = study()
    numbers["laws"][0] |= {"mu": 0.3, "presliding_length": 1e-6}
    numbers["laws"][1] |= {"stribeck_speed": 1e-3, "viscosity": 2}
    numbers["sweep"] = {
        f"{HERE}belt_speed_m_per_s": {"start": 0.0005, "stop": 0.02, "num": 40},
        "linked": [
            {
                f"{HERE}belt_vibration.frequency_rad_per_s": [376.9911184307752, 6283.185307179587],
                f"{HERE}normal_load_N": [20, 30],
            },
            {"laws.dahl.presliding_length": [1e-6, 2e-6], "laws.dahl.mu": [0.3, 0.4]},
        ],
    }
    where = {f"{HERE}belt_speed_m_per_s": 0.001, "law.presliding_length": 1e-6}
    numbers["expect"] = [{"where": where, "column": "mean_friction_N", "equals": 6, "within": 1}]
    return numbers


def test_a_study_of_texts_is_that_of_its_numbers() -> None:
    texts, numbers = parse_study(study()), parse_study(in_numbers())

    assert texts == numbers
    assert texts.digest() == numbers.digest()
    assert "60 Hz" in texts.to_yaml()
    assert parse_study(ruamel.yaml.YAML(typ="safe").load(texts.to_yaml())) == numbers
    assert parse_study(texts.resolved()) == texts


def test_a_table_has_the_numbers_under_the_keys_with_their_units() -> None:
    sweep = {f"{HERE}belt_speed": ["5 mm/s", "0.6 cm/s"]}
    laws = [{"kind": "coulomb", "mu": 0.3}]
    scene = {"dimensional": {**BODY, "drive": {"amplitude": "0 N", "frequency": "60 Hz"}}}
    run = fl.run({"schema": 1, "scene": scene, "laws": laws, "sweep": sweep})

    assert [*run.table[f"{HERE}belt_speed_m_per_s"]] == [0.005, 0.006]
    assert [*run.table["mean_friction_N"]] == pytest.approx([6, 6])


@pytest.mark.parametrize(
    ("override", "said"),
    [
        (f"sweep.{HERE}belt_speed=[1 mm/s, 2 mm]", "belt_speed[1]: '2 mm' is a length [m]; give a speed [m/s]"),
        (f"sweep.{HERE}belt_speed=[1 mm/s, 1e3 um/s]", "belt_speed[1]: 0.001 is in the list twice"),
        (f"sweep.{HERE}belt_speed.stop=6", "belt_speed.stop: 6 has no unit; give a speed [m/s] such as '2 mm/s'"),
        (f"sweep.{HERE}belt_speed.stop=1 um/s", "belt_speed.stop: must be > start = 0.0005, got 1e-06"),
        (f"{HERE}belt_speed=1 mm/s", f"the study sweeps {HERE}belt_speed_m_per_s: set"),
        (f"{HERE}mass=1", f"{HERE}mass: 1 has no unit; give a mass"),
        (f"sweep.{HERE}gravity=[1 g_0]", "scene.dimensional gives normal_load, so gravity_m_per_s2 cannot be swept"),
        ("laws.stribeck.stribeck_speed=1 um", "laws[1].stribeck_speed: '1 um' is a length [m]; give a speed [m/s]"),
        ("laws=[{kind: lugre, mu_kinetic: 0.3, stiffness: 5 N/um}]", "; contact_stiffness takes what is not"),
        ("laws=[{kind: dahl, mu: 0.3, stiffness: 5 N}]", "'5 N' is a force [N]; give a stiffness per force"),
        ("expect[0].equals=1 m", "expect[0].equals: '1 m' is a length [m]; give a force [N]"),
        ("expect[0].where={law.presliding_length: 1 N}", "where.law.presliding_length: '1 N' is a force [N]; give a"),
        ("scene={damping_ratio: 0, normal_load: 1, belt_speed: 1 m/s}", "(units go with a scene in SI units: scene."),
    ],
)  # fmt: skip
def test_a_wrong_text_is_told_under_the_key_that_was_written(override: str, said: str) -> None:
    with pytest.raises(StudyError) as caught:
        parse_study(study(), [override])

    assert said in str(caught.value)


def test_an_override_takes_the_place_of_the_same_value_under_its_other_key() -> None:
    overrides = [f"{HERE}mass_kg=0.6", f"sweep.{HERE}belt_speed_m_per_s=[0.001, 0.002]"]
    found = parse_study(study(expect=[]), overrides)

    assert found.scene.values()["dimensional.mass_kg"] == 0.6
    assert found.sweep[f"{HERE}belt_speed_m_per_s"] == (0.001, 0.002)


def test_a_law_made_in_python_takes_texts_where_the_scene_has_units() -> None:
    body = {**BODY, "belt_speed": "5 mm/s", "drive": {"amplitude": "20 N", "frequency": "60 Hz"}}
    scene = fl.Scene.si(**body)
    text, number = (fl.Dahl(mu=0.3, presliding_length=each) for each in ("1 um", 1e-6))
    plain = fl.Scene(belt_speed=1, slip=fl.Slip(velocity_amplitude=2, frequency=1))

    assert text == number
    means = [fl.steady_state(scene, law).mean_friction for law in (text, number)]
    assert means[0] == means[1] > 0.0
    assert "presliding_length: 1 um" in fl.Study.of(scene, text).to_yaml()
    with pytest.raises(ValueError, match="1 um has a unit, and the scene is nondimensional"):
        fl.steady_state(plain, text)
    with pytest.raises(StudyError, match="must be a number, got the text '1 um'"):
        fl.Study.of(plain, text)
    with pytest.raises(WrongValues, match=r"stiffness: .* contact_stiffness takes what is not per unit"):
        fl.Dahl(mu=0.3, stiffness="5 N/um")


def test_a_verdict_names_numbers_as_they_were_written() -> None:
    body = {**BODY, "belt_speed": "5 mm/s", "drive": {"amplitude": "20 N", "frequency": "60 Hz"}}
    claim = {"where": {f"{HERE}belt_speed": "5 mm/s"}, "column": "mean_friction_N", "below": "1 mN"}
    tree = {
        "schema": 1,
        "scene": {"dimensional": body},
        "laws": [{"kind": "coulomb", "mu": 0.3}],
        "expect": [claim],
    }
    study = parse_study(tree)

    (verdict,) = fl.run(study).verdicts
    assert "mean_friction_N below 1 mN" in verdict.sentence
    assert "belt_speed_m_per_s 5 mm/s" in verdict.sentence
    assert parse_study(study.resolved()) == study
