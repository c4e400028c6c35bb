"""Every steady state that motions end in along a curve in belt speed: orbits of any period, and what never repeats.

At each belt speed starts far from each other are followed until they repeat. Then every state found is carried on to
the next belt speed, upwards and downwards: an orbit is followed as far as it attracts, on both sides of a jump. One
motion alone is followed period after period.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import FoundState
from frictionlab.methods.periodic.follow import Attractor, closed_orbit
from frictionlab.methods.periodic.problem import PeriodicProblem
from frictionlab.methods.shooting.attractors import FollowedStarts, all_starts, found_state, same_state
from frictionlab.methods.shooting.long_motions import average_unrepeated
from frictionlab.motion.orbit.record import Orbit
from frictionlab.scene.scene import Scene
from frictionlab.theory.rest import stays_at_rest

BY_CLOSING, FROM_BELOW, FROM_ABOVE = "closed orbit", "the next lower belt speed", "the next higher belt speed"
"""Origins of a state other than a start: by the search for an orbit, by continuation from either side."""


@dataclass
class _Point:
    """States at one belt speed, each with where it was found from; ended: where its starts ended."""

    place: int
    followed: FollowedStarts
    states: list[tuple[Attractor, str]]
    ended: list[Attractor]

    def note(self, reached: Attractor, found_from: str) -> None:
        """Enter the state that a motion ended in, if it is a new one."""
        if not any(same_state(reached, one) for one, _ in self.states):
            self.states.append((reached, found_from))


def follow_states(
    scenes: Sequence[Scene], law: FrictionLaw, tolerance: float, count: int
) -> list[FoundState]:
    """States of driven scenes in ascending belt speed, by so many starts each and from those of their neighbours.

    Nothing where friction holds the mass at rest: there every place in a range is one.
    """
    problem = PeriodicProblem(scenes[0], law, tolerance)
    moving = [(i, scene) for i, scene in enumerate(scenes) if not stays_at_rest(scene, law)]
    points = [_from_starts(problem, i, scene, count) for i, scene in moving]
    _carry(pairwise(points), FROM_BELOW)
    _carry(pairwise(reversed(points)), FROM_ABOVE)
    return [
        found_state(problem, point.place, state, point.ended, way)
        for point in points
        for state, way in point.states
    ]


def _from_starts(problem: PeriodicProblem, place: int, scene: Scene, count: int) -> _Point:
    curve, _ = problem.close([scene])
    candidate = closed_orbit(curve, curve.closed.mean)
    followed = FollowedStarts(problem, scene, candidate)
    first, more = all_starts(problem, scene, count)
    for start in [*first, *more][:count]:
        followed.follow(start)
    average_unrepeated(problem, scene, followed)
    found = [] if candidate is None else [(candidate, BY_CLOSING)]
    point = _Point(place, followed, found, followed.reached)
    for number, reached in enumerate(followed.reached, 1):
        point.note(reached, f"start {number}")
    return point


def _carry(neighbours: Iterable[tuple[_Point, _Point]], found_from: str) -> None:
    """Follow the states of each point on at the next."""
    for here, there in neighbours:
        for state, _ in here.states:
            if there.followed.carry_on(state):
                there.note(there.followed.reached[-1], found_from)


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
