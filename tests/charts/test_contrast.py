"""Every line of a figure can be seen on white, and lines are told apart without colour."""

from __future__ import annotations

import re
from itertools import pairwise
from pathlib import Path

import matplotlib as mpl
import pytest
from drawn_figures import drawn
from oracle import table_in_the_plane

from frictionlab.bench.charts import OURS, THEIRS
from frictionlab.charts.bifurcation import LONGER, PERIOD_MARKERS, WILD
from frictionlab.charts.looks import contrast, luminance, with_contrast
from frictionlab.charts.needs import ERROR
from frictionlab.charts.sheet import CYCLE, STYLE, write_figure

LEAST_CONTRAST = 3.0  # of a line against white (WCAG 2.1, 1.4.11)
LINES = [look["color"] for look in CYCLE]
OTHERS = [*OURS, *THEIRS, WILD, ERROR, LONGER[1], *(color for _, color in PERIOD_MARKERS.values())]


def test_contrast_is_that_of_wcag() -> None:
    assert [contrast("white"), contrast("black")] == pytest.approx([1.0, 21.0])
    assert contrast("#767676") == pytest.approx(4.54, abs=0.01)


@pytest.mark.parametrize("color", [*LINES, *OTHERS])
def test_every_line_can_be_seen_on_white(color: str) -> None:
    assert contrast(color) >= LEAST_CONTRAST


@pytest.mark.parametrize("wanted", [3.2, 7.0, 14.0])
def test_a_colour_takes_the_contrast_asked_for(wanted: float) -> None:
    for color in LINES:
        assert contrast(with_contrast(color, wanted)) == pytest.approx(wanted)


def test_lines_differ_without_colour() -> None:
    assert len({str(look["linestyle"]) for look in CYCLE}) == len(CYCLE)
    greys = sorted(luminance(color) ** (1 / 3) for color in LINES[:5])
    assert min(high - low for low, high in pairwise(greys)) > 0.03


def test_values_of_a_sweep_get_paler_and_stay_visible() -> None:
    lines = [line for line in drawn(table_in_the_plane()).axes[0].lines if len(line.get_xdata()) > 2]

    seen = [contrast(line.get_color()) for line in lines]
    assert seen == sorted(seen, reverse=True)
    assert seen[-1] >= LEAST_CONTRAST
    assert len({line.get_marker() for line in lines}) == len(lines)


def test_text_stays_text_in_drawings(tmp_path: Path) -> None:
    with mpl.rc_context(STYLE):
        svg, pdf = write_figure(drawn(table_in_the_plane()), tmp_path / "plane", ("svg", "pdf"))

    assert "belt speed" in svg.read_text("utf-8")
    assert re.findall("\u200b[\u0300-\u036f]", svg.read_text("utf-8"))
    assert not re.search(">[\u0300-\u036f]", svg.read_text("utf-8"))
    assert b"/FontFile2" in pdf.read_bytes()
    assert b"/Type3" not in pdf.read_bytes()
