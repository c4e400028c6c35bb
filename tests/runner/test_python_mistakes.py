"""Mistakes made in Python: each is told as a study tells it, before anything is solved, and nothing slips past."""

from __future__ import annotations

import math
import pickle
import re
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from functools import partial
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from fig_4b import GIVEN, LAW, SCENE, STEADY
from profiles import deep

import frictionlab as fl
from frictionlab.runner.state import NoMeanError
from frictionlab.study.load import parse_study
from frictionlab.study.registry import method_names, read_law_file
from frictionlab.study.written import yaml_text
from frictionlab.values.notes import StudyError, WrongValues

PLANAR = SCENE.with_(transverse={"natural_frequency": 2, "damping_ratio": 0.1, "load": {"amplitude": 3}})
BODY = {"mass_kg": 1, "stiffness_N_per_m": 4, "damping_N_s_per_m": 0.4, "length_m": 0.01}
SI = fl.Scene(dimensional={**BODY, "belt_speed_m_per_s": 0.1})

NUMBERS = "belt_speed must be a list of finite numbers, got"
SEVERAL = "one number here: fl.curve, fl.compare and fl.sweep take several"
WHOLE = "must be a whole number of at least 1, got"
SAID = {
    "fl.Coulomb(0.4)": "Coulomb takes its values by name: write Coulomb(mu=0.4)",
    "fl.Stribeck(mu=0.4, mu_kinetic=0.6, mu_static=1)": "Stribeck: mu: unknown key; allowed: mu_kinetic, "
    "mu_static, stribeck_speed, stribeck_exponent, viscosity, curve\n    did you mean 'mu_kinetic'?",
    "fl.Stribeck(mu=-0.4, mu_static=1)": "Stribeck: mu: must be >= 0, got -0.4",
    "SI.with_(damping_ratio=0.1)": "Scene: damping_ratio: takes the place of damping: write "
    "with_(damping=None, damping_ratio=0.1)",
    "fl.curve(SI, LAW, ['1 mm'])": "belt_speed: '1 mm' is a length [m]; give a speed [m/s] such as 2 mm/s",
    "fl.Coulomb(mu='0.4')": "Coulomb: mu: must be a number, got the text '0.4' (remove the quotes)",
    "SCENE.with_(normal_load=-3)": "Scene: normal_load: must be > 0, got -3",
    "fl.Scene(**GIVEN, initail={'x': 1})": "Scene: initail: unknown key; allowed: damping_ratio, spring, "
    "normal_load, belt_speed, drive, transverse, body, slip, transverse_slip, belt_vibration, "
    "normal_load_variation, initial, dimensional\n    did you mean 'initial'?",
    "fl.steady_state(SCENE, LAW, method='shoting')": f"unknown method 'shoting'; installed: "
    f"{', '.join(method_names())}; did you mean 'shooting'?",
    "fl.steady_state(SCENE, 'coulomb')": "law must be a friction law such as fl.Coulomb(mu=0.4), "
    "got the text 'coulomb'; did you mean Coulomb(mu=...)?",
    "fl.steady_state(PLANAR, LAW, method='exact').raise_for_status()": "refused, no mean_friction: exact works "
    "along one line: this scene has a transverse load; use shooting",
    "fl.Scene({'belt_speed': 5})": "Scene takes its values by name: write Scene(**values)",
    "fl.Mdsm('distance')": "Mdsm takes its values by name: write Mdsm(error='distance')",
    "fl.HarmonicBalance(3)": "HarmonicBalance takes its values by name: write HarmonicBalance(harmonics=3)",
    "fl.Scene(SCENE)": "Scene takes its values by name, and this is a Scene already",
    "SCENE.with_(belt_speed=np.ones(3))": "Scene: belt_speed: must be a number, got an array of shape (3,)\n"
    f"    {SEVERAL}",
    "fl.Coulomb(mu=[0.3, 0.4])": f"Coulomb: mu: must be a number, got a list\n    {SEVERAL}",
    "SCENE.with_(5)": "with_ takes values by name, belt_speed=2, or by path, {'drive.frequency': 2}",
    "fl.HarmonicBalance(harmonics=2.5)": "HarmonicBalance: harmonics: must be a whole number, got 2.5",
    "fl.HarmonicBalance(tail='yes')": "HarmonicBalance: tail: must be true or false, got the text 'yes'",
    "fl.Exact(certify=True)": "Exact: certify: is gone: use method certified, which the package "
    "frictionlab-certified brings",
    "fl.curve(SCENE, LAW, np.ones((2, 2)))": f"{NUMBERS} an array of shape (2, 2)",
    "fl.compare(SCENE, LAW, pd.DataFrame({'speed': [1.0]}))": f"{NUMBERS} DataFrame of shape (1, 1)",
    "fl.curve(SCENE, LAW, {'stop': 2})": "belt_speed: start: required key is missing\n"
    "belt_speed: num: required key is missing",
    "fl.curve(SCENE, LAW, [])": f"{NUMBERS} none",
    "fl.curve(SCENE, LAW, ['1'])": f"{NUMBERS} the text '1' (remove the quotes) at [0]",
    "fl.curve(SCENE, LAW, [True])": f"{NUMBERS} True at [0]",
    "fl.curve(SCENE, LAW, 'fast')": f"{NUMBERS} the text 'fast'",
    "fl.curve(SCENE, LAW, None)": f"{NUMBERS} None",
    "fl.curve(SCENE, LAW, [1j])": f"{NUMBERS} 1j at [0]",
    "fl.compare(SCENE, LAW, [1, math.nan])": f"{NUMBERS} nan at [1]",
    "fl.trajectory(SCENE, LAW, initial=3)": "Scene: initial: must be Initial(...) or a mapping, got 3",
    "fl.steady_state(SCENE, LAW).orbit(2.5)": f"n {WHOLE} 2.5",
    "fl.attractors(SCENE, LAW, [1.0], starts='8')": f"starts {WHOLE} the text '8' (remove the quotes)",
}


@pytest.mark.parametrize("mistake", SAID)
def test_a_mistake_in_python_is_told_in_the_words_of_a_study(mistake: str) -> None:
    with pytest.raises(Exception) as caught:  # noqa: PT011 - the text is what counts
        eval(mistake)

    assert str(caught.value) == SAID[mistake]
    assert "pydantic" not in str(type(caught.value))


@pytest.mark.parametrize("path", ["mu", "mu_static", "wobble"])
@pytest.mark.parametrize("value", [-1, "0.4", [1], {}, math.inf])
def test_a_law_says_in_python_what_a_study_says_of_it(path: str, value: Any) -> None:
    values = {"mu": 0.4, path: value}
    with pytest.raises(WrongValues) as in_python:
        fl.Coulomb(**values)
    with pytest.raises(StudyError) as in_study:
        parse_study(PLAN | {"laws": [{"kind": "coulomb", **values}]})

    told = [(f"laws[0].{one.path}", one.what, one.hint) for one in in_python.value.mistakes]
    said = {(one.path, one.what.replace(" .inf", " inf"), one.hint) for one in in_study.value.mistakes}
    assert {(path, what, hint.replace(SEVERAL, "")) for path, what, hint in told} == said


def test_numbers_may_have_units_or_be_of_no_dimension_in_python() -> None:
    given, law = [0.05, 0.1, 0.15], fl.Dahl(mu=np.array(0.4), presliding_length="1 um")
    usual = fl.curve(SI, law, given)["mean_friction"].tolist()

    for speeds in (["5 cm/s", "0.1 m/s", 0.15], {"start": "50 mm/s", "stop": "0.15 m/s", "num": 3}):
        assert fl.curve(SI, law, speeds)["mean_friction"].tolist() == pytest.approx(usual, rel=1e-12)
        assert fl.compare(SI, law, speeds).table["mean_friction"].tolist() == pytest.approx(usual, rel=1e-12)
    state = fl.steady_state(SI, law)
    assert state.si.mean_friction == state.si["mean_friction_N"]
    assert f"mean_friction {state.si.mean_friction:.6g} N" in repr(state.si)
    assert {"period", "velocity_amplitude"} <= {*dir(state.si)}
    with pytest.raises(AttributeError, match="no result 'speed' in SI units; there are mean_friction"):
        state.si.speed  # noqa: B018
    assert fl.LuGre(mu=0.3, stiffness=1e5, damping=0) == fl.LuGre(mu_kinetic=0.3, stiffness=1e5, damping=0)


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

    wrong = "belt_speed", "normal_load", "drive.unbalnce", "drive.frequency", "damping_ratio"
    assert {mistake.path for mistake in caught.value.mistakes} == {*wrong}
    assert pickle.loads(pickle.dumps(caught.value)).mistakes == caught.value.mistakes


def test_a_scene_with_other_values_is_a_scene_made_of_them() -> None:
    changed = SCENE.with_(normal_load=3, **{"drive.frequency": 2, "initial.x": 1})
    others = {"normal_load": 3, "initial": {"x": 1}, "drive": {"unbalance": 10, "frequency": 2}}

    assert changed == fl.Scene(**GIVEN | others)
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
        (SCENE, {"transverse.load.amplitude": 2}, "transverse.natural_frequency: required key is missing"),
        (
            SI,
            {"belt_speed": 2},
            "Scene.si: belt_speed_m_per_s: 2 has no unit; give a speed [m/s] such as '2 mm/s'",
        ),
        (SI, {"dimensional.mass_kg": -2}, "Scene.si: mass_kg: must be > 0, got -2"),
    ],
)
def test_a_scene_refuses_other_values_that_make_none(scene: fl.Scene, changes: Any, said: str) -> None:
    with pytest.raises(WrongValues, match=re.escape(said)):
        scene.with_(**changes)


def smuggled(scene: fl.Scene, **update: Any) -> dict[str, fl.Scene]:
    return {"scene": scene.model_copy(update=update)}


WORDY = SCENE.drive.model_copy(update={"frequency": "1"})  # type: ignore[union-attr]
TOLERANCE = "tolerance must be a positive number, got"
WRONG: list[tuple[dict[str, Any], str]] = [
    (smuggled(SCENE, normal_load=-3), "Scene: normal_load: must be > 0, got -3"),
    (smuggled(SCENE, wobble=3), "Scene: wobble: unknown key"),
    (smuggled(SCENE, drive=WORDY), "Scene: drive.frequency: must be a number, got the text '1' (remove "),
    (smuggled(SI, belt_speed=3.0), "belt_speed: leave it out, dimensional gives the scene"),
    ({"law": LAW.model_copy(update={"mu": math.nan})}, "Coulomb: mu: must be a finite number, got nan"),
    ({"law": fl.Coulomb.model_construct()}, "Coulomb: mu: required key is missing"),
    ({"law": fl.Coulomb}, "got the class Coulomb; did you mean Coulomb(mu=...)?"),
    ({"scene": GIVEN}, "scene must be an fl.Scene, got a mapping; did you mean fl.Scene(**scene)?"),
    ({"method": fl.March}, "a method such as fl.March(), got the class March; did you mean March()?"),
    ({"method": fl.March().model_copy(update={"stepper": "rk5"})}, "March: stepper: must be 'moreau', 'rk4'"),
    *(({"tolerance": wrong}, f"{TOLERANCE} {wrong:g}") for wrong in (0.0, -1e-8, math.nan, math.inf)),
    ({"tolerance": True}, f"{TOLERANCE} True"),
]
PLAN = {"schema": 1, "scene": GIVEN, "laws": [{"kind": "coulomb", "mu": 0.4}]}
STUDY = parse_study(PLAN)
ZERO = replace(STUDY.laws[0], parameters={"mu": 0})
WRONG_RUNS: list[tuple[dict[str, Any], str]] = [
    ({"study": 3}, "study must be the path of a study file, a mapping or a Study, got 3"),
    ({"study": replace(STUDY, tolerance=-1.0)}, f"{TOLERANCE} -1"),
    ({"study": replace(STUDY, **WRONG[0][0])}, WRONG[0][1]),
    ({"study": replace(STUDY, laws=(ZERO,))}, "Coulomb: mu: must be > 0, got 0"),
    ({"columns": "floquet"}, "columns must be a list of names, got the text 'floquet'"),
    ({"existing": "keep"}, "existing must be 'reuse' or 'replace', got the text 'keep'"),
    ({"executor": 4}, "executor must be a concurrent.futures.Executor, got 4"),
    ({"overrides": "tolerance=1"}, "overrides must be a list such as ['scene.belt_speed=5']"),
]
AT_ONE = partial(fl.curve, belt_speed=[1.0])


SOLVE = {"scene": SCENE, "law": LAW}
CALLS = [(call, SOLVE | each, said) for each, said in WRONG for call in (fl.steady_state, AT_ONE)]
CALLS += [(fl.run, {"study": STUDY} | each, said) for each, said in WRONG_RUNS]


@pytest.mark.parametrize(("call", "given", "said"), CALLS)
def test_nothing_unchecked_reaches_a_solver(call: Any, given: dict[str, Any], said: str) -> None:
    with pytest.raises((TypeError, ValueError), match=re.escape(said)):
        call(**given)


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


@deep("processes")
def test_states_and_laws_of_files_go_to_other_processes_and_come_back(tmp_path: Path) -> None:
    file = tmp_path / "told.py"
    file.write_text(STEADY)
    law = read_law_file(file).laws["steady"](mu=0.4)  # type: ignore[call-arg]
    state = fl.steady_state(SCENE, LAW)
    twin = pickle.loads(pickle.dumps(state))

    assert pickle.loads(pickle.dumps(law)) == law
    assert repr(twin) == repr(state)
    assert np.array_equal(twin.orbit(16).v1, state.orbit(16).v1)
    study = tmp_path / "study.yaml"
    plan = {"plugins": ["told.py"], "laws": [{"kind": "steady", "mu": 0.4}], "methods": ["mdsm"]}
    study.write_text(yaml_text(PLAN | plan))
    with ProcessPoolExecutor(1, get_context("spawn")) as pool:
        elsewhere = pool.submit(fl.steady_state, SCENE, law, "mdsm").result()
        table = fl.run(study, executor=pool).table
    assert table["status"].tolist() == [elsewhere.status] == ["refused"]
    assert table["reason"].tolist() == [elsewhere.reason]
