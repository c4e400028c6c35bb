"""The command ``needs``: sentences or records on stdout, a table and a figure where a folder is given, exit codes."""

from __future__ import annotations

import csv
import json
from pathlib import Path
from typing import Any

import pytest

from frictionlab import cli
from frictionlab.study.written import yaml_text
from frictionlab.values.columns import NEEDS

GIVEN: dict[str, Any] = {
    "schema": 1,
    "scene": {"damping_ratio": 0.1, "normal_load": 10, "belt_speed": 34}
    | {"drive": {"unbalance": 10, "frequency": 1}},
    "laws": [{"kind": "coulomb", "mu": 0.4}],
    "methods": ["auto", "mdsm"],
    "sweep": {"scene.drive.frequency": [1, 1.5]},
}


@pytest.fixture
def study(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    path = tmp_path / "study.yaml"
    path.write_text(yaml_text(GIVEN))
    return path


def test_every_curve_is_told_in_sentences_and_nothing_is_written(
    study: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    code, told = cli.main(["needs", str(study)]), capsys.readouterr()

    assert code == 0
    lines = told.out.splitlines()
    assert [line for line in lines if not line.startswith(" ")] == [
        "drive.frequency 1:",
        "drive.frequency 1.5:",
    ]
    assert (
        "  friction's effect on the motion is needed: without it the mean changes by 0.0905 at belt speed 34"
        in lines
    )
    assert told.err == ""
    assert list(study.parent.iterdir()) == [study]


def test_what_holds_for_every_curve_is_told_once(study: Path, capsys: pytest.CaptureFixture[str]) -> None:
    cli.main(["needs", str(study), "--set", "sweep={scene.drive.frequency: [1, 1.01]}"])
    lines = capsys.readouterr().out.splitlines()

    assert lines[0] == "every curve:"
    friction = [line for line in lines if line.startswith("  friction's effect on the motion is needed")]
    assert len(friction) == 1
    assert " ... 0.0905 at belt speed 34" in friction[0]


def test_a_folder_gets_the_table_and_the_figure_and_stdout_the_records(
    study: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    code = cli.main(["needs", str(study), "-o", "out", "--within", "0.1", "--json", "--set", "sweep={}"])
    told = capsys.readouterr()
    found = json.loads(told.out)

    assert code == 0
    assert told.err == "table and figure in out\n"
    assert [list(each) for each in found] == [[*NEEDS]] * len(found)
    assert {each["verdict"] for each in found} == {"not needed"}
    assert [each["without"] for each in found if each["smallest"]] == ["friction's effect on the motion"]
    with Path("out/needs.csv").open() as lines:
        assert [row["without"] for row in csv.DictReader(lines)] == [each["without"] for each in found]
    assert {path.name for path in Path("out/figures").iterdir()} == {"needs.svg", "needs.png"}


def test_a_scene_without_one_mean_says_so(study: Path, capsys: pytest.CaptureFixture[str]) -> None:
    changes = ["scene.belt_speed=0", "scene.normal_load=1000", "sweep={}"]
    code = cli.main(["needs", str(study), *(word for each in changes for word in ("--set", each))])
    told = capsys.readouterr()

    assert code == 0
    assert told.out.startswith(
        "the full scene has no one mean to compare with (not_unique: the belt is at rest"
    )


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--set", "scene.normal_load=-1"], "scene.normal_load"),
        (["--within", "0"], "--within"),
        (["-o", "study.yaml"], "cannot make the folder study.yaml"),
    ],
)
def test_a_wrong_command_or_study_ends_with_two(
    study: Path, arguments: list[str], said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert cli.main(["needs", str(study), *arguments]) == 2
    told = capsys.readouterr()
    assert told.out == ""
    assert said in told.err
