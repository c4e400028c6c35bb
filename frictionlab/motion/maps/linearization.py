"""Blocks of a step: difference quotients of a law's rates and friction, by slip and by its memory.

For deflections they are central quotients on the scale of steady sliding. Friction of a scalar law is steep
where it creeps: there a quotient by slip is taken on the scale of the slip itself, as far as rounding allows.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from frictionlab.compile.decorators import fast, inner
from frictionlab.compile.dispatch import by_dimension, by_law, by_scalars, length
from frictionlab.compile.stack import count_of
from frictionlab.motion.contact import friction_of
from frictionlab.motion.equation import (
    Flow,
    Instant,
    deviation_slip_rate,
    instant_near,
    load_share,
    normal_load_rate,
    reference_jerk,
    restoring_force,
    swing_of,
    unbalanced_rate,
)
from frictionlab.motion.linalg import (
    add,
    apply,
    block,
    diagonal,
    dimension,
    from_columns,
    keep,
    multiple,
    unit,
)
from frictionlab.motion.maps.creep import SCALE, SLOW
from frictionlab.motion.maps.rates import (
    IMPULSE,
    MEMORY,
    SMOOTH,
    YIELDS,
    U,
    Work,
    Y,
    as_memory,
    friction_in_mode,
    load_on,
    note_share,
    rate_in_mode,
    slip_held,
    springs_at,
    stretching,
)
from frictionlab.scene.body import BodyNumbers

NUDGE = 1e-5
"""Shift for a difference quotient, relative to a deflection in steady sliding, to a scalar or to a creeping
slip."""
FINE = 1e-7
"""Shift relative to a deflection that may have a corner near: its law has corners, and little other
curvature."""
LOST = 1e-9
"""Smallest relative difference of friction that rounding leaves; slip too slow to matter, relative to the
speed of the motion."""


def _away_in_the_plane(flow: Flow, least: float, work: Work, w: complex) -> complex:
    """Return a slip far enough from the one at which deflections that give way are unloaded."""
    for k in range(count_of(flow.law)):
        z = work.memory[k]
        size = math.sqrt(z.real * z.real + z.imag * z.imag)
        if work.mode[k] == YIELDS and size > 0.0:
            along = (z.real * w.real + z.imag * w.imag) / size
            w = w + (max(least - along, 0.0) / size) * z
    return w


_away = by_dimension(
    # slip so far from its reversal that the quotient stays on one side
    lambda flow, least, work, w: flow.side * max(flow.side * w, least),
    _away_in_the_plane,
)


@inner
def _keep_by_slip(work: Work, n: int, zero: Any) -> None:
    """Make the blocks of the columns: for each direction of slip, the rates of all numbers, then friction."""
    for k in range(n):
        keep(work.jacobian, 3 * k, from_columns(work.columns[k], work.columns[n + 1 + k]), zero)
    keep(work.jacobian, 3 * n, from_columns(work.columns[n], work.columns[2 * n + 1]), zero)


@fast
def _deflections_by_slip(flow: Flow, w: Any, work: Work, zero: Any) -> Any:
    n, least = count_of(flow.law), _least(flow, w)
    # a quotient across a reversal of slip, or across the unloading of a yielding deflection, would mix both sides
    w = _away(flow, 2.0 * least, work, w)
    share = 0.5 / least
    for column in range(dimension(zero)):
        shift, first = least * unit(column, zero), (n + 1) * column
        ahead = friction_in_mode(flow.law, work, w + shift)
        for k in range(n):
            work.columns[2 * n + 2 + k] = work.moving[k]
        behind = friction_in_mode(flow.law, work, w - shift)
        for k in range(n):
            work.columns[first + k] = share * (work.columns[2 * n + 2 + k] - work.moving[k])
        work.columns[first + n] = share * (ahead - behind)
    _keep_by_slip(work, n, zero)
    return w


@inner
def _least(flow: Flow, w: Any) -> float:
    """Return the shift of a slip for a quotient."""
    return NUDGE * length(w) + LOST * (swing_of(flow.body) + abs(flow.belt_speed))


_beside_rest = by_dimension(
    lambda least, w: max(w, least) if w >= 0.0 else min(w, -least), lambda least, w: w
)
"""_beside_rest(least, w): slip on the line, at least so fast, on its own side."""


@inner
def _creep_by_slip(flow: Flow, w: Any, work: Work, column: int, zero: Any) -> float:
    """Write the quotient of friction by slip on the scale of the slip, and return the shift of the slip."""
    n, swing = count_of(flow.law), swing_of(flow.body) + abs(flow.belt_speed)
    scale, slow, least = work.creep[SCALE], work.creep[SLOW], LOST * swing
    # a prescribed slip is at rest only for a moment
    slowest = NUDGE * (scale if scale > 0.0 else slow) if slow > 0.0 else least
    shift = max(NUDGE * length(w), slowest)
    while True:
        ahead = friction_in_mode(flow.law, work, w + shift * unit(column, zero))
        behind = friction_in_mode(flow.law, work, w - shift * unit(column, zero))
        work.columns[(n + 1) * column + n] = (ahead - behind) / (2.0 * shift)
        # rounding dominates the difference: use a larger shift
        if not shift < least or length(ahead - behind) > LOST * (length(ahead) + length(behind)):
            return shift
        shift = min(1e3 * shift, least)


@inner
def _scalars_by_slip(flow: Flow, w: Any, work: Work, zero: Any) -> Any:
    n, least = count_of(flow.law), LOST * (swing_of(flow.body) + abs(flow.belt_speed))
    for column in range(dimension(zero)):
        shift, there = _creep_by_slip(flow, w, work, column, zero), w
        # rates of scalars hardly depend on a slip as slow as creep: shift the slip by an amount that matters to them
        if shift < least:
            shift, there = least, _beside_rest(2.0 * least, w)
        friction_in_mode(flow.law, work, there + shift * unit(column, zero))
        for k in range(n):
            work.columns[2 * n + 2 + k] = work.moving[k] + 0.0 * zero
        friction_in_mode(flow.law, work, there - shift * unit(column, zero))
        for k in range(n):
            difference = work.columns[2 * n + 2 + k] - work.moving[k]
            work.columns[(n + 1) * column + k] = difference / (2.0 * shift)
    _keep_by_slip(work, n, zero)
    return w


_by_slip = by_scalars(_deflections_by_slip, _scalars_by_slip)
"""_by_slip(flow, w, work, zero): fill B of every number, and G; returns the slip at which to take the other
blocks."""


class Sides(NamedTuple):
    """Rate and friction on either side of a number that a law remembers."""

    ahead: Any
    friction_ahead: Any
    behind: Any
    friction_behind: Any


@fast
def _sides(flow: Flow, w: Any, k: int, shift: Any, work: Work) -> Sides:
    """Return rate and friction for the k-th number shifted both ways."""
    law, here, moving = flow.law, work.memory[k], work.moving[k]
    work.memory[k] = here + shift
    ahead = rate_in_mode(law, work, k, w)
    work.moving[k] = ahead
    friction_ahead = friction_of(law, work.memory, work.moving, w)
    work.memory[k] = here - shift
    behind = rate_in_mode(law, work, k, w)
    work.moving[k] = behind
    friction_behind = friction_of(law, work.memory, work.moving, w)
    work.memory[k], work.moving[k] = here, moving
    return Sides(ahead, friction_ahead, behind, friction_behind)


@inner
def _keep_by_number(work: Work, k: int, zero: Any) -> None:
    """Make A and F of the columns: for each direction of a number its rate, then friction."""
    keep(work.jacobian, 3 * k + 1, from_columns(work.columns[0], work.columns[2]), zero)
    keep(work.jacobian, 3 * k + 2, from_columns(work.columns[1], work.columns[3]), zero)


@fast
def _centrally(flow: Flow, w: Any, k: int, work: Work, zero: Any) -> None:
    nudge = NUDGE * work.size[k]
    share = 0.5 / nudge
    for column in range(dimension(zero)):
        at = _sides(flow, w, k, nudge * unit(column, zero), work)
        work.columns[2 * column] = share * (at.ahead - at.behind)
        work.columns[2 * column + 1] = share * (at.friction_ahead - at.friction_behind)
    _keep_by_number(work, k, zero)


@inner
def _flatter(ahead: Any, here: Any, behind: Any, h: float) -> Any:
    """Return the central quotient, or the flatter one-sided one at a corner, where both sides disagree."""
    rise, fall = (ahead - here) / h, (here - behind) / h
    if length(rise - fall) <= 0.1 * (length(rise) + length(fall)):
        return 0.5 * (rise + fall)
    return rise if length(rise) < length(fall) else fall


@inner
def _flatly(flow: Flow, w: Any, k: int, work: Work, zero: Any) -> None:
    """Write A and F of a deflection that moves by its own rate, which may have an undeclared corner."""
    nudge = FINE * work.size[k]
    friction = friction_of(flow.law, work.memory, work.moving, w)
    for column in range(dimension(zero)):
        at = _sides(flow, w, k, nudge * unit(column, zero), work)
        work.columns[2 * column] = _flatter(at.ahead, work.moving[k], at.behind, nudge)
        work.columns[2 * column + 1] = _flatter(at.friction_ahead, friction, at.friction_behind, nudge)
    _keep_by_number(work, k, zero)


@inner
def _bristle(flow: Flow, w: Any, k: int, work: Work, zero: Any) -> None:
    _centrally(flow, w, k, work, zero)


@inner
def _deflection(flow: Flow, w: Any, k: int, work: Work, zero: Any) -> None:
    if work.mode[k] == SMOOTH:
        _flatly(flow, w, k, work, zero)
    else:
        _centrally(flow, w, k, work, zero)


@inner
def _scalar(flow: Flow, w: Any, k: int, work: Work, zero: Any) -> None:
    """Write A and F of a scalar, shifted by a share of its value: it may range over decades."""
    least = 0.0 if work.positive[k] > 0.0 else LOST * work.size[k]
    shift = max(NUDGE * abs(work.memory[k]), least)
    friction = friction_of(flow.law, work.memory, work.moving, w)
    at = _sides(flow, w, k, shift, work)
    by_itself = _flatter(at.ahead, work.moving[k], at.behind, shift)
    keep(work.jacobian, 3 * k + 1, multiple(by_itself, zero), zero)
    by_scalar = _flatter(at.friction_ahead, friction, at.friction_behind, shift)
    keep(work.jacobian, 3 * k + 2, multiple(by_scalar, zero), zero)


_by_memory = by_law(_bristle, _bristle, _deflection, _scalar)
"""_by_memory(flow, w, k, work, zero): fill A and F of one number; the rates of all stand in ``work.moving``
and stay."""


@inner
def _swell(body: BodyNumbers, now: Instant) -> float:
    """Return the rate of the normal load by which friction moves the mass."""
    return 0.0 if body.prescribed else normal_load_rate(body, now)


@inner
def _slope_of_deviation(flow: Flow, now: Instant, rub: Any, work: Work, zero: Any) -> None:
    """Fill the slope in time at constant deviation: loads and slip change; rub: friction coefficient."""
    body, n = flow.body, count_of(flow.law)
    turn = deviation_slip_rate(flow, now, 0.0 * zero)
    load, pressed = unbalanced_rate(body, now), load_on(body, now)
    friction = apply(block(work.jacobian, 3 * n, zero), turn)
    work.slope[Y], work.slope[U] = 0.0 * zero, load - pressed * friction - _swell(body, now) * rub
    swollen = normal_load_rate(body, now) / body.normal_load
    work.slope[IMPULSE] = load_share(body, now) * friction + swollen * rub
    for k in range(n):
        work.slope[MEMORY + k] = apply(block(work.jacobian, 3 * k, zero), turn)


@inner
def _slope_of_slip(flow: Flow, now: Instant, rub: Any, work: Work, zero: Any) -> None:
    """Fill the slope in time at constant slip: loads and deviation change."""
    body = flow.body
    turn = deviation_slip_rate(flow, now, 0.0 * zero)
    jerk = reference_jerk(flow, now)
    work.slope[Y], work.slope[IMPULSE] = -turn, (normal_load_rate(body, now) / body.normal_load) * rub
    load = unbalanced_rate(body, now) - _swell(body, now) * rub
    work.slope[U] = load + jerk + restoring_force(springs_at(flow, work), 0.0 * turn, turn)
    for k in range(count_of(flow.law)):
        work.slope[MEMORY + k] = 0.0 * zero


_slope = by_scalars(_slope_of_deviation, _slope_of_slip)
"""_slope(flow, now, rub, work, zero): fill ``work.slope``, at constant numbers of the state."""


@inner
def _by_share(work: Work, flow: Flow, now: Instant, w: Any, zero: Any) -> None:
    """Add the effect of a changing load on a contact of constant stiffness, where it divides deflections."""
    law, body, n = flow.law, flow.body, count_of(flow.law)
    share, rate, bend = work.share[0], work.share[1], work.share[2]
    # With n = N/N_mean the state holds zeta = z/n, and zeta' = z'/n - (n'/n) zeta: -n'/n more in its own block, and
    # the derivative of n'/n, which is n''/n - (n'/n)^2, in the slope in time.
    strain = rate / share
    turn = bend / share - strain * strain  # its rate
    for k in range(n):
        stretched = add(block(work.jacobian, 3 * k + 1, zero), diagonal(-strain, 0.0, zero), zero)
        keep(work.jacobian, 3 * k + 1, stretched, zero)
    # z'/n of a yielding deflection is its turning plus the stretching by the load, of any other the law's rate over n
    here = friction_of(law, work.memory, work.moving, w)
    for k in range(n):
        z, yields = work.memory[k], 1.0 if work.mode[k] == YIELDS and work.radius[k] > 0.0 else 0.0
        change = -strain * (work.moving[k] - yields * stretching(work, z))
        work.slope[MEMORY + k] = work.slope[MEMORY + k] + change - (1.0 - yields) * turn * z + 0.0 * zero
        work.moving[k] = work.moving[k] + change + yields * turn * z
    more = friction_of(law, work.memory, work.moving, w) - here
    pressed = load_on(body, now)
    work.slope[U] = work.slope[U] - pressed * more
    work.slope[IMPULSE] = work.slope[IMPULSE] + load_share(body, now) * more


@inner
def linearize(flow: Flow, tau: float, work: Work, zero: Any) -> None:
    """Fill ``work.jacobian`` and the slopes in time at ``work.start``."""
    n, now = count_of(flow.law), instant_near(flow, tau)
    note_share(work, flow.body, now)
    for k in range(n):
        work.memory[k] = as_memory(flow.law, work.start[MEMORY + k])
    w = _by_slip(flow, slip_held(flow, now, work.start[U]), work, zero)
    rub = friction_in_mode(
        flow.law, work, w
    )  # and the rates of all, which quotients by one number do not change
    for k in range(n):
        _by_memory(flow, w, k, work, zero)
    _slope(flow, now, rub, work, zero)
    if len(work.keeps_stiffness) > 0:
        _by_share(work, flow, now, w, zero)
