"""Figures of a result table: mean friction, velocity response and energies, for the page of a journal.

A point without a number is a mark on the axis and a line in the legend: nothing is dropped in silence. Methods whose
curves are one line are drawn once, and the legend says so.
"""

from __future__ import annotations

import textwrap
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

import matplotlib as mpl
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, MaxNLocator, NullFormatter, StrMethodFormatter
from numpy.typing import NDArray

from frictionlab.charts.curves import (
    LEAST_VISIBLE,
    CurveData,
    Family,
    SweptValue,
    drawn_once,
    family_of,
    is_logarithmic,
)
from frictionlab.charts.legend import WITHOUT_NUMBER, add_legend
from frictionlab.charts.looks import Looks
from frictionlab.charts.onsets import draw_onsets, onset_entries, onsets_on
from frictionlab.charts.speed_marks import draw_speed_marks
from frictionlab.charts.style import COLUMN, LINE, PAGE, PANEL_HEIGHT, STYLE, write_figure
from frictionlab.charts.words import plain, sentence
from frictionlab.columns import SI, belt_speed, word
from frictionlab.printable import printable

FIGURES = {
    "mean_friction": ["mean_friction"],
    "velocity": ["velocity_amplitude", "transverse_velocity_amplitude"],
    "energies": ["energy_input", "energy_viscous", "energy_friction", "energy_contact"],
}
IN_SI = {made.column: name for name, made in SI.items() if made.scale != "load"}

DEGREES = [1, 1.5, 3, 4.5, 9, 10]  # between ticks of an angle, times a power of ten
ROUNDING = 1e-9  # of the largest level: less is zero, whatever its sign
LIKE_RANGES = 2.5  # ranges of pictures of one quantity that differ by less have one scale


class Data(NamedTuple):
    """One curve of one quantity as arrays: where, how much, and the shape it is drawn in."""

    x: NDArray[np.float64]
    y: NDArray[np.float64]
    rows: pd.DataFrame
    color: Any


def draw_figures(
    table: pd.DataFrame, title: str, folder: Path, onsets: pd.DataFrame | None = None
) -> list[Path]:
    """Draw every figure of a result table into a folder, onsets marked along belt speed; the files written.

    A table without a sweep has no figure, nor has a quantity that applies nowhere. Raises OSError where the
    folder cannot be written.
    """
    family = family_of(table)
    if family is None:
        return []
    folder.mkdir(parents=True, exist_ok=True)
    files = []
    with mpl.rc_context(STYLE), warnings.catch_warnings():
        warnings.filterwarnings("ignore", "Glyph .* missing from")  # of a title: an empty box says it
        for name, columns in figure_columns(table).items():
            files += write_figure(_figure(family, columns, printable(title), onsets), folder / name)
    return files


def figure_columns(table: pd.DataFrame) -> dict[str, list[str]]:
    """The columns that each figure of a table shows; a figure without any is not there."""
    shown = {
        name: [column for column in _as_given(wanted, table) if table[column].notna().any()]
        for name, wanted in FIGURES.items()
    }
    return {name: columns for name, columns in shown.items() if columns}


def _as_given(columns: Sequence[str], table: pd.DataFrame) -> list[str]:
    """Velocities and energies in SI units where the scene is."""
    return [IN_SI[column] if IN_SI.get(column) in table else column for column in columns]


def _figure(family: Family, columns: Sequence[str], title: str, onsets: pd.DataFrame | None = None) -> Figure:
    if family.abscissa != belt_speed([family.abscissa]):
        onsets = None
    looks = Looks(drawn_once(family.curves, columns))
    marks = [mark for curve in family.curves for mark in onsets_on(curve, onsets)]
    pictures = [(panel, column) for panel in family.panels for column in columns]
    wide = min(2, len(pictures))
    high = -(-len(pictures) // wide)
    width = (COLUMN, PAGE)[wide - 1]
    figure = Figure(figsize=(width, high * PANEL_HEIGHT), layout="constrained")
    FigureCanvasAgg(figure)
    lines = textwrap.wrap(plain(title), round(width * 13))
    figure.suptitle("\n".join(lines), x=0.01, ha="left", fontsize=8, fontweight="bold")
    below = add_legend(figure, family, looks, columns, onset_entries(marks))
    figure.set_figheight(high * PANEL_HEIGHT + LINE * (len(lines) + below))
    drawn: dict[str, list[Axes]] = {}
    for place, (panel, column) in enumerate(pictures, start=1):
        axes = figure.add_subplot(high, wide, place)
        _draw_panel(axes, family, looks, panel, column, onsets)
        drawn.setdefault(column, []).append(axes)
    for of_a_column in drawn.values():
        _scale_alike(of_a_column)
    return figure


def _draw_panel(
    axes: Axes,
    family: Family,
    looks: Looks,
    panel: tuple[SweptValue, ...],
    column: str,
    onsets: pd.DataFrame | None,
) -> None:
    curves = [curve for curve in looks.curves if curve.panel == panel]
    for curve in curves:
        _draw_curve(axes, family, looks, curve, column)
    for curve in family.curves:
        if curve.panel == panel:
            _mark_missing(axes, curve, family.abscissa, looks)
    axes.set_xlabel(word(family.abscissa))
    axes.set_ylabel(word(column, 28))
    if panel:
        axes.set_title(", ".join(sentence(setting) for setting in panel), loc="left")
    axes.margins(x=0.02)
    if word(family.abscissa).endswith("deg]"):
        axes.xaxis.set_major_locator(MaxNLocator(steps=DEGREES))
    if is_logarithmic(
        np.concatenate([curve.rows[family.abscissa].to_numpy(dtype=float) for curve in curves])
    ):
        axes.set_xscale("log")
        _label_decades(axes.xaxis)
    _scale_upwards(axes, [curve.rows[column] for curve in curves], column)
    if family.abscissa == belt_speed([family.abscissa]):
        draw_speed_marks(axes, curves, looks, width=0.75 * 72 * COLUMN)
    for curve in curves:
        draw_onsets(axes, onsets_on(curve, onsets), looks.color(curve))


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


def _draw_curve(axes: Axes, family: Family, looks: Looks, curve: CurveData, column: str) -> None:
    x, y = (curve.rows[name].to_numpy(dtype=float) for name in (family.abscissa, column))
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
