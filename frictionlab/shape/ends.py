"""Both ends of a friction curve, read from its rows: where slip stops reversing, and friction at rest."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from frictionlab.quantities import Floats
from frictionlab.shape.shakedown import Hold, largest_turn
from frictionlab.shape.verdict import Measured, Unreadable

_ROUNDING = 1e-14
_SAME = 1e-9  # relative spread of what is one number but for rounding


class Loads(NamedTuple):
    """What shakes the body of a curve, the same at every belt speed.

    along, across: phasors of the forces along and across the belt. static_limit: the largest friction force at
    rest, where the law has one of its own; NaN otherwise. prescribed: the slip itself is given. hold: of a law
    with bristles, what they do on a belt that creeps. unread: why the start of the curve is not known, '' where it
    is. Forces in K_1 L.
    """

    along: complex
    across: complex
    across_slip: float
    static_limit: float
    prescribed: bool
    hold: Hold | None = None
    unread: str = ""

    @property
    def along_belt_only(self) -> bool:
        """Whether nothing moves the body across the belt."""
        return self.across == 0 and not self.across_slip > 0.0

    @property
    def largest(self) -> float:
        """The largest size the turning load reaches within a period."""
        return largest_turn(self.along, self.across)


class Rows(NamedTuple):
    """Columns of the result table at the belt speeds > 0 of one curve that have a number, rising."""

    belt_speed: Floats
    mean_friction: Floats
    error: Floats
    normalized_friction: Floats
    velocity_ratio: Floats
    velocity_amplitude: Floats
    reversals: Floats
    stick_fraction: Floats
    friction_to_drive: Floats

    @property
    def steady(self) -> Floats:
        """Friction coefficient of steady sliding."""
        return self.mean_friction / self.normalized_friction

    @property
    def constant_friction(self) -> bool:
        """Whether steady sliding has one friction coefficient at every speed."""
        known = self.steady[np.isfinite(self.steady)]
        return bool(known.size and np.ptp(known) <= _SAME * np.abs(known).max())


def end_of_reversal(rows: Rows, loads: Loads) -> tuple[Measured, bool]:
    """The belt speed above which slip neither reverses nor sticks; whether friction is known to have a kink there.

    V_lin for constant friction along the belt (and for prescribed slip, whose amplitude it is), else between the
    last point that reverses or sticks and the next. Raises Unreadable.
    """
    ratio = rows.velocity_ratio[np.isfinite(rows.velocity_ratio) & (rows.velocity_ratio > 0.0)]
    kinked = loads.along_belt_only and (rows.constant_friction or loads.prescribed)
    if ratio.size and (kinked or loads.prescribed):
        speed = float((rows.belt_speed / rows.velocity_ratio)[-1])
        return Measured(speed, _ROUNDING * speed), kinked and rows.constant_friction
    return _bracketed(rows), False


def _bracketed(rows: Rows) -> Measured:
    """Between two points, at the place where the velocity amplitude of x1 falls below the belt speed."""
    excess = rows.velocity_amplitude - rows.belt_speed
    told = np.isfinite(rows.reversals)
    reverses = np.where(told, (rows.reversals > 0.0) | (rows.stick_fraction > 0.0), excess > 0.0)
    if not reverses.any():
        raise Unreadable("slip reverses at no point")
    last = int(np.flatnonzero(reverses)[-1])
    if last + 1 == reverses.size:
        raise Unreadable(f"slip still reverses at the highest belt speed, {rows.belt_speed[-1]:.6g}")
    low, high = (float(speed) for speed in rows.belt_speed[last : last + 2])
    fall = float(excess[last] - excess[last + 1])
    share = float(np.clip(excess[last] / fall, 0.0, 1.0)) if fall > 0.0 else 0.5
    place = low + share * (high - low)
    return Measured(place, max(place - low, high - place))


def friction_at_rest(rows: Rows, loads: Loads) -> Measured:
    """The limit of mean friction as belt speed falls to zero. Raises Unreadable.

    Zero by symmetry where the body moves on a belt at rest, or where bristles drift as it vibrates. A
    body that constant friction holds against its load creeps with the belt until the load's peak frees it: the
    spring then carries what the peak leaves, and the limit is mu (1 - load/friction).
    """
    if loads.unread:
        raise Unreadable(loads.unread)
    if loads.hold is not None:
        return _on_bristles(rows, loads.hold, loads.prescribed)
    if loads.prescribed:
        return Measured(0.0, 0.0)
    force = abs(loads.along) or abs(loads.across)
    if force == 0.0:
        raise Unreadable("nothing shakes the body: its friction at rest has no limit that is known")
    kinetic = float(np.nanmax(rows.friction_to_drive)) * force
    limit = kinetic if math.isnan(loads.static_limit) else max(kinetic, loads.static_limit)
    if limit <= loads.largest:
        return Measured(0.0, 0.0)
    if loads.along_belt_only and rows.constant_friction and limit <= kinetic * (1.0 + _SAME):
        steady = float(np.nanmedian(rows.steady))
        return Measured(steady * (1.0 - loads.largest / limit), _ROUNDING * steady)
    raise Unreadable(
        "friction holds the body on a belt at rest: where the curve then starts is known for constant friction "
        "along the belt alone"
    )


def _on_bristles(rows: Rows, hold: Hold, prescribed: bool) -> Measured:
    """The friction of bristles held elastically, zero where they drift.

    A body might also vibrate farther than its elastic bristles let it: the limit would then be zero. That friction
    at the slowest belt is above the elastic limit, and how near, tells how sure it is.
    """
    limit = hold.friction()
    if prescribed or limit == 0.0:
        return Measured(limit, _ROUNDING * limit)
    above = float(rows.mean_friction[0] - limit)
    if above < -float(rows.error[0]):
        raise Unreadable(
            f"bristles can hold the body on a slow belt, where the curve would start at {limit:.6g}, and its first "
            "point lies below"
        )
    return Measured(limit, min(limit, abs(above) + float(rows.error[0])))
