"""What a command prints: no text ends a run, and none steers the terminal."""

from __future__ import annotations

import os
import subprocess
import sys
import xml.etree.ElementTree as ET
from pathlib import Path

import pytest
from profiles import deep

from frictionlab import cli
from frictionlab.values.printable import printable

STUDY = """schema: 1
title: "\\e[31m\\a red \\ud83d\\ude00"
scene: {damping_ratio: 0.1, normal_load: 10, drive: {unbalance: 10, frequency: 1}}
laws: [{kind: coulomb, mu: 0.4, label: µ→0}]
methods: [exact]
sweep: {scene.belt_speed: [4, 5]}
columns: [mean_friction]
expect: [{column: mean_friction, below: 1, because: "\\e[0m"}]
"""


@deep("processes")
def test_neither_a_name_that_is_no_text_nor_a_terminal_of_few_characters_ends_a_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path(os.fsdecode(b"\xff\x1b.yaml")).write_text(STUDY, encoding="utf-8")
    program = "import sys; from frictionlab.cli import main; sys.exit(main())"
    command = [sys.executable, "-c", program, "run", b"\xff\x1b.yaml"]
    done = subprocess.run(command, env=os.environ | {"PYTHONIOENCODING": "ascii"}, capture_output=True)
    out = Path("runs") / os.fsdecode(b"\xff\x1b")

    assert done.returncode == 0, done.stderr
    assert b"\x1b" not in done.stdout + done.stderr
    assert b"\\x1b[31m" in done.stdout
    assert b"runs/\\udcff\\x1b" in done.stderr
    report = (out / "report.html").read_text(encoding="utf-8")
    assert printable(report) == report
    ET.parse(out / "figures" / "mean_friction.svg")
    assert cli.main(["report", str(out)]) == 0


@pytest.mark.parametrize("arguments", [["\x1b[31m"], ["run", "\x1b[31m.yaml"], ["check", "--\x1b"]])
def test_what_was_typed_is_shown_and_not_obeyed(
    capsys: pytest.CaptureFixture[str], arguments: list[str]
) -> None:
    assert cli.main(arguments) == 2
    said = capsys.readouterr().err
    assert "\\x1b" in said
    assert "\x1b" not in said
