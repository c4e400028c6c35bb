"""The arrays into which a kernel writes an orbit, panel by panel."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from frictionlab.compile.decorators import inner
from frictionlab.orbit.panels import NODES


class Track(NamedTuple):
    """Arrays for the panels of an orbit [panels, nodes], stick [panels], and the number of panels written [1]."""

    tau: Any
    x: Any
    v: Any
    friction: Any
    stick: Any
    filled: Any


@inner
def track_of(room: int) -> Track:
    """An empty track for at most ``room`` panels; with 0 nothing is recorded."""
    nodes = NODES.size
    return Track(
        np.empty((room, nodes)),
        np.empty((room, nodes), np.complex128),
        np.empty((room, nodes), np.complex128),
        np.empty((room, nodes), np.complex128),
        np.zeros(room, np.bool_),
        np.zeros(1, np.int64),
    )


@inner
def grown(track: Track, room: int) -> Track:
    """The same track with more room."""
    larger = track_of(room)
    for panel in range(track.filled[0]):
        larger.stick[panel] = track.stick[panel]
        for node in range(NODES.size):
            larger.tau[panel, node], larger.x[panel, node] = track.tau[panel, node], track.x[panel, node]
            larger.v[panel, node] = track.v[panel, node]
            larger.friction[panel, node] = track.friction[panel, node]
    larger.filled[0] = track.filled[0]
    return larger


def panel_writer(state_at: Any) -> Any:
    """``note_panel(track, tau, h, stick, *given)`` for a kernel function ``state_at(part, *given)`` of one motion.

    It writes the panel that begins at tau and lasts h, if there is room for it; state_at gives position, velocity and
    friction coefficient a while ``part`` after the beginning. (numba caches no kernel that is handed a function.)
    """

    @inner
    def note_panel(track: Track, tau: float, h: float, stick: bool, *given: Any) -> None:
        # Room for no panel at all is how maps are asked not to record.
        row = track.filled[0]
        if row == track.stick.size:
            return
        for k in range(NODES.size):
            part = 0.5 * h * (1.0 + NODES[k])
            x, v, rub = state_at(part, *given)
            track.tau[row, k] = tau + part
            track.x[row, k] = x
            track.v[row, k] = v
            track.friction[row, k] = rub
        track.stick[row] = stick
        track.filled[0] = row + 1

    return note_panel
