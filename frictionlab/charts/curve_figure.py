"""A figure of curves: pictures side by side, each with one quantity along the same axis.

A point without a number is a mark on the axis and a line in the legend: nothing is dropped in silence. Methods whose
curves are one line are drawn once, and the legend says so.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import LogLocator, MaxNLocator, NullFormatter, StrMethodFormatter
from numpy.typing import NDArray

from frictionlab.charts.closer_view import draw_closer_view
from frictionlab.charts.curves import LEAST_VISIBLE, CurveData, Family, SweptValue, drawn_once, is_logarithmic
from frictionlab.charts.derived import is_along_speed
from frictionlab.charts.legend import WITHOUT_NUMBER, add_legend
from frictionlab.charts.looks import Looks
from frictionlab.charts.onsets import draw_onsets, onset_entries, onsets_on
from frictionlab.charts.speed_marks import draw_speed_marks
from frictionlab.charts.style import LINE, PANEL_HEIGHT, blank_figure, page_of
from frictionlab.charts.words import label_once, sentence, write_title
from frictionlab.columns import word
from frictionlab.study.figure_options import USUAL_FIGURES, FigureOptions

DEGREES = [1, 1.5, 3, 4.5, 9, 10]  # between ticks of an angle, times a power of ten
ROUNDING = 1e-9  # of the largest level: less is zero, whatever its sign
SAME_SPEED = 1e-6  # share of a belt speed: an onset and V_lin closer than this are one
LIKE_RANGES = 2.5  # ranges of pictures of one quantity that differ by less have one scale
BAND_LOOK: Any = {
    "linewidth": 6.0,
    "alpha": 0.3,
    "solid_capstyle": "butt",
}  # of a curve where the body sticks


@dataclass(frozen=True)
class CurveFigure:
    """What a figure of curves shows. words: of a column, where they are not its own; level: whether zero is a line.

    left_out: what is not drawn, in words. onsets: of the whole study, None where none are marked.
    """

    family: Family
    columns: Sequence[str]
    title: str = ""
    onsets: pd.DataFrame | None = None
    options: FigureOptions = USUAL_FIGURES
    words: Mapping[str, str] = field(default_factory=dict)
    level: bool = False
    left_out: str = ""

    def draw(self) -> Figure:
        """The figure, with matplotlib's settings as they are."""
        looks = Looks(drawn_once(self.family.curves, self.columns))
        pictures = [(panel, column) for panel in self.family.panels for column in self.columns]
        width, wide = page_of(len(pictures), self.options.width)
        high = -(-len(pictures) // wide)
        figure = blank_figure(width, high * PANEL_HEIGHT)
        above = write_title(figure, self.title if self.options.title else "")
        below = add_legend(figure, self.family, looks, self.columns, self._more_entries(looks))
        figure.set_figheight(high * PANEL_HEIGHT + LINE * (above + below))
        drawn: dict[str, list[Axes]] = {}
        for place, (panel, column) in enumerate(pictures, start=1):
            axes = figure.add_subplot(high, wide, place)
            _Picture(self, looks, panel, column, 72 * 0.8 * width / wide).draw(axes)
            drawn.setdefault(column, []).append(axes)
        for of_a_column in drawn.values():
            _scale_alike(of_a_column)
        label_once(figure.axes, wide)
        return figure

    def onsets_of(self, curve: CurveData) -> list[Any]:
        """The marks on the axis under a curve, but for the end of reversal where the mark of V_lin says it."""
        if not is_along_speed(self.family):
            return []
        marks = onsets_on(curve, self.onsets, self.family.abscissa)
        return [mark for mark in marks if mark.onset != "reversal_ends" or not _is_kink(mark.at, curve)]

    def _more_entries(self, looks: Looks) -> list[Line2D]:
        marks = [mark for curve in self.family.curves for mark in self.onsets_of(curve)]
        entries: list[Line2D] = list(onset_entries(marks))
        if self.options.stick and any(sticks(curve.rows).any() for curve in looks.curves):
            entries.append(Line2D([], [], color="0.3", label="stick in part of the period", **BAND_LOOK))
        if self.left_out:
            entries.append(Line2D([], [], linestyle="none", label=self.left_out))
        return entries


def _is_kink(at: float, curve: CurveData) -> bool:
    return any(abs(at - kink) <= SAME_SPEED * abs(kink) for kink in curve.kinks)


def sticks(rows: pd.DataFrame) -> NDArray[np.bool_]:
    """At which points the body sticks for a part of the period."""
    if "stick_fraction" not in rows:
        return np.zeros(len(rows), dtype=bool)
    return np.nan_to_num(rows["stick_fraction"].to_numpy(dtype=float)) > 0.0


@dataclass(frozen=True)
class _Picture:
    """One quantity of the curves of one panel. width: of the picture, about [point]."""

    of: CurveFigure
    looks: Looks
    panel: tuple[SweptValue, ...]
    column: str
    width: float

    def draw(self, axes: Axes) -> None:
        abscissa, options = self.of.family.abscissa, self.of.options
        curves = [curve for curve in self.looks.curves if curve.panel == self.panel]
        self.lines(axes, curves)
        for curve in (curve for curve in self.of.family.curves if curve.panel == self.panel):
            _mark_missing(axes, curve, abscissa, self.looks)
        self._name(axes)
        axes.margins(x=0.02)
        if word(abscissa).endswith("deg]"):
            axes.xaxis.set_major_locator(MaxNLocator(steps=DEGREES))
        if is_logarithmic(np.concatenate([curve.rows[abscissa].to_numpy(dtype=float) for curve in curves])):
            axes.set_xscale("log")
            _label_decades(axes.xaxis)
        _scale_upwards(axes, [curve.rows[self.column] for curve in curves], self.column)
        if is_along_speed(self.of.family):
            draw_speed_marks(axes, curves, self.looks, self.width)
        for curve in curves:
            draw_onsets(axes, self.of.onsets_of(curve), self.looks.color(curve))
        if options.inset and self.column == "mean_friction":
            known = [(x, y) for x, y in (_points(curve, abscissa, self.column) for curve in curves)]
            draw_closer_view(axes, known, lambda inside: self.lines(inside, curves))

    def lines(self, axes: Axes, curves: Sequence[CurveData]) -> None:
        """The curves alone."""
        if self.of.level and self.column == "mean_friction":
            axes.axhline(0.0, color="0.45", linewidth=0.6, zorder=0)
        for curve in curves:
            _draw_curve(axes, self.of.family.abscissa, self.looks, curve, self.column)
            if self.of.options.stick:
                _shade_stick(axes, self.of.family.abscissa, self.looks, curve, self.column)

    def _name(self, axes: Axes) -> None:
        axes.set_xlabel(self.of.family.word(self.of.family.abscissa))
        axes.set_ylabel(self.of.words.get(self.column) or word(self.column, 28))
        if self.panel:
            axes.set_title(", ".join(sentence(setting) for setting in self.panel), loc="left")


def _points(curve: CurveData, abscissa: str, column: str) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    x, y = (curve.rows[name].to_numpy(dtype=float) for name in (abscissa, column))
    known = np.isfinite(x) & np.isfinite(y)
    return x[known], y[known]


def _shade_stick(axes: Axes, abscissa: str, looks: Looks, curve: CurveData, column: str) -> None:
    """A pale band along the points at which the body sticks."""
    x, y = (curve.rows[name].to_numpy(dtype=float) for name in (abscissa, column))
    held = sticks(curve.rows)
    if held.any():
        at, level = (np.where(held, values, np.nan) for values in (x, y))
        axes.plot(at, level, color=looks.color(curve), zorder=1, **BAND_LOOK)


class Data(NamedTuple):
    """One curve of one quantity as arrays: where, how much, and the shape it is drawn in."""

    x: NDArray[np.float64]
    y: NDArray[np.float64]
    rows: pd.DataFrame
    color: Any


def _scale_alike(pictures: Sequence[Axes]) -> None:
    """One scale for pictures of one quantity, that curves may be compared across them, where ranges are alike."""
    ranges = [axes.get_ylim() for axes in pictures]
    heights = [high - low for low, high in ranges]
    if all(axes.get_yscale() == "linear" for axes in pictures) and max(heights) < LIKE_RANGES * min(heights):
        for axes in pictures:
            axes.set_ylim(min(low for low, _ in ranges), max(high for _, high in ranges))


def _scale_upwards(axes: Axes, curves: Sequence[pd.Series], column: str) -> None:
    """A foot at zero for what is not negative; logarithmic where whole curves lie decades apart."""
    if column != "mean_friction" and _lie_decades_apart(curves):
        axes.set_yscale("log")
        _label_decades(axes.yaxis)
        return
    low, high = axes.get_ylim()
    if -0.06 * high < low:  # nothing but the margin below zero, so zero itself is the natural foot
        axes.set_ylim(0.0, max(high, 1.05 * axes.dataLim.y1))


def _label_decades(axis: Axis) -> None:
    """Of few decades 1, 2 and 5 are labelled, as plain numbers: every multiple would be one on the other."""
    low, high = sorted(axis.get_view_interval())
    if high < 1000.0 * low:
        axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        axis.set_major_formatter(StrMethodFormatter("{x:g}"))
        axis.set_minor_formatter(NullFormatter())


def _lie_decades_apart(curves: Sequence[pd.Series]) -> bool:
    """Whether every curve keeps to a level above rounding, and the levels are decades apart."""
    known = [curve for curve in curves if curve.notna().any()]
    if not known:
        return False
    levels = [float(curve.median()) for curve in known]
    low, high = min(levels), max(levels)
    return high > 30.0 * low > ROUNDING * high and min(float(curve.min()) for curve in known) > 0.2 * low


def _draw_curve(axes: Axes, abscissa: str, looks: Looks, curve: CurveData, column: str) -> None:
    x, y = (curve.rows[name].to_numpy(dtype=float) for name in (abscissa, column))
    look = looks.line(curve)
    if np.isnan(x).all():  # a law without the swept parameter: the level that the others are held against
        ends = [0.0, 0.5, 1.0]
        axes.plot(ends, y[[0, 0, 0]], markevery=[1], transform=axes.get_yaxis_transform(), **look)
        return
    axes.plot(x, y, markevery=looks.marked(y, curve), **look)
    data = Data(x, y, curve.rows, look["color"])
    if column == "mean_friction":
        _draw_error(axes, data)
        _draw_ranges(axes, data)


def _draw_error(axes: Axes, data: Data) -> None:
    """The error as a band, where it is wide enough to be seen at all."""
    error = data.rows["error"].to_numpy(dtype=float)
    seen = np.nan_to_num(error) > LEAST_VISIBLE * np.ptp(axes.get_ylim())
    if seen.any():
        axes.fill_between(data.x, data.y - error, data.y + error, color=data.color, alpha=0.25, linewidth=0)


def _draw_ranges(axes: Axes, data: Data) -> None:
    """A bar from mean_low to mean_high where the steady state is not unique."""
    rows = (data.rows["status"] == "not_unique").to_numpy()
    if not rows.any():
        return
    low, high = (data.rows[name].to_numpy(dtype=float)[rows] for name in ("mean_low", "mean_high"))
    centre = 0.5 * (low + high)
    axes.errorbar(data.x[rows], centre, yerr=high - centre, fmt="none", color=data.color, capsize=1.5)


def _mark_missing(axes: Axes, curve: CurveData, abscissa: str, looks: Looks) -> None:
    """A mark on the axis for every point without a number; a curve refused as a whole is only counted."""
    if (curve.rows["status"] == "refused").all() or curve.rows[abscissa].isna().all():
        return
    for status, mark in WITHOUT_NUMBER.items():
        x = curve.rows[abscissa].to_numpy(dtype=float)[(curve.rows["status"] == status).to_numpy()]
        where = axes.get_xaxis_transform()
        if len(x):
            color = looks.color(curve)
            axes.plot(x, 0.0 * x, mark, color=color, ms=4, clip_on=False, transform=where, zorder=5)
