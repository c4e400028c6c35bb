"""One chart per curve: largest error against time per point, every method and peer, readable without colour."""

from __future__ import annotations

import math
import re
import textwrap
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import matplotlib as mpl
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.lines import Line2D

from frictionlab.bench.account import small_print
from frictionlab.bench.measure import Row, WorkloadResult
from frictionlab.bench.names import file_stem
from frictionlab.bench.record import Contender
from frictionlab.bench.report import largest, point_remark
from frictionlab.bench.sections import BenchPicture, SectionResult
from frictionlab.charts.style import PAGE, STYLE
from frictionlab.runner.errors import SaveError

OURS = ("#08306b", "#7f0000", "#00441b", "#4a1486", "#662506", "#252525")
THEIRS = ("#e6550d", "#31a354", "#756bb1", "#969696")
MARKERS, HOLLOW = "osD^v<>", "oshdPX"
LINE_STYLES = ("solid", (0, (5, 1.5)), (0, (1, 1.2)), (0, (5, 1.5, 1, 1.5)))
LEAST = 1e-17
"""An error of zero is drawn here."""
HEIGHT = 3.0
UNSTAMPED = {"svg": {"Date": None}, "png": {"Software": None}}
"""The kinds of file of a chart, and what is left out of each so that the same chart is the same file."""
CAPTION = (
    "Lower is nearer the reference, further left is cheaper: read what each error costs along a level line."
)
_DIGITS = re.compile(r"(?<=[ -])(\d+\.\d\d)\d+")
"""A coordinate: a hundredth of a point is kept of it, which takes a third off the file."""
LETTERS = 36
"""On a line of the legend."""


def draw_charts(done: Sequence[WorkloadResult | SectionResult], folder: Path) -> list[BenchPicture]:
    """Draw every curve and section as SVG and PNG; what was drawn. Raises SaveError."""
    pictures = []
    try:
        with mpl.rc_context(STYLE):
            for measured in done:
                if isinstance(measured, WorkloadResult):
                    pictures.append(BenchPicture(file_stem(measured.work.name), CAPTION))
                    save_figure(chart(measured), folder, pictures[-1].file_stem)
                else:
                    pictures += measured.draw(folder)
    except OSError as problem:
        raise SaveError(f"cannot write the charts in {folder}: {problem.strerror or problem}") from problem
    return pictures


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


def chart(measured: WorkloadResult) -> Figure:
    """The chart of one curve."""
    figure = Figure(figsize=(PAGE, HEIGHT), layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.add_subplot()
    entries = [_draw(axes, contender, look, rows) for contender, look, rows in _looks(measured)]
    lines = sum(str(entry.get_label()).count("\n") + 1.4 for entry in entries)
    figure.set_figheight(max(HEIGHT, 0.4 + 0.11 * lines))
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlabel(
        r"time per point [$\mathrm{\mu s}$]; thin: with every other column; dotted: a model without its error"
    )
    axes.set_ylabel("largest error of the mean friction")
    axes.grid(which="major", color="0.9", linewidth=0.5)
    axes.set_axisbelow(True)
    _shade_what_is_not_known(axes, measured)
    work = measured.work
    axes.set_title(f"{work.name}: {work.title}" if work.title else work.name, loc="left", fontweight="bold")
    figure.legend(handles=entries, loc="outside right upper", handlelength=3.2)
    return figure


def _looks(measured: WorkloadResult) -> Iterator[tuple[Contender, dict[str, Any], list[Row]]]:
    """Each contender with its look: methods dark and full, peers light and hollow."""
    contenders = list({row.contender.label: row.contender for row in measured.rows}.values())
    seen = {"method": 0, "peer": 0}
    for contender in contenders:
        n, ours = seen[contender.side], contender.side == "method"
        seen[contender.side] += 1
        color = (OURS if ours else THEIRS)[n % len(OURS if ours else THEIRS)]
        look = {
            "color": color,
            "marker": (MARKERS if ours else HOLLOW)[n % len(MARKERS if ours else HOLLOW)],
            "markerfacecolor": color if ours else "white",
            "linestyle": LINE_STYLES[n % len(LINE_STYLES)],
            "markersize": 4.5,
        }
        yield contender, look, [row for row in measured.rows if row.contender is contender]


def _draw(axes: Axes, contender: Contender, look: dict[str, Any], rows: Sequence[Row]) -> Line2D:
    """The line of one contender, and its place in the legend, which it keeps when there is no line."""
    drawn = [row for row in rows if math.isfinite(row.largest) and math.isfinite(row.mean.least)]
    places = [(1e6 * row.mean.least, max(row.largest, LEAST)) for row in drawn]
    if places:
        axes.plot(*zip(*places, strict=True), **look)
    for row, (x, y) in zip(drawn, places, strict=True):
        axes.plot([x, 1e6 * row.whole.least], [y, y], color=look["color"], linewidth=0.5)
        if math.isfinite(row.model.least):
            alone = look | {"marker": "|", "linestyle": (0, (1, 1.5)), "linewidth": 0.9, "markevery": [0]}
            axes.plot([1e6 * row.model.least, x], [y, y], **alone)
    partly = [place for place, row in zip(places, drawn, strict=True) if row.counts["ok"] < row.points]
    for x, y in partly:
        axes.plot([x], [y], marker="x", markersize=8, color="0.2", linestyle="none")
    text = contender.label + (" (peer)" if contender.side == "peer" else "")
    without = next((point_remark(row) for row in rows if point_remark(row)), "")
    if without:
        told = textwrap.shorten(f"{text}; {_share(rows)}{without}", 3 * LETTERS - 12, placeholder=" ...")
        text = "\n".join(textwrap.wrap(told, LETTERS))
    return Line2D([], [], label=text, **(look if places else look | {"linestyle": "none"}))


def _share(rows: Sequence[Row]) -> str:
    """At how many settings points are missing, where it is not all of them."""
    missing = sum(row.counts["ok"] < row.points for row in rows)
    return "" if missing in (0, len(rows)) else f"at {missing} of {len(rows)} settings (x) "


def _shade_what_is_not_known(axes: Axes, measured: WorkloadResult) -> None:
    """Errors below those of the references cannot be told apart."""
    known = largest([largest(reference.errors) for reference in measured.references])
    low, high = axes.get_ylim()
    if math.isfinite(known) and low < known:
        axes.axhspan(low, known, color="0.93", zorder=0)
        axes.set_ylim(low, high)
