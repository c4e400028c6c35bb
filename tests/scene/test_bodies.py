"""Bodies that are not linear: their numbers, units, equations, and what becomes of them where they are taken away."""

from __future__ import annotations

import math
from typing import Any

import pytest

import frictionlab as fl
from frictionlab.analysis.needs.motion import LesserModel
from frictionlab.analysis.needs.parts import without_term

LINE: dict[str, Any] = {
    "damping_ratio": 0.1,
    "normal_load": 2,
    "belt_speed": 1,
    "drive": {"amplitude": 3, "frequency": 1.5},
}
BENT = {"cubic_stiffness": 0.2, "amplitude_damping": 0.3, "curvature": 0.05}
REMEMBERS = {"relaxation": {"stiffness": 0.5, "time": 2}, "fractional": {"coefficient": 0.2, "order": 0.5}}


def test_spring_and_dashpot_of_a_curvature_are_those_of_a_strain() -> None:
    r, beta = 0.3, 0.07
    bends = fl.Body(curvature=r).bends(beta)
    for x, v in ((0.7, -0.4), (-1.3, 2.0)):
        strain, stretch = x + r * x**2, 1.0 + 2.0 * r * x
        bent = bends.spring_2 * x**2 + bends.spring_3 * x**3 + (bends.dashpot_1 + bends.dashpot_2 * x) * x * v
        assert x + 2.0 * beta * v + bent == pytest.approx(
            (strain + 2.0 * beta * stretch * v) * stretch, rel=1e-14
        )


def test_a_body_that_adds_nothing_leaves_the_mass_as_it_is() -> None:
    scene = fl.Scene(**LINE)
    assert scene.with_(body=fl.Body()).mass() == scene.mass()
    assert scene.with_(body={"curvature": 0.0}).body_terms == []


def test_a_body_in_si_units_is_that_of_its_numbers() -> None:
    mass, stiffness, length = 2.0, 800.0, 1e-3
    omega = math.sqrt(stiffness / mass)
    si = {
        "mass": "2 kg",
        "stiffness": "800 N/m",
        "damping_ratio": 0.1,
        "length": "1 mm",
        "belt_speed": "20 mm/s",
        "body": {
            "cubic_stiffness": "4 N/mm^3",
            "amplitude_damping_N_s_per_m3": 1e7,
            "curvature": "0.05 1/mm",
            "relaxation": {"stiffness": "400 N/m", "time": "0.1 s"},
            "fractional": {"coefficient_N_sq_per_m": 5.0, "order": 0.5},
        },
    }
    scene = fl.Scene(dimensional=si)

    assert scene.body is not None
    assert scene.body.cubic_stiffness == pytest.approx(4e9 * length**2 / stiffness)
    assert scene.body.amplitude_damping == pytest.approx(1e7 * length**2 * omega / stiffness)
    assert scene.body.curvature == pytest.approx(0.05)
    assert scene.body.relaxation is not None
    assert scene.body.relaxation.stiffness == pytest.approx(0.5)
    assert scene.body.relaxation.time == pytest.approx(0.1 * omega)
    assert scene.body.fractional is not None
    assert scene.body.fractional.coefficient == pytest.approx(5.0 * math.sqrt(omega) / stiffness)
    assert fl.Scene(**scene.given()) == scene


@pytest.mark.parametrize("name", [*BENT, *REMEMBERS])
def test_every_term_may_be_taken_away(name: str) -> None:
    terms = BENT | REMEMBERS
    full = LesserModel(fl.Scene(**LINE, body=terms), fl.Coulomb(mu=0.4))
    left = without_term(name)(full)

    assert left is not None
    assert left.scene.body_terms == [each for each in terms if each != name]
    assert without_term(name)(left) is None
    alone = without_term(name)(LesserModel(fl.Scene(**LINE, body={name: terms[name]}), full.law))
    assert alone is not None
    assert alone.scene.body is None


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"body": {"amplitude_damping": -1}}, "body.amplitude_damping: must be >= 0, got -1"),
        (
            {"body": {"fractional": {"coefficient": 1, "order": 1.5}}},
            "body.fractional.order: must be <= 1, got 1.5",
        ),
        ({"body": {"relaxation": {"stiffness": 1}}}, "body.relaxation.time: required key is missing"),
        ({"body": {"cubic": 1}}, "did you mean 'cubic_stiffness'?"),
    ],
)
def test_what_no_body_can_be_is_told(change: dict[str, Any], said: str) -> None:
    with pytest.raises(ValueError, match="Scene: ") as caught:
        fl.Scene(**LINE | change)
    assert said in str(caught.value)
    with pytest.raises(ValueError, match="body: leave it out with a prescribed slip"):
        fl.Scene(belt_speed=1, slip={"velocity_amplitude": 1, "frequency": 1}, body=BENT)
