"""Time stepping to the steady state: the road everybody takes, with what it costs and how far off it is."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from typing import Annotated, ClassVar, Literal

from pydantic import BeforeValidator, Field, ValidationInfo, field_validator

from frictionlab.laws.base import FrictionLaw, Positive, SlidingLaw
from frictionlab.laws.memory import BristleLaw, MemoryLaw
from frictionlab.methods.base import Answers, Method, Status
from frictionlab.methods.march import memory_stability
from frictionlab.methods.march.attractors import Reached, Search, first_reached, one_motion
from frictionlab.methods.march.error import (
    FEWEST_LAPS,
    WORK,
    Found,
    Plan,
    found,
    restless,
    steps_needed,
    why_not,
)
from frictionlab.methods.march.laps import RESTING, STALLED, TOO_FAST, TOO_STIFF
from frictionlab.methods.march.prescribed import solve_sampled
from frictionlab.methods.march.prescribed_bristle import solve_rubbed
from frictionlab.methods.march.rows import Row, answers_of
from frictionlab.methods.march.run import LONGEST_PERIOD, MarchResult, MarchRun
from frictionlab.methods.march.stability import fewest_steps, friction_falls
from frictionlab.methods.periodic.problem import along_the_belt
from frictionlab.methods.refusals import suggest_shooting
from frictionlab.methods.shooting.attractors import describe
from frictionlab.orbit.read import read_columns
from frictionlab.orbit.record import Orbit
from frictionlab.scene.scene import Scene
from frictionlab.theory.rest import resting_range, stays_at_rest
from frictionlab.theory.uniqueness import is_convergent


def _whole(given: object) -> object:
    if isinstance(given, bool) or not isinstance(given, int | float) or given != int(given):
        raise ValueError(f"must be a whole number, not {given!r}")
    return int(given)


def _half_or_one(given: object) -> object:
    if isinstance(given, bool) or given not in (0.5, 1):
        raise ValueError(f"must be 0.5 or 1, not {given!r}")
    return 1.0 if given == 1 else 0.5


Theta = Annotated[float, BeforeValidator(_half_or_one)]
Count = Annotated[int, BeforeValidator(_whole), Field(ge=4, le=100_000_000)]

OWN_KEYS = {
    "moreau": ("theta", "steps"),
    "rk4": ("steps",),
    "smoothed": ("width", "smoothing"),
    "exponential": ("steps",),
    "sdirk2": ("steps",),
}
FOR_SLIDING = "moreau", "rk4", "smoothed"
FOR_BRISTLES = "exponential", "rk4", "sdirk2"
FOR_MEMORY = ("rk4",)
"""The steppers of each kind of law, the one taken where none is named first."""
ORDERS = {
    ("moreau", 0.5): 2,
    ("moreau", 1.0): 1,
    ("rk4", 0.5): 4,
    ("smoothed", 0.5): 8,
    ("exponential", 0.5): 2,
    ("sdirk2", 0.5): 2,
}
"""Of each stepper on smooth motion, by theta where it has one."""
READABLE = 4096
"""Most steps per period of the run that the columns besides the mean are read from."""
WATCHED = 300
"""Laps over which a motion that never repeats is averaged."""


class March(Method):
    """Time stepping, period by period, until the motion repeats: no events, no shooting.

    stepper: of laws without memory moreau (default: Moreau-Jean, friction projected on its disk), rk4 (Runge-Kutta of
    order 4 on the jump itself, blind to it) or smoothed (DOP853 with step control on friction smoothed at rest); of
    laws with bristles exponential (default: bristles carried exactly along the slip, of order 2, steps limited by the
    mass held by its bristles alone), rk4 (steps limited by stiffness*speed/friction as well) or sdirk2 (L-stable, of
    order 2, no limit); of laws with several memories or scalars rk4 (steps limited by their largest rate).
    theta [-]: of moreau, 0.5 (default) or 1.
    steps [-], >= 4: of all but smoothed, per period of the drive, per 2 pi where nothing drives. The mean is that of
    so many steps, its error told by two and four times as many. Left out, steps are doubled until the error is
    below the tolerance or a point has cost 16 million, and the mean extrapolated where the order can be seen.
    width [scene velocity], > 0: of smoothed, 0.01 where left out; the mean is that of this width, its error tells
    the bias by twice, half and a quarter of the width.
    smoothing: of smoothed, tanh (default), square_root or arctan.
    periods [-], >= 4: most periods to wait for the motion to repeat, 100000.

    The motion starts from scene.initial, else on the friction-free orbit, undriven at rest on the belt. Where no
    theorem makes the steady state unique, starts far from each other must reach the same.

    Sources: moreau: Moreau (1988), Jean (1999); rk4: Kutta (1901); smoothed: Hairer, Nørsett & Wanner (1993);
    exponential: Strang (1968); sdirk2: Alexander (1977).
    """

    name: ClassVar[str] = "march"

    stepper: Literal["moreau", "rk4", "smoothed", "exponential", "sdirk2"] | None = None
    theta: Theta | None = None
    steps: Count | None = None
    width: Positive | None = None
    smoothing: Literal["tanh", "square_root", "arctan"] | None = None
    periods: Count = 100_000

    @field_validator("theta", "steps", "width", "smoothing", mode="before")
    @classmethod
    def _key_of_the_stepper(cls, given: object, info: ValidationInfo) -> object:
        """Key by key, not for all at once, so that it is told beside whatever else is wrong."""
        stepper = info.data.get("stepper", "") or "moreau"
        own = OWN_KEYS[stepper] if "stepper" in info.data else None
        if given is not None and own is not None and info.field_name not in own:
            known = ", ".join(own)
            raise ValueError(f"leave it out, stepper {stepper} knows {known} and periods")
        return given

    def refusal(self, scene: Scene, law: FrictionLaw) -> str | None:
        """A stepper of another kind of law; of a law without memory, a static coefficient above the sliding one, but
        for moreau along the belt; bristles too stiff for an explicit stepper.
        """
        if isinstance(law, BristleLaw):
            assert scene.normal_load is not None
            return self._bristle_refusal(scene, law.under_load(scene.normal_load))
        if isinstance(law, MemoryLaw):
            assert scene.normal_load is not None
            return self._refusal_with_memory(scene, law.under_load(scene.normal_load))
        if not isinstance(law, SlidingLaw):
            return "march needs a SlidingLaw, a BristleLaw or a MemoryLaw"
        if self._stepper(law) not in FOR_SLIDING:
            return f"stepper {self.stepper} needs a bristle law; use moreau, rk4 or smoothed"
        jumps = law.static_friction() > law.sliding_friction(0.0)
        if jumps and scene.degrees_of_freedom == 2 and not scene.load_along_belt_only:
            return suggest_shooting(
                "static friction above sliding friction: in the plane a time step may stop a mass that passes rest, "
                "and the error of that has no known bound",
                scene,
                law,
            )
        if self._stepper(law) != "moreau" and jumps:
            return (
                f"stepper {self.stepper} has no stick, and static friction above sliding friction needs it; "
                f"use stepper moreau"
            )
        return None

    def _bristle_refusal(self, scene: Scene, law: BristleLaw) -> str | None:
        stepper = self._stepper(law)
        if stepper not in FOR_BRISTLES:
            return f"stepper {stepper} does not support friction with memory; use exponential, rk4 or sdirk2"
        if self.theta is not None:
            return (
                "theta is a key of stepper moreau, which does not support friction with memory; leave it out"
            )
        planar = law.planar == "vectorial" and not along_the_belt(scene, law)
        if planar and law.no_vector_form():
            return law.no_vector_form()
        if stepper == "rk4" and math.isinf(law.largest_rate(1.0)):
            return "stepper rk4 needs a bound on the decay rate of bristles, and this law has none; use exponential"
        if stepper == "sdirk2" and scene.degrees_of_freedom == 0:
            return "stepper sdirk2 is not needed under a prescribed slip; use exponential, for any stiffness"
        if stepper == "sdirk2" and math.isfinite(law.yield_deflection()):
            return (
                "stepper sdirk2 needs continuous rates, and those of this law jump at yield; use exponential"
            )
        return self._too_few(fewest_steps(scene, law, stepper), law, stepper)

    def _refusal_with_memory(self, scene: Scene, law: MemoryLaw) -> str | None:
        if self._stepper(law) not in FOR_MEMORY:
            return f"stepper {self.stepper} does not support laws with several memories or scalars; use rk4"
        if self.theta is not None:
            return (
                "theta is a key of stepper moreau, which does not support friction with memory; leave it out"
            )
        if law.remembers_stick():
            return "stepper rk4 does not remember which deflections stick; use shooting"
        if scene.degrees_of_freedom == 0:
            return "for a law with several memories or scalars march needs a driven mass; use shooting"
        if scene.undriven:
            return "for a law with several memories or scalars march needs a driven mass: give a drive"
        if math.isinf(law.largest_rate(1.0)):
            return "stepper rk4 needs a bound on the decay rate of the memory, and this law has none; use shooting"
        return self._too_few(memory_stability.fewest_steps(scene, law), law, "rk4")

    def _too_few(self, fewest: int, law: FrictionLaw, stepper: str) -> str | None:
        """Why so many steps cannot be taken, where this many are needed."""
        if self.steps is not None and self.steps < fewest:
            return _unstable(self.steps, fewest, law, stepper)
        if self.steps is None and 3 * FEWEST_LAPS * fewest > WORK:
            return (
                f"stepper {stepper} is unstable on {_stiff(law)} below about {fewest:,} steps per period, too "
                f"many to refine with {WORK:,} steps in all; give steps, or use {_others(law, 'exponential')}"
            )
        return None

    def _stepper(self, law: FrictionLaw) -> str:
        if isinstance(law, MemoryLaw):
            return self.stepper or FOR_MEMORY[0]
        return self.stepper or (FOR_BRISTLES if isinstance(law, BristleLaw) else FOR_SLIDING)[0]

    def cost(self, scene: Scene, law: FrictionLaw, tolerance: float) -> float:
        """Some twenty periods of 50 ns steps, errors falling as one over their number; at most what WORK takes."""
        if self.stepper == "smoothed":
            return 0.05
        if isinstance(law, BristleLaw):
            assert scene.normal_load is not None
            fewest = fewest_steps(scene, law.under_load(scene.normal_load), self._stepper(law))
            return 1e-7 * min(30.0 * max(4.0 * (self.steps or 4096), 2.0 * fewest), WORK)
        if isinstance(law, MemoryLaw):
            assert scene.normal_load is not None
            fewest = memory_stability.fewest_steps(scene, law.under_load(scene.normal_load))
            return 3e-7 * min(30.0 * max(4.0 * (self.steps or 4096), 2.0 * fewest), WORK)
        steps = 4.0 * self.steps if self.steps else 2.0 * law.sliding_friction(1.0) / tolerance
        return 5e-8 * min(30.0 * steps, WORK)

    def solve(self, scenes: Sequence[Scene], law: FrictionLaw, tolerance: float) -> Answers:
        """Answer each scene by itself, from its own start."""
        assert scenes[0].normal_load is not None
        law = law.under_load(scenes[0].normal_load)
        plan = self._plan(law)
        if scenes[0].degrees_of_freedom == 0:
            if isinstance(law, BristleLaw):
                return solve_rubbed(scenes, law, tolerance, plan)
            assert isinstance(law, SlidingLaw)
            return solve_sampled(scenes, law, tolerance, plan)
        points = [_Point(scene, law, tolerance, plan) for scene in scenes]
        return answers_of(points)

    def _plan(self, law: FrictionLaw) -> Plan:
        theta, stepper = self.theta or 0.5, self._stepper(law)
        return Plan(
            stepper=stepper,
            theta=theta,
            order=ORDERS[stepper, theta],
            steps=self.steps,
            width=self.width or 0.01,
            smoothing=self.smoothing or "tanh",
            periods=self.periods,
        )


def _unstable(steps: int, fewest: int, law: FrictionLaw, stepper: str) -> str:
    """Why an explicit stepper is unstable with so many steps, and how many are enough."""
    return (
        f"stepper {stepper} is unstable on {_stiff(law)} with {steps:,} steps per period: about {fewest:,} "
        f"are enough; or use {_others(law, stepper)}"
    )


def _stiff(law: FrictionLaw) -> str:
    return "memory this fast" if isinstance(law, MemoryLaw) else "bristles this stiff"


def _others(law: FrictionLaw, stepper: str) -> str:
    if isinstance(law, MemoryLaw):
        return "method shooting"
    return "stepper exponential or sdirk2" if stepper == "rk4" else "stepper sdirk2"


class _Point:
    """One scene, marched, and its row."""

    def __init__(self, scene: Scene, law: FrictionLaw, tolerance: float, plan: Plan) -> None:
        self.scene, self.law, self.plan = scene, law, plan
        self.walker = MarchRun(scene, law, plan.stepper)
        self.found = Row()
        self.status: Status = "failed"
        self.reason, self.model = "", ""
        self.orbit: Callable[[], Orbit | None] = nowhere
        if self._held() and scene.initial is None and not scene.undriven:
            assert isinstance(law, SlidingLaw)
            self._leave_open(resting_range(scene, law))
        else:
            self._judge(found(self.walker, plan, tolerance), tolerance)
        self.seconds = self.walker.seconds

    def _held(self) -> bool:
        """Whether friction without memory can hold the mass on a belt at rest, wherever it stops."""
        return isinstance(self.law, SlidingLaw) and stays_at_rest(self.scene, self.law)

    def _leave_open(self, highest: float) -> None:
        self._range(-highest, highest)
        self.reason = (
            "the belt is at rest and static friction balances the loads: the mass may rest anywhere in a range; "
            "give scene.initial to choose a start"
        )

    def _range(self, low: float, high: float) -> None:
        self.status = "not_unique"
        self.found = Row(low=low, high=high)

    def _judge(self, answer: Found, tolerance: float) -> None:
        last = answer.runs[-1]
        self.model = f"march, {self.plan.stepper}{self._theta()}: {answer.how or 'no steady state'}"
        if last.verdict == TOO_FAST:
            self.status = "refused"
            fewest = math.ceil(steps_needed(self.walker, last))
            self.reason = _unstable(last.pace.steps, fewest, self.law, self.plan.stepper)
            return
        if last.verdict == TOO_STIFF:
            self.status = "refused"
            would_do = f"about {steps_needed(self.walker, last):.2g} are enough; or use method shooting"
            self.reason = f"the motion {why_not(last)}: {would_do}"
            return
        if not last.settled:
            self.reason = f"the motion {why_not(last)}"
            return
        readable = self._readable(answer.runs)
        reached, problem = self._reached(answer, readable)
        unique = not problem and one_motion(reached)
        if reached[0].period == 1 and (unique or self.scene.initial is not None):
            told_apart = (
                reached[0].high - reached[0].low
            )  # which lap's mean is meant makes so much of a difference
            self._accept(replace(answer, error=answer.error + told_apart), readable, tolerance)
        elif problem:
            self.reason = f"{describe(reached, 6)}; {problem}"
        else:
            self._leave_range(reached)
        if self.status == "ok" and not unique:
            self._remark(
                f"reached from scene.initial; {'; '.join(filter(None, (describe(reached, 6), problem)))}"
            )

    def _reached(self, answer: Found, readable: MarchResult) -> tuple[list[Reached], str]:
        """Where the starts lead; and why one leads nowhere, or ''."""
        if restless(answer.runs, self.walker):
            seen = self.walker.watch(answer.runs[-1], WATCHED)
            first = Reached(0, math.nan, seen.low, seen.high, seen.laps)
        else:
            first = first_reached(self.walker, answer)
        if not self._has_rivals():
            return [first], ""
        return Search(self.walker, answer, first, readable).reached()

    def _has_rivals(self) -> bool:
        """Whether another start may lead elsewhere, in a row that is not about one start alone."""
        if self.scene.undriven or self._held():
            return False
        if isinstance(self.law, SlidingLaw):
            return not is_convergent(self.scene, self.law)
        if isinstance(self.law, MemoryLaw):
            return self.scene.belt_speed == 0.0 or not self.walker.has_corners or friction_falls(self.law)
        assert isinstance(self.law, BristleLaw)
        at_rest = self.scene.belt_speed == 0.0 and self.law.elastic_deflection() > 0.0
        return at_rest or friction_falls(self.law)

    def _falls(self) -> bool:
        return isinstance(self.law, SlidingLaw) or friction_falls(self.law)

    def _leave_range(self, reached: Sequence[Reached]) -> None:
        self._range(min(one.low for one in reached), max(one.high for one in reached))
        why = "friction falls with speed: " if self._has_rivals() and self._falls() else ""
        if not why and reached[0].period == 0:
            why = "the motion is not periodic at any step: "
        self.reason = why + describe(reached, 6)
        if one_motion(reached):
            self.found = replace(self.found, period=float(reached[0].period))

    def _lost_in_chatter(self, answer: Found) -> float:
        """All that the mean may be off by, where the belt is slower than the jumps that rk4 makes about rest."""
        law, load = self.law, self.scene.mass().normal_load
        if not isinstance(law, SlidingLaw):
            return 0.0
        step = 2.0 * math.pi / self.scene.frequency / answer.runs[-1].pace.steps
        chatters = (
            self.plan.stepper == "rk4" and abs(self.scene.belt_speed) < load * law.static_friction() * step
        )
        return law.static_friction() + abs(answer.mean.real) if chatters else 0.0

    def _remark(self, said: str) -> None:
        self.reason = "; ".join(filter(None, (self.reason, said)))

    def _theta(self) -> str:
        return f" with theta {self.plan.theta:g}" if self.plan.stepper == "moreau" else ""

    def _accept(self, answer: Found, readable: MarchResult, tolerance: float) -> None:
        last = answer.runs[-1]
        self.status = "ok"
        self.orbit = partial(self._orbit, readable, last.stride if self.scene.undriven else 1)
        error = max(answer.error, self._lost_in_chatter(answer))
        self.found = Row(answer.mean, error, self._period(answer, last))
        if last.verdict == STALLED:
            self._remark(
                f"rounding to time steps makes the motion aperiodic: averaged over {self.walker.window} periods"
            )
        if not (self.walker.converges or self._has_rivals() or self._moves_on()):
            start = "scene.initial" if self.scene.initial else "the default start"
            self._remark(f"the state reached from {start}; no other start was tried")
        if not self.found.error <= tolerance:
            self._remark(f"the error is above the tolerance {tolerance:.1e}")

    def _moves_on(self) -> bool:
        """Whether bristles that a moving belt drags along forget where the mass started."""
        return (
            not isinstance(self.law, SlidingLaw) and not self.scene.undriven and self.scene.belt_speed != 0.0
        )

    def _period(self, answer: Found, last: MarchResult) -> float:
        if not self.scene.undriven:
            return 1.0
        swing = read_columns([self.scene], lambda i: self.orbit())["velocity_amplitude"][0]
        still = swing <= 2.0 * last.pace.enough
        return math.nan if last.verdict == RESTING or still else answer.period / (2.0 * math.pi)

    def _readable(self, runs: Sequence[MarchResult]) -> MarchResult:
        """The run of which an orbit is kept: the one asked for, else the finest that is not too long to keep."""
        fine = [run for run in runs if run.pace.steps <= READABLE] or [runs[0]]
        return runs[0] if self.plan.steps is not None else fine[-1]

    def _orbit(self, run: MarchResult, own: int) -> Orbit:
        """The orbit of a run whose response takes ``own`` laps; more where steps keep it from repeating so soon."""
        steps = max(1, run.steps // run.laps)
        laps = max(1, min(LONGEST_PERIOD, LONGEST_PERIOD * READABLE // steps))
        laps = laps if run.verdict == STALLED else run.stride
        periods = max(1, laps // own)
        orbit = replace(self.walker.track(run, periods * own), periods=periods)
        return orbit if self.plan.stepper == "moreau" else replace(orbit, stick=None)


def nowhere() -> None:
    """The orbit of a point without one."""
