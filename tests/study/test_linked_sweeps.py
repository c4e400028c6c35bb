"""Sweeps that advance together, and the friction coefficient of every law: their grid, and what it is read as."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from profiles import deep

import frictionlab as fl
from frictionlab.charts.curves import family_of
from frictionlab.laws.base import SlidingLaw
from frictionlab.runner.gathering import thinned
from frictionlab.runner.table import swept_inputs, whole
from frictionlab.study.grid import grid_size
from frictionlab.study.load import load_study, parse_study
from frictionlab.study.study import Study
from frictionlab.values.columns import leading
from frictionlab.values.notes import StudyError

SCENE = {"damping_ratio": 0.1, "normal_load": 10, "belt_speed": 5, "drive": {"unbalance": 10, "frequency": 1}}
LAWS: list[dict[str, Any]] = [
    {"kind": "coulomb", "mu": 0.4, "mu_static": 0.5},
    {"kind": "dahl", "mu": 0.4, "stiffness": 40},
    {"kind": "lugre", "presliding_length": 0.01},
]
LINKED = {
    "scene.drive.frequency": [1, 1.5],
    "scene.damping_ratio": {"start": 0.1, "stop": 0.2, "num": 2},
    "laws.dahl.stiffness": [40, 90],
}


def study(sweep: dict[str, Any], laws: list[dict[str, Any]] = LAWS) -> Study:
    return parse_study({"schema": 1, "scene": SCENE, "laws": laws, "sweep": sweep})


def test_linked_lists_advance_together_and_cross_the_other_sweeps(tmp_path: Path) -> None:
    given = study({"scene.belt_speed": [1, 2, 3], "linked": [LINKED], "friction": [0.2, 0.4]})

    cases = given.cases()
    assert len(cases) == grid_size(given) == 3 * 2 * 2 * 3
    assert {(each.scene.drive.frequency, each.scene.damping_ratio) for each in cases if each.scene.drive} == {
        (1.0, 0.1),
        (1.5, 0.2),
    }
    dahls = {
        (each.scene.damping_ratio, each.given_law.numbers()["bristle_stiffness"]) for each in cases[12:24]
    }
    assert dahls == {(0.1, 40.0), (0.2, 90.0)}
    assert [each.scene.belt_speed for each in cases[:4]] == [1.0, 1.0, 2.0, 2.0]

    file = tmp_path / "study.yaml"
    file.write_text(given.to_yaml())
    assert load_study(file) == given
    assert load_study(file).digest() == given.digest()
    assert given.digest() != study({"scene.belt_speed": [1, 2, 3], "friction": [0.2, 0.4], **LINKED}).digest()


def test_friction_is_that_of_every_law() -> None:
    found = [each.given_law for each in study({"friction": [0.2, 0.4]}).cases()]

    assert [law.sliding_friction(1e3) for law in found] == [0.2, 0.4] * 3
    assert found[0] == fl.Coulomb(mu=0.2, mu_static=0.25)
    assert found[1] == fl.Coulomb(mu=0.4, mu_static=0.5)
    assert [law.numbers()["bristle_stiffness"] for law in found[2:]] == [40.0, 40.0, 20.0, 40.0]


def test_a_law_without_a_coefficient_is_named() -> None:
    class Slick(SlidingLaw):
        drag: float = 0.1

        def sliding_friction(self, speed: float) -> float:
            return self.drag

    scene = fl.Scene(**SCENE)
    with pytest.raises(StudyError, match="the law 'Slick' has neither mu nor mu_kinetic to set"):
        fl.Study.of(scene, [Slick(), fl.Coulomb(mu=0.4)], sweep={"friction": [0.1, 0.2]})


def test_points_at_linked_belt_speeds_make_no_curve() -> None:
    together = {"scene.belt_speed": [10, 20, 30.0], "scene.drive.frequency": [1, 1.2, 1.4]}
    found = fl.sweep(fl.Scene(**SCENE), fl.Coulomb(mu=0.4), {"linked": [together]})

    assert len(found.table) == 3
    assert found.curves.empty
    assert found.onsets.empty
    for speed, frequency, row in zip(*together.values(), found.table.itertuples(), strict=True):
        state = fl.steady_state(
            fl.Scene(**SCENE).with_(belt_speed=speed, **{"drive.frequency": frequency}), fl.Coulomb(mu=0.4)
        )
        assert abs(state.mean_friction - row.mean_friction) <= state.error + row.error


@deep("seconds of runs")
def test_what_changes_together_is_told_once() -> None:
    over = {"scene.belt_speed": [10, 20, 30], "linked": [{**LINKED}], "friction": [0.2, 0.4]}
    del over["linked"][0]["laws.dahl.stiffness"]  # type: ignore[attr-defined]
    laws = [fl.Coulomb(mu=0.4), fl.Stribeck(mu_kinetic=0.4, mu_static=0.5)]
    found = fl.sweep(fl.Scene(**SCENE), laws, over, columns=["mean_friction"])

    family = family_of(found.table)
    assert family is not None
    assert family.member == "law.mu"
    assert [name for name, _ in family.panels[0]] == ["scene.damping_ratio", "scene.drive.frequency"]
    assert len(found.curves) == 2 * 2 * 2
    sizes = {"law": 2, "friction": 2, "scene.damping_ratio": 2, "scene.belt_speed": 3}
    assert dict(found.to_xarray().sizes) == sizes


def test_a_line_or_an_axis_names_what_changes_together() -> None:
    together = {"scene.normal_load": [5.0, 10.0, 20.0], "scene.drive.frequency": [0.8, 1.0, 1.5]}
    law = fl.Coulomb(mu=0.4)
    lines, axis = (
        family_of(fl.sweep(fl.Scene(**SCENE), law, over, columns=["mean_friction"]).table)
        for over in ({"linked": [together], "scene.belt_speed": [10, 20, 30]}, {"linked": [together]})
    )

    words = r"normal load $\gamma^2$, with $\Omega$"
    assert lines is not None
    assert axis is not None
    assert lines.word("scene.normal_load") == axis.word(axis.abscissa) == words
    assert lines.word(lines.abscissa) == "belt speed $v_b$"


def test_an_input_that_follows_from_another_is_left_out() -> None:
    cells = {"law": "aaab", "few": [1, 1, 2, 1], "many": [5, 6, 7, 5], "other": [0, 9, 9, 0]}
    assert leading(["few", "many"], cells) == ["many"]
    assert leading(["few", "other"], cells) == ["few", "other"]
    assert leading(["many", "other"], cells) == ["many"]


@pytest.mark.parametrize(
    ("sweep", "said"),
    [
        ({"linked": {}}, "sweep.linked: must be a list of entries such as {scene.drive.frequency: [1, 2]"),
        ({"linked": []}, "sweep.linked: the list is empty; give at least one entry"),
        ({"linked": [3]}, "sweep.linked[0]: must be a mapping (key: value), got 3"),
        ({"linked": [{"friction": [1]}]}, "sweep.linked[0]: one list alone links nothing: give two or more"),
        (
            {"linked": [{"friction": [0.1, 0.2], "scene.normal_load": [1, 2, 3]}]},
            "sweep.linked[0].scene.normal_load: has 3 values, friction 2: lists of one entry advance together",
        ),
        (
            {"linked": [{"friction": [0.1, 0.1], "scene.normal_load": [1, 1]}]},
            "sweep.linked[0]: its places 0 and 1 are the same point",
        ),
        (
            {"linked": [{"friction": [0.1], "scene.load": [1]}]},
            "sweep.linked[0].scene.load: no such value in",
        ),
        ({"friction": [0.1, 0]}, "sweep.friction[1]: must be > 0, got 0"),
        ({"friction": {"start": 0, "stop": 1, "num": 3}}, "sweep.friction[0]: must be > 0, got 0"),
        (
            {"friction": [0.1], "laws.dahl.mu": [1]},
            "sweep.laws.dahl.mu: the study sweeps friction, which sets mu",
        ),
        ({"linkd": []}, "did you mean 'linked'?"),
        (
            {"linked": [{"friction": [0.1], "scene.normal_load": [1]}], "friction": [1]},
            "friction is swept already",
        ),
    ],
)
def test_mistakes_are_told(sweep: dict[str, Any], said: str) -> None:
    with pytest.raises(StudyError) as problem:
        study(sweep, [*LAWS[:2], {**LAWS[2], "mu_kinetic": 0.3}])
    assert said in str(problem.value)
    assert len(problem.value.mistakes) == 1


def test_a_static_coefficient_needs_the_one_its_ratio_is_to() -> None:
    laws = [{"kind": "coulomb", "mu_static": 0.5}, {"kind": "stribeck", "mu_kinetic": 0, "mu_static": 0.4}]
    with pytest.raises(StudyError, match="of the law 'coulomb' mu is missing"):
        study({"friction": [0.1]}, laws)
    with pytest.raises(StudyError, match="of the law 'stribeck' mu_kinetic is 0"):
        study({"friction": [0.1]}, laws[1:])


def test_curves_spread_over_a_long_table_are_not_taken_for_linked() -> None:
    over = {
        "scene.belt_speed": [10, 20, 30],
        "scene.drive.frequency": [1, 2, 3],
        "scene.damping_ratio": [1, 2, 3],
    }
    table = fl.sweep(fl.Scene(**SCENE), fl.Coulomb(mu=0.4), over, columns=["mean_friction"]).table
    diagonal = table["scene.drive.frequency"] == table["scene.damping_ratio"]
    assert len(swept_inputs(table[diagonal])) == 1

    shown = thinned([table], np.flatnonzero(diagonal))
    assert swept_inputs(whole(shown)) == ["scene.damping_ratio", "scene.drive.frequency"]
    family = family_of(whole(shown))
    assert family is not None
    assert len({*family.panels[0], family.member}) == 2
