"""One scene of a law as kernels see it: what a period map, its fixed point and its derivative belong to.

The steps of one motion, kept to be taken again by motions close by.

Two maps whose steps are each chosen by their own error differ by as much as either is wrong wherever one step more is
repeated, or one less. Over the same steps the end is a smooth function of the start, however coarse they are, and
difference quotients by small shifts are as good as the map.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from frictionlab.compile.decorators import inner
from frictionlab.motion.equation import in_piece
from frictionlab.motion.orbit.recorder import Track, track_of
from frictionlab.scene.body import BodyNumbers


class Case(NamedTuple):
    """Law and body on a belt; ``zero`` is a zero of the kind of its positions, float or complex."""

    law: Any
    body: BodyNumbers
    belt_speed: float
    zero: Any


@inner
def case_of(law: Any, body: BodyNumbers, belt_speed: float) -> Case:
    """The case of a body, whose own numbers tell whether it moves on a line or in the plane."""
    return Case(law, body, belt_speed, body.reference_sine - body.reference_sine)


@inner
def case_in_piece(case: Case, k: int) -> Case:
    """The case as the k-th piece of its span has it."""
    return Case(case.law, in_piece(case.body, k), case.belt_speed, case.zero)


MOST_KEPT = 4096


class Pace(NamedTuple):
    """Of each step how long it was tried and by what kind of event it ended before that (0: none); their count [1].

    More than there is room for are counted, and not kept.
    """

    lengths: Any
    endings: Any
    taken: Any


class Stepping(NamedTuple):
    """How a map steps.

    accuracy: of each step, in the norm of energy. track: notes every piece of the way where it has room. pace: keeps
    every step where it has room. repeats: whether instead the steps kept in the pace are taken again.
    """

    accuracy: float
    track: Track
    pace: Pace
    repeats: bool


@inner
def pace_of(room: int) -> Pace:
    """No steps yet; with room for none, none are kept."""
    return Pace(np.empty(room), np.empty(room, np.int64), np.zeros(1, np.int64))


@inner
def keep_step(pace: Pace, tried: float, ending: int) -> None:
    """Add a step to those of a pace with room."""
    count = pace.taken[0]
    if count < pace.lengths.size:
        pace.lengths[count], pace.endings[count] = tried, ending
    pace.taken[0] = count + 1


@inner
def noting(accuracy: float, track: Track) -> Stepping:
    """Steps of this accuracy, their way noted on a track with room."""
    return Stepping(accuracy, track, pace_of(0), False)


@inner
def keeping(accuracy: float, pace: Pace) -> Stepping:
    """Steps of this accuracy, kept in a pace with room."""
    return Stepping(accuracy, track_of(0), pace, False)


@inner
def repeating(accuracy: float, pace: Pace) -> Stepping:
    """The steps that a pace has kept; accuracy: of the events located anew."""
    return Stepping(accuracy, track_of(0), pace, True)
