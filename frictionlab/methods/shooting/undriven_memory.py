"""What an undriven mass does in the long run on a contact with memory: steady sliding, a cycle, or rest.

The motion is followed from scene.initial until it nears steady sliding as the derivative of its map says, or until
two largest deflections, those beyond steady sliding, are nearly the same state. A cycle is then closed by Newton's
method on what the motion makes of such a state in one period; the velocity there is zero, and in its place the period
is the unknown. A cycle counts where small disturbances leave it no more and the motion from the start nears it.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from frictionlab.compile.call import KernelCall
from frictionlab.compile.decorators import inner
from frictionlab.compile.interpret import interpreted
from frictionlab.dynamics.motion import mean_friction
from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.periodic.case import case_of
from frictionlab.methods.periodic.fixed_point import FINER, ROUNDING
from frictionlab.methods.periodic.period_map import period_map, size_of, start_of
from frictionlab.methods.shooting.undriven_motion import (
    AT_REST,
    FREE,
    SLIDING,
    TURN,
    Effort,
    NotFound,
    PeriodicMotion,
)
from frictionlab.orbit.record import Orbit
from frictionlab.orbit.recorder import Track, track_of
from frictionlab.quantities import Floats
from frictionlab.scene.body import Body, Mass, on_the_line
from frictionlab.scene.scene import Scene
from frictionlab.theory.sliding_stability import steady_deflection

LOOK = 2.0
"""Turns between looks at where the motion leads."""
ROUGH, COARSE = 1e-8, 1e-6
"""Accuracy of the maps that follow the motion, per normal load, and the coarsest of those that close a cycle."""
FINEST = 1e-14
"""Accuracy, per normal load, beyond which rounding decides."""
FINE, SHIFT = 1e-11, 1e-4
"""Accuracy, per normal load, of maps for difference quotients, and the share of a state that they shift it by."""
AT_ONCE, MOMENT = 1e-12, 1e-7
"""Time after which a start is seen that has no acceleration: slip has a direction by then. Turns, over which rates are
quotients."""
MOST_WORK = 2_000_000
"""Steps after which no motion is followed any longer, some seconds of them."""
MOST_NEWTON = 16
ROOM = 128
"""Panels that a track has room for at first."""
NEAR, CLOSE = 0.05, 1e-6
"""How near to each other two deflections are worth closing a cycle from [amplitudes]; how near a motion must come to
what attracts it to be there without further proof."""
PATIENCE = 10, 30, 100, 300, 1000
"""Counts of returns at which a cycle is looked for however far apart they are."""
LONGEST, MOST_PEAKS = 4, 8
"""Returns in one period, and those asked for between two looks, at most."""
AGREED, ENOUGH = 0.1, 3
"""How far a motion may be from what the derivative of its map says, as a share of how it changes; and looks in a row
after which it is believed."""
KEPT = 0.15
"""Of the difference between the two coarser means, stands in where the two finer agree by chance."""
STICKING = 1e-2
"""Of the belt speed: slower slip is called stick."""
MOST_TURNS, RESTING = 5000, 4
"""Turns after which a mass that still swings on a belt at rest is given up, and those by which its decay is judged."""


class Span(NamedTuple):
    """One span of the motion: its end, the integral of friction, the slowest slip, the steps (-1: it gave up), and
    where there is room the track."""

    end: Any
    impulse: float
    slowest: float
    steps: int
    track: Track


@inner
def follow_undriven(law: Any, body: Body, belt_speed: float, state: Any, accuracy: float, room: int) -> Span:
    """The motion from a state over the span of the body, on a track with so much room at first."""
    case, end, track = case_of(law, body, belt_speed), np.empty(state.size), track_of(room)
    image = period_map(case, state, end, accuracy, track)
    # how many panels there are is known once they are written: a full track may lack some
    while 0 < track.stick.size == track.filled[0]:
        track = track_of(4 * track.stick.size)
        image = period_map(case, state, end, accuracy, track)
    for row in range(state.size):
        end[row] = state[row] + end[row]
    return Span(end, image.rubbed, image.closest, image.steps, track)


class Still(NamedTuple):
    """Steady sliding as a state, and the derivative of the motion there, from one look to the next."""

    state: Floats
    matrix: Floats

    @property
    def gap(self) -> float:
        """One less its largest multiplier."""
        return 1.0 - _radius(self.matrix)


class Return(NamedTuple):
    """A largest deflection beyond steady sliding, and when it was reached [turns]."""

    state: Floats
    turns: float


class Reach(NamedTuple):
    """The deflections between which a motion went, from some turn on."""

    turns: float
    low: float
    high: float


class Loop(NamedTuple):
    """A cycle from a largest deflection: its period [turns] and mean, and the derivative from each one to the next."""

    state: Floats
    turns: float
    mean: float
    error: float
    matrix: Floats


class Linear(NamedTuple):
    """Rates of the state at a largest deflection, the derivative from each to the next, and Newton's inverse of it."""

    rates: Floats
    matrix: Floats
    inverse: Floats


@dataclass(frozen=True)
class UndrivenMemory:
    """An undriven scene and a law with memory, followed through time."""

    scene: Scene
    law: FrictionLaw
    tolerance: float
    effort: Effort = field(default_factory=Effort)
    _tried: dict[int, float] = field(default_factory=dict)

    @cached_property
    def _mass(self) -> Mass:
        return self.scene.mass()

    @cached_property
    def _body(self) -> Body:
        return on_the_line(self._mass)

    @cached_property
    def _kernel(self) -> KernelCall:
        return KernelCall(follow_undriven, self.law)

    @cached_property
    def _size(self) -> int:
        return int(interpreted(size_of)(self.law, 0.0))

    @property
    def _speed(self) -> float:
        """Of the belt."""
        return self.scene.belt_speed

    # --- the motion, followed ---

    def _follow(self, state: Floats, turns: float, accuracy: float = ROUGH, room: int = 0) -> Span:
        """So many turns, on a track with so much room. Raises NotFound."""
        body, load = self._body._replace(periods=turns), self._mass.normal_load
        span: Span
        span, seconds = self._kernel.timed(body, self._speed, state, accuracy * load, room)
        self.effort.seconds += seconds
        self.effort.work += span.steps
        if span.steps < 0 or not np.isfinite(span.end).all():
            raise NotFound(f"no step is short enough: {self._whereabouts(state)}")
        if self.effort.work > MOST_WORK:
            raise NotFound(f"no steady state within {MOST_WORK:,} steps: {self._whereabouts(state)}")
        return span

    def _quotients(self, state: Floats, turns: float) -> Floats:
        """The derivative of the state after so many turns by the one before."""
        columns = []
        for row, shift in enumerate(self._shifts(state)):
            step = np.zeros(self._size)
            step[row] = shift
            ahead, behind = (self._follow(state + side * step, turns, FINE).end for side in (1.0, -1.0))
            columns.append((ahead - behind) / (2.0 * shift))
        return np.array(columns).T

    def _shifts(self, state: Floats) -> Floats:
        """Small against what a state is, and what it is away from steady sliding."""
        still = self._sliding_state
        shifts: Floats = SHIFT * (np.abs(still) + np.abs(state - still)) + SHIFT**2 * abs(self._speed)
        shifts[1] = SHIFT * abs(self._speed)
        return shifts

    def _whereabouts(self, state: Floats) -> str:
        x, v = state[0] / math.sqrt(self._mass.stiffness), state[1]
        return (
            f"after {self.effort.turns:.3g} periods of the free mass it is at x = {x:.6g} "
            f"with velocity {v:.6g}"
        )

    # --- states ---

    def _state(self, x: float, v: float, memory: float) -> Floats:
        """Memory: the deflection of a bristle, else the slip velocity of the steady sliding that is remembered."""
        state = np.empty(self._size)
        interpreted(start_of)(self.law, self._body, state, x, v, memory)
        return state

    @cached_property
    def _start(self) -> Floats:
        """Bristles and springs undeflected; scalars as in steady sliding on this belt."""
        start = self.scene.start
        slides = -self._speed if self.law.memory_kind == "scalars" else 0.0
        # what neither slips nor accelerates is looked at a moment later, when the belt has stretched its spring
        moment = AT_ONCE if start.x == 0.0 and start.velocity == self._speed else 0.0
        return self._state(start.x + moment * self._speed, start.velocity, slides)

    @cached_property
    def _sliding_friction(self) -> float:
        """Its mean coefficient, along x1."""
        return math.copysign(self.law.sliding_friction(abs(self._speed)), self._speed)

    @property
    def _deflection(self) -> float:
        """Of the spring in steady sliding."""
        return self._mass.normal_load * self._sliding_friction / self._mass.stiffness

    @cached_property
    def _sliding_state(self) -> Floats:
        bristle = self.law.memory_kind == "bristle"
        memory = steady_deflection(self.law, -self._speed) if bristle else -self._speed
        return self._state(self._deflection, 0.0, memory)

    @cached_property
    def _still(self) -> Still:
        """Steady sliding. Raises NotFound."""
        return Still(self._sliding_state, self._quotients(self._sliding_state, LOOK))

    def _from_still(self, state: Floats) -> Floats:
        return state - self._sliding_state

    # --- where it leads ---

    def motion(self) -> PeriodicMotion:
        """The motion reached from the start. Raises NotFound."""
        if self._speed == 0.0:
            return self._at_rest()
        state, turns, steady = self._start, 0.0, 0
        returns, loops, reaches = list[Return](), list[Loop](), list[Reach]()
        while True:
            span = self._follow(state, LOOK, room=ROOM)
            steady = steady + 1 if self._nears_sliding(state, span.end) else 0
            if steady >= ENOUGH or self._is_still(span.end):
                return self._sliding()
            if self._conserves and self._slides_freely(span.track):
                return self._free(span.end)
            reaches.append(_reach(turns, span.track))
            if len(returns) > 2:  # no further back than two returns
                reaches = [one for one in reaches if one.turns > returns[-3].turns - LOOK]
            for peak in self._peaks(state, span.track, _middle(reaches)) if not self._conserves else ():
                returns.append(Return(peak.state, turns + peak.turns))
                loop = self._loop(returns, loops)
                if loop is not None:
                    return self._cycle(loop)
            state, turns = span.end, turns + LOOK
            self.effort.turns = turns

    def _is_still(self, state: Floats) -> bool:
        """Whether the motion has come so near to steady sliding, which attracts, that it ends there."""
        near = CLOSE * (1.0 + float(np.linalg.norm(self._still.state)))
        return self._still.gap > CLOSE and float(np.linalg.norm(self._from_still(state))) < near

    def _nears_sliding(self, before: Floats, after: Floats) -> bool:
        """Whether the motion from one look to the next nears steady sliding as the derivative there says."""
        still = self._still
        return _obeys(still.matrix, still.gap, self._from_still(before), self._from_still(after))

    @property
    def _conserves(self) -> bool:
        """Whether nothing but a friction other than that of sliding takes energy: there is no cycle but a free one."""
        return self._mass.damping == 0.0 and self.law.constant_sliding_friction()

    def _slides_freely(self, track: Track) -> bool:
        """Whether friction is that of sliding, to little."""
        friction = -track.friction.real[: track.filled[0]]
        return bool(np.abs(friction - self._sliding_friction).max() <= 1e-4 * abs(self._sliding_friction))

    def _sliding(self) -> PeriodicMotion:
        mean = self._sliding_friction
        return PeriodicMotion(self._still.state, math.nan, mean, ROUNDING, math.nan, SLIDING)

    def _free(self, state: Floats) -> PeriodicMotion:
        """Friction stays that of sliding: the oscillation on which the motion comes to end, no faster than the belt."""
        swing = self._from_still(state)[:2]
        swing *= min(1.0, abs(self._speed) / math.hypot(*swing))
        state = self._still.state.copy()
        state[:2] += swing
        return PeriodicMotion(state, TURN, self._sliding_friction, ROUNDING, 1.0, FREE)

    # --- largest deflections ---

    def _peaks(self, state: Floats, track: Track, middle: float) -> Iterator[Return]:
        """The largest deflections in a motion from a state, those beyond the middle of what it goes through."""
        side, filled = math.copysign(1.0, self._speed), track.filled[0]
        tau, v = track.tau[:filled].ravel() / TURN, side * track.v.real[:filled].ravel()
        beyond = side * (track.x.real[:filled].ravel() - middle) > 0.0
        for i in np.flatnonzero((v[:-1] > 0.0) & (v[1:] <= 0.0) & beyond[1:])[:MOST_PEAKS]:
            first = self._follow(state, tau[i]).end if tau[i] > 0.0 else state
            peak = self._peak(first, tau[i + 1] - tau[i])
            yield Return(peak.state, tau[i] + peak.turns)

    def _peak(self, first: Floats, within: float) -> Return:
        """The largest deflection within so many turns from a state that nears it."""
        side = math.copysign(1.0, self._speed)
        # Illinois: of the false positions, the end that stays is given half its weight
        low, high, below, above = 0.0, within, side * first[1], math.nan
        at, end = within, first
        for _ in range(30):
            end = self._follow(first, at).end
            if abs(end[1]) <= ROUGH * abs(self._speed) or high - low < 1e-12:
                break
            if side * end[1] > 0.0:
                low, below, above = at, side * end[1], 0.5 * above
                high = max(high, 1.01 * at)  # the end of the track was that of coarser steps
            else:
                high, above, below = at, side * end[1], 0.5 * below
            at = (low * above - high * below) / (above - below) if above < 0.0 else high
        return Return(end, at)

    def _loop(self, returns: list[Return], loops: list[Loop]) -> Loop | None:
        """The cycle that the motion nears, where that is sure; loops: those known so far, one more where it is new."""
        for loop in loops:
            if self._nears(returns, loop):
                return loop
        last = returns[-1]
        size = float(np.linalg.norm(self._from_still(last.state)))
        for back in range(1, min(LONGEST, len(returns) - 1) + 1):
            before = returns[-1 - back]
            apart = float(np.linalg.norm(last.state - before.state))
            # closing is costly: again only where the returns have come much nearer to each other
            near = min(NEAR * size, 0.25 * self._tried.get(back, math.inf))
            if apart < near or (back == 1 and len(returns) in PATIENCE):
                self._tried[back] = apart
                loop = self._closed(last.state, last.turns - before.turns)
                if loop is not None and not any(_same(loop, other) for other in loops):
                    loops.append(loop)
                    return loop if self._nears(returns, loop) else None
        return None

    def _nears(self, returns: list[Return], loop: Loop) -> bool:
        """Whether the last period of the motion comes nearer to a cycle as its derivative says, or is there."""
        gap, last = 1.0 - _radius(loop.matrix), returns[-1]
        if not gap > CLOSE:
            return False
        after = last.state - loop.state
        if float(np.linalg.norm(after)) < CLOSE * (1.0 + float(np.linalg.norm(loop.state))):
            return True
        periods = [last.turns - one.turns for one in returns[-1 - LONGEST : -1]]
        starts = [
            one
            for one, period in zip(returns[-1 - LONGEST : -1], periods, strict=True)
            if abs(period - loop.turns) < NEAR * loop.turns
        ]
        return bool(starts) and _obeys(loop.matrix, gap, starts[-1].state - loop.state, after)

    # --- a cycle ---

    def _closed(self, state: Floats, turns: float) -> Loop | None:
        """The cycle next to a largest deflection that comes back after so many turns; None where there is none.

        Its mean is that of three closed cycles, each of maps FINER times finer than the one before.
        """
        accuracy, means, error = max(min(self.tolerance, COARSE), FINEST), list[float](), math.inf
        at = Loop(
            np.where(np.arange(self._size) == 1, 0.0, state), turns, math.nan, math.inf, np.empty((0, 0))
        )
        linear = self._linearized(at)
        while True:
            found, linear = self._newton(at, linear, accuracy)
            if found is None:
                return None
            means.append(found.mean)
            if len(means) > 2:
                error = 2.0 * max(abs(means[-1] - means[-2]), KEPT * abs(means[-2] - means[-3])) + found.error
                error += 10.0 * accuracy / (found.turns * TURN) + ROUNDING
            if error <= self.tolerance or accuracy <= FINEST:
                return found._replace(error=error, matrix=linear.matrix)
            at, accuracy = found, max(accuracy / FINER, FINEST)

    def _newton(self, at: Loop, linear: Linear, accuracy: float) -> tuple[Loop | None, Linear]:
        """The same by maps of one accuracy; the error is what the last step has moved the mean by."""
        (state, turns, mean, _, _), size = at, math.inf
        for count in range(MOST_NEWTON):
            span = self._follow(state, turns, accuracy)
            before, mean = mean, float(interpreted(mean_friction)(span.impulse, turns * TURN))
            # to the section along the motion
            late = -span.end[1] / linear.rates[1]
            step = linear.inverse @ (span.end + late * linear.rates - state)
            step[1] = 0.0
            last, size = size, float(np.abs(step).max()) + abs(late)
            if not size < 1.0 + np.abs(state).max():
                break
            # steps that shrink no more are what the steps of a map jump about by
            if count > 0 and size <= 1e3 * accuracy and (size <= accuracy or size > 0.3 * last):
                apart = float(np.linalg.norm(self._from_still(state)))
                # steady sliding comes back after any time, and motions next to it, too
                found = Loop(state, turns, mean, abs(mean - before), linear.matrix)
                return found if apart > 1e3 * (size + accuracy) else None, linear
            state, turns = state + step, turns + late / TURN
            if not turns > 0.0:
                break
            if size > 0.3 * last:
                linear = self._linearized(at._replace(state=state, turns=turns))
        return None, linear

    def _linearized(self, at: Loop) -> Linear:
        rates: Floats = (self._follow(at.state, MOMENT, FINEST).end - at.state) / (MOMENT * TURN)
        whole = self._quotients(at.state, at.turns)
        matrix = whole - np.outer(rates, whole[1]) / rates[1]
        matrix[:, 1] = 0.0
        return Linear(rates, matrix, np.linalg.pinv(np.eye(self._size) - matrix))

    def _cycle(self, loop: Loop) -> PeriodicMotion:
        period = loop.turns * TURN
        rests = self._follow(loop.state, loop.turns).slowest < STICKING * abs(self._speed)
        kind = "a cycle of stick and slip" if rests else "a cycle of slip without rest"
        multiplier = _radius(loop.matrix)
        return PeriodicMotion(loop.state, period, loop.mean, loop.error, multiplier, kind)

    # --- rest ---

    def _at_rest(self) -> PeriodicMotion:
        """On a belt at rest the spring keeps what friction holds when the motion has died out."""
        if self.scene.start.x == self.scene.start.velocity == 0.0:
            return PeriodicMotion(self._start, math.nan, 0.0, ROUNDING, math.nan, AT_REST)
        accuracy = max(0.1 * self.tolerance, FINEST)
        # where it ends depends on every step of the way: twice, the second time much finer
        (rough, _), (fine, left) = (self._rested(each) for each in (accuracy, accuracy / FINER))
        unit = math.sqrt(self._mass.stiffness) / self._mass.normal_load
        mean, error = unit * fine[0], unit * (2.0 * abs(fine[0] - rough[0]) + left) + ROUNDING
        return PeriodicMotion(fine, math.nan, float(mean), float(error), math.nan, AT_REST)

    def _rested(self, accuracy: float) -> tuple[Floats, float]:
        """The state in which the motion has died out, but for a rest of its way, also returned. Raises NotFound."""
        state, ways = self._start, list[float]()
        enough = 0.1 * self.tolerance * self._mass.normal_load
        for _ in range(MOST_TURNS):
            span = self._follow(state, 1.0, accuracy, ROOM)
            state = span.end
            # positions in a state are of the norm of energy, too
            x = math.sqrt(self._mass.stiffness) * span.track.x.real[: span.track.filled[0]]
            way = float(np.abs(np.diff(x.ravel())).sum())
            ways.append(way)
            self.effort.turns += 1.0
            # what is left shrinks, turn by turn, as it did over the last ones
            rate = (
                (ways[-1] / ways[-1 - RESTING]) ** (1.0 / RESTING)
                if len(ways) > RESTING and way > 0.0
                else 1.0
            )
            left = way * rate / (1.0 - rate) if rate < 1.0 else math.inf
            if way <= 1e-15 or left <= enough:
                return state, min(left, enough)
        raise NotFound(f"the mass still swings: {self._whereabouts(state)}")

    def orbit(self, motion: PeriodicMotion) -> Orbit:
        """The orbit of the motion; of one that stands still, over 2 pi."""
        turns = motion.period / TURN if math.isfinite(motion.period) else 1.0
        track = self._follow(motion.state, turns, max(0.1 * self.tolerance, FINEST), ROOM).track
        parts = track.tau, track.x, track.v, track.friction, track.stick
        return Orbit(*(part[: track.filled[0]] for part in parts))


def _reach(turns: float, track: Track) -> Reach:
    x = track.x.real[: track.filled[0]]
    return Reach(turns, float(x.min()), float(x.max()))


def _middle(reaches: list[Reach]) -> float:
    """Of the deflections that a motion went through."""
    return 0.5 * (min(one.low for one in reaches) + max(one.high for one in reaches))


def _radius(matrix: Floats) -> float:
    return float(np.abs(np.linalg.eigvals(matrix)).max())


def _same(one: Loop, other: Loop) -> bool:
    size = 1.0 + float(np.linalg.norm(one.state))
    return float(np.linalg.norm(one.state - other.state)) < CLOSE * size


def _obeys(matrix: Floats, gap: float, before: Floats, after: Floats) -> bool:
    """Whether a distance became another as the derivative says, to a part of what makes all of them shrink."""
    predicted = matrix @ before
    missed = float(np.linalg.norm(predicted - after))
    changed, size = float(np.linalg.norm(predicted - before)), float(np.linalg.norm(before))
    return gap > 0.0 and missed <= AGREED * changed and missed <= 0.5 * gap * size
