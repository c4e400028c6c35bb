"""A figure of curves: pictures side by side, each with one quantity along the same axis.

A point without a number is a mark on the axis and a line in the legend: nothing is dropped in silence. Methods whose
curves are one line are drawn once, and the legend says so.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import matplotlib as mpl
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import LogLocator, MaxNLocator, NullFormatter, StrMethodFormatter
from numpy.typing import NDArray

from frictionlab.charts.curves import LEAST_VISIBLE, CurveData, CurveNumbers, Family, drawn_once
from frictionlab.charts.looks import WITHOUT_NUMBER, Looks, curve_entries, status_entries
from frictionlab.charts.marks import OnsetMark, draw_onsets, draw_speed_marks, onset_entries, onsets_on
from frictionlab.charts.sheet import NO_HEADING, Heading, Sheet, scale_alike, write_heading
from frictionlab.charts.sweeps import SweptValue, is_logarithmic
from frictionlab.columns import unit_shown, word
from frictionlab.study.figure_options import USUAL_FIGURES, FigureOptions

DEGREES = [1, 1.5, 3, 4.5, 9, 10]  # between ticks of an angle, times a power of ten
ROUNDING = 1e-9  # of the largest level: less is zero, whatever its sign
LIKE_RANGES = 2.5  # ranges of pictures of one quantity that differ by less have one scale
LEVEL_SHARE = 0.4  # of a linear axis, up to its right end: with less of it level there is no closer view
DIFFER_MOST = 0.3  # of the largest difference: from there on curves are shown closer
GAP, LABELS = 0.07, 0.04  # to the level part around, and for labels of the view, in shares of the picture
Points = tuple[CurveNumbers, CurveNumbers]
BAND_LOOK: Any = {"linewidth": 6.0, "alpha": 0.3, "solid_capstyle": "butt"}  # where the body sticks


@dataclass(frozen=True)
class CurveFigure:
    """What a figure of curves shows. words: of a column, where they are not its own; level: whether zero is a line.

    onsets: of the whole study, None where none are marked. more: entries of the legend.
    """

    family: Family
    columns: Sequence[str]
    onsets: pd.DataFrame | None = None
    options: FigureOptions = USUAL_FIGURES
    words: Mapping[str, str] = field(default_factory=dict)
    level: bool = False
    more: Sequence[Line2D] = ()

    @cached_property
    def looks(self) -> Looks:
        """Those of the curves that are drawn."""
        return Looks(drawn_once(self.family.curves, self.columns))

    def draw(self, heading: Heading = NO_HEADING) -> Figure:
        """The figure, with matplotlib's settings as they are."""
        pictures = [(panel, column) for panel in self.family.panels for column in self.columns]
        about = self.family.word(self.family.member) if self.family.member else None
        sheet = Sheet.blank(len(pictures), heading, self._entries(), about)
        drawn = [
            _Picture(self, panel, column, sheet.axes(place)).draw(sheet.picture_width)
            for place, (panel, column) in enumerate(pictures)
        ]
        for column in range(len(self.columns)):
            scale_alike(drawn[column :: len(self.columns)], LIKE_RANGES)
        sheet.label_once(drawn)
        return sheet.figure

    def onsets_of(self, curve: CurveData) -> list[OnsetMark]:
        """The marks on the axis under a curve."""
        return onsets_on(curve, self.onsets, self.family.abscissa) if self.family.along_speed else []

    def _entries(self) -> list[Line2D]:
        marks = [mark for curve in self.family.curves for mark in self.onsets_of(curve)]
        rows = pd.concat([curve.rows[["method", "status"]] for curve in self.family.curves])
        entries = [*curve_entries(self.looks, self.columns), *status_entries(rows), *onset_entries(marks)]
        if self.options.stick and any(_sticks(curve).any() for curve in self.looks.curves):
            entries.append(Line2D([], [], color="0.3", label="stick in part of the period", **BAND_LOOK))
        return [*entries, *self.more]


def _sticks(curve: CurveData) -> NDArray[np.bool_]:
    """At which points the body sticks for a part of the period."""
    known = "stick_fraction" in curve.rows
    return np.nan_to_num(curve.column("stick_fraction")) > 0.0 if known else np.zeros(len(curve.rows), bool)


@dataclass(frozen=True)
class _Picture:
    """One quantity of the curves of one panel."""

    of: CurveFigure
    panel: tuple[SweptValue, ...]
    column: str
    axes: Axes

    def draw(self, width: float) -> Axes:
        """The picture. width: about [point]."""
        axes, abscissa = self.axes, self.of.family.abscissa
        curves = [curve for curve in self.of.looks.curves if curve.panel == self.panel]
        self.lines(axes, curves)
        for curve in self.of.family.curves:
            if curve.panel == self.panel:
                self._mark_missing(curve)
        axes.set_xlabel(self.of.family.word(abscissa))
        axes.set_ylabel(self.of.words.get(self.column) or word(self.column, 28))
        axes.margins(x=0.02)
        if unit_shown(abscissa) == "deg":
            axes.xaxis.set_major_locator(MaxNLocator(steps=DEGREES))
        if is_logarithmic(np.concatenate([curve.column(abscissa) for curve in curves])):
            axes.set_xscale("log")
            _label_decades(axes.xaxis)
        self._scale_upwards(curves)
        room = draw_speed_marks(axes, curves, self.of.looks, width) if self.of.family.along_speed else 0.0
        pad = mpl.rcParams["axes.titlepad"] + room
        write_heading(axes, ", ".join(each.sentence for each in self.panel), width, pad)
        for curve in curves:
            draw_onsets(axes, self.of.onsets_of(curve), self.of.looks.color(curve))
        if self.of.options.inset and self.column == "mean_friction":
            drawn = [(curve.column(abscissa), curve.column(self.column)) for curve in curves]
            _draw_closer_view(axes, drawn, lambda inside: self.lines(inside, curves))
        return axes

    def lines(self, axes: Axes, curves: Sequence[CurveData]) -> None:
        """The curves alone."""
        if self.of.level and self.column == "mean_friction":
            axes.axhline(0.0, color="0.45", linewidth=0.6, zorder=0)
        for curve in curves:
            self._draw_curve(axes, curve)

    def _draw_curve(self, axes: Axes, curve: CurveData) -> None:
        x, y = curve.column(self.of.family.abscissa), curve.column(self.column)
        look = self.of.looks.line(curve)
        if np.isnan(x).all():  # a law without the swept parameter: the level that the others are held against
            across = axes.get_yaxis_transform()
            axes.plot([0.0, 0.5, 1.0], y[[0, 0, 0]], markevery=[1], transform=across, **look)
            return
        axes.plot(x, y, markevery=self.of.looks.marked(y, curve), **look)
        if self.column == "mean_friction":
            _draw_errors(axes, curve, x, look["color"])
        held = _sticks(curve) if self.of.options.stick else np.zeros(len(x), bool)
        if held.any():  # a pale band along these points
            at, level = (np.where(held, values, np.nan) for values in (x, y))
            axes.plot(at, level, color=look["color"], zorder=1, **BAND_LOOK)

    def _mark_missing(self, curve: CurveData) -> None:
        """A mark on the axis for every point without a number; a curve refused as a whole is only counted."""
        x = curve.column(self.of.family.abscissa)
        if curve.having("refused").all() or np.isnan(x).all():
            return
        look: Any = {"ms": 4, "clip_on": False, "transform": self.axes.get_xaxis_transform(), "zorder": 5}
        for status, mark in WITHOUT_NUMBER.items():
            if len(at := x[curve.having(status)]):
                self.axes.plot(at, 0.0 * at, mark, color=self.of.looks.color(curve), **look)

    def _scale_upwards(self, curves: Sequence[CurveData]) -> None:
        """A foot at zero for what is not negative; logarithmic where whole curves lie decades apart."""
        if self.column != "mean_friction" and _lie_decades_apart(
            [curve.rows[self.column] for curve in curves]
        ):
            self.axes.set_yscale("log")
            _label_decades(self.axes.yaxis)
            return
        low, high = self.axes.get_ylim()
        if -0.06 * high < low:  # nothing but the margin below zero, so zero itself is the natural foot
            self.axes.set_ylim(0.0, max(high, 1.05 * self.axes.dataLim.y1))


def _draw_errors(axes: Axes, curve: CurveData, x: CurveNumbers, color: Any) -> None:
    """A band of the error where it can be seen, a bar from mean_low to mean_high where the state is not unique."""
    error, mean = curve.column("error"), curve.column("mean_friction")
    if (np.nan_to_num(error) > LEAST_VISIBLE * np.ptp(axes.get_ylim())).any():
        axes.fill_between(x, mean - error, mean + error, color=color, alpha=0.25, linewidth=0)
    if (several := curve.having("not_unique")).any():
        low, high = (curve.column(name)[several] for name in ("mean_low", "mean_high"))
        half = 0.5 * (high - low)
        axes.errorbar(x[several], low + half, yerr=half, fmt="none", color=color, capsize=1.5)


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


def _draw_closer_view(axes: Axes, curves: Sequence[Points], draw: Callable[[Axes], None]) -> None:
    """Draw the lines anew where they differ, or where they change, in the room under or over their level part.

    Nothing is drawn where less than LEVEL_SHARE of a linear axis, up to its right end, is level.
    """
    finite = [np.isfinite(x) & np.isfinite(y) for x, y in curves]
    curves = [(x[known], y[known]) for (x, y), known in zip(curves, finite, strict=True)]
    window = _level_from(curves)
    if window is None or axes.get_xscale() != "linear" or axes.get_yscale() != "linear":
        return
    start, level = window
    ends = axes.transData.transform([(start, level), (axes.get_xlim()[1], axes.get_ylim()[1])])
    (left, bottom), (right, _) = axes.transAxes.inverted().transform(ends)
    foot, top = (0.1, bottom - GAP) if bottom > 0.5 else (bottom + GAP, 0.95)
    if top - foot < 0.25:
        return
    first = left + GAP + LABELS
    inside = axes.inset_axes((first, foot + GAP, right - first - 0.5 * GAP, top - foot - GAP))
    draw(inside)
    low, high = _of_interest(curves, start)
    heights = np.concatenate([y[(x >= low) & (x <= high)] for x, y in curves])
    margin = 0.08 * float(np.ptp(heights))
    inside.set_xlim(low, high)
    inside.set_ylim(float(heights.min()) - margin, float(heights.max()) + margin)
    inside.tick_params(labelsize=5.5, length=2)
    axes.indicate_inset_zoom(inside, edgecolor="0.45", linewidth=0.5)


def _level_from(curves: Sequence[Points]) -> tuple[float, float] | None:
    """From where on, and at which level, all curves stay within what can be seen; None for less than LEVEL_SHARE."""
    known = [(x, y) for x, y in curves if len(x) > 2]
    if not known:
        return None
    least = LEAST_VISIBLE * float(np.ptp(np.concatenate([y for _, y in known])))
    changes = [np.append(True, np.abs(y - y[-1]) > least) for _, y in known]
    start = max(float(x[np.flatnonzero(each)[-1] - 1]) for (x, _), each in zip(known, changes, strict=True))
    low, high = min(float(x[0]) for x, _ in known), max(float(x[-1]) for x, _ in known)
    levels = [float(y[-1]) for _, y in known]
    if np.ptp(levels) > least or not low < start <= high - LEVEL_SHARE * (high - low):
        return None
    return start, levels[0]


def _of_interest(curves: Sequence[Points], start: float) -> tuple[float, float]:
    """The part before the level one in which several curves differ most; all of it where they do not, or for one."""
    first = min(float(x[0]) for x, _ in curves)
    at = np.linspace(first, start, 400)
    heights = np.array([np.interp(at, x, y) for x, y in curves])
    apart = np.ptp(heights, axis=0)
    if apart.max() <= 2.0 * LEAST_VISIBLE * float(np.ptp(heights)):
        return first, start
    apart = apart > DIFFER_MOST * apart.max()
    margin = 0.1 * (start - first)
    return max(first, float(at[apart][0]) - margin), min(start, float(at[apart][-1])) + margin
