"""How far apart models are, experiment by experiment: a picture for each input that was varied."""

from __future__ import annotations

from collections.abc import Sequence

import matplotlib as mpl
import pandas as pd
from matplotlib.figure import Figure

from frictionlab.charts.sheet import Heading, Sheet
from frictionlab.charts.style import CYCLE, STYLE
from frictionlab.columns import word


def experiments_figure(table: pd.DataFrame, inputs: Sequence[str]) -> Figure:
    """The smallest distance between two models over the standard error; the best experiment is filled."""
    with mpl.rc_context(STYLE):
        sheet = Sheet.blank(len(inputs), Heading())
        for place, name in enumerate(inputs):
            axes = sheet.axes(place)
            look = {"color": CYCLE[0]["color"], "linestyle": "none", "marker": "o"}
            axes.plot(table[name], table["apart"], markersize=3.0, markerfacecolor="white", **look)
            axes.plot(table[name].iloc[:1], table["apart"].iloc[:1], markersize=6.0, **look)
            axes.set(xlabel=word(f"scene.{name}"), ylabel=r"smallest distance over $\sigma$")
            axes.set_ylim(bottom=0.0)
    return sheet.figure
