"""Orbits: one period of these motions as smooth panels."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from frictionlab.tools import NODES, Track, grown, inner, njit, track_of
from linear_bodies.locus import (
    Instants,
    LocusSetting,
    length_of,
    mean_of_friction,
    slip_of_steps,
    steps_of_friction,
)
from linear_bodies.response import (
    INTEGRAL,
    TWICE,
    FreeWaves,
    StepAnswer,
    table_at,
    waves_at,
    wrapped,
)
from linear_bodies.rest_rule import RestRule, RestRules, rule_at
from linear_bodies.search import empty_motion

FINEST_PANEL = 1e-4
"""Share of the period of the first panel after an instant, where memory has powers that are no whole numbers."""
PANELS = 24
"""Panels in a period at least."""


class BesideFriction(NamedTuple):
    """Waves [n, 3] of x1 under waves of the load, of the belt's vibration and of its path; smooth: whether the body
    is, after a jump of force."""

    position: Any
    belt: Any
    path: Any
    smooth: bool


@njit
def make_locus_orbits(
    response: StepAnswer,
    rules: RestRules,
    forcing: FreeWaves,
    around: BesideFriction,
    given: Any,
    belt_speeds: Any,
    solved: Any,
    ends: Any,
) -> Track:
    """Return the panels of every orbit, one after another, that of belt speed i before panel ends[i].

    given: limit of friction, normal load. solved: of each the number of instants, -1 without a motion and 0 where
    slip never reverses, the place of its rule, and what ``follow_curve`` found."""
    counts, degrees, found = solved
    room, track = 64, track_of(64)
    for i in range(belt_speeds.size):
        if counts[i] >= 0:
            setting, rule = (
                LocusSetting(response, forcing, given[0], belt_speeds[i]),
                rule_at(rules, degrees[i]),
            )
            motion = as_found(setting, rule, found[i], counts[i])
            edges = panel_edges(setting, motion, around.smooth)
            if track.filled[0] + edges.size > room:
                room = 2 * (room + edges.size)
                track = grown(track, room)
            note_locus(setting, rule, motion, around, edges, given[1], track)
        ends[i] = track.filled[0]
    return track


@inner
def as_found(setting: LocusSetting, rule: RestRule, found: Any, count: int) -> Instants:
    """Return the motion that was written; without instants slip of one sign from tau = 0 on."""
    motion = empty_motion(max(count, 1), rule.nodes.size)
    motion.times[0], motion.modes[0] = 0.0, math.copysign(1.0, -setting.belt_speed)
    for j in range(count):
        motion.times[j], motion.modes[j] = found[j, 0], found[j, 1]
        if motion.modes[j] == 0.0:
            for k in range(rule.nodes.size):
                motion.friction[j, k] = found[j, 2 + k]
    return motion


@inner
def panel_edges(setting: LocusSetting, motion: Instants, smooth: bool) -> Any:
    """Return the edges in a period from 0, ascending: at every instant and corner of the load.

    They are closer after it where the body is not smooth.
    """
    of, corners, n = setting.response, setting.forcing.corners, motion.times.size
    largest = of.period / max(PANELS, of.panels)
    starts = np.empty(n + corners.shape[0])
    for j in range(starts.size):
        starts[j] = wrapped(of, motion.times[j] if j < n else corners[j - n, 0])
    starts = np.sort(starts)
    edges, count = np.empty(2 + starts.size * 64 + 4 * max(PANELS, of.panels)), 2
    edges[0], edges[1] = 0.0, of.period
    for j in range(starts.size):
        whole = (starts[j + 1] if j < starts.size - 1 else starts[0] + of.period) - starts[j]
        r = 0.0
        while r < whole and count < edges.size:
            edges[count] = starts[j] + r if starts[j] + r < of.period else starts[j] + r - of.period
            count += 1
            length = largest if smooth else min(largest, max(FINEST_PANEL * of.period, r))
            r = r + min(
                length,
                max(0.5 * (whole - r), 1e-3 * length) if r + 1.5 * length > whole > r + length else length,
            )
    order = np.sort(edges[:count])
    kept = 1
    for k in range(1, count):
        if order[k] - order[kept - 1] > 1e-14 * of.period:
            order[kept] = order[k]
            kept += 1
    return order[:kept]


@inner
def note_locus(
    setting: LocusSetting,
    rule: RestRule,
    motion: Instants,
    around: BesideFriction,
    edges: Any,
    normal_load: float,
    track: Track,
) -> None:
    """Write the panels between these edges on a track with room for them."""
    of = setting.response
    mean = mean_of_friction(setting, rule, motion)
    steps = steps_of_friction(setting, rule, motion)
    for k in range(edges.size - 1):
        panel, middle = track.filled[0], 0.5 * (edges[k] + edges[k + 1])
        j = instant_before(setting, motion, middle)
        rests = motion.modes[j] == 0.0
        begun = motion.times[j] + of.period * math.floor((middle - motion.times[j]) / of.period)
        for node in range(NODES.size):
            t = middle + 0.5 * (edges[k + 1] - edges[k]) * NODES[node]
            belt, _ = waves_at(around.belt, t)
            if rests:
                path, _ = waves_at(around.path, t)
                before, _ = waves_at(around.path, begun)
                x = position_at(setting, steps, around, begun, mean)
                x = x + setting.belt_speed * (t - begun) + (path - before)
                v, friction = setting.belt_speed + belt, friction_at(of.period, rule, motion, j, t - begun)
            else:
                x = position_at(setting, steps, around, t, mean)
                v = slip_of_steps(setting, steps, t) + (setting.belt_speed + belt)
                friction = setting.limit * motion.modes[j]
            track.tau[panel, node] = t
            track.x[panel, node], track.v[panel, node] = complex(x, 0.0), complex(v, 0.0)
            track.friction[panel, node] = complex(friction / normal_load, 0.0)
        track.stick[panel] = rests
        track.filled[0] = panel + 1


@inner
def instant_before(setting: LocusSetting, motion: Instants, t: float) -> int:
    """Return the instant after which a time lies."""
    period, best, least = setting.response.period, 0, math.inf
    for j in range(motion.times.size):
        since = t - motion.times[j]
        since = since - period * math.floor(since / period)
        if since < least:
            best, least = j, since
    return best


@inner
def friction_at(period: float, rule: RestRule, motion: Instants, j: int, since: float) -> float:
    """Return friction a while after instant j, at which a rest begins: Clenshaw's sum in xi."""
    n = rule.nodes.size
    share = min(max(since / length_of(motion, period, j), 0.0), 1.0)
    x, last, now = 2.0 * share ** (1.0 / rule.grading) - 1.0, 0.0, 0.0
    for k in range(n - 1, -1, -1):
        coefficient = 0.0
        for m in range(n):
            coefficient = coefficient + rule.to_polynomials[k, m] * motion.friction[j, m]
        if k == 0:
            return x * now - last + coefficient
        last, now = now, 2.0 * x * now - last + coefficient
    return now


@inner
def position_at(setting: LocusSetting, steps: Any, around: BesideFriction, t: float, mean: float) -> float:
    """Return x1 at a time in no rest; mean: of friction."""
    of, corners = setting.response, setting.forcing.corners
    x, _ = waves_at(around.position, t)
    x = x - of.static * mean
    for c in range(corners.shape[0]):
        u = wrapped(of, t - corners[c, 0])
        x = x + corners[c, 1] * table_at(of, TWICE, u)
    for j in range(steps.shape[0]):
        x = x - steps[j, 1] * table_at(of, INTEGRAL, wrapped(of, t - steps[j, 0]))
    return x
