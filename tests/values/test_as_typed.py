"""Scenes, laws, methods and results as they show themselves: what one would type to make them again."""

from __future__ import annotations

import inspect
import pydoc
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from profiles import some
from pydantic import BaseModel
from strategies import LAWS
from truth import ROWS

import frictionlab as fl
from frictionlab.study.load import parse_study
from frictionlab.values.quantities import Record, rebuilt

NAMES: dict[str, Any] = {name: getattr(fl, name) for name in fl.__all__}
RECORDS = {name: kind for name, kind in NAMES.items() if isinstance(kind, type) and issubclass(kind, Record)}
SCENE = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1))
BODY = {
    "mass_kg": 1,
    "stiffness_N_per_m": 4,
    "damping_N_s_per_m": 0.4,
    "length_m": 0.01,
    "belt_speed_m_per_s": 0.1,
}
IN_SI: list[dict[str, Any]] = [
    {},
    {"normal_load_N": 3, "drive": {"amplitude_N": 2, "frequency_rad_per_s": 3}},
    {
        "drive": {"unbalance_kg_m": 0.1, "frequency_rad_per_s": 3, "waveform": "square"},
        "transverse": {"stiffness_N_per_m": 3, "damping_N_s_per_m": 0, "load": {"amplitude_N": 1}},
        "belt_vibration": {"velocity_amplitude_m_per_s": 1e-3, "frequency_ratio": "3/2"},
        "normal_load_variation": {"amplitude": 0.3, "contact": "constant"},
        "initial": {"x2_m": 0.01},
    },
]
METHODS = [
    fl.Auto(),
    fl.Exact(),
    fl.March(stepper="rk4", steps=100),
    fl.HarmonicBalance(harmonics=3, tail=False),
    fl.Mdsm(error="distance"),
    fl.Shooting(),
]


def again(shown: object) -> Any:
    """What is made by typing what is shown."""
    return eval(repr(shown), dict(NAMES))


@some(20, "scenes of every kind")
@pytest.mark.parametrize(
    "name", [name for name, row in ROWS.items() if row.also and row.law["kind"] != "rate-and-state"]
)
def test_what_a_scene_and_its_law_show_makes_them_again(name: str) -> None:
    keys, law = ROWS[name].scene, ROWS[name].law
    study = parse_study({"schema": 1, "scene": keys, "laws": [law], "sweep": {"scene.belt_speed": [1, 2.5]}})

    assert again(study.scene) == study.scene
    assert again(study).resolved() == study.resolved()
    assert "None" not in repr(study)


@pytest.mark.parametrize(
    "swept",
    [
        {"scene.belt_speed": {"start": 1, "stop": 5, "within": 0.01}},
        {"linked": [{"scene.drive.frequency": [1, 2], "scene.normal_load": [3, 4]}]},
        {"friction": [0.1, 0.2]},
        {"scene.drive.waveform": ["sine", {"harmonics": [{"order": 2, "amplitude": 1, "phase": 30}]}]},
    ],
    ids=lambda swept: next(iter(swept)),
)
def test_what_a_study_shows_makes_it_again(swept: dict[str, Any]) -> None:
    laws = [fl.Coulomb(mu=0.4, label="worn"), fl.Dahl(mu=0.3, stiffness=4)]
    study = fl.Study.of(SCENE, laws, ["auto", fl.March(steps=100)], swept, tolerance=1e-6, keep={"orbit": 20})

    assert again(study).resolved() == study.resolved()


@pytest.mark.parametrize("more", IN_SI, ids=range(len(IN_SI)))
def test_what_a_scene_in_si_units_shows_makes_it_again(more: dict[str, Any]) -> None:
    scene = fl.Scene(dimensional=BODY | more)

    assert again(scene) == scene
    assert repr(scene).startswith("Scene.si(mass_kg=1, ")
    assert "gravity" not in repr(scene)


@pytest.mark.parametrize("name", LAWS)
@given(data=st.data())
def test_what_a_law_shows_makes_it_again(name: str, data: st.DataObject) -> None:
    law = data.draw(LAWS[name])

    assert again(law) == law
    assert "None" not in repr(law)


@pytest.mark.parametrize("method", METHODS, ids=lambda method: method.name)
def test_what_a_method_shows_makes_it_again(method: Any) -> None:
    assert again(method) == method


@pytest.mark.parametrize(
    ("shown", "text"),
    [
        (
            SCENE,
            "Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=Drive(unbalance=10, frequency=1))",
        ),
        (fl.Dahl(mu=0.4, stiffness=40.5), "Dahl(mu=0.4, stiffness=40.5)"),
        (fl.Stribeck(mu_kinetic=0.2, mu_static=0.3), "Stribeck(mu_kinetic=0.2, mu_static=0.3)"),
        (fl.Coulomb(mu=0.4, label="worn"), "Coulomb(mu=0.4, label='worn')"),
        (fl.March(), "March()"),
        (
            fl.Scene(belt_speed=1, slip=fl.Slip(velocity_amplitude=2, frequency=3, waveform="square")),
            "Scene(belt_speed=1, slip=Slip(velocity_amplitude=2, frequency=3, waveform='square'))",
        ),
        (
            fl.Study.of(
                fl.Scene(damping_ratio=0.1, normal_load=1, belt_speed=0),
                {"soft": fl.Dahl(mu=0.4, stiffness=4)},
                sweep={
                    "scene.belt_speed": {"start": 1, "stop": 9, "num": 3},
                    "scene.normal_load": [*range(1, 20)],
                },
            ),
            "Study.of(Scene(damping_ratio=0.1, normal_load=1, belt_speed=0), {'soft': Dahl(mu=0.4, stiffness=4)}, "
            "sweep={'scene.belt_speed': {'start': 1, 'stop': 9, 'num': 3}, 'scene.normal_load': [1, 2, ..., 19]})",
        ),
    ],
    ids=lambda shown: type(shown).__name__,
)
def test_only_what_one_would_type_is_shown(shown: object, text: str) -> None:
    assert repr(shown) == str(shown) == text


def test_a_run_shows_its_counts_and_needs_their_sentences() -> None:
    study = fl.Study.of(SCENE, fl.Coulomb(mu=0.4), ["exact", "mdsm"])
    needed = fl.needs(SCENE, fl.Coulomb(mu=0.4))

    assert repr(fl.run(study)) == "Run(2 points: 2 ok)"
    assert repr(needed) == "\n".join(needed.sentences)


@pytest.mark.parametrize("name", RECORDS)
def test_the_signature_names_values_plain_types_and_defaults(name: str) -> None:
    kind = RECORDS[name]
    told = str(inspect.signature(kind))

    label = {"label"} if issubclass(kind, fl.FrictionLaw) else set()
    assert set(inspect.signature(kind).parameters) == {*kind.model_fields} | label
    for inside in ("Annotated", "FieldInfo", "Validator", "frictionlab.", "typing.", "'float'", "'str'"):
        assert inside not in told


@pytest.mark.parametrize("name", RECORDS)
def test_help_shows_nothing_of_how_values_are_checked(name: str) -> None:
    shown = pydoc.plain(pydoc.render_doc(RECORDS[name]))
    names = dir(RECORDS[name])

    for inside in ("__pydantic", "model_dump", "model_config", "ValidationError", "Decorator"):
        assert inside not in shown
    assert not {each for each in names if each[:2] == "__"} | ({*names} & {*dir(BaseModel)})


def test_completion_offers_values_and_methods() -> None:
    offered = {name for name in dir(SCENE) if name[0] != "_"}

    assert {"belt_speed", "drive", "with_"} < offered
    assert not {"json", "copy", "model_dump", "parse_obj"} & offered


def test_a_copy_with_a_number_of_another_type_is_not_taken_for_the_same() -> None:
    law = fl.Coulomb(mu=1.0).model_copy(update={"mu": 1})

    assert type(rebuilt(law).mu) is float  # type: ignore[attr-defined]
