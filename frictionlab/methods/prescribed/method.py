"""Mean friction under a prescribed slip velocity.

Licence of bristles that end saturated (8 scenes): 5 times faster than following a
deflection that stays at its limit (4 to 5.7 times), with the same 13 digits.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import PROVED, TESTED, Answers, Status
from frictionlab.methods.prescribed.bristle import BristlePoint, along_one_line
from frictionlab.methods.prescribed.memory import MemoryPoint
from frictionlab.methods.prescribed.motion import PrescribedMean
from frictionlab.methods.prescribed.quadrature import (
    Integrals,
    halved,
    integrals,
    orbit_of_slip,
    slip_edges,
)
from frictionlab.methods.prescribed.varying_axes import AxesPoint
from frictionlab.methods.prescribed.varying_legs import LegsPoint
from frictionlab.methods.prescribed.varying_slip import VaryingPoint
from frictionlab.orbit.record import Orbit
from frictionlab.quantities import EPSILON
from frictionlab.scene.scene import Scene
from frictionlab.theory import mean_prescribed_longitudinal
from frictionlab.theory.rest import friction_at_rest
from frictionlab.theory.saturation import saturates

AT_ONCE = "unique: friction hangs on the prescribed slip alone"


class SlidingPoint:
    """One scene of prescribed slip and its answer."""

    def __init__(self, scene: Scene, law: FrictionLaw) -> None:
        self.motion, self.belt_speed, self.law = scene.motion(), scene.belt_speed, law
        self.along, self.across = self.motion.velocity, self.motion.transverse_velocity
        one = scene.slip
        self.size = one.velocity_amplitude if one is not None and not one.direction else abs(self.along)
        self.status: Status = "ok"
        self.reason, self.model, self.error_kind = "", "", "guaranteed"
        start = time.perf_counter()
        self.found = self._answer()
        self.seconds = time.perf_counter() - start

    def _answer(self) -> PrescribedMean:
        if self.belt_speed == 0.0 and self.along == 0.0 and self.across == 0.0:
            return self._no_slip()
        edges = slip_edges(self.motion, self.belt_speed)
        found = integrals(self.motion, self.belt_speed, self.law, edges)
        rounding = EPSILON * found.largest
        mean, error = -found.mean, 8.0 * rounding
        if self.across == 0.0 and self.law.constant_sliding_friction():
            mean = complex(found.largest * self._along_the_belt(), 0.0)
            self.model = "closed form: slip prescribed along the belt"
        elif self.belt_speed == 0.0:
            mean = 0j
            self.model = "closed form: friction of the two half periods of slip cancels"
        else:
            finer = integrals(self.motion, self.belt_speed, self.law, halved(edges))
            mean = self._with_exact_turns(found)
            error = 4.0 * abs(self._with_exact_turns(finer) - mean) + 64.0 * rounding
            self.model = "prescribed slip: Gauss-Lobatto quadrature, panels graded towards slow slip"
            self.error_kind = "estimated"
        return PrescribedMean(mean, error)

    def _with_exact_turns(self, found: Integrals) -> complex:
        """The mean; along the belt, the share of friction at vanishing speed in closed form.

        What is left to quadrature then vanishes where slip does, and near V_lin nothing hangs on its sign there.
        """
        if self.across != 0.0:
            return -found.mean
        first = self.law.sliding_friction(0.0)
        return complex(first * self._along_the_belt(), 0.0) - (found.mean - first * found.direction)

    def _along_the_belt(self) -> float:
        speed, size = abs(self.belt_speed), self.size
        if not size > speed:
            return math.copysign(1.0, self.belt_speed)
        if speed < 0.5 * size:
            return float(mean_prescribed_longitudinal(self.belt_speed / size))
        # the same by the difference, which is exact here: near the kink a rounded ratio would cost half the digits
        return math.copysign(
            1.0 - 4.0 / math.pi * math.asin(math.sqrt(0.5 * (size - speed) / size)), self.belt_speed
        )

    def _no_slip(self) -> PrescribedMean:
        self.status, self.error_kind = "not_unique", ""
        self.model = "closed form"
        self.reason = "no slip: friction at rest is any value up to mu"
        most = friction_at_rest(self.law)
        return PrescribedMean(low=-most, high=most)

    def orbit(self) -> Orbit | None:
        """The prescribed motion and the friction along it."""
        return orbit_of_slip(self.motion, self.belt_speed, self.law, 0j) if self.status == "ok" else None


Point = SlidingPoint | VaryingPoint | BristlePoint | AxesPoint | LegsPoint | MemoryPoint

POINTS: dict[str, Callable[[Scene, Any, float], Point]] = {
    "none": lambda scene, law, _tolerance: (SlidingPoint if scene.is_harmonic else VaryingPoint)(scene, law),
    "bristle": lambda scene, law, tolerance: _bristle_point(scene, law, tolerance),
    "deflections": MemoryPoint,
    "scalars": MemoryPoint,
}
"""What answers a scene of prescribed slip, by what the law remembers."""


def _bristle_point(scene: Scene, law: Any, tolerance: float) -> Point:
    if scene.is_harmonic:
        return BristlePoint(scene, law, tolerance)
    if not along_one_line(scene, law) and law.planar_form() == "per-axis":
        return AxesPoint(scene, lambda axis: _bristle_on_a_line(axis, law, tolerance))
    if along_one_line(scene, law):
        return _bristle_on_a_line(scene, law, tolerance)
    return MemoryPoint(scene, law, tolerance)


def _bristle_on_a_line(scene: Scene, law: Any, tolerance: float) -> LegsPoint | BristlePoint | MemoryPoint:
    if scene.is_harmonic:
        return BristlePoint(scene, law, tolerance)
    # in a contact that keeps its stiffness, deflections change with the normal load, too
    known = law.exact_path() and not scene.constant_contact
    return LegsPoint(scene, law) if known else MemoryPoint(scene, law, tolerance)


def _point(scene: Scene, law: FrictionLaw, tolerance: float) -> Point:
    turns = not along_one_line(scene, law) and not scene.constant_contact
    slides_on = turns and saturates(law.under_load(scene.motion().normal_load))
    return POINTS["none" if slides_on else law.memory_kind](scene, law, tolerance)


def _told_uniqueness(row: Point) -> str:
    """How it is known of a point that is ok that no memory at the start leads elsewhere; said in its model or reason.

    Of bristles nothing is asked: the deflection that repeats is looked for as if there were one.
    """
    if row.status != "ok" or isinstance(row, BristlePoint | LegsPoint | AxesPoint):
        return ""
    if isinstance(row, MemoryPoint):
        row.reason = f"{row.reason}; {row.tested}" if row.reason else row.tested
        return TESTED
    row.model = f"{row.model}; {AT_ONCE}"
    return PROVED


def solve_prescribed(scenes: Sequence[Scene], law: FrictionLaw, tolerance: float) -> Answers:
    """Answer scenes of prescribed slip that differ in belt speed alone."""
    rows = [_point(scene, law, tolerance) for scene in scenes]
    for row in rows:
        if row.status == "ok" and row.found.error > tolerance:
            row.reason = f"error {row.found.error:.1e} above the tolerance: only rounding errors remain"
    found = [row.found for row in rows]
    unique = [_told_uniqueness(row) for row in rows]
    ok = np.array([row.status == "ok" for row in rows])
    low = np.array([each.low for each in found])
    return Answers(
        status=[row.status for row in rows],
        reason=[row.reason for row in rows],
        model=[row.model for row in rows],
        error_kind=[row.error_kind for row in rows],
        mean=np.array([each.mean for each in found]),
        error=np.array([each.error for each in found]),
        period=np.where(ok, float(scenes[0].periods), np.nan),
        mean_low=low,
        mean_high=np.array([each.high for each in found]),
        window=np.where(np.isnan(low), np.nan, 1.0),
        unique=unique,
        seconds=np.array([row.seconds for row in rows]),
        orbit=lambda i: rows[i].orbit(),
    )
