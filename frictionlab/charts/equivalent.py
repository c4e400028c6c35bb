"""Two curves brought near each other, and their distance over what was varied."""

from __future__ import annotations

import matplotlib as mpl
import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from frictionlab.charts.sheet import Heading, Sheet
from frictionlab.charts.style import CYCLE, STYLE
from frictionlab.columns import word


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
