"""The derivative of the period map of planar slip: each orbit in eight lanes, shifted there and back along the four
directions of its state.

The lanes take the same steps. The end is then a smooth function of the start, however coarse they are, and central
difference quotients by small shifts are as good as the map.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from frictionlab.compile.decorators import inner
from frictionlab.compile.lane_arrays import room_for
from frictionlab.dynamics.motion import belt_advance
from frictionlab.methods.periodic.lane_map import LaneRows, lane_map, rows_for
from frictionlab.numerics.linalg import norm
from frictionlab.scene.body import BodyNumbers

LANES_OF_AN_ORBIT = 8
SHIFT = 1e-6
"""Of the size of a state."""
COARSE = 1e-9
"""Accuracy of the steps, of the size of a state: multipliers are wrong by some hundred times that where slip grazes
rest, else by a tenth of it."""


@inner
def _write_shifted(rows: LaneRows, belt_speed: float, z: Any, shift: float, first: int) -> None:
    for k in range(LANES_OF_AN_ORBIT):
        rows.belt_speed[first + k] = belt_speed
        for row in range(4):
            moved = shift if k % 2 == 0 else -shift
            rows.state[row, first + k] = z[row] + (moved if row == k // 2 else 0.0)


@inner
def _write_monodromy(rows: LaneRows, shift: float, first: int, matrix: Any) -> None:
    """The matrix, NaN where a lane was left."""
    for k in range(LANES_OF_AN_ORBIT):
        shift = shift if rows.arrived[first + k] > 0.0 else np.nan
    for column in range(4):
        for row in range(4):
            ahead, behind = rows.residual[row, first + 2 * column], rows.residual[row, first + 2 * column + 1]
            matrix[row, column] = (ahead - behind) / (2.0 * shift) + (1.0 if row == column else 0.0)


@inner
def differentiate_in_lanes(law: Any, body: BodyNumbers, belt_speeds: Any, states: Any) -> Any:
    """The monodromies of these orbits [n, 4, 4]; NaN where they come next to rest."""
    n = belt_speeds.size
    matrices, lanes = np.empty((n, 4, 4)), room_for(LANES_OF_AN_ORBIT * n)
    rows, orbits = rows_for(lanes), lanes // LANES_OF_AN_ORBIT
    shifts = np.empty(orbits)
    for begin in range(0, n, orbits):
        size = 0.0
        for k in range(orbits):
            i = min(begin + k, n - 1)  # lanes that are left over repeat the last orbit
            z, belt_speed = states[i], belt_speeds[i]
            way = abs(belt_advance(body, belt_speed))
            # the pattern of events hangs on the way of the belt
            shifts[k], size = min(SHIFT * (1.0 + norm(z)), max(0.01 * way, 1e-3 * SHIFT)), max(size, norm(z))
            _write_shifted(rows, belt_speed, z, shifts[k], LANES_OF_AN_ORBIT * k)
        lane_map(law, body, rows, COARSE * (1.0 + size), True)
        for k in range(min(orbits, n - begin)):
            _write_monodromy(rows, shifts[k], LANES_OF_AN_ORBIT * k, matrices[begin + k])
    return matrices
