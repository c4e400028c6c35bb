"""Mean friction by time stepping, and its distance to the full answer.

Steps do not see what happens inside them, nor a smoothed law what it smooths: no error of a march can be told
from its own runs alone. So its error is the distance to the answer of ``exact`` or ``shooting``, and where these
have none, march has none either.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import NamedTuple

from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import PROVED, Answers, Ledger, Status
from frictionlab.methods.march.laps import CLOSED, LATE, RESTING, STALLED, TIRED, TOO_FAST, TOO_STIFF
from frictionlab.methods.march.refusal import FEWEST_LAPS, WORK, unstable
from frictionlab.methods.march.run import LONGEST_PERIOD, MarchResult, MarchRun
from frictionlab.methods.march.steppers import MARGIN, Resolution, StepperName
from frictionlab.motion.orbit.read import read_columns
from frictionlab.motion.orbit.record import Orbit
from frictionlab.motion.orbit.recorder import orbit_at_one_place
from frictionlab.scene.scene import Scene
from frictionlab.theory.rest import size_of_friction

FIRST_STEPS = 64
"""Steps per period to begin with, where ``steps`` is left out."""
MOST_WORK, MOST_ADAPTIVE = 500_000_000, 10_000_000
"""Steps of one run, where they are given, and where they are adaptive."""
READABLE = 4096
"""Most steps per period of the run that the columns besides the mean are read from."""
ROUNDING = 1e-13
"""Rounding error of the mean coefficient from summing the impulses of a period, and a thousandth of it per step."""
APERIODIC = "rounding to time steps makes the motion aperiodic: averaged over {:.0f} periods"
NO_FULL_ANSWER = "how far off time steps are is not known, for no other method tells the mean: "


class Plan(NamedTuple):
    """Parameters of a study for time stepping, defaults filled in."""

    stepper: StepperName
    theta: float
    steps: int | None
    width: float
    smoothing: str
    periods: int


class FullAnswer(NamedTuple):
    """Answer of ``exact`` or ``shooting`` to a scene; NaN where there is none.

    reason: why there is none.
    """

    status: Status
    mean: float
    error: float
    low: float
    high: float
    window: float
    period: float
    unique: str
    reason: str

    @classmethod
    def of(cls, answers: Answers, i: int) -> FullAnswer:
        """Return the i-th of several answers."""
        ranges = answers.mean_low, answers.mean_high, answers.window
        numbers = (answers.mean.real, answers.error, *ranges, answers.period)
        mean, error, *others = (math.nan if each is None else float(each[i]) for each in numbers)
        low, high, window, period = others
        unique = answers.unique[i] if answers.unique else ""
        return cls(answers.status[i], mean, error, low, high, window, period, unique, answers.reason[i])


# --- runs ---------------------------------------------------------------------------------------------------------


class Runs:
    """Runs of one motion, each from where the last one ended, until one is near enough to the full answer.

    known: mean of the full answer.
    """

    def __init__(self, march: MarchRun, plan: Plan, tolerance: float, known: float) -> None:
        self.march, self.plan, self.tolerance, self.known = march, plan, tolerance, known
        self.all: list[MarchResult] = []
        if march.facts.adaptive:
            self._by_width()
        elif plan.steps is not None:
            self._run(self._steps(plan.steps, MOST_WORK))
            self.asked = self.all[0]
        else:
            self._by_halving()

    @property
    def apart(self) -> float:
        """Distance of the mean to the full answer."""
        return abs(self.asked.mean.real - self.known) + ROUNDING * (1.0 + 1e-3 * self.asked.pace.steps)

    @property
    def readable(self) -> MarchResult:
        """Run of which an orbit is kept: the one asked for, else the finest that is not too long to keep."""
        if self.plan.steps is not None:
            return self.asked
        fine = [run for run in self.all if run.settled and run.pace.steps <= READABLE]
        return fine[-1] if fine else self.asked

    @property
    def _changed(self) -> float:
        return abs(self.all[-1].mean - self.all[-2].mean)

    def _run(self, pace: Resolution) -> None:
        before = self.all[-1] if self.all else None
        self.all.append(self.march.run(pace, before.place if before and self.march.forgets else None))

    def _steps(self, steps: int, work: int) -> Resolution:
        before = self.all[-1] if self.all else None
        share = max(0.05 * self.tolerance, 2e-3 * self.march.law.sliding_friction(1.0) / steps)
        return Resolution(
            steps=steps,
            refined=steps // self.all[0].pace.steps if before else 1,
            theta=self.plan.theta,
            enough=0.25 * share * self.march.mass.normal_load,
            most=self.plan.periods,
            work=max(work, FEWEST_LAPS * steps),
            rate=before.rate if before is not None and before.verdict == CLOSED else 0.0,
        )

    def _by_halving(self) -> None:
        """Halve the step until the mean is near enough or the work is done."""
        # what the motion asks for, and what the stepper needs not to explode
        steps, work = max(FIRST_STEPS * self._slowness(), self.march.fewest()), 0
        while True:
            self._run(self._steps(steps, WORK - work))
            run = self.all[-1]
            work += run.steps
            if not run.settled:
                more = steps_needed(self.march, run)
                if 3 * FEWEST_LAPS * more > WORK - work:
                    break
                self.all, steps = [], math.ceil(more)
                continue
            self.asked = run
            # one mean alone may be near by chance
            near = self.apart <= self.tolerance and len(self.all) > 1 and self._changed <= self.tolerance
            if near or work + 2 * run.steps * min(1.0, 12 / run.laps) > WORK:
                break
            steps *= 2
        settled = [each for each in self.all if each.settled]
        self.asked = settled[-1] if settled and self.all[-1].verdict != TOO_STIFF else self.all[-1]

    def _slowness(self) -> int:
        """Return by how much a slow drive needs more steps a period, for the body's own motion."""
        mass = self.march.mass
        quickest = max(1.0, mass.damping, mass.varying.quickest if mass.varying else 0.0)
        if not self.march.straight:
            quickest = max(quickest, math.sqrt(mass.transverse_stiffness), mass.transverse_damping)
        return max(1, math.ceil(quickest / mass.frequency - 1e-9))

    def _by_width(self) -> None:
        """Run friction smoothed over this width."""
        plan, mass = self.plan, self.march.mass
        friction = self.march.law.sliding_friction(plan.width) or size_of_friction(
            self.march.scene, self.march.law
        )
        load = mass.normal_load * friction
        accuracy = max(min(1e-5 * self.tolerance * load, 1e-3 * plan.width, 1e-6 * load), 1e-13 * load)
        pace = Resolution(
            width=plan.width,
            smoothing=plan.smoothing,
            accuracy=accuracy,
            enough=1e3 * accuracy,
            most=plan.periods,
            work=MOST_ADAPTIVE,
        )
        self._run(pace)
        self.asked = self.all[0]


def steps_needed(march: MarchRun, run: MarchResult) -> float:
    """Return the steps per period that are stable where those of a run were not; else infinity."""
    if run.verdict == TOO_FAST:
        return 1.5 * run.pace.steps * run.met / march.fastest(run.pace)
    return MARGIN * march.through_rest if run.verdict == TOO_STIFF else math.inf


def why_not(run: MarchResult) -> str:
    """Return why a run has no steady state, as the continuation of "the motion"."""
    if run.verdict == LATE:
        return (
            f"still changes by {run.drift:.1e} a period after {run.laps} periods (at most {run.pace.most}); "
            f"give more periods"
        )
    if run.verdict == TOO_FAST and math.isfinite(run.met):
        return f"slips faster, at {run.met:.3g}, than {run.pace.steps} steps per period are stable for"
    if run.verdict == TOO_STIFF:
        return f"comes to rest, where the law is too stiff for {run.pace.steps} explicit steps per period"
    if run.verdict == TIRED:
        return f"is not periodic within {run.steps:.1g} steps ({run.laps} periods); give fewer or wider ones"
    return f"is not finite after {run.laps} periods: it grows without bound, or never returns; give shorter steps"


# --- answers ------------------------------------------------------------------------------------------------------


class MarchedPoint:
    """Scene that is marched, and its answer, to be entered in a ledger."""

    def __init__(
        self, scene: Scene, law: FrictionLaw, tolerance: float, plan: Plan, full: FullAnswer
    ) -> None:
        self.scene, self.law, self.plan, self.full, self.tolerance = scene, law, plan, full, tolerance
        self.march = MarchRun(scene, law, plan.stepper)
        self.orbit: Callable[[], Orbit | None] = nowhere

    def enter(self, ledger: Ledger, i: int) -> None:
        """March the scene, and enter the answer."""
        full = self.full
        if full.status == "ok":
            self._judge(Runs(self.march, self.plan, self.tolerance, full.mean), ledger, i)
        elif full.status == "not_unique":
            ledger.leave_open(i, full.reason, full.low, full.high, full.window)
            ledger.unique[i] = full.unique
        else:
            ledger.fail(i, NO_FULL_ANSWER + full.reason, full.status)
        ledger.seconds[i] = self.march.seconds

    def _judge(self, runs: Runs, ledger: Ledger, i: int) -> None:
        run = runs.asked
        if not run.settled:
            ledger.fail(i, *self._why_not(run))
            return
        error = runs.apart + self.full.error
        # steps can keep a motion from repeating as soon as it would
        laps = self.full.period / self.march.periods if not self.scene.undriven else math.nan
        alike = run.high - run.low <= max(error, self.tolerance)
        own = round(laps) if math.isfinite(laps) else 1 if alike else run.stride
        self.orbit = partial(self._orbit, runs.readable, run.stride if self.scene.undriven else own)
        if self.scene.undriven and self._is_still(run):
            self.orbit, own = partial(self._at_one_place, run), 0
        repeats = own > 0 and (self.scene.undriven or math.isfinite(laps))
        period = run.period / (2.0 * math.pi) if self.scene.undriven else self.march.periods * own
        ledger.accept(i, run.mean, error, period if repeats else math.nan)
        ledger.window[i] = self.full.window
        ledger.unique[i] = self.full.unique if self.full.unique != PROVED else ""
        theta = f" with theta {self.plan.theta:g}" if "theta" in self.march.facts.keys else ""
        ledger.model[i] = f"march, {self.plan.stepper}{theta}: {self._pace(run)}"
        if run.verdict == STALLED and repeats:
            averaged = self.march.window * self.march.periods
            ledger.remark(i, APERIODIC.format(averaged))
        if not error <= self.tolerance:
            ledger.remark(i, f"the error is above the tolerance {self.tolerance:.1e}")
        ledger.remark(i, self.full.reason if ledger.unique[i] else "")

    def _pace(self, run: MarchResult) -> str:
        """Return the steps or the smoothing of a run in words."""
        if self.march.facts.adaptive:
            return f"{self.plan.smoothing} of width {self.plan.width:g}"
        return f"{run.pace.steps} steps per period"

    def _why_not(self, last: MarchResult) -> tuple[str, Status]:
        """Return why there is no steady state, and the status: refused where other steps would do, else failed."""
        reason = f"the motion {why_not(last)}"
        if last.verdict == TOO_FAST and math.isfinite(last.met):
            fewest = math.ceil(steps_needed(self.march, last))
            return unstable(last.pace.steps, fewest, self.law, self.plan.stepper), "refused"
        if last.verdict == TOO_STIFF:
            fewest_said = f"{steps_needed(self.march, last):.2g}"
            return f"{reason}: about {fewest_said} are enough; or use method shooting", "refused"
        return reason, "failed"

    def _is_still(self, run: MarchResult) -> bool:
        """Check that an undriven mass has come to slide steadily, or to rest."""
        swing = read_columns([self.scene], lambda i: self.orbit())["velocity_amplitude"][0]
        return run.verdict == RESTING or bool(swing <= 2.0 * run.pace.enough)

    def _at_one_place(self, run: MarchResult) -> Orbit:
        """Return the orbit of a mass that keeps its place, over a time of 2 pi."""
        orbit = orbit_at_one_place(run.place.x, run.mean, run.verdict == RESTING)
        return orbit if self.march.facts.sticks else replace(orbit, stick=None)

    def _orbit(self, run: MarchResult, own: int) -> Orbit:
        """Return the orbit of a run whose response takes ``own`` laps; of more if steps keep it from repeating."""
        steps = max(1, run.steps // run.laps)
        laps = max(1, min(LONGEST_PERIOD, LONGEST_PERIOD * READABLE // steps))
        laps = laps if run.verdict == STALLED else run.stride
        periods = max(1, laps // own)
        orbit = replace(self.march.track(run, periods * own), periods=periods)
        return orbit if self.march.facts.sticks else replace(orbit, stick=None)


def nowhere() -> None:
    """Return no orbit."""
