"""The runner: every point gets a row, rows do not depend on the way they were made, nothing found is lost."""

from __future__ import annotations

import csv
import errno
import json
import math
import os
import pickle
import threading
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, fields
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from fake_methods import Fake, Trouble, breaks_down, faked, is_broken, is_wrong
from fig_4b import COULOMB, GIVEN, LAW, SCENE
from pandas.testing import assert_frame_equal
from profiles import deep, some

import frictionlab as fl
from frictionlab.runner import files, folder, study_run
from frictionlab.runner.files import FolderError, SaveError
from frictionlab.runner.packing import kept_of, packed_answers
from frictionlab.runner.pieces import Task, blocks_of_table, cuts, is_long
from frictionlab.runner.solve import solve
from frictionlab.runner.summary import summary
from frictionlab.runner.table import inputs, records
from frictionlab.study import registry
from frictionlab.study.load import load_study, parse_study
from frictionlab.testing import check_law
from frictionlab.values.columns import ALWAYS, DEFAULT, RESULTS, TEXT, columns_of

pytestmark = pytest.mark.usefixtures("fakes")


@pytest.fixture
def out(tmp_path: Path) -> Path:
    return tmp_path / "out"


def study(**changes: Any) -> dict[str, Any]:
    return faked([4, 13, -2, 0, 17, 9], **changes)


WRONG = "internal error: TypeError: no such operand"
MANY = {"scene.belt_speed": {"start": 0.5, "stop": 40, "num": 400}, "scene.drive.frequency": [1, 1.5]}


def test_the_table_has_the_inputs_first_and_every_result_column_in_the_order_of_the_contract() -> None:
    table = fl.run(study()).table

    scene = "damping_ratio", "normal_load", "belt_speed", "drive.unbalance", "drive.phase", "drive.frequency"
    given = ["law", "kind", "method", *(f"scene.{name}" for name in scene), "law.mu"]
    usual = [name for name in RESULTS if name in table]
    assert list(table.columns) == [*given, *usual]
    assert {*ALWAYS} < {*usual} < {*DEFAULT}
    assert all(table[name].notna().any() for name in usual if name != "reason")
    assert list(fl.run(study(), columns="all").table) == [*given, *columns_of("all")]


def test_rows_are_in_the_order_of_the_cases() -> None:
    two = [COULOMB, {"kind": "coulomb", "mu": 0.2, "label": "weak"}]
    done = fl.run(study(laws=two, methods=["fake", "another"]))

    rows = done.table[["law", "method", "scene.belt_speed", "law.mu"]].itertuples(index=False, name=None)
    assert list(rows) == [
        (case.law_label, case.method_label, case.scene.belt_speed, case.law.numbers()["mu"])
        for case in done.study.cases()
    ]
    assert done.table["scene.belt_speed"].tolist()[:6] == [4, 13, -2, 0, 17, 9]


@pytest.mark.parametrize("place", range(3))
def test_inputs_are_those_of_the_cases_wherever_the_belt_speed_runs(place: int) -> None:
    others = [("scene.damping_ratio", [0.1, 0.2]), ("scene.drive.frequency", [1, 1.5, 3])]
    others.insert(place, ("scene.belt_speed", [4, 13, -2, 0]))
    sweep = {"laws.coulomb.mu": [0.1, 0.2], **dict(others)}
    plan = parse_study(study(methods=["fake", "another"], sweep=sweep))
    told = pd.DataFrame(inputs(list(plan.curves())).columns)

    assert len(told) == len(plan.cases()) == 2 * 2 * 24
    for row, case in zip(records(told), plan.cases(), strict=True):
        assert row["method"] == case.method_label
        assert row["law.mu"] == case.given_law.numbers()["mu"]
        scene = {name.removeprefix("scene."): row[name] for name in row if "scene." in name}
        assert scene == case.scene.values()


def test_every_point_is_answered_where_one_is_refused_and_one_has_no_number() -> None:
    done = fl.run(study())

    assert done.table["status"].tolist() == ["ok", "refused", "ok", "ok", "failed", "ok"]
    assert done.table["reason"].tolist()[1] == "thirteen, of all numbers"
    assert "no finite mean_friction" in done.table["reason"].tolist()[4]
    assert done.counts == {"ok": 4, "refused": 1, "failed": 1}
    assert done.table["mean_friction"].tolist()[0] == pytest.approx(0.4 * math.tanh(4) / 3, abs=1e-15)


def test_a_breakdown_of_arithmetic_costs_its_own_point_alone(trouble: Trouble) -> None:
    trouble({4.0: breaks_down})
    table = fl.run(study()).table

    assert table["status"].tolist() == ["failed", "refused", "ok", "ok", "failed", "ok"]
    assert table["reason"].tolist()[0] == "ZeroDivisionError: float division by zero"


def test_an_error_of_the_program_is_called_one_and_stays_in_its_chunk(trouble: Trouble) -> None:
    trouble({4.0: is_wrong, 5.0: is_wrong})
    table = fl.run(study(sweep={"scene.belt_speed": [4, 9], "scene.damping_ratio": [0.1, 0.2]})).table
    assert table["status"].tolist() == ["failed"] * 4
    assert set(table["reason"]) == {WRONG}
    state = fl.steady_state(SCENE, LAW, method="fake")
    assert (state.status, state.reason) == ("failed", WRONG)

    mixed = fl.run(study(methods=["fake", "auto"], sweep={"scene.belt_speed": [4]})).table
    assert mixed["status"].tolist() == ["failed", "ok"]


def test_a_broken_plugin_stops_the_run(trouble: Trouble, out: Path) -> None:
    trouble({4.0: is_broken})
    with pytest.raises(registry.BrokenPlugin, match="does not compile"):
        fl.run(study(), out=out)


def test_a_method_that_answers_too_few_points_is_found_out(monkeypatch: pytest.MonkeyPatch) -> None:
    whole = Fake.solve
    monkeypatch.setattr(Fake, "solve", lambda self, scenes, *rest: whole(self, scenes[1:], *rest))

    table = fl.run(study()).table

    assert set(table["status"]) == {"failed", "refused"}
    assert "gave [4] answers for 5 points" in table["reason"].tolist()[0]


def test_mean_friction_belt_speed_and_load_are_told_against_their_natural_scales() -> None:
    table = fl.run(study(), columns=["ratios"]).table

    assert table["normalized_friction"].tolist()[2] == pytest.approx(math.tanh(2) / 3, rel=1e-14)
    assert np.isnan(table["normalized_friction"].tolist()[3])
    # at resonance V_lin = alpha / (2 beta) = 50, and the force amplitude is alpha Omega^2 = 10
    assert table["velocity_ratio"].tolist()[0] == pytest.approx(4 / 50, rel=1e-14)
    assert set(table["friction_to_drive"]) == {0.4}
    assert table["presliding_ratio"].isna().all()


ACROSS = {"natural_frequency": 2, "damping_ratio": 0.1, "load": {"amplitude": 8}}


@pytest.mark.parametrize(
    ("scene", "of_drive", "of_speed"),
    [
        (GIVEN | {"drive": {"amplitude": 0, "frequency": 1}, "transverse": ACROSS}, 0.5, math.nan),
        ({"belt_speed": 5, "slip": {"velocity_amplitude": 8, "frequency": 1}}, math.nan, 0.5),
    ],
)
def test_friction_is_told_against_the_load_there_is(scene: Any, of_drive: float, of_speed: float) -> None:
    first = fl.run(study(scene=scene), columns=["ratios"]).table.iloc[0]

    told = first[["friction_to_drive", "velocity_ratio"]].tolist()
    assert told == pytest.approx([of_drive, of_speed], nan_ok=True)


def test_chunks_hold_neighbours_of_one_curve_in_rising_belt_speed() -> None:
    curves = list(parse_study(study(sweep=MANY)).curves())
    (block,) = blocks_of_table(curves, Task(1e-8))

    assert sorted(row for piece in block.pieces for row in piece.rows) == list(range(800))
    assert all(64 <= len(piece) <= 250 for piece in block.pieces)
    assert [len(curve.rows) for curve in curves] == [400, 400]
    for piece in block.pieces:
        (chunk,) = piece.chunks()
        assert len({scene.frequency for scene in chunk.scenes}) == 1
        speeds = [scene.belt_speed for scene in chunk.scenes]
        assert speeds == sorted(speeds)


def test_short_curves_of_a_long_study_are_solved_and_kept_together() -> None:
    sweep = {"scene.normal_load": {"start": 1, "stop": 9, "num": 3000}, "scene.belt_speed": [*range(1, 8)]}
    blocks = blocks_of_table(list(parse_study(study(sweep=sweep)).curves()), Task(1e-8))
    rows = [np.concatenate([piece.rows for piece in block.pieces]) for block in blocks]

    assert sorted(np.concatenate(rows).tolist()) == list(range(21000))
    for block, own in zip(blocks, rows, strict=True):
        assert own.max() - own.min() == len(own) - 1
        assert all(len(piece) <= 500 for piece in block.pieces)
        assert all(len(piece) > 490 for piece in block.pieces[:-1])


@pytest.mark.parametrize("points", [2, 64, 187, 188, 250, 251, 312, 313, 1000, 3999])
def test_no_chunk_is_longer_than_250_points_nor_shorter_than_64_but_for_want_of_points(points: int) -> None:
    speeds = {"scene.belt_speed": {"start": 1, "stop": 40, "num": points}}
    curves = list(parse_study(study(sweep=speeds)).curves())
    sizes = [len(cut.rows) for cut in cuts(curves, is_long(curves))]

    assert sum(sizes) == points
    assert max(sizes) <= 250
    assert min(sizes) >= min(points, 64)


def test_rows_do_not_depend_on_the_number_of_workers() -> None:
    def run_with(workers: int) -> pd.DataFrame:
        with ThreadPoolExecutor(workers) as pool:
            return fl.run(study(methods=["exact", "fake"], sweep=MANY), executor=pool).table

    one = run_with(1)
    assert_frame_equal(one, run_with(7), check_exact=True)


def test_chunks_and_answers_can_cross_to_another_process() -> None:
    curves = list(parse_study(study(keep={"orbit": 4})).curves())
    (chunk,) = blocks_of_table(curves, Task(1e-8, 4))[0].pieces[0].chunks()
    answers = pickle.loads(pickle.dumps(packed_answers([solve(pickle.loads(pickle.dumps(chunk)))])))

    assert len(answers) == 6
    assert kept_of(answers, "orbits").groupby("row").size().tolist() == [4] * 4


def test_nothing_is_written_without_an_output_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    fl.run(study(keep={"orbit": 4}))
    assert list(tmp_path.iterdir()) == []


def test_the_folder_of_a_run_holds_the_table_twice_its_study_and_its_account(tmp_path: Path) -> None:
    out = tmp_path / "deep" / "out"
    done = fl.run(study(title="Oh: a title, #1"), out=out)

    files = {"curves.csv", "provenance.json", "results.csv", "results.parquet", "study.yaml"}
    assert {path.name for path in out.iterdir()} == files
    assert_frame_equal(pd.read_parquet(out / "results.parquet"), done.table, check_exact=True)
    assert load_study(out / "study.yaml") == done.study
    account = json.loads((out / "provenance.json").read_text())
    told = {"digest": done.study.digest(), "counts": done.counts, "frictionlab": fl.__version__}
    assert {name: account[name] for name in told} == told
    assert [run["computed"] for run in account["runs"]] == [6]
    assert {"numpy", "numba"} <= set(account["packages"])
    assert account["processor"]


def test_the_folder_holds_one_row_per_curve_with_its_shape(out: Path) -> None:
    expect = [{"where": {"scene.drive.frequency": 1.5}, "shape": "convex", "measure": "initial"}]
    plan = study(methods=["exact"], sweep=MANY, expect=expect)
    done, written = fl.run(plan, out=out), out / "curves.csv"
    read = pd.read_csv(written, dtype={"shape_area": str})

    assert read["scene.drive.frequency"].tolist() == [1.0, 1.5]
    assert read["shape"].fillna("").tolist() == ["", "convex"]
    assert read["reason"][0] == "the curve ends at belt speed 40, below the end of reversal, 50"
    assert float(read["shape_area"].tolist()[1]) == done.curves["shape_area"].tolist()[1]
    assert [verdict.passed for verdict in done.verdicts] == [True]

    text = written.read_bytes()
    written.unlink()
    assert fl.run(plan, out=out).computed == 0
    assert written.read_bytes() == text
    fl.run(study(sweep={"scene.damping_ratio": [0.1, 0.2]}), out, (), "replace")
    assert not written.exists()


def test_floats_come_back_from_the_csv_file_bit_for_bit(out: Path) -> None:
    def value(name: str, cell: str) -> str | float | None:
        return (cell if name in {"law", "kind", "method", *TEXT} else float(cell)) if cell else None

    done = fl.run(study(sweep=MANY), out=out)
    with (out / "results.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))

    for row, record in zip(rows, records(done.table), strict=True):
        assert {name: value(name, cell) for name, cell in row.items()} == record
    assert rows[0]["mean_friction"] == repr(done.table["mean_friction"].tolist()[0])


def test_finished_points_are_taken_over(out: Path, trouble: Trouble) -> None:
    first = fl.run(study(), out=out)
    trouble(dict.fromkeys([4.0, -2.0, 0.0, 9.0], is_wrong))
    again = fl.run(study(title="Only the title is new"), out=out)

    assert (first.computed, again.computed) == (6, 0)
    assert_frame_equal(again.table, first.table, check_exact=True)
    assert "Only the title" in (out / "study.yaml").read_text()


@deep("seconds of runs")
def test_no_method_is_loaded_where_every_point_is_finished(out: Path, monkeypatch: Any) -> None:
    answered = study(sweep={"scene.belt_speed": [1, 2]})
    fl.run(answered, out=out)
    fresh = parse_study(answered)
    monkeypatch.setattr(registry, "method_class", lambda name: pytest.fail(f"{name} was loaded"))

    assert fl.run(fresh, out=out).computed == 0


@deep("seconds of runs")
def test_a_run_that_dies_loses_nothing_that_came_back(out: Path) -> None:
    slow, came = study(methods=[{"kind": "fake", "pause": 0.12}], sweep=MANY), [0]

    def die(done: int, total: int, *_how: Any) -> None:
        assert total == 800
        came[0] = done
        if done:
            raise MemoryError

    with ThreadPoolExecutor(1) as pool, pytest.raises(MemoryError):
        fl.run(slow, out=out, executor=pool, progress=die)
    again = fl.run(slow, out=out)
    assert again.computed == 800 - came[0]
    assert_frame_equal(again.table, fl.run(slow).table, check_exact=True)


def test_an_interrupted_run_keeps_what_is_done_and_says_what_is_not(out: Path, trouble: Trouble) -> None:
    def stop(done: int, *_how: Any) -> None:
        if done:
            stopped.set()
            raise KeyboardInterrupt

    stopped = threading.Event()
    trouble({40.0: lambda: stopped.wait(60.0)})
    slow = study(methods=[{"kind": "fake", "pause": 0.05}], sweep=MANY)
    with ThreadPoolExecutor(1) as pool, pytest.raises(study_run.Interrupted) as caught:
        fl.run(slow, out=out, executor=pool, progress=stop)

    table = caught.value.run.table
    killed = table[table["status"] == "killed"]
    assert 0 < len(killed) < len(table)
    assert set(killed["reason"]) == {"interrupted"}
    assert killed["mean_friction"].isna().all()
    assert_frame_equal(pd.read_parquet(out / "results.parquet"), table, check_exact=True)
    assert fl.run(slow, out=out).computed == len(killed)


@deep("seconds of runs")
def test_another_study_is_refused_a_folder_that_is_taken(out: Path) -> None:
    fl.run(study(), out=out)
    before, other = {path: path.read_bytes() for path in out.iterdir()}, study(tolerance=1e-6)

    told = r"another study(.|\n)*tolerance: 1.0e-08(.|\n)*1.0e-06(.|\n)*--force"
    with pytest.raises(FolderError, match=told):
        fl.run(other, out=out)

    assert {path: path.read_bytes() for path in out.iterdir()} == before
    assert fl.run(other, out=out, existing="replace").computed == 6
    assert fl.run(other, out=out).computed == 0


def test_studies_that_differ_in_long_lines_are_told_apart_in_short_ones(out: Path) -> None:
    values = list(parse_study(study(sweep=MANY)).sweep["scene.belt_speed"])
    fl.run(study(sweep={"scene.belt_speed": values}), out=out)

    with pytest.raises(FolderError) as caught:
        fl.run(study(), out=out)
    shown = str(caught.value).splitlines()[1:-1]
    assert any("0.5989974937343359" in line for line in shown)
    assert max(map(len, shown)) < 90


def test_another_version_is_refused_a_folder_that_is_taken(out: Path, monkeypatch: Any) -> None:
    fl.run(study(), out=out)
    monkeypatch.setattr(folder, "__version__", "99.0")

    with pytest.raises(FolderError, match=f"frictionlab {fl.__version__}, this is 99.0; .*--force"):
        fl.run(study(), out=out)


@deep("seconds of runs")
def test_replacing_results_takes_away_those_of_the_other_study_and_nothing_else(out: Path) -> None:
    fl.run(study(keep={"orbit": 4}), out=out)
    (out / "figures").mkdir()
    for name in ("figures/old.svg", "mine.txt"):
        (out / name).write_text("mine")

    fl.run(study(tolerance=1e-6), out=out, existing="replace")

    there = [(out / name).exists() for name in ("orbits.parquet", "figures/old.svg", "mine.txt")]
    assert there == [False, False, True]


def test_a_folder_that_cannot_be_made_is_refused_before_computing(out: Path, trouble: Trouble) -> None:
    trouble({4.0: is_broken})
    out.write_text("")
    for place in (out, out / "deep" / "out"):
        with pytest.raises(FolderError, match="out is a file, not a folder"):
            fl.run(study(), out=place)


def test_a_folder_without_permission_is_refused(out: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(os, "access", lambda *_: False)
    with pytest.raises(FolderError, match="no permission"):
        fl.run(study(), out=out)
    assert list(out.parent.iterdir()) == []


def fill_disk_for(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    def replace(source: Path, target: Path, whole: Any = os.replace) -> None:
        if target.name == name:
            raise OSError(errno.ENOSPC, "No space left on device")
        whole(source, target)

    monkeypatch.setattr(files.os, "replace", replace)


@some(1, "a run each")
@pytest.mark.parametrize("name", ["results.parquet", "results.csv", "orbits.parquet"])
def test_a_full_disk_leaves_the_table_in_hand(out: Path, monkeypatch: Any, name: str) -> None:
    fill_disk_for(name, monkeypatch)
    with pytest.raises(study_run.UnsavedError, match=rf"cannot write .*{name}: No space left") as caught:
        fl.run(study(keep={"orbit": 4}), out=out)

    assert caught.value.run.counts["ok"] == 4
    assert not list(out.glob(".*"))


def test_a_disk_full_at_the_start_stops_the_run(out: Path, monkeypatch: Any, trouble: Trouble) -> None:
    trouble({4.0: is_broken})  # nothing is computed
    fill_disk_for("provenance.json", monkeypatch)
    with pytest.raises(SaveError, match="No space left"):
        fl.run(study(), out=out)


@deep("seconds of runs")
def test_orbits_are_kept_row_by_row_and_made_again_from_the_store(out: Path) -> None:
    fl.run(study(), out=out)
    kept, file = study(keep={"orbit": 4}), out / "orbits.parquet"
    whole = fl.run(kept, out=out)
    assert whole.computed == 6
    assert whole.orbits.columns.tolist()[:4] == ["row", "tau", "x1", "v1"]
    assert whole.orbits.groupby("row").size().to_dict() == {0: 4, 2: 4, 4: 4, 5: 4}
    assert whole.orbits["v1"][whole.orbits["row"] == 5].tolist() == pytest.approx([9.0] * 4)

    file.unlink()
    again = fl.run(kept, out=out)

    assert again.computed == 0
    for orbits in (again.orbits, pd.read_parquet(file)):
        assert_frame_equal(orbits, whole.orbits)
    assert fl.run(study(keep={"orbit": 8}), out=out).computed == 6


def test_what_a_study_expects_is_judged_and_every_verdict_is_in_the_account(out: Path) -> None:
    mean = {"column": "mean_friction", "where": {"scene.belt_speed": 4}}
    done = fl.run(study(expect=[mean | {"below": 0.2}, mean | {"above": 0.2}]), out=out)

    assert [verdict.passed for verdict in done.verdicts] == [True, False]
    assert json.loads((out / "provenance.json").read_text())["expect"] == list(map(asdict, done.verdicts))


def test_a_curve_comes_back_in_the_order_it_was_asked_for() -> None:
    table = fl.curve(SCENE, LAW, belt_speed=np.array([9.0, 4.0, 9.0]), method="fake", tolerance=1e-6)

    assert table["scene.belt_speed"].tolist() == [9.0, 4.0, 9.0]
    assert table["kind"].tolist() == ["coulomb"] * 3
    assert table["error"].tolist() == [1e-6] * 3
    assert table["mean_friction"][0] == table["mean_friction"][2]


def test_a_steady_state_is_the_row_of_the_same_scene() -> None:
    assert {field.name for field in fields(fl.SteadyState)} - {"motion", "si"} == set(RESULTS)
    state = fl.steady_state(SCENE, LAW)
    (row,) = records(fl.curve(SCENE, LAW, belt_speed=[5.0], columns="all"))

    for name in {*columns_of("all")} - {"seconds"}:
        value = getattr(state, name)
        assert row[name] == (None if value == "" or value != value else value), name
    assert state.normalized_friction == state.mean_friction / 0.4


def test_the_orbit_of_a_steady_state_is_one_period_along_the_belt() -> None:
    orbit = fl.steady_state(SCENE, LAW).orbit(64)

    assert orbit.tau[0] == 0.0
    assert orbit.tau[1] == pytest.approx(2 * math.pi / 64)
    assert not orbit.x2.any()
    assert np.allclose(orbit.load, 10 * np.sin(orbit.tau))
    assert np.abs(orbit.friction).max() == pytest.approx(0.4)


def test_a_refused_steady_state_is_an_answer_without_an_orbit() -> None:
    state = fl.steady_state(SCENE.with_(belt_speed=13.0), LAW, method=Fake())

    assert (state.status, state.reason) == ("refused", "thirteen, of all numbers")
    assert math.isnan(state.mean_friction)
    with pytest.raises(ValueError, match="'refused': thirteen, of all numbers"):
        state.orbit(8)


def test_of_many_curves_the_first_have_a_line_each() -> None:
    many = {"scene.belt_speed": [4, 13], "scene.drive.frequency": [float(place) for place in range(1, 26)]}
    lines = summary(fl.run(study(methods=["fake"], sweep=many))).splitlines()

    assert sum(line.startswith("coulomb  ") for line in lines) == 20
    assert "... and 5 more curves" in lines


def test_models_that_differ_in_numbers_alone_are_one_line_of_the_summary() -> None:
    done = fl.run(study(methods=["fake"]))
    models = [f"closed form: belt speed >= {speed}" for speed in range(len(done.table))]
    done.table["model"] = [*models[:-1], "another"]
    lines = summary(done).splitlines()

    assert [line for line in lines if line.startswith("model")] == [
        f"model 1: closed form: belt speed >= 0 ... {len(models) - 2}",
        "model 2: another",
    ]
    assert lines.count("words of models in full: frictionlab columns") == 1
    assert any(line.endswith(" 1, 2") for line in lines)


def test_curves_whose_motions_start_somewhere_are_measured() -> None:
    shaken = fl.BeltVibration(velocity_amplitude=10, frequency=1)
    scene = fl.Scene(
        damping_ratio=0.1, normal_load=10, belt_speed=5, belt_vibration=shaken, initial=fl.Initial(x=0.0)
    )

    assert len(fl.compare(scene, fl.Coulomb(mu=0.4), belt_speed=[5, 8]).curves) == 1


class Falling(fl.SlidingLaw):
    """Friction that falls with the logarithm of speed, without end."""

    mu: fl.Positive

    def sliding_friction(self, speed: float) -> float:
        """Return the coefficient at slip speed s >= 0."""
        return self.mu - 0.2 * math.log(1.0 + speed)


def test_a_coefficient_below_zero_is_refused_with_its_speed_and_seen_by_the_battery() -> None:
    scene = fl.Scene(belt_speed=0.5, slip=fl.Slip(velocity_amplitude=1, frequency=1))

    table = fl.curve(scene, Falling(mu=0.3), belt_speed=[0.5, 9.0])

    assert list(table["status"]) == ["ok", "refused"]
    assert table["reason"][1] == (
        "sliding_friction of the law is -0.18 at slip speed 10: a coefficient of friction is at least 0"
    )
    outcome = check_law(Falling, on_failure="return", only=["answers"]).outcome("answers")
    assert outcome.counterexample.startswith("sliding_friction must be at least 0")
