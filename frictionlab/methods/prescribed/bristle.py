"""Bristle laws under a prescribed slip: the periodic deflection, and the results computed from it."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from frictionlab.compile.call import KernelCall
from frictionlab.compile.decorators import njit
from frictionlab.dynamics.contact import resistance
from frictionlab.laws.base import FrictionLaw
from frictionlab.laws.memory import BristleLaw
from frictionlab.methods.base import Status
from frictionlab.methods.prescribed.closed_loop_line import Along, line_loop
from frictionlab.methods.prescribed.collocation import plane_loop
from frictionlab.methods.prescribed.loop import Closed, Open, PrescribedMean, Vectors
from frictionlab.methods.prescribed.varying_slip import VaryingSlip, nodes
from frictionlab.methods.words import ModelWord
from frictionlab.orbit.record import Orbit
from frictionlab.scene.scene import Scene

ROUNDING = 2.0**-50


def along_one_line(scene: Scene, law: FrictionLaw) -> bool:
    """Whether the prescribed slip keeps to the belt's line, and the law with it."""
    return scene.load_along_belt_only and (scene.transverse_slip is None or law.planar_form() != "rotated")


class BristlePoint:
    """One scene of a prescribed sine, or of an ellipse in the vectorial or rotated form, and the answer."""

    def __init__(self, scene: Scene, law: BristleLaw, tolerance: float) -> None:
        self.scene, self.motion, self.belt_speed = scene, scene.motion(), scene.belt_speed
        self.law = law.under_load(self.motion.normal_load)
        self.line = along_one_line(scene, law)
        if self.line:
            along = Along(self.motion.velocity, self.belt_speed, self.motion.frequency)
            self.closed = line_loop(self.law, along, tolerance)
        else:
            self.closed = plane_loop(self.law, self.motion, self.belt_speed, tolerance)
        self.seconds = self.closed.seconds
        self.status: Status = "ok"
        self.reason, self.model, self.error_kind = "", "", "estimated"
        self.found = self._answer(self.closed)

    def _answer(self, closed: Closed | Open) -> PrescribedMean:
        if isinstance(closed, Open):
            self.status = "failed" if math.isnan(closed.low) else "not_unique"
            self.reason, self.error_kind = closed.reason, ""
            return PrescribedMean(low=closed.low, high=closed.high)
        self.model = closed.model
        if self.belt_speed == 0.0:
            self.model, self.error_kind = ModelWord.SYMMETRY, "guaranteed"
            return PrescribedMean(0j, ROUNDING * closed.loop.largest)
        if closed.model == ModelWord.SLIP_ONE_WAY and self.law.constant_sliding_friction():
            self.error_kind = "guaranteed"
        return PrescribedMean(closed.loop.mean, closed.error)

    def orbit(self) -> Orbit | None:
        """One period of the prescribed motion, and the friction of the deflection along it."""
        if isinstance(self.closed, Open):
            return None
        loop, slip = self.closed.loop, VaryingSlip.of(self.scene.signals(), self.motion.normal_load)
        # no panel of the orbit reaches over the edge of one of the loop's
        edges = np.unique(np.concatenate(([0.0, 2.0 * math.pi], loop.start % (2.0 * math.pi))))
        angle, _ = nodes(edges)
        tau, deflection = angle / self.motion.frequency, loop.at(angle, loop.deflection)
        v = slip.velocity(tau, np.zeros(1, np.int64)) - self.belt_speed
        moved = (v.real, deflection) if self.line else (v, deflection.astype(complex))
        return slip.orbit(tau, _resisted(self.law, *moved))


def _resisted(law: BristleLaw, slip: Any, deflection: Any) -> Vectors:
    """The friction coefficient at every slip velocity and deflection."""
    rub = np.empty(slip.size, slip.dtype)
    KernelCall(friction_of_each, law)(slip.ravel(), deflection.ravel(), rub)
    return rub.reshape(slip.shape).astype(complex)


@njit
def friction_of_each(law: Any, slip: Any, deflection: Any, rub: Any) -> None:
    """Fill rub with the friction of a bristle law at each slip velocity and deflection."""
    for i in range(slip.size):
        rub[i] = resistance(law, slip[i], deflection[i])[1]
