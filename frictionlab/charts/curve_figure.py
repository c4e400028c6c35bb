"""A figure of curves: pictures side by side, each with one quantity along the same axis.

A point without a number is a mark on the axis and a line in the legend: nothing is dropped in silence. Methods whose
curves are one line are drawn once, and the legend says so.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence
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
from frictionlab.charts.looks import (
    LEGEND_MARKS,
    WITHOUT_NUMBER,
    Looks,
    curve_entries,
    status_entries,
)
from frictionlab.charts.marks import (
    OnsetMark,
    draw_onsets,
    draw_speed_marks,
    onset_entries,
    onsets_on,
)
from frictionlab.charts.sheet import NO_HEADING, Heading, Sheet, scale_alike, write_heading
from frictionlab.charts.sweeps import SweptValue, headings, is_logarithmic
from frictionlab.study.figure_options import USUAL_FIGURES, FigureOptions
from frictionlab.values.columns import unit_shown, word

DEGREES = [1, 1.5, 3, 4.5, 9, 10]  # between ticks of an angle, times a power of ten
KEPT_LEVEL = 1e-6  # of mean friction beyond V_lin: what differs by less is level
LEAST_SHARE = 1e-3  # of the largest number of a curve on a logarithmic axis
_ROUNDING = 1e-9  # of the largest level: less is zero, whatever its sign
LIKE_RANGES = 2.5  # ranges of pictures of one quantity that differ by less have one scale

Panel = tuple[SweptValue, ...]
BAND_LOOK: Any = {"linewidth": 6.0, "alpha": 0.3, "solid_capstyle": "butt"}  # where the body sticks


@dataclass(frozen=True)
class CurveFigure:
    """Contents of a figure of curves. words: of a column, where they are not its own; level: whether zero is a line.

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
        """Return the looks of the curves that are drawn."""
        return Looks(drawn_once(self.family.curves, self.columns))

    @cached_property
    def logarithmic(self) -> tuple[bool, bool]:
        """Check whether the axes of all pictures are logarithmic, along and upwards: they are alike in a figure."""
        curves = self.looks.curves
        along = is_logarithmic(np.concatenate([curve.column(self.family.abscissa) for curve in curves]))
        pictures = [
            [curve.rows[column] for curve in curves if curve.panel == panel]
            for panel in self.family.panels
            for column in self.columns
        ]
        apart = "mean_friction" not in self.columns and any(map(_lie_decades_apart, pictures))
        return along, apart and all(map(_is_positive, itertools.chain(*pictures)))

    def draw(self, heading: Heading = NO_HEADING) -> Figure:
        """Return the figure, with matplotlib's settings as they are."""
        pictures = [(panel, column) for panel in self.family.panels for column in self.columns]
        sheet = Sheet.blank(len(pictures), heading)
        titles = headings([panel for panel, _ in pictures])
        drawn = [
            _Picture(self, panel, column, sheet.axes(place)).draw(sheet.picture_width, title)
            for place, ((panel, column), title) in enumerate(zip(pictures, titles, strict=True))
        ]
        for column in range(len(self.columns)):
            scale_alike(drawn[column :: len(self.columns)], LIKE_RANGES)
        sheet.label_once(drawn)
        self._name_curves(sheet)
        return sheet.figure

    def _name_curves(self, sheet: Sheet) -> None:
        """A legend of the curves, below which is all else."""
        named = curve_entries(self.looks, self.columns)
        tells_what = any(entry.get_linestyle() == "None" for entry in named)  # what is swept
        about = self.family.word(self.family.member) if self.family.member and not tells_what else None
        sheet.add_legend([*named, *self._entries()], about)

    def onsets_of(self, curve: CurveData) -> list[OnsetMark]:
        """Return the marks on the axis under a curve."""
        return onsets_on(curve, self.onsets, self.family.abscissa) if self.family.along_speed else []

    def _entries(self) -> list[Line2D]:
        marks = [mark for curve in self.family.curves for mark in self.onsets_of(curve)]
        rows = pd.concat([curve.rows[["method", "status"]] for curve in self.family.curves])
        entries = [*status_entries(rows), *onset_entries(marks)]
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
    panel: Panel
    column: str
    axes: Axes

    def draw(self, width: float, title: str) -> Axes:
        """Return the picture. width: about [point]."""
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
        if self.of.logarithmic[0]:
            axes.set_xscale("log")
            _label_decades(axes.xaxis)
        self._scale_upwards()
        room = draw_speed_marks(axes, curves, self.of.looks, width) if self.of.family.along_speed else 0.0
        pad = mpl.rcParams["axes.titlepad"] + room
        write_heading(axes, title, width, pad)
        for curve in curves:
            draw_onsets(axes, self.of.onsets_of(curve), self.of.looks.color(curve))
        return axes

    def lines(self, axes: Axes, curves: Sequence[CurveData]) -> None:
        """Draw the curves alone."""
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
        drawn = _with_kinks(x, y, curve.kinks if self.column == "mean_friction" and not self.of.level else ())
        solved = np.isin(drawn[0], x)  # a kink is none of the points
        axes.plot(
            *drawn, markevery=[at for at in self.of.looks.marked(drawn[1], curve) if solved[at]], **look
        )
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
        look: Any = {
            "ms": 4,
            "ls": "none",
            "clip_on": False,
            "transform": self.axes.get_xaxis_transform(),
            "zorder": 5,
        }
        marks = WITHOUT_NUMBER if self.column == "mean_friction" else LEGEND_MARKS
        for status, mark in marks.items():
            if len(at := x[curve.having(status)]):
                self.axes.plot(at, 0.0 * at, marker=mark, color=self.of.looks.color(curve), **look)

    def _scale_upwards(self) -> None:
        """A foot at zero for what is not negative; logarithmic where whole curves lie decades apart."""
        if self.of.logarithmic[1]:
            self.axes.set_yscale("log")
            _label_decades(self.axes.yaxis)
            return
        low, high = self.axes.get_ylim()
        if -0.06 * high < low:  # nothing but the margin below zero, so zero itself is the natural foot
            self.axes.set_ylim(0.0, max(high, 1.05 * self.axes.dataLim.y1))


def _with_kinks(
    x: CurveNumbers, y: CurveNumbers, kinks: Sequence[float]
) -> tuple[CurveNumbers, CurveNumbers]:
    """Points of a curve and, at V_lin, one of the level that every point keeps from there on."""
    for kink in kinks:
        places = np.flatnonzero(x >= kink if kink > 0.0 else x <= kink)
        level = float(y[places].mean()) if places.size else math.nan
        if (
            math.isfinite(level)
            and kink not in x
            and np.abs(y[places] - level).max() <= KEPT_LEVEL * abs(level)
        ):
            at = int(np.searchsorted(x, kink))
            x, y = np.insert(x, at, kink), np.insert(y, at, level)
    return x, y


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
    """Label 1, 2 and 5 of an axis of few decades, as plain numbers: every multiple would be one on the other."""
    low, high = sorted(axis.get_view_interval())
    if high < 1000.0 * low:
        axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        axis.set_major_formatter(StrMethodFormatter("{x:g}"))
        axis.set_minor_formatter(NullFormatter())


def _is_positive(curve: pd.Series) -> bool:
    """Check whether a curve keeps to what a logarithmic axis shows well; one without numbers does."""
    return bool(curve.isna().all() or curve.min() > LEAST_SHARE * curve.max())


def _lie_decades_apart(curves: Sequence[pd.Series]) -> bool:
    """Check whether every curve keeps to a level above rounding, and the levels are decades apart."""
    known = [curve for curve in curves if curve.notna().any()]
    if not known:
        return False
    levels = [float(curve.median()) for curve in known]
    low, high = min(levels), max(levels)
    return high > 30.0 * low > _ROUNDING * high and min(float(curve.min()) for curve in known) > 0.2 * low
