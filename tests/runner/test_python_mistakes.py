"""Mistakes made in Python: each is told as a study tells it, before anything is solved, and nothing slips past."""

from __future__ import annotations

import math
import pickle
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from profiles import deep

import frictionlab as fl
from frictionlab.runner.state import NoMeanError
from frictionlab.study.load import parse_study
from frictionlab.study.registry import method_names, read_law_file
from frictionlab.study.written import yaml_text
from frictionlab.values.notes import StudyError, WrongValues

GIVEN: dict[str, Any] = {
    "damping_ratio": 0.1,
    "normal_load": 10.0,
    "belt_speed": 5.0,
    "drive": {"unbalance": 10.0, "frequency": 1.0},
}
SCENE, LAW = fl.Scene(**GIVEN), fl.Coulomb(mu=0.4)
PLANAR = SCENE.with_(transverse={"natural_frequency": 2, "damping_ratio": 0.1, "load": {"amplitude": 3}})
BODY = {"mass_kg": 1, "stiffness_N_per_m": 4, "damping_N_s_per_m": 0.4, "length_m": 0.01}
SI = fl.Scene(dimensional={**BODY, "belt_speed_m_per_s": 0.1})

EIGHT: list[tuple[Callable[[], object], str]] = [
    (lambda: fl.Coulomb(0.4), "Coulomb takes its values by name: write Coulomb(mu=0.4)"),
    (
        lambda: fl.Stribeck(mu=0.4, mu_static=0.6),
        "Stribeck: mu: unknown key; allowed: mu_kinetic, mu_static, stribeck_speed, stribeck_exponent, viscosity, "
        "curve\n    did you mean 'mu_kinetic'?",
    ),
    (lambda: fl.Coulomb(mu="0.4"), "Coulomb: mu: must be a number, got the text '0.4' (remove the quotes)"),
    (lambda: SCENE.with_(normal_load=-3), "Scene: normal_load: must be > 0, got -3"),
    (
        lambda: fl.Scene(**GIVEN, initail={"x": 1}),
        "Scene: initail: unknown key; allowed: damping_ratio, normal_load, belt_speed, drive, transverse, body, "
        "slip, transverse_slip, belt_vibration, normal_load_variation, initial, dimensional\n"
        "    did you mean 'initial'?",
    ),
    (
        lambda: fl.steady_state(SCENE, LAW, method="shoting"),
        f"unknown method 'shoting'; installed: {', '.join(method_names())}; did you mean 'shooting'?",
    ),
    (
        lambda: fl.steady_state(SCENE, "coulomb"),  # type: ignore[arg-type]
        "law must be a friction law such as fl.Coulomb(mu=0.4), got the text 'coulomb'; "
        "did you mean Coulomb(mu=...)?",
    ),
    (
        lambda: fl.steady_state(PLANAR, LAW, method="exact").raise_for_status(),
        "refused, no mean_friction: exact works along one line: this scene has a transverse load; use shooting",
    ),
]


MORE: list[tuple[Callable[[], object], str]] = [
    (lambda: fl.Scene({"belt_speed": 5}), "Scene takes its values by name: write Scene(**values)"),  # type: ignore[call-arg]
    (lambda: fl.Mdsm("distance"), "Mdsm takes its values by name: write Mdsm(error='distance')"),  # type: ignore[call-arg]
    (
        lambda: fl.HarmonicBalance(3),
        "HarmonicBalance takes its values by name: write HarmonicBalance(harmonics=3)",
    ),  # type: ignore[call-arg]
    (lambda: fl.Scene(SCENE), "Scene takes its values by name, and this is a Scene already"),  # type: ignore[call-arg]
    (
        lambda: SCENE.with_(belt_speed=np.ones(3)),
        "Scene: belt_speed: must be a number, got an array of shape (3,)\n"
        "    one number here: fl.curve, fl.compare and fl.sweep take several",
    ),
    (
        lambda: fl.Coulomb(mu=[0.3, 0.4]),  # type: ignore[arg-type]
        "Coulomb: mu: must be a number, got a list\n"
        "    one number here: fl.curve, fl.compare and fl.sweep take several",
    ),
    (
        lambda: SCENE.with_(5),  # type: ignore[arg-type]
        "with_ takes values by name, belt_speed=2, or by path, {'drive.frequency': 2}",
    ),
    (
        lambda: fl.HarmonicBalance(harmonics=2.5),  # type: ignore[arg-type]
        "HarmonicBalance: harmonics: must be a whole number, got 2.5",
    ),
    (
        lambda: fl.HarmonicBalance(tail="yes"),  # type: ignore[arg-type]
        "HarmonicBalance: tail: must be true or false, got the text 'yes'",
    ),
    (
        lambda: fl.Exact(certify=True),  # type: ignore[call-arg]
        "Exact: certify: is gone: use method certified, which the package frictionlab-certified brings",
    ),
    (
        lambda: fl.curve(SCENE, LAW, np.ones((2, 2))),
        "belt_speed must be a list of finite numbers, got an array of shape (2, 2)",
    ),
    (
        lambda: fl.compare(SCENE, LAW, pd.DataFrame({"speed": [1.0]})),
        "belt_speed must be a list of finite numbers, got DataFrame of shape (1, 1)",
    ),
    (
        lambda: fl.curve(SCENE, LAW, {"start": 1, "stop": 2, "num": 3}),  # type: ignore[arg-type]
        "belt_speed must be a list of finite numbers, got a mapping; fl.compare and fl.sweep take ranges",
    ),
    (lambda: fl.curve(SCENE, LAW, []), "belt_speed must be a list of finite numbers, got none"),
    (
        lambda: fl.compare(SCENE, LAW, [1, math.nan]),
        "belt_speed must be a list of finite numbers, got nan at [1]",
    ),
    (
        lambda: fl.trajectory(SCENE, LAW, initial=3),  # type: ignore[arg-type]
        "Scene: initial: must be Initial(...) or a mapping, got 3",
    ),
    (
        lambda: fl.steady_state(SCENE, LAW).orbit(2.5),  # type: ignore[arg-type]
        "n must be a whole number of at least 1, got 2.5",
    ),
    (
        lambda: fl.attractors(SCENE, LAW, [1.0], starts="8"),  # type: ignore[arg-type]
        "starts must be a whole number of at least 1, got the text '8' (remove the quotes)",
    ),
]


@pytest.mark.parametrize(("mistake", "said"), EIGHT + MORE)
def test_a_mistake_in_python_is_told_in_the_words_of_a_study(
    mistake: Callable[[], object], said: str
) -> None:
    with pytest.raises(Exception) as caught:  # noqa: PT011 - the text is what counts
        mistake()

    assert str(caught.value) == said
    assert "pydantic" not in f"{type(caught.value)} {said}"


@pytest.mark.parametrize("path", ["mu", "mu_static", "wobble"])
@pytest.mark.parametrize("value", [-1, "0.4", [1], {}, math.inf])
def test_a_law_says_in_python_what_a_study_says_of_it(path: str, value: Any) -> None:
    values = {"mu": 0.4, path: value}
    with pytest.raises(WrongValues) as in_python:
        fl.Coulomb(**values)
    with pytest.raises(StudyError) as in_study:
        parse_study({"schema": 1, "scene": GIVEN, "laws": [{"kind": "coulomb", **values}]})

    several = (
        "one number here: fl.curve, fl.compare and fl.sweep take several"  # which a study says elsewhere
    )
    told = {
        (f"laws[0].{each.path}", each.what, each.hint.replace(several, ""))
        for each in in_python.value.mistakes
    }
    assert told == {
        (each.path, each.what.replace(" .inf", " inf"), each.hint) for each in in_study.value.mistakes
    }


def test_numbers_of_numpy_and_pandas_are_taken_for_what_they_are() -> None:
    speeds = [5.0, 20.0]
    usual = fl.compare(SCENE, LAW, speeds).table["mean_friction"].tolist()

    for given in (np.array(speeds), pd.Series(speeds, index=[7, 8]), range(5, 21, 15), tuple(speeds)):
        assert fl.compare(SCENE, LAW, given).table["mean_friction"].tolist() == usual
        assert fl.sweep(SCENE, LAW, {"scene.belt_speed": given}).table["mean_friction"].tolist() == usual
        assert fl.curve(SCENE, LAW, given)["mean_friction"].tolist() == usual
    assert fl.compare(SCENE, LAW, 5).table["mean_friction"].tolist() == usual[:1]
    assert len(fl.steady_state(SCENE, LAW).orbit(np.int64(3))) == 3
    assert len(fl.trajectory(SCENE, LAW, np.int64(1), samples=4, initial={"x": 1})) == 5  # type: ignore[arg-type]


def test_every_mistake_is_told_at_once() -> None:
    with pytest.raises(WrongValues) as caught:
        fl.Scene(damping_ratio=-1, normal_load="x", drive={"frequency": 0, "unbalnce": 1})

    assert {mistake.path for mistake in caught.value.mistakes} == {
        *("belt_speed", "normal_load", "drive.unbalnce", "drive.frequency", "damping_ratio"),
    }
    assert pickle.loads(pickle.dumps(caught.value)).mistakes == caught.value.mistakes


def test_a_scene_with_other_values_is_a_scene_made_of_them() -> None:
    changed = SCENE.with_(normal_load=3, **{"drive.frequency": 2, "initial.x": 1})

    assert changed == fl.Scene(
        **{**GIVEN, "normal_load": 3, "initial": {"x": 1}, "drive": {"unbalance": 10, "frequency": 2}}
    )
    assert SCENE.with_({"drive.frequency": 2}, normal_load=3, **{"initial.x": 1}) == changed
    assert changed.with_(initial=None, normal_load=10, **{"drive.frequency": 1}) == SCENE
    assert SCENE.with_() == SCENE
    assert SCENE.with_(drive=fl.Drive(amplitude=3, frequency=1), **{"drive.frequency": 2}).frequency == 2.0
    assert SI.with_(**{"dimensional.mass_kg": 4}).dimensional.mass_kg == 4.0  # type: ignore[union-attr]


@pytest.mark.parametrize(
    ("scene", "changes", "said"),
    [
        (SCENE, {"drive.frequncy": 2}, "Scene: drive.frequncy: unknown key"),
        (SCENE, {"drive.amplitude": 2}, "Scene: drive: give exactly one of unbalance and amplitude"),
        (SCENE, {"belt_speed.x": 2}, "Scene: belt_speed: must be a number, got a mapping"),
        (
            SCENE,
            {"transverse.load.amplitude": 2},
            "Scene: transverse.natural_frequency: required key is missing",
        ),
        (SI, {"belt_speed": 2}, "Scene: belt_speed: leave it out, dimensional gives the scene"),
        (SI, {"dimensional.mass_kg": -2}, "Scene: dimensional.mass_kg: must be > 0, got -2"),
    ],
)
def test_a_scene_refuses_other_values_that_make_none(
    scene: fl.Scene, changes: dict[str, Any], said: str
) -> None:
    with pytest.raises(WrongValues) as caught:
        scene.with_(**changes)

    assert said in str(caught.value)


SMUGGLED: list[tuple[dict[str, Any], str]] = [
    ({"scene": SCENE.model_copy(update={"normal_load": -3})}, "Scene: normal_load: must be > 0, got -3"),
    ({"scene": SCENE.model_copy(update={"wobble": 3})}, "Scene: wobble: unknown key"),
    (
        {"scene": SCENE.model_copy(update={"drive": SCENE.drive.model_copy(update={"frequency": "1"})})},  # type: ignore[union-attr]
        "Scene: drive.frequency: must be a number, got the text '1' (remove the quotes)",
    ),
    (
        {"scene": SI.model_copy(update={"belt_speed": 3.0})},
        "belt_speed: leave it out, dimensional gives the scene",
    ),
    ({"law": LAW.model_copy(update={"mu": math.nan})}, "Coulomb: mu: must be a finite number, got nan"),
    ({"law": fl.Coulomb.model_construct()}, "Coulomb: mu: required key is missing"),
    ({"law": fl.Coulomb}, "got the class Coulomb; did you mean Coulomb(mu=...)?"),
    ({"scene": GIVEN}, "scene must be an fl.Scene, got a mapping; did you mean fl.Scene(**scene)?"),
    (
        {"method": fl.March},
        "or a method such as fl.March(), got the class March; did you mean March()?",
    ),
    ({"method": fl.March().model_copy(update={"stepper": "rk5"})}, "March: stepper: must be 'moreau', 'rk4'"),
    *(
        ({"tolerance": wrong}, f"tolerance must be a positive number, got {told}")
        for wrong, told in [
            (True, "True"),
            (0.0, "0"),
            (-1e-8, "-1e-08"),
            (math.nan, "nan"),
            (math.inf, "inf"),
        ]
    ),
]


@pytest.mark.parametrize(("wrong", "said"), SMUGGLED)
def test_nothing_unchecked_reaches_a_solver(wrong: dict[str, Any], said: str) -> None:
    given: dict[str, Any] = {"scene": SCENE, "law": LAW, **wrong}
    for solve in (fl.steady_state, lambda **all_: fl.curve(**all_, belt_speed=[1.0])):
        with pytest.raises((TypeError, ValueError)) as caught:
            solve(**given)
        assert said in str(caught.value)


STUDY = parse_study({"schema": 1, "scene": GIVEN, "laws": [{"kind": "coulomb", "mu": 0.4}]})


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"study": 3}, "study must be the path of a study file, a mapping or a Study, got 3"),
        ({"study": replace(STUDY, tolerance=-1.0)}, "tolerance must be a positive number, got -1"),
        ({"study": replace(STUDY, scene=SMUGGLED[0][0]["scene"])}, "Scene: normal_load: must be > 0, got -3"),
        (
            {"study": replace(STUDY, laws=(replace(STUDY.laws[0], parameters={"mu": 0}),))},
            "Coulomb: mu: must be > 0, got 0",
        ),
        ({"study": STUDY, "columns": "floquet"}, "columns must be a list of names, got the text 'floquet'"),
        ({"study": STUDY, "existing": "keep"}, "existing must be 'reuse' or 'replace', got the text 'keep'"),
        ({"study": STUDY, "executor": 4}, "executor must be a concurrent.futures.Executor, got 4"),
        (
            {"study": STUDY, "overrides": "tolerance=1"},
            "overrides must be a list such as ['scene.belt_speed=5']",
        ),
    ],
)
def test_a_run_says_what_it_cannot_use(given: dict[str, Any], said: str) -> None:
    with pytest.raises((TypeError, ValueError)) as caught:
        fl.run(**given)

    assert said in str(caught.value)


@pytest.mark.parametrize("speeds", [["1"], [True], "fast", None, [1j]])
def test_belt_speeds_are_never_made_of_something_else(speeds: Any) -> None:
    with pytest.raises(ValueError, match="belt_speed must be a list of finite numbers, got"):
        fl.curve(SCENE, LAW, belt_speed=speeds)


def test_a_refused_state_raises_nothing_and_says_so() -> None:
    refused = fl.steady_state(PLANAR, LAW, method="exact")
    solved = fl.steady_state(SCENE, LAW)

    assert repr(refused) == f"SteadyState(refused, no mean_friction: {refused.reason})"
    assert repr(solved).startswith(f"SteadyState(ok, mean_friction={solved.mean_friction!r}, error=")
    assert solved.raise_for_status() is solved
    with pytest.raises(NoMeanError, match="refused"):
        refused.raise_for_status()


def test_a_state_that_is_not_unique_shows_its_range() -> None:
    state = fl.steady_state(SCENE.with_(belt_speed=0, normal_load=1e3), LAW)

    assert repr(state).startswith(f"SteadyState(not_unique, mean_friction between {state.mean_low!r} and ")


LAW_FILE = """import frictionlab as fl


class Told(fl.SlidingLaw):
    '''Friction of one strength. mu [-], > 0: friction coefficient. Source: Amontons (1699).'''

    mu: fl.Positive

    def sliding_friction(self, speed: float) -> float:
        return self.mu
"""


def _answered(given: tuple[fl.Scene, Any]) -> fl.SteadyState:
    return fl.steady_state(*given, "mdsm")


@deep("processes")
def test_states_and_laws_of_files_go_to_other_processes_and_come_back(tmp_path: Path) -> None:
    file = tmp_path / "told.py"
    file.write_text(LAW_FILE)
    law = read_law_file(file).laws["told"](mu=0.4)  # type: ignore[call-arg]
    state = fl.steady_state(SCENE, LAW)
    twin = pickle.loads(pickle.dumps(state))

    assert pickle.loads(pickle.dumps(law)) == law
    assert repr(twin) == repr(state)
    assert np.array_equal(twin.orbit(16).v1, state.orbit(16).v1)
    study = tmp_path / "study.yaml"
    plan = {"schema": 1, "scene": GIVEN, "plugins": ["told.py"], "laws": [{"kind": "told", "mu": 0.4}]}
    study.write_text(yaml_text(plan | {"methods": ["mdsm"]}))
    with ProcessPoolExecutor(1, get_context("spawn")) as pool:
        (elsewhere,) = pool.map(_answered, [(SCENE, law)])
        table = fl.run(study, executor=pool).table
    assert table["status"].tolist() == [elsewhere.status] == ["refused"]
    assert table["reason"].tolist() == [elsewhere.reason]
