"""One chart per curve: largest error against time per point, every method and peer, readable without colour."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Iterator, Sequence
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from frictionlab.bench.charts.style import LINE_STYLES, OURS, THEIRS, dress
from frictionlab.bench.curve import CurveResult
from frictionlab.bench.record import Contender, ReferenceMeans, Row
from frictionlab.bench.report import largest, point_remark
from frictionlab.charts.style import PAGE, blank_figure

MARKERS, HOLLOW = "osD^v<>", "oshdPX"
LEAST = 1e-17
"""An error of zero is drawn here."""
HEIGHT = 3.0
LETTERS = 36
"""On a line of the legend."""


def curve_figure(result: CurveResult) -> Figure:
    """Times and errors of every contender."""
    figure = blank_figure(PAGE, HEIGHT)
    axes = figure.add_subplot()
    entries = [_draw(axes, contender, look, own) for contender, look, own in _looks(result.rows)]
    lines = sum(str(entry.get_label()).count("\n") + 1.4 for entry in entries)
    figure.set_figheight(max(HEIGHT, 0.4 + 0.11 * lines))
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlabel(
        r"time per point [$\mathrm{\mu s}$]; thin: with every other column; dotted: a model without its error"
    )
    axes.set_ylabel("largest error of the mean friction")
    _shade_what_is_not_known(axes, result.references)
    dress(axes, f"{result.name}: {result.title}" if result.title else result.name, fontweight="bold")
    figure.legend(handles=entries, loc="outside right upper", handlelength=3.2)
    return figure


def _looks(rows: Sequence[Row]) -> Iterator[tuple[Contender, dict[str, Any], list[Row]]]:
    """Each contender with its look: methods dark and full, peers light and hollow."""
    contenders = list({row.contender.label: row.contender for row in rows}.values())
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
        yield contender, look, [row for row in rows if row.contender is contender]


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


def _shade_what_is_not_known(axes: Axes, references: Sequence[ReferenceMeans]) -> None:
    """Errors below those of the references cannot be told apart."""
    known = largest([largest(reference.errors) for reference in references])
    low, high = axes.get_ylim()
    if math.isfinite(known) and low < known:
        axes.axhspan(low, known, color="0.93", zorder=0)
        axes.set_ylim(low, high)
