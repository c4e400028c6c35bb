"""Figures of a bench: settings as lines and markers, points of maps as cells; readable without colour."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import matplotlib as mpl
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.colors import BoundaryNorm, ListedColormap, LogNorm
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.patheffects import withStroke
from matplotlib.ticker import LogLocator, NullLocator, StrMethodFormatter
from numpy.typing import NDArray

from frictionlab.bench.texts import remark, who
from frictionlab.charts.maps import cell_edges
from frictionlab.charts.sheet import PAGE, blank_figure
from frictionlab.charts.sweeps import is_logarithmic
from frictionlab.values.columns import word
from frictionlab.values.quantities import Floats

Look = dict[str, Any]
Mask = NDArray[np.bool_]
OURS = ("#08306b", "#7f0000", "#00441b", "#4a1486", "#662506", "#252525")
THEIRS = ("#e6550d", "#31a354", "#756bb1", "#858585")
LINE_STYLES = ("solid", (0, (5, 1.5)), (0, (1, 1.2)), (0, (5, 1.5, 1, 1.5)))
MARKERS, HOLLOW = "osD^v<>phPX*", "oshdPX"
TIME = r"time per point [$\mathrm{\mu s}$]"
LETTERS = 36
"""On a line of the legend."""


def _look(place: int, color: str, full: bool, **other: Any) -> Look:
    """Marker and line of the solver at this place, hollow or full."""
    look = {"color": color, "markerfacecolor": color if full else "white", "markersize": 4.5}
    look |= {"marker": MARKERS[place % len(MARKERS)], "linestyle": LINE_STYLES[place % len(LINE_STYLES)]}
    return look | other


def _dress(axes: Axes, title: str, scales: str = "log log", **look: Any) -> None:
    """A title at the left, a pale grid behind, and the scales of both axes."""
    axes.set_title(title, loc="left", **look)
    axes.grid(which="major", color="0.9", linewidth=0.5)
    axes.set_axisbelow(True)
    x, y = scales.split()
    axes.set_xscale(x)
    axes.set_yscale(y)


# --- error against time: curves and models ------------------------------------------------------------------------


def curve_figure(title: str, table: pd.DataFrame, known: float) -> Figure:
    """Times and errors of every contender: methods dark and full, peers light and hollow."""
    figure, entries, seen = blank_figure(PAGE, 3.0), [], {"method": 0, "peer": 0}
    axes = figure.add_subplot()
    for _, own in table.groupby("solver", sort=False) if len(table) else ():
        side = own["side"].iloc[0]
        colors, markers = (OURS, MARKERS[:7]) if side == "method" else (THEIRS, HOLLOW)
        n = seen[side]
        seen[side] += 1
        marker = {"marker": markers[n % len(markers)]}
        look = _look(n, colors[n % len(colors)], side == "method", **marker)
        drawn = _draw_settings(axes, own, look, 1e-17)
        for _, row in drawn.iterrows():
            ends = [row["mean_us"], row["all_us"]]
            axes.plot(ends, [row["y"]] * 2, color=look["color"], linewidth=0.5)
        entries.append(_entry(_told(own), look | ({"linestyle": "none"} if drawn.empty else {})))
    lines = sum(str(entry.get_label()).count("\n") + 1.4 for entry in entries)
    figure.set_figheight(max(3.0, 0.4 + 0.11 * lines))
    axes.set_xlabel(f"{TIME}; thin: with every other column; dotted: a model without its error")
    axes.set_ylabel("largest error of the mean friction")
    _dress(axes, title, fontweight="bold")
    low, high = axes.get_ylim()
    if low < known:  # errors below those of the references cannot be told apart
        axes.axhspan(low, known, color="0.93", zorder=0)
        axes.set_ylim(low, high)
    figure.legend(handles=entries, loc="outside right upper", handlelength=3.2)
    return figure


def _draw_settings(axes: Axes, own: pd.DataFrame, look: Look, least: float) -> pd.DataFrame:
    """A marker for each setting of a solver that has an error, a cross where points are missing; those drawn.

    A dotted tail leads to what a reduced model costs without its error. Smaller errors are drawn at the least.
    """
    drawn = own.dropna(subset=["largest_error", "mean_us"])
    drawn = drawn.assign(y=drawn["largest_error"].clip(lower=least))
    if not drawn.empty:
        axes.plot(drawn["mean_us"], drawn["y"], **look)
    alone = look | {"marker": "|", "linestyle": (0, (1, 1.5)), "linewidth": 0.9, "markevery": [0]}
    for _, row in drawn.dropna(subset="model_us").iterrows():
        axes.plot([row["model_us"], row["mean_us"]], [row["y"]] * 2, **alone)
    partly = drawn[drawn["ok"] < drawn["points"]]
    if not partly.empty:
        axes.plot(partly["mean_us"], partly["y"], marker="x", markersize=8, color="0.2", linestyle="none")
    return drawn


def _told(own: pd.DataFrame) -> str:
    """A solver in the legend, with what has no number: at how many settings, where it is not all of them."""
    without = next(filter(None, map(remark, own.to_dict("records"))), "")
    missing = int((own["ok"] < own["points"]).sum())
    share = "" if missing in (0, len(own)) else f"at {missing} of {len(own)} settings (x) "
    text = who(own.iloc[0])
    if not without:
        return text
    told = textwrap.shorten(f"{text}; {share}{without}", 3 * LETTERS - 12, placeholder=" ...")
    return "\n".join(textwrap.wrap(told, LETTERS))


FRONT: Look = {"color": "0.55", "linewidth": 3.0, "alpha": 0.45, "zorder": 1, "solid_capstyle": "round"}


def models_figure(title: str, table: pd.DataFrame, best: pd.DataFrame, known: float) -> Figure:
    """Models told apart by colour and by filling, methods by marks; errors below what is known stand on that."""
    figure = blank_figure(PAGE, 3.4)
    axes = figure.add_subplot()
    models, methods = list(table["model"].unique()), list(table["solver"].unique())
    for (model, method), own in table.groupby(["model", "solver"], sort=False):
        _draw_settings(axes, own, _model_look(models.index(model), methods.index(method)), known)
    _dress(axes, textwrap.fill(title, 56), fontweight="bold")
    _draw_front(axes, best.assign(y=best["largest_error"].clip(lower=known)))
    axes.set_xlabel(TIME)
    axes.set_ylabel(f"largest distance from {models[0]}")
    axes.axhspan(1e-3 * known, known, color="0.93", zorder=0)
    axes.set_ylim(0.1 * known)
    axes.set_xlim(0.2 * axes.get_xlim()[0])  # room for the name of the cheapest
    seen = {*table.loc[table["largest_error"].notna(), "solver"]}
    entries = [_entry(model, _model_look(k, 0)) for k, model in enumerate(models)]
    entries += [_entry(" ", {"linestyle": "none"})]
    for k, method in enumerate(methods):
        label = method if method in seen else f"{method}: refused"
        entries += [_entry(label, _look(k, "0.3", True, linestyle="none"))]
    entries += [_entry("front", FRONT)]
    figure.legend(handles=entries, loc="outside right upper")
    return figure


def _model_look(model: int, method: int) -> Look:
    full = model % 2 == 0
    line = {"linewidth": 0.8, "linestyle": "solid" if full else (0, (4, 1.5))}
    return _look(method, OURS[model % len(OURS)], full, **line)


def _draw_front(axes: Axes, best: pd.DataFrame) -> None:
    """A stair through the front, its points by name: what is left of it is cheaper, what is below is nearer."""
    if not best.empty:
        axes.step(best["mean_us"], best["y"], where="post", **FRONT)
    look: Look = {"fontsize": 5.5, "ha": "right", "va": "top", "color": "0.25"}
    for _, row in best.drop_duplicates(["model", "solver"]).iterrows():  # finer settings follow on its line
        name = f"{row['model']}\n{row['solver']}"
        axes.annotate(name, (row["mean_us"], row["y"]), (-4.0, -4.0), textcoords="offset points", **look)


# --- error against setting: orders --------------------------------------------------------------------------------

LOWEST = 1e-16
"""Errors below are drawn here."""
RIGHT = 9.7
"""Places of the slopes."""
NEAREST_LABELS = 1.3
"""Powers of ten between two numbers at the right end."""


def orders_figure(table: pd.DataFrame) -> Figure:
    """Draw a panel for each motion, a line for each solver: its errors, hollow where they are not asymptotic."""
    solvers, motions = list(table["solver"].unique()), table.groupby("title", sort=False)
    high = math.ceil(len(motions) / 3)
    figure = blank_figure(PAGE, 1.95 * high + 0.6)
    panels = figure.subplots(high, 3, squeeze=False, sharex=True, sharey=True)
    looks, small = dict[str, Look](), {"markersize": 3.0, "linewidth": 0.9}
    for k, solver in enumerate(solvers):
        looks[solver] = _look(k, (*OURS, *THEIRS)[k], True, marker="osD^v<>ph"[k], **small)
    for axes, (title, own) in zip(panels.flat, motions, strict=False):
        for _, row in own.iterrows():
            hollow = {} if row["asymptotic"] == "yes" else {"markerfacecolor": "white"}
            axes.plot(np.maximum(row["errors"], LOWEST), **(looks[row["solver"]] | hollow))
        _label_slopes(axes, own, looks)
        _dress(axes, title, "linear log", fontsize=7)
        axes.set_ylim(0.3 * LOWEST, 3.0)
        axes.set_xlim(-0.3, RIGHT - 0.2)
    for axes in panels.flat[len(motions) :]:
        axes.set_axis_off()
    for shown in ([axes for axes in column if axes.axison] for column in panels.T):
        for axes in shown[-1:]:
            axes.set_xlabel("refinements")
            axes.tick_params(labelbottom=True)
    figure.supylabel("error of the mean friction", fontsize=8)
    entries = [_entry(solver, look) for solver, look in looks.items()]
    figure.legend(handles=entries, loc="outside lower center", ncols=5, handlelength=3.2)
    return figure


def _label_slopes(axes: Axes, own: pd.DataFrame, looks: Mapping[str, Look]) -> None:
    """Write the slopes, at the right end and as high as the last errors fitted, but not one upon another."""
    height = math.log10(LOWEST) - NEAREST_LABELS
    fitted = own.dropna(subset="order").assign(end=lambda rows: [errors[-1] for errors in rows["errors"]])
    for _, row in fitted.sort_values("end", kind="stable").iterrows():
        height = max(math.log10(max(row["end"], LOWEST)), height + NEAREST_LABELS)
        told = f"{row['order']:.2f}" if row["asymptotic"] == "yes" else f"({row['order']:.2f})"
        color = looks[row["solver"]]["color"]
        axes.text(RIGHT, 10.0**height, told, fontsize=6, color=color, va="center", clip_on=False)


# --- cells of a map: stability and failures -----------------------------------------------------------------------

_OUTLINED = [withStroke(linewidth=2.4, foreground="black")]
"""Lines are seen on every shade."""


def _hatch(
    axes: Axes, x: Floats, y: Floats, where: Mask, edgecolor: str, facecolor: str = "none", hatch: str = ""
) -> None:
    """Mark all cells of a kind between these edges."""
    if where.any():
        cells, (x, y) = where.repeat(2, axis=0).repeat(2, axis=1), (x.repeat(2)[1:-1], y.repeat(2)[1:-1])
        marked = axes.contourf(x, y, cells, [0.5, 1.5], colors=[facecolor], hatches=[hatch], zorder=1.5)
        marked.set(edgecolor=edgecolor, linewidth=0.0)


def _entry(label: str, look: Look) -> Line2D:
    """A line of a legend."""
    return Line2D([], [], label=label, **look)


CROSS: Look = {"marker": "x", "markersize": 4.0, "color": "red", "linestyle": "none", "zorder": 4}
CROSS |= {"path_effects": _OUTLINED, "rasterized": True}
"""At a point that is wrong without a word."""
BEST, WORST = 1e-9, 1.0
"""Errors beyond are drawn as these."""
MEASURED_DOTS = 12
NEAR_LIMIT = 0.85
"""Steps that adapt hover about the limit: drawn is where they first come so near."""
LIMIT: Look = {"linestyles": "dashed", "colors": "red", "linewidths": 1.2}
DOT: Look = {"color": "white", "marker": "o", "markersize": 2.5, "linestyle": "none"}
DOT |= {"markeredgecolor": "red", "markeredgewidth": 0.6}


def stability_figure(title: str, table: pd.DataFrame) -> Figure | None:
    """A panel a problem: true error as colour, its regions, and the limits of the step."""
    if table.empty:
        return None
    maps = table.groupby("problem", sort=False)
    figure = blank_figure(min(PAGE, 2.6 * len(maps) + 1.2), 2.9)
    panels = figure.subplots(1, len(maps), squeeze=False)[0]
    for axes, (_, points) in zip(panels, maps, strict=True):
        colors = _draw_stability(axes, points)
    figure.colorbar(colors, ax=list(panels), label="true error of the mean friction", extend="both", pad=0.01)
    figure.suptitle(title, x=0.01, ha="left", fontsize=8, fontweight="bold")
    figure.legend(handles=_stability_legend(table), loc="outside lower center", ncols=2, handlelength=2.6)
    return figure


def _draw_stability(axes: Axes, points: pd.DataFrame) -> Any:
    first, x = points.iloc[0], points["value"].unique()
    cells = {name: points[name].to_numpy().reshape(-1, len(x)) for name in points}
    y, steps = cells["rate"][:, 0], first["setting"] == "steps"
    errors, mesh = np.ma.masked_invalid(np.clip(cells["error"], BEST, WORST)), (cell_edges(x), cell_edges(y))
    colors = axes.pcolormesh(*mesh, errors, norm=LogNorm(BEST, WORST), cmap="cividis", rasterized=True)
    _hatch(axes, *mesh, cells["region"] == "wrong_and_said", "black", hatch="////")
    silent = points[points["region"] == "wrong_and_silent"]
    axes.plot(silent["value"], silent["rate"], **(CROSS | {"markersize": 2.2}))
    axes.set(facecolor="0.85", xscale="log", yscale="log", ylim=(y.min(), y.max()))
    axes.set_xlim(*(x.max(), x.min()) if steps else (x.min(), x.max()))
    axes.set_xlabel("steps per period (longer steps to the right)" if steps else "tolerance")
    axes.set_ylabel(f"local rate: {first['rate_text']}")
    axes.set_title(first["title"], loc="left", fontsize=7)
    if math.isfinite(predicted := first["predicted_limit"]):
        reach, measured = cells["step_times_rate"] / (1.0 if steps else NEAR_LIMIT), first["measured_limit"]
        axes.contour(x, y, reach, [predicted], **LIMIT)
        found = axes.contour(x, y, reach, [measured if measured > 0.0 else predicted], linewidths=0.0)
        for dots in filter(len, (np.asarray(path.vertices) for path in found.get_paths())):
            axes.plot(*dots[:: max(1, len(dots) // MEASURED_DOTS)].T, **DOT)
    if math.isfinite(first["held_limit"]):
        axes.contour(x, y, cells["held"], [first["held_limit"]], **(LIMIT | {"linestyles": "dotted"}))
    return colors


def _stability_legend(table: pd.DataFrame) -> list[Any]:
    """Return the entries for what the pictures of a solver hold."""
    told_so = Patch(facecolor="white", edgecolor="0.2", hatch="////", label="wrong, and told so")
    entries: list[Any] = [told_so, _entry("wrong without a word", CROSS)]
    if np.isfinite(table["predicted_limit"]).any():
        near = "" if table["setting"].iloc[0] == "steps" else f"{NEAR_LIMIT:g} of "
        told = f"step times rate at {near}its limit, predicted"
        entries += [_entry(told, {"color": "red", "linestyle": "dashed"}), _entry("measured", DOT)]
    if np.isfinite(table["held_limit"]).any():
        told = "limit of a mass held by its bristles"
        entries += [_entry(told, {"color": "red", "linestyle": "dotted"})]
    return entries


_LEVELS = (1e-16, 1e-12, 1e-10, 1e-8, 1e-6, 1e-4, 1e-2, 1.0)
"""Edges of errors: a shade between two of them, darker for a smaller error."""
_WITHOUT_ERROR: dict[str, Look] = {
    "refused": {"facecolor": "white", "edgecolor": "0.6", "hatch": "////"},
    "failed": {"facecolor": "0.85", "edgecolor": "#b2182b", "hatch": "xxxx"},
    "not unique": {"facecolor": "white", "edgecolor": "#762a83", "hatch": "||||"},
    "no error known": {"facecolor": "white", "edgecolor": "0.6"},
    "reference too coarse to tell": {"facecolor": "none", "edgecolor": "0.5", "hatch": "\\\\\\\\"},
}
"""Marks of cells without shade; in the last the distance to the reference is above the stated error, but not with the
reference's own added."""
_LINES: dict[str, Look] = {
    "V_lin": {"color": "white", "linestyle": "solid"},
    "end of reversal": {"color": "#fdae61", "linestyle": (0, (1, 1))},
    "stick window": {"color": "#f768a1", "linestyle": (0, (4, 1.5))},
    "one steady state proved: edge": {"color": "#00ffff", "linestyle": (0, (6, 1.5, 1, 1.5))},
    "friction holds the load: edge": {"color": "#ffffbf", "linestyle": (0, (2, 2))},
}
_LINE: Look = {"linewidth": 1.1, "path_effects": _OUTLINED, "zorder": 3}


class FailurePicture(NamedTuple):
    """Map to be drawn: its grid, a row for each ordinate, which ascend, and its named points.

    across: what the ordinates are. free: V_lin at each. edges: ordinates by what changes there; borders: where on the
    grid something is so, NaN where that is not known.
    """

    name: str
    across: str
    x: Floats
    y: Floats
    grid: pd.DataFrame
    named: pd.DataFrame
    free: Floats
    edges: Mapping[str, Sequence[float]]
    borders: Mapping[str, Floats]


def failures_figure(
    title: str, maps: Sequence[FailurePicture], kinds: Sequence[str], below: str
) -> Figure | None:
    """A row for each map, a panel for each kind of error; below: text over the legend."""
    if not maps:
        return None
    figure = blank_figure(PAGE, 1.75 * len(maps) + 1.1 + 0.12 * below.count("\n"))
    panels = figure.subplots(len(maps), len(kinds), squeeze=False)
    colors = ListedColormap(mpl.colormaps["viridis"](np.linspace(0.0, 0.97, len(_LEVELS) - 1)))
    mesh: Any = None
    for row, drawn in zip(panels, maps, strict=True):
        for axes, kind in zip(row, kinds, strict=True):
            mesh = _draw_failures(axes, drawn, kind, colors)
            axes.tick_params(labelleft=axes is row[0])
        row[0].set_ylabel(drawn.across)
        silent = int((pd.concat([drawn.grid, drawn.named])["outcome"] == "silent").sum())
        told = f": {silent} wrong without a word" if silent else ""
        row[0].set_title(f"{drawn.name}{told}", loc="left", fontweight="bold")
    for above, lowest, kind in zip(panels[0], panels[-1], kinds, strict=True):
        above.set_title(f"{kind} error", loc="right")
        lowest.set_xlabel(word("scene.belt_speed"))
    bar = figure.colorbar(mesh, ax=panels, location="right", ticks=_LEVELS, shrink=min(1.0, 2.0 / len(maps)))
    bar.set_label("error of the mean friction")
    bar.ax.set_yticklabels([f"$10^{{{round(math.log10(level))}}}$" for level in _LEVELS])
    look = {"ncols": 4, "columnspacing": 1.2, "title": below or None}
    figure.legend(handles=_failures_legend(), loc="outside lower center", **look)
    figure.suptitle(title, x=0.01, ha="left", fontsize=8)
    return figure


def _failures_legend() -> list[Any]:
    entries: list[Any] = [Patch(linewidth=0.4, label=name, **look) for name, look in _WITHOUT_ERROR.items()]
    entries += [_entry("wrong without a word", CROSS)]
    return entries + [_entry(name, look | _LINE) for name, look in _LINES.items()]


def _draw_failures(axes: Axes, drawn: FailurePicture, kind: str, colors: ListedColormap) -> Any:
    x, y = cell_edges(drawn.x), cell_edges(drawn.y)
    cells = {name: drawn.grid[name].to_numpy().reshape(len(drawn.y), -1) for name in drawn.grid}
    errors, outcome = cells[f"{kind}_error"], cells["outcome"]
    shades = np.where(np.isfinite(errors), np.clip(errors, _LEVELS[0], 0.999), np.nan)
    norm = BoundaryNorm(_LEVELS, colors.N)
    mesh = axes.pcolormesh(x, y, shades, cmap=colors, norm=norm, rasterized=True)
    told = {"no error known": np.isin(outcome, ("ok", "silent")) & ~np.isfinite(errors)}
    if kind == "true":
        undecided = (outcome == "ok") & (cells["stated_error"] < cells["true_error"])
        told["reference too coarse to tell"] = undecided
    for name, look in _WITHOUT_ERROR.items():
        _hatch(axes, x, y, told.get(name, outcome == name.replace(" ", "_")), **look)
    for name, values, edges in (("x", drawn.x, x), ("y", drawn.y, y)):
        log = is_logarithmic(values)
        axes.set(**{f"{name}scale": "log" if log else "linear", f"{name}lim": (edges[0], edges[-1])})
        _number_ticks(getattr(axes, f"{name}axis"), log)
    _draw_theory(axes, drawn)
    rows, columns = np.nonzero(outcome == "silent")
    axes.plot(drawn.x[columns], drawn.y[rows], **CROSS)
    _name_points(axes, drawn.named)
    return mesh


def _draw_theory(axes: Axes, drawn: FailurePicture) -> None:
    """Lines of theory, and those that are read from the motion of the first reference."""
    axes.plot(drawn.free, drawn.y, **(_LINES["V_lin"] | _LINE | {"zorder": 3.5}))
    for name, ordinate in ((name, each) for name, found in drawn.edges.items() for each in found):
        axes.axhline(ordinate, **(_LINES[name] | _LINE))
    for name, where in drawn.borders.items():
        if (where == 0.0).any() and (where == 1.0).any():
            look: Look = {f"{key}s": [value] for key, value in _LINES[name].items()}
            border = axes.contour(drawn.x, drawn.y, where, levels=[0.5], linewidths=1.1, zorder=3, **look)
            border.set(path_effects=_OUTLINED)


def _number_ticks(axis: Axis, logarithmic: bool) -> None:
    """No small ticks, and plain numbers on a logarithmic axis of few decades."""
    axis.set_minor_locator(NullLocator())
    low, high = axis.get_view_interval()
    if logarithmic and high < 100.0 * low:
        axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        axis.set_major_formatter(StrMethodFormatter("{x:g}"))


def _name_points(axes: Axes, named: pd.DataFrame) -> None:
    """A ring at each named point, with its name, and a cross through one that is wrong without a word."""
    box = {"boxstyle": "square,pad=0.1", "facecolor": "white", "edgecolor": "none", "alpha": 0.8}
    ring: Look = {"marker": "o", "markersize": 3.5, "markerfacecolor": "white", "markeredgecolor": "black"}
    for _, point in named.iterrows():
        at = (point["belt_speed"], point["ordinate"])
        if point["outcome"] == "silent":
            axes.plot(*at, **CROSS)
        axes.plot(*at, zorder=5, **ring)
        look: Look = {"textcoords": "offset points", "fontsize": 5.5, "zorder": 5, "bbox": box}
        axes.annotate(point["point"], at, xytext=(4, 3), **look)
