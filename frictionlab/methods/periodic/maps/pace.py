"""The steps of one motion, kept to be taken again by motions close by.

Two maps whose steps are each chosen by their own error differ by as much as either is wrong wherever one step more is
repeated, or one less. Over the same steps the end is a smooth function of the start, however coarse they are, and
difference quotients by small shifts are as good as the map.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from frictionlab.compile.decorators import inner

MOST_KEPT = 4096


class Pace(NamedTuple):
    """Of each step how long it was tried and by what kind of event it ended before that (0: none); their count [1].

    More than there is room for are counted, and not kept.
    """

    lengths: Any
    endings: Any
    taken: Any


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
