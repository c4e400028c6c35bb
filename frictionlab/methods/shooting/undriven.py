"""What an undriven mass does in the long run, followed through time: steady sliding, a cycle, or rest.

The motion is followed from scene.initial until it nears steady sliding as the derivative there says, or until its
largest deflections come back: from them a cycle is closed, whose period is an unknown. Either counts where small
disturbances do not leave it and the motion from the start nears it. Without memory rest leaves one motion to go on
with, from the one deflection at which the spring overcomes friction, and energy may tell steady sliding beforehand.
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
from frictionlab.methods.base import STATISTICAL, Answers, Status
from frictionlab.methods.periodic.attraction import ENOUGH, KnownOrbit
from frictionlab.methods.periodic.fixed_point import FINER, ROUNDING, stated_error
from frictionlab.methods.shooting.long_mean import (
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
    MOST_CLOSING,
    MOST_RETURNS,
    PANELS_AT_FIRST,
    RETURN_DISTANCE,
    TURN,
    Cycle,
    Effort,
    NotFound,
    Return,
    Span,
    TooMuchWork,
    UndrivenPath,
    close_shortest,
    is_there,
    nears,
    radius,
)
from frictionlab.methods.under_way import each_told, once
from frictionlab.methods.words import ModelWord
from frictionlab.motion.equation import mean_friction
from frictionlab.motion.orbit.record import Orbit
from frictionlab.motion.orbit.recorder import NODES, Track
from frictionlab.scene.scene import Scene
from frictionlab.theory.sliding_stability import loses_energy
from frictionlab.values.quantities import Floats

BETWEEN_LOOKS, PIECE = 2.0, 0.125
"""Turns between looks at where the motion leads, and between looks for rest."""
LOOKS_AVERAGED, FEWEST_LOOKS = (512, 1024, 2048), 128
"""Counts of looks after which a motion that comes to nothing is averaged, and the fewest that are."""
TURNS_SHOWN, NEARLY_ALL = (64.0, 256.0, 1024.0), 0.9
"""Turns of such a motion from which columns other than the mean are read: the fewest in which its slip is nearly as
quick as over all, by this share."""
TRIALS = 10, 30, 100, 300, 1000
"""Counts of largest deflections after which a cycle is looked for however far apart they are."""
FRICTION_SPREAD = 1e-4
"""Of sliding friction: how near to it friction must stay where nothing else takes energy from the motion."""
STICKING = 1e-2
"""Of the belt speed: slower slip is called stick."""
ACROSS = "friction of so quick a slip may feed a motion across the belt, which is not followed: leave transverse out"
MOST_TURNS, RESTING, SHRINKING = 5000, 4, 30
"""Turns after which a mass that still swings on a belt at rest is given up; those by which its decay is judged; and
those in which its way shrinks to half, or is followed by finer steps."""


class PeriodicMotion(NamedTuple):
    """A periodic motion from a state: its period, mean friction, error and largest multiplier, and what it is.

    long: of a motion that does not repeat, its mean, over so many turns. fastest: its slip meanwhile.
    """

    state: Floats
    period: float
    mean: float
    error: float
    multiplier: float
    kind: str
    long: LongMean | None = None
    turns: float = math.nan
    fastest: float = math.nan


class Reach(NamedTuple):
    """The deflections between which a motion went, from some turn on."""

    turns: float
    low: float
    high: float


@dataclass
class Way:
    """A motion so far: its largest deflections, where it went of late, and the cycles found beside it.

    means, states, fastest: the mean friction from each look to the next, where that ended, and the fastest slip.
    """

    returns: list[Return] = field(default_factory=list)
    reaches: list[Reach] = field(default_factory=list)
    cycles: list[Cycle] = field(default_factory=list)
    means: list[float] = field(default_factory=list)
    states: list[Floats] = field(default_factory=list)
    fastest: list[float] = field(default_factory=list)

    def note(self, span: Span, turns: float, speed: float) -> None:
        """One span more; those before the last two returns, or half of the way, are left out one at a time.

        speed: of the belt.
        """
        track = span.track
        self.means.append(mean_of(span))
        self.states.append(span.end)
        self.fastest.append(most_slip(track, speed))
        since = self.returns[-3].turns if len(self.returns) > 2 else 0.5 * turns
        if self.reaches and self.reaches[0].turns <= since - BETWEEN_LOOKS:
            del self.reaches[0]
        x = track.x.real[: track.filled[0]]
        self.reaches.append(Reach(turns, float(x.min()), float(x.max())))

    @property
    def middle(self) -> float:
        """Of the deflections it went through of late."""
        return 0.5 * (min(one.low for one in self.reaches) + max(one.high for one in self.reaches))


@dataclass(frozen=True)
class Undriven:
    """An undriven scene and a law, followed through time."""

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
        """Whether only friction other than that of sliding takes energy."""
        mass = self._path.mass
        elastic = mass.damping == 0.0 and not mass.bends and not mass.relaxing
        return elastic and self.law.constant_sliding_friction()

    @property
    def _forgets(self) -> bool:
        """Whether at rest nothing is left of the motion before."""
        return self.law.count() == 0 and not self.scene.remembers

    def motion(self) -> PeriodicMotion:
        """The motion reached from the start. Raises NotFound."""
        if self._path.speed == 0.0:
            return self._at_rest()
        way = Way()
        try:
            return self._followed(way)
        except TooMuchWork:
            if len(way.means) < FEWEST_LOOKS:
                raise
            self.effort.work = 0  # as much again for what the error needs
            motion = self._unrepeated(way)
            if motion is None:
                raise
            return motion

    def motion_or_why_not(self) -> tuple[PeriodicMotion | str, float]:
        """The motion, or why none was found, and kernel time [s]."""
        try:
            motion: PeriodicMotion | str = self.motion()
        except NotFound as problem:
            motion = str(problem)
        return motion, self.effort.seconds

    def _followed(self, way: Way) -> PeriodicMotion:
        """Where the motion from the start leads on a moving belt. Raises NotFound."""
        path = self._path
        state, turns, steady, forgets = path.start, 0.0, 0, self._forgets
        while True:
            if self._loses_energy(state):
                return self._sliding()
            span = path.follow(state, BETWEEN_LOOKS, room=PANELS_AT_FIRST)
            if span.stuck > 0.0 and forgets:
                motion = self._from_release()
                if motion is not None:
                    return motion
                state, forgets = path.release, False  # it does not rest again
                continue
            steady = steady + 1 if nears(self._still, state, span.end) else 0
            if steady >= ENOUGH or is_there(self._still, span.end):
                return self._sliding()
            if self._conserves and self._slides_freely(span.track):
                return self._free(span.end)
            cycle = self._cycle_neared(way, state, span, turns)
            if cycle is not None:
                return self._cycle(cycle)
            if len(way.means) in LOOKS_AVERAGED:
                motion, last = self._unrepeated(way), len(way.means) == LOOKS_AVERAGED[-1]
                if motion is not None and (last or motion.error <= max(self.tolerance, SMALL_ERROR)):
                    return motion
                if last:
                    raise NotFound(f"no steady state within {turns:.0f} periods: {path.whereabouts(state)}")
            state, turns = span.end, turns + BETWEEN_LOOKS
            self.effort.turns = turns

    # --- steady sliding ---

    def _sliding(self) -> PeriodicMotion:
        path = self._path
        return PeriodicMotion(
            path.sliding, math.nan, path.sliding_friction, ROUNDING, math.nan, ModelWord.SLIDES
        )

    def _loses_energy(self, state: Floats) -> bool:
        """Whether every motion with no more energy than this one loses it, down to steady sliding."""
        path = self._path
        linear = self.law.count() == 0 and not path.mass.bends
        return linear and loses_energy(path.mass, self.law, path.speed, path.from_sliding(state))

    def _slides_freely(self, track: Track) -> bool:
        """Whether friction is that of sliding, to little."""
        sliding = self._path.sliding_friction
        friction = -track.friction.real[: track.filled[0]]
        return bool(np.abs(friction - sliding).max() <= FRICTION_SPREAD * abs(sliding))

    def _free(self, state: Floats) -> PeriodicMotion:
        """The oscillation that the motion ends on, no faster than the belt: friction stays that of sliding."""
        path = self._path
        swing = state[:2] - path.sliding[:2]
        swing *= min(1.0, abs(path.speed) / math.hypot(*swing))
        state = path.sliding.copy()
        state[:2] += swing
        return PeriodicMotion(state, TURN, path.sliding_friction, ROUNDING, 1.0, ModelWord.SLIDES_FREELY)

    # --- from the end of rest, without memory ---

    def _from_release(self) -> PeriodicMotion | None:
        """The motion from the end of rest; None where the mass does not come to rest again."""
        release = self._path.release
        if self._conserves and self.law.monotone():
            return self._free(release)
        if self._loses_energy(release):
            return self._sliding()
        accuracy = max(0.1 * self.tolerance, LEAST)
        # twice, the second time much finer: the difference is the error
        rough, fine = (self._back_to_rest(part * accuracy) for part in (1.0, 1.0 / FINER))
        if rough is None or fine is None:
            return None
        (_, before), (turns, mean) = rough, fine
        # two step sizes may agree by chance: what one step of the finer motion may cost
        error = interpreted(stated_error)(abs(mean - before), 0.0, accuracy / FINER + 1e-12)
        return PeriodicMotion(release, turns * TURN, mean, error, 0.0, ModelWord.STICKS)

    def _back_to_rest(self, accuracy: float) -> tuple[float, float] | None:
        """Turns and mean friction from the end of rest to the next; None where the mass does not rest again.

        An orbit that closes one loop without sticking never sticks later.
        """
        path, state, turns, peaks = self._path, self._path.release, 0.0, 0
        patience = 10.0 * (1.0 + path.mass.damping)  # for one damped too heavily to have peaks
        while peaks < 3 and turns < patience:
            span = path.follow(state, PIECE, accuracy)
            if turns > 0.0 and span.stuck > 0.0:
                # else the belt carries the mass on to where slip began
                way = (path.release[0] - span.end[0]) / math.sqrt(path.mass.stiffness)
                left = span.released if span.released >= 0.0 else PIECE * TURN + way / path.speed
                turns += left / TURN
                whole = path.follow(path.release, turns, accuracy)
                return turns, float(interpreted(mean_friction)(whole.impulse, turns * TURN))
            peaks += 1 if path.side * state[1] > 0.0 >= path.side * span.end[1] else 0
            state, turns = span.end, turns + PIECE
        return None

    # --- cycles ---

    def _cycle_neared(self, way: Way, state: Floats, span: Span, turns: float) -> Cycle | None:
        """The cycle that the motion nears at one of the largest deflections of a span."""
        way.note(span, turns, self._path.speed)
        if self._conserves or self.effort.closing > MOST_CLOSING:
            return None
        before = self.effort.work
        for peak in self._path.peaks(state, span.track, way.middle):
            way.returns.append(Return(peak.state, turns + peak.turns))
            cycle = self._reached_cycle(way.returns, way.cycles)
            if cycle is not None:
                return cycle
        self.effort.closing += self.effort.work - before
        return None

    def _reached_cycle(self, returns: list[Return], cycles: list[Cycle]) -> Cycle | None:
        """The cycle that the motion surely nears; cycles: those found so far, one more where it is new."""
        for cycle in cycles:
            if cycle.neared(returns):
                return cycle
        last = returns[-1]
        size = self._path.from_sliding(last.state)
        for back in range(1, min(MOST_RETURNS, len(returns) - 1) + 1):
            before = returns[-1 - back]
            apart = float(np.linalg.norm(last.state - before.state))
            # closing is costly: again only where they have come much nearer to each other
            near = min(RETURN_DISTANCE * size, 0.25 * self._tried.get(back, math.inf))
            if apart < near or (back == 1 and len(returns) in TRIALS):
                self._tried[back] = apart
                guess = Return(last.state, last.turns - before.turns)
                found = close_shortest(self._path, guess, back, self.tolerance)
                if found is not None and not any(is_there(other.orbit, found.state) for other in cycles):
                    cycles.append(found)
                    return found if found.neared(returns) else None
        return None

    def _cycle(self, cycle: Cycle) -> PeriodicMotion:
        """Raises NotFound where a motion across the belt might grow."""
        span, speed = self._path.follow(cycle.state, cycle.turns, room=PANELS_AT_FIRST), self._path.speed
        self._check_across(most_slip(span.track, speed))
        kind = ModelWord.STICKS if span.slowest < STICKING * abs(speed) else ModelWord.SLIPS
        return PeriodicMotion(
            cycle.state, cycle.turns * TURN, cycle.mean, cycle.error, cycle.multiplier, kind
        )

    def _check_across(self, fastest: float) -> None:
        """Raises NotFound where slip of this speed may feed a motion across the belt."""
        if self.scene.degrees_of_freedom == 2 and not self.law.damps_across(fastest):
            raise NotFound(ACROSS)

    # --- motions that do not repeat ---

    def _unrepeated(self, way: Way) -> PeriodicMotion | None:
        """The motion by its long mean, the first quarter left out; None where it is on its way elsewhere still.

        Raises NotFound where a motion across the belt might grow.
        """
        first = len(way.means) // 4
        means, states = np.array(way.means[first:]), np.array(way.states[first - 1 :])
        if drifts(np.linalg.norm(states - self._path.sliding, axis=1)):
            return None
        self._check_across(max(way.fastest[first:]))
        found = long_mean([means])
        if found.quasi_periodic:  # nearer to each other than its parts are to the motion
            finer = self._means(states[0], len(means), self._accuracy / FINER)
            found = found._replace(error=found.error + 2.0 * abs(birkhoff_mean(finer) - birkhoff_mean(means)))
        turns = BETWEEN_LOOKS * len(means)
        return PeriodicMotion(
            states[-1],
            math.nan,
            found.mean,
            found.error,
            math.nan,
            ModelWord.NEVER_REPEATS,
            found,
            turns,
            max(way.fastest[first:]),
        )

    def _means(self, state: Floats, looks: int, accuracy: float) -> Floats:
        """Of friction from look to look."""
        means = np.empty(looks)
        for i in range(looks):
            span = self._path.follow(state, BETWEEN_LOOKS, accuracy)
            means[i], state = mean_of(span), span.end
        return means

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
            left = way * rate / (1.0 - rate) if rate < 1.0 else math.inf if way > 1e-15 else 0.0
            if left <= enough:
                return state, left
            # bristles creep on the errors of steps: where the way does not shrink they may be what is left of it
            if len(ways) % SHRINKING == 0 and way > 0.5 * ways[-SHRINKING]:
                accuracy = max(accuracy / FINER, LEAST)
        raise NotFound(f"the mass still swings: {path.whereabouts(state)}")

    def orbit(self, motion: PeriodicMotion) -> Orbit:
        """The orbit of the motion; of one that stands still, over 2 pi."""
        if motion.kind == ModelWord.AT_REST:
            x = motion.state[0] / math.sqrt(self._path.mass.stiffness)
            whole = np.ones((1, NODES.size), np.complex128)
            held = -motion.mean * whole
            return Orbit(0.5 * TURN * (NODES[None, :] + 1.0), x * whole, 0.0 * whole, held, np.array([True]))
        turns = motion.period / TURN if math.isfinite(motion.period) else 1.0
        if motion.long is not None:
            turns = self._turns_that_show(motion)
        accuracy = max(0.1 * self.tolerance, LEAST)
        # steps of order eight, the most accurate, are as long as a swing: sixteen times finer they are shown well
        accuracy = accuracy / FINER if self.law.count() == 0 else accuracy
        track = self._path.follow(motion.state, turns, accuracy, PANELS_AT_FIRST).track
        parts = track.tau, track.x, track.v, track.friction, track.stick
        found = Orbit(*(part[: track.filled[0]] for part in parts))
        return found if motion.long is None else replace(found, periods=int(turns))

    def _turns_that_show(self, motion: PeriodicMotion) -> float:
        """Turns of a motion that does not repeat in which its slip is as quick as it was over all."""
        for turns in TURNS_SHOWN[:-1]:
            track = self._path.follow(motion.state, turns, room=PANELS_AT_FIRST).track
            if most_slip(track, self._path.speed) >= NEARLY_ALL * motion.fastest:
                return turns
        return TURNS_SHOWN[-1]


def mean_of(span: Span) -> float:
    """The mean friction of one from a look to the next."""
    return float(interpreted(mean_friction)(span.impulse, BETWEEN_LOOKS * TURN))


def most_slip(track: Track, speed: float) -> float:
    """Of a motion, on a belt of this speed."""
    return float(np.abs(track.v.real[: track.filled[0]] - speed).max())


def solve_undriven(scenes: Sequence[Scene], law: FrictionLaw, tolerance: float) -> Answers:
    """Answer undriven scenes, each by the state it reaches from its start."""
    numbers = np.full((6, len(scenes)), np.nan)
    mean, error, period, window, multipliers, seconds = numbers
    status: list[Status] = ["failed"] * len(scenes)
    reason, model, kind = [""] * len(scenes), [""] * len(scenes), [""] * len(scenes)
    found: dict[int, tuple[Undriven, PeriodicMotion]] = {}
    for i, scene in enumerate(each_told(scenes)):
        undriven = Undriven(scene, law, tolerance)
        motion, seconds[i] = once(undriven.motion_or_why_not, scene.belt_speed)
        if isinstance(motion, str):
            reason[i] = motion
            continue
        if motion.long is not None and not is_earned(motion.error, law, tolerance):
            said = motion.long.sentence(motion.turns, FREE)
            reason[i] = f"{said}; {too_wide(motion.mean, motion.error)}"
            continue
        found[i] = undriven, motion
        status[i], model[i], kind[i] = "ok", motion.kind, "estimated"
        mean[i], error[i] = motion.mean, motion.error
        period[i], multipliers[i] = motion.period / TURN, motion.multiplier
        if motion.long is not None:
            kind[i], window[i] = STATISTICAL, motion.turns
            reason[i] = motion.long.sentence(motion.turns, FREE)
        elif not motion.error <= tolerance:
            reason[i] = f"the error is above the tolerance {tolerance:.1e}"
    return Answers(
        status=status,
        reason=reason,
        model=model,
        error_kind=kind,
        mean=mean,
        error=error,
        period=period,
        window=window,
        floquet=lambda: multipliers,
        seconds=seconds,
        orbit=lambda i: found[i][0].orbit(found[i][1]) if i in found else None,
    )
