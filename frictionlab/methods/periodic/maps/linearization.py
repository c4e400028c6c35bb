"""The blocks of a step: central difference quotients of a law's rates and friction, by slip and by deflection."""

from __future__ import annotations

import math
from typing import Any

from frictionlab.compile.decorators import fast
from frictionlab.compile.dispatch import by_dimension
from frictionlab.compile.stack import count_of
from frictionlab.dynamics.events import reference_acceleration
from frictionlab.dynamics.motion import belt_acceleration, instant_near, slip_at, unbalanced_rate
from frictionlab.methods.periodic.maps.rates import (
    IMPULSE,
    MEMORY,
    YIELDS,
    Flow,
    U,
    Work,
    Y,
    friction_in_mode,
    friction_of,
    load_on,
    rate_in_mode,
)
from frictionlab.numerics.blocks import apply, block, from_columns, keep
from frictionlab.numerics.vectors import dimension, unit

NUDGE = 1e-5
"""Of a deflection in steady sliding, for a difference quotient."""


def _away_on_the_line(flow: Flow, least: float, work: Work, w: float) -> float:
    """Slip far enough from its reversal for a quotient on its own side."""
    return flow.side * max(flow.side * w, least)


def _away_in_the_plane(flow: Flow, least: float, work: Work, w: complex) -> complex:
    """Slip far enough from where what gives way is unloaded."""
    for k in range(count_of(flow.law)):
        z = work.memory[k]
        size = math.sqrt(z.real * z.real + z.imag * z.imag)
        if work.mode[k] == YIELDS and size > 0.0:
            along = (z.real * w.real + z.imag * w.imag) / size
            w = w + (max(least - along, 0.0) / size) * z
    return w


_away = by_dimension(_away_on_the_line, _away_in_the_plane)


@fast
def _by_slip(flow: Flow, w: Any, least: float, work: Work, like: Any) -> None:
    """B of every deflection and G."""
    n, share = count_of(flow.law), 0.5 / least
    for column in range(dimension(like)):
        shift, first = least * unit(column, like), (n + 1) * column
        ahead = friction_in_mode(flow.law, work, w + shift)
        for k in range(n):
            work.columns[2 * n + 2 + k] = work.moving[k]
        behind = friction_in_mode(flow.law, work, w - shift)
        for k in range(n):
            work.columns[first + k] = share * (work.columns[2 * n + 2 + k] - work.moving[k])
        work.columns[first + n] = share * (ahead - behind)
    for k in range(n):
        keep(work.jacobian, 3 * k, from_columns(work.columns[k], work.columns[n + 1 + k]), like)
    keep(work.jacobian, 3 * n, from_columns(work.columns[n], work.columns[2 * n + 1]), like)


@fast
def _by_deflection(flow: Flow, w: Any, k: int, work: Work, like: Any) -> None:
    """A and F of one deflection; the rates of the others are in ``work.moving`` and stay."""
    law, z, moving = flow.law, work.memory[k], work.moving[k]
    nudge = NUDGE * work.size[k]
    share = 0.5 / nudge
    for column in range(dimension(like)):
        shift = nudge * unit(column, like)
        work.memory[k] = z + shift
        ahead = rate_in_mode(law, work, k, w)
        work.moving[k] = ahead
        friction_ahead = friction_of(law, work.memory, work.moving, w)
        work.memory[k] = z - shift
        behind = rate_in_mode(law, work, k, w)
        work.moving[k] = behind
        friction_behind = friction_of(law, work.memory, work.moving, w)
        work.columns[2 * column] = share * (ahead - behind)
        work.columns[2 * column + 1] = share * (friction_ahead - friction_behind)
        work.memory[k], work.moving[k] = z, moving
    keep(work.jacobian, 3 * k + 1, from_columns(work.columns[0], work.columns[2]), like)
    keep(work.jacobian, 3 * k + 2, from_columns(work.columns[1], work.columns[3]), like)


@fast
def linearize(flow: Flow, tau: float, least: float, work: Work, like: Any) -> None:
    """Fill ``work.jacobian`` and the slopes in time at ``work.start``; least: by how much slip is moved."""
    body, n = flow.body, count_of(flow.law)
    for k in range(n):
        work.memory[k] = work.start[MEMORY + k]
    w = _away(flow, 2.0 * least, work, slip_at(flow, tau, work.start[U]))
    _by_slip(flow, w, least, work, like)
    if n > 1:  # the rates of the others
        friction_in_mode(flow.law, work, w)
    for k in range(n):
        _by_deflection(flow, w, k, work, like)
    # in time the loads change, and the slip of a mass whose deviation stays as it is
    now = instant_near(flow, tau)
    turn = reference_acceleration(body, now.sine, now.cosine) - belt_acceleration(body, flow.belt_speed, now)
    turn = turn + 0.0 * like
    load, pressed = unbalanced_rate(body, now), load_on(body, now)
    friction = apply(block(work.jacobian, 3 * n, like), turn)
    work.slope[Y], work.slope[U], work.slope[IMPULSE] = 0.0 * like, load - pressed * friction, friction
    for k in range(n):
        work.slope[MEMORY + k] = apply(block(work.jacobian, 3 * k, like), turn)
