"""Belt speeds chosen as a run goes: in rounds, each the ordinary run of the speeds that the one before asked for.

Where a curve of mean friction needs more points: the intervals in which straight lines may be too far off.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from frictionlab.laws.base import FrictionLaw
from frictionlab.runner.packing import numbers_of
from frictionlab.runner.pieces import Piece, TableBlock
from frictionlab.runner.solving import Solving
from frictionlab.scene.scene import Scene
from frictionlab.study.axes import CLOSEST_SPEEDS, MOST_CHOSEN, WITHIN, SpeedRange
from frictionlab.study.grid import StudyCurve, grid_size
from frictionlab.study.study import Study
from frictionlab.theory import friction_free_velocity
from frictionlab.values.notes import Mistake, StudyError
from frictionlab.values.quantities import Floats

_MARGIN = 1.5
"""Over the deviation of a parabola from its chord, where neighbouring curvatures agree, and over that of a triangle:
between points slopes may rise to a kink and fall behind it."""
_WIDEST = 3.0
"""Times a finer neighbour that an interval may be wide, before it is judged as if slopes turned in it."""


def halves_to_add(
    speeds: Floats, means: Floats, errors: Floats, breaks: Floats, within: float, closest: float
) -> Floats:
    """Return the middle of every interval in which a chord may deviate from the curve by more than ``within``.

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
    """Return how far a curve may be from each of the chords between its points; infinite of two points alone.

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
    """Check whether the curvature around an interval has one sign and, but for a factor of two, one size."""
    near = _around(curvature, 2)
    low, high = np.nanmin(near, axis=1), np.nanmax(near, axis=1)
    ends_known = np.isfinite(near[:, 1]) & np.isfinite(near[:, 2])
    return (
        ends_known
        & (low * high > 0.0)
        & (np.maximum(-low, high) <= 2.0 * np.minimum(np.abs(low), np.abs(high)))
    )


Known = tuple[Floats, Floats, Floats]
"""Belt speeds of a curve, ascending, their mean friction and its error; NaN where there is no number."""

_SHARES = (0.025, 0.05, *(0.1 * k for k in range(1, 10)))
"""Shares of V_lin that the shape of a curve is read from where no more belt speeds are asked for."""


class ChosenSpeeds(NamedTuple):
    """A study with its belt speeds, where the answers of all rounds are, and whether the last was interrupted."""

    study: Study
    solving: Solving
    stopped: bool


def _in_one(rounds: Sequence[Solving], study: Study) -> Solving:
    """Return the pieces of all rounds with their rows in the table of the study, which holds all belt speeds."""
    curves, pieces = list(study.curves()), list[Piece]()
    for one in rounds:
        rows = np.empty(one.points, np.int64)
        for each, whole in zip(one.curves, curves, strict=True):
            rows[each.rows.start : each.rows.stop] = whole.rows.start + np.searchsorted(
                whole.scenes.given, each.scenes.given
            )
        pieces += [replace(piece, rows=rows[piece.rows]) for block in one.blocks for piece in block.pieces]
    last = rounds[-1]
    found = Solving(curves, last.task, last.store, last.keys, [TableBlock(range(len(curves)), pieces)])
    found.rest = last.rest
    return found


def choose_speeds(study: Study, solve: Callable[[list[StudyCurve]], tuple[Solving, bool]]) -> ChosenSpeeds:
    """Solve at more and more belt speeds until chords are within what the study says; those of a scene are shared.

    Every law and method of a scene is solved at all of its belt speeds: begin with evenly spaced ones and V_lin, then
    halve each interval in which a curve asks for it. Raises StudyError where that would take too many points.
    """
    along = study.chosen_range
    assert along is not None
    curves = list(study.with_speeds([along.first()] * len(study.scenes_along)).curves())
    count = len(study.scenes_along)
    breaks = [
        _breaks([each.law for each in curves[at::count]], curves[at].scenes.scene, along)
        for at in range(count)
    ]
    named = _named(study, along)
    new = [_first(along, each, named) for each in breaks]
    speeds, known, rounds, stopped = new, [_nothing()] * len(curves), list[Solving](), False
    while any(map(len, new)) and not stopped:
        one = study.with_speeds([each.tolist() for each in new])
        curves = list(one.curves())
        solving, stopped = solve(curves)
        rounds.append(solving)
        known = [_merged(*both) for both in zip(known, _found(solving), strict=True)]
        asked = [_asked(known[at::count], breaks[at], along) for at in range(count)]
        new = [each if not stopped else np.empty(0) for each in asked]
        speeds = [np.union1d(*both) for both in zip(speeds, new, strict=True)]
        _check_size(study.with_speeds([each.tolist() for each in speeds]), along)
    whole = study.with_speeds([each.tolist() for each in speeds])
    return ChosenSpeeds(whole, _in_one(rounds, whole), stopped)


def _check_size(study: Study, along: SpeedRange) -> None:
    if (size := grid_size(study)) > MOST_CHOSEN:
        name = "study" if study.path is None else str(study.path)
        path = next(path for path, each in study.ranges.items() if each is along)
        what = (
            f"takes more than {size} points, and {MOST_CHOSEN} at most are chosen: give a larger one, or num"
        )
        raise StudyError([Mistake(name, None, f"sweep.{path}.{WITHIN}", what)])


def _breaks(laws: Sequence[FrictionLaw], scene: Scene, along: SpeedRange) -> Floats:
    """V_lin of a scene under each of its laws, and its mirror image, where they lie inside the range."""
    si = scene.dimensional
    scale = 1.0 if si is None else si.scales.velocity
    sizes = {scale * friction_free_velocity(scene, law) for law in laws}
    found = [sign * size for size in sizes if math.isfinite(size) for sign in (-1.0, 1.0)]
    near = CLOSEST_SPEEDS * (along.stop - along.start)
    return np.unique([each for each in found if along.start + near < each < along.stop - near])


def _named(study: Study, along: SpeedRange) -> Floats:
    """Return the belt speeds in the range that the study expects something of."""
    path = next(path for path, each in study.ranges.items() if each is along)
    wanted = [each.where[path] for each in study.expect if path in each.where]
    found = [one for each in wanted for one in (each if isinstance(each, list) else [each])]
    return np.array([each for each in found if isinstance(each, float) and along.start <= each <= along.stop])


def _first(along: SpeedRange, breaks: Floats, named: Floats) -> Floats:
    """Evenly spaced belt speeds, and V_lin and those named in place of any that are nearly there.

    Of a curve that bends within few of them also shares of V_lin, from which its shape can be read.
    """
    even, near = np.array(along.first()), CLOSEST_SPEEDS * (along.stop - along.start)
    below = [
        share * each
        for each in breaks
        if (np.abs(even) < abs(each)).sum() < len(_SHARES)
        for share in _SHARES
    ]
    inside = [each for each in below if along.start + near < each < along.stop - near]
    wanted = np.unique(np.concatenate([breaks, named, inside]))
    far = [bool((np.abs(wanted - each) > near).all()) for each in even]
    return np.union1d(even[far], wanted)


def _asked(known: Sequence[Known], breaks: Floats, along: SpeedRange) -> Floats:
    """Return the belt speeds that the curves of one scene still need."""
    closest = CLOSEST_SPEEDS * (along.stop - along.start)
    return np.unique(np.concatenate([halves_to_add(*each, breaks, along.within, closest) for each in known]))


def _nothing() -> Known:
    return np.empty(0), np.empty(0), np.empty(0)


def _found(solving: Solving) -> list[Known]:
    answers = solving.answers()
    means, errors = numbers_of(answers, "mean_friction"), numbers_of(answers, "error")
    rows = [slice(each.rows.start, each.rows.stop) for each in solving.curves]
    return [
        (each.scenes.given, means[own], errors[own]) for each, own in zip(solving.curves, rows, strict=True)
    ]


def _merged(known: Known, found: Known) -> Known:
    speeds, means, errors = (np.concatenate(both) for both in zip(known, found, strict=True))
    rising = np.argsort(speeds, kind="stable")
    return speeds[rising], means[rising], errors[rising]
