"""Figures of a bench: how they are begun, and written with machine, date and versions in small print."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import matplotlib as mpl
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine

from frictionlab.bench.circumstances import small_print
from frictionlab.charts.style import PAGE, STYLE

OURS = ("#08306b", "#7f0000", "#00441b", "#4a1486", "#662506", "#252525")
THEIRS = ("#e6550d", "#31a354", "#756bb1", "#969696")
LINE_STYLES = ("solid", (0, (5, 1.5)), (0, (1, 1.2)), (0, (5, 1.5, 1, 1.5)))
UNSTAMPED: dict[str, Mapping[str, Any]] = {"svg": {"Date": None}, "png": {"Software": None}}
"""The kinds of file of a chart, and what is left out of each so that the same chart is the same file."""
_DIGITS = re.compile(r"(?<=[ -])(\d+\.\d\d)\d+")
"""A coordinate: a hundredth of a point is kept of it, which takes a third off the file."""


def new_figure(height: float, width: float = PAGE) -> Figure:
    """An empty figure of this size [inch]."""
    figure = Figure(figsize=(width, height), layout="constrained")
    FigureCanvasAgg(figure)
    return figure


def dress(axes: Axes, title: str, **look: Any) -> None:
    """A title at the left, and a pale grid behind."""
    axes.set_title(title, loc="left", **look)
    axes.grid(which="major", color="0.9", linewidth=0.5)
    axes.set_axisbelow(True)


def save_in_style(
    made: Callable[[], Figure | None], look: Mapping[str, Any], folder: Path, stem: str
) -> bool:
    """Make a figure in this look beside the style of all, and write it; whether there is one. Raises OSError."""
    style: Any = {**STYLE, **look}
    with mpl.rc_context(style):
        if (figure := made()) is not None:
            save_figure(figure, folder, stem)
    return figure is not None


def save_figure(figure: Figure, folder: Path, stem: str) -> None:
    """Write a figure as SVG and PNG, with machine, date and versions in small print. Raises OSError."""
    _print_below(figure, textwrap.fill(small_print(), 175))
    for kind, unstamped in UNSTAMPED.items():
        figure.savefig(folder / f"{stem}.{kind}", metadata=unstamped)
    drawn = folder / f"{stem}.svg"
    drawn.write_text(_DIGITS.sub(r"\1", drawn.read_text(encoding="utf-8")), encoding="utf-8")


def _print_below(figure: Figure, text: str) -> None:
    """Small print at the lower right, in a strip that the layout leaves free."""
    strip = 0.085 * (1 + text.count("\n")) / figure.get_figheight()
    engine = figure.get_layout_engine()
    if isinstance(engine, ConstrainedLayoutEngine):
        engine.set(rect=(0.0, strip, 1.0, 1.0 - strip))
    figure.text(0.995, 0.1 * strip, text, ha="right", va="bottom", fontsize=4.5, color="0.45")
