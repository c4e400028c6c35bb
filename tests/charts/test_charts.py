"""Figures of a result table: what is drawn, what tells curves apart, and that nothing is dropped."""

from __future__ import annotations

import re
from collections.abc import Iterable
from itertools import pairwise
from pathlib import Path

import matplotlib as mpl
import numpy as np
import pandas as pd
import pytest
from drawn_figures import curves_of, legend_of, names_above, names_of, titles_of
from matplotlib import style as styles
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from oracle import table_in_the_plane, table_of_one_degree_of_freedom
from profiles import deep

from frictionlab.charts import figures
from frictionlab.charts.bifurcation import bifurcation_figures
from frictionlab.charts.curve_figure import CurveFigure
from frictionlab.charts.curves import Family, family_of
from frictionlab.charts.figures import FIGURES, FigureData, draw_figures
from frictionlab.charts.looks import MOST_VALUES_IN_LEGEND
from frictionlab.charts.sheet import STYLE, Heading
from frictionlab.charts.sweeps import is_logarithmic
from frictionlab.study.figure_options import FigureOptions
from frictionlab.values.columns import RESULTS, symbol


@pytest.fixture(scope="module")
def line() -> pd.DataFrame:
    return table_of_one_degree_of_freedom()


@pytest.fixture(scope="module")
def plane() -> pd.DataFrame:
    return table_in_the_plane()


@pytest.fixture
def resonance(line: pd.DataFrame) -> pd.DataFrame:
    """One curve alone: Omega = 1."""
    return line[line["scene.drive.frequency"] == 1.0].reset_index(drop=True)


def _joined(tables: Iterable[pd.DataFrame]) -> pd.DataFrame:
    return pd.concat(tables, ignore_index=True)


def _family(table: pd.DataFrame) -> Family:
    family = family_of(table)
    assert family is not None
    return family


def _figure(table: pd.DataFrame, *columns: str) -> Figure:
    with mpl.rc_context(STYLE):
        return CurveFigure(_family(table), columns or ("mean_friction",)).draw(Heading("A title"))


def test_a_single_point_gives_no_figure_and_no_folder(line: pd.DataFrame, tmp_path: Path) -> None:
    assert draw_figures(FigureData(line.iloc[:1], "One point"), tmp_path / "figures") == []
    assert not (tmp_path / "figures").exists()


def test_a_quantity_that_applies_nowhere_gives_no_figure(resonance: pd.DataFrame, tmp_path: Path) -> None:
    resonance[FIGURES["energies"]] = np.nan

    files = draw_figures(FigureData(resonance, "No energies"), tmp_path)
    assert [file.stem for file in files] == ["mean_friction", "mean_friction", "velocity", "velocity"]
    assert [file.suffix for file in files] == [".svg", ".png"] * 2
    # other programs than browsers leave out a line with an empty list of dashes
    assert "stroke-dasharray: ;" not in files[0].read_text()


def test_every_curve_is_drawn_whole_against_belt_speed(plane: pd.DataFrame) -> None:
    drawn = curves_of(_figure(plane).axes[0])

    expected = [rows for _, rows in plane.groupby("scene.transverse.natural_frequency")]
    assert len(drawn) == len(expected) == 6
    for (x, y), rows in zip(drawn, expected, strict=True):
        np.testing.assert_array_equal(x, rows["scene.belt_speed"])
        np.testing.assert_array_equal(y, rows["mean_friction"])


def test_the_legend_names_the_swept_quantity_and_its_values(plane: pd.DataFrame) -> None:
    figure = _figure(plane)

    assert figure.legends[0].get_title().get_text() == r"transverse natural frequency $\omega_r$"
    assert legend_of(figure) == ["0.5", "1", "2", "3", "4", "10"]


def test_one_curve_needs_nolegend_of(resonance: pd.DataFrame) -> None:
    assert _figure(resonance).legends == []


def _other(table: pd.DataFrame, method: str, off: float = 0.05) -> pd.DataFrame:
    """The same curve by another method, so far off."""
    return table.assign(method=method, mean_friction=table["mean_friction"] + off)


def test_laws_differ_in_colour_and_dashes_and_methods_in_markers(resonance: pd.DataFrame) -> None:
    both = pd.concat([resonance, _other(resonance, "mdsm")])
    table = _joined([both, both.assign(law="other")])

    figure = _figure(table)
    first, second, third, fourth = figure.axes[0].lines[:4]

    assert legend_of(figure) == ["coulomb, auto", "coulomb, mdsm", "other, auto", "other, mdsm"]
    assert first.get_color() == second.get_color() != third.get_color() == fourth.get_color()
    dashes = [str(line._unscaled_dash_pattern) for line in (first, second, third, fourth)]
    assert dashes[0] == dashes[1] != dashes[2] == dashes[3]
    assert first.get_marker() == third.get_marker() != second.get_marker() == fourth.get_marker()
    assert all(line.get_markevery() for line in (first, second, third, fourth))


def test_laws_are_of_different_grey(resonance: pd.DataFrame) -> None:
    table = _joined([resonance.assign(law=law) for law in "abcd"])

    lines = _figure(table).axes[0].lines[:4]

    greys = sorted(float(np.dot(to_rgb(line.get_color()), (0.299, 0.587, 0.114))) for line in lines)
    assert min(np.diff(greys)) > 0.04
    assert len({str(line._unscaled_dash_pattern) for line in lines}) == 4


def test_of_one_law_colour_is_the_value_and_dashes_are_the_method() -> None:
    table = table_of_one_degree_of_freedom()
    figure = _figure(_joined([table, _other(table, "mdsm")]))
    lines = figure.axes[0].lines[:4]
    colors = {line.get_color() for line in lines}
    dashes = {str(line._unscaled_dash_pattern) for line in lines}
    methods, values = figure.legends[0].get_lines()[:2], figure.legends[0].get_lines()[2:]

    assert legend_of(figure) == ["auto", "mdsm", r"drive frequency $\Omega$ = 1", "1.5"]
    assert len(colors) == len(dashes) == 2
    assert {str(line._unscaled_dash_pattern) for line in methods} == dashes
    assert {line.get_color() for line in values} == colors


def test_methods_whose_curves_are_one_line_are_drawn_once(resonance: pd.DataFrame) -> None:
    far, near = _other(resonance, "mdsm"), _other(resonance, "shooting", 1e-9)
    table = _joined([resonance, near.assign(error=1e-8), far])

    figure = _figure(table)

    assert len(curves_of(figure.axes[0])) == 2
    assert set(names_of(figure)) == {"auto = shooting", "mdsm"}


@pytest.mark.parametrize(("off", "error"), [(1e-5, 1e-9), (0.05, 0.2)])
def test_methods_that_differ_by_more_than_their_errors_or_can_be_seen_to_are_both_drawn(
    resonance: pd.DataFrame, off: float, error: float
) -> None:
    wrong = _other(resonance, "march", off).assign(error=error)

    figure = _figure(_joined([resonance.assign(error=1e-9), wrong]))

    assert len(curves_of(figure.axes[0])) == 2
    assert set(names_of(figure)) == {"auto", "march"}


def _of_ten_methods(table: pd.DataFrame) -> pd.DataFrame:
    return _joined([_other(table, f"method{i}", 0.02 * i) for i in range(10)])


def test_ten_methods_are_told_apart_in_colour_and_in_black_and_white(resonance: pd.DataFrame) -> None:
    figure = _figure(_of_ten_methods(resonance))
    lines, handles = figure.axes[0].lines[:10], figure.legends[0].get_lines()

    for shown in (lines, handles):
        assert len({str(line.get_color()) for line in shown}) == 10
        assert len({line.get_marker() for line in shown}) == 10
        assert len({str(line._unscaled_dash_pattern) for line in shown}) == 10
    assert max(line.get_linewidth() for line in lines) <= 2.0


def test_the_legend_keeps_within_the_figure(resonance: pd.DataFrame) -> None:
    short = [resonance.assign(method=name) for name in ("a", "b", "c", "d")]
    long = resonance.assign(method="n" * 60)
    refused = long.assign(law="rough", status="refused", mean_friction=np.nan)
    figure = _figure(_joined([*short, long, resonance.assign(law="rough"), refused]))

    figure.canvas.draw()

    legend = figure.legends[0].get_window_extent()
    assert figure.bbox.x0 <= legend.x0 < legend.x1 <= figure.bbox.x1
    assert legend.y1 <= figure.axes[0].get_window_extent().y0


@deep("seconds of figures")
def test_labels_of_a_logarithmic_axis_do_not_overlap(resonance: pd.DataFrame) -> None:
    speeds = np.geomspace(5.0, 100.0, len(resonance))
    figure = _figure(resonance.assign(**{"scene.belt_speed": speeds}))
    figure.canvas.draw()
    below = figure.axes[0].xaxis

    low, high = figure.axes[0].get_xlim()
    ticks = [*below.get_major_ticks(), *below.get_minor_ticks()]
    labels = [tick.label1 for tick in ticks if low <= tick.get_loc() <= high and tick.label1.get_text()]
    assert [label.get_text() for label in labels] == ["5", "10", "20", "50", "100"]
    places = [label.get_window_extent() for label in labels]
    assert not any(one.overlaps(other) for one, other in pairwise(places))
    assert list(names_above(figure.axes[0]).values()) == [r"$V_\mathrm{lin}$"]


def test_a_long_family_is_drawn_whole_and_named_from_end_to_end(resonance: pd.DataFrame) -> None:
    loads = np.linspace(1, 30, 30)
    table = _joined([resonance.assign(**{"scene.normal_load": load}) for load in loads])

    figure = _figure(table)

    assert len(curves_of(figure.axes[0])) == 30
    assert len(legend_of(figure)) == MOST_VALUES_IN_LEGEND
    assert legend_of(figure)[0] == "1"
    assert legend_of(figure)[-1] == "30"


def test_two_further_swept_quantities_give_small_multiples(plane: pd.DataFrame) -> None:
    table = _joined(plane.assign(**{"scene.damping_ratio": beta}) for beta in (0.1, 0.2))

    figure = _figure(table)

    assert titles_of(figure) == [r"damping ratio $\beta_1$ = 0.1", r"$\beta_1$ = 0.2"]
    assert [len(curves_of(axes)) for axes in figure.axes] == [6, 6]


def test_without_a_sweep_of_belt_speed_the_longest_sweep_is_the_axis(resonance: pd.DataFrame) -> None:
    loads = np.logspace(-1, 2, len(resonance))
    table = resonance.assign(**{"scene.belt_speed": 5.0, "scene.normal_load": loads})

    axes = _figure(table).axes[0]

    assert axes.get_xlabel() == r"normal load $\gamma^2$"
    assert axes.get_xscale() == "log"


def test_a_sweep_of_more_values_than_a_few_belt_speeds_is_the_axis(resonance: pd.DataFrame) -> None:
    many = resonance.assign(**{"scene.normal_load": np.logspace(-1, 2, len(resonance))})

    axes = _figure(_joined(many.assign(**{"scene.belt_speed": speed}) for speed in (1.0, 2.0))).axes[0]

    assert axes.get_xlabel() == r"normal load $\gamma^2$"


def test_a_law_without_the_parameter_along_the_axis_is_a_level_line(resonance: pd.DataFrame) -> None:
    fixed = resonance.head(10).assign(**{"scene.belt_speed": 5.0})
    soft = fixed.assign(law="dahl", **{"law.stiffness": np.logspace(0, 3, 10)})
    rigid = fixed.head(1).assign(**{"law.stiffness": np.nan})

    (level, _) = curves_of(_figure(_joined([rigid, soft])).axes[0])

    assert level[1] == pytest.approx(rigid["mean_friction"].to_numpy().repeat(3))


def test_frequencies_of_several_laws_are_never_in_one_picture(line: pd.DataFrame) -> None:
    figure = _figure(_joined([line, line.assign(law="other")]))

    assert titles_of(figure) == [r"drive frequency $\Omega$ = 1", r"$\Omega$ = 1.5"]
    assert legend_of(figure) == ["coulomb", "other"]


def test_of_too_many_pictures_for_comparison_each_law_has_one(resonance: pd.DataFrame) -> None:
    loads = _joined(resonance.assign(**{"scene.normal_load": float(load)}) for load in range(1, 14))

    figure = _figure(_joined(loads.assign(law=law) for law in ("soft", "rough")))

    assert titles_of(figure) == ["soft", "rough"]
    assert [len(curves_of(axes)) for axes in figure.axes] == [13, 13]
    assert legend_of(figure)[0] == "1"


def test_a_parameter_that_differs_between_laws_is_no_sweep(resonance: pd.DataFrame) -> None:
    other = resonance.assign(law="slippery", **{"law.mu": 0.2})

    family = _family(_joined([resonance, other]))

    assert family.member is None
    assert [curve.law for curve in family.curves] == ["coulomb", "slippery"]


def test_a_sweep_of_one_law_leaves_the_other_law_one_curve(resonance: pd.DataFrame) -> None:
    soft = [resonance.assign(law="dahl", **{"law.mu": np.nan, "law.stiffness": s}) for s in (4.0, 40.0)]
    table = _joined([resonance.assign(**{"law.stiffness": np.nan}), *soft])

    assert legend_of(_figure(table)) == ["coulomb", r"dahl, $\sigma_0$ = 4", r"dahl, $\sigma_0$ = 40"]


def test_points_without_a_number_are_marked_on_the_axis_and_counted(resonance: pd.DataFrame) -> None:
    resonance.loc[[10, 11, 12], ["status", "mean_friction"]] = ["failed", np.nan]
    resonance.loc[[20], ["status", "mean_friction"]] = ["refused", np.nan]

    figure = _figure(resonance)

    marks = {line.get_marker(): np.asarray(line.get_xdata()) for line in figure.axes[0].lines}
    np.testing.assert_array_equal(marks["x"], resonance["scene.belt_speed"][[10, 11, 12]])
    np.testing.assert_array_equal(marks["|"], resonance["scene.belt_speed"][[20]])
    assert legend_of(figure) == ["3 points failed", "1 point refused"]


def test_a_method_that_refuses_a_whole_curve_is_counted_by_name(resonance: pd.DataFrame) -> None:
    refused = resonance.assign(method="shooting", status="refused", mean_friction=np.nan)

    figure = _figure(_joined([resonance, refused]))

    assert legend_of(figure) == ["auto", "120 points refused (shooting)"]


def test_a_steady_state_that_is_not_unique_is_drawn_as_its_range(resonance: pd.DataFrame) -> None:
    values = ["not_unique", np.nan, -0.1, 0.3]
    resonance.loc[[5], ["status", "mean_friction", "mean_low", "mean_high"]] = values

    figure = _figure(resonance)

    (bars,) = figure.axes[0].containers
    np.testing.assert_allclose(bars.lines[2][0].get_segments()[0], [[3.0, -0.1], [3.0, 0.3]])
    assert legend_of(figure) == ["1 point not unique"]


@pytest.mark.parametrize(("error", "bands"), [(1e-9, 0), (0.02, 1)])
def test_the_error_is_a_band_where_it_can_be_seen(resonance: pd.DataFrame, error: float, bands: int) -> None:
    axes = _figure(resonance.assign(error=error)).axes[0]

    assert len([band for band in axes.collections if len(band.get_paths()) and band.get_alpha()]) == bands


def test_v_lin_is_marked_where_friction_has_its_kink(line: pd.DataFrame) -> None:
    assert [list(curve.kinks) for curve in _family(line).curves] == [
        [pytest.approx(50)],
        [pytest.approx(26.254457)],
    ]
    names = names_above(_figure(line).axes[0])
    assert list(names.values()) == [rf"$V_\mathrm{{lin}}$, $\Omega$ = {value}" for value in ("1.5", "1")]


def test_a_belt_that_also_runs_backward_has_a_kink_on_either_side(resonance: pd.DataFrame) -> None:
    odd = ["scene.belt_speed", "mean_friction", "velocity_ratio"]
    both = _joined([resonance.assign(**-resonance[odd]), resonance])

    names = names_above(_figure(both).axes[0])
    assert list(names.values()) == [r"$-V_\mathrm{lin}$", r"$V_\mathrm{lin}$"]
    assert list(names) == pytest.approx([-50, 50])


def test_v_lin_is_not_marked_where_there_is_no_kink(plane: pd.DataFrame, resonance: pd.DataFrame) -> None:
    below = resonance[resonance["scene.belt_speed"] < 40]
    rise = 2 + resonance["scene.belt_speed"]
    falling = resonance.assign(normalized_friction=resonance["mean_friction"] * rise)

    for table in (plane, below, falling):
        assert [list(curve.kinks) for curve in _family(table).curves if curve.kinks] == []


def test_a_point_alone_between_gaps_is_still_seen(resonance: pd.DataFrame) -> None:
    resonance.loc[[10, 12], ["status", "mean_friction"]] = ["failed", np.nan]

    curve = _figure(resonance).axes[0].lines[0]

    assert curve.get_markevery() == [11]


def test_curves_that_lie_decades_apart_are_drawn_on_a_logarithmic_scale(plane: pd.DataFrame) -> None:
    def scales(*columns: str) -> list[str]:
        return [axes.get_yscale() for axes in _figure(plane, *columns).axes]

    assert scales("energy_viscous", "energy_friction") == ["log", "log"]
    assert scales("energy_viscous", "mean_friction") == ["linear", "linear"]


def test_an_energy_that_is_zero_but_for_rounding_is_drawn_as_zero(line: pd.DataFrame) -> None:
    sliding = line["scene.belt_speed"] > 10
    table = line.assign(energy_friction=line["energy_friction"].mask(sliding, 1e-14))
    (axes, *_) = _figure(table, "energy_friction").axes

    assert axes.get_yscale() == "linear"
    assert axes.get_ylim()[0] == 0.0


ACROSS_DECADES = [1.5, 3, 5, 8, 10, 12, 15, 17, 20, 30, 50, 150, 500, 5000]
"""Contact stiffnesses that crowd about a resonance."""


@pytest.mark.parametrize(
    "values", [np.logspace(-2, 1, 7), [0.1, 1, 10], [1, 2, 5, 10, 20, 50], ACROSS_DECADES]
)
def test_logarithmic_spacing_is_recognised(values: list[float]) -> None:
    assert is_logarithmic(np.asarray(values))


CHOSEN = np.r_[1:4:0.25, 4:12:0.5, 12:28:2, 28:61:4]
"""As belt speeds are chosen where a curve bends most on slow belts: intervals of an even range, halved."""


@pytest.mark.parametrize(
    "values", [np.linspace(0.5, 60, 120), [1.0, 1.5], [0, 1, 10, 100], [1, 2, 3], CHOSEN]
)
def test_linear_spacing_is_recognised(values: list[float]) -> None:
    assert not is_logarithmic(np.asarray(values, dtype=float))


def test_every_drawn_column_is_a_column_of_the_table_with_a_symbol() -> None:
    for column in (column for columns in FIGURES.values() for column in columns):
        assert column in RESULTS
        assert re.fullmatch(r"\$.+\$", symbol(column))


@deep("seconds of figures")
def test_words_of_a_study_are_drawn_as_they_are_whatever_signs_they_hold(
    resonance: pd.DataFrame, tmp_path: Path
) -> None:
    laws = [resonance.assign(law=label) for label in (r"$\nope{$", "costs $5", "L" * 200)]
    table = _joined(laws)

    data = FigureData(table, r"$\bad{ 摩擦 and $3", options=FigureOptions(all=True))
    assert len(draw_figures(data, tmp_path)) == 2 * len(figures.figures_of(data))
    assert legend_of(_figure(table)) == [r"\$\nope{\$", r"costs \$5", "L" * 35 + "…"]


def test_the_legend_names_what_a_picture_shows_and_nothing_else(resonance: pd.DataFrame) -> None:
    falls = resonance.assign(law="falls", status="not_unique", mean_low=0.1, mean_high=0.3)
    falls = falls.assign(mean_friction=np.nan, energy_viscous=np.nan)
    table = _joined([resonance.assign(law="flat"), falls])

    assert legend_of(_figure(table))[:2] == ["flat", "falls"]
    assert legend_of(_figure(table, "energy_viscous"))[0] == "flat"
    assert "falls" not in legend_of(_figure(table, "energy_viscous"))


def test_the_style_can_be_used_by_its_name() -> None:
    with styles.context("frictionlab.charts.frictionlab"):
        assert mpl.rcParams["legend.frameon"] is False
        assert mpl.rcParams["axes.prop_cycle"].by_key()["color"][0] == "#08306b"


def test_the_kink_lies_at_v_lin_between_points_of_a_sweep(resonance: pd.DataFrame) -> None:
    coarse = resonance[::7].reset_index(drop=True)
    assert 50.0 not in coarse["scene.belt_speed"].tolist()

    (x, y), *_ = curves_of(_figure(coarse).axes[0])

    (at,) = np.flatnonzero(np.isclose(x, 50.0))
    assert y[at] == pytest.approx(0.4)
    assert len(x) == len(coarse) + 1
    rising = coarse.assign(mean_friction=coarse["mean_friction"] + 1e-3 * coarse["scene.belt_speed"])
    first = coarse.index[coarse["scene.belt_speed"] > 50.0][0]
    for unlike in (
        rising,
        coarse.assign(mean_friction=coarse["mean_friction"].drop(first)),
    ):  # or not known there
        (x, _), *_ = curves_of(_figure(unlike).axes[0])
        assert len(x) == len(coarse)


def test_where_a_state_is_not_unique_other_quantities_have_a_mark(resonance: pd.DataFrame) -> None:
    values = ["not_unique", np.nan, np.nan]
    resonance.loc[[5], ["status", "mean_friction", "velocity_amplitude"]] = values

    marks = [
        line
        for line in _figure(resonance, "velocity_amplitude").axes[0].lines
        if line.get_marker() == "$\\mathrm{I}$"
    ]

    assert [list(line.get_xdata()) for line in marks] == [[3.0]]


def test_the_legend_tells_laws_and_values_apart_where_that_is_shorter(resonance: pd.DataFrame) -> None:
    lengths = [{"law.presliding_length": length} for length in (0.1, 1.0, 10.0)]
    table = _joined(resonance.assign(law=law, **each) for law in ("soft", "rough") for each in lengths)

    figure = _figure(table)

    assert legend_of(figure) == ["soft", "rough", r"presliding length $\delta$ = 0.1", "1", "10"]
    laws, values = figure.legends[0].get_lines()[:2], figure.legends[0].get_lines()[2:]
    assert {line.get_linestyle() for line in values} == {"None"}
    lines = figure.axes[0].lines[:6]
    assert {line.get_marker() for line in lines} == {line.get_marker() for line in values}
    dashes = {str(line._unscaled_dash_pattern) for line in laws}
    assert dashes == {str(line._unscaled_dash_pattern) for line in lines}


def test_a_figure_of_every_state_takes_the_width_asked_for() -> None:
    rows = {"point": [1, 1], "period": [1, 0], "belt_speed": [1.0, 2.0], "mean_friction": 0.1, "x": 0.0}
    states = pd.DataFrame({"law": "coulomb", **rows, "mean_low": 0.0, "mean_high": 0.2})

    widths = []
    for width in ("single", "double"):
        with mpl.rc_context(STYLE):
            figure = bifurcation_figures(states)["bifurcation"](Heading("A title", width))
        widths.append(round(25.4 * figure.get_figwidth()))
    assert widths == [85, 175]
