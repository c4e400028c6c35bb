"""The record of an orbit while a kernel follows it, piece by piece."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from frictionlab.compile.decorators import inner
from frictionlab.orbit.panels import NODES


class Track(NamedTuple):
    """Room for the panels of an orbit [panels, nodes], stick [panels], and how many are filled [1]."""

    tau: Any
    x: Any
    v: Any
    friction: Any
    stick: Any
    filled: Any


@inner
def track_of(room: int) -> Track:
    """An empty track with room for so many panels; none to note nothing."""
    nodes = NODES.size
    return Track(
        np.empty((room, nodes)),
        np.empty((room, nodes), np.complex128),
        np.empty((room, nodes), np.complex128),
        np.empty((room, nodes), np.complex128),
        np.zeros(room, np.bool_),
        np.zeros(1, np.int64),
    )
