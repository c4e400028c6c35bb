"""The command line: what goes to stdout and what to stderr, which exit code, what is left behind."""

from __future__ import annotations

import errno
import json
import os
import re
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pandas as pd
import pytest
from fake_methods import Fake, breaks_down, faked, register
from profiles import deep, some

from frictionlab import cli
from frictionlab.bench import load_bench
from frictionlab.charts import figures
from frictionlab.runner import api, engine
from frictionlab.runner.files import alone_in
from frictionlab.study.bibliography import read_bibtex
from frictionlab.study.load import load_study
from frictionlab.study.written import yaml_text

POINTS = [4.0, 13.0, -2.0, 9.0]
DOOR = "[frictionlab.methods]\nfake = fake_methods:Fake\n"


@pytest.fixture(autouse=True)
def _interrupts_are_heard() -> Iterator[None]:
    """A shell starts what runs in the background with interrupts ignored, and so everything started from there."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.fixture(autouse=True)
def _in_a_folder_of_its_own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("frictionlab.runner.progress.QUIET", 600.0)  # a busy machine is slow
    register(monkeypatch, fake=Fake)
    handler = signal.getsignal(signal.SIGTERM)
    yield
    signal.signal(signal.SIGTERM, handler)


@pytest.fixture(autouse=True)
def _draws_where_that_is_looked_at(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    if "drawn" not in request.fixturenames:
        for step in ("_draw", "_report"):
            monkeypatch.setattr(f"frictionlab.cli.run.{step}", lambda *_: None)


@pytest.fixture
def drawn() -> None:
    """Runs draw their figures and write their report."""


def study(name: str = "study.yaml", **changes: Any) -> str:
    Path(name).parent.mkdir(parents=True, exist_ok=True)
    Path(name).write_text(yaml_text(faked(POINTS, **changes)))
    return name


class Said:
    """What a command said, and its exit code."""

    def __init__(self, capsys: pytest.CaptureFixture[str], *arguments: str) -> None:
        self.code = cli.main(arguments)
        self.out, self.err = capsys.readouterr()


@pytest.fixture
def frictionlab(capsys: pytest.CaptureFixture[str]) -> Any:
    return lambda *arguments: Said(capsys, *arguments)


def test_a_run_prints_curves_reasons_verdicts_and_where_the_table_is(frictionlab: Any) -> None:
    claim = {"where": {"scene.belt_speed": 4}, "column": "mean_friction", "below": 0.2, "because": "it is so"}
    said = frictionlab("run", study(title="A title", expect=[claim]))

    assert said.code == 0
    lines = said.out.splitlines()
    assert lines[0] == "A title"
    assert lines[1] == "4 points: 3 ok, 1 refused"
    assert any("coulomb" in line and "-0.128537 ... 0.133333" in line and "1.0e-08" in line for line in lines)
    assert "coulomb, 1 refused at belt speed 13: thirteen, of all numbers" in lines
    assert "expect: 1 passed" in lines
    assert "it is so" not in said.out
    assert lines[-1] == "table in runs/study/results.parquet"
    assert len(pd.read_parquet("runs/study/results.parquet")) == 4


def test_a_run_writes_its_report_last_with_its_figures_inside(frictionlab: Any, drawn: None) -> None:
    said = frictionlab("run", study(columns=["mean_friction"]), "--out", "out")

    assert said.err.splitlines()[-1] == "report in out/report.html"
    assert "figures in out/figures" in said.err
    assert {path.suffix for path in Path("out/figures").iterdir()} == {".svg", ".png"}
    assert Path("out/report.html").read_text().count('<img src="data:image/') == 1
    assert said.out.splitlines()[-1] == "table in out/results.parquet"


@deep("seconds of reports")
def test_the_same_run_again_makes_only_pages_that_are_gone_or_changed(
    frictionlab: Any, monkeypatch: Any, drawn: None
) -> None:
    name, made = study(columns=["mean_friction"]), []
    first = frictionlab("run", name, "-o", "out")
    before = {path: path.read_bytes() for path in Path("out").rglob("*.*g")}
    draw = figures.draw_figures
    monkeypatch.setattr(figures, "draw_figures", lambda *given: made.append(1) or draw(*given))
    again = frictionlab("run", name, "-o", "out")
    assert (again.err.splitlines()[-2:], made) == (first.err.splitlines()[-2:], [])
    for deed in (Path.unlink, lambda file: file.write_text("mine")):
        deed(Path("out/figures/mean_friction.svg"))
        frictionlab("run", name, "-o", "out")
        assert {path: path.read_bytes() for path in Path("out").rglob("*.*g")} == before
    assert len(made) == 2


def test_plot_and_report_make_again_what_a_run_made_and_compute_nothing(
    frictionlab: Any, monkeypatch: Any, drawn: None
) -> None:
    frictionlab("run", study(columns=["mean_friction"]), "-o", "out")
    files = ("report.html", "figures/mean_friction.svg", "figures/mean_friction.png")
    before = [(Path("out") / file).read_bytes() for file in files]
    monkeypatch.setattr(Fake, "solve", lambda *_: pytest.fail("computed"))
    for file in files:
        (Path("out") / file).unlink()
    written = frictionlab("report", "out")

    assert (written.code, written.err, written.out) == (0, "", "out/report.html\n")
    assert [(Path("out") / file).read_bytes() for file in files] == before

    for file in files[1:]:
        (Path("out") / file).unlink()
    drawn = frictionlab("plot", "out")

    assert (drawn.code, drawn.err) == (0, "")
    assert sorted(drawn.out.split()) == sorted(f"out/{file}" for file in files[1:])
    assert [(Path("out") / file).read_bytes() for file in files] == before


@deep("seconds of runs")
def test_a_run_without_a_sweep_has_nothing_to_plot_and_a_report(frictionlab: Any) -> None:
    frictionlab("run", study(sweep={}), "-o", "out")
    said = frictionlab("plot", "out")

    assert (said.code, said.out) == (0, "")
    assert said.err == "no figures: the study of out sweeps nothing\n"
    assert frictionlab("report", "out").code == 0


@pytest.mark.parametrize("command", ["plot", "report"])
def test_what_is_no_run_is_code_2_with_one_message(frictionlab: Any, command: str) -> None:
    study()
    Path("empty").mkdir()
    frictionlab("run", "study.yaml", "-o", "all/one")
    said = {name: frictionlab(command, name) for name in ("missing", "study.yaml", "empty", "all")}

    assert {each.code for each in said.values()} == {2}
    assert {each.out for each in said.values()} == {""}
    assert {each.err.count("\n") for each in said.values()} == {1}
    assert (
        "missing: no such folder; RUN is a folder that 'frictionlab run STUDY -o RUN' wrote"
        in said["missing"].err
    )
    assert "is a file" in said["study.yaml"].err
    assert "no results.parquet, study.yaml, provenance.json in it" in said["empty"].err
    assert "give one of them: all/one" in said["all"].err


@deep("seconds of runs")
def test_a_page_that_cannot_be_written_is_code_3_with_the_table_safe(
    frictionlab: Any, monkeypatch: Any, drawn: None
) -> None:
    def replace(source: Path, target: Path) -> None:
        if target.name == "report.html":
            raise OSError(errno.ENOSPC, "No space left on device")
        whole(source, target)

    whole = os.replace
    monkeypatch.setattr("frictionlab.runner.folder.os.replace", replace)
    said = frictionlab("run", study(sweep={}), "-o", "out")

    assert said.code == 3
    assert said.out.splitlines()[-1] == "table in out/results.parquet"
    assert said.err.splitlines()[-1] == "cannot write out/report.html: No space left on device"
    assert not [path for path in Path("out").iterdir() if path.name.startswith(".")]


@deep("seconds of reports")
def test_force_takes_the_report_of_the_earlier_study_away(frictionlab: Any) -> None:
    frictionlab("run", study(), "-o", "out")
    assert frictionlab("report", "out").code == 0
    frictionlab("run", study(tolerance=1e-6), "-o", "out", "--force")

    assert not Path("out/report.html").exists()


@deep("seconds of reports")
def test_a_folder_of_studies_gets_an_index_that_leads_to_every_report(frictionlab: Any, drawn: None) -> None:
    study("set/one.yaml", title="The first", sweep={})
    study("set/two.yaml", sweep={})
    said = frictionlab("run", "set", "-o", "out")

    assert said.err.splitlines()[-1] == "index in out/index.html"
    index = Path("out/index.html").read_text()
    assert "The first" in index
    for link in ("one/report.html", "two/report.html"):
        assert f'href="{link}"' in index
        assert (Path("out") / link).is_file()
    assert frictionlab("run", "set", "-o", "out").code == 0


def test_an_index_that_a_person_wrote_stays_and_nothing_is_computed(
    frictionlab: Any, monkeypatch: Any
) -> None:
    monkeypatch.setattr(Fake, "solve", lambda *_: pytest.fail("computed"))
    study("set/one.yaml")
    Path("out").mkdir()
    Path("out/index.html").write_text("mine")
    said = frictionlab("run", "set", "-o", "out")

    assert (said.code, said.out) == (2, "")
    assert said.err == (
        "out/index.html is there already and was not written by frictionlab; choose another folder with -o\n"
    )
    assert [path.name for path in Path("out").iterdir()] == ["index.html"]


def test_a_new_study_is_written_once_and_runs_as_it_is(frictionlab: Any) -> None:
    said = frictionlab("new", "study", "my study")
    again = frictionlab("new", "study", "my study")

    assert (said.code, said.out) == (0, "my study.yaml\n")
    assert said.err == "change what it says, then: frictionlab run 'my study.yaml'\n"
    assert frictionlab("check", "my study.yaml").code == 0
    assert (again.code, again.out) == (2, "")
    assert again.err == "my study.yaml is there already and stays as it is; choose another name\n"


def test_a_new_study_in_si_units_is_one(frictionlab: Any) -> None:
    assert frictionlab("new", "study", "mine", "--si").code == 0

    scene = load_study("mine.yaml").scene
    assert scene.dimensional is not None
    assert repr(scene.dimensional.belt_vibration).startswith("dict(displacement_amplitude_m=5e-06, frequency")


def test_a_new_list_of_a_bench_can_be_measured_as_it_is(frictionlab: Any) -> None:
    said = frictionlab("new", "bench", "mine")

    assert (said.code, said.out) == (0, "mine.yaml\n")
    assert said.err == "change what it says, then: frictionlab bench mine.yaml\n"
    assert load_bench(Path("mine.yaml")).names == ["resonance"]
    assert frictionlab("new", "bench", "mine").code == 2


def test_a_new_study_names_its_schema_to_editors_who_find_it_beside_the_file(frictionlab: Any) -> None:
    assert frictionlab("new", "study", "mine").code == 0
    line, schema = Path("mine.yaml").read_text().splitlines()[0], Path("frictionlab.schema.json")
    assert line == f"# yaml-language-server: $schema=./{schema.name}"
    assert schema.read_text() == frictionlab("schema").out

    schema.write_text("{}")
    said = frictionlab("new", "study", "another")
    assert said.code == 0
    assert "frictionlab.schema.json is that of other laws or another version and stays" in said.err
    assert schema.read_text() == "{}"


@deep("seconds of runs")
def test_the_table_is_on_disk_before_the_drawing_begins(frictionlab: Any, monkeypatch: Any) -> None:
    seen = []
    monkeypatch.setattr(
        "frictionlab.cli.run._draw", lambda *_: seen.extend(path.name for path in Path("out").iterdir())
    )
    frictionlab("run", study(), "-o", "out")

    assert {"results.parquet", "results.csv", "study.yaml", "provenance.json"} <= set(seen)


def test_json_is_one_record_per_row_and_nothing_else_on_stdout(frictionlab: Any) -> None:
    said = frictionlab("run", study(), "--json", "-j", "3")

    records = json.loads(said.out)
    assert [record["scene.belt_speed"] for record in records] == POINTS
    assert records[1]["mean_friction"] is None
    assert list(records[0])[:3] == ["law", "kind", "method"]


def test_a_value_set_on_the_command_line_is_in_the_table_and_in_the_study_kept(frictionlab: Any) -> None:
    frictionlab("run", study(), "-o", "out", "--set", "scene.normal_load=3", "--set", "tolerance=1e-6")

    assert set(pd.read_parquet("out/results.parquet")["scene.normal_load"]) == {3.0}
    assert "normal_load: 3" in Path("out/study.yaml").read_text()
    assert json.loads(Path("out/provenance.json").read_text())["runs"][0]["overrides"] == [
        "scene.normal_load=3",
        "tolerance=1e-6",
    ]


@pytest.mark.parametrize(
    "arguments",
    [
        [],
        ["jump"],
        ["run"],
        ["run", "study.yaml", "-j", "0"],
        ["run", "study.yaml", "--no-such-option"],
        ["run", "study.yaml", "--cite", "--json"],
        ["laws", "glue"],
        ["run", "missing.yaml"],
        ["check", "missing.yaml"],
        ["run", "empty"],
        ["run", "study.yaml", "--set", "scene.mass=3"],
        ["check", "study.yaml", "--set", "scene.normal_load=-3"],
        ["run", "study.yaml", "-o", "study.yaml"],
        ["run", "study.yaml", "-o", "study.yaml/out"],
    ],
)
def test_a_wrong_command_or_study_is_code_2_with_a_message_and_leaves_nothing(
    frictionlab: Any, arguments: list[str]
) -> None:
    study()
    Path("empty").mkdir()
    said = frictionlab(*arguments)

    assert said.code == 2
    assert said.out == ""
    assert said.err
    assert "Traceback" not in said.err
    assert sorted(path.name for path in Path().iterdir()) == ["empty", "study.yaml"]


def test_every_mistake_is_told_before_anything_is_computed(frictionlab: Any, monkeypatch: Any) -> None:
    monkeypatch.setattr(Fake, "solve", lambda *_: pytest.fail("computed"))
    study("set/good.yaml")
    study("set/bad.yaml", tolerance=-1.0, sweep={"scene.mass": [1.0]})
    study("set/worse.yaml", laws=[])
    said = frictionlab("run", "set")

    assert said.code == 2
    assert "bad.yaml:" in said.err
    assert "worse.yaml:" in said.err
    assert not Path("runs").exists()


def test_a_folder_of_studies_runs_each_into_a_folder_of_its_own(frictionlab: Any) -> None:
    study("set/one.yaml")
    study("set/two.yaml", tolerance=1e-6)
    Path("set/notes.txt").write_text("no study")
    said = frictionlab("run", "set", "--json")

    assert said.code == 0
    assert [record["study"] for record in json.loads(said.out)] == ["one"] * 4 + ["two"] * 4
    assert sorted(path.name for path in Path("runs/set").iterdir()) == [".cache", "index.html", "one", "two"]


@deep("seconds of runs")
def test_a_run_prints_what_to_cite_for_it_and_computes_nothing_anew_for_that(frictionlab: Any) -> None:
    frictionlab("run", study(source="Dahl (1976)"), "-o", "out")
    said = frictionlab("run", "study.yaml", "-o", "out", "--cite")

    assert said.code == 0
    assert [entry.key for entry in read_bibtex(said.out)] == [
        *("frictionlab", "dahl1976", "amontons1699", "coulomb1785", "sulollari"),
    ]
    assert len(json.loads(Path("out/provenance.json").read_text())["runs"]) == 1


@deep("seconds of runs")
def test_publications_that_several_studies_draw_on_are_cited_once(frictionlab: Any) -> None:
    study("set/one.yaml")
    study("set/two.yaml", tolerance=1e-6, source="Dahl (1976)")
    keys = [entry.key for entry in read_bibtex(frictionlab("run", "set", "--cite").out)]

    assert len(keys) == len(set(keys)) == 5


@deep("seconds of runs")
def test_a_folder_that_holds_another_study_stops_all_of_them(frictionlab: Any) -> None:
    study("set/one.yaml")
    frictionlab("run", "set/one.yaml", "-o", "out/one")
    study("set/one.yaml", tolerance=1e-6)
    study("set/another.yaml")
    said = frictionlab("run", "set", "-o", "out")

    assert said.code == 2
    assert "another study" in said.err
    assert "--force" in said.err
    assert not Path("out/another").exists()
    assert frictionlab("run", "set", "-o", "out", "--force").code == 0


@pytest.mark.parametrize("options", [[], ["--force"]])
def test_a_study_that_a_person_wrote_is_never_overwritten(frictionlab: Any, options: list[str]) -> None:
    text = Path(study()).read_text()
    said = frictionlab("run", "study.yaml", "-o", ".", *options)

    assert said.code == 2
    assert "holds a study.yaml that no run wrote" in said.err
    assert [path.name for path in Path().iterdir()] == ["study.yaml"]
    assert Path("study.yaml").read_text() == text


def test_points_that_fail_are_code_3(frictionlab: Any, monkeypatch: Any) -> None:
    monkeypatch.setattr(Fake, "troubles", {4.0: breaks_down})
    said = frictionlab("run", study())

    assert said.code == 3
    assert "coulomb, 1 failed at belt speed 4: ZeroDivisionError: float division by zero" in said.out


def test_points_that_a_study_expects_to_fail_are_code_0(frictionlab: Any, monkeypatch: Any) -> None:
    monkeypatch.setattr(Fake, "troubles", {4.0: breaks_down, 9.0: breaks_down})
    expected = {"where": {"scene.belt_speed": 4}, "status": "failed"}

    assert frictionlab("run", study(expect=[expected]), "-o", "one").code == 3
    both = {"where": {"scene.belt_speed": [4, 9]}, "status": "failed"}
    assert frictionlab("run", study(expect=[expected, both]), "-o", "both").code == 0


def test_an_expectation_that_fails_is_code_3(frictionlab: Any) -> None:
    said = frictionlab("run", study(expect=[{"column": "mean_friction", "above": 9}]))

    assert said.code == 3
    assert "expect: 1 FAILED" in said.out
    assert "expect FAILED: " in said.out
    assert "expect FAILED: " in frictionlab("run", "study.yaml", "--json").err


@deep("seconds of runs")
def test_a_full_disk_is_code_3_and_the_summary_is_printed(frictionlab: Any, monkeypatch: Any) -> None:
    def replace(source: Path, target: Path) -> None:
        if target.name == "results.parquet":
            raise OSError(errno.ENOSPC, "No space left on device")
        whole(source, target)

    whole = os.replace
    monkeypatch.setattr("frictionlab.runner.folder.os.replace", replace)
    said = frictionlab("run", study(), "-o", "out")

    assert said.code == 3
    assert "4 points: 3 ok, 1 refused" in said.out
    assert "table in" not in said.out
    assert said.err.strip().endswith("cannot write out/results.parquet: No space left on device")
    assert len(json.loads(frictionlab("run", study(), "-o", "out", "--json").out)) == 4


@deep("seconds of runs")
def test_figures_that_cannot_be_written_are_code_3_with_the_table_safe(frictionlab: Any, drawn: None) -> None:
    Path("out").mkdir()
    Path("out/figures").write_text("in the way")
    said = frictionlab("run", study(), "-o", "out")

    assert said.code == 3
    assert "cannot write the figures" in said.err
    assert len(pd.read_parquet("out/results.parquet")) == 4


def test_a_bug_of_ours_is_code_1_with_a_traceback_and_a_plea(frictionlab: Any, monkeypatch: Any) -> None:
    monkeypatch.setattr(api, "solve_study", lambda *_: 1 / 0)
    said = frictionlab("run", study())

    assert said.code == 1
    assert "Traceback" in said.err
    assert "please report" in said.err


def test_a_check_tells_curves_points_models_refusals_and_time_and_keeps_nothing(frictionlab: Any) -> None:
    grid = {"scene.belt_speed": POINTS, "scene.damping_ratio": [0.1, 0.2]}
    said = frictionlab("check", study(methods=["fake", "auto"], sweep=grid))

    assert said.code == 0
    assert "coulomb by fake: points 8, curves 2" in said.out
    assert "2 refused: thirteen, of all numbers" in said.out
    assert "8 by exact (" in said.out
    assert said.out.count("lack points for a measure of shape; add belt speeds ") == 1
    assert "  coulomb: 4 of 4 curves lack points" in said.out
    assert re.search(
        r"about (\d+ min )?\d+ s on \d+ cores, \S+ s of it to solve, as measured on \d+ of 16 points",
        said.out,
    )
    assert sorted(path.name for path in Path().iterdir()) == ["study.yaml"]


def test_a_misspelt_command_is_told_with_the_one_meant(frictionlab: Any) -> None:
    said = frictionlab("rnu", "study.yaml")

    assert said.code == 2
    assert "No such command 'rnu'. Did you mean 'run'?" in said.err


def test_a_check_tells_laws_that_are_one(frictionlab: Any) -> None:
    dahl = {"kind": "dahl", "mu": 0.3, "presliding_length": 0.5}
    lugre = {"kind": "lugre", "mu_kinetic": 0.3, "presliding_length": 0.5}
    said = frictionlab("check", study(laws=[{"kind": "coulomb", "mu": 0.3}, dahl, lugre]))

    assert said.out.count("are one law") == 1
    assert "  dahl and lugre are one law with these numbers: their curves are one line\n" in said.out


def test_a_check_in_json_is_a_record_per_law_and_method(frictionlab: Any) -> None:
    (first, second) = json.loads(frictionlab("check", study(methods=["fake", "auto"]), "--json").out)

    assert (first["study"], first["law"], first["method"]) == ("study", "coulomb", "fake")
    assert (first["points"], first["curves"]) == (4, 1)
    assert 0.0 < first["seconds"] < 1.0
    assert first["refused"] == {"thirteen, of all numbers": 1}
    assert list(second["models"].values()) == [4]


def test_a_law_that_is_not_installed_is_code_2_with_the_one_that_is_meant(frictionlab: Any) -> None:
    for arguments in (["laws", "dupond"], ["laws", "test", "dupond"], ["warm", "dupond"]):
        said = frictionlab(*arguments)

        assert (said.code, said.out) == (2, "")
        assert "unknown law 'dupond'; installed: " in said.err
        assert "elasto-plastic (or dupont), " in said.err
        assert said.err.endswith("did you mean 'dupont'?\n")


def test_laws_are_listed_with_parameters_limits_and_what_they_declare(frictionlab: Any) -> None:
    assert "coulomb" in frictionlab("laws").out
    assert "Amontons (1699)" in frictionlab("laws", "coulomb").out
    records = {record["name"]: record for record in json.loads(frictionlab("laws", "--json").out)}
    (alone,) = json.loads(frictionlab("laws", "coulomb", "--json").out)

    assert records["coulomb"] == alone
    (mu,) = [given for given in alone["parameters"] if given["name"] == "mu"]
    assert (mu["required"], mu["default"], mu["limits"]) == (True, None, "> 0")
    assert "friction coefficient" in mu["meaning"]
    (mu_static,) = [given for given in alone["parameters"] if given["name"] == "mu_static"]
    assert (mu_static["required"], mu_static["default"], mu_static["limits"]) == (False, None, "> 0")
    assert "the subdifferential of mu |v|" in alone["declares"]["monotone"]


def test_columns_and_their_groups_are_listed(frictionlab: Any) -> None:
    columns = {record["column"]: record for record in json.loads(frictionlab("columns", "--json").out)}
    assert (columns["floquet"]["group"], columns["floquet"]["default"]) == ("multipliers", False)
    assert "energies: work of loads" in frictionlab("columns").out


def test_methods_are_listed(frictionlab: Any) -> None:
    assert "exact" in frictionlab("methods").out
    records = {record["name"]: record for record in json.loads(frictionlab("methods", "--json").out)}

    assert {"auto", "exact", "shooting", "fake"} <= set(records)
    assert records["fake"]["parameters"][0]["default"] == 0.0


def test_the_version_is_told(frictionlab: Any) -> None:
    said = frictionlab("--version")
    assert (said.code, said.out.split()[0]) == (0, "frictionlab")


# From here on in a process of its own, which finds the fake method by the public door.


@pytest.fixture
def surroundings(tmp_path: Path) -> dict[str, str]:
    door = tmp_path / "site" / "fake-1.0.dist-info"
    door.mkdir(parents=True)
    (door / "METADATA").write_text("Metadata-Version: 2.1\nName: fake\nVersion: 1.0\n")
    (door / "entry_points.txt").write_text(DOOR)
    places = [
        str(tmp_path / "site"),
        str(Path(__file__).parents[1]),
        *os.environ.get("PYTHONPATH", "").split(os.pathsep),
    ]
    return os.environ | {"PYTHONPATH": os.pathsep.join(filter(None, places))}


COMMAND = [sys.executable, "-m", "frictionlab"]


@deep("processes")
def test_a_stopped_run_keeps_what_is_done_and_the_same_command_continues(
    surroundings: dict[str, str],
) -> None:
    ratios = [0.1 * k for k in range(1, 7)]
    slow = [{"kind": "fake", "pause": 0.5, "touch": "begun"}]
    sweep = {"scene.damping_ratio": ratios, "scene.belt_speed": POINTS}
    study(methods=slow, sweep=sweep, columns=["mean_friction"])
    command = [*COMMAND, "run", "study.yaml", "-o", "out", "-j", "1"]
    unfinished = [24]
    for number in (signal.SIGINT, signal.SIGTERM):
        process = subprocess.Popen(
            command, env=surroundings, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
        )
        while not Path("begun").exists():
            assert process.poll() is None, process.communicate()
            time.sleep(0.02)
        process.send_signal(number)
        _, err = process.communicate(timeout=30)

        assert process.returncode == 130, err
        assert "Traceback" not in err
        assert " points are done and kept in out; the same command continues" in err
        left = pd.read_parquet("out/results.parquet")
        unfinished.append(int((left["status"] == "killed").sum()))
        assert 0 < unfinished[-1] < unfinished[-2]
        assert not [path for path in Path("out").iterdir() if path.name.startswith(".")]
        Path("begun").unlink()

    done = subprocess.run(command, env=surroundings, capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr
    assert "24 points: 18 ok, 6 refused" in done.stdout
    runs = json.loads(Path("out/provenance.json").read_text())["runs"]
    first, second = unfinished[1:]
    assert [run["computed"] for run in runs] == [24 - first, first - second, second]


@some(1, "a run each")
@pytest.mark.parametrize("stage", ["_draw", "_report"])
def test_an_interrupt_after_the_table_says_what_is_left_to_do(
    stage: str, frictionlab: Any, monkeypatch: Any
) -> None:
    monkeypatch.setattr("frictionlab.cli.run._draw", lambda *_: None)
    monkeypatch.setattr(f"frictionlab.cli.run.{stage}", lambda *_: signal.raise_signal(signal.SIGINT))
    said = frictionlab("run", study(), "-o", "out")

    assert said.code == 130
    whole = "interrupted: the table in out is whole; the same command makes figures and report\n"
    assert said.err.endswith(whole)


def test_an_interrupted_run_does_not_wait_for_a_method_that_takes_for_ever(
    frictionlab: Any, monkeypatch: Any
) -> None:
    left = []
    monkeypatch.setattr(engine, "GRACE", 0.05)
    monkeypatch.setattr(cli.os, "_exit", left.append)
    monkeypatch.setattr(
        "frictionlab.runner.progress.Meter.__call__", lambda *_: signal.raise_signal(signal.SIGINT)
    )
    said = frictionlab("run", study(methods=[{"kind": "fake", "pause": 4.0}]), "-o", "out")

    assert left == [130]
    assert "interrupted: 0 of 4 points are done; the same command continues" in said.err


def test_two_runs_into_one_folder_and_parts_of_one(frictionlab: Any) -> None:
    began, ends = threading.Event(), threading.Event()

    def work() -> None:
        with alone_in(Path("out")):
            began.set()
            ends.wait()

    other = threading.Thread(target=work)
    other.start()
    began.wait()
    run = "run", study(), "-o", "out"
    refused, part, plot = frictionlab(*run), frictionlab(*run, "--part", "1/2"), frictionlab("plot", "out")
    ends.set()
    other.join()

    assert (refused.code, part.code, plot.code) == (2, 0, 2)
    assert "out is in use by another run" in refused.err
    assert "out is in use by another run" in plot.err
    assert "study, part 1 of 2: " in part.out
    assert not Path("out").exists()


def test_every_command_is_a_module_of_its_name() -> None:
    files = {path.stem for path in Path(cli.__file__).parent.glob("*.py")}

    assert {*cli.COMMANDS} == files - {"__init__", "interrupts", "options", "output", "scaffold"}
    assert [*cli.COMMANDS] == sorted(cli.COMMANDS)


@deep("processes")
def test_a_reader_that_had_enough_sees_no_traceback(surroundings: dict[str, str]) -> None:
    text = " ".join(f"'{part}'" for part in COMMAND)
    done = subprocess.run(
        f"{text} laws --json | head -c 10",
        shell=True,
        env=surroundings,
        capture_output=True,
        text=True,
    )
    assert "Traceback" not in done.stderr
    assert "BrokenPipe" not in done.stderr


@deep("processes")
def test_a_command_whose_output_is_closed_runs_all_the_same(surroundings: dict[str, str]) -> None:
    study(sweep={})
    text = " ".join(f"'{part}'" for part in COMMAND)
    done = subprocess.run(f"{text} run study.yaml -o out >&- 2>&-", shell=True, env=surroundings)

    assert done.returncode == 0
    assert Path("out/results.parquet").exists()


@deep("processes")
@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs a device that is always full")
def test_an_output_that_takes_nothing_is_code_3(surroundings: dict[str, str]) -> None:
    with open("/dev/full", "w") as full:
        done = subprocess.run(
            [*COMMAND, "methods"], env=surroundings, stdout=full, stderr=subprocess.PIPE, text=True
        )
    assert done.returncode == 3
    assert "cannot write the output: No space left on device" in done.stderr
    assert "Traceback" not in done.stderr


@some(1, "a process each")
@pytest.mark.parametrize(
    ("arguments", "stranger"),
    [
        (["--help"], ["numpy", "scipy", "pandas", "numba", "pydantic", "matplotlib", "jinja2"]),
        (["run", "--help"], ["numpy", "scipy", "pandas", "numba", "pydantic", "matplotlib", "jinja2"]),
        (["laws"], ["pandas", "scipy", "numba", "matplotlib"]),
        (["run", "missing.yaml"], ["numba", "matplotlib"]),
        (["run", "study.yaml", "-o", "out"], ["numba", "hypothesis"]),
    ],
)
def test_a_command_imports_what_it_needs_and_no_more(
    frictionlab: Any, surroundings: dict[str, str], arguments: list[str], stranger: list[str]
) -> None:
    if "study.yaml" in arguments:
        study(methods=["exact"], sweep={})
        frictionlab(*arguments)
    code = "import sys; from frictionlab.cli import main; main(); print(*sys.modules, file=sys.stderr)"
    done = subprocess.run(
        [sys.executable, "-c", code, *arguments], env=surroundings, capture_output=True, text=True
    )

    loaded = set(done.stderr.split())
    assert "click" in loaded
    assert not loaded & set(stranger)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["run", ""], "Invalid value for 'STUDY': the path is empty"),
        (["run", "study.yaml", "-o", ""], "Invalid value for '-o' / '--out': the path is empty"),
        (["run", f"{'x' * 300}.yaml"], ".yaml: File name too long"),
        (["plot", "x" * 300], "xxx: File name too long"),
        (["run", "study.yaml", "-o", "out", "--cache", "study.yaml"], "--cache: study.yaml is a file"),
    ],
)
def test_a_path_that_can_be_none_is_one_message(frictionlab: Any, arguments: list[str], said: str) -> None:
    study()
    refused = frictionlab(*arguments)

    assert (refused.code, refused.out) == (2, "")
    assert said in refused.err
    assert "Traceback" not in refused.err
    assert sorted(path.name for path in Path().iterdir()) == ["study.yaml"]


def test_a_decimal_comma_is_told_to_be_a_point(frictionlab: Any) -> None:
    text = Path(study()).read_text().replace("mu: 0.4", "mu: 0,4")
    Path("study.yaml").write_text(text)

    assert "numbers are written with a point, such as 0.4" in frictionlab("check", "study.yaml").err
