"""Motion of an undriven mass: spans of it, its passages of a level, and the cycle next to a passage.

An oscillation passes the middle of its swing at its fastest. From one such passage against the belt to the next
the motion is a map, however long that takes. Newton's method closes a cycle of this map, with the period as one
more unknown.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from typing import Any, NamedTuple

import numpy as np

from frictionlab.compile.call import KernelCall, MadeByKernel
from frictionlab.compile.decorators import inner
from frictionlab.compile.interpret import interpreted
from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.periodic.attraction import KnownOrbit, obeys
from frictionlab.methods.periodic.fixed_point import FINER, stated_error
from frictionlab.methods.periodic.period_map import size_of, start_of, unit_of_scalars
from frictionlab.methods.periodic.problem import largest_modulus
from frictionlab.methods.periodic.setting import Maps, Setting, maps_of, recorded_map
from frictionlab.motion.equation import (
    START,
    belt_velocity,
    equilibrium,
    mean_friction,
    restoring_force,
    runs_away,
    slopes_at,
)
from frictionlab.motion.maps.sliding import MOST_STEPS
from frictionlab.motion.orbit.recorder import Track, track_of
from frictionlab.scene.body import BodyNumbers, Mass, on_the_line
from frictionlab.scene.scene import Scene
from frictionlab.theory.rest import friction_at_rest
from frictionlab.theory.sliding_stability import loses_energy, steady_deflection
from frictionlab.values.quantities import Floats

TURN = 2.0 * math.pi
"""Period of the free mass."""
FOLLOWED, ROUGH, QUOTIENTS, LEAST = 1e-8, 1e-9, 1e-11, 1e-14
"""Accuracies of maps, per normal load: of those that follow the motion, of those for difference quotients on the way
and in the end, and the one beyond which rounding decides."""
SHIFTED = 1e-4
"""Share of a state by which it is shifted for a difference quotient."""
SHORT, LITTLE_LEFT = (1e-1, 1e-2, 1e-3, 1e-4, 1e-5), 0.2
"""Turns over which growth is a quotient: the first in which no more of a distance is lost than down to this share."""
SPEEDING_UP = 1e-12
"""Time after which a start is seen that has no acceleration: slip has a direction by then."""
MOST_WORK = 2_000_000
"""Steps after which no motion is followed any longer, some seconds of them."""
PANELS_AT_FIRST, MOST_PANELS = 128, 131072
"""Panels that a track has room for at first, and the most."""


@dataclass
class Effort:
    """Cost of following a motion so far [steps], its length [turns], and kernel time [s]."""

    work: int = 0
    turns: float = 0.0
    seconds: float = 0.0


class NotFound(Exception):
    """No periodic motion; the message says why."""


class TooMuchWork(NotFound):
    """None within ``MOST_WORK`` steps."""


class TooLong(NotFound):
    """A span takes too many steps."""


class Span(NamedTuple):
    """One span of the motion: its end, the integral of friction, the time at rest, when rest ended last (-1: it did
    not), the slowest slip, the steps (-1: it gave up), and where there is room the track."""

    end: Any
    impulse: float
    stuck: float
    released: float
    slowest: float
    steps: int
    track: Track


@inner
def follow_undriven(
    maps: Maps, belt_speed: float, turns: float, state: Any, accuracy: float, room: int
) -> Span:
    """Return the motion from a state over so many turns, on a track with so much room at first."""
    setting, end, track = Setting(maps, belt_speed, turns), np.empty(state.size), track_of(room)
    image = recorded_map(setting, state, end, accuracy, track)
    # how many panels there are is known once they are written: a full track may lack some
    while 0 < track.stick.size == track.filled[0] < MOST_PANELS:
        track = track_of(4 * track.stick.size)
        image = recorded_map(setting, state, end, accuracy, track)
    for row in range(state.size):
        end[row] = state[row] + end[row]
    rests = image.stuck, image.released
    return Span(end, image.friction_impulse.real, *rests, image.closest, image.steps, track)


@dataclass(frozen=True)
class UndrivenPath:
    """An undriven scene and a law; states are those of ``period_map``, times turns of the free mass."""

    scene: Scene
    law: FrictionLaw
    effort: Effort = field(default_factory=Effort)

    @cached_property
    def mass(self) -> Mass:
        """Return the numbers of the scene."""
        return self.scene.mass()

    @cached_property
    def speed(self) -> float:
        """Speed of the belt, which does not vibrate."""
        return float(interpreted(belt_velocity)(self._body, self.scene.belt_speed, START))

    @property
    def side(self) -> float:
        """1 or -1: the direction in which the belt moves."""
        return math.copysign(1.0, self.speed)

    @cached_property
    def _body(self) -> BodyNumbers:
        return on_the_line(self.mass)

    @cached_property
    def _maps(self) -> MadeByKernel:
        # steps by the path are explicit: none is longer than a swing of the mass on its bristle
        return MadeByKernel(maps_of, self.law, self._body)

    @cached_property
    def size(self) -> int:
        """Size of a state."""
        return int(interpreted(size_of)(self.law, 0.0))

    # --- states ---

    def _state(self, x: float, v: float, memory: float) -> Floats:
        """Memory: the deflection of a bristle, else the slip velocity of the steady sliding that is remembered."""
        state = np.empty(self.size)
        interpreted(start_of)(self.law, self._body, state, x, v, memory)
        return state

    @cached_property
    def start(self) -> Floats:
        """Bristles and springs undeflected; scalars as in steady sliding on this belt."""
        start = self.scene.start
        slides = -self.speed if self.law.memory_kind == "scalars" else 0.0
        # what neither slips nor accelerates is looked at a moment later, when the belt has stretched its spring
        still = self.law.count() > 0 and start.x == 0.0 and start.velocity == self.speed
        moment = SPEEDING_UP if still else 0.0
        return self._state(start.x + moment * self.speed, start.velocity, slides)

    @cached_property
    def sliding_friction(self) -> float:
        """Its mean coefficient along x1, on this belt."""
        return math.copysign(self.law.sliding_friction(abs(self.speed)), self.speed)

    @cached_property
    def sliding(self) -> Floats:
        """Steady sliding."""
        x = interpreted(equilibrium)(self._body, self.mass.normal_load * self.sliding_friction, 0.0)
        bristle = self.law.memory_kind == "bristle"
        return self._state(x, 0.0, steady_deflection(self.law, -self.speed) if bristle else -self.speed)

    @cached_property
    def release(self) -> Floats:
        """Return where rest ends, and slip begins."""
        limit = math.copysign(self.mass.normal_load * friction_at_rest(self.law), self.speed)
        return self._state(interpreted(equilibrium)(self._body, limit, self.speed), self.speed, 0.0)

    def held(self, state: Floats) -> tuple[float, float]:
        """Return the mean friction of a mass that rests in a state, and by how much it changes with that position."""
        scale, body = math.sqrt(self.mass.stiffness), self._body
        x, unit = float(state[0]) / scale, 1.0 / self.mass.normal_load
        slope = interpreted(slopes_at)(body, x, 0.0)
        rise = float(slope.stiffness_mean + slope.stiffness_split) / scale
        return unit * float(interpreted(restoring_force)(body, x, 0.0)), unit * abs(rise)

    def from_sliding(self, state: Floats) -> float:
        """Distance to steady sliding."""
        return float(np.linalg.norm(state - self.sliding))

    @cached_property
    def growth(self) -> float:
        """Largest growth rate of a small distance to steady sliding [1/time], from quotients over a short time."""
        for turns in SHORT:
            matrix = self.quotients(self.sliding, partial(self._after, turns))
            multipliers = np.abs(np.linalg.eigvals(matrix))
            if multipliers.min() > LITTLE_LEFT:
                break
        return float(np.log(multipliers.max())) / (turns * TURN)

    def _after(self, turns: float, state: Floats) -> Floats:
        return np.asarray(self.follow(state, turns, QUOTIENTS).end)

    def quotients(self, state: Floats, image: Callable[[Floats], Floats], first: int = 0) -> Floats:
        """Return the derivative of an image at a state by its numbers from ``first`` on. Raises NotFound."""
        whole = np.zeros((self.size, self.size))
        for row, shift in list(enumerate(self.shifts(state)))[first:]:
            step = np.zeros(self.size)
            step[row] = shift
            ahead, behind = image(state + step), image(state - step)
            if (
                np.isnan(ahead).any() != np.isnan(behind).any()
            ):  # a motion on one side alone goes on like this one
                here = image(state)
                ahead = 2.0 * here - behind if np.isnan(ahead).any() else ahead
                behind = 2.0 * here - ahead
            whole[:, row] = (ahead - behind) / (2.0 * shift)
        return whole

    def loses_energy(self, state: Floats) -> bool:
        """Check that every motion with no more energy than this one loses it, down to steady sliding."""
        linear = self.law.count() == 0 and not self.mass.bends
        return linear and loses_energy(self.mass, self.law, self.speed, self.from_sliding(state))

    # --- the motion ---

    def follow(self, state: Floats, turns: float, accuracy: float = FOLLOWED, room: int = 0) -> Span:
        """So many turns, on a track with so much room. Raises NotFound, TooLong where shorter spans may do."""
        span: Span
        accuracy *= self.mass.normal_load
        arguments = self._maps, self.scene.belt_speed, float(turns), state, accuracy, room
        span, seconds = KernelCall(follow_undriven).timed(*arguments)
        self.effort.seconds += seconds
        self.effort.work += span.steps if span.steps >= 0 else MOST_STEPS
        if span.steps < 0 and interpreted(runs_away)(self._body, float(span.end[0])):
            raise NotFound(f"the motion runs away: {self.whereabouts(state)}")
        if span.steps < 0 or not np.isfinite(span.end).all() or span.track.filled[0] == MOST_PANELS:
            raise TooLong(
                f"friction is too steep near rest for {MOST_STEPS:,} steps: {self.whereabouts(state)}"
            )
        if self.effort.work > MOST_WORK:
            raise TooMuchWork(f"no steady state within {MOST_WORK:,} steps: {self.whereabouts(state)}")
        return span

    def whereabouts(self, state: Floats) -> str:
        """Return how far the motion has come."""
        x = state[0] / math.sqrt(self.mass.stiffness)
        return (
            f"after {self.effort.turns:.3g} periods of the free mass it is at x = {x:.6g} "
            f"with velocity {state[1]:.6g}"
        )

    def shifts(self, state: Floats) -> Floats:
        """Return shifts small against what a state is, and against what it is away from steady sliding."""
        far = np.abs(self.sliding) + np.abs(state - self.sliding)
        far[1] = abs(state[1] - self.speed)  # friction jumps where slip turns round, and only there
        if self.law.count() == 0:
            far[0] = far[1]
        if self.law.memory_kind == "scalars":  # coordinates that are logarithms where they are small
            unit = float(interpreted(unit_of_scalars)(self.law, self._body, 0.0))
            far[2:] = np.maximum(np.abs(state[2:]), unit)
        far[far == 0.0] = far.max()
        shifts: Floats = SHIFTED * far
        return shifts


# --- from passage to passage ----------------------------------------------------------------------------------------

FIRST_SPAN, LONGEST = 2.0, 1e15
"""Turns of the first span in which a passage is looked for, and turns without one after which none is."""
SHORTER, FEW_STEPS = 0.05, 5000
"""Length of a span followed anew, over that of one that took too many steps; steps of one that may be longer."""
BEFORE = 0.9
"""Turns of the first span of a passage, over those of the last passage: what comes behind is followed twice."""
BESIDE = 1e-3
"""Distance from which a motion that nears steady sliding ends there, over the speed of the belt and over friction."""
FRICTION_SPREAD = 1e-4
"""Largest distance of friction from that of sliding, over it, of a motion that nothing else brakes."""
SWINGS_BESIDE, PATIENCE = 3, 4.0
"""Largest deflections without a passage between them after which the level moves to their middle, if none has come
for so many times as the last took."""
WELL_WITHIN = 0.1
"""Share of a swing by which the level lies within it."""
LOST = 1e3
"""Distance to steady sliding at which nothing is known of the direction, over the error of a map."""
AT_LEVEL = 1e-3
"""Largest distance from the level, over the error of a map."""


class Passage(NamedTuple):
    """Passage of the level against the belt, and the motion since the one before.

    turns, impulse: duration, and integral of friction. low, high: smallest and largest deflection along the belt.
    fastest: quickest slip.
    """

    state: Floats
    turns: float
    impulse: float
    low: float
    high: float
    fastest: float


class Settled(NamedTuple):
    """Motion that passes no more: it ends in steady sliding, or swings ``freely`` about it."""

    state: Floats
    freely: bool


@dataclass
class Passages:
    """Map of a motion from one passage of the level to the next.

    conserves: whether nothing but friction other than that of sliding takes energy. level: position along the belt;
    that of steady sliding at first. usual: turns that a passage takes.
    """

    path: UndrivenPath
    accuracy: float
    conserves: bool = False
    level: float = math.nan
    usual: float = FIRST_SPAN

    def __post_init__(self) -> None:
        if math.isnan(self.level):
            self.level = self.path.side * float(self.path.sliding[0]) / self._root

    @property
    def _root(self) -> float:
        return math.sqrt(self.path.mass.stiffness)

    @property
    def noise(self) -> float:
        """Error of a map."""
        return self.accuracy * self.path.mass.normal_load

    def size(self, state: Floats) -> float:
        """Return the distance of a state to steady sliding."""
        return self.path.from_sliding(state)

    def price(self, state: Floats) -> float:
        """Return 0: a passage takes steps for one turn at most."""
        return 0.0

    def mapped(self, states: Floats) -> Floats:
        """Return the next passage of each state; NaN where there is none."""
        found = np.full_like(states, math.nan)
        for row in np.flatnonzero(np.isfinite(states).all(axis=1)):
            end = self.next(states[row])
            found[row] = end.state if isinstance(end, Passage) else math.nan
        return found

    def derivative(self, state: Floats, passages: int = 1, accuracy: float = ROUGH) -> Floats:
        """Return the derivative of the map of so many passages, by quotients; NaN where there is none."""

        def image(start: Floats) -> Floats:
            found = self.around(start, passages, min(accuracy, self.accuracy))
            return np.full_like(start, math.nan) if found is None else found.state

        return self.path.quotients(state, image, first=1)

    def around(self, state: Floats, passages: int, accuracy: float) -> Passage | None:
        """Return so many passages as one, by maps of an accuracy; None where there are fewer. The level stays."""
        map_, found = replace(self, accuracy=accuracy), list[Passage]()
        while len(found) < passages:
            one = map_.next(found[-1].state if found else state)
            if isinstance(one, Settled) or map_.level != self.level:
                return None
            found.append(one)
        turns, impulse = sum(each.turns for each in found), sum(each.impulse for each in found)
        return found[-1]._replace(turns=turns, impulse=impulse)

    def next(self, state: Floats) -> Passage | Settled:
        """Follow a motion to its next passage; where it swings beside the level, move that. Raises NotFound."""
        path, turns, impulse, length = self.path, 0.0, 0.0, BEFORE * self.usual
        low, high, fastest, spread, rises = math.inf, -math.inf, 0.0, 0.0, False
        longest, swings, least, most = math.inf, 0, math.inf, -math.inf
        while turns < LONGEST:
            try:
                span = path.follow(state, length, self.accuracy, PANELS_AT_FIRST)
            except TooLong:
                if length <= FIRST_SPAN:
                    raise
                length = longest = SHORTER * length
                continue
            tau, x, v = self._along(span.track)
            found = self._first_passage(x, v, rises)
            spread = max(spread, self._friction_off_sliding(span.track))
            if self.conserves and spread <= FRICTION_SPREAD and (found >= 0 or turns + length >= 1.0):
                return Settled(span.end, True)
            till = slice(0, found + 1) if found >= 0 else slice(None)
            low, high = min(low, x[till].min()), max(high, x[till].max())
            fastest = max(fastest, np.abs(v[till] - abs(path.speed)).max())
            if found >= 0:
                before = path.follow(state, tau[found], self.accuracy) if tau[found] > 0.0 else None
                end, late = self._at_level(before.end if before else state, tau[found + 1] - tau[found])
                turns += tau[found] + late
                impulse += end.impulse + (before.impulse if before else 0.0)
                self.usual = turns
                if self._stays(state, end.end):
                    return Settled(end.end, False)
                return Passage(end.end, turns, impulse, float(low), float(high), float(fastest))
            if self._stays(state, span.end):
                return Settled(span.end, False)
            tops = np.flatnonzero((v[:-1] > 0.0) & (v[1:] <= 0.0))
            if tops.size or swings:  # what comes behind the first largest deflection
                part, swings = x[tops[0] :] if not swings else x, swings + tops.size
                least, most = min(least, part.min()), max(most, part.max())
            if swings >= SWINGS_BESIDE and turns > PATIENCE * self.usual:
                self.level = 0.5 * float(least + most)
            rises = rises or bool((v > 0.0).any())
            state, turns, impulse = span.end, turns + length, impulse + span.impulse
            # as long as the last passage took, and a little: then ever longer, while spans take few steps
            if turns <= self.usual:
                length = min(longest, (1.05 - BEFORE) * self.usual)
            elif span.steps < FEW_STEPS:
                length = min(longest, 2.0 * length)
        raise NotFound(f"no steady state within {turns:.0e} periods: {path.whereabouts(state)}")

    def center(self, last: Passage) -> bool:
        """Move the level to the middle of the last swing, unless it is well within; return whether it moved."""
        room = WELL_WITHIN * (last.high - last.low)
        if last.low + room < self.level < last.high - room:
            return False
        self.level = 0.5 * (last.low + last.high)
        return True

    def _along(self, track: Track) -> tuple[Floats, Floats, Floats]:
        """Return the times of a track, and position and velocity along the belt."""
        filled, side = track.filled[0], self.path.side
        tau, x, v = (part[:filled].ravel() for part in (track.tau, track.x.real, track.v.real))
        return tau / TURN, side * x, side * v

    def _first_passage(self, x: Floats, v: Floats, rises: bool) -> int:
        """Return the node before the first passage after a motion along the belt; -1 for none."""
        rising = [0] if rises else np.flatnonzero(v > 0.0)
        falls = np.flatnonzero((x[:-1] > self.level) & (x[1:] <= self.level) & (v[1:] < 0.0))
        falls = falls[falls >= rising[0]] if len(rising) else falls[:0]
        return int(falls[0]) if len(falls) else -1

    def _at_level(self, first: Floats, within: float) -> tuple[Span, float]:
        """Return the span from a state to the level, which it reaches within so many turns, and its turns."""
        level, side = self.level * self._root, self.path.side
        low, high, at = 0.0, within, within
        while True:
            end = self.path.follow(first, at, self.accuracy)
            left, speed = side * float(end.end[0]) - level, side * TURN * self._root * float(end.end[1])
            if abs(left) <= AT_LEVEL * self.noise or high - low <= 1e-14 * (1.0 + within):
                end.end[0] = side * level
                return end, at
            if left > 0.0:
                low, high = at, max(high, 1.01 * at)  # the end of the track was that of other steps
            else:
                high = at
            at = at - left / speed if speed < 0.0 else low
            if not low < at < high:
                at = 0.5 * (low + high)

    def _friction_off_sliding(self, track: Track) -> float:
        """Return the largest distance of friction from that of sliding, over it unless it is zero."""
        friction, sliding = -track.friction.real[: track.filled[0]], self.path.sliding_friction
        off = float(np.abs(friction - sliding).max())
        return off / abs(sliding) if sliding else math.inf if off else 0.0

    def _stays(self, before: Floats, after: Floats) -> bool:
        """Check that a motion ends in steady sliding: it nears it, and is so near that friction is linear."""
        path = self.path
        near = BESIDE * np.abs(path.sliding)
        near[0] = BESIDE * path.mass.normal_load * abs(path.sliding_friction)
        near[1] = BESIDE * abs(path.speed)
        near[near == 0.0] = near[0]
        if path.loses_energy(after):
            return True
        close = bool((np.abs(after - path.sliding) <= near).all())
        away = path.from_sliding(after)
        return close and path.growth < 0.0 and away <= max(path.from_sliding(before), LOST * self.noise)


# --- cycles ---------------------------------------------------------------------------------------------------------

REPELS = 1.05
"""Multiplier of a cycle that surely repels."""
COARSEST_CLOSED = 1e-6
"""Coarsest accuracy of maps that close a cycle, per normal load."""
MOST_NEWTON, MOST_DERIVATIVES = 16, 4
"""Steps of Newton's method, and how often derivatives are found anew for them."""
CHANCE = 0.15
"""Share of the difference between the two coarser means that stands in where the two finer agree by chance."""
BESIDE_CYCLE = 3.0
"""Distance of a motion to a cycle, over what is left of its way, up to which it may be on its way there."""
RETURN_DISTANCE = 0.05
"""Distance to its end at which a motion closes a cycle [distances to sliding]."""
CONVERGED_DISTANCE, STRONGLY_DISTANCE = 1e-6, 3e-5
"""Distance to what attracts a motion at which it is there without further proof; and to what halves its distance
each time, where the steps on the way may leave it farther off."""
MOST_RETURNS = 8
"""Most passages in one period."""


def nears(orbit: KnownOrbit, before: Floats, after: Floats) -> bool:
    """Check that a motion comes nearer to an orbit from one state to another as the derivative there says."""
    predicted = np.empty(before.size)
    return bool(interpreted(obeys)(orbit, before - orbit.state, after - orbit.state, predicted))


class Cycle(NamedTuple):
    """Cycle from a passage: its period [turns], mean friction and the error of that.

    matrix: derivative of the map of its passages. size: distance to steady sliding.
    """

    state: Floats
    turns: float
    mean: float
    error: float
    matrix: Floats
    passages: int
    size: float

    @property
    def multiplier(self) -> float:
        """Return the largest modulus of the multipliers, without the trivial one."""
        return float(largest_modulus(self.matrix[None])[0])

    @property
    def orbit(self) -> KnownOrbit:
        """As kernels see it."""
        return KnownOrbit(self.state, self.matrix, 1.0 - self.multiplier)

    def has(self, state: Floats) -> bool:
        """Check that a state is so near to the cycle, which attracts, that the motion ends on it."""
        gap = 1.0 - self.multiplier
        share = STRONGLY_DISTANCE if gap > 0.5 else CONVERGED_DISTANCE
        return bool(gap > CONVERGED_DISTANCE and np.linalg.norm(state - self.state) < share * self.size)

    def is_beside(self, state: Floats, left: float) -> bool:
        """Check that a motion that is so far from its end may be on its way to the cycle, or away from it."""
        return bool(np.linalg.norm(state - self.state) < BESIDE_CYCLE * left)

    def neared(self, passages: list[Passage]) -> bool:
        """Check that the last period of a motion led to it, which attracts, or nearer as its derivative says."""
        last = passages[-1].state
        return self.has(last) or (
            len(passages) > self.passages and nears(self.orbit, passages[-1 - self.passages].state, last)
        )


def close_cycle(section: Passages, state: Floats, passages: int, tolerance: float) -> Cycle | None:
    """Return the cycle of so many passages beside one; None where none is found. One that repels has no error.

    Its mean is that of the last of three or more closed cycles, each of maps FINER times finer than the one before.
    Raises NotFound.
    """
    coarsest = accuracy = max(min(tolerance, COARSEST_CLOSED), LEAST)
    means, found, matrix = list[float](), None, section.derivative(state, passages)
    while True:
        one = _newton(section, state, passages, matrix, accuracy)
        # finer than rounding allows: the third of three is then a coarser one
        last = one is None and len(means) > 1
        if last:
            one = _newton(section, state, passages, matrix, coarsest * FINER)
        if one is None and (means or accuracy <= section.accuracy):
            return None
        if one is not None and last:
            means.insert(0, one.mean)
        elif one is not None:
            found = one if means else one._replace(matrix=section.derivative(one.state, passages))
            if not found.multiplier < REPELS:
                return found._replace(error=math.nan)
            means.append(found.mean)
            state, matrix, within = found.state, found.matrix, accuracy
        if found is not None and len(means) > 2:
            changed = max(abs(means[-1] - means[-2]), CHANCE * abs(means[-2] - means[-3]))
            steps = 10.0 * within / (found.turns * TURN)
            error = interpreted(stated_error)(changed, 0.5 * found.error, steps)
            if last or error <= tolerance or accuracy <= LEAST:
                # derivatives that closed it are those of the guess, or of a step on the way
                fine = section.derivative(found.state, passages, QUOTIENTS)
                return found._replace(error=error, matrix=fine)
        accuracy = max(accuracy / FINER, LEAST)


def close_shortest(section: Passages, state: Floats, passages: int, tolerance: float) -> Cycle | None:
    """Return the same; where it is a shorter cycle over again, the shorter."""
    found = close_cycle(section, state, passages, tolerance)
    if found is None:
        return None
    for fewer in range(1, passages):
        end = section.around(found.state, fewer, FOLLOWED) if passages % fewer == 0 else None
        if end is not None and found.has(end.state):
            return close_cycle(section, found.state, fewer, tolerance)
    return found


def _newton(section: Passages, state: Floats, passages: int, matrix: Floats, accuracy: float) -> Cycle | None:
    """Return the cycle by maps of one accuracy, its error what the last step has moved the mean by.

    matrix: derivative of the map, which is made anew where steps shrink too slowly.
    """
    path, mean, size, derivatives = section.path, math.nan, math.inf, 0
    noise, far = accuracy * path.mass.normal_load, path.from_sliding(state)
    for count in range(MOST_NEWTON):
        try:
            image = section.around(state, passages, accuracy)
        except TooLong:
            return None
        if image is None or not np.isfinite(matrix).all():
            return None
        before, mean = mean, float(interpreted(mean_friction)(image.impulse, image.turns * TURN))
        step = np.linalg.pinv(np.eye(path.size) - matrix) @ (image.state - state)
        last, size = size, float(np.abs(step).max())
        if not size < far:
            return None
        # steps that shrink no more are what the steps of a map jump about by
        if count > 0 and size <= 1e3 * noise and (size <= noise or size > 0.3 * last):
            # steady sliding comes back after any time, and motions next to it nearly do
            away = path.from_sliding(state)
            found = Cycle(state, image.turns, mean, abs(mean - before), matrix, passages, away)
            return found if away > 1e3 * (size + noise) else None
        state = state + step
        if size > 0.3 * last:
            derivatives += 1
            if derivatives > MOST_DERIVATIVES:
                return None
            matrix = section.derivative(state, passages)
    return None
