"""A fit: what was measured with what each law says of it, what is left, and how far neighbours in that are alike."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from frictionlab.charts.sheet import Heading, Sheet
from frictionlab.charts.style import CYCLE, STYLE, write_figure
from frictionlab.columns import word
from frictionlab.printable import printable

POINTS_SHOWN = 1000
"""Of a path of slip in the first picture: some of its middle, one after the other."""
MEASURED: Any = {"color": "0.35", "linestyle": "none", "marker": "o", "markersize": 2.6}
LAGS = 200
FEW_TICKS = 5
"""Of belt speeds in m/s, whose numbers are long."""


def fit_figure(found: Any, title: str = "") -> Figure:
    """Three pictures: measured and fitted; residuals along belt speed or time; their autocorrelation."""
    looks = [CYCLE[place % len(CYCLE)] for place in range(len(found.fitted))]
    entries: list[Any] = [Line2D([], [], label="measured", **MEASURED)]
    entries += [
        Line2D([], [], label=each.model.words, **look) for each, look in zip(found.fitted, looks, strict=True)
    ]
    with mpl.rc_context(STYLE):
        sheet = Sheet.blank(3, Heading(printable(title), "double"), entries)
        first, second, third = (sheet.axes(place) for place in range(3))
        (_draw_loops if found.measured.is_path else _draw_measured)(first, found, looks)
        _draw_left(second, found, looks)
        _draw_alike(third, found, looks)
    return sheet.figure


def draw_fit(found: Any, title: str, folder: Path) -> list[Path]:
    """Draw a fit into a folder; the files. Raises OSError where it cannot be written."""
    folder.mkdir(parents=True, exist_ok=True)
    with mpl.rc_context(STYLE):
        return write_figure(fit_figure(found, title), folder / "fit")


def _draw_measured(axes: Axes, found: Any, looks: list[Any]) -> None:
    """Mean friction against belt speed, a line for each law and scene."""
    measured = found.measured
    speeds = measured.table[measured.along].to_numpy(dtype=float)
    axes.errorbar(speeds, measured.values, yerr=measured.sigma, elinewidth=0.7, zorder=1, **MEASURED)
    for each, look in zip(found.fitted, looks, strict=True):
        for places in measured.scenes_rising:
            axes.plot(speeds[places], each.said[places], **look)
    axes.set(xlabel=word(measured.speed), ylabel=word("mean_friction"))
    axes.xaxis.set_major_locator(MaxNLocator(FEW_TICKS))


def _draw_loops(axes: Axes, found: Any, looks: list[Any]) -> None:
    """Friction against slip, some of the path."""
    shown = _shown(len(found.measured.values))
    slip = found.measured.table["slip"].to_numpy(dtype=float)[shown]
    axes.plot(slip, found.measured.values[shown], zorder=1, **MEASURED | {"markersize": 1.2})
    for each, look in zip(found.fitted, looks, strict=True):
        axes.plot(slip, each.said[shown], **look)
    axes.set(xlabel="slip", ylabel="friction coefficient")


def _shown(rows: int) -> slice:
    """Those in the middle of a path that are drawn."""
    first = max(0, rows // 2 - POINTS_SHOWN // 2)
    return slice(first, first + POINTS_SHOWN)


def _draw_left(axes: Axes, found: Any, looks: list[Any]) -> None:
    """Fitted less measured, a line for each law and scene; of a path that part which the first picture shows."""
    measured = found.measured
    along = measured.table[measured.along].to_numpy(dtype=float)
    parts = [np.arange(len(along))[_shown(len(along))]] if measured.is_path else measured.scenes_rising
    marks = {"linewidth": 0.5} if measured.is_path else {"marker": ".", "markersize": 3.0, "linewidth": 0.6}
    for each, look in zip(found.fitted, looks, strict=True):
        for places in parts:
            axes.plot(along[places], each.raw[places], **look | marks)
    axes.axhline(0.0, color="0.5", linewidth=0.7)
    axes.set(
        xlabel="time" if measured.is_path else word(measured.speed),
        ylabel="fitted less measured",
    )
    axes.xaxis.set_major_locator(MaxNLocator(FEW_TICKS))


def _draw_alike(axes: Axes, found: Any, looks: list[Any]) -> None:
    """Autocorrelation of what is left, along belt speed or time; within the dashes it may be chance."""
    along = found.measured.table[found.measured.along].to_numpy(dtype=float)
    order, count = np.argsort(along, kind="stable"), len(along)
    lags = min(LAGS, count // 2)
    for each, look in zip(found.fitted, looks, strict=True):
        axes.plot(range(lags + 1), each.autocorrelation(order, lags), **look)
    for side in (-1.0, 1.0):
        axes.axhline(side * 2.0 / np.sqrt(count), color="0.5", linewidth=0.7, linestyle=(0, (4, 2)))
    axes.set(xlabel="lag [rows]", ylabel="autocorrelation")
