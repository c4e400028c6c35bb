"""One chart per curve: largest error against time per point, every method and peer, readable without colour.

Looks that the charts of a bench share.

The chart of models: distance from the richest one against time per point, and the front.
"""

from __future__ import annotations

import math
import textwrap
from collections.abc import Iterator, Sequence
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from frictionlab.bench.curve import CurveResult, ModelRow, ModelsResult, front
from frictionlab.bench.record import Contender, ReferenceMeans, Row
from frictionlab.bench.report import largest, point_remark
from frictionlab.charts.sheet import PAGE, blank_figure

OURS = ("#08306b", "#7f0000", "#00441b", "#4a1486", "#662506", "#252525")
THEIRS = ("#e6550d", "#31a354", "#756bb1", "#858585")
LINE_STYLES = ("solid", (0, (5, 1.5)), (0, (1, 1.2)), (0, (5, 1.5, 1, 1.5)))


def dress(axes: Axes, title: str, **look: Any) -> None:
    """A title at the left, and a pale grid behind."""
    axes.set_title(title, loc="left", **look)
    axes.grid(which="major", color="0.9", linewidth=0.5)
    axes.set_axisbelow(True)


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


MARKS_OF_METHODS = "osD^v<>phPX*"
CHART_HEIGHT = 3.4
TITLE_LETTERS = 56
"""On a line of the title."""
FRONT: dict[str, Any] = {
    "color": "0.55",
    "linewidth": 3.0,
    "alpha": 0.45,
    "zorder": 1,
    "solid_capstyle": "round",
}


def models_figure(result: ModelsResult) -> Figure:
    """One panel; models told apart by colour and by filling, methods by marks."""
    rows, title = result.rows, result.title or result.name
    figure = blank_figure(PAGE, CHART_HEIGHT)
    axes = figure.add_subplot()
    axes.set_xscale("log")
    axes.set_yscale("log")
    labels = list(dict.fromkeys(each.model.label for each in rows))
    methods = list(dict.fromkeys(each.row.contender.label for each in rows))
    drawn = [each for each in rows if math.isfinite(each.row.largest)]
    known = largest([largest(reference.errors) for reference in result.references])
    for label in labels:
        for method in methods:
            own = [each for each in drawn if (each.model.label, each.row.contender.label) == (label, method)]
            _draw_models(axes, own, known, _look(labels.index(label), methods.index(method)))
    _draw_front(axes, front(rows), known)
    axes.set_xlabel(r"time per point [$\mathrm{\mu s}$]")
    axes.set_ylabel(f"largest distance from {rows[0].model.label}")
    dress(axes, textwrap.fill(title, TITLE_LETTERS), fontweight="bold")
    axes.axhspan(1e-3 * known, known, color="0.93", zorder=0)
    axes.set_ylim(0.1 * known)
    axes.set_xlim(0.2 * axes.get_xlim()[0])  # room for the name of the cheapest
    seen = {each.row.contender.label for each in drawn}
    entries = [Line2D([], [], label=label, **_look(k, 0)) for k, label in enumerate(labels)]
    entries += [Line2D([], [], linestyle="none", label=" ")]
    entries += [_mark(k, method, method in seen) for k, method in enumerate(methods)]
    entries += [Line2D([], [], label="front", **FRONT)]
    figure.legend(handles=entries, loc="outside right upper")
    return figure


def _look(model: int, method: int) -> dict[str, Any]:
    color = OURS[model % len(OURS)]
    full = model % 2 == 0
    return {
        "color": color,
        "marker": MARKS_OF_METHODS[method % len(MARKS_OF_METHODS)],
        "markerfacecolor": color if full else "white",
        "markersize": 4.5,
        "linewidth": 0.8,
        "linestyle": "solid" if full else (0, (4, 1.5)),
    }


def _mark(place: int, method: str, seen: bool) -> Line2D:
    marker, label = MARKS_OF_METHODS[place % len(MARKS_OF_METHODS)], method if seen else f"{method}: refused"
    return Line2D([], [], linestyle="none", label=label, color="0.3", marker=marker, markersize=4.5)


def _place(each: ModelRow, known: float) -> tuple[float, float]:
    """Distances below what is known of the richest model cannot be told apart: they stand on that."""
    return 1e6 * each.row.mean.least, max(each.row.largest, known)


def _draw_models(axes: Axes, rows: Sequence[ModelRow], known: float, look: dict[str, Any]) -> None:
    """A method on a model: one mark for each of its settings, joined in their order."""
    if not rows:
        return
    places = [_place(each, known) for each in rows]
    axes.plot(*zip(*places, strict=True), **look)
    for each, (x, y) in zip(rows, places, strict=True):
        if math.isfinite(each.row.model.least):
            alone = 1e6 * each.row.model.least
            axes.plot([alone, x], [y, y], color=look["color"], linestyle=(0, (1, 1.5)), linewidth=0.8)
        if not each.answered:
            axes.plot([x], [y], marker="x", markersize=8, color="0.2", linestyle="none")


def _draw_front(axes: Axes, best: Sequence[ModelRow], known: float) -> None:
    """A stair through the front, its points by name: what is left of it is cheaper, what is below is nearer."""
    places = [_place(each, known) for each in best]
    if places:
        axes.step(*zip(*places, strict=True), where="post", **FRONT)
    named: set[tuple[str, str]] = set()
    for each, place in zip(best, places, strict=True):
        name = each.model.label, each.row.contender.label
        if name not in named:  # its finer settings follow on its line
            said = "\n".join(name)
            axes.annotate(
                said, place, (-4.0, -4.0), textcoords="offset points", fontsize=5.5, ha="right", va="top",
                color="0.25",
            )  # fmt: skip
        named.add(name)
