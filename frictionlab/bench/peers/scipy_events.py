"""scipy's solve_ivp with its own event location: each reversal ends a leg, stick is handled between legs.

A mass under Coulomb friction along a line: the bookkeeping around an event integrator.

The integrator follows slip up to its end; what comes next, the impulse of friction and when the motion has closed
are settled here, in plain Python, as a user of such a library would.
"""

from __future__ import annotations

import cmath
import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from typing import ClassVar, Literal, NamedTuple

import numpy as np

from frictionlab.bench.peers.base import Peer, closed_mean
from frictionlab.bench.peers.equations import LEAST_RTOL, start
from frictionlab.laws.base import FrictionLaw
from frictionlab.scene.body import Mass
from frictionlab.scene.scene import Scene
from frictionlab.values.quantities import Floats

MOST_EVENTS = 10_000


class MotionState(NamedTuple):
    """Time, position and velocity."""

    t: float
    x: float
    v: float


class LineMotion(ABC):
    """One scene but belt speed, and a library that follows its motion leg by leg."""

    def __init__(self, mass: Mass, limit: float) -> None:
        self.mass, self.limit = mass, limit
        self.belt_speed = 0.0
        self.period = 2.0 * math.pi / mass.frequency

    @abstractmethod
    def slide(self, side: float, place: MotionState) -> tuple[MotionState, float]:
        """Slip with its sign, until it ends or the period is over, and the impulse of friction."""

    @abstractmethod
    def hold(self, place: MotionState) -> MotionState:
        """Stick, until the force to hold reaches the limit or the period is over."""

    def one_period(self, state: Floats) -> Floats:
        """Slip and stick in turn: x, v and the integral of the friction coefficient from t = 0 to the end."""
        place = MotionState(0.0, *state[:2].tolist())
        impulse, side = 0.0, self.side(place)
        for _ in range(MOST_EVENTS):
            if side == 0.0:
                end = self.hold(place)
                impulse += self.held_impulse(place, end)
                side = math.copysign(1.0, self.net(end))  # what ends stick is a force too large for it
            else:
                end, more = self.slide(side, place)
                impulse, side = impulse + more, self.side(end)
            place = end
            if self.period - place.t <= 1e-13 * self.period:
                return np.array([place.x, place.v, impulse / self.mass.normal_load])
        raise ArithmeticError(f"more than {MOST_EVENTS} legs in one period")

    def load(self, t: float) -> float:
        """Return the load."""
        return (self.mass.force * cmath.exp(1j * self.mass.frequency * t)).imag

    def net(self, place: MotionState) -> float:
        """Return the force that friction must balance in stick."""
        return self.load(place.t) - self.mass.damping * self.belt_speed - place.x

    def held_impulse(self, start: MotionState, end: MotionState) -> float:
        """Return the integral of ``net`` over a leg of stick."""
        turn = self.mass.force / (1j * self.mass.frequency)
        drive = (turn * cmath.exp(1j * self.mass.frequency * end.t)).imag
        drive -= (turn * cmath.exp(1j * self.mass.frequency * start.t)).imag
        constant = self.mass.damping * self.belt_speed + 0.5 * (start.x + end.x)
        return drive - constant * (end.t - start.t)

    def side(self, place: MotionState) -> float:
        """Return the sign of the slip, from zero slip that of the force too large to hold; 0 in stick."""
        slip = place.v - self.belt_speed
        if slip != 0.0:
            return math.copysign(1.0, slip)
        net = self.net(place)
        return math.copysign(1.0, net) if abs(net) > self.limit else 0.0


def means(line: LineMotion, scenes: Sequence[Scene], tolerance: float) -> Floats:
    """Return the mean friction of each scene, from the friction-free orbit until the period closes."""
    found, state = [], np.array([*start(line.mass)[:2], 0.0])
    enough = tolerance * line.mass.normal_load * line.period
    for scene in scenes:
        line.belt_speed = scene.belt_speed
        found.append(closed_mean(line.one_period, state, slice(0, 2), line.period, enough))
    return np.array(found)


def first_step(line: LineMotion, side: float, place: MotionState) -> MotionState:
    """A leg of slip begun by a short step of its own series, for it starts where its event is.

    Event location finds that zero again, or takes it for the only one of a step, or finds it by rounding alone
    where slip starts flat. Slip too short for the step stays where it is.
    """
    if place.v != line.belt_speed:
        return place
    mass, omega = line.mass, line.mass.frequency
    step = 1e-4 / max(1.0, omega)
    second = line.net(place) - side * line.limit
    third = (1j * omega * mass.force * cmath.exp(1j * omega * place.t)).imag - mass.damping * second - place.v
    fourth = -(omega**2) * line.load(place.t) - mass.damping * third - second
    slip = second * step + third * step**2 / 2.0 + fourth * step**3 / 6.0
    if slip * side <= 0.0:
        return place
    moved = place.v * step + second * step**2 / 2.0 + third * step**3 / 6.0 + fourth * step**4 / 24.0
    return MotionState(place.t + step, place.x + moved, place.v + slip)


LOOKS = 128
"""At the force of stick per period, before its meeting with the limit is bracketed."""


class ScipyEvents(Peer):
    """solve_ivp from event to event along the line, from the friction-free orbit until the period closes.

    solver: DOP853 (default), RK45 or Radau; rtol and atol are the tolerance.
    """

    name: ClassVar[str] = "scipy_events"
    package: ClassVar[str] = "scipy"

    solver: Literal["DOP853", "RK45", "Radau"] = "DOP853"

    def refusal(self, scene: Scene, law: FrictionLaw) -> str | None:
        """Motion in the plane, where slip has no sign to change."""
        if (known := super().refusal(scene, law)) is not None:
            return known
        return None if scene.load_along_belt_only else "scipy_events is set up for motion along the belt"

    def solve(self, scenes: Sequence[Scene], law: FrictionLaw, tolerance: float) -> Floats:
        """One scene after the other."""
        mass = scenes[0].mass()
        legs = _Legs(mass, law.sliding_friction(1.0) * mass.normal_load)
        legs.solver, legs.tolerance = self.solver, tolerance
        return means(legs, scenes, tolerance)


class _Legs(LineMotion):
    """Legs by solve_ivp."""

    solver: str
    tolerance: float

    def slide(self, side: float, place: MotionState) -> tuple[MotionState, float]:
        from scipy.integrate import solve_ivp

        begun, place = place.t, first_step(self, side, place)
        settings = {"method": self.solver, "rtol": max(self.tolerance, LEAST_RTOL), "atol": self.tolerance}
        span, state = (place.t, self.period), [place.x, place.v]
        found = solve_ivp(self._rates(side), span, state, events=self._end_of_slip(side), **settings)
        if found.status < 0:
            raise ArithmeticError(f"solve_ivp: {found.message}")
        x, v = found.y[:, -1]
        end = float(found.t[-1])
        place = MotionState(end, float(x), self.belt_speed if found.status == 1 else float(v))
        return place, side * self.limit * (end - begun)

    def _rates(self, side: float) -> Callable[[float, Floats], list[float]]:
        damping, rub = self.mass.damping, side * self.limit
        return lambda t, y: [y[1], self.load(t) - damping * y[1] - y[0] - rub]

    def _end_of_slip(self, side: float) -> Callable[[float, Floats], float]:
        def slip(t: float, y: Floats) -> float:
            return float(y[1] - self.belt_speed)

        slip.terminal, slip.direction = True, -side  # type: ignore[attr-defined]  # how solve_ivp is told
        return slip

    def hold(self, place: MotionState) -> MotionState:
        """Stick needs no integrator: the spring is drawn out evenly, and the force to hold it is known."""
        from scipy.optimize import brentq

        def at(t: float) -> MotionState:
            return MotionState(t, place.x + self.belt_speed * (t - place.t), self.belt_speed)

        def room(t: float) -> float:
            return self.limit - abs(self.net(at(t)))

        times = np.append(np.arange(place.t, self.period, self.period / LOOKS), self.period)
        over = next((k for k in range(1, len(times)) if room(times[k]) < 0.0), None)
        if over is None:
            return at(self.period)
        low = float(times[over - 1])
        return at(low if room(low) <= 0.0 else brentq(room, low, float(times[over]), xtol=1e-15))
