"""Scene of a law for kernels, and the steps of one motion, kept for motions close by.

A map, its fixed point and its derivative belong to a case. Two maps whose steps are each chosen by their own
error differ by as much as either is wrong, wherever one step more or less is repeated. Over the same steps
the end is a smooth function of the start, however coarse they are. Difference quotients by small shifts are
then as good as the map.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from frictionlab.compile.decorators import inner
from frictionlab.motion.equation import in_piece
from frictionlab.motion.orbit.recorder import Track, track_of
from frictionlab.scene.body import BodyNumbers


class Case(NamedTuple):
    """Law and body on a belt; zero: of the type of its positions, float or complex."""

    law: Any
    body: BodyNumbers
    belt_speed: float
    zero: Any


@inner
def case_of(law: Any, body: BodyNumbers, belt_speed: float) -> Case:
    """Return the case of a body, whose own numbers tell whether it moves on a line or in the plane."""
    return Case(law, body, belt_speed, body.reference_sine - body.reference_sine)


@inner
def case_in_piece(case: Case, k: int) -> Case:
    """Return the case with the functions of time that hold in the k-th piece of its span."""
    return Case(case.law, in_piece(case.body, k), case.belt_speed, case.zero)


MOST_KEPT = 4096


class Pace(NamedTuple):
    """Steps of a motion: tried length and kind of event that ended it earlier (0: none); their count [1].

    Steps beyond the room of the arrays are counted, and not kept.
    """

    lengths: Any
    endings: Any
    taken: Any


class Stepping(NamedTuple):
    """Options of the steps of a map.

    accuracy: of each step, in the norm of energy. track: records every piece of the motion, if it has room.
    pace: keeps every step, if it has room. repeats: take the steps kept in the pace again instead of choosing
    them.
    """

    accuracy: float
    track: Track
    pace: Pace
    repeats: bool


@inner
def pace_of(room: int) -> Pace:
    """Return a pace without steps; with room for none, none are kept."""
    return Pace(np.empty(room), np.empty(room, np.int64), np.zeros(1, np.int64))


@inner
def keep_step(pace: Pace, tried: float, ending: int) -> None:
    """Add a step to a pace with room."""
    count = pace.taken[0]
    if count < pace.lengths.size:
        pace.lengths[count], pace.endings[count] = tried, ending
    pace.taken[0] = count + 1


@inner
def noting(accuracy: float, track: Track) -> Stepping:
    """Return the options for steps of this accuracy that are recorded on a track with room."""
    return Stepping(accuracy, track, pace_of(0), False)


@inner
def keeping(accuracy: float, pace: Pace) -> Stepping:
    """Return the options for steps of this accuracy that are kept in a pace with room."""
    return Stepping(accuracy, track_of(0), pace, False)


@inner
def repeating(accuracy: float, pace: Pace) -> Stepping:
    """Return the options for taking the steps of a pace again; accuracy: of the events located anew."""
    return Stepping(accuracy, track_of(0), pace, True)
