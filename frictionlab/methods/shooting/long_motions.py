"""Motions that do not repeat, followed on until their long mean is known, or until they repeat after all."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from frictionlab.methods.periodic.follow import MOST, POINTS_KEPT, Attractor, ends_on, orbit_at_the_end
from frictionlab.methods.periodic.long_mean import BLOCKS, LongMean, birkhoff_mean, long_mean, near_each_other
from frictionlab.methods.periodic.problem import PeriodicProblem, Transient
from frictionlab.methods.shooting.attractors import FollowedStarts, carried_for
from frictionlab.scene.scene import Scene
from frictionlab.theory.rest import friction_at_rest
from frictionlab.values.quantities import Floats

LENGTHS = 512, 1024, 2048
"""Periods after which motions are averaged: the next length where the error is not small enough yet."""
FEWEST_AVERAGED, FEWEST_FOLLOWED = 256, 100
"""Periods below which nothing is averaged; and those below which a motion is not followed on: each length is followed
for so many steps at most, and three lengths would not do."""
SMALL_ERROR = 1e-4
"""Error of the mean friction that is small enough, where the tolerance is smaller."""
ACCURACY, FINER = 1e-7, 1e-9
"""Accuracy of the maps of these periods, over the normal load; and of those that tell their error."""
HARDLY = 1e-6
"""Error of the mean of a chaotic motion below which maps may be off by more."""
REPEATED = 1e-6
"""Distance of a state to an earlier one, over its size, at which the motion repeats."""


class LongMotion:
    """One motion that has not repeated, and the means of its periods since it was followed on.

    start: where it was left before. path: the state before the first period and those after each, of these sizes.
    end: where it leads, once it is known to repeat.
    """

    def __init__(self, problem: PeriodicProblem, scene: Scene, start: Attractor) -> None:
        self._problem, self._scene, self.start = problem, scene, start
        self.means: Floats = np.empty(0)
        self.sizes: Floats = np.empty(0)
        self.states = self.path = start.points[-1:]
        self.end: Attractor | None = None
        self.seconds = 0.0

    def follow(self, length: int, known: Sequence[Attractor] = ()) -> None:
        """On to so many periods in all, and to its end where it turns out to repeat; known: ends of others."""
        way = self._way(self.states[-1], length - len(self.means), ACCURACY)
        self.means, self.states = np.concatenate([self.means, way.means]), way.states
        self.path = np.concatenate([self.path, way.states])
        self.sizes = np.concatenate([self.sizes, np.linalg.norm(way.states, axis=1)])
        period = late_period(self.states)
        if period:
            self.end = next((one for one in known if ends_on(way.state, period, one)), None)
        if period and self.end is None:
            found = Transient(period, way.means, way.states, way.state, 0.0)
            end, more = orbit_at_the_end(self._problem, self._scene, found)
            self.end = end if end.curve is not None else None
            self.seconds += more

    def linger(self) -> None:
        """On to the greatest length, however many steps that takes; means before another one set in are forgotten."""
        while len(self.means) < LENGTHS[-1] and self.may_go_on:
            self.follow(LENGTHS[-1])
        half = len(self.means) // 2
        while half >= FEWEST_AVERAGED:
            if not near_each_other(long_mean([self.means[:half]]), long_mean([self.means[half:]])):
                self.means, self.sizes, self.path = self.means[half:], self.sizes[half:], self.path[half:]
            half //= 2

    def off_by_maps(self) -> float:
        """By how much finer maps change its weighted mean."""
        way = self._way(self.path[0], len(self.means), FINER)
        return abs(birkhoff_mean(way.means) - birkhoff_mean(self.means[: len(way.means)]))

    def _way(self, state: Floats, periods: int, accuracy: float) -> Transient:
        way = self._problem.followed_on(self._scene.belt_speed, state, periods, accuracy)
        self.seconds += way.seconds
        return way

    @property
    def may_go_on(self) -> bool:
        """Check whether it has no end yet, and its steps are not too many to be followed for long enough."""
        stopped = self.start.stopped or 0 < len(self.means) < FEWEST_FOLLOWED
        return self.end is None and not stopped

    @property
    def stays(self) -> bool:
        """Check whether it is not on its way elsewhere: growing, or dying out, in every part of the time."""
        return len(self.means) >= FEWEST_AVERAGED and not drifts(self.sizes)

    def averaged(self, mean: LongMean | None) -> Attractor:
        """Return where it leads: a closed orbit, or a motion with this mean over all of its attractor."""
        if self.end is not None or mean is None:
            return self.end or self.start
        low, high = float(self.means.min()), float(self.means.max())
        kept = self.states[-POINTS_KEPT:]
        return replace(self.start, followed=len(self.means), low=low, high=high, points=kept, average=mean)


def late_period(states: Floats) -> int:
    """After how many of the states [n, size] at the starts of periods the last two repeat; 0 where they do not."""
    size = max(1.0, float(np.abs(states[-1]).max()))
    for lag in range(1, len(states) // 4):
        last = np.abs(states[-1] - states[-1 - lag]).max(), np.abs(states[-2] - states[-2 - lag]).max()
        if max(last) <= REPEATED * size:
            return lag
    return 0


def drifts(sizes: Floats) -> bool:
    """Check whether the mean of these grows from each part to the next, or falls: by chance once in 20,000 times."""
    steps = np.diff([part.mean() for part in np.array_split(sizes, BLOCKS)])
    return bool((steps > 0.0).all() or (steps < 0.0).all())


def average_unrepeated(problem: PeriodicProblem, scene: Scene, followed: FollowedStarts) -> None:
    """Say of every start whose motion did not repeat where it leads over a long time."""
    on_the_way = carried_for(scene, problem.mass.normal_load * friction_at_rest(problem.law)) > MOST
    if on_the_way or not any(one.curve is None and one.average is None for one in followed.reached):
        return
    places = [place for place, one in enumerate(followed.reached) if one.curve is None and not one.neutral]
    motions = {place: LongMotion(problem, scene, followed.reached[place]) for place in places}
    means: dict[int, LongMean] = {}
    for length in LENGTHS:
        for motion in motions.values():
            if motion.may_go_on:
                motion.follow(length, [one.end for one in motions.values() if one.end is not None])
        means = means_of_attractors(motions)
        open_ = [place for place, motion in motions.items() if motion.end is None]
        enough = max(problem.goal.tolerance, SMALL_ERROR)
        if len(set(means.values())) < 2 and all(
            place in means and means[place].error <= enough for place in open_
        ):
            break
    repeats = len(open_) < len(followed.reached)
    means = with_errors_of_maps(motions, once_joined(motions, means, repeats))
    followed.lead_to({place: motion.averaged(means.get(place)) for place, motion in motions.items()})
    followed.seconds += sum(motion.seconds for motion in motions.values())


def once_joined(
    motions: dict[int, LongMotion], means: dict[int, LongMean], repeats: bool
) -> dict[int, LongMean]:
    """Same, once chaotic motions have been followed on to see whether they join another state; the commonest mean
    stays, unless other starts repeat.

    Chaos may linger for hundreds of periods beside an orbit that repels.
    """
    if len(set(means.values())) + repeats < 2:
        return means
    shares = Counter(means.values())
    most = max(shares, key=lambda mean: shares[mean])
    for place, mean in means.items():
        if not mean.quasi_periodic and (repeats or mean is not most):
            motions[place].linger()
    return means_of_attractors(motions)


def means_of_attractors(motions: dict[int, LongMotion]) -> dict[int, LongMean]:
    """Return the long means of motions that go on without repeating, one for all that are on one attractor.

    One that seems on its way elsewhere, but has the mean of one that stays, beats more slowly than it is followed.
    """
    alone = {
        place: long_mean([motion.means])
        for place, motion in motions.items()
        if motion.end is None and len(motion.means) >= FEWEST_AVERAGED
    }
    groups: list[list[int]] = []
    for place in sorted(alone, key=lambda place: alone[place].mean):
        if motions[place].stays and groups and near_each_other(alone[groups[-1][-1]], alone[place]):
            groups[-1].append(place)
        elif motions[place].stays:
            groups.append([place])
    of_groups = [long_mean([motions[place].means for place in group]) for group in groups]
    means = {place: mean for group, mean in zip(groups, of_groups, strict=True) for place in group}
    beating = [(place, own, mean) for place, own in alone.items() if place not in means for mean in of_groups]
    return means | {place: mean for place, own, mean in beating if near_each_other(mean, own)}


def with_errors_of_maps(motions: dict[int, LongMotion], means: dict[int, LongMean]) -> dict[int, LongMean]:
    """Means that are closer to each other than maps are to the motion: add what finer maps change.

    So quasi-periodic ones are; chaos leaves more than that, but where it hardly moves the mean.
    """
    told = {
        mean: mean._replace(error=mean.error + 2.0 * motions[place].off_by_maps())
        for mean, place in {mean: place for place, mean in means.items()}.items()
        if mean.quasi_periodic or mean.error < HARDLY
    }
    return {place: told.get(mean, mean) for place, mean in means.items()}
