"""What an undriven mass does in the long run on a contact with memory: steady sliding, a cycle, or rest.

The motion is followed from scene.initial until it nears steady sliding as the derivative there says, or until its
largest deflections come back: from them a cycle is closed, whose period is an unknown. Either counts where small
disturbances do not leave it and the motion from the start nears it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property
from typing import NamedTuple

import numpy as np

from frictionlab.compile.interpret import interpreted
from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.periodic.attraction import ENOUGH, KnownOrbit, obeys
from frictionlab.methods.periodic.fixed_point import FINER, ROUNDING
from frictionlab.methods.shooting.undriven_cycle import Cycle, close_cycle, radius
from frictionlab.methods.shooting.undriven_motion import (
    COMES_TO_REST,
    SLIDES,
    SLIDES_FREELY,
    TURN,
    Effort,
    NotFound,
    PeriodicMotion,
)
from frictionlab.methods.shooting.undriven_path import FOLLOWED, LEAST, PANELS_AT_FIRST, Return, UndrivenPath
from frictionlab.orbit.record import Orbit
from frictionlab.orbit.recorder import Track
from frictionlab.quantities import Floats
from frictionlab.scene.scene import Scene

BETWEEN_LOOKS = 2.0
"""Turns between looks at where the motion leads."""
BACK = 0.05
"""How near to each other two largest deflections must come to close a cycle from them [distances to sliding]."""
THERE = 1e-6
"""How near a motion must come to what attracts it to be there without further proof."""
TRIALS = 10, 30, 100, 300, 1000
"""Counts of largest deflections after which a cycle is looked for however far apart they are."""
MOST_RETURNS = 4
"""Largest deflections in one period."""
LITTLE = 1e-4
"""Of sliding friction: how near to it friction must stay where nothing else takes energy from the motion."""
STICKING = 1e-2
"""Of the belt speed: slower slip is called stick."""
ACROSS = "friction of so quick a slip may feed a motion across the belt, which is not followed: leave transverse out"
MOST_TURNS, RESTING = 5000, 4
"""Turns after which a mass that still swings on a belt at rest is given up; those by which its decay is judged."""


class Reach(NamedTuple):
    """The deflections between which a motion went, from some turn on."""

    turns: float
    low: float
    high: float


@dataclass(frozen=True)
class UndrivenMemory:
    """An undriven scene and a law with memory, followed through time."""

    scene: Scene
    law: FrictionLaw
    tolerance: float
    effort: Effort = field(default_factory=Effort)
    _tried: dict[int, float] = field(default_factory=dict)

    @cached_property
    def _path(self) -> UndrivenPath:
        return UndrivenPath(self.scene, self.law, self.effort)

    @cached_property
    def _still(self) -> KnownOrbit:
        """Steady sliding, as an orbit from one look to the next. Raises NotFound."""
        state = self._path.sliding
        matrix = self._path.quotients(state, BETWEEN_LOOKS)
        return KnownOrbit(state, matrix, 1.0 - radius(matrix))

    @property
    def _accuracy(self) -> float:
        """Of maps that are to follow the motion no worse than the mean is asked for."""
        return max(min(0.1 * self.tolerance, FOLLOWED), LEAST)

    @property
    def _conserves(self) -> bool:
        """Whether only friction other than that of sliding takes energy: then no cycle is left but free ones."""
        return self._path.mass.damping == 0.0 and self.law.constant_sliding_friction()

    def motion(self) -> PeriodicMotion:
        """The motion reached from the start. Raises NotFound."""
        path = self._path
        if path.speed == 0.0:
            return self._at_rest()
        state, turns, steady = path.start, 0.0, 0
        returns, cycles, reaches = list[Return](), list[Cycle](), list[Reach]()
        while True:
            span = path.follow(state, BETWEEN_LOOKS, room=PANELS_AT_FIRST)
            steady = steady + 1 if _nears(self._still, state, span.end) else 0
            if steady >= ENOUGH or _is_there(self._still, span.end):
                return self._sliding()
            if self._conserves and self._slides_freely(span.track):
                return self._free(span.end)
            reaches = [*_recent(reaches, returns, turns), _reach(span.track, turns)]
            for peak in path.peaks(state, span.track, _middle(reaches)) if not self._conserves else ():
                returns = [*returns, Return(peak.state, turns + peak.turns)]
                cycle = self._reached_cycle(returns, cycles)
                if cycle is not None:
                    return self._cycle(cycle)
            state, turns = span.end, turns + BETWEEN_LOOKS
            self.effort.turns = turns

    # --- steady sliding ---

    def _sliding(self) -> PeriodicMotion:
        path = self._path
        return PeriodicMotion(path.sliding, math.nan, path.sliding_friction, ROUNDING, math.nan, SLIDES)

    def _slides_freely(self, track: Track) -> bool:
        """Whether friction is that of sliding, to little."""
        sliding = self._path.sliding_friction
        friction = -track.friction.real[: track.filled[0]]
        return bool(np.abs(friction - sliding).max() <= LITTLE * abs(sliding))

    def _free(self, state: Floats) -> PeriodicMotion:
        """The oscillation that the motion ends on, no faster than the belt: friction stays that of sliding."""
        path = self._path
        swing = state[:2] - path.sliding[:2]
        swing *= min(1.0, abs(path.speed) / math.hypot(*swing))
        state = path.sliding.copy()
        state[:2] += swing
        return PeriodicMotion(state, TURN, path.sliding_friction, ROUNDING, 1.0, SLIDES_FREELY)

    # --- cycles ---

    def _reached_cycle(self, returns: list[Return], cycles: list[Cycle]) -> Cycle | None:
        """The cycle that the motion surely nears; cycles: those found so far, one more where it is new."""
        for cycle in cycles:
            if _nears_cycle(cycle, returns):
                return cycle
        last = returns[-1]
        size = self._path.from_sliding(last.state)
        for back in range(1, min(MOST_RETURNS, len(returns) - 1) + 1):
            before = returns[-1 - back]
            apart = float(np.linalg.norm(last.state - before.state))
            # closing is costly: again only where they have come much nearer to each other
            near = min(BACK * size, 0.25 * self._tried.get(back, math.inf))
            if apart < near or (back == 1 and len(returns) in TRIALS):
                self._tried[back] = apart
                guess = Return(last.state, last.turns - before.turns)
                found = close_cycle(self._path, guess, self.tolerance)
                if found is not None and not any(_is_there(_orbit(other), found.state) for other in cycles):
                    cycles.append(found)
                    return found if _nears_cycle(found, returns) else None
        return None

    def _cycle(self, cycle: Cycle) -> PeriodicMotion:
        """Raises NotFound where a motion across the belt might grow."""
        span, speed = self._path.follow(cycle.state, cycle.turns, room=PANELS_AT_FIRST), self._path.speed
        fastest = float(np.abs(span.track.v.real[: span.track.filled[0]] - speed).max())
        if self.scene.degrees_of_freedom == 2 and not self.law.damps_across(fastest):
            raise NotFound(ACROSS)
        rests = span.slowest < STICKING * abs(speed)
        kind = "a cycle of stick and slip" if rests else "a cycle of slip without rest"
        return PeriodicMotion(
            cycle.state, cycle.turns * TURN, cycle.mean, cycle.error, cycle.multiplier, kind
        )

    # --- rest ---

    def _at_rest(self) -> PeriodicMotion:
        """On a belt at rest: the spring keeps what friction holds when the motion has died out."""
        start, mass = self.scene.start, self._path.mass
        if start.x == start.velocity == 0.0:
            return PeriodicMotion(self._path.start, math.nan, 0.0, ROUNDING, math.nan, COMES_TO_REST)
        unit, accuracy = math.sqrt(mass.stiffness) / mass.normal_load, self._accuracy
        state, left = self._rested(accuracy)
        while True:
            # where it ends depends on every step of the way: once more, much finer
            before, accuracy = state, max(accuracy / FINER, LEAST)
            state, left = self._rested(accuracy)
            mean = float(unit * state[0])
            error = unit * (2.0 * float(abs(state[0] - before[0])) + left) + ROUNDING
            if error <= self.tolerance or accuracy <= LEAST:
                return PeriodicMotion(state, math.nan, mean, error, math.nan, COMES_TO_REST)

    def _rested(self, accuracy: float) -> tuple[Floats, float]:
        """The state in which the motion has died out, but for so much of its way. Raises NotFound."""
        path, ways = self._path, list[float]()
        state, enough = path.start, 0.1 * self.tolerance * path.mass.normal_load
        for _ in range(MOST_TURNS):
            span = path.follow(state, 1.0, accuracy, PANELS_AT_FIRST)
            state = span.end
            # in a state, positions are in the norm of energy
            x = math.sqrt(path.mass.stiffness) * span.track.x.real[: span.track.filled[0]]
            way = float(np.abs(np.diff(x.ravel())).sum())
            ways.append(way)
            self.effort.turns += 1.0
            # what is left of the way shrinks, turn by turn, as it did over the last ones
            rate = (way / ways[-1 - RESTING]) ** (1.0 / RESTING) if len(ways) > RESTING and way > 0.0 else 1.0
            left = way * rate / (1.0 - rate) if rate < 1.0 else math.inf
            if way <= 1e-15 or left <= enough:
                return state, min(left, enough)
        raise NotFound(f"the mass still swings: {path.whereabouts(state)}")

    def orbit(self, motion: PeriodicMotion) -> Orbit:
        """The orbit of the motion; of one that stands still, over 2 pi."""
        turns = motion.period / TURN if math.isfinite(motion.period) else 1.0
        track = self._path.follow(
            motion.state, turns, max(0.1 * self.tolerance, LEAST), PANELS_AT_FIRST
        ).track
        parts = track.tau, track.x, track.v, track.friction, track.stick
        return Orbit(*(part[: track.filled[0]] for part in parts))


def _nears(orbit: KnownOrbit, before: Floats, after: Floats) -> bool:
    """Whether a motion comes nearer to an orbit from one state to another as the derivative there says."""
    predicted = np.empty(before.size)
    return bool(interpreted(obeys)(orbit, before - orbit.state, after - orbit.state, predicted))


def _is_there(orbit: KnownOrbit, state: Floats) -> bool:
    """Whether a state is so near to an orbit that attracts that the motion ends on it."""
    near = THERE * (1.0 + float(np.linalg.norm(orbit.state)))
    return bool(orbit.gap > THERE and float(np.linalg.norm(state - orbit.state)) < near)


def _orbit(cycle: Cycle) -> KnownOrbit:
    return KnownOrbit(cycle.state, cycle.matrix, 1.0 - cycle.multiplier)


def _nears_cycle(cycle: Cycle, returns: list[Return]) -> bool:
    """Whether the last period of the motion led to a cycle that attracts, or nearer to it as its derivative says."""
    orbit, last = _orbit(cycle), returns[-1]
    if not orbit.gap > THERE:
        return False
    if _is_there(orbit, last.state):
        return True
    a_period_ago = [
        one
        for one in returns[-1 - MOST_RETURNS : -1]
        if abs(last.turns - one.turns - cycle.turns) < BACK * cycle.turns
    ]
    return bool(a_period_ago) and _nears(orbit, a_period_ago[-1].state, last.state)


def _reach(track: Track, turns: float) -> Reach:
    x = track.x.real[: track.filled[0]]
    return Reach(turns, float(x.min()), float(x.max()))


def _recent(reaches: list[Reach], returns: list[Return], turns: float) -> list[Reach]:
    """Those of the last two returns, or of half of the way; one at a time is left out."""
    since = returns[-3].turns if len(returns) > 2 else 0.5 * turns
    return reaches[1:] if reaches and reaches[0].turns <= since - BETWEEN_LOOKS else reaches


def _middle(reaches: list[Reach]) -> float:
    return 0.5 * (min(one.low for one in reaches) + max(one.high for one in reaches))
