"""The steppers of march on the grid: what the method answers, and how far off that is."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from frictionlab.bench.solvers import solve_points
from frictionlab.bench.stability.grid import KnownState, known_state, local_rate, spaced, whole_steps
from frictionlab.bench.stability.limits import predicted_limit, stepper_limit
from frictionlab.bench.stability.problems import StabilityProblem, width_at
from frictionlab.bench.stability.record import MapPoint, StabilityMap, StepLimit
from frictionlab.methods.march.error import Plan, march_mean
from frictionlab.methods.march.method import March
from frictionlab.methods.march.run import MarchRun, Resolution
from frictionlab.methods.march.stability import quickest_when_held
from frictionlab.numerics.steppers import exponential

LONGEST_MARCH = 200
"""That a motion is waited for to repeat: where it is right, it does so in twenty, but for rounding."""
OFFERED_THETAS = 0.5, 1.0


@dataclass(frozen=True)
class MappedStepper:
    """A stepper of march at fixed steps."""

    name: str
    stepper: str
    theta: float = 0.5

    @property
    def integrated(self) -> str:
        """For the caption."""
        return "a mass by march until its motion repeats, for 200 periods at most"

    def refusal(self) -> str | None:
        """It is always there."""
        return None

    def problems(self) -> list[str]:
        """Those whose law it takes."""
        known = {"rk4": ["bristle", "plane"], "moreau": ["plane"]}
        return known.get(self.stepper, ["bristle"])

    def map_of(self, problem: StabilityProblem, n: int) -> StabilityMap:
        """n steps per period by n rates."""
        rates, steps = spaced(problem.rates, n), whole_steps(problem.steps, n)
        limit = StepLimit(
            predicted_limit(self.stepper, self.theta),
            stepper_limit(self.stepper, self.theta, problem.memory),
            held=exponential.DECAY if self.stepper == "exponential" else math.inf,
        )
        points = []
        for rate in rates:
            known = known_state(problem.name, rate)
            points += [self._point(known, count, local_rate(problem.name, known, rate)) for count in steps]
        return StabilityMap(problem, "steps", limit, [float(count) for count in steps], rates, points)

    def _point(self, known: KnownState, steps: int, rate: float) -> MapPoint:
        step = 2.0 * math.pi / (known.scene.frequency * steps)
        if self.stepper == "moreau" and self.theta not in OFFERED_THETAS:
            return self._not_offered(known, steps, rate, step)
        theta = self.theta if self.stepper == "moreau" else None
        method = March(stepper=self.stepper, theta=theta, steps=steps, periods=LONGEST_MARCH)
        found = solve_points(method, [known.scene], known.law, 1e-6)
        error = abs(float(found.means[0]) - known.mean)
        stated = float(found.errors[0]) + known.error
        held = step * quickest_when_held(known.scene, known.law) if self.stepper == "exponential" else 0.0
        return MapPoint(float(steps), rate, step, found.status[0], found.reason[0], error, stated, held)

    def _not_offered(self, known: KnownState, steps: int, rate: float, step: float) -> MapPoint:
        pace = Resolution(steps=steps, theta=self.theta, enough=1e-9, most=LONGEST_MARCH)
        with np.errstate(all="ignore"):  # beyond its limit it grows without bound
            run = MarchRun(known.scene, known.law, "moreau").run(pace)
        error = abs(run.mean.real - known.mean)
        return MapPoint(float(steps), rate, step, "refused", "march offers theta 0.5 and 1", error, math.nan)


@dataclass(frozen=True)
class MappedSmoothing:
    """March on smoothed friction, whose steps adapt to the tolerance; its error is that against friction as it is."""

    name: str = "smoothed"

    @property
    def integrated(self) -> str:
        """For the caption."""
        return "the creep of a mass that would stick, by march until it repeats, at several widths"

    def refusal(self) -> str | None:
        """It is always there."""
        return None

    def problems(self) -> list[str]:
        """The one whose rate is that of the smoothing."""
        return ["smoothing"]

    def map_of(self, problem: StabilityProblem, n: int) -> StabilityMap:
        """n tolerances by n rates."""
        rates, tolerances = spaced(problem.rates, n), spaced(problem.tolerances, n)
        limit = StepLimit(predicted_limit("dop853"), stepper_limit("smoothed", 0.5, problem.memory))
        points = [
            self._point(known_state(problem.name, rate), rate, tolerance)
            for rate in rates
            for tolerance in tolerances
        ]
        return StabilityMap(problem, "tolerance", limit, tolerances, rates, points)

    def _point(self, known: KnownState, rate: float, tolerance: float) -> MapPoint:
        method = March(stepper="smoothed", width=width_at(rate))
        found = solve_points(method, [known.scene], known.law, tolerance)
        error = abs(float(found.means[0]) - known.mean)
        stated = float(found.errors[0]) + known.error
        step = _usual_step(known, rate, tolerance)
        return MapPoint(tolerance, rate, step, found.status[0], found.reason[0], error, stated)


def _usual_step(known: KnownState, rate: float, tolerance: float) -> float:
    """The mean step of the run that was asked for."""
    march = MarchRun(known.scene, known.law, "smoothed")
    plan = Plan("smoothed", 0.5, 8, None, width_at(rate), "tanh", 100_000)
    run = march_mean(march, plan, tolerance).runs[-1]
    return run.laps * march.lap / run.steps


_ALL: tuple[MappedStepper | MappedSmoothing, ...] = (
    MappedStepper("rk4", "rk4"),
    *(MappedStepper(f"moreau_{theta:g}", "moreau", theta) for theta in (0.25, 0.5, 0.75, 1.0)),
    MappedSmoothing(),
    MappedStepper("exponential", "exponential"),
    MappedStepper("sdirk2", "sdirk2"),
)
MAPPED_STEPPERS = {stepper.name: stepper for stepper in _ALL}
"""By name, in the order of tables and pictures."""
