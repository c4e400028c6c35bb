"""Damage to the folder of a run: what a run and a report say, and how the same command mends it."""

from __future__ import annotations

import hashlib
import json
import os
import re
import subprocess
import sys
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

import pandas as pd
import pytest
from fake_methods import faked
from fig_4b import STEADY
from pandas.testing import assert_frame_equal
from profiles import deep

import frictionlab as fl
from frictionlab import cli
from frictionlab.charts import figures
from frictionlab.runner.files import FolderError, remove_leftovers, unfinished
from frictionlab.runner.folder import run_folder
from frictionlab.runner.saved import read_run as read_saved
from frictionlab.study.load import load_study
from frictionlab.study.written import yaml_text
from frictionlab.values.printable import printable

pytestmark = deep("seconds of runs")

STUDY = faked([2.0, 4.0, 9.0, 12.0], plugins=["steady.py"], laws=[{"kind": "steady", "mu": 0.4}])
STUDY |= {"keep": {"orbit": 4}, "expect": [{"column": "mean_friction", "below": 1}]}
FILES = ("results.parquet", "results.csv", "curves.csv", "orbits.parquet", "study.yaml", "laws/steady.py")


@pytest.fixture(autouse=True)
def _solved_by_a_fake(fakes: None, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "steady.py").write_text(STEADY)
    (tmp_path / "mine.yaml").write_text(yaml_text(STUDY))


def contents(folder: Path) -> dict[str, bytes]:
    return {name: (folder / name).read_bytes() for name in FILES}


def half(path: Path) -> None:
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])


def flipped(path: Path) -> None:
    whole = bytearray(path.read_bytes())
    whole[len(whole) // 2] ^= 1
    path.write_bytes(whole)


Deed = Callable[[Path], None]
DEEDS = [("results.parquet", flipped), *((name, deed) for name in FILES for deed in (half, Path.unlink))]


@pytest.mark.parametrize(("name", "deed"), DEEDS)
def test_a_damaged_file_is_named_with_the_command_that_mends_it(name: str, deed: Deed) -> None:
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
        assert re.fullmatch(f"out/{name} is .*; it is made again", line)
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


REPORT, RUN = ["report", "out"], ["run", "mine.yaml", "-o", "out"]


def test_the_commands_say_what_is_damaged(capsys: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(figures, "draw_figures", lambda *_: [Path("out")])
    fl.run("mine.yaml", out="out")
    half(Path("out/results.csv"))

    for asked, said in ((REPORT, "out/results.csv is damaged: it has "), (RUN, "results.csv is damaged")):
        assert cli.main(asked) == 0
        assert said in capsys.readouterr().err
    assert cli.main(["plot", "out"]) == 0
    assert capsys.readouterr().err == ""


@pytest.mark.parametrize("deed", [half, Path.unlink])
def test_a_folder_without_its_account_is_replaced_by_the_command_named(deed: Deed, capsys: Any) -> None:
    fl.run("mine.yaml", out="out")
    deed(Path("out/provenance.json"))

    for asked in (REPORT, RUN):
        assert cli.main(asked) == 2
        assert "frictionlab run STUDY -o out --force" in capsys.readouterr().err
    fl.run("mine.yaml", out="out", existing="replace")
    assert reported(Path("out")) == ""


@pytest.mark.parametrize("name", ["results.parquet", "study.yaml", "provenance.json"])
def test_any_flipped_bit_is_noticed_or_does_no_harm(name: str) -> None:
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
    for written in (pd.read_csv("out/results.csv"), pd.read_parquet("out/results.parquet")):
        assert list(written) == list(part.table)
    fl.run("mine.yaml", out="few", columns=["floquet"])
    whole = fl.run("mine.yaml", out="few")
    assert list(pd.read_csv("few/results.csv")) == list(whole.table)


def test_leftovers_of_killed_runs_are_removed_and_those_of_running_ones_stay(tmp_path: Path) -> None:
    process = subprocess.Popen([sys.executable, "-c", ""])
    process.wait()
    for folder in (Path("out"), Path("out/laws")):
        folder.mkdir()
        stays = {folder / ".mine", unfinished(folder / "results.csv", os.getppid())}
        goes = {
            unfinished(folder / name, process.pid) for name in ("results.parquet", "report.html", "steady.py")
        }
        for path in stays | goes:
            path.write_text("")

    fl.run("mine.yaml", out="out")

    assert {path.name for path in Path("out").rglob(".*")} == {path.name for path in stays}
    unfinished(tmp_path / "index.html", os.getpid()).write_text("")
    remove_leftovers(tmp_path)
    assert not list(tmp_path.glob(".index*"))


def test_the_account_holds_a_checksum_of_the_table_and_the_length_of_every_file_that_is_read_again() -> None:
    fl.run("mine.yaml", out="out")
    account = json.loads(Path("out/provenance.json").read_text())

    lengths = {name: len(content) for name, content in contents(Path("out")).items()}
    assert account["files"] | {"study.yaml": lengths["study.yaml"]} == lengths
    assert "study.yaml" not in account["files"]
    assert account["table"] == hashlib.sha256(Path("out/results.parquet").read_bytes()).hexdigest()
