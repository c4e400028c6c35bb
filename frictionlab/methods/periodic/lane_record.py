"""Orbits of a curve recorded eight at a time: every step of every lane is a panel of its orbit.

All lanes step at once and write into one array of steps; the panels of each are gathered from it afterwards.

The derivative of the period map of planar slip: each orbit in eight lanes, shifted there and back along the four
directions of its state.

The lanes take the same steps. The end is then a smooth function of the start, however coarse they are, and central
difference quotients by small shifts are as good as the map.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from frictionlab.compile.decorators import inner
from frictionlab.compile.interpret import over_lanes, run_as
from frictionlab.compile.lane_arrays import any_lane, room_for, write_lanes
from frictionlab.methods.periodic.lane_map import (
    LaneRows,
    LaneWay,
    advance_lanes,
    begin_lanes,
    lane_map,
    limits_of,
    moving,
    rows_for,
    write_ends,
)
from frictionlab.methods.periodic.period_map import size_of_deviation
from frictionlab.motion.equation import belt_advance
from frictionlab.motion.maps.sliding import dense, motion_in_slip
from frictionlab.motion.orbit.recorder import NODES, Track, grown, track_of
from frictionlab.scene.body import BodyNumbers

MOST_RECORDED = 600
"""Steps of an orbit; one that needs more is recorded by itself."""
MOST_AT_ONCE = 128
"""Lanes of a record, where Python runs it: a step of each takes 6 kB."""
TAU, X, X2, V, V2, FRICTION, FRICTION2, NUMBERS = range(8)
"""Numbers of a node: time, and position, velocity and friction, each along x1 and across."""


@inner
def _note(before: LaneWay, after: LaneWay, nodes: Any) -> None:
    """Write the nodes of a step [nodes, numbers, lanes]; of lanes that did not move they mean nothing."""
    node, h = before.node, after.node.tau - before.node.tau
    whole = dense(before.problem, node.tau, node.state, h)
    for k in range(NODES.size):
        part = 0.5 * h * (1.0 + NODES[k])
        x, v, f = motion_in_slip(part, before.problem, node, whole)
        write_lanes(nodes[k, TAU], node.tau + part)
        write_lanes(nodes[k, X], x.real)
        write_lanes(nodes[k, X2], x.imag)
        write_lanes(nodes[k, V], v.real)
        write_lanes(nodes[k, V2], v.imag)
        write_lanes(nodes[k, FRICTION], f.real)
        write_lanes(nodes[k, FRICTION2], f.imag)


@over_lanes
@inner
def _recorded(law: Any, body: BodyNumbers, rows: LaneRows, accuracy: float, nodes: Any, stepped: Any) -> int:
    """As ``lane_map``, its steps written down; stepped [steps, lanes]: 1 where a lane took this step."""
    limits = limits_of(law, body, accuracy, False)
    way, steps = begin_lanes(law, body, rows, limits.longest), 0
    while steps < MOST_RECORDED:
        going = moving(way, limits)
        if not any_lane(going):
            break
        before = way
        way = advance_lanes(way, going, limits)
        write_lanes(stepped[steps], way.node.tau - before.node.tau)
        _note(before, way, nodes[steps])
        steps += 1
    write_ends(way, limits, rows)
    return steps


@inner
def _write_panel(nodes: Any, lane: int, track: Track, row: int) -> None:
    for k in range(NODES.size):
        track.tau[row, k] = nodes[k, TAU, lane]
        track.x[row, k] = complex(nodes[k, X, lane], nodes[k, X2, lane])
        track.v[row, k] = complex(nodes[k, V, lane], nodes[k, V2, lane])
        track.friction[row, k] = complex(nodes[k, FRICTION, lane], nodes[k, FRICTION2, lane])


def _write_panel_in_python(nodes: Any, lane: int, track: Track, row: int) -> None:
    tau, x, x2, v, v2, f, f2 = nodes[:, :, lane].T
    track.tau[row], track.x[row], track.v[row], track.friction[row] = (
        tau,
        x + 1j * x2,
        v + 1j * v2,
        f + 1j * f2,
    )


run_as(_write_panel, _write_panel_in_python)


@inner
def record_in_lanes(law: Any, body: BodyNumbers, belt_speeds: Any, states: Any, accuracy: float) -> Any:
    """Return the track of these orbits, one after another, and the panels before which each ends [n].

    Of an orbit that lanes leave there are no panels.
    """
    n, lanes = belt_speeds.size, min(room_for(belt_speeds.size), MOST_AT_ONCE)
    rows, ends = rows_for(lanes), np.zeros(n, np.int64)
    nodes = np.empty((MOST_RECORDED, NODES.size, NUMBERS, lanes))
    stepped = np.empty((MOST_RECORDED, lanes))
    track, row = track_of(64 * n), 0
    for begin in range(0, n, lanes):
        for k in range(lanes):
            i = min(begin + k, n - 1)  # lanes that are left over repeat the last orbit
            rows.belt_speed[k] = belt_speeds[i]
            for each in range(4):
                rows.state[each, k] = states[i, each]
        steps = _recorded(law, body, rows, accuracy, nodes, stepped)
        for k in range(min(lanes, n - begin)):
            for j in range(steps if rows.arrived[k] > 0.0 else 0):
                if stepped[j, k] > 0.0:
                    if row == track.stick.size:
                        track.filled[0] = row
                        track = grown(track, 2 * row)
                    _write_panel(nodes[j], k, track, row)
                    row += 1
            ends[begin + k] = row
    track.filled[0] = row
    return track, ends


LANES_OF_AN_ORBIT = 8
SHIFT = 1e-6
"""Change of a state for difference quotients, over its size."""
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
    """Write the matrix, NaN where a lane was left."""
    for k in range(LANES_OF_AN_ORBIT):
        shift = shift if rows.arrived[first + k] > 0.0 else np.nan
    for column in range(4):
        for row in range(4):
            ahead, behind = rows.residual[row, first + 2 * column], rows.residual[row, first + 2 * column + 1]
            matrix[row, column] = (ahead - behind) / (2.0 * shift) + (1.0 if row == column else 0.0)


@inner
def differentiate_in_lanes(law: Any, body: BodyNumbers, belt_speeds: Any, states: Any) -> Any:
    """Return the monodromies of these orbits [n, 4, 4]; NaN where they come next to rest."""
    n = belt_speeds.size
    matrices, lanes = np.empty((n, 4, 4)), room_for(LANES_OF_AN_ORBIT * n)
    rows, orbits = rows_for(lanes), lanes // LANES_OF_AN_ORBIT
    shifts = np.empty(orbits)
    for begin in range(0, n, orbits):
        size = 0.0
        for k in range(orbits):
            i = min(begin + k, n - 1)  # lanes that are left over repeat the last orbit
            z, belt_speed = states[i], belt_speeds[i]
            way, whole = abs(belt_advance(body, belt_speed)), size_of_deviation(body.normal_load, z)
            # the pattern of events hangs on the way of the belt
            shifts[k], size = min(SHIFT * whole, max(0.01 * way, 1e-3 * SHIFT * whole)), max(size, whole)
            _write_shifted(rows, belt_speed, z, shifts[k], LANES_OF_AN_ORBIT * k)
        lane_map(law, body, rows, COARSE * size, True)
        for k in range(min(orbits, n - begin)):
            _write_monodromy(rows, shifts[k], LANES_OF_AN_ORBIT * k, matrices[begin + k])
    return matrices
