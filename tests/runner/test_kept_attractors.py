"""The attractors that a study keeps: their file, figure and place in the report, taken over by the next run."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
import pytest
from fig_4b import over_speeds
from profiles import deep

import frictionlab as fl
from frictionlab import cli
from frictionlab.charts.bifurcation import bifurcations
from frictionlab.runner import study_run
from frictionlab.study.written import yaml_text
from frictionlab.values.columns import ATTRACTORS, OF_STATES

LAW = {"kind": "stribeck", "mu_static": 0.4, "mu_kinetic": 0.2, "stribeck_speed": 1, "stribeck_exponent": 1}
LIGHT: dict[str, Any] = {"damping_ratio": 0.01, "normal_load": 10, "belt_speed": 0.4}
LIGHT |= {"drive": {"unbalance": 0.2, "frequency": 1.3}}
BOTH = ["auto", {"kind": "march", "steps": 64}]
STUDY = over_speeds([0.5, 0.4, 0.45], scene=LIGHT, laws=[LAW], methods=BOTH)
STUDY |= {"keep": {"attractors": 2}}

HELD = LIGHT | {"normal_load": 1, "drive": {"amplitude": 0.05, "frequency": 3}}
FALLS = {"kind": "stribeck", "mu_static": 0.8, "mu_kinetic": 0.2, "stribeck_speed": 0.1, "viscosity": 0.01}
SLIDING_OR_NOT = over_speeds([0.9, 0.6], scene=HELD, laws=[FALLS], methods=["auto"])


@pytest.fixture(scope="module")
def ran(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("kept")
    (folder / "study.yaml").write_text(yaml_text(STUDY))
    assert cli.main(["run", str(folder / "study.yaml"), "-o", str(folder / "out")]) in (0, 3)
    return folder


@deep("seconds of maps")
def test_every_state_is_a_row_per_point_and_only_of_methods_that_follow_motions(ran: Path) -> None:
    table = pd.read_csv(ran / "out" / "attractors.csv")

    assert tuple(table.columns[-len(ATTRACTORS) :]) == tuple(ATTRACTORS)
    assert set(table["method"]) == {"auto"}
    assert "scene.belt_speed" not in table
    assert table["scene.damping_ratio"].unique().tolist() == [0.01]
    states = table.groupby(["belt_speed", "state"])
    assert states["point"].max().tolist() == states["period"].max().tolist() == [3, 2, 3, 2, 2]


@deep("seconds of maps")
def test_figure_and_report_show_every_period_in_colour_and_in_grey(ran: Path) -> None:
    picture = plt.imread(ran / "out" / "figures" / "bifurcation.png")[..., :3]
    grey = picture @ [0.299, 0.587, 0.114]

    assert (ran / "out" / "figures" / "bifurcation.svg").stat().st_size < 250_000
    assert np.ptp(picture, axis=2).max() > 0.3
    assert (grey < 0.55).mean() > 0.005
    assert "periods of the response found: 2, 3." in (ran / "out" / "report.html").read_text()


@deep("seconds of maps")
def test_the_same_study_takes_them_over(ran: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    counts: list[int] = []

    def count(*given: Any) -> pd.DataFrame:
        counts.append(given[-1])
        return pd.DataFrame({"law": ["x"]})

    monkeypatch.setattr(study_run, "attractor_table", count)
    first = fl.run(ran / "study.yaml", ran / "out")
    assert counts == []
    assert len(first.attractors) == 12
    fl.run(ran / "study.yaml", ran / "out", ["keep.attractors=3"])
    assert counts == [3]


def test_a_point_that_has_several_states_is_a_row_each_without_asking(tmp_path: Path) -> None:
    first = fl.run(SLIDING_OR_NOT, tmp_path / "out")
    table = pd.read_csv(tmp_path / "out" / "attractors.csv")

    assert first.table["status"].tolist() == ["not_unique"] * 2
    assert tuple(table.columns[-len(OF_STATES) :]) == OF_STATES
    by_speed = table.groupby("belt_speed")
    assert by_speed["state"].apply(list).tolist() == [[1, 2]] * 2
    assert by_speed["share"].sum().tolist() == pytest.approx([1.0, 1.0])
    ends = first.table.set_index("scene.belt_speed").sort_index()[["mean_low", "mean_high"]]
    assert by_speed["mean_friction"].agg(["min", "max"]).to_numpy() == pytest.approx(ends.to_numpy())
    again = fl.run(SLIDING_OR_NOT, tmp_path / "beside").attractors  # from the kept chunks
    assert again["mean_friction"].tolist() == pytest.approx(table["mean_friction"].tolist(), abs=1e-15)


def test_each_curve_has_a_figure_of_its_own() -> None:
    rows = pd.DataFrame({"law": ["a", "b", "b"], **{name: [1.0, 2.0, 3.0] for name in ATTRACTORS}})

    assert [len(part) for part in bifurcations(rows).values()] == [1, 2]
    assert list(bifurcations(rows)) == ["1_bifurcation", "2_bifurcation"]
    assert list(bifurcations(rows[:1])) == ["bifurcation"]
    assert bifurcations(rows[:0]) == {}
