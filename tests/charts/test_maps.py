"""Two swept numbers are a map: its shades, its lines of equal value, what has no number."""

from __future__ import annotations

import itertools

import numpy as np
import pandas as pd
import pytest
from drawn_figures import NOTHING, drawn, legend_of, titles_of
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.contour import QuadContourSet
from matplotlib.figure import Figure
from profiles import deep

import frictionlab as fl
from frictionlab.charts.derived import v_lin_of
from frictionlab.charts.figures import FigureData, figures_of
from frictionlab.charts.maps import map_of
from frictionlab.values.columns import SHOWN_IN_PART

FREQUENCIES, LOADS = np.linspace(0.5, 2.0, 7), np.geomspace(1.0, 100.0, 5)


def grid(law: str = "coulomb", method: str = "auto", **more: object) -> pd.DataFrame:
    points = list(itertools.product(FREQUENCIES, LOADS))
    values = [0.1 * frequency + 0.05 * np.log10(load) for frequency, load in points]
    found = {"mean_friction": values, "error": 1e-9, "status": "ok", "normalized_friction": values}
    inputs = {"law": law, "kind": law, "method": method, "scene.belt_speed": 5.0}
    rows = pd.DataFrame(points, columns=["scene.drive.frequency", "scene.normal_load"])
    return rows.assign(**NOTHING | inputs | found).assign(**more)


def meshes(figure: Figure) -> list[QuadMesh]:
    return [one for axes in figure.axes[:-1] for one in axes.collections if isinstance(one, QuadMesh)]


def lines_in(axes: Axes) -> list[QuadContourSet]:
    return [one for one in axes.collections if isinstance(one, QuadContourSet)]


def test_the_mean_is_a_map_of_every_point_with_lines_of_equal_value() -> None:
    figure = drawn(grid())

    mean = figure.axes[0]
    shades = meshes(figure)[0]
    means = grid()["mean_friction"].to_numpy().reshape(7, 5).T
    np.testing.assert_allclose(np.ma.getdata(shades.get_array()), means)
    (lines,) = lines_in(mean)
    assert all(0.05 < level < 0.3 for level in lines.levels)
    assert len(lines.levels) >= 3
    assert mean.get_xlabel() == r"drive frequency $\Omega$"
    assert mean.get_ylabel() == r"normal load $\gamma^2$"
    assert mean.get_yscale() == "log"


def test_shades_of_laws_mean_the_same() -> None:
    table = pd.concat([grid(), grid("dahl", mean_friction=0.6)], ignore_index=True)

    first, second, *_ = meshes(drawn(table))

    assert first.norm.vmax == second.norm.vmax == 0.6
    assert titles_of(drawn(table))[:2] == ["coulomb", "dahl"]


@deep("seconds of figures")
def test_a_method_whose_map_is_the_same_is_named_and_not_drawn_again() -> None:
    same, other = grid(method="exact"), grid(method="mdsm", mean_friction=0.2)

    assert titles_of(drawn(pd.concat([grid(), same, other], ignore_index=True)))[:2] == [
        "auto = exact",
        "mdsm",
    ]


def test_a_point_without_a_number_is_white_marked_and_counted() -> None:
    table = grid()
    table.loc[[3, 4], ["status", "mean_friction", "error"]] = ["failed", np.nan, np.nan]

    figure = drawn(table)

    assert meshes(figure)[0].get_array().mask.sum() == 2
    (marks,) = figure.axes[0].lines
    assert list(marks.get_ydata()) == pytest.approx(LOADS[[3, 4]])
    assert legend_of(figure) == ["2 points failed", "no number"]


def test_beside_belt_speed_the_measures_of_curves_are_a_map() -> None:
    heads = grid().drop(columns=["scene.belt_speed", "status", "error", "mean_friction"])
    share = np.linspace(0.0, 1.0, len(heads))
    curves = heads.assign(reduction=0.2 + 0.7 * share, shape_area=-0.2 + 0.5 * share)
    speeds = [grid().assign(**{"scene.belt_speed": speed}) for speed in range(1, 10)]
    table = pd.concat(speeds, ignore_index=True)

    figure = drawn(table, "map", curves=curves)

    assert map_of(table) is None
    assert "differences" not in figures_of(FigureData(table))
    (areas,) = lines_in(figure.axes[2])
    widths = dict(zip(areas.levels, areas.get_linewidths(), strict=True))
    assert widths[0.0] == max(widths.values()) > min(widths.values())


def along_speed(values: int, missing: int = 0) -> pd.DataFrame:
    """A curve over belt speed for each value of the drive frequency, V_lin at twice that."""
    points = [(speed, 1.0 + 0.1 * at) for at in range(values) for speed in range(1, 10)]
    rows = pd.DataFrame(points, columns=["scene.belt_speed", "scene.drive.frequency"])
    ratio = rows["scene.belt_speed"] / (2.0 * rows["scene.drive.frequency"])
    head = grid().iloc[[0] * len(rows)].reset_index(drop=True).drop(columns=list(rows))
    found = pd.concat([rows, head], axis="columns").assign(velocity_ratio=ratio, mean_friction=0.1 * ratio)
    return found.iloc[: len(found) - missing].assign(**{"scene.normal_load": 1.0})


def test_more_curves_than_lines_can_tell_apart_are_a_map_with_v_lin_in_it() -> None:
    figure = drawn(along_speed(13))

    mean = figure.axes[0]
    assert mean.get_xlabel() == "belt speed $v_b$"
    assert mean.get_ylabel() == r"drive frequency $\Omega$"
    (line,) = mean.lines
    np.testing.assert_allclose(line.get_xdata(), 2.0 * np.asarray(line.get_ydata()))
    assert legend_of(figure) == [r"belt speed $V_\mathrm{lin}$"]
    assert len(drawn(along_speed(12)).axes[0].lines) == 12
    of_error = drawn(along_speed(13).assign(error=0.05)).axes[2]  # after the bar of the mean
    assert [*of_error.get_xlim(), *of_error.get_ylim()] == pytest.approx([0.5, 9.5, 0.95, 2.25])


def test_v_lin_is_drawn_from_its_formula_between_the_points() -> None:
    scene = fl.Scene(
        damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1)
    )
    over = {
        "scene.drive.frequency": np.linspace(0.5, 2.0, 16),
        "scene.belt_speed": np.linspace(1.0, 60.0, 12),
    }
    found = fl.sweep(scene, fl.Coulomb(mu=0.4), over)

    (line,) = found.plot().axes[0].lines

    tip = int(np.argmax(line.get_xdata()))
    assert line.get_xdata()[tip] == pytest.approx(51.03, abs=0.01)
    assert line.get_ydata()[tip] == pytest.approx(1.02, abs=0.005)


def test_an_error_that_cannot_be_seen_has_no_map() -> None:
    shown = [[axes.get_ylabel() for axes in drawn(grid(error=error)).axes] for error in (1e-9, 0.01)]
    assert ["error bound of the mean" in labels for labels in shown] == [False, True]


def test_v_lin_of_no_scene_is_not_known() -> None:
    study = fl.Study.of(
        fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(amplitude=1, frequency=2)),
        fl.Coulomb(mu=0.4),
    )

    assert v_lin_of(study, {"scene.normal_load": 1.0}) == pytest.approx(2.0 / np.hypot(3.0, 0.4))
    assert np.isnan(v_lin_of(study, {"scene.normal_load": -1.0}))  # at the edge of a cell


def test_a_picture_of_one_value_is_no_map() -> None:
    curves = along_speed(13)
    pairs = curves["scene.drive.frequency"].rank(method="dense") // 2
    spread = curves.assign(**{"scene.damping_ratio": pairs})
    spread.attrs = {SHOWN_IN_PART: True}

    assert map_of(spread) is None


def test_a_grid_with_holes_is_lines() -> None:
    assert map_of(along_speed(13)) is not None
    assert map_of(along_speed(13, missing=1)) is None


@deep("seconds of figures")
def test_labels_of_lines_of_equal_value_do_not_lie_on_each_other() -> None:
    peak = np.exp(-((np.arange(35) % 5 - 2.0) ** 2) * 4.0) * 3000.0
    figure = drawn(grid(mean_friction=peak))

    axes = figure.axes[0]
    shown = [text for text in axes.texts if text.get_visible()]
    places = [axes.transLimits.transform(axes.transScale.transform(text.get_position())) for text in shown]
    assert all(float(text.get_text()) % 100 == 0 and "e" not in text.get_text() for text in shown)
    assert len(axes.texts) > len(shown) > 1
    for one, other in itertools.combinations(places, 2):
        assert not (np.abs(one - other) < (0.16, 0.09)).all()
