"""What compiling a study takes is told before: the kernels it calls, less those that are kept."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from profiles import deep

import frictionlab as fl
from frictionlab.compile.call import KernelCall, compiling_at_once
from frictionlab.runner.arguments import given_study
from frictionlab.runner.kernels import kernels_to_compile

LINE: dict[str, Any] = {"damping_ratio": 0.1, "normal_load": 10, "belt_speed": 5}
LINE |= {"drive": {"amplitude": 10, "frequency": 1.5}}
ACROSS = {"natural_frequency": 1.7, "damping_ratio": 0.15, "load": {"amplitude": 12, "phase": 90}}
UNDRIVEN = {"damping_ratio": 0.1, "normal_load": 1, "belt_speed": 0.5}
SLIP: dict[str, Any] = {"slip": {"velocity_amplitude": 2, "frequency": 1}, "belt_speed": 1}
COULOMB = {"kind": "coulomb", "mu": 0.4}
DAHL = {"kind": "dahl", "mu": 0.4, "presliding_length": 0.4}
LANES = "answer lanes", "record in lanes", "differentiate in lanes"
CASES = [
    (LINE, COULOMB, ["continue in speed", "make orbits", "read each"]),
    (LINE, DAHL, ["answer curve", "maps of", "read each"]),
    (LINE | {"transverse": ACROSS}, COULOMB, ["answer curve", "maps of", *LANES, "read each"]),
    (LINE | {"transverse": ACROSS}, DAHL, ["answer curve", "maps of", "read each"]),
    (UNDRIVEN, COULOMB, ["follow undriven", "maps of", "read each"]),
    (UNDRIVEN, DAHL, ["follow undriven", "maps of", "read each"]),
    (SLIP, COULOMB, ["read each"]),
    (SLIP, DAHL, ["closed legs", "friction of each", "read each"]),
]
IDS = [f"{', '.join(scene)}: {law['kind']}" for scene, law, _ in CASES]


def study(scene: dict[str, Any], law: dict[str, Any], **more: Any) -> fl.Study:
    swept = {"scene.belt_speed": {"start": 0.5, "stop": 5.0, "num": 6}}
    return given_study({"schema": 1, "scene": scene, "laws": [law], "sweep": swept, **more}, (), None)


def told(given: fl.Study) -> dict[str, float] | None:
    return kernels_to_compile(given.curves(), given)


@pytest.fixture
def nothing_kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("FRICTIONLAB_CACHE", str(tmp_path / "kernels"))


@pytest.mark.usefixtures("nothing_kept")
@pytest.mark.parametrize(("scene", "law", "kernels"), CASES, ids=IDS)
def test_the_kernels_of_a_study_are_named_with_what_they_take(
    scene: dict[str, Any], law: dict[str, Any], kernels: list[str]
) -> None:
    found = told(study(scene, law))

    assert found is not None
    assert list(found) == kernels
    assert all(1.0 < seconds < 30.0 for seconds in found.values())


@pytest.mark.usefixtures("nothing_kept")
def test_what_is_not_known_beforehand_is_not_guessed() -> None:
    square = LINE | {"drive": {"amplitude": 10, "frequency": 1.5, "waveform": "square"}}

    assert told(study(LINE, COULOMB, methods=["march"])) is None
    assert told(study(square, COULOMB)) is None
    assert told(study(LINE, DAHL, methods=["mdsm"])) == {}  # refused: nothing is called
    assert told(study(SLIP, COULOMB, columns=["period"])) == {}  # no column that is read from an orbit


def test_machine_code_is_known_by_what_it_was_made_for(monkeypatch: pytest.MonkeyPatch) -> None:
    line, plane = study(LINE, DAHL), study(LINE | {"transverse": ACROSS}, DAHL)
    kept = ["Numbers(int64); Body(float64, bool, builtins.tuple())"]
    monkeypatch.setattr(KernelCall, "kept_for", lambda call: kept)

    assert told(line) == {}
    assert told(plane) == {"maps of": 6.0}
    kept[:] = ["Numbers(int64); Body(complex128, bool, Packed(array(float64, 1d, C)))"]
    assert list(told(plane) or ()) == ["answer curve", "maps of", "read each"]


@deep("compiles some twenty kernels")
@pytest.mark.usefixtures("nothing_kept")
@pytest.mark.parametrize(("scene", "law", "kernels"), CASES, ids=IDS)
def test_after_a_run_that_compiles_at_once_nothing_is_left_to_compile(
    scene: dict[str, Any], law: dict[str, Any], kernels: list[str]
) -> None:
    given = study(scene, law)
    before = told(given)
    with compiling_at_once():
        assert not fl.run(given).table["mean_friction"].isna().any()

    assert before is not None
    assert told(given) == {}
