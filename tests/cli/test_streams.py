"""What a command prints: no text ends a run, and none steers the terminal."""

from __future__ import annotations

import os
import subprocess
import sys
import xml.etree.ElementTree as ET
from pathlib import Path

import pytest

from frictionlab.printable import printable

STUDY = """schema: 1
title: "\\e[31m\\a red \\ud83d\\ude00"
scene: {damping_ratio: 0.1, normal_load: 10, drive: {unbalance: 10, frequency: 1}}
laws: [{kind: coulomb, mu: 0.4, label: µ→0}]
methods: [exact]
sweep: {scene.belt_speed: [4, 5]}
expect: [{column: mean_friction, below: 1, because: "\\e[0m"}]
"""


def command(folder: Path, *arguments: str | bytes, **environment: str) -> subprocess.CompletedProcess[bytes]:
    return subprocess.run(
        [sys.executable, "-c", "import sys; from frictionlab.cli import main; sys.exit(main())", *arguments],
        cwd=folder, env=os.environ | environment, capture_output=True,
    )  # fmt: skip


@pytest.mark.parametrize("encoding", ["ascii", "latin-1"])
def test_a_terminal_that_cannot_show_a_character_does_not_end_a_run(tmp_path: Path, encoding: str) -> None:
    (tmp_path / "study.yaml").write_text(STUDY, encoding="utf-8")
    done = command(tmp_path, "run", "study.yaml", PYTHONIOENCODING=encoding)
    said = (done.stdout + done.stderr).decode("latin-1")

    assert done.returncode == 0, said
    assert b"\x1b" not in done.stdout + done.stderr
    assert b"\\x1b[31m" in done.stdout
    report = (tmp_path / "runs" / "study" / "report.html").read_text(encoding="utf-8")
    assert printable(report) == report
    ET.parse(tmp_path / "runs" / "study" / "figures" / "mean_friction.svg")


def test_a_name_that_is_no_text_does_not_end_a_run(tmp_path: Path) -> None:
    name = os.fsencode(tmp_path) + b"/\xff\x1b.yaml"
    with open(name, "wb") as file:
        file.write(STUDY.replace('title: "\\e[31m\\a red \\ud83d\\ude00"\n', "").encode())
    done = command(tmp_path, "run", name)

    assert done.returncode == 0, done.stderr
    assert b"runs/\\udcff\\x1b" in done.stderr
    assert command(tmp_path, "report", b"runs/\xff\x1b").returncode == 0


@pytest.mark.parametrize("arguments", [["\x1b[31m"], ["run", "\x1b[31m.yaml"], ["check", "--\x1b"]])
def test_what_was_typed_is_shown_and_not_obeyed(tmp_path: Path, arguments: list[str]) -> None:
    done = command(tmp_path, *arguments)

    assert done.returncode == 2
    assert b"\\x1b" in done.stderr
    assert b"\x1b" not in done.stderr
