"""The failure maps of one method or peer as a figure: a row of panels for each map, readable without colour."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Sequence
from typing import Any, NamedTuple

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, PathPatch
from matplotlib.path import Path as Outline
from matplotlib.patheffects import withStroke
from matplotlib.ticker import LogLocator, NullLocator, StrMethodFormatter
from numpy.typing import NDArray

from frictionlab.bench.failure_maps import OF_FRICTION_TO_LOAD, MapOutcome, MapTruth, edges, free_velocities
from frictionlab.bench.failures import FailureResult
from frictionlab.charts.maps import cell_edges
from frictionlab.charts.sheet import PAGE, blank_figure
from frictionlab.charts.sweeps import is_logarithmic
from frictionlab.values.columns import word
from frictionlab.values.quantities import Floats

_LEVELS = (1e-16, 1e-12, 1e-10, 1e-8, 1e-6, 1e-4, 1e-2, 1.0)
"""Of errors: a shade between two of them, darker for a smaller error."""
_WITHOUT_ERROR: dict[str, dict[str, Any]] = {
    "refused": {"facecolor": "white", "edgecolor": "0.6", "hatch": "////"},
    "failed": {"facecolor": "0.85", "edgecolor": "#b2182b", "hatch": "xxxx"},
    "not_unique": {"facecolor": "white", "edgecolor": "#762a83", "hatch": "||||"},
}
_UNKNOWN: dict[str, Any] = {"facecolor": "white", "edgecolor": "0.6"}
"""Where a number has no error to be shown."""
_UNDECIDED: dict[str, Any] = {"facecolor": "none", "edgecolor": "0.1", "hatch": "\\\\\\\\", "alpha": 0.45}
"""Where the distance from the reference is above the stated error, but not with the reference's own added."""
_PANEL, _LEGEND = 1.75, 1.1
"""Heights [inch] of a map and of what stands below all of them."""


class Mesh(NamedTuple):
    """Edges between the cells of a map, along both axes, and whether an axis is logarithmic."""

    x: Floats
    y: Floats
    logarithmic: tuple[bool, bool]


def failures_figure(result: FailureResult) -> Figure | None:
    """A row for each map that is not refused everywhere: stated error, where any is stated, and true error."""
    maps = [*zip(result.outcomes, result.truths, strict=True)]
    if not (shown := [each for each in maps if each[0].has_panel]):
        return None
    kinds = ["true"] if result.side == "peer" else ["stated", "true"]
    refused = _refused_everywhere([outcome for outcome, _ in maps if not outcome.has_panel])
    figure = blank_figure(PAGE, _PANEL * len(shown) + _LEGEND + 0.12 * refused.count("\n"))
    grid = figure.subplots(len(shown), len(kinds), squeeze=False)
    colors = ListedColormap(mpl.colormaps["viridis"](np.linspace(0.0, 0.97, len(_LEVELS) - 1)))
    mesh: Any = None
    for row, (outcome, truth) in zip(grid, shown, strict=True):
        for axes, kind in zip(row, kinds, strict=True):
            mesh = _draw(axes, outcome, truth, kind, colors)
            if axes is not row[0]:
                axes.tick_params(labelleft=False)
        row[0].set_ylabel(_across(outcome))
        row[0].set_title(_heading(outcome), loc="left", fontweight="bold")
    for axes, kind in zip(grid[0], kinds, strict=True):
        axes.set_title(f"{kind} error", loc="right")
    for axes in grid[-1]:
        axes.set_xlabel(word("scene.belt_speed"))
    bar = figure.colorbar(mesh, ax=grid, location="right", ticks=_LEVELS, shrink=min(1.0, 2.0 / len(shown)))
    bar.set_label("error of the mean friction")
    bar.ax.set_yticklabels([f"$10^{{{round(math.log10(level))}}}$" for level in _LEVELS])
    figure.legend(
        handles=_legend(), loc="outside lower center", ncols=4, title=refused or None, columnspacing=1.2
    )
    counts = result.counts()
    title = f"{result.title}: {counts.total():,} points, {counts['silent']:,} wrong without a word"
    figure.suptitle(title, x=0.01, ha="left", fontsize=8)
    return figure


def _heading(outcome: MapOutcome) -> str:
    silent = outcome.counts()["silent"]
    return f"{outcome.drawn.name}{f': {silent} wrong without a word' if silent else ''}"


def _refused_everywhere(outcomes: Sequence[MapOutcome]) -> str:
    """Maps without a panel, with the reason."""
    told = [f"{each.drawn.name}: refused at every point: {each.points[0].reason}" for each in outcomes]
    return "\n".join(line for each in told for line in textwrap.wrap(each, 110))


def _across(outcome: MapOutcome) -> str:
    drawn = outcome.drawn
    if drawn.quantity in OF_FRICTION_TO_LOAD:
        return "friction over load"
    kind, _, parameter = drawn.quantity.rpartition(".")
    return word(f"law.{parameter}" if kind.startswith("laws.") else drawn.quantity, 22)


def _draw(axes: Axes, outcome: MapOutcome, truth: MapTruth, kind: str, colors: ListedColormap) -> Any:
    drawn = outcome.drawn
    ordinates = np.array([drawn.ordinate(row) for row in drawn.rows])
    rising = np.argsort(ordinates)
    x, y = drawn.speeds, ordinates[rising]
    mesh = Mesh(cell_edges(x), cell_edges(y), (is_logarithmic(x), is_logarithmic(y)))
    grid = [outcome.grid[i] for i in rising]
    told = np.array([[point.outcome for point in row] for row in grid])
    errors = np.array([[getattr(point, kind) for point in row] for row in grid])
    number = np.isfinite(errors)
    shades = np.where(number, np.clip(errors, _LEVELS[0], 0.999), np.nan)
    drawn_mesh = axes.pcolormesh(
        mesh.x, mesh.y, shades, cmap=colors, norm=BoundaryNorm(_LEVELS, colors.N), rasterized=True
    )
    for name, look in _WITHOUT_ERROR.items():
        _hatch(axes, mesh, told == name, look)
    _hatch(axes, mesh, np.isin(told, ("ok", "silent")) & ~number, _UNKNOWN)
    if kind == "true":
        undecided = np.array([[point.undecided for point in row] for row in grid])
        _hatch(axes, mesh, undecided, _UNDECIDED)
    axes.set_xscale("log" if mesh.logarithmic[0] else "linear")
    axes.set_yscale("log" if mesh.logarithmic[1] else "linear")
    axes.set_xlim(mesh.x[0], mesh.x[-1])
    axes.set_ylim(mesh.y[0], mesh.y[-1])
    for axis, logarithmic in zip((axes.xaxis, axes.yaxis), mesh.logarithmic, strict=True):
        _number_ticks(axis, logarithmic)
    _draw_lines(axes, truth, rising)
    _cross_out(axes, drawn.speeds, ordinates[rising], told == "silent")
    _name_points(axes, outcome)
    return drawn_mesh


def _hatch(axes: Axes, mesh: Mesh, where: NDArray[np.bool_], look: dict[str, Any]) -> None:
    """One outline around all cells of a kind: neighbours along the belt speed joined."""
    boxes = [
        [(mesh.x[start], mesh.y[row]), (mesh.x[stop], mesh.y[row]), (mesh.x[stop], mesh.y[row + 1]),
         (mesh.x[start], mesh.y[row + 1]), (mesh.x[start], mesh.y[row])]
        for row, cells in enumerate(where)
        for start, stop in _runs(cells)
    ]  # fmt: skip
    if not boxes:
        return
    codes = [Outline.MOVETO, Outline.LINETO, Outline.LINETO, Outline.LINETO, Outline.CLOSEPOLY]
    outline = Outline(np.concatenate(boxes), np.tile(codes, len(boxes)))
    axes.add_patch(PathPatch(outline, linewidth=0.0, zorder=1.5, **look))


def _runs(cells: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """Where neighbours are true: first and one after the last."""
    changes = np.flatnonzero(np.diff(np.concatenate([[False], cells, [False]]).astype(int)))
    return list(zip(changes[::2].tolist(), changes[1::2].tolist(), strict=True))


_LINES: dict[str, dict[str, Any]] = {
    "free": {"color": "white", "linestyle": "solid", "label": "V_lin"},
    "reverses": {"color": "#fdae61", "linestyle": (0, (1, 1)), "label": "end of reversal"},
    "sticks": {"color": "#f768a1", "linestyle": (0, (4, 1.5)), "label": "stick window"},
    "unique": {
        "color": "#00ffff",
        "linestyle": (0, (6, 1.5, 1, 1.5)),
        "label": "one steady state proved: edge",
    },
    "rest": {"color": "#ffffbf", "linestyle": (0, (2, 2)), "label": "friction holds the load: edge"},
}
_OUTLINED = [withStroke(linewidth=2.4, foreground="black")]
"""Lines are seen on every shade."""


def _line(name: str) -> dict[str, Any]:
    look = {key: value for key, value in _LINES[name].items() if key != "label"}
    return look | {"linewidth": 1.1, "path_effects": _OUTLINED, "zorder": 3}


def _number_ticks(axis: Axis, logarithmic: bool) -> None:
    """No small ticks, and plain numbers on a logarithmic axis of few decades."""
    axis.set_minor_locator(NullLocator())
    low, high = axis.get_view_interval()
    if logarithmic and high < 100.0 * low:
        axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        axis.set_major_formatter(StrMethodFormatter("{x:g}"))


def _draw_lines(axes: Axes, truth: MapTruth, rising: NDArray[np.int64]) -> None:
    """Those of theory, and those that are read from the motion of the first reference."""
    speeds, ordinates = free_velocities(truth.drawn)
    axes.plot(speeds[rising], ordinates[rising], **(_line("free") | {"zorder": 3.5}))
    for name, ordinates_of_edge in edges(truth.drawn).items():
        for ordinate in ordinates_of_edge:
            axes.axhline(ordinate, **_line(name))
    for name, where in truth.motions().items():
        if (where == 0.0).any() and (where == 1.0).any():
            look = _line(name)
            border = axes.contour(
                truth.drawn.speeds, ordinates[rising], where[rising], levels=[0.5],
                colors=look["color"], linestyles=[look["linestyle"]], linewidths=look["linewidth"], zorder=3,
            )  # fmt: skip
            border.set(path_effects=_OUTLINED)


def _cross_out(axes: Axes, speeds: Floats, ordinates: Floats, silent: NDArray[np.bool_]) -> None:
    rows, columns = np.nonzero(silent)
    look: dict[str, Any] = {"marker": "x", "markersize": 4.0, "markeredgewidth": 1.0, "linestyle": "none"}
    if len(rows):
        axes.plot(
            speeds[columns],
            ordinates[rows],
            color="red",
            path_effects=_OUTLINED,
            zorder=4,
            rasterized=True,
            **look,
        )


def _name_points(axes: Axes, outcome: MapOutcome) -> None:
    """A ring at each named point, with its name, and a cross through one that is wrong without a word."""
    drawn = outcome.drawn
    for point, row, found in zip(drawn.points, drawn.named_rows, outcome.named, strict=True):
        at = (point.belt_speed, drawn.ordinate(row))
        silent = np.array([[found.outcome == "silent"]])
        _cross_out(axes, np.array(at[:1]), np.array(at[1:]), silent)
        axes.plot(*at, marker="o", markersize=3.5, markerfacecolor="white", markeredgecolor="black", zorder=5)
        axes.annotate(
            point.name, at, xytext=(4, 3), textcoords="offset points", fontsize=5.5, zorder=5,
            bbox={"boxstyle": "square,pad=0.1", "facecolor": "white", "edgecolor": "none", "alpha": 0.8},
        )  # fmt: skip


def _legend() -> list[Any]:
    words = {"refused": "refused", "failed": "failed", "not_unique": "not unique"}
    patches: list[Any] = [
        Patch(linewidth=0.4, label=words[name], **look) for name, look in _WITHOUT_ERROR.items()
    ]
    patches.append(Patch(linewidth=0.4, label="no error known", **_UNKNOWN))
    patches.append(Patch(linewidth=0.4, label="reference too coarse to tell", **_UNDECIDED))
    cross = Line2D([], [], marker="x", color="red", linestyle="none", path_effects=_OUTLINED, markersize=4)
    cross.set_label("wrong without a word")
    lines = [Line2D([], [], label=look["label"], **_line(name)) for name, look in _LINES.items()]
    return [*patches, cross, *lines]
