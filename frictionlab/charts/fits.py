"""A fit: what was measured with what each law says of it, what is left, and how far neighbours in that are alike.

Two curves brought near each other, and their distance over what was varied.

How far apart models are, experiment by experiment: a picture for each input that was varied.

The sine and the best drive: each over a period, and the velocity that the body has then.

Impedance of a contact over frequency: modulus and phase (Bode), and its path in the complex plane (Nyquist).
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from frictionlab.charts.sheet import CYCLE, PAGE, STYLE, Heading, Sheet, blank_figure, write_figure
from frictionlab.values.columns import BELT_SPEEDS, SHOWN_IN, word
from frictionlab.values.printable import printable
from frictionlab.values.units import handy_unit

POINTS_SHOWN = 1000
"""Points of a path of slip in the first picture: some of its middle, one after the other."""
_MEASURED: Any = {"color": "0.35", "linestyle": "none", "marker": "o", "markersize": 2.6}
LAGS = 200
FEW_TICKS = 5


def fit_figure(found: Any, title: str = "") -> Figure:
    """Three pictures: measured and fitted; residuals along belt speed or time; their autocorrelation."""
    looks = [CYCLE[place % len(CYCLE)] for place in range(len(found.fitted))]
    entries: list[Any] = [Line2D([], [], label="measured", **_MEASURED)]
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
    speeds, label = _along(measured)
    axes.errorbar(speeds, measured.values, yerr=measured.sigma, elinewidth=0.7, zorder=1, **_MEASURED)
    for each, look in zip(found.fitted, looks, strict=True):
        for places in measured.scenes_rising:
            axes.plot(speeds[places], each.said[places], **look)
    axes.set(xlabel=label, ylabel=word("mean_friction"))
    axes.xaxis.set_major_locator(MaxNLocator(FEW_TICKS))


def _along(measured: Any) -> tuple[Any, str]:
    """Return times or belt speeds, in a unit of a handy size, and what the axis says."""
    along = measured.table[measured.along].to_numpy(dtype=float)
    if measured.is_path or measured.speed != BELT_SPEEDS[1]:
        return along, "time" if measured.is_path else word(measured.speed)
    unit = handy_unit("m/s", float(np.abs(along).max()))
    return along / unit.size, word(f"{measured.speed}{SHOWN_IN}{unit.unit}")


def _draw_loops(axes: Axes, found: Any, looks: list[Any]) -> None:
    """Friction against slip, some of the path."""
    shown = _shown(len(found.measured.values))
    slip = found.measured.table["slip"].to_numpy(dtype=float)[shown]
    axes.plot(slip, found.measured.values[shown], zorder=1, **_MEASURED | {"markersize": 1.2})
    for each, look in zip(found.fitted, looks, strict=True):
        axes.plot(slip, each.said[shown], **look)
    axes.set(xlabel="slip", ylabel="friction coefficient")


def _shown(rows: int) -> slice:
    """Return the samples in the middle of a path that are drawn."""
    first = max(0, rows // 2 - POINTS_SHOWN // 2)
    return slice(first, first + POINTS_SHOWN)


def _draw_left(axes: Axes, found: Any, looks: list[Any]) -> None:
    """Fitted less measured, a line for each law and scene; of a path that part which the first picture shows."""
    measured = found.measured
    along, label = _along(measured)
    parts = [np.arange(len(along))[_shown(len(along))]] if measured.is_path else measured.scenes_rising
    marks = {"linewidth": 0.5} if measured.is_path else {"marker": ".", "markersize": 3.0, "linewidth": 0.6}
    for each, look in zip(found.fitted, looks, strict=True):
        for places in parts:
            axes.plot(along[places], each.raw[places], **look | marks)
    axes.axhline(0.0, color="0.5", linewidth=0.7)
    axes.set(xlabel=label, ylabel="fitted less measured")
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


def equivalent_figure(table: pd.DataFrame, curves: pd.DataFrame) -> Figure:
    """Both curves; where something was varied, the largest distance and its root mean square over that, too."""
    varied = len(table) > 1
    words = ("the curve", "the nearest of the other model")
    entries = [Line2D([], [], label=label, **look) for label, look in zip(words, CYCLE, strict=False)]
    with mpl.rc_context(STYLE):
        sheet = Sheet.blank(2 if varied else 1, Heading(), entries)
        axes = sheet.axes(0)
        for name, look in zip(("of", "among"), CYCLE, strict=False):
            axes.plot(curves["belt_speed"], curves[name], **look)
        axes.set(xlabel=word("scene.belt_speed"), ylabel=word("mean_friction"))
        if varied:
            over = table.columns[0]
            axes.set_title(
                f"{word(f'scene.{over}')}: {table[over][table['distance'].first_valid_index()]:g}", loc="left"
            )
            axes = sheet.axes(1)
            for name, label, mark in (("distance", "distance", "o"), ("rms", "root mean square", "s")):
                axes.plot(table[over], np.asarray(table[name]), color="0.25", marker=mark, label=label)
            axes.set(xlabel=word(f"scene.{over}"), ylabel="distance of mean friction")
            axes.set_ylim(bottom=0.0)
            axes.legend()
    return sheet.figure


_HEIGHT = 3.4  # [inch]


def impedance_figure(speeds: Any, frequencies: Any, values: Any) -> Figure:
    """A line for each belt speed; arrays of one shape: belt speeds, circular frequencies, impedances.

    In the complex plane a mark stands at the lowest frequency; left of the upright line friction feeds a motion.
    """
    speeds, frequencies, values = (np.ravel(each) for each in (speeds, frequencies, values))
    with mpl.rc_context(STYLE):
        figure = blank_figure(PAGE, _HEIGHT)
        grid = figure.add_gridspec(2, 2)
        modulus = figure.add_subplot(grid[0, 0])
        phase = figure.add_subplot(grid[1, 0], sharex=modulus)
        plane = figure.add_subplot(grid[:, 1])
        entries = []
        for place, speed in enumerate(dict.fromkeys(speeds.tolist())):
            own = np.flatnonzero((speeds == speed) & np.isfinite(values))
            own = own[np.argsort(frequencies[own], kind="stable")]
            look, z = CYCLE[place % len(CYCLE)], values[own]
            drawn = frequencies[own] > 0.0  # zero has no place on a logarithmic axis
            omega = frequencies[own][drawn]
            modulus.plot(omega, np.abs(z)[drawn], **look)
            phase.plot(omega, np.angle(z, deg=True)[drawn], **look)
            plane.plot(z.real, z.imag, **look)
            plane.plot(z.real[:1], z.imag[:1], color=look["color"], marker="o")
            entries.append(Line2D([], [], label=f"belt speed {speed:g}", **look))
        scales = ("log" if (np.abs(each) > 0.0).any() else "linear" for each in (frequencies, values))
        modulus.set(ylabel=r"modulus $|Z|$", **dict(zip(("xscale", "yscale"), scales, strict=True)))
        modulus.tick_params(labelbottom=False)
        phase.set(xlabel="circular frequency", ylabel="phase [degrees]", ylim=(-190, 190))
        phase.set_yticks([-180, -90, 0, 90, 180])
        plane.set(
            xlabel=r"real part of $Z$: damping",
            ylabel=r"imaginary part of $Z$: inertia, or stiffness below 0",
        )
        for line in (plane.axvline, plane.axhline):
            line(0.0, color="0.5", linewidth=0.6, zorder=0)
        Sheet(figure, 2, 2).add_legend(entries)
    return figure
