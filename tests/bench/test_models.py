"""Models on one chart: what is read from a list, what is measured against what, and the front."""

from __future__ import annotations

import math
from pathlib import Path

import pandas as pd
import pytest
from bench_lists import changed, measured, mistake, texts

from frictionlab import cli
from frictionlab.bench.models import front

LIST = """
schema: 1
models:
  - name: soft
    scene:
      damping_ratio: 0.1
      normal_load: 1
      drive: {unbalance: 10, frequency: 4}
      transverse: {natural_frequency: 0.5, damping_ratio: 0.1}
    laws: [{kind: coulomb, mu: 0.4}, {kind: coulomb, mu: 0.3, label: less}]
    sweep: {scene.belt_speed: [5, 20]}
    without: [transverse]
    references: [{kind: exact, tolerance: 1.0e-12}]
    methods: [exact, {kind: shooting, tolerance: [1.0e-3, 1.0e-6]}]
    repeats: 1
"""


@pytest.fixture(scope="module")
def soft(tmp_path_factory: pytest.TempPathFactory) -> pd.DataFrame:
    """The table of the list."""
    return measured(LIST, tmp_path_factory.mktemp("list"))[0].table


def test_every_method_on_every_law_and_scene(soft: pd.DataFrame) -> None:
    models = [(law, scene) for scene in ("whole", "without transverse") for law in ("coulomb", "less")]
    settings = [("exact", "nan"), ("shooting", "0.001"), ("shooting", "1e-06")]

    assert [*zip(soft["law"], soft["scene"], strict=True)] == [model for model in models for _ in settings]
    assert [*zip(soft["method"], soft["value"].map(str), strict=True)] == settings * 4
    assert (soft["ok"] == 2).all()
    assert soft["largest_error"].notna().all()


def test_distances_are_those_from_the_richest_model(soft: pd.DataFrame) -> None:
    exact = soft[soft["method"] == "exact"].set_index(["law", "scene"])
    off = exact["largest_error"]
    assert off["coulomb", "whole"] < 1e-12
    # without a load across the belt the transverse motion does not matter (theorem T2), the coefficient does
    assert off["coulomb", "without transverse"] < 1e-12
    assert off["less", "whole"] == pytest.approx(off["less", "without transverse"], abs=1e-12)
    assert off["less", "whole"] > 1e-3


def rows(*told: tuple[float, float, int]) -> pd.DataFrame:
    """Settings with a time, an error and so many answers of two."""
    return pd.DataFrame(told, columns=["mean_us", "largest_error", "ok"]).assign(points=2)


def test_the_front_is_what_nothing_cheaper_is_as_near_as() -> None:
    table = rows((3, 1e-6, 2), (1, 1e-2, 2), (2, 1e-2, 2), (4, 1e-5, 2), (5, 0.95e-6, 2), (0.5, 1e-9, 1))
    assert front(table)["mean_us"].tolist() == [1.0, 3.0]
    assert front(rows((1, math.nan, 2))).empty


def test_the_command_writes_table_chart_and_front(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "list.yaml").write_text(LIST)
    assert cli.main(["bench", str(tmp_path / "list.yaml"), "-o", str(tmp_path / "out")]) == 0
    assert capsys.readouterr().out.startswith("models_soft: errors against coulomb (exact at 1e-12)\n")
    table = texts(tmp_path / "out" / "models_soft.csv")
    assert len(table) == 12
    assert {*table["scene"]} == {"whole", "without transverse"}
    assert "yes" in set(table["front"])
    assert (tmp_path / "out" / "models_soft.svg").exists()


CUT, SWEPT, KNOWN = "without: [transverse]", "[5, 20]}", "references: [{kind: exact, tolerance: 1.0e-12}]"
METHODS = "methods: [exact, {kind: shooting, tolerance: [1.0e-3, 1.0e-6]}]"
MISTAKES = [
    (CUT, "without: [belt_vibration]", "the scene has no 'belt_vibration'"),
    (CUT, "without: [damping_ratio.x]", "the scene has no 'damping_ratio.x'"),
    (CUT, "without: [damping_ratio]", "scene.damping_ratio: required key"),
    (SWEPT, "[5], scene.normal_load: [5, 20]}", "sweeps the belt speed alone"),
    (KNOWN, "title: x", "references: required key is missing"),
    ("name: soft", "name: [soft]", "name: "),
    (METHODS, "title: x", "there is nothing to measure"),
    ("repeats: 1", "repeats: 0", "must be >= 1"),
]


@pytest.mark.parametrize(("old", "new", "told"), MISTAKES)
def test_mistakes_have_their_line(tmp_path: Path, old: str, new: str, told: str) -> None:
    assert told in str(mistake(changed(LIST, old, new), tmp_path))
