"""Figures of a bench, written with machine, date and versions in small print."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import matplotlib as mpl
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine

from frictionlab.bench.account import small_print
from frictionlab.bench.charts.curve import curve_figure
from frictionlab.bench.charts.failures import failures_figure
from frictionlab.bench.charts.models import models_figure
from frictionlab.bench.charts.orders import orders_figure
from frictionlab.bench.charts.stability import stability_figure
from frictionlab.bench.curve import CurveResult
from frictionlab.bench.failures.section import FailureResult
from frictionlab.bench.models import ModelsResult
from frictionlab.bench.orders.section import OrdersResult
from frictionlab.bench.sections import SectionResult, file_stem
from frictionlab.bench.stability.section import StabilityResult
from frictionlab.charts.style import STYLE, write_figure

_DIGITS = re.compile(r"(?<=[ -])(\d+\.\d\d)\d+")
"""A coordinate: a hundredth of a point is kept of it, which takes a third off the file."""
FIGURES_OF_SECTIONS: dict[type, Callable[[Any], Figure | None]] = {
    CurveResult: curve_figure,
    OrdersResult: orders_figure,
    StabilityResult: stability_figure,
    FailureResult: failures_figure,
    ModelsResult: models_figure,
}
"""The figure of each kind of result, None where there is nothing to draw."""


class BenchPicture(NamedTuple):
    """A chart, written as SVG and PNG under this stem; the caption is one sentence on how to read it."""

    file_stem: str
    caption: str


def draw(result: SectionResult, folder: Path) -> list[BenchPicture]:
    """Write the chart of a result, with machine, date and versions in small print. Raises OSError."""
    stem, look = file_stem(result.name), dict[Any, Any](STYLE | result.style)
    with mpl.rc_context(look):
        if (figure := FIGURES_OF_SECTIONS[type(result)](result)) is None:
            return []
        _print_below(figure, textwrap.fill(small_print(), 110))
        drawn, _ = write_figure(figure, folder / f"{stem}.svg")
    drawn.write_text(_DIGITS.sub(r"\1", drawn.read_text(encoding="utf-8")), encoding="utf-8")
    return [BenchPicture(stem, result.caption)]


def _print_below(figure: Figure, text: str) -> None:
    """Small print at the lower right, in a strip that the layout leaves free."""
    strip = 0.12 * (1 + text.count("\n")) / figure.get_figheight()
    engine = figure.get_layout_engine()
    if isinstance(engine, ConstrainedLayoutEngine):
        engine.set(rect=(0.0, strip, 1.0, 1.0 - strip))
    figure.text(0.995, 0.1 * strip, text, ha="right", va="bottom", fontsize=6.5, color="0.3")
