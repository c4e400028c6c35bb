"""Motion of an undriven mass in the long run, followed through time: steady sliding, a cycle, or rest.

The motion is followed from ``scene.initial``, from one passage of a level to the next (undriven_path.py), until it
ends in steady sliding or on a cycle that attracts: the motion must come nearer to it as the derivative there says,
passage by passage or by leaps. What does neither for hundreds of passages has a mean over a long time.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np

from frictionlab.compile.interpret import interpreted
from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import STATISTICAL, Answers, Ledger
from frictionlab.methods.periodic.attraction import KnownOrbit
from frictionlab.methods.periodic.fixed_point import FINER, ROUNDING, stated_error
from frictionlab.methods.periodic.leaps import Leaper
from frictionlab.methods.periodic.long_mean import (
    FREE,
    LongMean,
    birkhoff_mean,
    is_earned,
    long_mean,
    too_wide,
)
from frictionlab.methods.shooting.long_motions import SMALL_ERROR, drifts
from frictionlab.methods.shooting.undriven_path import (
    FOLLOWED,
    LEAST,
    MOST_RETURNS,
    PANELS_AT_FIRST,
    RETURN_DISTANCE,
    TURN,
    Cycle,
    Effort,
    NotFound,
    Passage,
    Passages,
    Settled,
    TooMuchWork,
    UndrivenPath,
    close_shortest,
)
from frictionlab.methods.under_way import each_told
from frictionlab.methods.words import ModelWord
from frictionlab.motion.orbit.record import Orbit
from frictionlab.motion.orbit.recorder import orbit_at_one_place
from frictionlab.scene.scene import Scene
from frictionlab.values.quantities import Floats

OF_BELT_SPEED = 1e-3
"""Coarsest accuracy of the maps that follow a motion, over the speed of the belt."""
AVERAGED, FEWEST = (256, 512, 1024, 2048), 128
"""Counts of passages after which a motion that comes to nothing is averaged, and the fewest that are."""
LED_FROM = 40
"""Passages after which leaps are tried."""
SHOWN = 64
"""Last passages of such a motion, from which columns other than the mean are read."""
MOST_CLOSING = 200_000
"""Steps for closing cycles that may be more than half of all."""
NOISE = 10.0
"""Distance between passages that may be the error of the maps, over that error."""
MOST_CENTERED = 20
"""Most moves of the level."""
STICKING = 1e-2
"""Share of the belt speed below which slip is called stick."""
ACROSS = "friction of so quick a slip may feed a motion across the belt, which is not followed: leave transverse out"
MOST_TURNS, RESTING, SHRINKING = 5000, 4, 30
"""Turns after which a mass that still swings on a belt at rest is given up; those by which its decay is judged; and
those in which its way shrinks to half, or is followed by finer steps."""


class PeriodicMotion(NamedTuple):
    """A periodic motion from a state: its period, mean friction, error and largest multiplier, and what it is.

    long: of a motion that does not repeat, its mean, over so many turns; it is shown over its period.
    """

    state: Floats
    period: float
    mean: float
    error: float
    multiplier: float
    kind: str
    long: LongMean | None = None
    turns: float = math.nan


@dataclass
class Way:
    """A motion so far: its passages of the level, and the cycles found beside it.

    tried: by number of passages, how far it was from its end where a cycle was looked for. closing: steps for that.
    """

    passages: list[Passage] = field(default_factory=list)
    cycles: list[Cycle] = field(default_factory=list)
    tried: dict[int, float] = field(default_factory=dict)
    closing: int = 0


@dataclass(frozen=True)
class Undriven:
    """An undriven scene and a law, followed through time."""

    scene: Scene
    law: FrictionLaw
    tolerance: float
    effort: Effort = field(default_factory=Effort)

    @cached_property
    def _path(self) -> UndrivenPath:
        return UndrivenPath(self.scene, self.law, self.effort)

    @property
    def _accuracy(self) -> float:
        """Return the accuracy of maps that follow the motion no worse than the mean is asked for."""
        asked, of_belt = 0.1 * self.tolerance, abs(self._path.speed) / self._path.mass.normal_load
        if (
            self.law.memory_kind != "scalars" and of_belt > 0.0
        ):  # by scalars, slow slip has steps in its logarithm
            asked = min(asked, OF_BELT_SPEED * of_belt)
        return max(min(asked, FOLLOWED), LEAST)

    @property
    def _conserves(self) -> bool:
        """Check whether only friction other than that of sliding takes energy."""
        mass = self._path.mass
        elastic = mass.damping == 0.0 and not mass.bends
        return elastic and self.law.constant_sliding_friction()

    def motion(self) -> PeriodicMotion:
        """Return the motion reached from the start. Raises NotFound."""
        if self._path.speed == 0.0:
            return self._at_rest()
        section, way = Passages(self._path, self._accuracy, self._conserves), Way()
        try:
            return self._followed(section, way)
        except TooMuchWork:
            if len(way.passages) < FEWEST:
                raise
            self.effort.work = 0  # as much again for what the error needs
            motion = self._unrepeated(section, way.passages)
            if motion is None:
                raise
            return motion

    def motion_or_why_not(self) -> tuple[PeriodicMotion | str, float]:
        """Return the motion, or why none was found, and kernel time [s]."""
        try:
            motion: PeriodicMotion | str = self.motion()
        except NotFound as problem:
            motion = str(problem)
        return motion, self.effort.seconds

    def _followed(self, section: Passages, way: Way) -> PeriodicMotion:
        """Return where the motion from the start leads on a moving belt. Raises NotFound."""
        state, centered = self._path.start, 0
        while True:
            level, found = section.level, section.next(state)
            if isinstance(found, Settled):
                return self._settled(found)
            state = found.state
            self.effort.turns += found.turns
            if section.level != level or (centered < MOST_CENTERED and section.center(found)):
                centered += 1
                way.passages.clear()
                way.cycles.clear()
                way.tried.clear()
                continue
            way.passages.append(found)
            cycle = self._reached_cycle(section, way)
            if cycle is None and len(way.passages) == LED_FROM:
                cycle, led = self._led(section, way)
                if led is not state:
                    way.passages.clear()
                state = led
            if cycle is not None:
                return self._cycle(cycle)
            if len(way.passages) in AVERAGED:
                motion, last = self._unrepeated(section, way.passages), len(way.passages) == AVERAGED[-1]
                if motion is not None and (last or motion.error <= max(self.tolerance, SMALL_ERROR)):
                    return motion
                if last:
                    raise NotFound(
                        f"no steady state within {self.effort.turns:.0f} periods: {self._path.whereabouts(state)}"
                    )

    def _settled(self, end: Settled) -> PeriodicMotion:
        """Steady sliding, or an oscillation about it no faster than the belt: friction stays that of sliding."""
        path = self._path
        if not end.freely:
            kind, nan = ModelWord.SLIDES, math.nan
            return PeriodicMotion(path.sliding, nan, path.sliding_friction, ROUNDING, nan, kind)
        swing = end.state[:2] - path.sliding[:2]
        swing *= min(1.0, abs(path.speed) / max(math.hypot(*swing), 1e-300))
        state = path.sliding.copy()
        state[:2] += swing
        return PeriodicMotion(state, TURN, path.sliding_friction, ROUNDING, 1.0, ModelWord.SLIDES_FREELY)

    # --- cycles ---

    def _reached_cycle(self, section: Passages, way: Way) -> Cycle | None:
        """Find the cycle that the motion surely nears; one more is known where it is new."""
        passages = way.passages
        for cycle in way.cycles:
            if cycle.neared(passages):
                return cycle
        states = [each.state for each in passages]
        near = RETURN_DISTANCE * self._path.from_sliding(states[-1]) / 4.0 ** len(way.cycles)
        for back in range(1, min(MOST_RETURNS, (len(states) - 1) // 2) + 1):
            apart, was = (float(np.linalg.norm(states[-1 - k] - states[-1 - k - back])) for k in (0, back))
            # how far it still is from the cycle, if it goes on to come nearer as it does
            left = apart if apart <= NOISE * section.noise else apart * was / max(was - apart, 1e-300)
            known = any(one.is_beside(states[-1], left) for one in way.cycles if back % one.passages == 0)
            # closing is costly: again only where it is much nearer, and not next to a known cycle
            may = self._may_close(way) or apart <= NOISE * section.noise
            if may and not known and left < min(near, 0.25 * way.tried.get(back, math.inf)):
                way.tried[back] = left
                found = self._close(section, way, states[-1], back)
                if found is not None:
                    return found if found.neared(passages) else None
        return None

    def _close(self, section: Passages, way: Way, state: Floats, passages: int = 1) -> Cycle | None:
        """Close the cycle beside a state, if it is new."""
        before = self.effort.work
        found = close_shortest(section, state, passages, self.tolerance)
        way.closing += self.effort.work - before
        if found is None or any(other.has(found.state) for other in way.cycles):
            return None
        way.cycles.append(found)
        return found

    def _may_close(self, way: Way) -> bool:
        """Check that closing has not taken more than following."""
        return way.closing <= max(0.5 * self.effort.work, MOST_CLOSING)

    def _led(self, section: Passages, way: Way) -> tuple[Cycle | None, Floats]:
        """Lead a motion by leaps: the cycle of one passage where they end, or none, and the state that they reach."""
        orbits: dict[int, KnownOrbit] = {}

        def known() -> list[KnownOrbit]:
            orbits.update({place: one.orbit for place, one in enumerate(way.cycles) if one.passages == 1})
            return list(orbits.values())

        leaper = Leaper(section, way.passages[-1].state)
        found = leaper.lead(known, lambda state: self._may_close(way) and self._close(section, way, state))
        cycle = next((way.cycles[place] for place, orbit in orbits.items() if orbit is found), None)
        return cycle, leaper.state

    def _cycle(self, cycle: Cycle) -> PeriodicMotion:
        """Raises NotFound where a motion across the belt might grow."""
        span, speed = self._path.follow(cycle.state, cycle.turns, room=PANELS_AT_FIRST), self._path.speed
        self._check_across(float(np.abs(span.track.v.real[: span.track.filled[0]] - speed).max()))
        kind = ModelWord.STICKS if span.slowest < STICKING * abs(speed) else ModelWord.SLIPS
        # at rest nothing is left of the motion before
        forgets = span.stuck > 0.0 and self.law.count() == 0
        multiplier = 0.0 if forgets else cycle.multiplier
        return PeriodicMotion(cycle.state, cycle.turns * TURN, cycle.mean, cycle.error, multiplier, kind)

    def _check_across(self, fastest: float) -> None:
        """Raises NotFound where slip of this speed may feed a motion across the belt."""
        if self.scene.degrees_of_freedom == 2 and not self.law.damps_across(fastest):
            raise NotFound(ACROSS)

    # --- motions that do not repeat ---

    def _unrepeated(self, section: Passages, passages: list[Passage]) -> PeriodicMotion | None:
        """Motion by its long mean, the first quarter left out; None where it is on its way elsewhere still.

        Raises NotFound where a motion across the belt might grow.
        """
        way = passages[len(passages) // 4 :]
        if drifts(np.array([self._path.from_sliding(each.state) for each in way])):
            return None
        self._check_across(max(each.fastest for each in way))
        means = means_of(way)
        found = long_mean([means])
        if found.quasi_periodic:  # nearer to each other than its parts are to the motion
            finer = means_of(self._again(section, way[0].state, len(way) - 1))
            found = found._replace(
                error=found.error + 2.0 * abs(birkhoff_mean(finer) - birkhoff_mean(means[1:]))
            )
        shown, turns = way[-SHOWN:], sum(each.turns for each in way)
        state, period = way[-SHOWN - 1].state, math.ceil(sum(each.turns for each in shown)) * TURN
        kind = ModelWord.NEVER_REPEATS
        return PeriodicMotion(state, period, found.mean, found.error, math.nan, kind, found, turns)

    def _again(self, section: Passages, state: Floats, count: int) -> list[Passage]:
        """Return the next passages of a motion by finer maps."""
        finer, found = replace(section, accuracy=section.accuracy / FINER), list[Passage]()
        while len(found) < count and isinstance(end := finer.next(state), Passage):
            found.append(end)
            state = end.state
        return found

    # --- rest ---

    def _at_rest(self) -> PeriodicMotion:
        """On a belt at rest: the spring keeps what friction holds when the motion has died out."""
        start, path = self.scene.start, self._path
        if start.x == start.velocity == 0.0:
            return PeriodicMotion(path.start, math.nan, 0.0, ROUNDING, math.nan, ModelWord.AT_REST)
        accuracy = self._accuracy
        state, left = self._rested(accuracy)
        while True:
            # where it ends depends on every step of the way: once more, much finer
            before, accuracy = state, max(accuracy / FINER, LEAST)
            state, left = self._rested(accuracy)
            mean, unit = path.held(state)
            changed = abs(mean - path.held(before)[0])
            error = interpreted(stated_error)(changed, 0.5 * unit * left, 0.0)
            if error <= self.tolerance or accuracy <= LEAST:
                return PeriodicMotion(state, math.nan, mean, error, math.nan, ModelWord.AT_REST)

    def _rested(self, accuracy: float) -> tuple[Floats, float]:
        """Return the state in which the motion has died out, but for so much of its way. Raises NotFound."""
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
            left = way * rate / (1.0 - rate) if rate < 1.0 else math.inf if way > 1e-15 else 0.0
            if left <= enough:
                return state, left
            # bristles creep on the errors of steps: where the way does not shrink they may be what is left of it
            if len(ways) % SHRINKING == 0 and way > 0.5 * ways[-SHRINKING]:
                accuracy = max(accuracy / FINER, LEAST)
        raise NotFound(f"the mass still swings: {path.whereabouts(state)}")

    def orbit(self, motion: PeriodicMotion) -> Orbit | None:
        """Orbit of the motion; of one that stands still, over 2 pi; none of one that takes too many steps."""
        if motion.kind in (ModelWord.AT_REST, ModelWord.SLIDES):
            x = motion.state[0] / math.sqrt(self._path.mass.stiffness)
            return orbit_at_one_place(x, motion.mean, motion.kind == ModelWord.AT_REST)
        turns = motion.period / TURN if math.isfinite(motion.period) else 1.0
        try:
            found, _ = self.recorded(motion.state, turns)
        except NotFound:
            return None
        return found if motion.long is None else replace(found, periods=round(turns))

    def recorded(self, state: Floats, turns: float) -> tuple[Orbit, Floats]:
        """Record so many turns from a state, and the state after them. Raises NotFound."""
        accuracy = min(max(0.1 * self.tolerance, LEAST), self._accuracy)
        # steps of order eight, the most accurate, are as long as a swing: sixteen times finer they are shown well
        accuracy = max(accuracy / FINER, LEAST) if self.law.count() == 0 else accuracy
        span = self._path.follow(state, turns, accuracy, PANELS_AT_FIRST)
        track = span.track
        parts = track.tau, track.x, track.v, track.friction, track.stick
        return Orbit(*(part[: track.filled[0]] for part in parts)), np.asarray(span.end)

    def from_the_start(self, turns: int) -> list[Orbit]:
        """Record the motion from the start, turn by turn. Raises ValueError for one that cannot be followed."""
        state, found = self._path.start, list[Orbit]()
        try:
            for turn in range(turns):
                orbit, state = self.recorded(state, 1.0)
                found.append(replace(orbit, tau=orbit.tau + turn * TURN))
        except NotFound as problem:
            raise ValueError(str(problem)) from None
        return found


def means_of(passages: Sequence[Passage]) -> Floats:
    """Return numbers whose mean is that of friction over all passages, and whose scatter is that of the passages."""
    turns = np.array([each.turns for each in passages])
    impulses = np.array([each.impulse for each in passages]) / -TURN
    mean = impulses.sum() / turns.sum()
    return np.asarray(mean + (impulses - mean * turns) / turns.mean())


def solve_undriven(scenes: Sequence[Scene], law: FrictionLaw, tolerance: float) -> Answers:
    """Answer undriven scenes, each by the state it reaches from its start."""
    ledger, multipliers = Ledger(len(scenes)), np.full(len(scenes), np.nan)
    found: dict[int, tuple[Undriven, PeriodicMotion]] = {}
    for i, scene in enumerate(each_told(scenes)):
        undriven = Undriven(scene, law, tolerance)
        motion, ledger.seconds[i] = undriven.motion_or_why_not()
        if isinstance(motion, str):
            ledger.fail(i, motion)
            continue
        long, said = motion.long, motion.long.sentence(motion.turns, FREE) if motion.long else ""
        if long is not None and not is_earned(motion.error, scene, law, tolerance):
            ledger.fail(i, f"{said}; {too_wide(motion.mean, motion.error)}")
            continue
        found[i] = undriven, motion
        ledger.accept(i, motion.mean, motion.error, math.nan if long else motion.period / TURN)
        ledger.model[i], ledger.reason[i], multipliers[i] = motion.kind, said, motion.multiplier
        if long is not None:
            ledger.error_kind[i], ledger.window[i] = STATISTICAL, motion.turns
        elif not motion.error <= tolerance:
            ledger.remark(i, f"the error is above the tolerance {tolerance:.1e}")
    return ledger.answers(
        floquet=lambda: multipliers,
        orbit=lambda i: found[i][0].orbit(found[i][1]) if i in found else None,
    )
