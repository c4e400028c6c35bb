"""The picture of orders: a panel a motion, errors against settings, the fitted slope at each line's end.

The picture of a stability map: true error as colour, its regions, and the limits of the step.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from frictionlab.bench.charts.curve import LINE_STYLES, OURS, THEIRS, dress
from frictionlab.bench.orders import OrderRow, OrdersResult
from frictionlab.bench.stability import StabilityResult
from frictionlab.bench.stability_grid import StabilityMap, StepLimit
from frictionlab.charts.sheet import PAGE, blank_figure

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


MAP_HEIGHT, WIDEST_MAP = 2.9, 2.6
BEST, WORST = 1e-9, 1.0
"""Errors beyond are drawn as these."""
COLORS_OF_ERRORS = "cividis"
"""Told apart by the colour-blind, and in grey: dark is right."""
MEASURED_DOTS = 12
NEAR_LIMIT = 0.85
"""Steps that adapt hover about the limit: drawn is where they first come so near."""


def stability_figure(result: StabilityResult) -> Figure | None:
    """A panel a problem."""
    if not (maps := result.maps):
        return None
    figure = blank_figure(min(PAGE, WIDEST_MAP * len(maps) + 1.2), MAP_HEIGHT)
    panels = figure.subplots(1, len(maps), squeeze=False)[0]
    for axes, drawn in zip(panels, maps, strict=True):
        colors = _draw_map(axes, drawn)
    figure.colorbar(colors, ax=list(panels), label="true error of the mean friction", extend="both", pad=0.01)
    figure.suptitle(result.title, x=0.01, ha="left", fontsize=8, fontweight="bold")
    figure.legend(handles=_legend(maps), loc="outside lower center", ncols=2, handlelength=2.6)
    return figure


def _draw_map(axes: Axes, drawn: StabilityMap) -> Any:
    """One panel; rates as they were found at the points."""
    x, shape = np.array(drawn.settings), (len(drawn.rates), len(drawn.settings))
    rates = np.array([point.rate for point in drawn.points]).reshape(shape)[:, 0]
    errors = np.array([point.error for point in drawn.points]).reshape(shape)
    said = np.array([point.region == "wrong_and_said" for point in drawn.points]).reshape(shape)
    colors = axes.pcolormesh(
        x,
        rates,
        np.ma.masked_invalid(np.clip(errors, BEST, WORST)),
        norm=mpl.colors.LogNorm(BEST, WORST),
        cmap=COLORS_OF_ERRORS,
        shading="nearest",
        rasterized=True,
    )
    axes.set_facecolor("0.85")
    if said.any():
        axes.contourf(x, rates, said.astype(float), [0.5, 1.5], colors="none", hatches=["////"])
    silent = [point for point in drawn.points if point.region == "wrong_and_silent"]
    for color, width in (("black", 1.5), ("white", 0.6)):  # seen on dark and on light
        axes.plot(
            [point.value for point in silent],
            [point.rate for point in silent],
            color=color,
            marker="x",
            markersize=2.2,
            markeredgewidth=width,
            linestyle="none",
            rasterized=True,
        )
    _draw_limits(axes, drawn, x, rates)
    _dress_axes(axes, drawn, x, rates)
    return colors


def _dress_axes(axes: Axes, drawn: StabilityMap, x: Any, rates: Any) -> None:
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlim(x.min(), x.max())
    axes.set_ylim(rates.min(), rates.max())
    if drawn.setting == "steps":
        axes.invert_xaxis()
    axes.set_xlabel(
        "steps per period (longer steps to the right)" if drawn.setting == "steps" else "tolerance"
    )
    axes.set_ylabel(f"local rate: {drawn.problem.rate_text}")
    axes.set_title(drawn.problem.title, loc="left", fontsize=7)


def _draw_limits(axes: Axes, drawn: StabilityMap, x: Any, rates: Any) -> None:
    """Where the step taken is as long as the limit, or as near as steps that adapt stay to it."""
    limit, shape = drawn.limit, (len(rates), len(x))
    reach = np.array([point.step * point.rate for point in drawn.points]).reshape(shape)
    if math.isfinite(limit.predicted):
        share = 1.0 if drawn.setting == "steps" else NEAR_LIMIT
        _contour(axes, x, rates, reach / share, limit)
    if math.isfinite(limit.held):
        held = np.array([point.held for point in drawn.points]).reshape(shape)
        axes.contour(x, rates, held, [limit.held], colors="red", linestyles="dotted", linewidths=1.2)


def _contour(axes: Axes, x: Any, rates: Any, reach: Any, limit: StepLimit) -> None:
    drawn = axes.contour(
        x, rates, reach, [limit.predicted], colors="red", linestyles="dashed", linewidths=1.2
    )
    measured = (
        axes.contour(x, rates, reach, [limit.measured], linewidths=0.0) if limit.measured > 0.0 else drawn
    )
    for path in measured.get_paths():
        points = np.asarray(path.vertices)
        if len(points):
            every = max(1, len(points) // MEASURED_DOTS)
            axes.plot(*points[::every].T, color="white", marker="o", markersize=2.5, markeredgecolor="red",
                      markeredgewidth=0.6, linestyle="none")  # fmt: skip


def _legend(maps: Sequence[StabilityMap]) -> list[Any]:
    """What the pictures of these maps hold."""
    entries: list[Any] = [
        Patch(facecolor="white", edgecolor="0.2", hatch="////", label="wrong, and told so"),
        Line2D([], [], color="black", marker="x", linestyle="none", label="wrong without a word"),
    ]
    if any(math.isfinite(drawn.limit.predicted) for drawn in maps):
        steps = maps[0].setting == "steps"
        told = "step times rate at its limit" if steps else f"step times rate at {NEAR_LIMIT:g} of its limit"
        told += ", predicted"
        entries.append(Line2D([], [], color="red", linestyle="dashed", label=told))
        entries.append(
            Line2D([], [], color="white", marker="o", markeredgecolor="red", markersize=3, linestyle="none",
                   label="measured")
        )  # fmt: skip
    if any(math.isfinite(drawn.limit.held) for drawn in maps):
        entries.append(
            Line2D([], [], color="red", linestyle="dotted", label="limit of a mass held by its bristles")
        )
    return entries
