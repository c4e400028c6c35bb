"""Marks on the axis of belt speed: onsets below the picture, V_lin above it, each named with what it belongs to."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from frictionlab.charts.curves import CurveData
from frictionlab.charts.looks import Looks
from frictionlab.charts.sheet import text_width
from frictionlab.values.columns import ONSETS

SIGNS = {"stick_begins": ">", "stick_ends": "<", "reversal_ends": "d"}
"""Mark of each on the axis of belt speed: arrowheads enclose a window of stick."""
ONSET_LOOK: Any = {"markersize": 4.5, "markeredgecolor": "0.15", "markeredgewidth": 0.5}
SAME_SPEED = 1e-6  # share of a belt speed: an onset and V_lin closer than this are one
MOST_LINES = 3  # of names above a picture
NAME_FONT, NAME_LINE = 6.5, 8.0  # [point]


class OnsetMark(NamedTuple):
    """A mark on the axis of belt speed, in its units."""

    onset: str
    at: float


def onsets_on(curve: CurveData, onsets: pd.DataFrame | None, along: str | None = None) -> list[OnsetMark]:
    """Return the onsets of a curve, by the inputs equal along it, but for an end of reversal that is V_lin.

    along: the column that they are marked along, the belt speed as given where left out.
    """
    if onsets is None or onsets.empty:
        return []
    found, scale = curve.rows_in(onsets, ONSETS), curve.speed_scale(along)
    marks = map(OnsetMark, found["onset"], scale * found["belt_speed"])
    return [mark for mark in marks if mark.onset != "reversal_ends" or not _is_kink(mark.at, curve)]


def _is_kink(at: float, curve: CurveData) -> bool:
    return any(abs(at - kink) <= SAME_SPEED * abs(kink) for kink in curve.kinks)


def draw_onsets(axes: Axes, marks: Sequence[OnsetMark], color: Any) -> None:
    """On the axis, dark enough for a grey print whatever the curve's shade."""
    where: Any = {"transform": axes.get_xaxis_transform(), "clip_on": False, "zorder": 6}
    for each in marks:
        axes.plot([each.at], [0.0], SIGNS[each.onset], markerfacecolor=color, **where, **ONSET_LOOK)


def onset_entries(marks: Sequence[OnsetMark]) -> list[Line2D]:
    """One entry of the legend for each kind that is drawn."""
    seen = [name for name in SIGNS if name in {each.onset for each in marks}]
    look: Any = {"linestyle": "none", "markerfacecolor": "0.6", **ONSET_LOOK}
    return [Line2D([], [], marker=SIGNS[name], label=name.replace("_", " "), **look) for name in seen]


def draw_speed_marks(axes: Axes, curves: Sequence[CurveData], looks: Looks, width: float) -> float:
    """A thin line at every V_lin and its name above the picture; the room that takes [point].

    Where the picture has several, each has the look of its curve and is named with the swept value that it is for.
    A name without room is left out: its line then has the curve's marker alone. width: of the picture [point].
    """
    first: dict[float, CurveData] = {}
    for curve in curves:
        for at in curve.kinks:
            if all(abs(at - other) > 1e-9 * abs(at) for other in first):
                first[at] = curve
    several = len({abs(at) for at in first}) > 1
    pad, ends = 3.0 if several else 1.0, list[float]()  # of the names in each line above the picture
    above = axes.get_xaxis_transform()
    for at, curve in sorted(first.items(), key=lambda mark: mark[0]):
        look, name = looks.line(curve), _name(at, curve, several)
        axes.axvline(at, color=look["color"] if several else "0.45", linewidth=0.6, zorder=0)
        if several:
            axes.plot([at], [1.0], look["marker"], color=look["color"], ms=3, clip_on=False, transform=above)
        half = 0.5 * text_width(axes.figure, name, NAME_FONT) + 2.0
        centre = width * _share_of_axis(axes, at)
        line = next((i for i, end in enumerate(ends) if end < centre - half), len(ends))
        if line < MOST_LINES:
            ends[line:] = [centre + half, *ends[line + 1 :]]
            place = (0.0, pad + NAME_LINE * line)
            note = axes.annotate(name, (at, 1.0), place, above, "offset points", fontsize=NAME_FONT)
            note.set(ha="center", va="bottom")
    return pad + NAME_LINE * len(ends) if ends else 0.0


def _share_of_axis(axes: Axes, at: float) -> float:
    place, low, high = (axes.transScale.transform((x, 1.0))[0] for x in (at, *axes.get_xlim()))
    return float((place - low) / (high - low))


def _name(at: float, curve: CurveData, several: bool) -> str:
    name = r"$V_\mathrm{lin}$" if at > 0 else r"$-V_\mathrm{lin}$"
    if not several or curve.member is None:
        return name
    return f"{name}, {curve.member.brief}"
