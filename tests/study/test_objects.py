"""Studies made from Python objects: they say what a file says, and read back from their own YAML."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import frictionlab as fl
from frictionlab.laws.base import SlidingLaw
from frictionlab.study.load import load_study
from frictionlab.values.notes import StudyError

SCENE = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1))
LAW = fl.Coulomb(mu=0.4)


def test_objects_and_the_file_they_write_are_the_same_study(tmp_path: Path) -> None:
    study = fl.Study.of(
        SCENE,
        {"a": LAW, "b": fl.Dahl(mu=0.4, stiffness=4.0)},
        ["auto", fl.March(steps=100)],
        {
            "scene.belt_speed": np.linspace(1.0, 5.0, 3),
            "laws.a.mu": [0.1, 0.2],
            "scene.drive.frequency": [1.0],
        },
        tolerance=1e-6,
        title="objects",
        keep={"orbit": 4},
    )
    file = tmp_path / "study.yaml"
    file.write_text(study.to_yaml())

    assert load_study(file) == study
    assert len(study.cases()) == (2 + 1) * 2 * 3
    assert study.keep.orbit == 4


def test_waveforms_are_swept_as_in_a_file() -> None:
    study = fl.Study.of(SCENE, LAW, sweep={"scene.drive.waveform": ["sine", "square"]})
    assert [case.scene.drive.waveform.shape for case in study.cases() if case.scene.drive] == [
        "sine",
        "square",
    ]


def test_a_law_that_is_not_installed_takes_part() -> None:
    class Slick(SlidingLaw):
        mu: float = 0.1

        def sliding_friction(self, speed: float) -> float:
            return self.mu

    (case,) = fl.Study.of(SCENE, Slick()).cases()
    assert case.law.sliding_friction(1.0) == 0.1
    assert case.law_label == "Slick"


@pytest.mark.parametrize(
    ("made", "kind", "told"),
    [
        (lambda: fl.Study.of(SCENE, [LAW, LAW]), StudyError, "laws.0. has the label 'coulomb' too"),
        (lambda: fl.Study.of(SCENE, "coulomb"), TypeError, "laws must be a friction law such as"),
        (lambda: fl.Study.of(SCENE, LAW, [3]), TypeError, "methods must be a name such as 'auto'"),
        (lambda: fl.Study.of(SCENE, LAW, "exct"), StudyError, "did you mean 'exact'"),
        (lambda: fl.Study.of({}, LAW), TypeError, "scene must be an fl.Scene"),
        (lambda: fl.Study.of(SCENE, LAW, titel="x"), StudyError, "did you mean 'title'"),
        (
            lambda: fl.Study.of(SCENE, LAW, sweep={"scene.belt": [1]}),
            StudyError,
            "did you mean 'scene.belt_speed'",
        ),
    ],
)
def test_mistakes_are_told_as_those_of_a_file(
    made: Callable[[], object], kind: type[Exception], told: str
) -> None:
    with pytest.raises(kind, match=told):
        made()
