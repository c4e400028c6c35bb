"""What lanes answer of a curve: closed orbits, their record and multipliers, but where an orbit meets rest."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from frictionlab.compile.call import KernelCall
from frictionlab.compile.interpret import interpreted
from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.periodic.continuation import recorded_accuracy
from frictionlab.methods.periodic.fixed_point import Goal
from frictionlab.methods.periodic.lane_curve import LaneCurve, answer_lanes
from frictionlab.methods.periodic.lane_monodromy import differentiate_in_lanes
from frictionlab.methods.periodic.lane_record import record_in_lanes
from frictionlab.orbit.recorder import Track
from frictionlab.quantities import Floats
from frictionlab.scene.body import Body

FEWEST_IN_LANES = 4
"""Points of a curve; fewer are answered one by one."""


class LaneCalls(NamedTuple):
    """The kernels of lanes, of one law and body."""

    law: FrictionLaw
    body: Body
    goal: Goal

    def close(self, belt_speeds: Floats) -> tuple[LaneCurve, float]:
        """The orbits, and kernel time [s]."""
        return KernelCall(answer_lanes, self.law).timed(self.body, belt_speeds, self.goal)

    def differentiate(self, belt_speeds: Floats, states: Floats) -> Floats:
        """The monodromies of orbits [n, 4, 4]; NaN where lanes leave one."""
        return KernelCall(differentiate_in_lanes, self.law)(self.body, belt_speeds, states)

    def record(self, belt_speeds: Floats, states: Floats) -> tuple[Track, NDArray[np.int64]]:
        """The track of orbits and the panels before which each ends [n]; without panels where lanes leave one."""
        accuracy = interpreted(recorded_accuracy)(self.body.normal_load, self.goal)
        return KernelCall(record_in_lanes, self.law)(self.body, belt_speeds, states, accuracy)
