"""The problems of the stability maps: scenes in which something decays at a local rate that can be chosen.

A point of a stability map, the region it lies in, and the map of one stepper.

The grid of a stability map, what is known at each of its rates, and what a stepper or peer makes of it.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any, ClassVar, Literal, NamedTuple

import numpy as np

from frictionlab.bench.measure import solve_points
from frictionlab.laws.base import FrictionLaw
from frictionlab.laws.coulomb import Coulomb
from frictionlab.laws.dahl import Dahl
from frictionlab.methods.march.laps import MarchState
from frictionlab.methods.march.run import MarchRun
from frictionlab.methods.march.steppers import Resolution, StepperName
from frictionlab.methods.shooting.method import Shooting
from frictionlab.scene.scene import Drive, Initial, Load, Scene, Transverse

MU = 0.4
_SHAKEN = Scene(damping_ratio=0.5, normal_load=1.0, belt_speed=1.0, drive=Drive(amplitude=4.0, frequency=1.0))
"""Weak friction: slip goes from -5 to 3, and settles within a few periods."""
_FASTEST = 5.0
_CARRIED = Scene(
    damping_ratio=0.5, normal_load=10.0, belt_speed=0.5, drive=Drive(amplitude=3.0, frequency=1.0)
)
"""The load is below friction: smoothed friction lets the mass creep where it would stick."""


@dataclass(frozen=True)
class StabilityProblem:
    """Scenes by their local rate; rate_text: what that is, memory: what its law remembers."""

    name: str
    title: str
    rate_text: str
    memory: str
    at: Callable[[float], tuple[Scene, FrictionLaw]]
    steps: tuple[float, float] = (8.0, 4096.0)
    tolerances: tuple[float, float] = (1e-1, 1e-9)
    rates: tuple[float, float] = (1.0, 1e3)


def width_at(rate: float) -> float:
    """The smoothing width whose slope at rest makes slip decay at this rate."""
    return (_CARRIED.normal_load or 1.0) * MU / rate


def _bristles(rate: float) -> tuple[Scene, FrictionLaw]:
    return _SHAKEN, Dahl(mu=MU, stiffness=rate * MU / _FASTEST)


def _smoothing(rate: float) -> tuple[Scene, FrictionLaw]:
    return _CARRIED, Coulomb(mu=MU)


def _in_the_plane(rate: float) -> tuple[Scene, FrictionLaw]:
    """Belt speed 1; the transverse load turns the slip by as little as keeps the mass from moving with the belt.

    The spring across grows with the rate, or the mass would creep to its place within as many periods; along the belt
    it starts where the spring balances friction, or the belt would carry it there within as many.
    """
    quick = math.sqrt(rate)
    across = Transverse(natural_frequency=quick, damping_ratio=0.5, load=Load(amplitude=quick))
    scene = Scene(
        damping_ratio=0.5,
        normal_load=rate / MU,
        belt_speed=1.0,
        drive=Drive(amplitude=0.0, frequency=1.0),
        transverse=across,
        initial=Initial(x=rate),
    )
    return scene, Coulomb(mu=MU)


_ALL = (
    StabilityProblem("bristle", "bristles of Dahl's law", "largest |slip| k/mu", "bristle", _bristles),
    StabilityProblem("smoothing", "friction smoothed by tanh", "friction limit / width", "none", _smoothing),
    StabilityProblem("plane", "slow slip in the plane", "friction limit / |slip|", "none", _in_the_plane),
)
PROBLEMS: dict[str, StabilityProblem] = {problem.name: problem for problem in _ALL}
"""By name, in the order of tables and pictures."""


Region = Literal["right", "wrong_and_said", "wrong_and_silent"]
REGIONS: tuple[Region, ...] = ("right", "wrong_and_said", "wrong_and_silent")
WRONG = 0.01 * MU
"""A true error above this is wrong, whatever was stated or asked."""
TIMES_ASKED = 10.0
"""A peer, which states no error, may be off by so many times the tolerance that it was asked for."""


class MapPoint(NamedTuple):
    """One setting at one rate: the step taken (a usual one), the true error, and the one stated or allowed.

    held: the step times the frequency of the mass held by its bristles, 0 where that limits nothing.
    """

    value: float
    rate: float
    step: float
    status: str
    reason: str
    error: float
    stated: float
    held: float = 0.0

    @property
    def region(self) -> Region:
        """Whether it is right, and where not, whether anything tells."""
        if self.status != "ok":
            return "wrong_and_said"
        if not self.error <= self.stated:
            return "wrong_and_silent"
        return "right" if self.error <= WRONG else "wrong_and_said"


@dataclass(frozen=True)
class StepLimit:
    """Largest step times rate, infinite where any step will do.

    held: a limit of the step times the frequency of a mass held by its bristles, infinite where there is none.
    """

    predicted: float
    measured: float
    held: float = math.inf


@dataclass(frozen=True)
class StabilityMap:
    """A grid of points of one stepper on one problem; settings and rates ascend, all settings of a rate together."""

    problem: StabilityProblem
    setting: Literal["steps", "tolerance"]
    limit: StepLimit
    settings: Sequence[float]
    rates: Sequence[float]
    points: Sequence[MapPoint]

    def counts(self) -> dict[Region, int]:
        """How many points lie in each region."""
        found = Counter(point.region for point in self.points)
        return {region: found[region] for region in REGIONS}


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
