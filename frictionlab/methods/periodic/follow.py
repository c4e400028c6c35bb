"""Follow a motion, period by period and by leaps, to where it ends: an orbit, a state that stays, or neither."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from frictionlab.methods.periodic.attraction import ARRIVED, KnownOrbit, corners
from frictionlab.methods.periodic.continuation import FINE, MULTIPLIERS, Curve
from frictionlab.methods.periodic.leaps import Leaper
from frictionlab.methods.periodic.long_mean import LongMean
from frictionlab.methods.periodic.period_map import MAP_KINDS
from frictionlab.methods.periodic.problem import LEAST_GAP, PeriodicProblem, Transient, largest_modulus
from frictionlab.scene.scene import Scene
from frictionlab.values.quantities import Floats

NO_GROWTH = 1e-6
"""Largest difference from one that rounding gives a multiplier."""
NEARLY_REPEATED = 1e-3
"""Largest distance of states of an orbit, over their size, at which an orbit of fewer periods is tried."""
POINTS_KEPT = 100
"""Number of states that are kept of a motion that does not repeat."""
FEWEST, MOST = 200, 20_000
"""Smallest and largest number of periods for which a start is followed."""
LONGEST_FREE_PERIOD = 256
"""Longest period of the free mass [drive periods] at which a motion may be said not to repeat.

If it is longer, a motion is not followed for long enough to tell."""
NEUTRAL, MOST_STEPS = 1e-5, 12
"""Largest change by a map, over a small deviation, of one that the map leaves as it is; Newton's steps to it."""
SHIFT, LAST_WAY, RISES = 1e-4, 1e-6, 1e-8
"""Deviation by which a slope is measured, last way led up it, and smallest rise of the mean that counts.

The first two are over the size of the states."""


@dataclass(frozen=True)
class Attractor:
    """Destination of a start: a closed orbit, or a motion that never repeats.

    period: drive periods after which the orbit repeats; 0 if the motion never does. followed: number of
    periods for which the motion was followed. low, high: smallest and largest mean over one drive period.
    points [n, size]: states at the starts of the periods of a closed orbit, or at the last ones of another
    motion. average: mean over a long time of all motions on one attractor that never repeat; None if it has
    not been computed. neutral: True for a motion that repeats, like others near it, because nothing damps it or
    a contact holds it. stopped: True if following stopped before the end. lost: True if it stopped because the
    motion runs away.
    """

    followed: int
    period: int
    low: float
    high: float
    curve: Curve | None
    points: Floats
    average: LongMean | None = None
    neutral: bool = False
    stopped: bool = False
    lost: bool = False

    def agrees(self, other: Attractor) -> bool:
        """Check whether both have the same mean friction, as orbits of one period or by the same average."""
        if self.curve is None or other.curve is None or self.period != other.period:
            return self.average is not None and self.average is other.average
        doubt = self.error + other.error
        return abs(self.mean - other.mean) <= doubt + 1e-12

    @cached_property
    def known(self) -> KnownOrbit:
        """Orbit in the form that kernels take."""
        assert self.curve is not None
        return KnownOrbit(self.curve.states[0], self.curve.matrices[0], 1.0 - multiplier(self.curve))

    @cached_property
    def mean(self) -> float:
        """Mean friction over all periods of a closed orbit, or over a long time; NaN if it is not known."""
        if self.curve is not None:
            return float(self.curve.closed.mean[0])
        return math.nan if self.average is None else self.average.mean

    @property
    def averaged_over(self) -> int:
        """Number of periods of the mean; 1 if only the range of one-period means is known."""
        return self.period or (1 if self.average is None else self.followed)

    @cached_property
    def error(self) -> float:
        """Error of the mean; two standard errors for a mean over a long time."""
        if self.curve is not None:
            return float(self.curve.closed.error[0])
        return math.nan if self.average is None else self.average.error


def multiplier(curve: Curve, row: int = 0) -> float:
    """Return the largest modulus of the Floquet multipliers of an orbit."""
    return float(largest_modulus(curve.matrices[row : row + 1])[0])


def closed_orbit(
    curve: Curve, means: Floats, points: Floats | None = None, gap: float = LEAST_GAP
) -> Attractor | None:
    """Return a closed orbit with its means over each drive period and its states there.

    Return None if the orbit did not close, or if it repels. gap: least difference to one of the multipliers of
    an orbit that attracts.
    """
    # if slip never reverses, bristles may near their limit as a power of the path: multipliers are then one
    maps = curve.closed.maps[0]
    if maps < 0.0 or (maps > 0.0 and not multiplier(curve) < 1.0 - gap):
        return None
    points = curve.states if points is None else points
    return Attractor(0, len(means), float(means.min()), float(means.max()), curve, points)


class Held(NamedTuple):
    """State that a map leaves as it is, its mean friction, and its neutral ways.

    neutral [n, size]: orthonormal directions in which a map leaves neighbours as they are, too.
    """

    state: Floats
    mean: float
    neutral: Floats


@dataclass(frozen=True)
class DrivePeriods:
    """Map of a driven motion over one period of all that varies, as leaps ask for it."""

    problem: PeriodicProblem
    scene: Scene

    @property
    def noise(self) -> float:
        """Error of a map."""
        return FINE * self.problem.mass.normal_load

    def size(self, state: Floats) -> float:
        """Return the size of a state."""
        return float(np.linalg.norm(state))

    def price(self, state: Floats) -> float:
        """Return the number of steps that the map of a state takes."""
        return self.problem.followed_on(self.scene.belt_speed, state, 1, FINE).steps

    def mapped(self, states: Floats) -> Floats:
        """Return the images of states [count, size]."""
        return self.problem.mapped(np.full(len(states), self.scene.belt_speed), states)

    def derivative(self, state: Floats) -> Floats:
        """Return the monodromy matrix at a state."""
        problem, speeds = self.problem, np.array([self.scene.belt_speed])
        curve, _ = problem.called(speeds, state[None].copy(), problem.goal, MULTIPLIERS)
        matrix: Floats = curve.matrices[0]
        return matrix

    def stays(self, state: Floats) -> bool:
        """Check that a map changes a state by no more than its error."""
        return bool(np.linalg.norm(self.mapped(state[None])[0] - state) <= 100.0 * self.noise)

    def held(self, state: Floats) -> Held | None:
        """Return where the motion from a state ends, by true maps and then by Newton's; None if there is none.

        Newton's steps are the shortest, so that they lead along no neutral way.
        """
        way = self.problem.carried(self.scene.belt_speed, state, FEWEST)
        state = way.state
        for _ in range(MOST_STEPS):
            base, matrix = self.mapped(state[None])[0] - state, self.derivative(state)
            if (way.period == 0 and len(way.means) < FEWEST) or not np.isfinite(matrix).all():
                return None
            moved, changes, ways = np.linalg.svd(matrix - np.eye(len(base)))
            moves = changes >= NEUTRAL
            state = state - (base @ moved[:, moves] / changes[moves]) @ ways[moves]
            if np.linalg.norm(base) <= 100.0 * self.noise:
                mean = float(self.problem.repeated_once(self.scene, state[None])[1][0])
                return Held(state, mean, ways[~moves])
        return None

    def farthest(self, here: Held, side: float, size: float) -> Held:
        """Return the state of a continuum with the largest mean (side 1) or the smallest (-1), from one of it.

        Lead it along the neutral ways up the slope of the mean, and back onto the continuum by true maps, until
        no mean is larger. size: of the states.
        """
        way, up = size, np.zeros_like(here.state)
        while way > LAST_WAY * size:
            if len(here.neutral):  # next to an end of the continuum quotients see no neighbours that are held
                beside = here.state + SHIFT * size * here.neutral
                slopes = self.problem.repeated_once(self.scene, beside)[1] - here.mean
                up = side * slopes @ here.neutral / (np.linalg.norm(slopes) + 1e-300)
            there = self.held(here.state + way * up)
            rises = there is not None and side * (there.mean - here.mean) > RISES
            here, way = (there, way) if there is not None and rises else (here, 0.4 * way)
        return here

    def continuum(self) -> list[Held]:
        """Return states of a continuum that no map changes, both with the farthest means among them.

        They are the ends of starts with no deflection and with the deflections of steady sliding. Return none
        if the state in the middle of these ends has no such neighbours.
        """
        starts = corners(self.problem.maps, self.problem.law, self.problem.size, (0j, 0j), 1.0)
        ends = [end for start in starts if (end := self.held(start)) is not None]
        middle = self.held(np.mean([end.state for end in ends], axis=0)) if ends else None
        if middle is None or not len(middle.neutral):
            return []
        size = max(map(self.size, starts))
        return [*ends, *(self.farthest(middle, side, size) for side in (-1.0, 1.0))]


class Follower:
    """Motions of one scene on their way to their ends, the ends known so far, and the kernel time.

    known: states found, the candidate first if there is one. A motion that does not repeat is added each
    time. patience: largest number of periods for which a motion is followed plainly.
    """

    def __init__(
        self, problem: PeriodicProblem, scene: Scene, candidate: Attractor | None, patience: int
    ) -> None:
        self._problem, self._scene, self._patience = problem, scene, patience
        self._section = DrivePeriods(problem, scene)
        self.known = [] if candidate is None else [candidate]
        self.seconds = 0.0

    def led(self, state: Floats) -> tuple[Attractor, int]:
        """Return the destination of a state, and the number of periods for which it was followed.

        It is followed plainly and led by leaps in turn, to its end, or until it is sure to end on a known orbit.
        """
        first = next((one for one in self.known if one.period == 1 and one.curve is not None), None)
        leaper = Leaper(self._section, state)
        asked, more, slow = min(FEWEST, self._patience), leaper.fewest, False
        way = self._stretch(state, asked, first, slow)
        while (end := self._end_of(way, first)) is None and self._may_go_on(way, asked):
            leaper.state, before, asked = way.state, leaper.periods, len(way.means)
            end = self._leapt(leaper)
            if end is not None:
                break
            slow = slow or way.period > 0
            more = min(leaper.fewest if leaper.periods > before else 2 * more, self._patience - asked)
            way, asked = way.then(self._stretch(leaper.state, more, first, slow)), asked + more
        if end is None:
            end, _ = orbit_at_the_end(self._problem, self._scene, way._replace(period=0), leaper.periods)
            self.known = [*self.known, end]
        self.seconds += way.seconds
        return end, len(way.means) + leaper.periods

    def _stretch(self, state: Floats, periods: int, first: Attractor | None, slow: bool) -> Transient:
        """Follow a motion for some periods, a slow one for all of them although it seems to repeat."""
        speed, problem = self._scene.belt_speed, self._problem
        if slow:
            return problem.followed_on(speed, state, periods, MAP_KINDS[problem.kind].rough)
        return problem.carried(speed, state, periods, first.known if first else None)

    def _may_go_on(self, way: Transient, asked: int) -> bool:
        """Check that a motion was followed for as long as was asked, and that this is not yet the longest time."""
        return len(way.means) < self._patience and (way.period > 0 or len(way.means) == asked)

    def _end_of(self, way: Transient, first: Attractor | None) -> Attractor | None:
        """Return the destination of a motion that repeats; None if it does not.

        A slow motion repeats to rounding while it is still on its way, far from the orbit closed there.
        """
        if way.period <= 0:
            return first if way.period == ARRIVED else None
        found = next((one for one in self.known if ends_on(way.state, way.period, one)), None)
        if found is None:
            found, more = orbit_at_the_end(self._problem, self._scene, way)
            self.seconds += more
            if found.curve is None:
                return found if found.neutral else None
            if not any(found.agrees(one) for one in self.known):
                self.known = [*self.known, found]
        away = float(np.linalg.norm(found.points - way.state, axis=1).min())
        if away <= NEARLY_REPEATED * float(np.linalg.norm(way.state)):
            return found
        stays = self._problem.undamped and self._section.stays(way.state)
        return kept(way) if stays else None

    def _leapt(self, leaper: Leaper) -> Attractor | None:
        """Return the closed one-period orbit to which leaps lead, or None."""
        orbits: dict[int, Attractor] = {}

        def known() -> list[KnownOrbit]:
            repeating = [one for one in self.known if one.period == 1 and one.curve is not None]
            orbits.update({id(one.known): one for one in repeating})
            return [one.known for one in repeating]

        found = leaper.lead(known, self._close_beside)
        return None if found is None else orbits[id(found)]

    def _close_beside(self, state: Floats) -> None:
        """Add the closed orbit of one period beside a state to those known."""
        curve, seconds = self._problem.close([self._scene], state)
        self.seconds += seconds
        mean, gap = curve.closed.mean, self._problem.gap
        found = closed_orbit(curve, mean, gap=gap) if curve.closed.found[0] else None
        if found is not None and not any(found.agrees(one) for one in self.known):
            self.known = [*self.known, found]


def kept(way: Transient) -> Attractor:
    """Return the motion that repeats, like others near it; closing may lead along the neutral ways."""
    last = way.means[-way.period :]
    ends = float(last.min()), float(last.max())
    return Attractor(len(way.means), 0, *ends, None, way.states[-way.period :], neutral=True)


def orbit_at_the_end(
    problem: PeriodicProblem, scene: Scene, way: Transient, led: int = 0
) -> tuple[Attractor, float]:
    """Return the orbit at the end of a transient, or the motion that never repeats, and the kernel time.

    led: number of periods over which leaps led the motion in addition.
    """
    seconds, followed = 0.0, len(way.means)
    if way.period > 0:
        curve, means, points, seconds = _shortest(problem, scene, way)
        orbit = closed_orbit(curve, means, points, problem.gap)
        if orbit is not None:
            return orbit, seconds
        beside = bool(curve.closed.found[0]) and multiplier(curve) < 1.0 + NO_GROWTH
        if problem.undamped and (beside or DrivePeriods(problem, scene).stays(way.state)):
            return kept(way), seconds
    last = way.means[followed // 2 :]
    low, high = float(last.min()), float(last.max())
    stopped = way.period == 0 and (followed < FEWEST or problem.free_period > LONGEST_FREE_PERIOD)
    lost, points = stopped and problem.runs_away(way.state), way.states[-POINTS_KEPT:]
    return Attractor(followed + led, 0, low, high, None, points, stopped=stopped, lost=lost), seconds


def ends_on(state: Floats, period: int, orbit: Attractor) -> bool:
    """Check whether a state is near a state of a closed orbit of ``period`` periods."""
    return orbit.period == period > 0 and any(_beside(state, point) for point in orbit.points)


def _beside(one: Floats, other: Floats) -> bool:
    return bool(np.abs(one - other).max() <= 1e-5 * max(1.0, float(np.abs(other).max())))


def _shortest(problem: PeriodicProblem, scene: Scene, way: Transient) -> tuple[Curve, Floats, Floats, float]:
    """Return the orbit at the end of a transient, its mean and its state in each period, and the kernel time.

    The orbit has fewer periods than were seen if the motion was still alternating.
    """
    curve, seconds = problem.close([scene], way.state, way.period)
    if way.period == 1 or not curve.closed.found[0]:
        return curve, curve.closed.mean, curve.states, seconds
    whole = problem.repeated(
        scene.belt_speed, curve.states[0], way.period
    )  # with finer maps than those on the way
    seconds += whole.seconds
    near = NEARLY_REPEATED * max(1.0, float(np.abs(curve.states[0]).max()))
    for period in [each for each in range(1, len(whole.states)) if way.period % each == 0]:
        if np.abs(whole.states[period - 1] - curve.states[0]).max() > near:
            continue
        shorter, more = problem.close([scene], curve.states[0], period)
        seconds += more
        if shorter.closed.found[0] and _beside(shorter.states[0], curve.states[0]):
            return shorter, whole.means[:period], whole.states[:period], seconds
    return curve, whole.means, whole.states, seconds
