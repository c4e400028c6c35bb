"""The grid of a stability map, what is known at each of its rates, and what a stepper or peer makes of it."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from functools import cache
from typing import Any, ClassVar, Literal, NamedTuple

import numpy as np

from frictionlab.bench.solvers import solve_points
from frictionlab.bench.stability.problems import PROBLEMS, StabilityProblem, width_at
from frictionlab.bench.stability.record import MapPoint, StabilityMap, StepLimit
from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.march.laps import MarchState
from frictionlab.methods.march.run import MarchRun
from frictionlab.methods.march.steppers import Resolution, StepperName
from frictionlab.methods.shooting.method import Shooting
from frictionlab.scene.scene import Scene

BEST_TOLERANCE = 1e-12
SETTLED_LAPS = 400
FINE_STEPS = {"bristle": 65_536, "smoothing": 4096, "plane": 4096}
"""Per period, of the run that gives the state; more where slip reverses, which steps meet with order two."""


class KnownState(NamedTuple):
    """A scene at a rate with its steady state: mean friction and its error, largest slip, where a period begins."""

    scene: Scene
    law: FrictionLaw
    mean: float
    error: float
    most_slip: float
    state: MarchState


def spaced(ends: tuple[float, float], n: int) -> list[float]:
    """In equal ratios, ascending."""
    return [float(value) for value in np.geomspace(min(ends), max(ends), n)]


def whole_steps(ends: tuple[float, float], n: int) -> list[int]:
    """Steps per period in about equal ratios, each once."""
    return sorted({round(value) for value in spaced(ends, n)})


@cache
def known_state(problem: str, rate: float, smoothed: bool = False) -> KnownState:
    """By shooting, the state at the start of a period by many small steps; smoothed: of friction smoothed instead."""
    scene, law = PROBLEMS[problem].at(rate)
    ready = law.under_load(scene.normal_load or 1.0)
    if smoothed:
        pace = Resolution(width=width_at(rate), accuracy=1e-12, enough=1e-10, most=SETTLED_LAPS)
        run = MarchRun(scene, ready, "smoothed").run(pace)
        return KnownState(scene, ready, run.mean.real, 1e-9, run.met, run.place)
    found = solve_points(Shooting(), [scene], law, BEST_TOLERANCE)
    steps = max(FINE_STEPS[problem], int(8.0 * rate))
    stepper: StepperName = "moreau" if problem == "smoothing" else "rk4"
    run = MarchRun(scene, ready, stepper).run(Resolution(steps=steps, enough=1e-12, most=SETTLED_LAPS))
    return KnownState(scene, ready, float(found.means[0]), float(found.errors[0]), run.met, run.place)


def local_rate(problem: str, known: KnownState, rate: float) -> float:
    """The rate at the largest slip that is really met, for bristles; else as it was asked for."""
    if problem != "bristle":
        return rate
    law: Any = known.law
    return float(law.largest_rate(known.most_slip))


@dataclass(frozen=True)
class MappedSolver(ABC):
    """A stepper or peer on the grid; problems: those it can take, integrated: what each point integrates."""

    setting: ClassVar[Literal["steps", "tolerance"]] = "tolerance"
    name: str
    problems: tuple[str, ...]
    integrated: str

    def missing(self) -> str:
        """How to install it where it is not there."""
        return ""

    @abstractmethod
    def limit(self, problem: StabilityProblem) -> StepLimit:
        """How long its steps may be."""

    @abstractmethod
    def point(self, problem: StabilityProblem, rate: float, at: float) -> MapPoint:
        """What it comes to at a rate and a setting."""

    def map_of(self, problem: StabilityProblem, n: int) -> StabilityMap:
        """n settings by n rates."""
        rates, settings = spaced(problem.rates, n), spaced(problem.tolerances, n)
        if self.setting == "steps":
            settings = [float(count) for count in whole_steps(problem.steps, n)]
        points = [self.point(problem, rate, at) for rate in rates for at in settings]
        return StabilityMap(problem, self.setting, self.limit(problem), settings, rates, points)
