"""Steppers of march and peers on the grid of a stability map: what each point comes to, and how far off that is."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, partial
from typing import Any, NamedTuple

import numpy as np

from frictionlab.bench.peers.heyoka_taylor import Heyoka
from frictionlab.bench.peers.one_period import SOLVE_IVP_METHODS, by_heyoka, by_scipy, equations_of
from frictionlab.bench.solve import solve_points
from frictionlab.bench.stability_problems import MU, PROBLEMS, StabilityProblem, width_at
from frictionlab.bench.step_limits import peer_limit, predicted_limit, stepper_limit
from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.march.judge import Plan, Runs
from frictionlab.methods.march.laps import MarchState
from frictionlab.methods.march.method import March
from frictionlab.methods.march.run import MarchRun
from frictionlab.methods.march.steppers import STEPPERS, Resolution, StepperName, quickest_when_held
from frictionlab.methods.shooting.method import Shooting
from frictionlab.scene.scene import Scene

WRONG = 0.01 * MU
"""A true error above this is wrong, whatever was stated or asked."""
TIMES_ASKED = 10.0
"""A peer, which states no error, may be off by so many times the tolerance that it was asked for."""
REGIONS = ("right", "wrong_and_said", "wrong_and_silent")
BEST_TOLERANCE = 1e-12
SETTLED_LAPS = 400
FINE_STEPS = {"bristle": 65_536, "smoothing": 4096, "plane": 4096}
"""Per period, of the run that gives the state; more where slip reverses, which steps meet with order two."""
LONGEST_MARCH = 200
"""Periods that a motion is waited for to repeat: where it is right, it does so in twenty, but for rounding."""
OFFERED_THETAS = 0.5, 1.0
MARCHED = "a mass by march until its motion repeats, for 200 periods at most"
CREPT = "the creep of a mass that would stick, by march until it repeats, at several widths"
ONE_PERIOD = "one period, from a state of the periodic motion"


class MapPoint(NamedTuple):
    """Point of a map, a setting at a rate: the step taken (a usual one), the true error, that stated or allowed.

    held: the step times the frequency of the mass held by its bristles, 0 where that limits nothing.
    """

    value: float
    rate: float
    step: float
    status: str
    error: float
    stated: float
    reason: str
    held: float = 0.0

    @property
    def region(self) -> str:
        """Return one of ``REGIONS``: right, and where not, whether anything tells."""
        if self.status != "ok":
            return "wrong_and_said"
        if not self.error <= self.stated:
            return "wrong_and_silent"
        return "right" if self.error <= WRONG else "wrong_and_said"


@dataclass(frozen=True)
class MappedSolver:
    """A stepper or peer on the grid; problems: those it can take, integrated: what each point integrates.

    predicted, measured: the largest step times rate, the latter by the memory of a law; held: the largest step times
    frequency of a mass held by its bristles; infinite for none. point: what it comes to at a rate and a setting.
    """

    name: str
    problems: tuple[str, ...]
    integrated: str
    setting: str
    predicted: float
    measured: Callable[[str], float]
    point: Callable[[StabilityProblem, float, float], MapPoint]
    held: float = math.inf

    def missing(self) -> str | None:
        """Return how to install it where it is not there, which only heyoka may be."""
        return Heyoka().missing() if self.name == "heyoka" else None


class KnownState(NamedTuple):
    """A scene at a rate with its steady state: mean friction and its error, largest slip, where a period begins."""

    scene: Scene
    law: FrictionLaw
    mean: float
    error: float
    most_slip: float
    state: MarchState


@cache
def known_state(problem: str, rate: float, smoothed: bool = False) -> KnownState:
    """By shooting, the state at the start of a period by many small steps; smoothed: of friction smoothed instead."""
    scene, law = PROBLEMS[problem].at(rate)
    ready = law.under_load(scene.normal_load or 1.0)
    if smoothed:
        pace = Resolution(width=width_at(rate), accuracy=1e-12, enough=1e-10, most=SETTLED_LAPS)
        run = MarchRun(scene, ready, "smoothed").run(pace)
        return KnownState(scene, ready, run.mean.real, 1e-9, run.met, run.place)
    found = solve_points(Shooting(), [scene], law, BEST_TOLERANCE).iloc[0]
    steps = max(FINE_STEPS[problem], int(8.0 * rate))
    stepper: StepperName = "moreau" if problem == "smoothing" else "rk4"
    run = MarchRun(scene, ready, stepper).run(Resolution(steps=steps, enough=1e-12, most=SETTLED_LAPS))
    return KnownState(scene, ready, float(found["mean"]), float(found["error"]), run.met, run.place)


def local_rate(problem: StabilityProblem, known: KnownState, rate: float) -> float:
    """Return the rate at the largest slip that is really met, for bristles; else as it was asked for."""
    law: Any = known.law
    return float(law.largest_rate(known.most_slip)) if problem.name == "bristle" else rate


def _stepper(name: str, problems: tuple[str, ...], stepper: StepperName, theta: float = 0.5) -> MappedSolver:
    """A stepper of march at fixed steps."""
    facts = STEPPERS[stepper]
    bound = math.inf if facts.limited_by_rates else facts.held

    def point(problem: StabilityProblem, asked: float, at: float) -> MapPoint:
        known, steps = known_state(problem.name, asked), round(at)
        rate, step = local_rate(problem, known, asked), 2.0 * math.pi / (known.scene.frequency * steps)
        if stepper == "moreau" and theta not in OFFERED_THETAS:
            return MapPoint(at, rate, step, "refused", _off_at(known, steps, theta), math.nan, NOT_OFFERED)
        own = theta if stepper == "moreau" else None
        method = March(stepper=stepper, theta=own, steps=steps, periods=LONGEST_MARCH)
        held = step * quickest_when_held(known.scene, known.law) if math.isfinite(bound) else 0.0
        return MapPoint(at, rate, step, *_answered(method, known, 1e-6), held)

    predicted, measured = predicted_limit(stepper, theta), partial(stepper_limit, stepper, theta)
    return MappedSolver(name, problems, MARCHED, "steps", predicted, measured, point, bound)


NOT_OFFERED = "march offers theta 0.5 and 1"


def _off_at(known: KnownState, steps: int, theta: float) -> float:
    """Return the error of a theta that march does not offer."""
    pace = Resolution(steps=steps, theta=theta, enough=1e-9, most=LONGEST_MARCH)
    with np.errstate(all="ignore"):  # beyond its limit it grows without bound
        return abs(MarchRun(known.scene, known.law, "moreau").run(pace).mean.real - known.mean)


def _answered(method: March, known: KnownState, tolerance: float) -> tuple[str, float, float, str]:
    """Status, error, stated error and reason of the method's answer at this tolerance."""
    found = solve_points(method, [known.scene], known.law, tolerance).iloc[0]
    error, stated = abs(float(found["mean"]) - known.mean), float(found["error"]) + known.error
    return found["status"], error, stated, found["reason"]


def _smoothed(problem: StabilityProblem, rate: float, at: float) -> MapPoint:
    """March on smoothed friction at a tolerance, its error that against friction as it is.

    The step is the mean one of the run that was asked for.
    """
    known = known_state(problem.name, rate)
    march = MarchRun(known.scene, known.law, "smoothed")
    plan = Plan("smoothed", 0.5, None, width_at(rate), "tanh", 100_000)
    run = Runs(march, plan, at, known.mean).asked
    method = March(stepper="smoothed", width=width_at(rate))
    return MapPoint(at, rate, run.laps * march.lap / run.steps, *_answered(method, known, at))


def _peer(name: str, problems: tuple[str, ...]) -> MappedSolver:
    """A solver of solve_ivp, or heyoka: it states no error, so that ten times what was asked is allowed."""

    def point(problem: StabilityProblem, asked: float, at: float) -> MapPoint:
        width = width_at(asked) if problem.name == "smoothing" else None
        known = known_state(problem.name, asked, smoothed=width is not None)
        (x, v, z), rate = known.state, local_rate(problem, known, asked)
        bristle = known.law.memory_kind == "bristle"
        state = np.array([x.real, v.real, *([float(z[0].real)] if bristle else [x.imag, v.imag]), 0.0])
        allowed = TIMES_ASKED * at + known.error
        try:
            if name == "heyoka":
                mean, step = by_heyoka(known.scene, known.law, state, width, at)
            else:
                mean, step = by_scipy(name, equations_of(known.scene, known.law, width), state, at)
        except (ArithmeticError, ValueError) as problem:
            return MapPoint(at, rate, math.nan, "failed", math.nan, allowed, str(problem))
        return MapPoint(at, rate, step, "ok", abs(mean - known.mean), allowed, "")

    predicted = predicted_limit(name)
    measured = partial(peer_limit, name)
    return MappedSolver(name, problems, ONE_PERIOD, "tolerance", predicted, measured, point)


_LIMITS_OF_SMOOTHING = predicted_limit("dop853"), partial(stepper_limit, "smoothed", 0.5)
_STEPPERS = (
    _stepper("rk4", ("bristle", "plane"), "rk4"),
    *(_stepper(f"moreau_{theta:g}", ("plane",), "moreau", theta) for theta in (0.25, 0.5, 0.75, 1.0)),
    MappedSolver("smoothed", ("smoothing",), CREPT, "tolerance", *_LIMITS_OF_SMOOTHING, _smoothed),
    _stepper("sdirk2", ("bristle",), "sdirk2"),
)
MAPPED_STEPPERS = {stepper.name: stepper for stepper in _STEPPERS}
"""By name, in the order of tables and pictures."""
_PEERS = (
    *(_peer(name, ("bristle", "smoothing", "plane")) for name in SOLVE_IVP_METHODS),
    _peer("heyoka", ("smoothing", "plane")),  # whose series need friction without corners
)
MAPPED_PEERS = {peer.name: peer for peer in _PEERS}
"""By name, in the order of tables and pictures."""
