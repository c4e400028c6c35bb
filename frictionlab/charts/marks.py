"""Marks on the axis of belt speed: onsets below the picture, V_lin above it, each named with what it belongs to.

The names of curves at their right ends, in place of a legend, where they all fit there.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from frictionlab.charts.curves import CurveData, CurveNumbers
from frictionlab.charts.looks import Looks
from frictionlab.charts.sheet import LEGEND_FONT, text_width
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


MOST_LABELS, APART = 7, 9.0  # at one picture; from one to the next [point]
TOLD_APART, MOST_SHIFT = 3.0, 12.0  # between ends of curves, and from an end to its name [point]
HEIGHT, GAP = 110.0, 9.0  # of the inside of a picture, about, and from an end to its name [point]
WIDEST = 0.3  # of a picture


class CurveEnd(NamedTuple):
    """Right end of a curve, its name and its colour."""

    x: float
    y: float
    name: str
    color: Any


def ends_fit(axes: Axes, ends: Sequence[CurveEnd], width: float) -> bool:
    """Check whether all names fit beside a picture of this width [point], each at an end of its own."""
    if not 1 < len(ends) <= MOST_LABELS or len({end.x for end in ends}) > 1:
        return False
    if max(text_width(axes.figure, end.name, LEGEND_FONT) for end in ends) > WIDEST * width:
        return False
    heights = np.sort(_heights(axes, ends))
    return bool(
        np.diff(heights).min() >= TOLD_APART and np.abs(moved_apart(heights) - heights).max() <= MOST_SHIFT
    )


def draw_end_labels(axes: Axes, ends: Sequence[CurveEnd]) -> None:
    """Every name beside its end, with a line to it where it had to give way to another."""
    heights = _heights(axes, ends)
    order = np.argsort(heights)
    for at, place in zip(order, moved_apart(heights[order]), strict=True):
        end, shift = ends[at], float(place - heights[at])
        line: Any = {"arrowstyle": "-", "color": end.color, "linewidth": 0.5, "shrinkA": 0, "shrinkB": 0}
        axes.annotate(
            end.name,
            (end.x, end.y),
            (GAP, shift),
            textcoords="offset points",
            va="center",
            fontsize=LEGEND_FONT,
            arrowprops=line,
            annotation_clip=False,
        )


def moved_apart(heights: CurveNumbers) -> CurveNumbers:
    """Ascending places moved as little as may be until each is ``APART`` from the next."""
    steps = APART * np.arange(len(heights))
    blocks: list[tuple[float, int]] = []  # mean place without the steps, and how many there are
    for place in heights - steps:
        mean, count = float(place), 1
        while blocks and blocks[-1][0] > mean:
            before, others = blocks.pop()
            mean, count = (mean * count + before * others) / (count + others), count + others
        blocks.append((mean, count))
    return np.repeat([mean for mean, _ in blocks], [count for _, count in blocks]) + steps


def _heights(axes: Axes, ends: Sequence[CurveEnd]) -> CurveNumbers:
    """Return the heights of ends above the foot of the picture [point]."""
    places = axes.transScale.transform([(end.x, end.y) for end in ends])[:, 1]
    low, high = axes.transScale.transform([(ends[0].x, level) for level in axes.get_ylim()])[:, 1]
    return np.asarray(HEIGHT * (places - low) / (high - low))
