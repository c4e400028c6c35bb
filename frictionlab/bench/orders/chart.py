"""The picture of orders: a panel a motion, errors against settings, the fitted slope at each line's end."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from frictionlab.bench.chart import HOLLOW, LINE_STYLES, MARKERS, OURS, save_figure
from frictionlab.bench.orders.section import OrderRow
from frictionlab.charts.figures import PAGE, STYLE

COLUMNS, PANEL = 3, 1.9
LOWEST = 1e-16
"""Errors below are drawn here."""


def draw_orders(rows: Sequence[OrderRow], folder: Path, stem: str) -> None:
    """Write the picture. Raises OSError."""
    with mpl.rc_context(STYLE):
        save_figure(orders_figure(rows), folder, stem)


def orders_figure(rows: Sequence[OrderRow]) -> Figure:
    """Small multiples: one panel a motion, one line a solver."""
    motions = list({row.motion.name: row.motion for row in rows}.values())
    solvers = list(dict.fromkeys(row.solver for row in rows))
    lines = math.ceil(len(motions) / COLUMNS)
    figure = Figure(figsize=(PAGE, PANEL * lines + 0.7), layout="constrained")
    FigureCanvasAgg(figure)
    panels = figure.subplots(lines, COLUMNS, squeeze=False, sharex=True, sharey=True)
    handles: dict[str, Any] = {}
    for axes, motion in zip(panels.flat, motions, strict=False):
        for row in (row for row in rows if row.motion is motion):
            handles[row.solver] = _draw(axes, row, solvers.index(row.solver))
        _dress(axes, f"{motion.title} ({motion.law_text})")
    for axes in panels.flat[len(motions) :]:
        axes.set_axis_off()
    figure.supxlabel("setting over its coarsest: step, smoothing width or tolerance", fontsize=8)
    figure.supylabel("error of the mean friction", fontsize=8)
    named = [name for name in solvers if name in handles]
    figure.legend(
        [handles[name] for name in named], named, loc="outside lower center", ncols=4, handlelength=3.2
    )
    return figure


def _draw(axes: Axes, row: OrderRow, place: int) -> Any:
    """Errors of one solver: full where its range is asymptotic, and its slope beside the last fitted setting."""
    sizes, errors = row.refinement.sizes, np.maximum(row.refinement.errors, LOWEST)
    color = OURS[place % len(OURS)]
    known = row.asymptotic
    look: dict[str, Any] = {
        "color": color,
        "linestyle": LINE_STYLES[place % len(LINE_STYLES)],
        "marker": (MARKERS if known else HOLLOW)[place % 6],
        "markerfacecolor": color if known else "white",
        "linewidth": 0.9,
    }
    (line,) = axes.plot(sizes / sizes[0], errors, **look)
    if not math.isnan(row.fit.order):
        last = row.fit.last
        told = f"{row.fit.order:.2f}" if known else f"({row.fit.order:.2f})"
        axes.annotate(
            told, (sizes[last] / sizes[0], errors[last]), xytext=(3, 2), textcoords="offset points", fontsize=6,
            color=color,
        )  # fmt: skip
    return line


def _dress(axes: Axes, title: str) -> None:
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_ylim(LOWEST, 1.0)
    axes.invert_xaxis()
    axes.grid(which="major", color="0.9", linewidth=0.5)
    axes.set_axisbelow(True)
    axes.set_title(title, loc="left", fontsize=7)
