"""Time stepping from other starts, for scenes in which no theorem makes the steady state unique."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from frictionlab.methods.march.error import WORK, MarchMean, crossing, steps_needed, why_not
from frictionlab.methods.march.laps import CLOSED, STALLED, TOO_FAST, MarchState
from frictionlab.methods.march.run import MarchResult, MarchRun
from frictionlab.methods.shooting.attractors import starts
from frictionlab.methods.shooting.long_mean import LongMean, long_mean, near_each_other

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
        enough = min(self.like.pace.enough, SHUT * march.unit)
        pace = replace(self.like.pace, rate=0.0, enough=enough, work=max(self.like.pace.work, WORK))
        for place in self._places():
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

    def _places(self) -> list[MarchState]:
        """The other starts; of a slip that is prescribed, deflections to either side."""
        march = self.march
        if march.unmoved:
            depth = march.law.presliding()
            return [MarchState(0j, 0j, np.array([side * depth])) for side in (1.0, -1.0)]
        return [march.place(start) for start in starts(march.scene, march.law)[1:]]

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
