"""The steppers of march on the grid: what the method answers, and how far off that is."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar, Literal

import numpy as np

from frictionlab.bench.solvers import solve_points
from frictionlab.bench.stability.grid import KnownState, MappedSolver, known_state, local_rate
from frictionlab.bench.stability.limits import predicted_limit, stepper_limit
from frictionlab.bench.stability.problems import StabilityProblem, width_at
from frictionlab.bench.stability.record import MapPoint, StepLimit
from frictionlab.methods.march.error import Plan, march_mean
from frictionlab.methods.march.method import March
from frictionlab.methods.march.run import MarchRun
from frictionlab.methods.march.stability import quickest_when_held
from frictionlab.methods.march.steppers import STEPPERS, Resolution, StepperName

LONGEST_MARCH = 200
"""That a motion is waited for to repeat: where it is right, it does so in twenty, but for rounding."""
OFFERED_THETAS = 0.5, 1.0
MARCHED = "a mass by march until its motion repeats, for 200 periods at most"
CREPT = "the creep of a mass that would stick, by march until it repeats, at several widths"


@dataclass(frozen=True)
class MappedStepper(MappedSolver):
    """A stepper of march at fixed steps."""

    setting: ClassVar[Literal["steps", "tolerance"]] = "steps"
    stepper: StepperName
    theta: float = 0.5

    @property
    def _held(self) -> float:
        """Largest step times frequency of a mass held by its contact, where nothing else limits steps."""
        facts = STEPPERS[self.stepper]
        return math.inf if facts.limited_by_rates else facts.held

    def limit(self, problem: StabilityProblem) -> StepLimit:
        """By theory, and of one step."""
        measured = stepper_limit(self.stepper, self.theta, problem.memory)
        return StepLimit(predicted_limit(self.stepper, self.theta), measured, self._held)

    def point(self, problem: StabilityProblem, rate: float, at: float) -> MapPoint:
        """At so many steps per period."""
        known, steps = known_state(problem.name, rate), round(at)
        rate, step = local_rate(problem.name, known, rate), 2.0 * math.pi / (known.scene.frequency * steps)
        if self.stepper == "moreau" and self.theta not in OFFERED_THETAS:
            return self._not_offered(known, steps, rate, step)
        theta = self.theta if self.stepper == "moreau" else None
        method = March(stepper=self.stepper, theta=theta, steps=steps, periods=LONGEST_MARCH)
        held = step * quickest_when_held(known.scene, known.law) if math.isfinite(self._held) else 0.0
        return _answered(method, known, 1e-6, MapPoint(at, rate, step, "", "", 0.0, 0.0, held))

    def _not_offered(self, known: KnownState, steps: int, rate: float, step: float) -> MapPoint:
        pace = Resolution(steps=steps, theta=self.theta, enough=1e-9, most=LONGEST_MARCH)
        with np.errstate(all="ignore"):  # beyond its limit it grows without bound
            run = MarchRun(known.scene, known.law, "moreau").run(pace)
        error = abs(run.mean.real - known.mean)
        return MapPoint(float(steps), rate, step, "refused", "march offers theta 0.5 and 1", error, math.nan)


@dataclass(frozen=True)
class MappedSmoothing(MappedSolver):
    """March on smoothed friction, whose steps adapt to the tolerance; its error is that against friction as it is."""

    def limit(self, problem: StabilityProblem) -> StepLimit:
        """By theory, and of one step."""
        return StepLimit(predicted_limit("dop853"), stepper_limit("smoothed", 0.5, problem.memory))

    def point(self, problem: StabilityProblem, rate: float, at: float) -> MapPoint:
        """At a tolerance; the step is the mean one of the run that was asked for."""
        known = known_state(problem.name, rate)
        march = MarchRun(known.scene, known.law, "smoothed")
        plan = Plan("smoothed", 0.5, 8, None, width_at(rate), "tanh", 100_000)
        run = march_mean(march, plan, at).runs[-1]
        step = run.laps * march.lap / run.steps
        method = March(stepper="smoothed", width=width_at(rate))
        return _answered(method, known, at, MapPoint(at, rate, step, "", "", 0.0, 0.0))


def _answered(method: March, known: KnownState, tolerance: float, point: MapPoint) -> MapPoint:
    """A point with what the method answers at this tolerance."""
    found = solve_points(method, [known.scene], known.law, tolerance)
    error, stated = abs(float(found.means[0]) - known.mean), float(found.errors[0]) + known.error
    return point._replace(status=found.status[0], reason=found.reason[0], error=error, stated=stated)


_ALL: tuple[MappedSolver, ...] = (
    MappedStepper("rk4", ("bristle", "plane"), MARCHED, "rk4"),
    *(
        MappedStepper(f"moreau_{theta:g}", ("plane",), MARCHED, "moreau", theta)
        for theta in (0.25, 0.5, 0.75, 1.0)
    ),
    MappedSmoothing("smoothed", ("smoothing",), CREPT),
    MappedStepper("exponential", ("bristle",), MARCHED, "exponential"),
    MappedStepper("sdirk2", ("bristle",), MARCHED, "sdirk2"),
)
MAPPED_STEPPERS = {stepper.name: stepper for stepper in _ALL}
"""By name, in the order of tables and pictures."""
