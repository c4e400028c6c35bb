"""Damage to the folder of a run: what a run and a report say, and how the same command mends it."""

from __future__ import annotations

import hashlib
import json
import os
import subprocess
import sys
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

import pandas as pd
import pytest
from fake_methods import Fake, register
from pandas.testing import assert_frame_equal
from profiles import deep

import frictionlab as fl
from frictionlab import cli
from frictionlab.charts import figures
from frictionlab.runner.files import FolderError, begun, remove_leftovers
from frictionlab.runner.folder import run_folder
from frictionlab.runner.saved import load as read_saved
from frictionlab.study.load import load_study
from frictionlab.study.written import yaml_text
from frictionlab.values.printable import printable

pytestmark = deep("seconds of runs")

LAW = '''"""A law."""
import frictionlab as fl


class Steady(fl.SlidingLaw):
    """Of a constant coefficient."""

    mu: fl.Positive

    def sliding_friction(self, speed: float) -> float:
        """The coefficient."""
        return self.mu
'''
STUDY = {
    "schema": 1,
    "scene": {"damping_ratio": 0.1, "normal_load": 10, "drive": {"unbalance": 10, "frequency": 1}},
    "plugins": ["steady.py"],
    "laws": [{"kind": "steady", "mu": 0.4}],
    "methods": ["fake"],
    "sweep": {"scene.belt_speed": [2.0, 4.0, 9.0, 12.0]},
    "keep": {"orbit": 4},
    "expect": [{"column": "mean_friction", "below": 1}],
}
FILES = ("results.parquet", "results.csv", "curves.csv", "orbits.parquet", "study.yaml", "laws/steady.py")


@pytest.fixture(autouse=True)
def _solved_by_a_fake(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    register(monkeypatch, fake=Fake)
    monkeypatch.chdir(tmp_path)
    (tmp_path / "steady.py").write_text(LAW)
    (tmp_path / "mine.yaml").write_text(yaml_text(STUDY))


def contents(folder: Path) -> dict[str, bytes]:
    return {name: (folder / name).read_bytes() for name in FILES}


def half(path: Path) -> None:
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])


def flipped(path: Path) -> None:
    whole = bytearray(path.read_bytes())
    whole[len(whole) // 2] ^= 1
    path.write_bytes(whole)


def removed(path: Path) -> None:
    path.unlink()


@pytest.mark.parametrize(
    ("name", "deed"),
    [("results.parquet", flipped), *((name, deed) for name in FILES for deed in (half, removed))],
)
def test_a_damaged_file_is_named_with_the_command_that_mends_it(
    name: str, deed: Callable[[Path], None]
) -> None:
    out, study = Path("out"), load_study("mine.yaml")
    whole = fl.run(study, out=out)
    before = contents(out)
    deed(out / name)

    told = reported(out)
    assert f"out/{name}" in told or f"no {name} in it" in told
    command = told.rpartition("frictionlab ")[2].replace("STUDY", "mine.yaml").split()
    assert command in (["run", "mine.yaml", "-o", "out"], ["run", "out/study.yaml", "-o", "out"])

    said = run_folder(study, out).damaged()
    if name != "study.yaml":  # it may be edited, and is written by every run
        (line,) = said
        assert line.startswith(f"out/{name} is ")
        assert line.endswith("; it is made again")
    again = fl.run(command[1], out=out)
    assert contents(out) == before
    assert_frame_equal(again.table, whole.table)
    assert (reported(out), run_folder(study, out).damaged()) == ("", [])


def reported(folder: Path) -> str:
    """What a report says about the files of its folder."""
    try:
        return "\n".join(read_saved(folder).damaged)
    except FolderError as problem:
        return str(problem)


def test_the_commands_say_what_is_damaged(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(figures, "draw_figures", lambda *_: [Path("out")])
    fl.run("mine.yaml", out="out")
    half(Path("out/results.csv"))

    assert cli.main(["report", "out"]) == 0
    assert "out/results.csv is damaged: it has " in capsys.readouterr().err
    assert cli.main(["run", "mine.yaml", "-o", "out"]) == 0
    assert "results.csv is damaged" in capsys.readouterr().err
    assert cli.main(["plot", "out"]) == 0
    assert capsys.readouterr().err == ""


@pytest.mark.parametrize("deed", [half, removed])
def test_a_folder_without_its_account_is_replaced_by_the_command_that_is_named(
    deed: Callable[[Path], None], capsys: pytest.CaptureFixture[str]
) -> None:
    fl.run("mine.yaml", out="out")
    deed(Path("out/provenance.json"))

    for asked in (["report", "out"], ["run", "mine.yaml", "-o", "out"]):
        assert cli.main(asked) == 2
        assert "frictionlab run STUDY -o out --force" in capsys.readouterr().err
    fl.run("mine.yaml", out="out", existing="replace")
    assert reported(Path("out")) == ""


@pytest.mark.parametrize("name", ["results.parquet", "study.yaml", "provenance.json"])
def test_any_flipped_bit_is_noticed_or_does_no_harm(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    fl.run("mine.yaml", out="out")
    place = Path("out") / name
    whole = place.read_bytes()

    for at in range(0, len(whole), max(1, len(whole) // 12)):
        changed = bytearray(whole)
        changed[at] ^= 1 << at % 8
        place.write_bytes(changed)
        told = reported(Path("out"))
        assert "frictionlab run " in told or told == ""
        assert printable(told) == told


def test_a_file_that_is_being_replaced_is_known_before_and_after(monkeypatch: pytest.MonkeyPatch) -> None:
    class Killed(BaseException):
        """A process that ends here."""

    out, replace = Path("out"), os.replace
    steps, table, left = 0, fl.run("mine.yaml").table, [0]
    while left[0] <= 0:  # every rename of a run is the last one once
        steps += 1
        left = [steps]

        def dying(source: Path, target: Path, left: list[int] = left) -> None:
            left[0] -= 1
            if left[0] == 0:
                raise Killed
            replace(source, target)

        monkeypatch.setattr(os, "replace", dying)
        with suppress(Killed):
            fl.run("mine.yaml", out=out, existing="replace")
        monkeypatch.setattr(os, "replace", replace)
        again = fl.run("mine.yaml", out=out)

        assert_frame_equal(again.table, table)
        assert read_saved(out).damaged == ()
    assert steps > 3


def test_a_table_is_not_left_beside_the_text_of_an_earlier_one() -> None:
    fl.run("mine.yaml", out="out")
    part = fl.run("mine.yaml", out="out", columns=["reversals"], existing="reuse")
    assert (
        list(pd.read_csv("out/results.csv"))
        == list(part.table)
        == list(pd.read_parquet("out/results.parquet"))
    )
    fl.run("mine.yaml", out="few", columns=["floquet"])
    whole = fl.run("mine.yaml", out="few")
    assert list(pd.read_csv("few/results.csv")) == list(whole.table)


def test_leftovers_of_killed_runs_are_removed_and_those_of_running_ones_stay(tmp_path: Path) -> None:
    process = subprocess.Popen([sys.executable, "-c", ""])
    process.wait()
    gone, mine = process.pid, os.getpid()
    for folder in ("out", "out/laws"):
        Path(folder).mkdir()
        for name in ("results.parquet", "report.html", "steady.py"):
            begun(Path(folder) / name, gone).write_text("")
        (Path(folder) / ".mine").write_text("")
        begun(Path(folder) / "results.csv", os.getppid()).write_text("")

    fl.run("mine.yaml", out="out")

    left = {path.name for path in Path("out").rglob(".*")}
    assert left == {".mine", begun(Path("results.csv"), os.getppid()).name}
    begun(tmp_path / "index.html", mine).write_text("")
    remove_leftovers(tmp_path)
    assert not list(tmp_path.glob(".index*"))


def test_the_account_holds_a_checksum_of_the_table_and_the_length_of_every_file_that_is_read_again() -> None:
    fl.run("mine.yaml", out="out")
    account = json.loads(Path("out/provenance.json").read_text())

    assert account["files"] == {
        name: (Path("out") / name).stat().st_size for name in FILES if name != "study.yaml"
    }
    assert account["table"] == hashlib.sha256(Path("out/results.parquet").read_bytes()).hexdigest()
