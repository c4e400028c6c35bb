"""A closer view of the part of a picture in which its lines differ, where much of the rest is level."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from matplotlib.axes import Axes

from frictionlab.charts.curves import LEAST_VISIBLE, CurveNumbers

LEVEL_SHARE = 0.4  # of a linear axis, up to its right end: with less of it level there is no closer view
DIFFER_MOST = 0.3  # of the largest difference: from there on curves are shown closer
GAP, LABELS = 0.07, 0.04  # to the level part around, and for labels of the view, in shares of the picture
Points = tuple[CurveNumbers, CurveNumbers]


def draw_closer_view(axes: Axes, curves: Sequence[Points], draw: Callable[[Axes], None]) -> None:
    """Draw the lines anew where they differ, or where they change, in the room under or over their level part.

    Nothing is drawn where less than LEVEL_SHARE of a linear axis, up to its right end, is level.
    """
    finite = [np.isfinite(x) & np.isfinite(y) for x, y in curves]
    curves = [(x[known], y[known]) for (x, y), known in zip(curves, finite, strict=True)]
    window = _level_from(curves)
    if window is None or axes.get_xscale() != "linear" or axes.get_yscale() != "linear":
        return
    start, level = window
    ends = axes.transData.transform([(start, level), (axes.get_xlim()[1], axes.get_ylim()[1])])
    (left, bottom), (right, _) = axes.transAxes.inverted().transform(ends)
    foot, top = (0.1, bottom - GAP) if bottom > 0.5 else (bottom + GAP, 0.95)
    if top - foot < 0.25:
        return
    first = left + GAP + LABELS
    inside = axes.inset_axes((first, foot + GAP, right - first - 0.5 * GAP, top - foot - GAP))
    draw(inside)
    low, high = _of_interest(curves, start)
    heights = np.concatenate([y[(x >= low) & (x <= high)] for x, y in curves])
    margin = 0.08 * float(np.ptp(heights))
    inside.set_xlim(low, high)
    inside.set_ylim(float(heights.min()) - margin, float(heights.max()) + margin)
    inside.tick_params(labelsize=5.5, length=2)
    axes.indicate_inset_zoom(inside, edgecolor="0.45", linewidth=0.5)


def _level_from(curves: Sequence[Points]) -> tuple[float, float] | None:
    """From where on, and at which level, all curves stay within what can be seen; None for less than LEVEL_SHARE."""
    known = [(x, y) for x, y in curves if len(x) > 2]
    if not known:
        return None
    least = LEAST_VISIBLE * float(np.ptp(np.concatenate([y for _, y in known])))
    changes = [np.append(True, np.abs(y - y[-1]) > least) for _, y in known]
    start = max(float(x[np.flatnonzero(each)[-1] - 1]) for (x, _), each in zip(known, changes, strict=True))
    low, high = min(float(x[0]) for x, _ in known), max(float(x[-1]) for x, _ in known)
    levels = [float(y[-1]) for _, y in known]
    if np.ptp(levels) > least or not low < start <= high - LEVEL_SHARE * (high - low):
        return None
    return start, levels[0]


def _of_interest(curves: Sequence[Points], start: float) -> tuple[float, float]:
    """The part before the level one in which several curves differ most; all of it where they do not, or for one."""
    first = min(float(x[0]) for x, _ in curves)
    at = np.linspace(first, start, 400)
    heights = np.array([np.interp(at, x, y) for x, y in curves])
    apart = np.ptp(heights, axis=0)
    if apart.max() <= 2.0 * LEAST_VISIBLE * float(np.ptp(heights)):
        return first, start
    apart = apart > DIFFER_MOST * apart.max()
    margin = 0.1 * (start - first)
    return max(first, float(at[apart][0]) - margin), min(start, float(at[apart][-1])) + margin
