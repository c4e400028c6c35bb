"""Belt speeds that a planned curve lacks for its shape: with them it has one, and no others are asked for."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from fig_4b import COULOMB, LAW, SCENE, over_speeds
from hypothesis import example, given
from hypothesis import strategies as st

import frictionlab as fl
from frictionlab.curves.verdict import Estimate, FrictionCurve, UnreadableCurve, shape_of
from frictionlab.runner.curve_loads import lacking_speeds, speeds_to_add
from frictionlab.scene.scenes import Scenes


def curve(speeds: list[float], end: float) -> FrictionCurve:
    speed = np.array(sorted({v for v in speeds if v > 0.0}))
    rising = np.minimum(1.0, speed / end)
    return FrictionCurve(speed, rising, 0.0 * speed, Estimate(0.0, 0.0), Estimate(end, 0.0), kinked=True)


def has_all_measures(speeds: list[float], end: float) -> bool:
    try:
        return shape_of(curve(speeds, end)).initial is not None
    except UnreadableCurve:
        return False


@example(shares=[5e-324], decade=0.0)
@example(shares=[5e-324], decade=1.0)
@given(
    shares=st.lists(st.floats(-0.1, 1.5) | st.floats(0.0, 0.12), max_size=30),
    decade=st.floats(-6.0, 6.0),
)
def test_with_them_a_curve_has_every_measure_and_none_are_asked_for_without_need(
    shares: list[float], decade: float
) -> None:
    end = 10.0**decade
    speeds = [share * end for share in shares]
    more = lacking_speeds(speeds, end)

    assert has_all_measures([*speeds, *more], end)
    assert bool(more) == (not has_all_measures(speeds, end))
    assert not set(more) & set(speeds)


@pytest.mark.parametrize(
    ("speeds", "more"),
    [
        (np.linspace(1.0, 60.0, 60), []),
        (np.linspace(5.0, 60.0, 12), [2.5]),
        ([10.0, 20.0, 30.0, 40.0, 50.0, 60.0], [2.0, 4.0, 15.0, 25.0]),
        ([1.0, 2.0, 7.0, 15.0, 22.0, 30.0, 37.0, 45.0], [52.0]),
    ],
)
def test_they_are_few_and_easy_to_type(speeds: list[float], more: list[float]) -> None:
    assert lacking_speeds(speeds, 50.0) == more


def test_one_list_serves_the_curves_of_all_frequencies() -> None:
    speeds = np.linspace(1.0, 20.0, 20)
    scenes = [Scenes(SCENE.with_(**{"drive.frequency": w}), speeds) for w in (0.2, 0.5, 1.0)]
    lacking, more = speeds_to_add((each, LAW) for each in scenes)

    assert lacking == 3  # V_lin 0.08 and 1.65 ask for points near rest, 50 for some beyond 20
    assert speeds_to_add((Scenes(each.scene, np.array([*speeds, *more])), LAW) for each in scenes) == (0, [])


SHAKEN = {
    "drive": {"drive": {"amplitude": 1.0, "frequency": 1.5}},
    "belt": {"belt_vibration": {"velocity_amplitude": 0.5, "frequency": 1.5}},
}


@pytest.mark.parametrize(("shaken", "static"), [("drive", 0.4), ("drive", 0.5), ("belt", 0.4), ("belt", 0.5)])
def test_belt_speeds_are_advised_where_they_give_a_shape_and_nowhere_else(shaken: str, static: float) -> None:
    scene, law = (
        {"damping_ratio": 0.1, "normal_load": 4.0, **SHAKEN[shaken]},
        {"mu": 0.4, "mu_static": static},
    )
    speeds = np.linspace(0.2, 3.0, 6)
    _, more = speeds_to_add([(Scenes(fl.Scene(belt_speed=1.0, **scene), speeds), fl.Coulomb(**law))])
    asked = more or lacking_speeds(speeds, 0.5)
    others = {"scene": scene, "laws": [COULOMB | law], "methods": ["auto"], "columns": ["shape"]}
    found = fl.run(over_speeds([*speeds, *asked], **others)).curves

    assert bool(more) == bool(found["shape"].notna().all())
    assert bool(more) == (static == 0.4)


UNDRIVEN = fl.Scene(damping_ratio=0.1, normal_load=1.0, belt_speed=0.5)
FALLS = fl.Stribeck(mu_kinetic=0.3, mu_static=0.4)


@pytest.mark.parametrize(
    ("scene", "law", "speeds"),
    [(SCENE, FALLS, [5.0, 10.0]), (UNDRIVEN, LAW, [0.5, 1.0]), (SCENE, LAW, [5.0])],
)
def test_what_has_no_end_of_reversal_or_no_curve_lacks_no_shape(scene: Any, law: Any, speeds: Any) -> None:
    assert speeds_to_add([(Scenes(scene, np.array(speeds)), law)]) == (0, [])
