"""The names of curves at their right ends, in place of a legend, where they all fit there."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes

from frictionlab.charts.curves import CurveNumbers
from frictionlab.charts.sheet import LEGEND_FONT, text_width

MOST_LABELS, APART = 7, 9.0  # at one picture; from one to the next [point]
TOLD_APART, MOST_SHIFT = 3.0, 12.0  # between ends of curves, and from an end to its name [point]
HEIGHT, GAP = 110.0, 9.0  # of the inside of a picture, about, and from an end to its name [point]
WIDEST = 0.3  # of a picture


class CurveEnd(NamedTuple):
    """The right end of a curve, its name and its colour."""

    x: float
    y: float
    name: str
    color: Any


def ends_fit(axes: Axes, ends: Sequence[CurveEnd], width: float) -> bool:
    """Whether all names fit beside a picture of this width [point], each at an end of its own."""
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
    """Of ends above the foot of the picture [point]."""
    places = axes.transScale.transform([(end.x, end.y) for end in ends])[:, 1]
    low, high = axes.transScale.transform([(ends[0].x, level) for level in axes.get_ylim()])[:, 1]
    return np.asarray(HEIGHT * (places - low) / (high - low))
