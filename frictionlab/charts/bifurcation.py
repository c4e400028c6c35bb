"""Bifurcation figures: every state that motions end in, against belt speed.

Above the means, below where the mass is at the start of each drive period. A marker per period of the response, so
that the figure reads in black and white; motions that do not repeat are pale bars above, with a dash at their mean
over a long time, and pale dots below.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from frictionlab.charts.sheet import COLUMN, PAGE, Heading, Sheet, blank_figure, write_title
from frictionlab.values.columns import BELT_SPEEDS, INPUTS, SHOWN_IN, shown_column, unit_shown, word

PERIOD_MARKERS: dict[int, tuple[str, str]] = {
    1: ("o", "#000000"),
    2: ("s", "#c2410c"),
    3: ("^", "#0369a1"),
    4: ("D", "#15803d"),
    5: ("v", "#7e22ce"),
    6: ("P", "#be185d"),
}
LONGER = ("x", "#525252")
WILD = "0.57"
DOTS: Any = {"marker": "o", "markersize": 0.9, "mew": 0.0, "ls": "none", "color": "0.55", "rasterized": True}


def bifurcations(attractors: pd.DataFrame) -> dict[str, pd.DataFrame]:
    """Rows of each figure, by its name: one for every curve on which anything was found, with its points."""
    if "point" not in attractors:
        return {}
    inputs = [name for name in attractors.columns if name in INPUTS or name.startswith(("scene.", "law."))]
    curves = [rows for _, rows in attractors.groupby(inputs, sort=False, dropna=False)] if inputs else []
    if len(curves) == 1:
        return {"bifurcation": curves[0]}
    return {f"{number}_bifurcation": rows for number, rows in enumerate(curves, 1)}


def bifurcation_figures(attractors: pd.DataFrame) -> dict[str, Callable[[Heading], Figure]]:
    """Return what draws each of them, by its name."""
    return {name: partial(_figure, rows) for name, rows in bifurcations(attractors).items()}


def _figure(rows: pd.DataFrame, heading: Heading) -> Figure:
    if heading.into is not None:
        raise ValueError("ax takes a figure of one picture, and this has 2; leave ax out")
    figure = blank_figure(COLUMN if heading.width == "single" else PAGE, 4.6)
    write_title(figure, heading)
    above, below = figure.subplots(2, 1, sharex=True)
    speed, place = (shown_column(rows, name) for name in ("belt_speed", "x"))
    states, wild = rows[rows["point"] == 1], rows[rows["period"] == 0]
    long = states[states["period"] == 0]
    for some, color, width in ((long, WILD, 2.0), (states[states["period"] > 1], WILD, 0.5)):
        ends = some["mean_low"], some["mean_high"]
        above.vlines(some[speed], *ends, colors=color, linewidth=width, zorder=1)
    above.plot(long[speed], long["mean_friction"], marker="_", color="0.25", linestyle="none", markersize=4)
    below.plot(wild[speed], wild[place], zorder=1, **DOTS)
    for axes, points, column in ((above, states, "mean_friction"), (below, rows, place)):
        for period, own in points[points["period"] > 0].groupby("period"):
            axes.plot(own[speed], own[column], zorder=3, **_look(int(period)))
    above.set_ylabel(word("mean_friction", 28))
    axis = BELT_SPEEDS[0] if speed == "belt_speed" else f"{BELT_SPEEDS[1]}{SHOWN_IN}{unit_shown(speed)}"
    at = f"start of a drive period [{unit_shown(place)}]" if unit_shown(place) else "start of a drive period"
    below.set(xlabel=word(axis), ylabel=f"position $x_1$ at the\n{at}")
    Sheet(figure, 2, 1).add_legend(list(_legend(states)))
    return figure


def _look(period: int) -> dict[str, Any]:
    marker, color = PERIOD_MARKERS.get(period, LONGER)
    shape = {"marker": marker, "color": color, "markersize": 2.6, "markeredgewidth": 0.7}
    return {**shape, "linestyle": "none", "markerfacecolor": "none" if period > 1 else color}


def _legend(states: pd.DataFrame) -> Iterator[Line2D]:
    found = np.unique(states["period"].to_numpy(dtype=int)).tolist()
    for period in [each for each in found if each in PERIOD_MARKERS]:
        yield Line2D([], [], label="1 period" if period == 1 else f"{period} periods", **_look(period))
    if any(period > max(PERIOD_MARKERS) for period in found):
        yield Line2D([], [], label="more", **_look(max(PERIOD_MARKERS) + 1))
    if 0 in found:
        yield Line2D([], [], color=WILD, linewidth=2.0, label="does not repeat")
