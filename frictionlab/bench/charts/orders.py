"""The picture of orders: a panel a motion, errors against settings, the fitted slope at each line's end."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from frictionlab.bench.charts.style import LINE_STYLES, OURS, THEIRS, dress
from frictionlab.bench.orders.section import OrderRow, OrdersResult
from frictionlab.charts.style import PAGE, blank_figure

COLUMNS, PANEL = 3, 1.95
LOWEST = 1e-16
"""Errors below are drawn here."""
MARKERS_OF_SOLVERS = "osD^v<>ph"
RIGHT = 9.7
"""Where the slopes stand."""
NEAREST_LABELS = 1.3
"""Powers of ten between two numbers at the right end."""


def orders_figure(result: OrdersResult) -> Figure:
    """Small multiples: one panel a motion, one line a solver."""
    rows = result.rows
    motions = list({row.motion.name: row.motion for row in rows}.values())
    solvers = list(dict.fromkeys(row.solver for row in rows))
    lines = math.ceil(len(motions) / COLUMNS)
    figure = blank_figure(PAGE, PANEL * lines + 0.6)
    panels = figure.subplots(lines, COLUMNS, squeeze=False, sharex=True, sharey=True)
    handles: dict[str, Any] = {}
    for axes, motion in zip(panels.flat, motions, strict=False):
        drawn = [row for row in rows if row.motion is motion]
        for row in drawn:
            handles[row.solver] = _draw(axes, row, solvers.index(row.solver))
        _label(axes, drawn, handles)
        dress(axes, f"{motion.title} ({motion.law_text})", fontsize=7)
        axes.set_yscale("log")
        axes.set_ylim(0.3 * LOWEST, 3.0)
        axes.set_xlim(-0.3, RIGHT - 0.2)
    for axes in panels.flat[len(motions) :]:
        axes.set_axis_off()
    for column in range(COLUMNS):
        shown = [axes for axes in panels[:, column] if axes.axison]
        if shown:
            shown[-1].set_xlabel("refinements")
            shown[-1].tick_params(labelbottom=True)
    figure.supylabel("error of the mean friction", fontsize=8)
    named = [name for name in solvers if name in handles]
    entries = [Line2D([], [], **_look(solvers.index(name), full=True)) for name in named]
    figure.legend(entries, named, loc="outside lower center", ncols=5, handlelength=3.2)
    return figure


def _look(place: int, full: bool) -> dict[str, Any]:
    """Colour, marker and line of a solver; hollow where its range is not asymptotic."""
    color = (*OURS, *THEIRS)[place]
    return {
        "color": color,
        "linestyle": LINE_STYLES[place % len(LINE_STYLES)],
        "marker": MARKERS_OF_SOLVERS[place],
        "markerfacecolor": color if full else "white",
        "markersize": 3.0,
        "linewidth": 0.9,
    }


def _draw(axes: Axes, row: OrderRow, place: int) -> Line2D:
    """Errors of one solver at each refinement: full where its range is asymptotic."""
    errors = np.maximum(row.refinement.errors, LOWEST)
    (line,) = axes.plot(range(len(errors)), errors, **_look(place, row.asymptotic))
    return line


def _label(axes: Axes, rows: Sequence[OrderRow], handles: dict[str, Any]) -> None:
    """The slopes, at the right end and as high as the last errors fitted, but not one upon another."""
    fitted = [row for row in rows if not math.isnan(row.fit.order)]
    height = math.log10(LOWEST) - NEAREST_LABELS
    for row in sorted(fitted, key=lambda row: float(row.refinement.errors[-1])):
        height = max(math.log10(max(row.refinement.errors[-1], LOWEST)), height + NEAREST_LABELS)
        told = f"{row.fit.order:.2f}" if row.asymptotic else f"({row.fit.order:.2f})"
        axes.text(
            RIGHT,
            10.0**height,
            told,
            fontsize=6,
            color=handles[row.solver].get_color(),
            va="center",
            clip_on=False,
        )
