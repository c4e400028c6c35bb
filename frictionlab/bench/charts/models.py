"""The chart of models: distance from the richest one against time per point, and the front."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Sequence
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from frictionlab.bench.charts.style import OURS, dress
from frictionlab.bench.models import ModelRow, ModelsResult, front
from frictionlab.bench.report import largest
from frictionlab.charts.style import PAGE, blank_figure

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
            _draw(axes, own, known, _look(labels.index(label), methods.index(method)))
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


def _draw(axes: Axes, rows: Sequence[ModelRow], known: float, look: dict[str, Any]) -> None:
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
