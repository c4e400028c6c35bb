"""A mass under Coulomb friction along a line: the bookkeeping around an event integrator.

The integrator follows slip up to its end; what comes next, the impulse of friction and when the motion has closed
are settled here, in plain Python, as a user of such a library would.
"""

from __future__ import annotations

import cmath
import math
from abc import ABC, abstractmethod
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from frictionlab.bench.peers.base import LONGEST_TRANSIENT, ClosureTest
from frictionlab.bench.peers.equations import free_orbit
from frictionlab.quantities import Floats
from frictionlab.scene.body import Mass
from frictionlab.scene.scene import Scene

MOST_EVENTS = 10_000


class MotionState(NamedTuple):
    """Time, position and velocity."""

    t: float
    x: float
    v: float


class LineMotion(ABC):
    """One scene but belt speed, and a library that follows its motion over a period."""

    def __init__(self, mass: Mass, limit: float) -> None:
        self.mass, self.limit = mass, limit
        self.belt_speed = 0.0
        self.period = 2.0 * math.pi / mass.frequency

    @abstractmethod
    def one_period(self, place: MotionState) -> tuple[MotionState, float]:
        """From t = 0 to the end of the period, and the impulse of friction."""

    def load(self, t: float) -> float:
        """The load."""
        return (self.mass.force * cmath.exp(1j * self.mass.frequency * t)).imag

    def net(self, place: MotionState) -> float:
        """The force that friction must balance in stick."""
        return self.load(place.t) - self.mass.damping * self.belt_speed - place.x

    def held_impulse(self, start: MotionState, end: MotionState) -> float:
        """The integral of ``net`` over a leg of stick."""
        turn = self.mass.force / (1j * self.mass.frequency)
        drive = (turn * cmath.exp(1j * self.mass.frequency * end.t)).imag
        drive -= (turn * cmath.exp(1j * self.mass.frequency * start.t)).imag
        constant = self.mass.damping * self.belt_speed + 0.5 * (start.x + end.x)
        return drive - constant * (end.t - start.t)

    def side(self, place: MotionState) -> float:
        """The sign of the slip, from zero slip that of the force too large to hold; 0 in stick."""
        slip = place.v - self.belt_speed
        if slip != 0.0:
            return math.copysign(1.0, slip)
        net = self.net(place)
        return math.copysign(1.0, net) if abs(net) > self.limit else 0.0

    def up(self, place: MotionState) -> bool:
        """Whether the period is over."""
        return self.period - place.t <= 1e-13 * self.period


class EventMotion(LineMotion):
    """A period leg by leg: what an event integrator does is a leg from a place to its event, or to ``until``."""

    @abstractmethod
    def slide(self, side: float, place: MotionState, until: float) -> MotionState:
        """Slip with its sign, until it ends or time is up."""

    @abstractmethod
    def hold(self, place: MotionState, until: float) -> MotionState:
        """Stick, until the force to hold reaches the limit or time is up."""

    def one_period(self, place: MotionState) -> tuple[MotionState, float]:
        """Slip and stick in turn."""
        impulse, side = 0.0, self.side(place)
        for _ in range(MOST_EVENTS):
            if self.up(place):
                return place, impulse
            if side == 0.0:
                end = self.hold(place, self.period)
                impulse += self.held_impulse(place, end)
                side = math.copysign(1.0, self.net(end))  # what ends stick is a force too large for it
            else:
                end = self.slide(side, place, self.period)
                impulse += side * self.limit * (end.t - place.t)
                side = self.side(end)
            place = end
        raise ArithmeticError(f"more than {MOST_EVENTS} legs in one period")


def means(line: LineMotion, scenes: Sequence[Scene], tolerance: float) -> Floats:
    """The mean friction of each scene, from the friction-free orbit until the period closes."""
    found = []
    for scene in scenes:
        line.belt_speed = scene.belt_speed
        found.append(_steady_mean(line, scene.mass(), tolerance))
    return np.array(found)


def _steady_mean(line: LineMotion, mass: Mass, tolerance: float) -> float:
    place = MotionState(0.0, *free_orbit(mass.damping, mass.stiffness, mass.frequency, mass.force))
    closing = ClosureTest(tolerance, mass.normal_load, line.period)
    for _ in range(LONGEST_TRANSIENT):
        end, impulse = line.one_period(place)
        gap = math.hypot(end.x - place.x, end.v - place.v)
        place = MotionState(0.0, end.x, end.v)
        if closing.done(gap):
            return -impulse / (mass.normal_load * line.period)
    raise ArithmeticError(f"the motion has not closed after {LONGEST_TRANSIENT} periods")


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
