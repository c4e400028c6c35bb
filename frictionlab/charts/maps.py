"""Maps: a quantity over two swept numbers as shades with contours, in place of a line for each value.

The mean, its error and whatever else a figure shows, where belt speed is not swept, or beside it a number of more
values than lines can tell apart. Of two numbers beside belt speed the measures of the curves: how far friction falls,
and the area that decides on their shape.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.colors import LogNorm, Normalize
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.patheffects import withStroke
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from frictionlab.charts.curves import (
    LEAST_VISIBLE,
    MOST_PICTURES,
    SweptValue,
    along_the_axis,
    is_logarithmic,
    linked_words,
    some_of,
    swept_columns,
    swept_numbers,
    swept_value,
)
from frictionlab.charts.derived import SPEED_RATIO
from frictionlab.charts.legend import LEGEND_MARKS, status_entries
from frictionlab.charts.style import LINE, PANEL_HEIGHT, blank_figure, page_of
from frictionlab.charts.words import BESIDE, label_once, sentence, shortened, write_title
from frictionlab.columns import BELT_SPEEDS, word
from frictionlab.study.figure_options import USUAL_FIGURES, FigureOptions

LEAST_VALUES = 5  # of both numbers: fewer are told apart by lines
MOST_SEPARATE = 12  # values of a number beside belt speed that are lines; more are a map
LABEL_ROOM = 0.16, 0.09  # of a label of such a line, in shares of a picture
RASTERIZED = 100  # cells: more are pixels in a drawing
OF_CURVES = "reduction", "shape_area"
MOST_LEVELS, LEVEL_EDGE = 6, 0.02  # of lines of equal value, and what they keep from the ends of the range
OUTLINE = withStroke(linewidth=2.8, foreground="white")
DARK_EDGE = withStroke(linewidth=2.2, foreground="0.2")
MEASURE_NAMES = {
    "error": "error bound of the mean",
    "reduction": "largest fall of mean friction\nbelow steady sliding",
    "shape_area": "area over the chord\n(> 0 concave, < 0 convex)",
}


@dataclass(frozen=True)
class MapPicture:
    """The rows of one map: a law, the methods that all have this map, and the further values that select it."""

    law: str
    methods: tuple[str, ...]
    settings: tuple[SweptValue, ...]
    rows: pd.DataFrame

    def over(self, axes: tuple[str, str], column: str) -> tuple[NDArray[np.float64], ...]:
        """The values along both axes, and the column over them: a row for each of the second."""
        found = self.rows.pivot_table(column, axes[1], axes[0], aggfunc="first", dropna=False)
        known = found.to_numpy(dtype=float)
        return found.columns.to_numpy(dtype=float), found.index.to_numpy(dtype=float), known


@dataclass(frozen=True)
class MapFigure:
    """Maps of some columns over the same two numbers. left_out: pictures that are not drawn."""

    over: tuple[str, str]
    pictures: Sequence[MapPicture]
    table: pd.DataFrame
    columns: Sequence[str] = ()
    title: str = ""
    options: FigureOptions = field(default=USUAL_FIGURES)
    left_out: int = 0

    def draw(self) -> Figure:
        """The figure, with matplotlib's settings as they are."""
        abreast = len(self.columns) if len(self.pictures) == 1 else len(self.pictures)
        width, wide = page_of(abreast, self.options.width)
        lines = -(-len(self.pictures) // wide)
        of_a_column = lines if len(self.pictures) > 1 else 1 / wide
        high = math.ceil(of_a_column * len(self.columns))
        figure = blank_figure(width, high * PANEL_HEIGHT)
        above = write_title(figure, self.title if self.options.title else "")
        below = self._add_legend(figure)
        figure.set_figheight(high * PANEL_HEIGHT + LINE * (above + below))
        for number, column in enumerate(self.columns):
            first = number * lines * wide if len(self.pictures) > 1 else number
            places = [figure.add_subplot(high, wide, first + at + 1) for at in range(len(self.pictures))]
            self._draw(figure, places, column)
            label_once(places, wide)
        return figure

    def _draw(self, figure: Figure, places: Sequence[Axes], column: str) -> None:
        """One column, in shades that mean the same in every picture."""
        norm = _norm([picture.over(self.over, column)[2] for picture in self.pictures], column)
        meshes = [
            self._draw_map(axes, picture, column, norm)
            for axes, picture in zip(places, self.pictures, strict=True)
        ]
        bar = figure.colorbar(meshes[0], ax=list(places), pad=0.02, fraction=0.06)
        bar.set_label(MEASURE_NAMES.get(column) or word(column, 28))
        bar.outline.set_linewidth(0.5)

    def _draw_map(self, axes: Axes, picture: MapPicture, column: str, norm: Normalize) -> QuadMesh:
        x, y, known = picture.over(self.over, column)
        edges = [_edges(values) for values in (x, y)]
        mesh = axes.pcolormesh(
            *edges, np.ma.masked_invalid(known), norm=norm, rasterized=known.size > RASTERIZED
        )
        for values, scale in ((x, axes.set_xscale), (y, axes.set_yscale)):
            if is_logarithmic(values):
                scale("log")
        _draw_contours(axes, x, y, known, norm)
        _draw_v_lin(axes, x, y, picture.over(self.over, SPEED_RATIO)[2] if self._along_speed else known[:0])
        for status, mark in LEGEND_MARKS.items() if "status" in picture.rows else ():
            rows = picture.rows[picture.rows["status"] == status]
            look: Any = {"marker": mark, "linestyle": "none", "color": "0.3", "markersize": 3}
            if len(rows):
                axes.plot(rows[self.over[0]], rows[self.over[1]], **look)
        axes.set_xlabel(linked_words(self.table, self.over[0]))
        axes.set_ylabel(linked_words(self.table, self.over[1]))
        axes.spines[["top", "right"]].set_visible(True)
        axes.set_title(self._name(picture), loc="left")
        return mesh

    @property
    def _along_speed(self) -> bool:
        return self.over[0] in BELT_SPEEDS and SPEED_RATIO in self.table

    def _name(self, picture: MapPicture) -> str:
        laws = len({each.law for each in self.pictures}) > 1
        methods = len({each.methods for each in self.pictures}) > 1 or len(picture.methods) > 1
        joined = " = ".join(shortened(name, BESIDE) for name in picture.methods)
        named = [shortened(picture.law, BESIDE)] * laws + [joined] * methods
        return ", ".join(named + [sentence(setting) for setting in picture.settings])

    def _add_legend(self, figure: Figure) -> int:
        entries: list[Artist] = [*status_entries(self.table)] if "status" in self.table else []
        if self.left_out:
            told = f"{len(self.pictures)} of {len(self.pictures) + self.left_out} maps"
            entries.append(Line2D([], [], linestyle="none", label=told))
        if any(picture.rows[column].isna().any() for picture in self.pictures for column in self.columns):
            entries.append(Patch(facecolor="white", edgecolor="0.3", linewidth=0.5, label="no number"))
        if self._along_speed:
            look: Any = {"color": "white", "linestyle": "dashed", "path_effects": [DARK_EDGE]}
            entries.append(Line2D([], [], label=r"belt speed $V_\mathrm{lin}$", **look))
        if entries:
            figure.legend(handles=entries, loc="outside lower center", ncols=2)
        return -(-len(entries) // 2)


def map_of(table: pd.DataFrame) -> MapFigure | None:
    """The maps of a table; None where not two numbers take values enough.

    Along a sweep of belt speed that is a number of the scene whose values are more than lines can tell apart.
    """
    swept, numbers = swept_columns(table), swept_numbers(table)
    if not numbers:
        return None
    along = along_the_axis(table, numbers)
    if along not in BELT_SPEEDS:
        return _figure(table, swept, numbers)
    others = [name for name in numbers if name != along and table[name].nunique() > MOST_SEPARATE]
    return _figure(table, swept, others, along)


def map_of_curves(curves: pd.DataFrame) -> MapFigure | None:
    """The maps of the measures of curves; None where not two numbers beside belt speed take values enough."""
    found = _figure(curves, swept_columns(curves), swept_numbers(curves))
    known = [name for name in OF_CURVES if name in curves and curves[name].notna().any()]
    return replace(found, columns=known) if found is not None and known else None


def _figure(
    table: pd.DataFrame, swept: Sequence[str], numbers: Sequence[str], along: str | None = None
) -> MapFigure | None:
    """Those over the two numbers of most values, one of them the one given. numbers: of the fewest values first."""
    most = [name for name in numbers if name.startswith("scene.") or _of_every_law(table, name)]
    most += [along] if along else []
    if len(most) < 2 or table[most[-2]].nunique() < LEAST_VALUES:
        return None
    y, x = most[-2:]
    others = [name for name in swept if name not in (x, y)]
    pictures: list[MapPicture] = []
    for (law, method, *values), rows in table.groupby(["law", "method", *others], sort=False, dropna=False):
        settings = tuple(swept_value(name, value) for name, value in zip(others, values, strict=True))
        if "status" in rows and (rows["status"] == "refused").all():
            continue
        _add(pictures, MapPicture(str(law), (str(method),), settings, rows))
    if not all(_is_grid(picture.rows, (x, y)) for picture in pictures) or not pictures:
        return None
    drawn = some_of(pictures, MOST_PICTURES)
    return MapFigure((x, y), drawn, table, left_out=len(pictures) - len(drawn))


def _is_grid(rows: pd.DataFrame, over: tuple[str, str]) -> bool:
    """Whether every value of one number meets every value of the other: else a map is full of holes."""
    return len(rows) == rows[over[0]].nunique() * rows[over[1]].nunique()


def _of_every_law(table: pd.DataFrame, name: str) -> bool:
    """Whether a law's parameter varies within every law: one that has no such number has no map."""
    return bool((table.groupby("law")[name].nunique() > 1).all())


def _add(pictures: list[MapPicture], picture: MapPicture) -> None:
    """A method whose map is an earlier one's, within both errors and what can be seen, is named there."""
    for at, other in enumerate(pictures):
        if (other.law, other.settings) == (picture.law, picture.settings) and _same(other.rows, picture.rows):
            pictures[at] = replace(other, methods=(*other.methods, *picture.methods))
            return
    pictures.append(picture)


def _same(one: pd.DataFrame, other: pd.DataFrame) -> bool:
    if "error" not in one or len(one) != len(other) or list(one["status"]) != list(other["status"]):
        return False
    means, errors = (
        [each[name].to_numpy(dtype=float) for each in (one, other)] for name in ("mean_friction", "error")
    )
    apart, known = np.abs(means[0] - means[1]), np.isfinite(means[0])
    if not known.any():
        return False
    near = np.minimum(sum(errors), LEAST_VISIBLE * np.ptp(means[0][known]))
    return bool(np.all(apart[known] <= near[known]))


def _norm(maps: Sequence[NDArray[np.float64]], column: str) -> Normalize:
    known = np.concatenate([values[np.isfinite(values)] for values in maps])
    if column == "error" and (known > 0.0).any():
        return LogNorm(float(known[known > 0.0].min()), float(known.max()), clip=True)
    return Normalize(float(known.min()), float(known.max()))


def _draw_contours(
    axes: Axes, x: NDArray[np.float64], y: NDArray[np.float64], known: NDArray[np.float64], norm: Normalize
) -> None:
    """Labelled lines of equal value, zero a broad one; none of an error, which jumps from point to point."""
    low, high = float(norm.vmin or 0.0), float(norm.vmax or 0.0)
    if isinstance(norm, LogNorm) or min(known.shape) < 2 or not low < high or np.isfinite(known).sum() < 4:
        return
    edge = LEVEL_EDGE * (high - low)  # a plateau at an end differs from it by rounding
    levels = [at for at in MaxNLocator(MOST_LEVELS).tick_values(low, high) if low + edge < at < high - edge]
    if not levels:
        return
    broad = [1.8 if at == 0.0 else 0.7 for at in levels]
    look: Any = {"colors": "0.1", "linewidths": broad, "linestyles": "solid"}
    lines = axes.contour(x, y, np.ma.masked_invalid(known), levels, **look)
    lines.set(path_effects=[OUTLINE])
    kept: list[NDArray[np.float64]] = []
    for label in axes.clabel(lines, fontsize=6, fmt="%.4g", inline=False):
        at = (axes.transScale + axes.transLimits).transform(label.get_position())
        if any((np.abs(at - other) < LABEL_ROOM).all() for other in kept):
            label.set_visible(False)
        else:
            kept.append(at)
            label.set(path_effects=[OUTLINE])


def _draw_v_lin(
    axes: Axes, x: NDArray[np.float64], y: NDArray[np.float64], ratio: NDArray[np.float64]
) -> None:
    """The line on which the belt runs at V_lin, from the ratio of both speeds; none where no part of it is inside."""
    known = np.abs(ratio[np.isfinite(ratio)])
    if not known.size or not known.min() < 1.0 < known.max():
        return
    line = axes.contour(x, y, np.ma.masked_invalid(np.abs(ratio)), [1.0], colors="white", linestyles="dashed")
    line.set(linewidth=1.1, path_effects=[DARK_EDGE])


def _edges(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Of cells around these values, half way between neighbours."""
    steps = np.log(values) if is_logarithmic(values) else values
    half = 0.5 * np.diff(steps)
    edges = np.concatenate([[steps[0] - half[0]], steps[:-1] + half, [steps[-1] + half[-1]]])
    return np.exp(edges) if is_logarithmic(values) else edges
