"""Marks of onsets on curves: which lie on which curve, and what they look like."""

from __future__ import annotations

from collections.abc import Container, Sequence
from typing import Any, NamedTuple

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from frictionlab.charts.curves import CurveData
from frictionlab.columns import BELT_SPEED, ONSETS, belt_speed

SIGNS = {"stick_begins": ">", "stick_ends": "<", "reversal_ends": "d", "multiplier_leaves": "*"}
"""The mark of each on the axis of belt speed: arrowheads enclose a window of stick."""
WORDS = {
    "stick_begins": "stick begins",
    "stick_ends": "stick ends",
    "reversal_ends": "reversal ends",
    "multiplier_leaves": "a multiplier leaves the unit circle",
}


class OnsetMark(NamedTuple):
    """A mark on the axis of belt speed, in its units."""

    onset: str
    at: float


def onsets_on(curve: CurveData, onsets: pd.DataFrame | None, along: str | None = None) -> list[OnsetMark]:
    """Those of a curve, by the inputs that are equal along it; nothing where they are not among its columns.

    along: the column that they are marked along, the belt speed as given where left out.
    """
    if onsets is None or onsets.empty:
        return []
    found = rows_of_curve(curve, onsets, ONSETS)
    scale = speed_scale(curve, along)
    return [OnsetMark(name, scale * at) for name, at in zip(found["onset"], found["belt_speed"], strict=True)]


def rows_of_curve(curve: CurveData, table: pd.DataFrame, columns: Container[str]) -> pd.DataFrame:
    """The rows of a table that are those of a curve, by their inputs: what is not among these columns."""
    keys = [name for name in table.columns if name not in columns and name in curve.rows]
    own = curve.rows.iloc[0]
    same = pd.Series(True, table.index)
    for name in keys:
        same &= table[name].isna() if pd.isna(own[name]) else table[name] == own[name]
    return table[same]


def speed_scale(curve: CurveData, along: str | None = None) -> float:
    """A belt speed in the units of the axis over the nondimensional one."""
    speeds = curve.rows[along or belt_speed(curve.rows.columns)]
    scales = (speeds / curve.rows[BELT_SPEED]).replace([float("inf")], float("nan")).dropna()
    return 1.0 if scales.empty else float(scales.median())


def draw_onsets(axes: Axes, marks: Sequence[OnsetMark], color: Any) -> None:
    """On the axis, dark enough for a grey print whatever the curve's shade."""
    where = axes.get_xaxis_transform()
    for each in marks:
        axes.plot(
            [each.at], [0.0], SIGNS[each.onset], transform=where, clip_on=False, zorder=6, **_look(color)
        )


def onset_entries(marks: Sequence[OnsetMark]) -> list[Line2D]:
    """One entry of the legend for each kind that is drawn."""
    seen = {each.onset for each in marks}
    return [
        Line2D([], [], linestyle="none", marker=sign, label=WORDS[name], **_look("0.6"))
        for name, sign in SIGNS.items()
        if name in seen
    ]


def _look(color: Any) -> dict[str, Any]:
    return {"markersize": 4.5, "markerfacecolor": color, "markeredgecolor": "0.15", "markeredgewidth": 0.5}
