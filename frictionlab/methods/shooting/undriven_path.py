"""The motion of an undriven mass, span by span, and its largest deflections.

The cycle next to a largest deflection, by Newton's method on the map from one largest deflection to the next.

The velocity is zero there, and what the motion lacks of it after a period is made up for by a change of the period.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from frictionlab.compile.call import KernelCall, MadeByKernel
from frictionlab.compile.decorators import inner
from frictionlab.compile.interpret import interpreted
from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.periodic.attraction import KnownOrbit, obeys
from frictionlab.methods.periodic.fixed_point import FINER, stated_error
from frictionlab.methods.periodic.period_map import start_of, whole_size_of
from frictionlab.methods.periodic.setting import Maps, Setting, recorded_map, table_of_maps
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
from frictionlab.theory.sliding_stability import steady_deflection
from frictionlab.theory.springs import mass_of
from frictionlab.values.quantities import Floats

TURN = 2.0 * math.pi
"""The period of the free mass."""
FOLLOWED, QUOTIENTS, LEAST = 1e-8, 1e-11, 1e-14
"""Accuracies of maps, per normal load: of those that follow the motion, of those for difference quotients, and the
one beyond which rounding decides."""
SHIFTED = 1e-4
"""Share of a state by which it is shifted for a difference quotient."""
SPEEDING_UP = 1e-12
"""Time after which a start is seen that has no acceleration: slip has a direction by then."""
MOST_WORK = 2_000_000
"""Steps after which no motion is followed any longer, some seconds of them."""
MOST_CLOSING = MOST_WORK // 2
"""Of these, steps after which no cycle is looked for any longer: a motion that goes on is averaged."""
PANELS_AT_FIRST = 128
"""Panels that a track has room for at first."""
MOST_PEAKS = 8
"""Largest deflections that are looked for in one span."""


@dataclass
class Effort:
    """What following a motion has taken so far [steps], and closing cycles of that, how far it has led [turns], and
    kernel time [s]."""

    work: int = 0
    closing: int = 0
    turns: float = 0.0
    seconds: float = 0.0


class NotFound(Exception):
    """No periodic motion; the message says why."""


class TooMuchWork(NotFound):
    """None within ``MOST_WORK`` steps."""


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
    """The motion from a state over so many turns, on a track with so much room at first."""
    setting, end, track = Setting(maps, belt_speed, turns), np.empty(state.size), track_of(room)
    image = recorded_map(setting, state, end, accuracy, track)
    # how many panels there are is known once they are written: a full track may lack some
    while 0 < track.stick.size == track.filled[0]:
        track = track_of(4 * track.stick.size)
        image = recorded_map(setting, state, end, accuracy, track)
    for row in range(state.size):
        end[row] = state[row] + end[row]
    rests = image.stuck, image.released
    return Span(end, image.friction_impulse.real, *rests, image.closest, image.steps, track)


class Return(NamedTuple):
    """A largest deflection, and when it was reached [turns]."""

    state: Floats
    turns: float


@dataclass(frozen=True)
class UndrivenPath:
    """An undriven scene and a law; states are those of ``period_map``, times turns of the free mass."""

    scene: Scene
    law: FrictionLaw
    effort: Effort = field(default_factory=Effort)

    @cached_property
    def mass(self) -> Mass:
        """The numbers of the scene."""
        return mass_of(self.scene)

    @cached_property
    def speed(self) -> float:
        """Of the belt, which does not vibrate."""
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
        return table_of_maps(self.law, self._body)

    @cached_property
    def size(self) -> int:
        """Of a state."""
        return int(interpreted(whole_size_of)(self.law, self._body, 0.0))

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
        """Where rest ends, and slip begins."""
        limit = math.copysign(self.mass.normal_load * friction_at_rest(self.law), self.speed)
        return self._state(interpreted(equilibrium)(self._body, limit, self.speed), self.speed, 0.0)

    def held(self, state: Floats) -> tuple[float, float]:
        """The mean friction of a mass that rests in a state, and by how much it changes with that position."""
        scale, body = math.sqrt(self.mass.stiffness), self._body
        x, unit = float(state[0]) / scale, 1.0 / self.mass.normal_load
        slope = interpreted(slopes_at)(body, x, 0.0)
        rise = float(slope.stiffness_mean + slope.stiffness_split) / scale
        return unit * float(interpreted(restoring_force)(body, x, 0.0)), unit * abs(rise)

    def from_sliding(self, state: Floats) -> float:
        """Distance to steady sliding."""
        return float(np.linalg.norm(state - self.sliding))

    # --- the motion ---

    def follow(self, state: Floats, turns: float, accuracy: float = FOLLOWED, room: int = 0) -> Span:
        """So many turns, on a track with so much room. Raises NotFound."""
        span: Span
        accuracy *= self.mass.normal_load
        arguments = self._maps, self.scene.belt_speed, float(turns), state, accuracy, room
        span, seconds = KernelCall(follow_undriven).timed(*arguments)
        self.effort.seconds += seconds
        self.effort.work += span.steps
        if span.steps < 0 and interpreted(runs_away)(self._body, float(span.end[0])):
            raise NotFound(f"the motion runs away: {self.whereabouts(state)}")
        if span.steps < 0 or not np.isfinite(span.end).all():
            raise NotFound(
                f"friction is too steep near rest for {MOST_STEPS:,} steps: {self.whereabouts(state)}"
            )
        if self.effort.work > MOST_WORK:
            raise TooMuchWork(f"no steady state within {MOST_WORK:,} steps: {self.whereabouts(state)}")
        return span

    def whereabouts(self, state: Floats) -> str:
        """How far the motion has come."""
        x = state[0] / math.sqrt(self.mass.stiffness)
        return (
            f"after {self.effort.turns:.3g} periods of the free mass it is at x = {x:.6g} "
            f"with velocity {state[1]:.6g}"
        )

    def quotients(self, state: Floats, turns: float) -> Floats:
        """The derivative of the state after so many turns by the one before. Raises NotFound."""
        columns = []
        for row, shift in enumerate(self._shifts(state)):
            step = np.zeros(self.size)
            step[row] = shift
            ahead, behind = (self.follow(state + part, turns, QUOTIENTS).end for part in (step, -step))
            columns.append((ahead - behind) / (2.0 * shift))
        return np.array(columns).T

    def _shifts(self, state: Floats) -> Floats:
        """Small against what a state is, and against what it is away from steady sliding."""
        far = np.abs(self.sliding) + np.abs(state - self.sliding) + SHIFTED * abs(self.speed)
        far[1] = abs(self.speed)
        if self.law.count() == 0:  # friction jumps where slip turns round, and only there
            far[0] = far[1]
        shifts: Floats = SHIFTED * far
        return shifts

    # --- largest deflections ---

    def peaks(self, state: Floats, track: Track, middle: float) -> Iterator[Return]:
        """The largest deflections in the motion from a state, those beyond the middle. Raises NotFound."""
        filled = track.filled[0]
        tau, v = track.tau[:filled].ravel() / TURN, self.side * track.v.real[:filled].ravel()
        beyond = self.side * (track.x.real[:filled].ravel() - middle) > 0.0
        for i in np.flatnonzero((v[:-1] > 0.0) & (v[1:] <= 0.0) & beyond[1:])[:MOST_PEAKS]:
            first = self.follow(state, tau[i]).end if tau[i] > 0.0 else state
            peak = self._peak(first, tau[i + 1] - tau[i])
            yield Return(peak.state, float(tau[i]) + peak.turns)

    def _peak(self, first: Floats, within: float) -> Return:
        """The largest deflection within so many turns from a state that nears it."""
        # Illinois: of the false positions, the end that stays is given half its weight
        low, high, below, above = 0.0, within, self.side * first[1], math.nan
        at, end = within, first
        for _ in range(30):
            end = self.follow(first, at).end
            if abs(end[1]) <= FOLLOWED * abs(self.speed) or high - low < 1e-12:
                break
            if self.side * end[1] > 0.0:
                low, below, above = at, self.side * end[1], 0.5 * above
                high = max(high, 1.01 * at)  # the end of the track was that of other steps
            else:
                high, above, below = at, self.side * end[1], 0.5 * below
            at = (low * above - high * below) / (above - below) if above < 0.0 else high
        return Return(end, float(at))


COARSEST_CLOSED, OF_BELT_SPEED = 1e-6, 1e-5
"""The coarsest accuracy of maps that close a cycle, per normal load and per belt speed."""
INSTANT = 1e-7
"""Turns over which rates of a state are quotients."""
MOST_NEWTON, MOST_DERIVATIVES = 16, 4
"""Steps of Newton's method, and how often derivatives are found anew for them."""
CHANCE = 0.15
"""Of the difference between the two coarser means, stands in where the two finer agree by chance."""


RETURN_DISTANCE = 0.05
"""How near to each other two largest deflections must come to close a cycle from them [distances to sliding]."""
CONVERGED_DISTANCE, STRONGLY_DISTANCE = 1e-6, 3e-5
"""How near a motion must come to what attracts it to be there without further proof; and to what halves its distance
each time, where the steps on the way may leave it farther off."""
MOST_RETURNS = 4
"""Largest deflections in one period."""


def nears(orbit: KnownOrbit, before: Floats, after: Floats) -> bool:
    """Whether a motion comes nearer to an orbit from one state to another as the derivative there says."""
    predicted = np.empty(before.size)
    return bool(interpreted(obeys)(orbit, before - orbit.state, after - orbit.state, predicted))


def is_there(orbit: KnownOrbit, state: Floats) -> bool:
    """Whether a state is so near to an orbit that attracts that the motion ends on it."""
    share = STRONGLY_DISTANCE if orbit.gap > 0.5 else CONVERGED_DISTANCE
    near = share * (1.0 + float(np.linalg.norm(orbit.state)))
    return bool(orbit.gap > CONVERGED_DISTANCE and float(np.linalg.norm(state - orbit.state)) < near)


class Cycle(NamedTuple):
    """A cycle from a largest deflection: its period [turns], mean friction and the error of that, and the derivative
    from each largest deflection to the next."""

    state: Floats
    turns: float
    mean: float
    error: float
    matrix: Floats

    @property
    def multiplier(self) -> float:
        """The largest modulus of the multipliers, without the trivial one."""
        return radius(self.matrix)

    @property
    def orbit(self) -> KnownOrbit:
        """As kernels see it."""
        return KnownOrbit(self.state, self.matrix, 1.0 - self.multiplier)

    def neared(self, returns: list[Return]) -> bool:
        """Whether it attracts and the last period of a motion led to it, or nearer to it as its derivative says."""
        orbit, last = self.orbit, returns[-1]
        if not orbit.gap > CONVERGED_DISTANCE:
            return False
        if is_there(orbit, last.state):
            return True
        a_period_ago = [
            one
            for one in returns[-1 - MOST_RETURNS : -1]
            if abs(last.turns - one.turns - self.turns) < RETURN_DISTANCE * self.turns
        ]
        return bool(a_period_ago) and nears(orbit, a_period_ago[-1].state, last.state)


class Linear(NamedTuple):
    """Rates of a largest deflection, the derivative from each to the next, and Newton's inverse of that."""

    rates: Floats
    matrix: Floats
    inverse: Floats


def radius(matrix: Floats) -> float:
    """The largest modulus of the eigenvalues."""
    return float(np.abs(np.linalg.eigvals(matrix)).max())


def close_cycle(path: UndrivenPath, guess: Return, tolerance: float) -> Cycle | None:
    """The cycle near a largest deflection that comes back after about so many turns; None where none is found.

    Its mean is that of the last of three or more closed cycles, each of maps FINER times finer than the one before.
    Raises NotFound.
    """
    coarsest = min(COARSEST_CLOSED, OF_BELT_SPEED * abs(path.speed) / path.mass.normal_load)
    accuracy, means, error = max(min(tolerance, coarsest), LEAST), list[float](), math.inf
    state = guess.state.copy()
    state[1] = 0.0
    at = Cycle(state, guess.turns, math.nan, math.inf, np.empty((0, 0)))
    linear = _linearize(path, at)
    while True:
        found, linear = _newton(path, at, linear, accuracy)
        if found is None:
            return None
        means.append(found.mean)
        if len(means) > 2:
            changed = max(abs(means[-1] - means[-2]), CHANCE * abs(means[-2] - means[-3]))
            steps = 10.0 * accuracy / (found.turns * TURN)
            error = interpreted(stated_error)(changed, 0.5 * found.error, steps)
        if error <= tolerance or accuracy <= LEAST:
            # derivatives that closed it are those of the guess, or of a step on the way
            return found._replace(error=error, matrix=_linearize(path, found).matrix)
        at, accuracy = found, max(accuracy / FINER, LEAST)


def close_shortest(path: UndrivenPath, guess: Return, loops: int, tolerance: float) -> Cycle | None:
    """The same of a guess that goes from largest deflection to largest deflection so many times: where the cycle
    found is a shorter one over again, that."""
    found = close_cycle(path, guess, tolerance)
    if found is None:
        return None
    for parts in range(loops, 1, -1):
        end = path.follow(found.state, found.turns / parts).end
        if loops % parts == 0 and is_there(found.orbit, end):
            return close_cycle(path, Return(found.state, found.turns / parts), tolerance)
    return found


def _newton(path: UndrivenPath, at: Cycle, linear: Linear, accuracy: float) -> tuple[Cycle | None, Linear]:
    """The cycle by maps of one accuracy, its error what the last step has moved the mean by; the derivatives used."""
    (state, turns, mean, _, _), size, derivatives = at, math.inf, 0
    for count in range(MOST_NEWTON):
        span = path.follow(state, turns, accuracy)
        before, mean = mean, float(interpreted(mean_friction)(span.impulse, turns * TURN))
        # along the motion, until the velocity is zero
        late = -float(span.end[1] / linear.rates[1])
        step = linear.inverse @ (span.end + late * linear.rates - state)
        step[1] = 0.0
        # as a way in the states: where the motion lingers at its largest deflection, the instant is hardly known
        last, size = size, float(np.abs(step).max() + abs(late) * np.abs(linear.rates).max())
        if not size < 1.0 + np.abs(state).max():
            break
        # steps that shrink no more are what the steps of a map jump about by
        if count > 0 and size <= 1e3 * accuracy and (size <= accuracy or size > 0.3 * last):
            # steady sliding comes back after any time, and motions next to it nearly do
            apart = path.from_sliding(state) > 1e3 * (size + accuracy)
            return Cycle(state, turns, mean, abs(mean - before), linear.matrix) if apart else None, linear
        state, turns = state + step, turns + late / TURN
        if not turns > 0.0:
            break
        if size > 0.3 * last:
            derivatives += 1
            if derivatives > MOST_DERIVATIVES:
                break
            linear = _linearize(path, at._replace(state=state, turns=turns))
    return None, linear


def _linearize(path: UndrivenPath, at: Cycle) -> Linear:
    rates: Floats = (path.follow(at.state, INSTANT, LEAST).end - at.state) / (INSTANT * TURN)
    whole = path.quotients(at.state, at.turns)
    # from one largest deflection to the next, not from one instant to another: along the motion
    matrix = whole - np.outer(rates, whole[1]) / rates[1]
    matrix[:, 1] = 0.0
    return Linear(rates, matrix, np.linalg.pinv(np.eye(path.size) - matrix))
