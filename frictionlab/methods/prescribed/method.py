"""Prescribed slip: the mean friction of a slip velocity that is given."""

from __future__ import annotations

import math
import time
from collections.abc import Sequence

import numpy as np

from frictionlab.laws.base import FrictionLaw
from frictionlab.laws.memory import BristleLaw, MemoryLaw
from frictionlab.methods.base import Answers, Status
from frictionlab.methods.prescribed.bristle import BristlePoint, saturates
from frictionlab.methods.prescribed.memory import MemoryPoint
from frictionlab.methods.prescribed.motion import (
    Reading,
    prescribed_columns,
    undecided_columns,
)
from frictionlab.methods.prescribed.quadrature import (
    EPSILON,
    Integrals,
    belt_friction_at_rest,
    halved,
    integrals,
    orbit_of_slip,
    slip_edges,
)
from frictionlab.orbit.record import Orbit
from frictionlab.scene.scene import Scene
from frictionlab.theory import mean_prescribed_longitudinal


def solve_prescribed(scenes: Sequence[Scene], law: FrictionLaw, tolerance: float) -> Answers:
    """Answer scenes of prescribed slip that differ in belt speed alone."""
    rows = [_point(scene, law, tolerance) for scene in scenes]
    columns = {name: np.array([row.columns[name] for row in rows]) for name in rows[0].columns}
    columns["seconds"] = np.array([row.seconds for row in rows])
    for row in rows:
        if row.status == "ok" and row.columns["error"] > tolerance:
            row.reason = (
                f"error {row.columns['error']:.1e} above the tolerance: rounding is all that is left in it"
            )
    return Answers(
        [row.status for row in rows],
        [row.reason for row in rows],
        [row.model for row in rows],
        [row.error_kind for row in rows],
        columns,
        lambda i: rows[i].orbit(),
    )


def _point(scene: Scene, law: FrictionLaw, tolerance: float) -> _Point | BristlePoint | MemoryPoint:
    if isinstance(law, MemoryLaw):
        return MemoryPoint(scene, law, tolerance)
    if isinstance(law, BristleLaw) and not saturates(scene, law):
        return BristlePoint(scene, law, tolerance)
    return _Point(scene, law)


class _Point:
    """One scene of prescribed slip and its answer."""

    def __init__(self, scene: Scene, law: FrictionLaw) -> None:
        self.motion, self.belt_speed, self.law = scene.motion(), scene.belt_speed, law
        self.planar = scene.transverse_slip is not None
        self.along, self.across = self.motion.velocity, self.motion.transverse_velocity
        self.size = scene.slip.velocity_amplitude if scene.slip is not None else 0.0
        self.status: Status = "ok"
        self.reason, self.model, self.error_kind = "", "", "guaranteed"
        start = time.perf_counter()
        self.columns = self._answer()
        self.seconds = time.perf_counter() - start

    def _answer(self) -> dict[str, float]:
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
            self.model = "closed form: each half period of slip undoes the other"
        else:
            finer = integrals(self.motion, self.belt_speed, self.law, halved(edges))
            mean = self._with_exact_turns(found)
            error = 4.0 * abs(self._with_exact_turns(finer) - mean) + 64.0 * rounding
            self.model = "prescribed slip: Gauss-Lobatto quadrature, panels graded towards slow slip"
            self.error_kind = "estimated"
        return self._row(mean, error, found)

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

    def _no_slip(self) -> dict[str, float]:
        self.status, self.error_kind = "not_unique", ""
        self.model = "closed form"
        self.reason = "nothing moves: friction at rest may be anything up to mu"
        most = belt_friction_at_rest(self.law)
        return undecided_columns(self.motion, -most, most)

    def _row(self, mean: complex, error: float, found: Integrals) -> dict[str, float]:
        turns = 2.0 if abs(self.belt_speed) < abs(self.along) else 0.0
        read = Reading(mean, error, found.contact, found.taken, turns, turns)
        return prescribed_columns(self.motion, self.planar, read)

    def orbit(self) -> Orbit | None:
        """The prescribed motion and the friction along it."""
        return orbit_of_slip(self.motion, self.belt_speed, self.law, 0j) if self.status == "ok" else None
