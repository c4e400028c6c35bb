"""Auto: the least model within the tolerance for a whole curve and its cheapest method, held to the tolerance."""

from __future__ import annotations

import re

import numpy as np
import pytest
from answered import with_columns

from frictionlab.laws.base import FrictionLaw
from frictionlab.laws.coulomb import Coulomb
from frictionlab.laws.stribeck import Stribeck
from frictionlab.methods.auto import METHODS_BY_COST, Auto
from frictionlab.methods.exact.method import Exact
from frictionlab.methods.shooting.method import Shooting
from frictionlab.methods.words import model_in_sentences
from frictionlab.scene.scene import Drive, Load, Scene, Slip, Transverse

LAW = Coulomb(mu=0.4)


class Remembers(FrictionLaw):
    """A law that is not said to be without memory: no method applies."""

    def sliding_friction(self, speed):
        return 0.4 / (1.0 + speed)


def scene(belt_speed, load=None, **changes):
    """Paper, Fig. 4b, with a transverse direction where ``load`` or ``transverse`` says so."""
    across = (
        None
        if load is None
        else Transverse(natural_frequency=2.0, damping_ratio=0.1, load=Load(unbalance=load))
    )
    values = {
        "damping_ratio": 0.1,
        "normal_load": 10.0,
        "drive": Drive(unbalance=10.0, frequency=1.0),
        "transverse": across,
        **changes,
    }
    return Scene(belt_speed=belt_speed, **values)


SCENES = {
    "prescribed": (
        lambda v: Scene(belt_speed=v, slip=Slip(velocity_amplitude=2.0, frequency=1.0)),
        Exact,
        "no method is cheaper",
    ),
    "line": (scene, Exact, "no method is cheaper"),
    "plane without a transverse load": (
        lambda v: scene(v, transverse=Transverse(natural_frequency=2.0, damping_ratio=0.1)),
        Exact,
        "no method is cheaper",
    ),
    "transverse load of zero": (lambda v: scene(v, 0.0), Exact, "no method is cheaper"),
    "transverse load": (lambda v: scene(v, 10.0), Shooting, "this scene has a transverse load"),
}
SPEEDS = (0.7, 20.0, 49.0, 70.0)


@pytest.mark.parametrize("name", SCENES)
def test_the_cheapest_method_that_applies_solves_the_whole_curve_and_model_says_why(name):
    make, method, why = SCENES[name]
    scenes = [make(v) for v in SPEEDS]
    assert Auto().refusal(scenes[0], LAW) is None
    assert type(Auto().choice(scenes[0], LAW)[0]) is method
    answers, direct = with_columns(Auto(), scenes, LAW, 1e-9), with_columns(method(), scenes, LAW, 1e-9)
    assert answers.status == ["ok"] * len(SPEEDS)
    np.testing.assert_array_equal(answers.columns["mean_friction"], direct.columns["mean_friction"])
    for ours, theirs in zip(answers.model, direct.model, strict=True):
        assert ours.startswith(theirs)
        assert re.search(f"; auto chose {method.name}: .*{why}", model_in_sentences(ours))
    assert answers.orbit(0) is not None


@pytest.mark.parametrize("name", SCENES)
def test_one_method_solves_a_whole_curve_even_where_a_cheaper_one_would_do(name):
    make, method, _why = SCENES[name]
    assert {type(Auto().choice(make(v), LAW)[0]) for v in (0.0, *SPEEDS)} == {method}


def test_an_answer_above_the_tolerance_has_failed_with_both_numbers_in_the_reason():
    scenes = [scene(v, 10.0) for v in (5.0, 20.0)]
    answers, direct = with_columns(Auto(), scenes, LAW, 1e-16), with_columns(Shooting(), scenes, LAW, 1e-16)
    assert direct.status == ["ok", "ok"]
    assert answers.status == ["failed", "failed"]
    for reason, error in zip(answers.reason, direct.columns["error"], strict=True):
        assert error > 1e-16
        assert reason == f"shooting reaches an error of {error:.1e}, above the tolerance 1.0e-16"
    within = with_columns(Auto(), scenes, LAW, 1e-8)
    assert within.status == ["ok", "ok"]
    assert within.reason == ["", ""]


def test_a_scene_no_method_accepts_is_refused_with_every_reason():
    for one in (scene(5.0), scene(5.0, 10.0)):
        refusal = Auto().refusal(one, Remembers())
        for method in METHODS_BY_COST:
            assert method.refusal(one, Remembers()) in refusal


@pytest.mark.parametrize(
    ("one", "law"),
    [
        (scene(5.0), Coulomb(mu=0.4, mu_static=0.5)),
        (scene(5.0), Stribeck(mu_kinetic=0.4, mu_static=0.5)),
        (Scene(damping_ratio=0.1, normal_load=1.0, belt_speed=1.0), LAW),
        (
            Scene(belt_speed=1.0, slip=Slip(velocity_amplitude=2.0, frequency=1.0)),
            Stribeck(mu_kinetic=0.4, mu_static=0.5),
        ),
    ],
)
def test_what_exact_refuses_along_the_belt_is_answered_by_shooting(one, law):
    method, why = Auto().choice(one, law)

    assert isinstance(method, Shooting)
    assert "exact needs" in why
