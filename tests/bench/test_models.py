"""Models on one chart: what is read from a list, what is measured against what, and the front."""

from __future__ import annotations

import csv
import math
from pathlib import Path
from typing import Any

import pytest

from frictionlab import bench, cli
from frictionlab.bench.curve import BenchedModel, ModelRow, ModelsResult, front
from frictionlab.bench.record import NO_TIME, BenchSetting, Contender, Row, Times
from frictionlab.values.notes import StudyError

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


def measured(tmp_path: Path, text: str = LIST) -> ModelsResult:
    (tmp_path / "list.yaml").write_text(text)
    (section,) = bench.load_bench(tmp_path / "list.yaml").sections
    found: Any = section.measure(lambda line: None)
    return found


@pytest.fixture(scope="module")
def soft(tmp_path_factory: pytest.TempPathFactory) -> ModelsResult:
    return measured(tmp_path_factory.mktemp("list"))


def test_every_method_on_every_law_and_scene(soft: ModelsResult) -> None:
    labels = [each.model.label for each in soft.rows]
    assert labels == [
        label
        for label in ("coulomb", "less", "coulomb, without transverse", "less, without transverse")
        for _ in range(3)
    ]
    assert [each.label for each in soft.rows[:3]] == [
        "exact",
        "shooting, tolerance 0.001",
        "shooting, tolerance 1e-06",
    ]
    assert all(each.answered for each in soft.rows)


def test_distances_are_those_from_the_richest_model(soft: ModelsResult) -> None:
    off = {
        (each.model.law, each.model.scene): each.row.largest for each in soft.rows if each.label == "exact"
    }
    assert off["coulomb", ""] < 1e-12
    # without a load across the belt the transverse motion does not matter (theorem T2), the coefficient does
    assert off["coulomb", "without transverse"] < 1e-12
    assert off["less", ""] == pytest.approx(off["less", "without transverse"], abs=1e-12)
    assert off["less", ""] > 1e-3


def row(seconds: float, error: float, ok: int = 2) -> ModelRow:
    contender = Contender(f"{seconds:g}", "exact", (), None)
    counts = {"ok": ok, "refused": 2 - ok, "failed": 0, "not_unique": 0}
    times = Times(seconds, (seconds,) * 3, 1)
    told = Row(
        contender, BenchSetting("", 0.0, 1e-8), 2, counts, "", error, error, error, None, times, NO_TIME, None
    )
    return ModelRow(BenchedModel("law", "", None), told)  # type: ignore[arg-type]


def test_the_front_is_what_nothing_cheaper_is_as_near_as() -> None:
    rows = [
        row(3.0, 1e-6),
        row(1.0, 1e-2),
        row(2.0, 1e-2),
        row(4.0, 1e-5),
        row(5.0, 0.95e-6),
        row(0.5, 1e-9, ok=1),
    ]
    assert [each.row.mean.least for each in front(rows)] == [1.0, 3.0]
    assert front([row(1.0, math.nan)]) == []


def test_the_command_writes_table_chart_and_front(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "list.yaml").write_text(LIST)
    assert cli.main(["bench", str(tmp_path / "list.yaml"), "-o", str(tmp_path / "out")]) == 0
    assert capsys.readouterr().out.startswith("models_soft: errors against coulomb (exact at 1e-12)\n")
    with (tmp_path / "out" / "models_soft.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 12
    assert {each["scene"] for each in rows} == {"whole", "without transverse"}
    assert "yes" in {each["front"] for each in rows}
    assert (tmp_path / "out" / "models_soft.svg").exists()


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ("without: [transverse]", "without: [belt_vibration]", "the scene has no 'belt_vibration'"),
        ("without: [transverse]", "without: [damping_ratio]", "scene.damping_ratio: required key"),
        (
            "{scene.belt_speed: [5, 20]}",
            "{scene.belt_speed: [5], scene.normal_load: [5, 20]}",
            "sweeps the belt speed alone",
        ),
        (
            "references: [{kind: exact, tolerance: 1.0e-12}]",
            "title: x",
            "references: required key is missing",
        ),
        ("name: soft", "name: [soft]", "name: "),
        (
            "methods: [exact, {kind: shooting, tolerance: [1.0e-3, 1.0e-6]}]",
            "title: x",
            "there is nothing to measure",
        ),
        ("repeats: 1", "repeats: 0", "must be >= 1"),
    ],
)
def test_mistakes_have_their_line(tmp_path: Path, old: str, new: str, told: str) -> None:
    assert old in LIST
    with pytest.raises(StudyError, match=told):
        measured(tmp_path, LIST.replace(old, new))
