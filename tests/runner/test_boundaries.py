"""Lines over two swept numbers on which a measure of the curves has a level."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

import frictionlab as fl
from frictionlab.charts.maps import map_of_curves
from frictionlab.runner.api import with_boundaries
from frictionlab.study import StudyError

SPEEDS = {"start": 2, "stop": 60, "num": 30}
DRIVE = fl.Drive(amplitude=10, frequency=1)
SCENE = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=DRIVE)
SWEEP: dict[str, Any] = {
    "scene.drive.frequency": [0.9, 1.0, 1.1],
    "scene.normal_load": [5.0, 10.0, 15.0],
    "scene.belt_speed": SPEEDS,
}


def study(**told: Any) -> fl.Study:
    given: dict[str, Any] = {"sweep": SWEEP, "boundaries": {"shape_area": 0}} | told
    return fl.Study.of(SCENE, fl.Coulomb(mu=0.4), **given)


def area(load: float, frequency: float) -> float:
    scene = SCENE.with_(normal_load=load, **{"drive.frequency": frequency})
    alone = fl.Study.of(scene, fl.Coulomb(mu=0.4), sweep={"scene.belt_speed": SPEEDS}, columns=["shape"])
    return float(fl.run(alone).curves["shape_area"].iloc[0])


def test_every_place_is_where_a_bisection_of_the_curve_s_measure_is() -> None:
    found = fl.run(study()).boundaries

    assert set(found["piece"]) == {1}
    frequencies = found["scene.drive.frequency"]
    assert (frequencies.min(), frequencies.max()) == (0.9, 1.1)
    for row in found.iloc[[1, len(found) // 2, -2]].itertuples(index=False):
        told = dict(zip(found.columns, row, strict=True))
        root = brentq(area, 5.0, 15.0, args=(told["scene.drive.frequency"],), xtol=1e-9)
        assert told["scene.normal_load"] == pytest.approx(root, abs=1e-6)
    assert (found["scene.normal_load_error"] > 0.0).all()


def test_at_resonance_the_area_is_zero_where_friction_is_a_third_of_the_load() -> None:
    # the exact value, .331 of the load, is of many points; those few have an error that covers it
    found = fl.run(
        study(sweep=SWEEP | {"scene.belt_speed": {"start": 0.5, "stop": 60, "num": 120}})
    ).boundaries
    at = found[np.isclose(found["scene.drive.frequency"], 1.0)].iloc[0]

    assert at["scene.normal_load"] * 0.4 / 10.0 == pytest.approx(0.331, abs=1e-3)


def test_lines_are_kept_in_a_file_read_again_and_drawn(tmp_path: Path) -> None:
    for _ in range(2):
        done = with_boundaries(fl.run(study(), tmp_path / "out"))
    assert done.computed == 0
    assert len(done.boundaries) == len((tmp_path / "out" / "boundaries.csv").read_text().splitlines()) - 1


def test_a_map_shows_the_lines_in_place_of_contours_of_its_grid() -> None:
    fine = {"scene.drive.frequency": {"start": 0.9, "stop": 1.1, "num": 5}}
    fine |= {"scene.normal_load": {"start": 5, "stop": 15, "num": 5}, "scene.belt_speed": SPEEDS}
    done = fl.run(study(sweep=fine))
    measures = map_of_curves(done.curves)
    assert measures is not None
    axes = replace(measures, boundaries=done.boundaries).draw().axes

    lines = [line for each in axes for line in each.lines]
    assert len(lines) == 1
    np.testing.assert_allclose(lines[0].get_xdata(), done.boundaries["scene.drive.frequency"])


def test_a_study_says_what_its_lines_are_over() -> None:
    assert study().resolved()["boundaries"] == {"shape_area": 0}
    assert fl.Study.of(SCENE, fl.Coulomb(mu=0.4)).resolved().get("boundaries") is None


@pytest.mark.parametrize(
    ("told", "said"),
    [
        ({"boundaries": {"area": 0}}, "boundaries.area: unknown key"),
        (
            {"boundaries": {"shape_area": "zero"}},
            "boundaries.shape_area: must be a number, got the text 'zero'",
        ),
        ({"sweep": {"scene.belt_speed": SPEEDS}}, "needs the belt speed and two numbers swept"),
        ({"sweep": {"friction": [0.1, 0.2]} | SWEEP}, "needs the belt speed and two numbers swept"),
    ],
)
def test_what_is_no_boundary_is_said(told: dict[str, Any], said: str) -> None:
    with pytest.raises(StudyError, match=said):
        study(**told)
