"""The motion of an undriven mass, span by span, and its largest deflections."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from frictionlab.compile.call import Held, KernelCall
from frictionlab.compile.decorators import inner
from frictionlab.compile.interpret import interpreted
from frictionlab.dynamics.motion import (
    START,
    belt_velocity,
    equilibrium,
    restoring_force,
    runs_away,
    slopes_at,
)
from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.periodic.maps.sliding import MOST_STEPS
from frictionlab.methods.periodic.period_map import start_of, whole_size_of
from frictionlab.methods.periodic.setting import Maps, Setting, held_maps, recorded_map
from frictionlab.orbit.recorder import Track, track_of
from frictionlab.quantities import Floats
from frictionlab.scene.body import BodyNumbers, Mass, on_the_line
from frictionlab.scene.scene import Scene
from frictionlab.theory.rest import friction_at_rest
from frictionlab.theory.sliding_stability import steady_deflection
from frictionlab.theory.springs import mass_of

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
    def _maps(self) -> Held:
        return held_maps(self.law, self._body)

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
