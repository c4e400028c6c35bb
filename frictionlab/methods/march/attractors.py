"""Time stepping from other starts, for scenes in which no theorem makes the steady state unique."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

from frictionlab.methods.march.error import WORK, Found, crossing, steps_needed, why_not
from frictionlab.methods.march.laps import CLOSED, STALLED, TOO_FAST
from frictionlab.methods.march.run import MarchResult, MarchRun
from frictionlab.methods.shooting.attractors import starts

NOISE = 1e-3
"""Spread of the means of a motion that does not repeat, over friction at rest, that passes for noise of the steps."""
SHUT = 1e-7
"""Distance from a closed orbit over normal load: chaotic motion stays near repelling cycles for a while."""


@dataclass(frozen=True)
class Reached:
    """Where a start led: a motion that repeats after some laps (0: never), and its means over one of them.

    low, high: the smallest and the largest mean over one lap. followed: for how many laps.
    """

    period: int
    mean: float
    low: float
    high: float
    followed: int


@dataclass(frozen=True)
class Search:
    """The other starts of a scene, each marched once with the steps of a run that began at the first start.

    Both runs make the same errors, so what counts is whether they come to the same, within what those errors leave.
    """

    walker: MarchRun
    answer: Found
    first: Reached
    like: MarchResult

    def reached(self) -> tuple[list[Reached], str]:
        """Where every start led, the first one's first, equal ones the same object; why one led nowhere, or ''."""
        scene, walker = self.walker.scene, self.walker
        known, limit = [self.first], walker.mass.normal_load * walker.at_rest
        enough = min(self.like.pace.enough, SHUT * walker.mass.normal_load)
        pace = replace(self.like.pace, rate=0.0, enough=enough, work=max(self.like.pace.work, WORK))
        for start in starts(scene, limit)[1:]:
            run = walker.run(pace, walker.place(start))
            if run.verdict == TOO_FAST:  # flung: it needs more steps than where it ends
                steps = math.ceil(steps_needed(walker, run))
                run = walker.run(replace(pace, steps=steps), walker.place(start))
            if not run.settled:
                return known, f"from another start the motion {why_not(run)}"
            found = self._led(run)
            same = (old for old in known if self._agree(old, found, run))
            known.append(next(same, found))
        return known, ""

    def _led(self, run: MarchResult) -> Reached:
        mean, like, spread = run.mean.real, self.like, run.high - run.low
        noise = 2.0 * self._steps if self.first.period > 0 else 0.0
        if run.verdict == STALLED:
            noise = max(noise, NOISE * self.walker.at_rest)
            noise = max(noise, 2.0 * (like.high - like.low) if like.verdict == STALLED else 0.0)
        if spread <= noise or (run.verdict == CLOSED and run.stride == 1):
            return Reached(1, mean, mean, mean, run.laps)
        if run.verdict == STALLED:
            return Reached(0, math.nan, run.low, run.high, run.laps)
        if (run.verdict, run.stride) == (
            like.verdict,
            like.stride,
        ):  # repeats as the first does, or as its steps do
            return Reached(self.first.period, mean, run.low, run.high, run.laps)
        return Reached(run.stride, mean, run.low, run.high, run.laps)

    @property
    def _steps(self) -> float:
        """The error of a mean from the time steps."""
        if self.walker.stepper == "smoothed":  # no grid, and a bias that both runs share
            return 1e-5 * self.walker.at_rest
        beside = abs(self.like.mean.real - self.answer.mean.real)
        return self.answer.error + beside + crossing(self.walker, self.like)

    def _agree(self, old: Reached, found: Reached, run: MarchResult) -> bool:
        """Within twice what these steps leave: on a grid of times slip begins and ends up to a step apart."""
        doubt = 2.0 * self._steps + run.closing + self.like.closing
        return 0 < old.period == found.period and abs(found.mean - old.mean) <= doubt


def one_motion(reached: Sequence[Reached]) -> bool:
    """Whether every start reached the same periodic motion."""
    return reached[0].period > 0 and all(one is reached[0] for one in reached)


def first_reached(walker: MarchRun, answer: Found) -> Reached:
    """What the first start led to, by the finest run; undriven, the period of the response is a lap.

    Steps can keep a motion from repeating every lap: laps that differ by no more than the error are one.
    """
    last, mean = answer.runs[-1], answer.mean.real
    alike = last.verdict != CLOSED or last.stride == 1
    if alike or walker.follows_the_drive or walker.scene.undriven:
        return Reached(1, mean, mean, mean, last.laps)
    noise = min(answer.error, NOISE * walker.at_rest)
    period = 1 if last.high - last.low <= noise else last.stride
    return Reached(period, mean, last.low, last.high, last.laps)
