"""A deflection that repeats: Newton's method on what it gains in a period of prescribed slip, kept within bounds.

Licence: those of the closed loops on the line and in the plane, which this serves.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from frictionlab.compile.call import KernelCall
from frictionlab.laws.memory import BristleLaw
from frictionlab.methods.prescribed.deflection_path import follow_period
from frictionlab.methods.prescribed.loop import Closed, Loop, Open
from frictionlab.motion.steppers.radau_panel import NODES, WEIGHTS, Oscillation, Scale
from frictionlab.values.quantities import EPSILON, Floats

POINTS: Floats = np.concatenate(([0.0], NODES))
SHARES: Floats = np.concatenate(([0.0], WEIGHTS))
MOST_PERIODS = 80
NOISE = 300.0
"""How many times what is aimed at may be left open where the noise of steps hides the rest: it is in the error."""
FINEST, COARSEST, STEP = 2e-13, 1e-8, 50.0
LOST = Open(math.nan, math.nan, "the deflection could not be computed over a period")


class Accuracy(NamedTuple):
    """How well a deflection is to be followed: its scales, the error allowed per step and that asked of the mean."""

    scale: Scale
    per_step: float
    tolerance: float

    @classmethod
    def of(
        cls, law: BristleLaw, slip: Oscillation, belt_speed: float, tolerance: float, circle: float = -1.0
    ) -> Accuracy:
        """For this slip; what a soft contact changes in a period decides where it settles, so steps resolve that."""
        speed = abs(slip.along) + abs(slip.across) + abs(belt_speed)
        reach = natural_reach(law, speed)
        change = reach * min(1.0, speed / slip.frequency / reach)
        friction = abs(law.friction(0.0, reach, 0.0))
        per_step = min(max(0.01 * tolerance / friction, STEP * FINEST), COARSEST)
        return cls(Scale(reach, change, friction, circle), per_step, tolerance)


class _Period(NamedTuple):
    gained: Any
    carry: Floats
    start: Floats
    width: Floats
    slip: Any
    deflection: Any
    friction: Any


def natural_reach(law: BristleLaw, speed: float) -> float:
    """The largest deflection, or where the law declares none, that at which friction is that of sliding."""
    if law.largest_deflection() < math.inf:
        return law.largest_deflection()
    small = 1e-6
    return small * law.sliding_friction(speed) / abs(law.friction(0.0, small, 0.0))


def layer(law: BristleLaw, frequency: float, speed: Callable[[float], float]) -> float:
    """The angle after rest within which the deflection has begun to settle."""
    reach, angle = natural_reach(law, 1.0), 0.3
    for _ in range(60):
        fast = abs(speed(angle))
        rate = law.largest_rate(fast)
        rate = rate if rate < math.inf else fast / reach
        if rate * angle <= 0.3 * frequency:
            break
        angle *= 0.5
    return angle


def closed_deflection(
    law: BristleLaw, slip: Oscillation, stretches: Floats, accuracy: Accuracy, start: Any
) -> Closed | Open:
    """The closed loop, followed twice, the second time with steps fifty times more exact.

    The error is twice what that changes, what may be left of the closing, and what a step of the second time may be
    off by: two means can agree by chance.
    """
    spent, per_step, z = 0.0, accuracy.per_step, start
    while True:
        means = []
        for exactness in (per_step, per_step / STEP):
            closing = Closing(law, slip, stretches, accuracy.scale, exactness)
            period, z, left = closing.closed(z)
            spent += closing.seconds
            if period is None:
                return LOST._replace(seconds=spent)
            loop = Loop(
                period.start,
                period.width,
                POINTS,
                SHARES,
                period.slip,
                period.deflection,
                period.friction,
            )
            means.append(loop.mean)
        share = left / accuracy.scale.reach * accuracy.scale.friction
        error = 2.0 * abs(means[1] - means[0]) + 2.0 * share + 64.0 * EPSILON * loop.largest
        error += per_step / STEP * accuracy.scale.friction
        if error <= accuracy.tolerance or per_step <= STEP * FINEST:
            return Closed(loop, error, "", spent)
        per_step = max(per_step / STEP, STEP * FINEST)


class Closing:
    """The search for a deflection that repeats."""

    def __init__(
        self, law: BristleLaw, slip: Oscillation, stretches: Floats, scale: Scale, exactness: float
    ) -> None:
        self.kernel = KernelCall(follow_period, law)
        self.given = slip, stretches, scale, exactness
        self.reach, self.enough = scale.reach, max(0.1 * exactness, 1e-14) * scale.reach
        self.seconds = 0.0

    def _period(self, z: Any) -> _Period | None:
        found, seconds = self.kernel.timed(*self.given, z)
        self.seconds += seconds
        period = _Period(*found)
        return period if len(period.start) else None

    def closed(self, z: Any) -> tuple[_Period | None, Any, float]:
        """The period, the deflection it begins with, and how far that may be from repeating."""
        return self._in_the_plane(z) if isinstance(z, complex) else self._on_the_line(z)

    def _on_the_line(self, z: float) -> tuple[_Period | None, float, float]:
        """What is gained falls as the start grows: Newton's steps inside a bracket."""
        low, high, left = -self.reach, self.reach, math.inf
        for _ in range(MOST_PERIODS):
            period = self._period(z)
            if period is None:
                return None, z, left
            opened = 1.0 - float(period.carry[0, 0])
            low, high = (z, high) if period.gained > 0.0 else (low, z)
            step = float(period.gained) / opened if opened > 0.0 else math.copysign(math.inf, period.gained)
            left = min(abs(step), high - low)
            if left <= self.enough:
                return period, z, left
            z = z + step if low < z + step < high else 0.5 * (low + high)
        return None, z, left

    def _in_the_plane(self, z: complex) -> tuple[_Period | None, complex, float]:
        """Newton's method with Broyden's updates, shortened where it does not close the period further."""
        at = self._point(z)
        best = at
        for _ in range(MOST_PERIODS):
            if at is None or at.left <= self.enough:
                break
            following = self._nearer(at)
            best = at if best is None or at.left < best.left else best
            at = following
        if at is None or at.left > self.enough:
            at = best
        if at is None or at.left > NOISE * self.enough:
            return None, z, math.inf
        return at.period, at.z, at.left

    def _point(self, z: complex) -> _Point | None:
        period = self._period(z)
        if period is None:
            return None
        gained = np.array([period.gained.real, period.gained.imag])
        return _Point.of(z, period, gained, np.eye(2) - period.carry, self.reach)

    def _nearer(self, at: _Point) -> _Point | None:
        share = 1.0
        for _ in range(8):
            found = self._point(_within(at.z + share * complex(*at.step), self.reach))
            if found is None or at.free or (found.size < at.size and not found.free):
                break
            share *= 0.25
        if found is None or at.free or found.free or found.size > 0.3 * at.size:
            return found
        moved, gain = found.z - at.z, found.gained - at.gained
        change = np.array([moved.real, moved.imag])
        size = float(change @ change)
        if size == 0.0:
            return found
        matrix: Floats = at.matrix - np.outer(gain + at.matrix @ change, change) / size
        return _Point.of(found.z, found.period, found.gained, matrix, self.reach)


class _Point(NamedTuple):
    """A start of the period, what the deflection gains from there, and Newton's step; free where nothing holds it."""

    z: complex
    period: _Period
    gained: Floats
    matrix: Floats
    step: Floats
    free: bool

    @classmethod
    def of(cls, z: complex, period: _Period, gained: Floats, matrix: Floats, reach: float) -> _Point:
        """With the step that the matrix says; where nothing holds the deflection yet, far along what it gains."""
        if np.linalg.svd(matrix, compute_uv=False)[-1] > 1e-14:
            step: Floats = np.asarray(np.linalg.solve(matrix, gained), dtype=np.float64)
            return cls(z, period, gained, matrix, step, False)
        size = float(np.hypot(*gained))
        far: Floats = np.asarray(gained * (reach / size) if size > 0.0 else gained, dtype=np.float64)
        return cls(z, period, gained, matrix, far, True)

    @property
    def size(self) -> float:
        """How much the period is open."""
        return float(np.hypot(*self.gained))

    @property
    def left(self) -> float:
        """How far the deflection is from repeating."""
        return float(np.hypot(*self.step))


def _within(z: complex, reach: float) -> complex:
    return z if abs(z) <= reach else z * (reach / abs(z))
