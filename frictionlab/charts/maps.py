"""Maps: a quantity over two swept numbers as shades with contours, in place of a line for each value.

The mean, its error where that can be seen beside it, and whatever else a figure shows, where belt speed is not swept,
or beside it a number of more values than lines can tell apart. Of two numbers beside belt speed the measures of the
curves: how far friction falls, and the area that decides on their shape.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.patheffects import withStroke
from matplotlib.ticker import MaxNLocator

from frictionlab.charts.curves import (
    MOST_PICTURES,
    SPEED_RATIO,
    CurveData,
    CurveNumbers,
    curves_of,
    drawn_once,
)
from frictionlab.charts.looks import LEGEND_MARKS, joined_methods, status_entries
from frictionlab.charts.sheet import NO_HEADING, Heading, Sheet, abreast, part_told
from frictionlab.charts.sweeps import (
    BESIDE,
    headings,
    is_logarithmic,
    linked_words,
    shortened,
    some_of,
    sweep_of,
)
from frictionlab.values.columns import BOUNDARIES, is_belt_speed, word

LEAST_VALUES = 5  # of both numbers: fewer are told apart by lines
MOST_SEPARATE = 12  # values of a number beside belt speed that are lines; more are a map
LABEL_ROOM = 0.16, 0.09  # of a label of such a line, in shares of a picture
LINE_PLACES = 400  # places along a line from a formula
RASTERIZED = 100  # cells: more are pixels in a drawing
OF_CURVES = "reduction", "shape_area"
MOST_LEVELS, LEVEL_EDGE = 6, 0.02  # of lines of equal value, and what they keep from the ends of the range
BOUNDARY_LINE: Any = {"color": "#b3123c", "linewidth": 1.8, "linestyle": "solid", "zorder": 4}
OUTLINE = withStroke(linewidth=2.8, foreground="white")
DARK_EDGE = withStroke(linewidth=2.2, foreground="0.2")
MEASURE_NAMES = {
    "error": "error bound of the mean",
    "reduction": "largest fall of mean friction\nbelow steady sliding",
    "shape_area": "area over the chord\n(> 0 concave, < 0 convex)",
}


BOUNDARY_WORDS = {"reduction": "fall of mean friction", "shape_area": "area over the chord"}


class MapValues(NamedTuple):
    """A column over two numbers: their values, and a row of the column for each of the second."""

    x: CurveNumbers
    y: CurveNumbers
    known: CurveNumbers


@dataclass(frozen=True)
class MapFigure:
    """Maps of some columns over the same two numbers, whose names in words may be longer than their own.

    left_out: pictures that are not drawn. v_lin: of inputs by their columns, None where they are not all there is.
    boundaries: lines of levels of the measures that the pictures show.
    """

    over: tuple[str, str]
    words: tuple[str, str]
    pictures: Sequence[CurveData]
    table: pd.DataFrame
    columns: Sequence[str] = ()
    left_out: int = 0
    v_lin: Callable[[Mapping[str, float | str]], float] | None = None
    boundaries: pd.DataFrame | None = None

    def draw(self, heading: Heading = NO_HEADING) -> Figure:
        """Return the figure, with matplotlib's settings as they are."""
        wide = abreast(len(self.pictures), heading, len(self.columns))
        each = -(-len(self.pictures) // wide) * wide  # a column begins on a line of its own
        sheet = Sheet.blank(each * len(self.columns), heading, self._entries())
        for number, column in enumerate(self.columns):
            places = [sheet.axes(number * each + at) for at in range(len(self.pictures))]
            self._draw(sheet.figure, places, column)
            sheet.label_once(places)
        return sheet.figure

    def _draw(self, figure: Figure, places: Sequence[Axes], column: str) -> None:
        """One column, in shades that mean the same in every picture."""
        grids = [self._grid(picture, column) for picture in self.pictures]
        norm = _norm(np.concatenate([grid.known.ravel() for grid in grids]))
        titles = headings([picture.panel for picture in self.pictures])
        for axes, picture, grid, told in zip(places, self.pictures, grids, titles, strict=True):
            mesh = _draw_shades(axes, grid, norm)
            if column != "error":  # which jumps from point to point
                _draw_contours(axes, grid, norm, self._solved_lines(picture, column))
            if self._along_speed:
                self._draw_v_lin(axes, picture)
            for _, line in self._solved_lines(picture, column).groupby(["level", "piece"]):
                axes.plot(*(line[name] for name in self.over), **BOUNDARY_LINE)
            self._mark_missing(axes, picture)
            axes.set(xlabel=self.words[0], ylabel=self.words[1])
            axes.spines[["top", "right"]].set_visible(True)
            axes.set_title(", ".join([*self._names(picture), *([told] if told else [])]), loc="left")
        bar = figure.colorbar(mesh, ax=list(places), pad=0.02, fraction=0.06)
        bar.set_label(MEASURE_NAMES.get(column) or word(column, 28))
        bar.outline.set_linewidth(0.5)

    def _grid(self, picture: CurveData, column: str) -> MapValues:
        x, y = (np.unique(picture.column(name)) for name in self.over)
        rows = picture.rows.sort_values([self.over[1], self.over[0]])
        return MapValues(x, y, rows[column].to_numpy(dtype=float).reshape(len(y), len(x)))

    def _draw_v_lin(self, axes: Axes, picture: CurveData) -> None:
        """Draw the line on which the belt runs at V_lin: from its formula, else through that of every row."""
        ratio = self._grid(picture, SPEED_RATIO)
        y, edges = ratio.y, cell_edges(ratio.y)
        with np.errstate(divide="ignore", invalid="ignore"):
            x = np.nanmedian(np.abs(ratio.x / ratio.known), axis=1)
        if self.v_lin is not None:
            fine = (np.geomspace if is_logarithmic(y) else np.linspace)(edges[0], edges[-1], LINE_PLACES)
            given = {name: value for name, value in picture.panel if value is not None}
            found = np.array([self.v_lin(given | {self.over[1]: float(at)}) for at in fine])
            x, y = (found, fine) if np.isfinite(found).any() else (x, y)
        axes.plot(x, y, color="white", linestyle="dashed", linewidth=1.1, path_effects=[DARK_EDGE])

    def _solved_lines(self, picture: CurveData, column: str) -> pd.DataFrame:
        """Return the lines of levels of a measure that were solved for, of the law and the method of a picture."""
        if self.boundaries is None:
            return pd.DataFrame(columns=[*BOUNDARIES])
        own = picture.rows_in(self.boundaries, (*BOUNDARIES, *self.over))
        return own[own["measure"] == column]

    def _mark_missing(self, axes: Axes, picture: CurveData) -> None:
        look: Any = {"linestyle": "none", "color": "0.3", "markersize": 3}
        for status, mark in LEGEND_MARKS.items() if "status" in picture.rows else ():
            if (there := picture.having(status)).any():
                axes.plot(*(picture.column(name)[there] for name in self.over), marker=mark, **look)

    @property
    def _along_speed(self) -> bool:
        return is_belt_speed(self.over[0]) and SPEED_RATIO in self.table

    def _names(self, picture: CurveData) -> list[str]:
        methods = [(each.method, *each.same) for each in self.pictures]
        named = [shortened(picture.law, BESIDE)] if len({each.law for each in self.pictures}) > 1 else []
        if len(set(methods)) > 1 or len(methods[0]) > 1:
            named.append(joined_methods((picture.method, *picture.same)))
        return named

    def _entries(self) -> list[Artist]:
        entries: list[Artist] = [*status_entries(self.table)] if "status" in self.table else []
        entries += part_told(len(self.pictures), len(self.pictures) + self.left_out, "maps")
        if any(picture.rows[column].isna().any() for picture in self.pictures for column in self.columns):
            entries.append(Patch(facecolor="white", edgecolor="0.3", linewidth=0.5, label="no number"))
        if self.boundaries is not None:
            of_shown = self.boundaries[self.boundaries["measure"].isin(self.columns)]
            for measure, level in of_shown[["measure", "level"]].drop_duplicates().itertuples(index=False):
                entries.append(
                    Line2D([], [], label=f"{BOUNDARY_WORDS[measure]} {level:g}, solved for", **BOUNDARY_LINE)
                )
        if self._along_speed:
            look: Any = {"color": "white", "linestyle": "dashed", "path_effects": [DARK_EDGE]}
            entries.append(Line2D([], [], label=r"belt speed $V_\mathrm{lin}$", **look))
        return entries


def map_of(table: pd.DataFrame) -> MapFigure | None:
    """Return the maps of a table; None where not two numbers take values enough.

    Along a sweep of belt speed that is a number of the scene whose values are more than lines can tell apart.
    """
    sweep = sweep_of(table)
    numbers = sweep.numbers
    if sweep.along is not None and is_belt_speed(sweep.along):
        others = [name for name in numbers if name != sweep.along]
        numbers = [*(name for name in others if table[name].nunique() > MOST_SEPARATE), sweep.along]
    return _figure(table, sweep.inputs, numbers)


def map_of_curves(curves: pd.DataFrame) -> MapFigure | None:
    """Return the maps of the measures of curves; None where not two numbers beside belt speed take values enough."""
    sweep = sweep_of(curves)
    found = _figure(curves, sweep.inputs, sweep.numbers)
    known = [name for name in OF_CURVES if name in curves and curves[name].notna().any()]
    return replace(found, columns=known) if found is not None and known else None


def _figure(table: pd.DataFrame, swept: Sequence[str], numbers: Sequence[str]) -> MapFigure | None:
    """Draw the maps over the last two numbers that every law has; None where they take too few values."""
    within = table.groupby("law")[list(numbers)].nunique()  # a law without a parameter has no map over it
    most = [name for name in numbers if name.startswith("scene.") or (within[name] > 1).all()]
    if len(most) < 2 or table[most[-2]].nunique() < LEAST_VALUES:
        return None
    y, x = most[-2:]
    pictures = curves_of(table, x, [name for name in swept if name not in (x, y)])
    if "status" in table:
        pictures = [picture for picture in pictures if not picture.having("refused").all()]
    sizes = [(len(each.rows), each.rows[x].nunique(), each.rows[y].nunique()) for each in pictures]
    # else a map is full of holes
    if not pictures or any(rows != m * n or min(m, n) < 2 for rows, m, n in sizes):
        return None
    if "error" in table:
        pictures = drawn_once(pictures, ["mean_friction"])
    drawn = some_of(pictures, MOST_PICTURES)
    words = linked_words(table, x, swept), linked_words(table, y, swept)
    return MapFigure((x, y), words, drawn, table, left_out=len(pictures) - len(drawn))


def _norm(values: CurveNumbers) -> Normalize:
    known = values[np.isfinite(values)]
    return Normalize(float(known.min()), float(known.max()))


def _draw_shades(axes: Axes, grid: MapValues, norm: Normalize) -> QuadMesh:
    edges = [cell_edges(values) for values in (grid.x, grid.y)]
    pixels = grid.known.size > RASTERIZED
    mesh = axes.pcolormesh(*edges, np.ma.masked_invalid(grid.known), norm=norm, rasterized=pixels)
    for values, scale in ((grid.x, axes.set_xscale), (grid.y, axes.set_yscale)):
        if is_logarithmic(values):
            scale("log")
    axes.set(xlim=edges[0][[0, -1]], ylim=edges[1][[0, -1]])
    return mesh


def _draw_contours(axes: Axes, grid: MapValues, norm: Normalize, solved: pd.DataFrame) -> None:
    """Labelled lines of equal value but for those that were solved for, zero a broad one."""
    low, high = float(norm.vmin or 0.0), float(norm.vmax or 0.0)
    few = min(grid.known.shape) < 2 or np.isfinite(grid.known).sum() < 4
    if few or not low < high:
        return
    edge = LEVEL_EDGE * (high - low)  # a plateau at an end differs from it by rounding
    levels = [at for at in MaxNLocator(MOST_LEVELS).tick_values(low, high) if low + edge < at < high - edge]
    levels = [at for at in levels if at not in set(solved["level"])]
    if not levels:
        return
    broad = [1.8 if at == 0.0 else 0.7 for at in levels]
    look: Any = {"colors": "0.1", "linewidths": broad, "linestyles": "solid"}
    lines = axes.contour(grid.x, grid.y, np.ma.masked_invalid(grid.known), levels, **look)
    lines.set(path_effects=[OUTLINE])
    kept: list[CurveNumbers] = []
    for label in axes.clabel(lines, fontsize=6, fmt="%.4g", inline=False):
        at = (axes.transScale + axes.transLimits).transform(label.get_position())
        if any((np.abs(at - other) < LABEL_ROOM).all() for other in kept):
            label.set_visible(False)
        else:
            kept.append(at)
            label.set(path_effects=[OUTLINE])


def cell_edges(values: CurveNumbers) -> CurveNumbers:
    """Return the edges of cells around these values, half way between neighbours."""
    steps = np.log(values) if is_logarithmic(values) else values
    half = 0.5 * np.diff(steps)
    edges = np.concatenate([[steps[0] - half[0]], steps[:-1] + half, [steps[-1] + half[-1]]])
    return np.exp(edges) if is_logarithmic(values) else edges
