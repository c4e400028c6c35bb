"""The kernels that find the mean friction and its error alone: what may be timed beside a peer that gives no more."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from frictionlab.compile.cache import compiled
from frictionlab.laws.base import FrictionLaw, SlidingLaw
from frictionlab.laws.memory import BristleLaw
from frictionlab.methods.base import Method
from frictionlab.methods.exact import continuation as exact_continuation
from frictionlab.methods.exact.method import Exact
from frictionlab.methods.periodic import continuation
from frictionlab.methods.periodic.problem import PeriodicProblem
from frictionlab.methods.shooting.method import Shooting
from frictionlab.scene.scene import Scene


def core(
    method: Method, scenes: Sequence[Scene], law: FrictionLaw, tolerance: float
) -> Callable[[], object] | None:
    """The kernel of a method on a curve of moving belts; None for a method that always reads its orbits too."""
    moving = all(scene.belt_speed > 0.0 for scene in scenes) and scenes[0].degrees_of_freedom > 0
    if not moving or scenes[0].undriven:
        return None
    if isinstance(method, Exact) and isinstance(law, SlidingLaw):
        return _exact(scenes, law)
    return _shooting(scenes, law, tolerance) if isinstance(method, Shooting) else None


def _exact(scenes: Sequence[Scene], law: SlidingLaw) -> Callable[[], object]:
    speeds = np.array([scene.belt_speed for scene in scenes])
    mass, friction, rows = scenes[0].mass(), law.sliding_friction(1.0), np.zeros((len(speeds), 9))
    solve = compiled(exact_continuation.solve_curve)
    return lambda: solve(mass, friction, speeds, rows)


def _shooting(scenes: Sequence[Scene], law: FrictionLaw, tolerance: float) -> Callable[[], object] | None:
    law = law.under_load(scenes[0].mass().normal_load)
    closer = PeriodicProblem(scenes[0], law, tolerance)
    if not (closer.goal.contracts or (isinstance(law, BristleLaw) and closer.falls_slowly)):
        return None  # other starts are part of the answer
    speeds, no_guess = np.array([scene.belt_speed for scene in scenes]), np.empty((0, 0))
    solve = compiled(continuation.solve_curve, law)
    return lambda: solve(closer.body, speeds, no_guess, closer.goal, closer.like)
