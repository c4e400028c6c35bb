"""Bristle laws under a prescribed slip: the periodic deflection, and the results computed from it."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from frictionlab.compile.call import KernelCall
from frictionlab.compile.decorators import njit
from frictionlab.dynamics.contact import resistance
from frictionlab.laws.base import FrictionLaw
from frictionlab.laws.memory import PER_AXIS, ROTATED, BristleLaw
from frictionlab.methods.base import Status
from frictionlab.methods.prescribed.closed_loop_line import ONE_WAY, Along, line_loop
from frictionlab.methods.prescribed.closed_loop_plane import plane_loop
from frictionlab.methods.prescribed.loop import Closed, Loop, Open, Vectors
from frictionlab.methods.prescribed.motion import PrescribedMean, displacement, velocity
from frictionlab.orbit.panels import NODES
from frictionlab.orbit.record import Orbit
from frictionlab.quantities import Floats
from frictionlab.scene.scene import Scene

BY_SYMMETRY = "closed form: friction of the two half periods of slip cancels"
ROUNDING = 2.0**-50


def along_one_line(scene: Scene, law: FrictionLaw) -> bool:
    """Whether the prescribed slip keeps to the belt's line, and the law with it."""
    return scene.load_along_belt_only and (scene.transverse_slip is None or law.planar_form() != "rotated")


class BristlePoint:
    """One scene of prescribed slip, a bristle law, and the answer."""

    def __init__(self, scene: Scene, law: BristleLaw, tolerance: float) -> None:
        self.motion, self.belt_speed = scene.motion(), scene.belt_speed
        self.law = law.under_load(self.motion.normal_load)
        self.planar = scene.transverse_slip is not None or self.motion.transverse_velocity != 0
        self.loops = self._loops(along_one_line(scene, law), tolerance)
        self.seconds = sum(loop.seconds for loop in self.loops)
        self.status: Status = "ok"
        self.reason, self.model, self.error_kind = "", "", "estimated"
        self.found = self._answer()

    def _loops(self, one_line: bool, tolerance: float) -> list[Closed | Open]:
        """The loop in the plane, or along the belt, or those of both axes."""
        motion = self.motion
        along = Along(motion.velocity, self.belt_speed, motion.frequency)
        across = Along(motion.transverse_velocity, 0.0, motion.frequency)
        if one_line:
            return [line_loop(self.law, along, tolerance)]
        if self.law.form == PER_AXIS:
            return [line_loop(self.law, along, tolerance), line_loop(self.law, across, tolerance)]
        return [plane_loop(self.law, motion, self.belt_speed, tolerance)]

    def _answer(self) -> PrescribedMean:
        first = self.loops[0]
        if isinstance(first, Open):
            self.status = "failed" if math.isnan(first.low) else "not_unique"
            self.reason, self.error_kind = first.reason, ""
            return PrescribedMean(low=first.low, high=first.high)
        self.model = first.model
        mean, error = first.loop.mean, first.error
        if self.belt_speed == 0.0:
            mean, error, self.model = 0j, ROUNDING * first.loop.largest, BY_SYMMETRY
            self.error_kind = "guaranteed"
        elif self._saturated(first):
            self.error_kind = "guaranteed"
        if any(isinstance(other, Open) for other in self.loops[1:]):
            mean = complex(mean.real, math.nan)
        elif len(self.loops) > 1:
            mean = complex(mean.real, 0.0)
        return PrescribedMean(mean, error)

    def _saturated(self, closed: Closed) -> bool:
        return closed.model == ONE_WAY and self.law.constant_sliding_friction()

    def orbit(self) -> Orbit | None:
        """One period of the prescribed motion, and the friction of the deflection along it; NaN across the belt where
        the deflection there depends on its start."""
        loops = [closed.loop for closed in self.loops if isinstance(closed, Closed)]
        if self.status != "ok":
            return None
        angle = _angles(loops)
        x, v = displacement(self.motion, angle), velocity(self.motion, angle)
        friction = self._friction(v - self.belt_speed, [loop.deflection_at(angle) for loop in loops])
        return Orbit(angle / self.motion.frequency, x, v, friction, np.zeros(len(angle), np.bool_))

    def _friction(self, slip: Vectors, deflections: list[Floats]) -> Vectors:
        z, law = deflections[0], self.law
        unknown = complex(0.0, math.nan if len(deflections) < len(self.loops) else 0.0)
        if len(deflections) == 2:
            return _resisted(law, slip.real, z) + 1j * _resisted(law, slip.imag, deflections[1])
        if self._on_the_line():
            return _resisted(law, slip.real, z) + unknown
        return _resisted(law, slip, z.astype(complex))

    def _on_the_line(self) -> bool:
        """Whether the one loop is that of a line."""
        across = self.motion.transverse_velocity == 0 or self.law.form == PER_AXIS
        return not self.planar or (across and self.law.form != ROTATED)


def _resisted(law: BristleLaw, slip: Any, deflection: Any) -> Vectors:
    """The friction coefficient at every slip velocity and deflection."""
    rub = np.empty(slip.size, slip.dtype)
    KernelCall(friction_of_each, law)(slip.ravel(), deflection.ravel(), rub)
    return rub.reshape(slip.shape)


@njit
def friction_of_each(law: Any, slip: Any, deflection: Any, rub: Any) -> None:
    """Fill rub with the friction of a bristle law at each slip velocity and deflection."""
    for i in range(slip.size):
        rub[i] = resistance(law, slip[i], deflection[i])[1]


def _angles(loops: list[Loop]) -> Floats:
    """Gauss-Lobatto nodes of panels from 0 to once around, none of which reaches over the edge of a loop's panel."""
    edges = np.concatenate([loop.start for loop in loops]) % (2.0 * math.pi)
    edges = np.unique(np.concatenate(([0.0, 2.0 * math.pi], edges)))
    half = 0.5 * np.diff(edges)[:, None]
    return np.asarray(edges[:-1, None] + half * (1.0 + NODES))
