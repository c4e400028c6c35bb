"""How long a step may be: largest step times rate at which a perturbation does not grow, predicted and measured.

Measured by root finding on the factor that one step, taken by the stepper's own code, multiplies a perturbation with.

The steppers of march on the grid: what the method answers, and how far off that is.

Solvers of other libraries on the grid: one period from the known orbit at a tolerance, and how far off that is.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, partial
from typing import ClassVar, Literal

import numpy as np

from frictionlab.bench.measure import solve_points
from frictionlab.bench.peers.heyoka_taylor import Heyoka
from frictionlab.bench.peers.one_period import (
    SOLVE_IVP_METHODS,
    by_heyoka,
    by_scipy,
    equations_of,
    growth_by_scipy,
)
from frictionlab.bench.stability_grid import (
    TIMES_ASKED,
    KnownState,
    MappedSolver,
    MapPoint,
    StabilityProblem,
    StepLimit,
    known_state,
    local_rate,
    width_at,
)
from frictionlab.compile.interpret import interpreted
from frictionlab.laws.base import FrictionLaw
from frictionlab.laws.coulomb import Coulomb
from frictionlab.laws.dahl import Dahl
from frictionlab.methods.march.judge import Plan, Runs
from frictionlab.methods.march.laps import MarchState
from frictionlab.methods.march.method import March
from frictionlab.methods.march.run import MarchRun
from frictionlab.methods.march.steppers import STEPPERS, Resolution, StepperName, quickest_when_held
from frictionlab.motion.steppers import dop853, rk4
from frictionlab.scene.scene import Drive, Load, Scene, Transverse
from frictionlab.values.quantities import Floats

PREDICTED = {"rk4": rk4.DECAY, "dop853": 6.394, "RK23": 2.513, "RK45": 3.307, "DOP853": 6.394}
"""Real axis: where the stability polynomial of an explicit formula leaves the unit disk."""
CLOSE_ROOT = 1e-4
"""Relative width of the bracket that a measured limit is found to."""
LONGEST_STEP = 1e4
"""Times rate; a perturbation that has not grown by then grows at no step."""
MANY_STEPS = 400
"""That are looked at, between the shortest and the longest, for the first at which it grows."""
WEAK, QUICK = 1e-12, 1e4
"""A friction that moves no mass, and a rate beside which springs are slow."""


def predicted_limit(stepper: str, theta: float = 0.5) -> float:
    """By theory; infinite where no step is too long."""
    if stepper == "moreau":
        return 2.0 / (1.0 - 2.0 * theta) if theta < 0.5 else math.inf
    return PREDICTED.get(stepper, math.inf)


def measured_limit(growth: Callable[[float], float]) -> float:
    """The least step times rate from which on growth(step times rate) exceeds 1; infinite where it never does."""
    trials = np.geomspace(0.1, LONGEST_STEP, MANY_STEPS)
    above = next((i for i, z in enumerate(trials) if growth(float(z)) > 1.0 + 1e-9), None)
    if not above:
        return math.inf if above is None else 0.0
    low, high = float(trials[above - 1]), float(trials[above])
    while high - low > CLOSE_ROOT * high:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if growth(middle) > 1.0 else (middle, high)
    return 0.5 * (low + high)


@cache
def stepper_limit(stepper: StepperName, theta: float, memory: str) -> float:
    """The measured limit of a stepper of march, on bristles or on slip in the plane."""
    if stepper == "smoothed":
        return measured_limit(_growth_of_dop853)
    grows = _growth_of_bristles if memory == "bristle" else _growth_across
    return measured_limit(lambda z: grows(stepper, theta, z))


def _growth_of_bristles(stepper: StepperName, theta: float, z: float) -> float:
    """Of a deflection, under a slip that nothing changes: the difference of two steps."""
    scene = Scene(
        damping_ratio=0.0,
        normal_load=WEAK,
        belt_speed=QUICK,
        drive=Drive(amplitude=WEAK, frequency=2.0 * math.pi / z),
    )
    law = Dahl(mu=0.4, stiffness=0.4 / QUICK)
    ends = [
        _one_step(scene, law, stepper, theta, MarchState(0j, 0j, np.array([bent]))) for bent in (0j, 1.0 + 0j)
    ]
    return abs(complex(ends[1].z[0] - ends[0].z[0]))


def _growth_across(stepper: StepperName, theta: float, z: float) -> float:
    """Of a small velocity across the belt, while the spring balances friction along it."""
    small = 1e-6
    scene = Scene(
        damping_ratio=0.0,
        normal_load=QUICK / 0.4,
        belt_speed=1.0,
        drive=Drive(amplitude=0.0, frequency=2.0 * math.pi * QUICK / z),
        transverse=Transverse(natural_frequency=1e-3, damping_ratio=0.0, load=Load(amplitude=WEAK)),
    )
    end = _one_step(scene, Coulomb(mu=0.4), stepper, theta, MarchState(complex(QUICK), complex(0.0, small)))
    return abs(end.v.imag) / small


def _one_step(
    scene: Scene, law: FrictionLaw, stepper: StepperName, theta: float, start: MarchState
) -> MarchState:
    """A lap of one step."""
    return MarchRun(scene, law, stepper).run(Resolution(steps=1, most=1, theta=theta), start).place


def _decay(problem: None, stage: int, tau: float, x: float, v: float) -> tuple[float, float]:
    return -v, 0.0


def _growth_of_dop853(z: float) -> float:
    """Of a velocity that decays at the rate 1."""
    step = interpreted(dop853.stepper(_decay, dop853.unprepared))
    return abs(float(step(None, 0.0, dop853.State(0.0, 1.0, -1.0, 0.0), z).v))


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
        plan = Plan("smoothed", 0.5, None, width_at(rate), "tanh", 100_000)
        run = Runs(march, plan, at, known.mean).asked
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
    MappedStepper("sdirk2", ("bristle",), MARCHED, "sdirk2"),
)
MAPPED_STEPPERS = {stepper.name: stepper for stepper in _ALL}
"""By name, in the order of tables and pictures."""


ONE_PERIOD = "one period, from a state of the periodic motion"


@dataclass(frozen=True)
class MappedPeer(MappedSolver):
    """A solver of solve_ivp, or heyoka: it states no error, so that ten times what was asked is allowed."""

    def missing(self) -> str:
        """Only heyoka may be missing."""
        return Heyoka().missing() or "" if self.name == "heyoka" else ""

    def limit(self, problem: StabilityProblem) -> StepLimit:
        """By theory, and of one step."""
        return StepLimit(predicted_limit(self.name), peer_limit(self.name))

    def point(self, problem: StabilityProblem, rate: float, at: float) -> MapPoint:
        """At a tolerance."""
        width = width_at(rate) if problem.name == "smoothing" else None
        known = known_state(problem.name, rate, smoothed=width is not None)
        state = start_of_period(known)
        if self.name == "heyoka":
            found = by_heyoka(known.scene, known.law, state, width, at)
        else:
            equations = equations_of(known.scene, known.law, width)
            found = by_scipy(self.name, equations, state, at)
        status, error = "failed" if found.reason else "ok", abs(found.mean - known.mean)
        rate = local_rate(problem.name, known, rate)
        allowed = TIMES_ASKED * at + known.error
        return MapPoint(at, rate, found.step, status, found.reason, error, allowed)


def start_of_period(known: KnownState) -> Floats:
    """The state as the peers' equations of motion hold it, the friction integral last."""
    x, v, z = known.state
    if known.law.memory_kind == "bristle":
        return np.array([x.real, v.real, float(z[0].real), 0.0])
    return np.array([x.real, v.real, x.imag, v.imag, 0.0])


@cache
def peer_limit(name: str) -> float:
    """The measured limit of a peer's steps; LSODA changes its formula as it goes, heyoka its order and its steps."""
    return math.inf if name in ("LSODA", "heyoka") else measured_limit(partial(growth_by_scipy, name))


_ALL_PROBLEMS = ("bristle", "smoothing", "plane")
_ALL_PEERS = (
    *(MappedPeer(name, _ALL_PROBLEMS, ONE_PERIOD) for name in SOLVE_IVP_METHODS),
    MappedPeer("heyoka", ("smoothing", "plane"), ONE_PERIOD),  # whose series need friction without corners
)
MAPPED_PEERS = {peer.name: peer for peer in _ALL_PEERS}
"""By name, in the order of tables and pictures."""
