"""The motion of a driven mass from a start, period after period."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.periodic.problem import PeriodicProblem
from frictionlab.orbit.record import Orbit
from frictionlab.scene.scene import Scene


def follow_motion(scene: Scene, law: FrictionLaw, periods: int, tolerance: float) -> list[Orbit]:
    """A record of each period of all that changes in time, one where the other ends.

    From scene.initial, without one from the friction-free orbit. By the finest maps that this tolerance on the mean
    asks for, instants of stick and reversal located.
    """
    problem = PeriodicProblem(scene, law, tolerance)
    state = problem.state_at(scene.belt_speed, scene.initial)
    speeds, found = np.array([scene.belt_speed]), list[Orbit]()
    for _ in range(periods):
        orbit = problem.orbits([scene], [state]).one(0)
        if orbit is None:
            break
        start = found[-1].tau[-1, -1] if found else orbit.tau[0, 0]
        found.append(replace(orbit, tau=orbit.tau + (start - orbit.tau[0, 0])))
        state = problem.mapped(speeds, state[None, :])[0]
    return found
