"""Where a curve of mean friction needs more points: the intervals in which straight lines may be too far off."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from frictionlab.quantities import Floats

_MARGIN = 1.5
"""Over the deviation of a parabola from its chord, where neighbouring curvatures agree, and over that of a triangle:
between points slopes may rise to a kink and fall behind it."""
_WIDEST = 3.0
"""Times a finer neighbour that an interval may be wide, before it is judged as if slopes turned in it."""


def halves_to_add(
    speeds: Floats, means: Floats, errors: Floats, breaks: Floats, within: float, closest: float
) -> Floats:
    """The middle of every interval in which a chord may deviate from the curve by more than ``within``.

    speeds: ascending; means, errors: NaN where a point has no number: nothing is known beside one, and nothing added.
    breaks: speeds at which the curve may have a kink, such as V_lin; the points on one side say nothing of the other.
    closest: no interval of at most this length is halved, as one with a jump of friction in it would be for ever.
    """
    found = []
    ends = np.isin(speeds, breaks)
    known = np.isfinite(means)
    start = 0
    for place in range(len(speeds)):
        if known[place] and not (ends[place] and place > start) and place < len(speeds) - 1:
            continue
        stop = place + 1 if known[place] else place
        if stop - start > 1:
            piece = slice(start, stop)
            found.append(_halves(speeds[piece], means[piece], errors[piece], within, closest))
        start = place if known[place] else place + 1
    return np.concatenate(found) if found else np.empty(0)


def _halves(speeds: Floats, means: Floats, errors: Floats, within: float, closest: float) -> Floats:
    widths = np.diff(speeds)
    of_points = 2.0 * np.maximum(errors[:-1], errors[1:])
    wanted = (chord_deviation(speeds, means) > within + of_points) & (widths > closest)
    return (0.5 * (speeds[:-1] + speeds[1:]))[wanted]


def chord_deviation(speeds: Floats, means: Floats) -> Floats:
    """How far a curve may be from each of the chords between its points; infinite of two points alone.

    Where slopes rise from chord to chord, or fall, and go on so between points, the curve lies in the triangle of a
    chord and its neighbours carried on: its height bounds the deviation; a half is added. Where the curvature at
    points around an interval differs by less than a factor of two, the deviation is that of a parabola of the larger
    one, and a half.
    """
    widths = np.diff(speeds)
    if len(widths) < 2:
        return np.full(len(widths), np.inf)
    slopes = np.diff(means) / widths
    bends = np.diff(slopes)
    before, after = np.concatenate([[np.nan], bends]), np.concatenate([bends, [np.nan]])
    both = np.abs(before) + np.abs(after)
    triangle = widths * np.abs(before) * np.abs(after) / np.where(both > 0.0, both, 1.0)
    turning = 0.5 * widths * np.maximum(np.abs(before), np.abs(after))
    finer = np.minimum(np.append(widths[1:], np.inf), np.append(np.inf, widths[:-1]))
    turns = (before * after < 0.0) | (widths > _WIDEST * finer)
    deviation = np.where(turns, turning, _MARGIN * triangle)
    curvature = 2.0 * bends / (widths[:-1] + widths[1:])
    parabola = _MARGIN / 8.0 * widths**2 * _largest(curvature, 1)
    deviation = np.where(_alike(curvature), np.minimum(parabola, deviation), deviation)
    # at an end the neighbour on one side alone bounds it, twice as far as a curve like a root goes
    deviation[0], deviation[-1] = 0.5 * widths[0] * abs(after[0]), 0.5 * widths[-1] * abs(before[-1])
    return deviation


def _around(curvature: Floats, reach: int) -> Floats:
    """For each interval, in a row, the curvature at its ends and, for a reach of 2, at a point beyond each."""
    padded = np.pad(curvature, reach, constant_values=np.nan)
    return np.lib.stride_tricks.sliding_window_view(padded, 2 * reach)


def _largest(curvature: Floats, reach: int) -> Floats:
    return np.nanmax(np.abs(_around(curvature, reach)), axis=1)


def _alike(curvature: Floats) -> NDArray[np.bool_]:
    """Whether the curvature around an interval has one sign and, but for a factor of two, one size."""
    near = _around(curvature, 2)
    low, high = np.nanmin(near, axis=1), np.nanmax(near, axis=1)
    ends_known = np.isfinite(near[:, 1]) & np.isfinite(near[:, 2])
    return (
        ends_known
        & (low * high > 0.0)
        & (np.maximum(-low, high) <= 2.0 * np.minimum(np.abs(low), np.abs(high)))
    )
