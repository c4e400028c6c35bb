"""The way to a law of one's own, walked as the document tells it."""

from __future__ import annotations

import os
import re
import shlex
import subprocess
import sys
from pathlib import Path
from textwrap import indent
from typing import Any

import pandas as pd
import pytest
from profiles import deep

import frictionlab as fl
from frictionlab import cli
from frictionlab.runner.saved import read_run as read_saved
from frictionlab.study.load import load_study

PAGE = (Path(__file__).parents[1] / "docs" / "write_a_law.md").read_text()
COMMANDS = [
    shlex.split(line)
    for block in re.findall(r"```sh\n(.*?)```", PAGE, re.DOTALL)
    for line in block.splitlines()
]


def block(name: str) -> str:
    """The one fenced block below the comment of this name."""
    (found,) = re.findall(rf"<!-- {name} -->\n```\w+\n(.*?)```", PAGE, re.DOTALL)
    return str(found)


@pytest.fixture
def walked(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The law of the document, begun and edited as it says; the working folder is that of the law."""
    monkeypatch.chdir(tmp_path)
    begin, enter = COMMANDS[:2]
    assert (begin[0], enter[0]) == ("frictionlab", "cd")
    assert cli.main(begin[1:]) == 0
    monkeypatch.chdir(enter[1])
    file = Path("soft_rubber.py")
    file.write_text(edited(file.read_text()))
    return tmp_path / "soft-rubber"


def edited(law: str) -> str:
    """The law with the methods of the document in place of those of their names."""
    for method in re.findall(r"    def .*?(?=\n\n|\Z)", block("physics").rstrip(), re.DOTALL):
        name = re.match(r"    def (\w+)", method)
        assert name is not None
        law, count = re.subn(
            rf"    def {name[1]}\(.*?(?=\n\n|\Z)", lambda _, new=method: new, law, flags=re.DOTALL
        )  # type: ignore[misc]
        assert count == 1
    return f"{law.rstrip()}\n"


def test_the_files_are_those_of_the_table(walked: Path) -> None:
    rows = re.findall(r"^\| `([\w/]+\.\w+)` \|", PAGE, re.MULTILINE)

    files = {str(path.relative_to(walked)) for path in walked.rglob("*") if path.is_file()}
    assert set(rows) == files - {"README.md"}


def test_every_command_that_needs_no_installing_does_what_is_said(
    walked: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    told, tested, run = [command[1:] for command in COMMANDS if "--law" in command]

    assert cli.main(told) == 0
    assert "Source: Dahl (1968)" in capsys.readouterr().out
    assert tested[:2] == ["laws", "test"]
    assert run[0] == "run"
    assert cli.main(["check", *run[1:-2]]) == 0
    assert "soft-rubber by auto: points 40" in capsys.readouterr().out


def test_the_call_from_python_gives_a_curve_that_ends_at_mu(
    walked: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.syspath_prepend(str(walked))
    names: dict[str, object] = {}
    exec(block("python"), names)
    sys.modules.pop("soft_rubber")

    table = names["table"]
    assert isinstance(table, pd.DataFrame)
    assert list(table["status"]) == ["ok"] * 12
    assert table["mean_friction"].iloc[-1] == pytest.approx(0.4, abs=1e-6)
    errors = table["error"] + table["error"].shift()
    assert (table["mean_friction"].diff() >= -errors)[1:].all()
    assert "mean_friction" in capsys.readouterr().out


def test_the_study_of_one_file_knows_the_law_beside_it(walked: Path) -> None:
    Path("one.yaml").write_text(block("one file"))

    (law,) = load_study("one.yaml").laws
    assert (law.kind, law.law_class.__name__) == ("soft-rubber", "SoftRubber")


def test_the_whole_file_is_a_law() -> None:
    names: dict[str, Any] = {}
    exec(compile(block("whole file"), "fading.py", "exec", dont_inherit=True), names)
    law = names["Fading"](mu_rest=0.4, mu_fast=0.2, fading_speed=2)

    assert [law.sliding_friction(speed) for speed in (0.0, 100.0)] == pytest.approx([0.4, 0.2])


def test_the_interfaces_and_numbers_are_names_of_frictionlab() -> None:
    named = re.findall(r"`([A-Z]\w+)`", PAGE.partition("## What to derive from")[2])

    assert len(set(named)) == 13
    assert [name for name in named if name not in fl.__all__] == []


def test_smoothing_is_a_stepper_of_march(walked: Path) -> None:
    (methods,) = re.findall(r"`(methods: .*?)`", PAGE.replace("\n", " "))
    Path("smooth.yaml").write_text(
        f"{block('one file').partition('laws:')[0]}laws: [{{kind: coulomb, mu: 0.4}}]\n{methods}\n"
    )

    (case,) = load_study("smooth.yaml").cases()
    assert case.method.name == "march"


@deep("compiles the law and installs it")
def test_the_whole_way_leads_to_a_curve(walked: Path) -> None:
    pytest.importorskip("frictionlab.testing")
    site = walked.parent / "site"
    house = str(Path(fl.__file__).parents[1])
    known = os.environ | {"PYTHONPATH": os.pathsep.join([house, str(site)]), "PIP_NO_WARN_CONFLICTS": "1"}
    words = {
        "frictionlab": [
            sys.executable,
            "-c",
            "import sys; from frictionlab.cli import main; sys.exit(main())",
        ]
    }
    words |= {"python": [sys.executable], "pip": [sys.executable, "-m", "pip"]}
    for command in COMMANDS[2:]:
        head, *rest = command
        if head == "pip":  # not into the surroundings of the tests
            rest = ["install", "--quiet", "--no-deps", "--target", str(site), "."]
        done = subprocess.run(
            [*words[head], *rest], cwd=walked, env=known, capture_output=True, text=True, timeout=900
        )
        assert done.returncode == 0, f"{command}: {done.stdout}{done.stderr}"
    assert read_saved(walked / "out").counts == {"ok": 80}
    assert read_saved(walked / "runs" / "study").counts == {"ok": 80}


def test_the_bounds_of_the_page_refuse_what_lies_outside() -> None:
    head, _, fields = block("bounds").partition("\n\n")
    law = "class Bounded(fl.SlidingLaw):\n    sliding_friction = lambda self, speed: 0.4\n"
    space: dict[str, Any] = {}
    text = f"import frictionlab as fl\n{head}\n{law}{indent(fields, '    ')}"
    exec(compile(text, "page", "exec", dont_inherit=True), space)

    assert space["Bounded"](share=0.5).fading_speed == 1.0
    for wrong in ({"share": 1.5}, {"share": 0.5, "fading_speed": 11.0}):
        with pytest.raises(ValueError, match=r"must be <= 1|must be >= 0.01 and <= 10|must be <= 10"):
            space["Bounded"](**wrong)
