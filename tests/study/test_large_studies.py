"""Large studies, and studies of many mistakes: sizes before values, and no more time than they are long."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from profiles import deep
from pydantic import model_validator

import frictionlab as fl
from frictionlab.study import registry
from frictionlab.study.load import load_study, parse_study, read_back
from frictionlab.study.written import yaml_text
from frictionlab.values.notes import StudyError

SCENE = {"damping_ratio": 0.1, "normal_load": 10, "belt_speed": 1, "drive": {"unbalance": 10, "frequency": 1}}


def study(**changes: Any) -> dict[str, Any]:
    return {"schema": 1, "scene": SCENE, "laws": [{"kind": "coulomb", "mu": 0.4}], **changes}


def told(tree: dict[str, Any]) -> str:
    with pytest.raises(StudyError) as caught:
        parse_study(tree)
    return str(caught.value)


def up_to(num: int) -> dict[str, Any]:
    return {"start": 1, "stop": 2, "num": num}


@pytest.mark.parametrize("spacing", [{}, {"spacing": "log"}])
def test_a_range_stays_a_range_in_the_resolved_study(spacing: dict[str, str]) -> None:
    given = {"start": 0.5, "stop": 60, "num": 120, **spacing}
    ready = parse_study(study(sweep={"scene.belt_speed": given}))

    assert ready.resolved()["sweep"] == {"scene.belt_speed": given}
    assert parse_study(ready.resolved()) == ready
    assert len(ready.sweep["scene.belt_speed"]) == 120


def test_a_study_of_310000_points_is_saved_in_a_file_that_is_read_again(tmp_path: Path) -> None:
    ready = parse_study(study(sweep={"scene.belt_speed": up_to(3100), "laws.coulomb.mu": up_to(100)}))
    (tmp_path / "study.yaml").write_text(yaml_text(ready.resolved()))

    assert (tmp_path / "study.yaml").stat().st_size < 1000
    assert read_back(tmp_path / "study.yaml", {}) == ready
    assert load_study(tmp_path / "study.yaml").digest() == ready.digest()


@pytest.mark.parametrize(
    ("tree", "message"),
    [
        (
            lambda: study(
                sweep={
                    f"scene.{name}": up_to(1000) for name in ("belt_speed", "normal_load", "drive.frequency")
                }
            ),
            "sweep: the grid has 1000000000 points, more than 100000000",
        ),
        (lambda: study(keep={"harmonics": 10**8}), "100000000 harmonics of 1 points are more than 10000000"),
        (lambda: study(keep={"attractors": 10**6}), "1000000 starts at 1 points are more than 100000"),
        (lambda: study(keep={"orbit": 10**9}), "1000000000 samples of 1 points are more than 50000000"),
    ],
)
def test_what_is_too_large_is_told_and_not_tried(tree: Callable[[], dict[str, Any]], message: str) -> None:
    assert message in told(tree())


class Ordered(fl.SlidingLaw):
    """A law with a point in its middle that cannot be built."""

    mu: fl.Positive
    other: fl.Positive = 1.0

    @model_validator(mode="after")
    def _no_seven(self) -> Ordered:
        if self.mu == 7.0 and self.other == 7.0:
            raise ValueError("seven twice")
        return self

    def sliding_friction(self, speed: float) -> float:
        """The coefficient."""
        return self.mu


@deep("seconds of checks")
def test_a_point_inside_a_large_grid_that_cannot_be_built_is_a_mistake_when_it_is(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    known = registry.Laws.named
    monkeypatch.setattr(
        registry.Laws, "named", lambda laws, name: Ordered if name == "dahl" else known(laws, name)
    )
    values = {"start": 1, "stop": 400, "num": 400}
    tree = study(laws=[{"kind": "dahl"}], sweep={"laws.dahl.mu": values, "laws.dahl.other": values})

    ready = parse_study(tree)
    with pytest.raises(StudyError, match=r"study: sweep: a point of the grid cannot be built: .*seven twice"):
        list(ready.curves())


def calls(tree: dict[str, Any]) -> int:
    """How many functions are called to find the mistakes of a study, and to tell them."""
    count = 0

    def counted(frame: Any, event: str, argument: Any) -> None:
        nonlocal count
        count += event in ("call", "c_call")

    sys.setprofile(counted)
    try:
        str(parse_study(tree))
    except StudyError as problem:
        str(problem)
    finally:
        sys.setprofile(None)
    return count


def laws(number: int, **changes: Any) -> list[dict[str, Any]]:
    return [{"kind": "coulomb", "mu": 0.4, "label": f"l{k}", **changes} for k in range(number)]


@deep("compares times")
@pytest.mark.parametrize(
    "tree",
    [
        lambda n: study(**{f"key{k}": 1 for k in range(n)}),
        lambda n: study(sweep={"scene.normal_load": [-float(k + 1) for k in range(n)]}),
        lambda n: study(sweep={f"scene.key{k}": [1] for k in range(n)}),
        lambda n: study(laws=laws(n), sweep={f"laws.k{k}.mu": [1] for k in range(n)}),
        lambda n: study(laws=laws(n), sweep={f"laws.l{k}.mi": [1] for k in range(n)}),
        lambda n: study(laws=laws(n, kind="no"), sweep={f"laws.k{k}.mu": [1] for k in range(n)}),
        lambda n: study(laws=laws(n), sweep={f"laws.l{k}.mu": [0.1, 0.2] for k in range(n)}),
        lambda n: study(laws=laws(n), expect=[{"where": {"law": "k"}, "status": "ok"}] * n),
        lambda n: study(expect=[{"column": "nothing", "below": k} for k in range(n)]),
    ],
)
def test_twice_as_many_mistakes_are_told_in_twice_the_time(tree: Callable[[int], dict[str, Any]]) -> None:
    calls(tree(10))

    assert calls(tree(200)) < 2.3 * calls(tree(100))


@deep("thousands of mistakes")
def test_of_many_mistakes_the_first_fifty_are_shown_and_the_others_counted(tmp_path: Path) -> None:
    file = tmp_path / "study.yaml"
    wrong = "".join(f"key{k}: 1\n" for k in range(3000))
    file.write_text(wrong + yaml_text(study()))
    with pytest.raises(StudyError) as caught:
        load_study(file)

    lines = str(caught.value).splitlines()
    assert len(caught.value.mistakes) == 3000
    assert sum(line.startswith(str(file)) for line in lines) == 50
    assert lines[-1] == "and 2950 more: correct these first"
