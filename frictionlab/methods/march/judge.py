"""Whether a march has settled, on what, and what of it is an answer: status, reason, mean and error of a point.

Time stepping from other starts, for scenes in which no theorem makes the steady state unique.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import STATISTICAL, Answers, Status
from frictionlab.methods.march.error import (
    WORK,
    MarchMean,
    Plan,
    crossing,
    march_mean,
    restless,
    steps_needed,
    why_not,
)
from frictionlab.methods.march.laps import CLOSED, RESTING, STALLED, TOO_FAST, TOO_STIFF
from frictionlab.methods.march.refusal import unstable
from frictionlab.methods.march.run import LONGEST_PERIOD, MarchResult, MarchRun
from frictionlab.methods.march.steppers import friction_falls
from frictionlab.methods.shooting.attractors import describe, starts
from frictionlab.methods.shooting.long_mean import (
    DRIVEN,
    FREE,
    SHARED,
    LongMean,
    long_mean,
    near_each_other,
    spread_of_one_mean,
)
from frictionlab.motion.orbit.read import read_columns
from frictionlab.motion.orbit.record import Orbit
from frictionlab.scene.scene import Scene
from frictionlab.theory.rest import friction_at_rest, is_convergent, resting_range, stays_at_rest

LAPS_AVERAGED = 512
"""Laps over which a motion that never repeats is averaged."""
NOISE = 1e-3
"""Spread of the means of a motion that does not repeat, over friction at rest, that passes for noise of the steps."""
SHUT = 1e-7
"""Distance from a closed orbit over normal load: chaotic motion stays near repelling cycles for a while."""


@dataclass(frozen=True)
class Arrival:
    """Where a start led: a motion that repeats after some laps (0: never), and its means over one of them.

    low, high: the smallest and the largest mean over one lap. followed: for how many laps. average: the mean over
    all of them, of a motion that never repeats.
    """

    period: int
    mean: float
    low: float
    high: float
    followed: int
    average: LongMean | None = None


@dataclass(frozen=True)
class OtherStarts:
    """The other starts of a scene, each marched once with the steps of a run that began at the first start.

    Both runs make the same errors, so what counts is whether they come to the same, within what those errors leave.
    """

    march: MarchRun
    mean: MarchMean
    first: Arrival
    like: MarchResult

    def arrivals(self) -> tuple[list[Arrival], str]:
        """Where every start led, the first one's first, equal ones the same object; why one led nowhere, or ''."""
        march = self.march
        known = [self.first]
        enough = min(self.like.pace.enough, SHUT * march.mass.normal_load)
        pace = replace(self.like.pace, rate=0.0, enough=enough, work=max(self.like.pace.work, WORK))
        for start in starts(march.scene, march.law)[1:]:
            place = march.place(start)
            run = march.run(pace, place)
            if run.verdict == TOO_FAST:  # flung: it needs more steps than where it ends
                steps = math.ceil(steps_needed(march, run))
                run = march.run(replace(pace, steps=steps), place)
            if not run.settled:
                return known, f"from another start the motion {why_not(run)}"
            found = self._led(run)
            same = (old for old in known if self._agree(old, found, run))
            known.append(next(same, found))
        return known, ""

    def _led(self, run: MarchResult) -> Arrival:
        mean, like, spread = run.mean.real, self.like, run.high - run.low
        noise = 2.0 * self._steps if self.first.period > 0 else 0.0
        if run.verdict == STALLED:
            noise = max(noise, NOISE * self.march.at_rest)
            beside = like.verdict == STALLED and self.first.period > 0
            noise = max(noise, 2.0 * (like.high - like.low) if beside else 0.0)
        if spread <= noise or (run.verdict == CLOSED and run.stride == 1):
            return Arrival(1, mean, mean, mean, run.laps)
        if run.verdict == STALLED:
            return unrepeated_arrival(self.march, run)
        # repeats as the first does, or as its steps do
        same = (run.verdict, run.stride) == (like.verdict, like.stride)
        return Arrival(self.first.period if same else run.stride, mean, run.low, run.high, run.laps)

    @property
    def _steps(self) -> float:
        """The error of a mean from the time steps."""
        if self.march.facts.adaptive:  # no grid, and a bias that both runs share
            return 1e-5 * self.march.at_rest
        beside = abs(self.like.mean.real - self.mean.mean.real)
        return self.mean.error + beside + crossing(self.march, self.like)

    def _agree(self, old: Arrival, found: Arrival, run: MarchResult) -> bool:
        """Within twice what these steps leave: on a grid of times slip begins and ends up to a step apart."""
        if old.average is not None and found.average is not None:
            return near_each_other(old.average, found.average)
        doubt = 2.0 * self._steps + run.closing + self.like.closing
        return 0 < old.period == found.period and abs(found.mean - old.mean) <= doubt


def one_motion(arrivals: Sequence[Arrival]) -> bool:
    """Whether every start reached the same motion."""
    return all(one is arrivals[0] for one in arrivals)


def unrepeated_arrival(march: MarchRun, run: MarchResult) -> Arrival:
    """A motion that never repeats, followed on for its long mean."""
    laps = march.means_of_laps(run, LAPS_AVERAGED)
    found = long_mean([laps])
    return Arrival(0, found.mean, float(laps.min()), float(laps.max()), len(laps), found)


def mean_of_unrepeated(
    march: MarchRun, run: MarchResult, others: Sequence[MarchResult], own: LongMean
) -> LongMean:
    """The long mean of a motion that never repeats; its error by steps, too: what those of other runs make of it, and
    what slip that begins or ends inside a step may cost."""
    means = [long_mean([march.means_of_laps(other, LAPS_AVERAGED)]).mean for other in others]
    by_steps = max(abs(mean - own.mean) for mean in means) + crossing(march, run)
    return own._replace(error=own.error + by_steps)


def first_arrival(march: MarchRun, mean: MarchMean) -> Arrival:
    """What the first start led to, by the finest run; undriven, the period of the response is a lap.

    Steps can keep a motion from repeating every lap: laps that differ by no more than the error are one.
    """
    last, along = mean.runs[-1], mean.mean.real
    alike = last.verdict != CLOSED or last.stride == 1
    if alike or march.follows_the_drive or march.scene.undriven:
        return Arrival(1, along, along, along, last.laps)
    noise = min(mean.error, NOISE * march.at_rest)
    period = 1 if last.high - last.low <= noise else last.stride
    return Arrival(period, along, last.low, last.high, last.laps)


READABLE = 4096
"""Most steps per period of the run that the columns besides the mean are read from."""
LED_ELSEWHERE = (
    "static friction above sliding friction: where steps lead such a motion has no known bound; use shooting"
)


@dataclass(frozen=True)
class PointAnswer:
    """Mean friction (x1 + i x2), the error of its x1 and the period; the range of a mean that depends on the start.

    window: of the range, or of a mean without a period.

    Whatever is not known is NaN.
    """

    mean: complex = complex(math.nan, math.nan)
    error: float = math.nan
    period: float = math.nan
    low: float = math.nan
    high: float = math.nan
    window: float = math.nan


class MarchedPoint:
    """One scene, marched, and what came of it."""

    def __init__(self, scene: Scene, law: FrictionLaw, tolerance: float, plan: Plan) -> None:
        self.scene, self.law, self.plan = scene, law, plan
        self.march = MarchRun(scene, law, plan.stepper)
        self.answer = PointAnswer()
        self.status: Status = "failed"
        self.reason, self.model, self.error_kind = "", "", "estimated"
        self.orbit: Callable[[], Orbit | None] = nowhere
        if stays_at_rest(scene, law) and scene.initial is None and not scene.undriven:
            self._leave_open(-resting_range(scene, law, -1.0), resting_range(scene, law))
        else:
            self._judge(march_mean(self.march, plan, tolerance), tolerance)
        self.seconds = self.march.seconds

    def _leave_open(self, low: float, high: float) -> None:
        self._range(low, high)
        self.reason = (
            "the belt is at rest and static friction balances the loads: the mass may rest anywhere in a range; "
            "give scene.initial to choose a start"
        )

    def _range(self, low: float, high: float, window: float = 1.0) -> None:
        self.status = "not_unique"
        self.answer = PointAnswer(low=low, high=high, window=window)

    def _judge(self, mean: MarchMean, tolerance: float) -> None:
        last = mean.runs[-1]
        theta = f" with theta {self.plan.theta:g}" if "theta" in self.march.facts.keys else ""
        self.model = f"march, {self.plan.stepper}{theta}: {mean.how or 'no steady state'}"
        if not last.settled:
            self._give_up(last)
            return
        readable = self._readable(mean.runs)
        arrivals, problem = self._arrivals(mean, readable)
        unique = not problem and one_motion(arrivals)
        chosen = unique or self.scene.initial is not None
        if not problem and (long := self._long_mean(arrivals, chosen)) is not None:
            if friction_at_rest(self.law) > self.law.sliding_friction(0.0):
                self.reason = f"{describe(arrivals, 6)}; {LED_ELSEWHERE}"
                return
            self._accept_long_mean(mean.runs, readable, long)
        elif (own := arrivals[0].period) > 0 and chosen:
            # Which lap's mean is meant makes so much of a difference.
            spread = arrivals[0].high - arrivals[0].low if own == 1 else 0.0
            self._accept(replace(mean, error=mean.error + spread), readable, tolerance, own)
        elif problem:
            self.reason = f"{describe(arrivals, 6)}; {problem}"
        else:
            self._leave_range(arrivals)
        if self.status == "ok" and not unique:
            others = "; ".join(filter(None, (describe(arrivals, 6), problem)))
            start = self.scene.initial is not None
            self._remark(f"{'reached from scene.initial; ' if start else SHARED}{others}")

    def _give_up(self, last: MarchResult) -> None:
        """Without a steady state: refused where other steps would do, else failed."""
        self.reason = f"the motion {why_not(last)}"
        if last.verdict == TOO_FAST and math.isfinite(last.met):
            self.status = "refused"
            fewest = math.ceil(steps_needed(self.march, last))
            self.reason = unstable(last.pace.steps, fewest, self.law, self.plan.stepper)
        if last.verdict == TOO_STIFF:
            self.status = "refused"
            fewest_said = f"{steps_needed(self.march, last):.2g}"
            self.reason += f": about {fewest_said} are enough; or use method shooting"

    def _arrivals(self, mean: MarchMean, readable: MarchResult) -> tuple[list[Arrival], str]:
        """Where the starts lead; and why one leads nowhere, or ''."""
        if restless(mean.runs, self.march):
            first = unrepeated_arrival(self.march, readable)
        else:
            first = first_arrival(self.march, mean)
        if not self._may_depend_on_start():
            return [first], ""
        return OtherStarts(self.march, mean, first, readable).arrivals()

    def _may_depend_on_start(self) -> bool:
        """Whether another start may lead elsewhere, in a row that is not about one start alone."""
        scene, law = self.scene, self.law
        if scene.undriven or stays_at_rest(scene, law):
            return False
        if law.memory_kind == "none":
            return not is_convergent(scene, law)
        if scene.bends:
            return True
        if law.memory_kind == "scalars" or friction_falls(law):
            return True
        # An elastic contact holds the mass wherever it stops on a belt at rest; several deflections always do.
        elastic = law.memory_kind == "deflections" or law.elastic_deflection() > 0.0
        return scene.belt_speed == 0.0 and elastic

    def _leave_range(self, arrivals: Sequence[Arrival]) -> None:
        means, window = (
            [one.mean for one in arrivals],
            max(one.followed if one.average else 1 for one in arrivals),
        )
        self._range(min(means), max(means), window)
        falls = self.law.memory_kind == "none" or friction_falls(self.law)
        why = "friction falls with speed: " if self._may_depend_on_start() and falls else ""
        why = "springs and dashpots are not linear: " if self.scene.bends else why
        if not why and arrivals[0].period == 0:
            why = "the motion is not periodic at any step: "
        self.reason = why + describe(arrivals, 6)

    def _lost_in_chatter(self, mean: MarchMean) -> float:
        """All that the mean may be off by, where the belt is slower than the jumps that rk4 makes about rest."""
        if not self.march.facts.is_blind(self.law.memory_kind):
            return 0.0
        step = 2.0 * math.pi / self.scene.frequency / mean.runs[-1].pace.steps
        jump = self.march.mass.normal_load * self.march.at_rest * step
        return self.march.at_rest + abs(mean.mean.real) if abs(self.scene.belt_speed) < jump else 0.0

    def _remark(self, said: str) -> None:
        self.reason = "; ".join(filter(None, (self.reason, said)))

    def _accept(self, mean: MarchMean, readable: MarchResult, tolerance: float, own: int) -> None:
        """Answer by this mean, of a motion that takes so many laps; undriven, as many as the last run says."""
        last = mean.runs[-1]
        self.status = "ok"
        self.orbit = partial(self._orbit, readable, last.stride if self.scene.undriven else own)
        error = max(mean.error, self._lost_in_chatter(mean))
        self.answer = PointAnswer(mean.mean, error, self._period(mean, last, own))
        if last.verdict == STALLED:
            averaged = self.march.window * self.march.periods
            self._remark(
                f"rounding to time steps makes the motion aperiodic: averaged over {averaged:.0f} periods"
            )
        if not (self.march.converges or self._may_depend_on_start() or self._moves_on()):
            start = "scene.initial" if self.scene.initial else "the default start"
            self._remark(f"the state reached from {start}; no other start was tried")
        if not self.answer.error <= tolerance:
            self._remark(f"the error is above the tolerance {tolerance:.1e}")

    def _long_mean(self, arrivals: Sequence[Arrival], chosen: bool) -> LongMean | None:
        """Of a motion that never repeats: the first one, where it was chosen; else one that all share the mean of."""
        if chosen:
            return arrivals[0].average
        known = [one.average for one in arrivals if one.average]
        errors = [one.average.error if one.average else 0.0 for one in arrivals]  # steps tell theirs
        spread = spread_of_one_mean([one.mean for one in arrivals], errors, 0.0)
        return None if not known or math.isnan(spread) else known[0]._replace(error=max(errors) + spread)

    def _accept_long_mean(self, runs: Sequence[MarchResult], readable: MarchResult, long: LongMean) -> None:
        """Answer by the long mean of a motion that never repeats."""
        others = [run for run in (runs if self.plan.steps else runs[-2:]) if run is not readable]
        found = mean_of_unrepeated(self.march, readable, others, long)
        self.status, self.error_kind = "ok", STATISTICAL
        self.orbit = partial(self._orbit, readable, 1)
        window = LAPS_AVERAGED * readable.period / readable.stride / self.march.drive_period
        self.answer = PointAnswer(complex(found.mean, math.nan), found.error, window=window)
        self._remark(found.sentence(window, FREE if self.scene.undriven else DRIVEN))

    def _moves_on(self) -> bool:
        """Whether bristles that a moving belt drags along forget where the mass started."""
        moves = self.scene.belt_speed != 0.0 and not self.scene.undriven
        return self.law.count() > 0 and moves

    def _period(self, mean: MarchMean, last: MarchResult, own: int) -> float:
        if not self.scene.undriven:
            return self.march.periods * own
        swing = read_columns([self.scene], lambda i: self.orbit())["velocity_amplitude"][0]
        still = swing <= 2.0 * last.pace.enough
        return math.nan if last.verdict == RESTING or still else mean.period / (2.0 * math.pi)

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
        orbit = replace(self.march.track(run, periods * own), periods=periods)
        return orbit if self.march.facts.sticks else replace(orbit, stick=None)


def nowhere() -> None:
    """The orbit of a point without one."""


def answers_of(points: Sequence[MarchedPoint]) -> Answers:
    """The answers of points, none of which hangs on another."""
    low = np.array([point.answer.low for point in points])
    return Answers(
        status=[point.status for point in points],
        reason=[point.reason for point in points],
        model=[point.model for point in points],
        error_kind=[point.error_kind if point.status == "ok" else "" for point in points],
        mean=np.array([point.answer.mean for point in points]),
        error=np.array([point.answer.error for point in points]),
        period=np.array([point.answer.period for point in points]),
        mean_low=low,
        mean_high=np.array([point.answer.high for point in points]),
        window=np.array([point.answer.window for point in points]),
        seconds=np.array([point.seconds for point in points]),
        orbit=lambda i: points[i].orbit(),
    )
