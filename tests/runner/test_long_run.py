"""A table too long to be held is the table of a short run, written piece by piece, and shown thinned."""

from __future__ import annotations

import json
import re
import shutil
from collections import Counter
from functools import partial
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from fig_4b import COULOMB, GIVEN, over_speeds
from pandas.testing import assert_frame_equal
from profiles import deep
from run_folders import interrupted_after_one_piece

import frictionlab as fl
from frictionlab import cli
from frictionlab.runner import gathering as thinned
from frictionlab.runner import pieces, saved, study_run
from frictionlab.runner.saved import read_run as read_saved
from frictionlab.study.load import parse_study
from frictionlab.study.written import yaml_text

pytestmark = deep("seconds of runs")

SPEEDS = {"start": 0.5, "stop": 60, "num": 40}


def study(**changes: Any) -> dict[str, Any]:
    laws = [COULOMB, {"kind": "coulomb", "mu": 0.3, "mu_static": 0.5, "label": "static"}]
    sweep = {"scene.damping_ratio": [0.1, 0.2], "scene.belt_speed": SPEEDS, "scene.drive.frequency": [1, 1.5]}
    small = {"where": {"law": "coulomb"}, "column": "error", "below": 1e-8}
    given = {"laws": laws, "sweep": sweep, "keep": {"orbit": 3}, "expect": [small]}
    return over_speeds(SPEEDS, **given | changes)


@pytest.fixture
def short_pieces(monkeypatch: pytest.MonkeyPatch) -> None:
    """Runs of more than 100 rows are long, and written 60 rows at a time."""
    for place in (study_run, saved):
        monkeypatch.setattr(place, "LONG_TABLE", 100)
    monkeypatch.setattr(pieces, "ROWS_OF_A_BLOCK", 50)


AXES = "scene.damping_ratio", "scene.belt_speed", "scene.drive.frequency"
ORDERS = [AXES, AXES[1:] + AXES[:1], AXES[2:] + AXES[:2]]
ACROSS = GIVEN | {"transverse": {"natural_frequency": 0.5, "damping_ratio": 0.1}}
WAYS: list[dict[str, Any]] = [{"sweep": {name: study()["sweep"][name] for name in order}} for order in ORDERS]
WAYS += [{"keep": {"harmonics": 2}, "scene": ACROSS, "methods": ["exact", "mdsm"]}]


def _timeless(table: pd.DataFrame) -> pd.DataFrame:
    return table.drop(columns="seconds", errors="ignore")


@pytest.mark.parametrize("changes", WAYS)
def test_its_files_are_those_of_a_short_run(changes: dict[str, Any], tmp_path: Path, request: Any) -> None:
    plan, kept = study(**changes), "harmonics" if "keep" in changes else "orbits"
    short = fl.run(plan, out=tmp_path / "short" / "run")
    request.getfixturevalue("short_pieces")
    long = fl.run(plan, out=tmp_path / "long" / "run", as_csv=True)

    assert long.shown is not None
    assert len(getattr(short, kept)) > 0
    for name in ("table", "curves", kept):
        tables = (_timeless(getattr(run, name)) for run in (long, short))
        assert_frame_equal(*tables, check_exact=True, check_dtype=name != "harmonics")
    assert long.verdicts == short.verdicts
    assert long.counts == short.counts
    for name in ("results.csv", "curves.csv"):
        tables = (_timeless(pd.read_csv(tmp_path / way / "run" / name)) for way in ("long", "short"))
        assert_frame_equal(*tables, check_exact=True)
    again = fl.run(plan, out=tmp_path / "long" / "run")
    assert again.computed == 0
    assert_frame_equal(getattr(again, kept), getattr(long, kept))


def test_text_is_written_where_it_is_asked_for(short_pieces: None, tmp_path: Path) -> None:
    there = []
    for ways in ({}, {"as_csv": True}, {}, {"columns": ["floquet"]}):
        fl.run(study(), out=tmp_path / "run", **ways)
        there.append((tmp_path / "run" / "results.csv").exists())

    assert there == [False, True, True, False]  # it stays while it is of the same table


def test_the_same_study_again_finds_its_chunks(short_pieces: None, tmp_path: Path) -> None:
    first = fl.run(study(), out=tmp_path / "run")
    again = fl.run(study(), out=tmp_path / "run")

    assert (first.computed, again.computed) == (320, 0)
    assert_frame_equal(again.table, first.table, check_exact=True)
    account = json.loads((tmp_path / "run" / "provenance.json").read_text())
    assert [(run["computed"], run["found"]) for run in account["runs"]] == [(320, 0)]  # the table was whole
    assert account["counts"] == first.counts
    assert again.verdicts == first.verdicts
    assert_frame_equal(again.curves, first.curves, check_dtype=False)
    other = fl.run(study(title="a copy"), out=tmp_path / "other")
    assert other.computed == 0
    assert_frame_equal(other.table, first.table, check_exact=True)


def test_a_whole_table_needs_no_chunks_a_damaged_one_is_made_again(
    short_pieces: None, tmp_path: Path
) -> None:
    run = partial(fl.run, study(laws=[COULOMB]), out=tmp_path / "run")
    first = run()
    shutil.rmtree(tmp_path / ".cache")
    again, fewer = run(), run(columns=["floquet"])
    table = tmp_path / "run" / "results.parquet"
    table.write_bytes(table.read_bytes()[:-9])
    mended = run(columns=["floquet"])

    assert (first.computed, again.computed, fewer.computed, mended.computed) == (160, 0, 160, 0)
    assert "reversals" not in fewer.table
    assert_frame_equal(mended.table, fewer.table, check_exact=True)


def test_a_long_run_that_is_interrupted_goes_on(short_pieces: None, tmp_path: Path) -> None:
    stopped = interrupted_after_one_piece(study(), tmp_path / "run")
    reasons = stopped.table.loc[stopped.table["status"] == "killed", "reason"]
    again = fl.run(study(), out=tmp_path / "run")

    assert stopped.counts == {"killed": 280, "ok": 40}
    assert set(reasons) == {"interrupted"}
    assert stopped.curves.empty
    assert again.computed == 320 - stopped.computed
    assert again.counts == {"ok": 160, "refused": 160}


def test_the_page_and_the_figures_show_some_and_tell_of_all(
    short_pieces: None, tmp_path: Path, monkeypatch: Any, capsys: Any
) -> None:
    monkeypatch.setattr(thinned, "MOST_POINTS", 7)
    monkeypatch.setattr(thinned, "MOST_ODD", 3)
    (tmp_path / "long.yaml").write_text(yaml_text(study(columns=["mean_friction"])))
    out = tmp_path / "runs" / "long"

    assert cli.main(["run", str(tmp_path / "long.yaml"), "-o", str(out)]) == 0
    printed = capsys.readouterr().out
    page = re.sub("<[^>]*>", "", (out / "report.html").read_text())

    assert "320 points: 160 ok, 160 refused\nof 57 points spread over them:" in printed
    assert "is read from 57 points spread over all 320 points" in page
    assert (out / "figures" / "mean_friction.svg").exists()
    again = read_saved(out)
    assert (again.size, len(again.shown), again.counts) == (320, 57, {"ok": 160, "refused": 160})
    assert cli.main(["report", str(out)]) == 0


def test_shown_rows_hold_the_ends_of_the_first_and_the_last_curve() -> None:
    speeds = {"scene.belt_speed": {"start": 1, "stop": 9, "num": 5000}}
    rows = thinned.shown_rows(parse_study(study(sweep=speeds)))

    assert {0, 4999, 5000, 9999} <= set(rows.tolist())
    assert len(rows) == 400
    assert (np.diff(rows) > 0).all()


def test_shown_curves_of_many_make_a_grid_of_their_own() -> None:
    sweep = {
        "laws.static.mu_static": [0.5, 0.6, 0.7],
        "scene.drive.frequency": {"start": 1, "stop": 2, "num": 41},
        "scene.belt_speed": {"start": 1, "stop": 9, "num": 5},
        "scene.normal_load": {"start": 1, "stop": 5, "num": 33},
    }
    plan = parse_study(study(sweep=sweep, methods=["exact", "shooting"]))
    cases, shown = plan.cases(), thinned.shown_rows(plan).tolist()
    told = Counter(
        (
            getattr(case.given_law, "mu_static", None),
            case.method_label,
            case.scene.frequency,
            case.scene.normal_load,
        )
        for case in (cases[row] for row in shown)
    )

    beside = {"exact", "shooting"}, {1.0, 1.5, 2.0}, {1.0, 3.0, 5.0}
    assert told == dict.fromkeys(product({None, 0.5, 0.6, 0.7}, *beside), 5)


def test_a_long_run_keeps_the_memory_of_laws_that_come_later(tmp_path: Path, short_pieces: None) -> None:
    laws = [COULOMB, {"kind": "dahl", "mu": 0.4, "stiffness": 4}]
    wanted = study(laws=laws, methods=["shooting"], expect=[])
    long, short = fl.run(wanted, tmp_path / "long"), fl.run(wanted)
    assert long.shown is not None
    assert list(long.orbits) == list(short.orbits)
    assert long.orbits.memory_0.notna().sum() == len(long.orbits) // 2
