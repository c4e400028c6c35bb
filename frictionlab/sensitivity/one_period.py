"""One period of a scene and a law from a given state: the state that it leaves, and the mean friction meanwhile."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from frictionlab.laws.base import FrictionLaw
from frictionlab.laws.memory import BristleLaw
from frictionlab.methods.periodic.continuation import FINE
from frictionlab.methods.periodic.map_kinds import MAP_KINDS, map_kind
from frictionlab.methods.periodic.problem import PeriodicProblem, along_the_belt
from frictionlab.quantities import Floats
from frictionlab.scene.scene import Scene
from frictionlab.study.grid import law_in_scene

_WITH_ONE_DEFLECTION = 3
"""Numbers of a state on the line: position, velocity, deflection."""


class OnePeriod(NamedTuple):
    """The period map of a scene and a law; kind: of the map."""

    problem: PeriodicProblem
    scene: Scene
    law: FrictionLaw  # in the lengths and times of the scene

    @classmethod
    def of(cls, scene: Scene, law: FrictionLaw) -> OnePeriod:
        """That of a driven mass."""
        inside = law_in_scene(law, scene)
        kind = map_kind(inside, not along_the_belt(scene, inside))
        return cls(PeriodicProblem(scene, inside, MAP_KINDS[kind].finest), scene, inside)

    def like(self, other: OnePeriod) -> bool:
        """Whether states of the other are states of this one, followed by the same map."""
        mine, theirs = ((one.problem.size, one.problem.kind, one.law.structure()) for one in (self, other))
        return mine == theirs

    def noise(self, z: Floats) -> Floats:
        """By how much state and mean friction jump where steps are chosen otherwise."""
        relative = MAP_KINDS[self.problem.kind].noise
        return np.append(np.full(z.size, relative * (1.0 + float(np.linalg.norm(z)))), relative)

    def drift(self, z: Floats) -> Floats:
        """By how much steps leave them wrong: what varies as slowly as they do themselves."""
        load = self.problem.body.normal_load
        return np.append(np.full(z.size, FINE * load), self.problem.goal.tolerance)

    def closed(self) -> Floats | None:
        """The state of the closed orbit, as well as the search finds it; None where it finds none."""
        for way in filter(None, (self.problem, self.problem.by_implicit_steps)):
            curve, _ = way.close([self.scene])
            if curve.closed.found[0]:
                return np.array(curve.states[0])
        return None

    def from_states(self, states: Floats) -> Floats:
        """From each of states [n, size] the state a period later and the mean friction along x1 [n, size + 1]."""
        ends, means = self.problem.repeated_once(self.scene, self._yielding(states))
        return np.column_stack((ends, means))

    def _yielding(self, states: Floats) -> Floats:
        """The states with deflections cut back to the yield of a slider: on the line no slip leads beyond."""
        law = self.law
        if not isinstance(law, BristleLaw) or states.shape[1] != _WITH_ONE_DEFLECTION:
            return states
        reach = law.yield_deflection()
        if not np.isfinite(reach):
            return states
        # as states have it: a deflection times sqrt(normal_load*stiffness)
        most = np.sqrt(self.problem.body.normal_load * abs(law.friction(0.0, reach, 0.0)) * reach)
        return np.column_stack((states[:, :2], np.clip(states[:, 2:], -most, most)))
