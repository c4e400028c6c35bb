"""Both ends of a friction curve from its rows: the end of reversal, and friction at vanishing belt speed.

Mean friction of bristles at vanishing belt speed: elastic shakedown.

A contact may be elastic below a yield deflection: vibration within that range causes no drift, and the slow belt
stretches the bristles until the vibration reaches the end of the range (elastic shakedown). Where bristles drift
under any vibration, or where the vibration leaves the range, the mean friction tends to zero.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from frictionlab.curves.verdict import Estimate, UnreadableCurve
from frictionlab.laws.memory import BristleLaw
from frictionlab.values.quantities import Floats

Value = Callable[[str], float]
"""Reads a number of a scene by its dotted path; 0 if the scene does not have it."""


class Shakedown(NamedTuple):
    """Elastic bristles and their vibration.

    elastic: deflection up to which they are elastic, 0 for none [scene length]. along, across: phasors of the
    vibration of elastic bristles [scene length]. stiffness: friction coefficient per deflection. planar: of the law.
    """

    elastic: float
    along: complex
    across: complex
    stiffness: float
    planar: str

    def friction(self) -> float:
        """Return the limit of mean friction at vanishing belt speed under this vibration. Raises UnreadableCurve."""
        across = 0j if self.planar == "per-axis" else self.across
        size = largest_magnitude(self.along, across)
        if size == 0.0:
            raise UnreadableCurve("no vibration: the limit of friction at vanishing belt speed is not known")
        if size >= self.elastic:
            return 0.0
        if across == 0:
            return self.stiffness * (self.elastic - size)
        if self.along == 0:
            return self.stiffness * math.sqrt(self.elastic**2 - size**2)
        raise UnreadableCurve(
            "the body sticks elastically to a slow belt: the start of its curve is known only for vibration along "
            "the belt or across it, not both"
        )


def largest_magnitude(along: complex, across: complex) -> float:
    """Return the largest magnitude, within a period, of a vector of two harmonic components."""
    if math.inf in (abs(along), abs(across)):
        return math.inf
    squares = abs(along) ** 2 + abs(across) ** 2
    return math.sqrt(0.5 * (squares + abs(along**2 + across**2)))


def shakedown_of_slip(law: BristleLaw, value: Value) -> Shakedown:
    """Return the shakedown under a prescribed slip; ``law`` is per unit of the scene's normal load."""
    frequency = value("scene.slip.frequency") or value("scene.transverse_slip.frequency")
    along, across = (
        cmath.rect(value(f"{slip}.velocity_amplitude") / frequency, math.radians(value(f"{slip}.phase")))
        for slip in ("scene.slip", "scene.transverse_slip")
    )
    return Shakedown(law.elastic_deflection(), along, across, law.friction(0.0, 1.0, 0.0), law.planar)


def shakedown_of_body(law: BristleLaw, value: Value, along: complex, across: complex) -> Shakedown:
    """Return the shakedown of a body under two forces: its bristles act in parallel to its springs and dashpots."""
    load, omega = value("scene.normal_load"), value("scene.drive.frequency")
    bristles = law.friction(0.0, 1.0, 0.0)
    stiffness, damping = load * bristles, load * law.friction(1.0, 0.0, 1.0)
    omega_r = value("scene.transverse.natural_frequency")

    def moved(force: complex, spring: float, dashpot: float) -> complex:
        """Displacement phasor of a linear oscillator; infinite at undamped resonance."""
        dynamic = complex(spring + stiffness - omega**2, omega * (dashpot + damping))
        if force == 0:
            return 0j
        return force / dynamic if dynamic != 0 else complex(math.inf)

    phasors = (
        moved(along, 1.0, 2.0 * value("scene.damping_ratio")),
        moved(across, omega_r**2, 2.0 * value("scene.transverse.damping_ratio") * omega_r),
    )
    return Shakedown(law.elastic_deflection(), *phasors, bristles, law.planar)


_ROUNDING = 1e-14
_SAMPLED = 1e-10  # of a largest force, from a parabola through neighbours
_SAME = 1e-9  # relative spread of equal numbers with rounding errors


class Loads(NamedTuple):
    """Loads on the body of a curve, the same at every belt speed; forces in K_1 L.

    along, across: phasors of the forces along and across the belt. static_limit: the largest friction force at
    rest if the law defines one, else NaN. prescribed: whether the slip is prescribed. shakedown: for bristles, their
    state on a belt of vanishing speed. unknown_start: why the start of the curve is not known, '' where it is.
    start: the mean friction at vanishing belt speed where that is known beforehand, else NaN. lags: whether the
    friction of bristles lags behind the normal load. normal_load: its mean. varying: whether the law may vary with
    speed, even where steady sliding does not show it.
    """

    along: complex
    across: complex
    across_slip: float
    static_limit: float
    prescribed: bool
    shakedown: Shakedown | None = None
    unknown_start: str = ""
    start: float = math.nan
    lags: bool = False
    normal_load: float = math.nan
    varying: bool = False

    @property
    def along_belt_only(self) -> bool:
        """Check whether no load and no slip act across the belt."""
        return self.across == 0 and not self.across_slip > 0.0

    @property
    def largest(self) -> float:
        """Return the largest magnitude of the load vector within a period."""
        return largest_magnitude(self.along, self.across)


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

    @property
    def steady(self) -> Floats:
        """Friction coefficient of steady sliding; where vibration leaves no friction, the median of the others."""
        left = self.normalized_friction != 0.0
        size = np.full(len(left), np.nan)
        found = np.divide(self.mean_friction, self.normalized_friction, where=left, out=size)
        return found if left.all() or not left.any() else np.where(left, found, np.nanmedian(found))

    @property
    def constant_friction(self) -> bool:
        """Check whether steady sliding has one friction coefficient at every speed."""
        steady = self.steady
        known = steady[np.isfinite(steady)]
        return bool(known.size and np.ptp(known) <= _SAME * np.abs(known).max())


def end_of_reversal(rows: Rows, loads: Loads) -> tuple[Estimate, bool]:
    """Belt speed above which slip neither reverses nor sticks, and whether friction has a known kink there.

    V_lin for constant friction along the belt (and for prescribed slip, whose velocity amplitude it is), else between
    the last point with reversal or stick and the next. Raises UnreadableCurve.
    """
    ratio = rows.velocity_ratio[np.isfinite(rows.velocity_ratio) & (rows.velocity_ratio > 0.0)]
    constant = rows.constant_friction and not loads.lags and not loads.varying
    kinked = loads.along_belt_only and (constant or loads.prescribed)
    if ratio.size and (kinked or loads.prescribed):
        speed = float((rows.belt_speed / rows.velocity_ratio)[-1])
        return Estimate(speed, _ROUNDING * speed), kinked and constant
    return _bracket_end(rows), False


def reverses(rows: Rows) -> NDArray[np.bool_]:
    """Check whether slip reverses or sticks at each of the points."""
    counted = np.isfinite(rows.reversals)
    on = (rows.reversals > 0.0) | (rows.stick_fraction > 0.0)
    return np.where(counted, on, rows.velocity_amplitude > rows.belt_speed)


def _bracket_end(rows: Rows) -> Estimate:
    """End of reversal between two points, where the velocity amplitude of x1 falls below the belt speed."""
    excess, on = rows.velocity_amplitude - rows.belt_speed, reverses(rows)
    if not on.any():
        raise UnreadableCurve(
            "slip reverses at none of the points, so that no end of reversal limits the curve"
        )
    last = int(np.flatnonzero(on)[-1])
    if last + 1 == on.size:
        raise UnreadableCurve(
            f"slip still reverses at the highest belt speed that has a number, {rows.belt_speed[-1]:.6g}"
        )
    low, high = (float(speed) for speed in rows.belt_speed[last : last + 2])
    fall = float(excess[last] - excess[last + 1])
    share = float(np.clip(excess[last] / fall, 0.0, 1.0)) if fall > 0.0 else 0.5
    place = low + share * (high - low)
    return Estimate(place, max(place - low, high - place))


def start_friction(rows: Rows, loads: Loads) -> Estimate:
    """Return the limit of mean friction as belt speed falls to zero. Raises UnreadableCurve.

    Zero by symmetry where the body moves on a belt at rest, or where vibrated bristles drift. A body that sticks
    under constant friction moves with the belt until spring and load at its peak exceed friction: the limit is
    mu (1 - load/friction).
    """
    if loads.unknown_start:
        raise UnreadableCurve(loads.unknown_start)
    if loads.shakedown is not None:
        return _bristle_start(rows, loads.shakedown, loads.prescribed)
    if loads.start == loads.start:
        steady = float(np.nanmax(np.abs(rows.steady), initial=0.0))
        return Estimate(loads.start, _SAMPLED * max(abs(loads.start), steady) if loads.start else 0.0)
    if loads.prescribed:
        return Estimate(0.0, 0.0)
    if loads.along == 0 == loads.across:
        raise UnreadableCurve(
            "no load drives the body: the limit of friction at vanishing belt speed is not known"
        )
    kinetic = float(np.nanmax(np.abs(rows.steady))) * loads.normal_load
    limit = kinetic if math.isnan(loads.static_limit) else max(kinetic, loads.static_limit)
    if limit <= loads.largest:
        return Estimate(0.0, 0.0)
    constant = rows.constant_friction and not loads.varying
    if loads.along_belt_only and constant and limit <= kinetic * (1.0 + _SAME):
        steady = float(np.nanmedian(rows.steady))
        return Estimate(steady * (1.0 - loads.largest / limit), _ROUNDING * steady)
    raise UnreadableCurve(
        "the body sticks to a belt at rest: the start of its curve is known only for constant friction and a load "
        "along the belt"
    )


def _bristle_start(rows: Rows, shakedown: Shakedown, prescribed: bool) -> Estimate:
    """Return the limit of friction on elastic bristles, zero where they drift.

    The error is the distance to friction at the slowest belt: were the body to vibrate beyond the elastic range, the
    limit would be zero and that friction below the elastic limit.
    """
    limit = shakedown.friction()
    if prescribed or limit == 0.0:
        return Estimate(limit, _ROUNDING * limit)
    above = float(rows.mean_friction[0] - limit)
    if above < -float(rows.error[0]):
        raise UnreadableCurve(
            f"the body may stick elastically to a slow belt, and the curve would then start at {limit:.6g}, but its "
            "first point lies below"
        )
    return Estimate(limit, min(limit, abs(above) + float(rows.error[0])))
