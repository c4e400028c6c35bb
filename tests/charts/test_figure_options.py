"""What a study asks of its figures, and what is then drawn."""

from __future__ import annotations

from io import BytesIO
from pathlib import Path
from typing import Any

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
import pytest
from drawn_figures import curves_of, drawn, legend_of, names_above, titles_of
from matplotlib.figure import Figure
from matplotlib.image import imread
from oracle import table_of_one_degree_of_freedom
from profiles import deep

import frictionlab as fl
from frictionlab.charts.figures import FigureData, chosen_of, draw_figures, figure_of, figures_of
from frictionlab.charts.sheet import STYLE
from frictionlab.study.figure_options import FigureOptions, figure_options
from frictionlab.study.load import parse_study
from frictionlab.values.notes import StudyError


@pytest.fixture(scope="module")
def laws() -> pd.DataFrame:
    """Two laws at two frequencies."""
    table = table_of_one_degree_of_freedom()
    higher = table.assign(law="other", mean_friction=table["mean_friction"] * 1.02, error=1e-3)
    return pd.concat([higher.assign(kind="dahl"), table.assign(error=1e-9)], ignore_index=True)


SHAPES = pd.DataFrame(
    [
        ("coulomb", "coulomb", "auto", 1.0, 50.0, 0.05, 0.5446, 0.0574, 1e-3, "concave"),
        ("coulomb", "coulomb", "auto", 1.5, 26.254457, 0.0, 0.3627, -0.2071, 4e-2, "convex"),
    ],
    columns=[
        *("law", "kind", "method", "scene.drive.frequency"),
        *("reversal_end", "shape_start", "shape_half", "shape_area", "shape_area_error", "shape"),
    ],
)


def _drawn(table: pd.DataFrame, name: str = "mean_friction", **options: Any) -> Figure:
    curves = SHAPES if options.get("shape") else None
    return drawn(table, name, curves=curves, options=FigureOptions(**options))


def test_normalized_axes_are_shares_of_v_lin_and_of_steady_friction(laws: pd.DataFrame) -> None:
    figure = _drawn(laws, normalized=True)

    assert "V_" in figure.axes[0].get_xlabel()
    rows = laws[(laws["law"] == "coulomb") & (laws["scene.drive.frequency"] == 1.0)]
    x, y = curves_of(figure.axes[0])[1]
    np.testing.assert_allclose(x, rows["velocity_ratio"], rtol=1e-12)
    np.testing.assert_allclose(y, rows["normalized_friction"], rtol=1e-12)
    for axes in figure.axes:
        assert list(names_above(axes)) == [1.0]


@pytest.mark.parametrize(("against", "law", "sign"), [(None, "coulomb", 1.0), ("other", "other", -1.0)])
def test_differences_are_taken_from_coulomb_or_the_law_asked_for(
    laws: pd.DataFrame, against: str | None, law: str, sign: float
) -> None:
    figure = _drawn(laws, "differences", against=against)

    axes = figure.axes[0]
    assert axes.get_ylabel() == rf"$\bar\mu - \bar\mu_\text{{{law}}}$"
    rows = laws[(laws["law"] == "coulomb") & (laws["scene.drive.frequency"] == 1.0)]
    ((_, y),) = curves_of(axes)
    np.testing.assert_allclose(y, sign * 0.02 * rows["mean_friction"], atol=1e-12)
    (band,) = axes.collections
    heights = np.ptp(band.get_paths()[0].vertices[:, 1])
    assert heights == pytest.approx(np.ptp(0.02 * rows["mean_friction"]) + 2e-3, rel=1e-2)


def test_a_shape_is_drawn_with_its_chord_its_area_and_the_verdict(laws: pd.DataFrame) -> None:
    one = laws[laws["law"] == "coulomb"]

    figure = _drawn(one, "shape", shape=True)

    told = [title.splitlines()[-1] for title in titles_of(figure)]
    assert told == ["concave: area 0.0574 ± 0.0010", "convex: area \N{MINUS SIGN}0.207 ± 0.041"]
    for axes, (_, row) in zip(figure.axes, SHAPES.iterrows(), strict=True):
        (chord,) = [line for line in axes.lines if len(line.get_xdata()) == 2]
        assert list(chord.get_xdata()) == pytest.approx([0.0, row["reversal_end"]])
        assert list(chord.get_ydata()) == pytest.approx([row["shape_start"], 0.4], abs=1e-3)
        (area,) = axes.collections
        assert area.get_paths()[0].vertices[:, 0].max() == pytest.approx(row["reversal_end"])


def test_stick_is_a_band_along_the_points_where_it_is(laws: pd.DataFrame) -> None:
    sticky = laws.assign(stick_fraction=np.where(laws["scene.belt_speed"] > 40.0, 0.2, 0.0))

    figure = _drawn(sticky, stick=True)

    (band, _) = [line for line in figure.axes[0].lines if line.get_alpha()]
    held = np.isfinite(np.asarray(band.get_ydata(), dtype=float))
    np.testing.assert_array_equal(held, laws["scene.belt_speed"][:120].to_numpy() > 40.0)
    assert legend_of(figure)[-1] == "stick in part of the period"
    assert "stick" not in " ".join(legend_of(_drawn(sticky)))


def test_a_figure_of_many_pictures_is_no_higher_than_a_page(laws: pd.DataFrame) -> None:
    loads = [
        laws.assign(**{"scene.normal_load": load, "scene.damping_ratio": 0.1 * load})
        for load in (1.0, 2.0, 3.0)
    ]
    figure = _drawn(pd.concat(loads, ignore_index=True), width="single")

    assert len(figure.axes) > 4
    assert figure.get_figheight() * 25.4 <= 240.0
    figure.draw_without_rendering()
    boxes = [axes._left_title.get_window_extent() for axes in figure.axes]  # type: ignore[attr-defined]
    assert not any(one.overlaps(other) for k, one in enumerate(boxes) for other in boxes[:k] if one.width)


@pytest.mark.parametrize(("width", "millimetres"), [("single", 85.0), ("double", 175.0)])
def test_widths_are_those_of_a_journal(laws: pd.DataFrame, width: str, millimetres: float) -> None:
    assert _drawn(laws, width=width).get_figwidth() * 25.4 == pytest.approx(millimetres)


@deep("seconds of figures")
def test_formats_and_title_are_as_asked_for(laws: pd.DataFrame, tmp_path: Path) -> None:
    few = laws[(laws["law"] == "coulomb") & (laws["scene.drive.frequency"] == 1.0)]
    draw_figures(FigureData(few, "Of before"), tmp_path)
    files = draw_figures(FigureData(few, "T", options=FigureOptions(formats=("pdf",), title=False)), tmp_path)

    assert {file.suffix for file in tmp_path.iterdir()} == {".pdf"}
    assert len(files) == 3
    assert _drawn(laws, title=False).get_suptitle() == ""


STUDY = {
    "schema": 1,
    "scene": {"damping_ratio": 0.1, "normal_load": 1, "belt_speed": 1},
    "laws": [{"kind": "coulomb", "mu": 0.4}],
}


def test_a_study_says_how_its_figures_are_drawn() -> None:
    given = {"normalized": True, "against": "coulomb", "width": "double", "formats": ["pdf"], "title": False}

    study = parse_study(STUDY | {"figures": given})

    assert study.figures == FigureOptions(**given)
    assert study.resolved()["figures"] == given
    assert parse_study(study.resolved()).figures == study.figures
    assert study.digest() == parse_study(STUDY).digest()
    assert "figures" not in parse_study(STUDY).resolved()


@pytest.mark.parametrize(
    ("figures", "message"),
    [
        ({"normalised": True}, "unknown key"),
        ({"inset": 1}, "must be true or false, got 1"),
        ({"inset": True}, "closer views are gone: narrow the sweep, or draw the figure of differences"),
        ({"against": "columb"}, "must be one of coulomb"),
        ({"width": "wide"}, "must be 'single' or 'double'"),
        ({"width": 85}, "must be 'single' or 'double'; got 85"),
        ({"formats": "svg"}, "must be a list"),
        ({"formats": ["gif"]}, "must be 'svg', 'png' or 'pdf'"),
        ([], "must be a mapping"),
    ],
)
def test_mistakes_in_it_are_told(figures: Any, message: str) -> None:
    with pytest.raises(StudyError) as problem:
        parse_study(STUDY | {"figures": figures})

    (mistake,) = problem.value.mistakes
    assert message in str(mistake)
    assert mistake.path.startswith("figures")


def test_one_figure_is_had_without_files_or_pyplot(laws: pd.DataFrame) -> None:
    before = dict(mpl.rcParams)

    options = FigureOptions(against="other", width="single")
    figure = figure_of(FigureData(laws, options=options), "differences")

    assert dict(mpl.rcParams) == before
    assert figure.axes[0].get_ylabel().endswith("other}$")
    labels = [label for axes in figure.axes for label in axes.get_yticklabels()]
    assert {label.get_fontsize() for label in labels} == {STYLE["ytick.labelsize"]}
    pixels = imread(BytesIO(figure._repr_png_()))
    assert pixels.shape[1] == pytest.approx(85.0 / 25.4 * 200, abs=1)
    shape = figure_of(FigureData(laws[laws["law"] == "coulomb"], curves=SHAPES), "shape")
    assert len(shape.axes) == 2


def test_a_figure_that_is_not_there_is_refused_with_those_that_are(laws: pd.DataFrame) -> None:
    told = "no figure 'shapes'; this table has: differences, energies, mean_fr"
    with pytest.raises(ValueError, match=told):
        figure_of(FigureData(laws), "shapes")
    with pytest.raises(ValueError, match="none, for no number is swept"):
        figure_of(FigureData(laws.iloc[:1]))


def test_keywords_are_checked_as_the_keys_of_a_study_are() -> None:
    given = {"normalized": True, "against": "dahl"}
    assert figure_options(given, ("dahl",)) == FigureOptions(**given)
    for wrong, told in (
        ({"width": 85}, "figures: width: must be 'single' or 'double'; got 85"),
        ({"against": "dahls"}, "figures: against: must be one of dahl; got the text 'dahls'"),
    ):
        with pytest.raises(ValueError, match=told):
            figure_options(given | wrong, ("dahl",))


def test_laws_and_methods_are_told_in_words_and_labels_as_the_study_has_them() -> None:
    laws = {"coulomb": fl.Coulomb(mu=0.4), "Dahl, softer": fl.Dahl(mu=0.4, stiffness=0.4)}
    scene = fl.Scene(
        damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1)
    )
    done = fl.compare(scene, laws, [5, 20, 45], ["auto", "mdsm"])

    told = [text.get_text() for text in done.plot(against="coulomb").legends[0].get_texts()]

    assert told[:2] == ["Coulomb, steady state", "Coulomb, closed form"]
    assert told[2].startswith("Dahl, softer")


def test_two_laws_of_the_same_words_keep_their_labels() -> None:
    scene = fl.Scene(belt_speed=1, slip=fl.Slip(velocity_amplitude=2, frequency=1))
    laws = {"dahl": fl.Dahl(mu=0.4, stiffness=40), "Dahl": fl.Dahl(mu=0.4, stiffness=4)}

    assert fl.Study.of(scene, laws).in_words["law"] == {"dahl": "dahl", "Dahl": "Dahl"}


@deep("seconds of figures")
def test_only_the_figure_that_shows_a_finding_bears_the_title(laws: pd.DataFrame) -> None:
    def titles(**options: Any) -> dict[str, str]:
        found = figures_of(FigureData(laws, "A finding", options=FigureOptions(**options)))
        return {name: " ".join(draw().get_suptitle().split()) for name, draw in found.items()}

    assert titles() == {
        "mean_friction": "A finding",
        "differences": "Difference of mean friction from that of coulomb over belt speed",
        "velocity": "Velocity amplitude over belt speed",
        "energies": "Work of the loads, viscous loss, work absorbed by friction, heat in the contact over belt speed",
    }
    by_speed = titles(finding="velocity", normalized=True)
    assert next(iter(by_speed.items())) == ("velocity", "A finding")
    told = "Mean friction over steady sliding friction over relative belt speed"
    assert by_speed["mean_friction"] == told


def test_three_figures_are_drawn_and_all_where_asked_for(laws: pd.DataFrame) -> None:
    def names(options: FigureOptions) -> set[str]:
        return set(chosen_of(FigureData(laws, options=options)))

    assert names(FigureOptions()) == {"mean_friction", "differences", "velocity"}
    assert names(figure_options({"finding": "energies"}, ())) == {"energies", "mean_friction", "differences"}
    assert names(parse_study(STUDY | {"figures": "all"}).figures) == {
        "mean_friction",
        "differences",
        "velocity",
        "energies",
    }


def test_a_figure_of_one_picture_is_drawn_into_axes_of_ones_own(laws: pd.DataFrame) -> None:
    _, (first, second) = plt.subplots(1, 2)
    one = laws[laws["scene.drive.frequency"] == 1.0]

    figure = figure_of(FigureData(one, "A title"), into=second)

    assert figure.axes == [first, second]
    assert (len(first.lines), len(curves_of(second))) == (0, 2)
    assert [text.get_text() for text in second.get_legend().get_texts()] == ["other", "coulomb"]
    with pytest.raises(ValueError, match="ax takes a figure of one picture, and this has 2"):
        figure_of(FigureData(laws), into=first)
    plt.close(figure)
