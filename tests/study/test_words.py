"""Sweeps over words and waveforms: from the file to the table, its digest, its figures and its page."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

import frictionlab as fl
from frictionlab.charts.curves import family_of
from frictionlab.runner.pieces import blocks_of_table, task_of
from frictionlab.runner.store import Keys
from frictionlab.runner.table import inputs
from frictionlab.scene.waveforms import Form, Term
from frictionlab.study.load import load_study, parse_study
from frictionlab.study.study import Study
from frictionlab.study.written import yaml_text

SUM = {"harmonics": [{"order": 1, "amplitude": 1}, {"order": 3, "amplitude": 0.5, "phase": 90}]}
FORMULA = "sin(theta) + 0.5 sin(3 theta + 90 deg)"
SCENE: dict[str, Any] = {
    "damping_ratio": 0.1,
    "normal_load": 1,
    "belt_speed": 1,
    "drive": {"amplitude": 1, "frequency": 2},
    "normal_load_variation": {"amplitude": 0.3},
}
SWEEP: dict[str, Any] = {
    "scene.belt_speed": [0.5, 1.0],
    "scene.drive.waveform": ["sine", "square", SUM],
    "scene.normal_load_variation.contact": ["per_load", "constant"],
    "scene.normal_load_variation.frequency_ratio": [1, "3/2"],
}


def study(sweep: Any = SWEEP, **changes: Any) -> dict[str, Any]:
    return {
        "schema": 1,
        "scene": SCENE,
        "laws": [{"kind": "coulomb", "mu": 0.4}],
        "sweep": sweep,
        **changes,
    }


def columns(plan: Study) -> pd.DataFrame:
    """The input columns of its table."""
    return pd.DataFrame(inputs(list(plan.curves())).columns)


def test_every_combination_of_words_is_a_point_whose_scene_has_the_words_of_its_row() -> None:
    plan = parse_study(study())
    table, scenes = columns(plan), [case.scene for case in plan.cases()]

    assert len(table) == 2 * 3 * 2 * 2
    assert table["scene.drive.waveform"].unique().tolist() == ["sine", "square", FORMULA]
    assert table["scene.normal_load_variation.contact"].unique().tolist() == ["per_load", "constant"]
    assert sorted(table["scene.normal_load_variation.frequency_ratio"].unique()) == [1.0, 1.5]
    forms = [scene.drive.waveform for scene in scenes if scene.drive is not None]
    assert list(map(str, forms)) == table["scene.drive.waveform"].tolist()
    assert Form("harmonics", (Term(1, 1.0, 0.0), Term(3, 0.5, 90.0))) in forms


def test_a_resolved_study_with_words_is_the_same_study(tmp_path: Path) -> None:
    where = {"scene.drive.waveform": SUM, "scene.normal_load_variation.frequency_ratio": "3/2"}
    once = parse_study(study(expect=[{"where": where, "column": "error", "below": 1, "because": "x"}]))
    file = tmp_path / "study.yaml"
    file.write_text(yaml_text(once.resolved()))

    again = load_study(file)
    assert again == once
    assert again.digest() == once.digest()
    assert once.expect[0].where == {
        "scene.drive.waveform": FORMULA,
        "scene.normal_load_variation.frequency_ratio": 1.5,
    }


CHANGES = [
    {"drive": {**SCENE["drive"], "waveform": "square"}},
    {"drive": {**SCENE["drive"], "waveform": SUM}},
    {"normal_load_variation": {"amplitude": 0.3, "contact": "constant"}},
    {"normal_load_variation": {"amplitude": 0.3, "frequency_ratio": "3/2"}},
    {"belt_vibration": {"velocity_amplitude": 1}},
]


def test_each_change_of_a_word_gives_another_digest_and_another_key_of_its_chunks() -> None:
    plans = [parse_study(study({}, scene=SCENE | change)) for change in [{}, *CHANGES]]
    keys = Keys({})
    blocks = [blocks_of_table(list(plan.curves()), task_of(plan)) for plan in plans]
    found = [keys.of(piece) for (block,) in blocks for piece in block.pieces]

    assert not any(key.startswith("?") for key in found)
    assert len(set(found)) == len(plans)
    assert len({plan.digest() for plan in plans}) == len(plans)
    words = [parse_study(study({"scene.drive.waveform": ["sine", each]})) for each in ("square", SUM)]
    assert words[0].digest() != words[1].digest()


def test_words_are_set_from_the_command_line() -> None:
    plan = parse_study(
        study({}), ["scene.drive.waveform=square", "scene.belt_vibration.velocity_amplitude=2"]
    )
    swept = parse_study(
        study({}), ["sweep.scene.drive.waveform=[sine, {harmonics: [{order: 2, amplitude: 1}]}]"]
    )

    assert plan.scene.drive is not None
    assert plan.scene.drive.waveform == Form("square")
    assert [str(each) for each in swept.sweep["scene.drive.waveform"]] == ["sine", "sin(2 theta)"]


def found(plan: Study) -> pd.DataFrame:
    """A table of it, filled with a number of its own for each row."""
    table = columns(plan)
    table["status"] = "ok"
    table["mean_friction"] = 0.01 * np.arange(len(table))
    return table


def test_words_tell_curves_apart_and_never_lie_along_the_axis() -> None:
    family = family_of(found(parse_study(study())))
    alone = family_of(found(parse_study(study({"scene.drive.waveform": ["square", "sine"]}))))

    assert alone is None
    assert family is not None
    assert family.abscissa == "scene.belt_speed"
    assert family.member == "scene.drive.waveform"
    assert [curve.member for curve in family.curves[:3]] == [
        ("scene.drive.waveform", each) for each in ("sine", "square", FORMULA)
    ]
    assert len(family.panels) == 4


SI: dict[str, Any] = {
    "mass_kg": 2.0,
    "stiffness_N_per_m": 800.0,
    "damping_N_s_per_m": 8.0,
    "length_m": 1e-3,
    "belt_speed_m_per_s": 0.02,
    "drive": {"amplitude_N": 3.0, "frequency_rad_per_s": 25.0, "waveform": "square", "direction": 30},
    "transverse": {"stiffness_N_per_m": 500.0, "damping_N_s_per_m": 5.0},
    "belt_vibration": {"velocity_amplitude_m_per_s": 0.05, "phase": 20, "waveform": SUM, "direction": 60},
    "normal_load_variation": {"amplitude": 0.3, "frequency_ratio": "3/2", "contact": "constant"},
}


def test_a_scene_in_si_units_has_every_key_in_its_own_scales() -> None:
    scene = fl.Scene(dimensional=SI)
    plain = fl.Scene(  # omega_1 = 20 rad/s, omega_1 L = 0.02 m/s, K_1 L = 0.8 N
        damping_ratio=0.1,
        normal_load=2 * 9.81 / 0.8,
        belt_speed=1.0,
        drive={"amplitude": 3.0 / 0.8, "frequency": 1.25, "waveform": "square", "direction": 30},
        transverse=scene.transverse,
        belt_vibration={"velocity_amplitude": 2.5, "phase": 20, "waveform": SUM, "direction": 60},
        normal_load_variation={"amplitude": 0.3, "frequency_ratio": 1.5, "contact": "constant"},
    )

    names = [name for name in fl.Scene.model_fields if name != "dimensional"]
    assert {name: getattr(scene, name) for name in names} == {name: getattr(plain, name) for name in names}
    assert fl.Scene(**scene.given()) == scene
    tau = np.linspace(0.0, 7.0, 50)
    for one, other in zip(scene.signals().belt, plain.signals().belt, strict=True):
        np.testing.assert_allclose(one(tau), other(tau), atol=1e-13)
