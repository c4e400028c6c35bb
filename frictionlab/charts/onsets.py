"""Marks of onsets on curves: which lie on which curve, and what they look like."""

from __future__ import annotations

from collections.abc import Sequence
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


def onsets_on(curve: CurveData, onsets: pd.DataFrame | None) -> list[OnsetMark]:
    """Those of a curve, by the inputs that are equal along it; nothing where they are not among its columns."""
    if onsets is None or onsets.empty:
        return []
    keys = [name for name in onsets.columns if name not in ONSETS and name in curve.rows]
    own = curve.rows.iloc[0]
    same = pd.Series(True, onsets.index)
    for name in keys:
        same &= onsets[name].isna() if pd.isna(own[name]) else onsets[name] == own[name]
    speed = belt_speed(curve.rows.columns)
    scales = (curve.rows[speed] / curve.rows[BELT_SPEED]).replace([float("inf")], float("nan")).dropna()
    scale = 1.0 if speed == BELT_SPEED or scales.empty else float(scales.median())
    found = onsets[same]
    return [OnsetMark(name, scale * at) for name, at in zip(found["onset"], found["belt_speed"], strict=True)]


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
