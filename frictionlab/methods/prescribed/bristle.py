"""Bristle laws with an exact path under a prescribed sine along one line: the closed loop, by two exact legs."""

from __future__ import annotations

import cmath
import math
from typing import Any, NamedTuple

import numpy as np

from frictionlab.compile.call import KernelCall
from frictionlab.compile.decorators import njit
from frictionlab.laws.memory import BristleLaw
from frictionlab.methods.base import Status
from frictionlab.methods.prescribed.exact_legs import POINTS, SHARES, Legs, closed_legs
from frictionlab.methods.prescribed.loop import (
    ELASTIC,
    NOTHING_MOVES,
    Closed,
    Loop,
    Open,
    PrescribedMean,
    Vectors,
)
from frictionlab.methods.prescribed.varying_slip import VaryingSlip, nodes
from frictionlab.methods.words import ModelWord
from frictionlab.motion.contact import resistance
from frictionlab.motion.orbit.record import Orbit
from frictionlab.scene.scene import Scene
from frictionlab.values.quantities import EPSILON, Floats


class Along(NamedTuple):
    """Slip along a line: phasor of the oscillation, belt speed, frequency."""

    phasor: complex
    belt_speed: float
    frequency: float

    @property
    def size(self) -> float:
        """Return the amplitude of the oscillation."""
        return abs(self.phasor)

    @property
    def side(self) -> float:
        """1 for a belt that runs forward, else -1."""
        return -1.0 if self.belt_speed < 0.0 else 1.0

    @property
    def turn(self) -> float:
        """Half of the angle during which slip is reversed; 0 where it never is."""
        speed, size = abs(self.belt_speed), self.size
        return 2.0 * math.asin(math.sqrt(0.5 * (size - speed) / size)) if size > speed else 0.0


def line_loop(law: BristleLaw, along: Along) -> Closed | Open:
    """Return the closed loop of a law with an exact path, or the range of means if it is not unique."""
    if along.size == 0.0 and along.belt_speed == 0.0:
        return Open.up_to(law, law.largest_deflection(), NOTHING_MOVES)
    room = law.elastic_deflection() - along.size / along.frequency
    if along.belt_speed == 0.0 and room > 0.0:
        return Open.up_to(law, room, ELASTIC)
    return _legs(law, along) if along.turn > 0.0 else _one_way(law, along)


def legs_of(law: BristleLaw, along: Along, cuts: float) -> Legs:
    """Return the legs of a slip that reverses, under a law with an exact path."""
    reach, fastest = law.largest_deflection(), law.largest_rate(1.0)
    length = min(reach, 1.0 / fastest) if 0.0 < fastest < math.inf else reach
    return Legs(along.turn, along.size / along.frequency, along.size, length, reach, cuts)


def _legs(law: BristleLaw, along: Along) -> Closed:
    kernel, loops, seconds = KernelCall(closed_legs, law), [], 0.0
    for cuts in (1.0, 2.0):
        (start, *rest), spent = kernel.timed(legs_of(law, along, cuts))
        seconds += spent
        loops.append(_turned(along, (start + along.turn - math.pi, *rest), POINTS, SHARES))
    coarse, fine = loops
    error = 4.0 * abs(fine.mean - coarse.mean) + 64.0 * EPSILON * fine.largest
    return Closed(fine, error, ModelWord.TWO_LEGS, seconds)


def _one_way(law: BristleLaw, along: Along) -> Closed:
    edges = np.linspace(-math.pi, math.pi, 33)
    width = np.diff(edges)
    angle = edges[:-1, None] + width[:, None] * POINTS
    slip = along.size * np.cos(angle) + abs(along.belt_speed)
    z = law.largest_deflection()
    rub = np.array([[law.friction(v, z, law.rate(v, z)) for v in row] for row in slip.tolist()])
    loop = _turned(along, (edges[:-1], width, slip, np.full(slip.shape, z), rub), POINTS, SHARES)
    return Closed(loop, 16.0 * EPSILON * loop.largest, ModelWord.SLIP_ONE_WAY, 0.0)


def _turned(along: Along, parts: tuple[Any, ...], points: Floats, shares: Floats) -> Loop:
    """Return the loop at the phase and with the signs of the given slip."""
    start, width, slip, deflection, friction = parts
    shift = -0.5 * math.pi * along.side - cmath.phase(along.phasor)
    side = complex(-along.side, 0.0)
    return Loop(start + shift, width, points, shares, side * slip, side.real * deflection, side * friction)


ROUNDING = 2.0**-50


class BristlePoint:
    """Scene of a prescribed sine along a line under a law with an exact path, and the answer."""

    def __init__(self, scene: Scene, law: BristleLaw) -> None:
        self.scene, self.motion, self.belt_speed = scene, scene.motion(), scene.belt_speed
        self.law = law.under_load(self.motion.normal_load)
        along = Along(self.motion.velocity, self.belt_speed, self.motion.frequency)
        self.closed = line_loop(self.law, along)
        self.seconds = self.closed.seconds
        self.status: Status = "ok"
        self.reason, self.model, self.error_kind = "", "", "estimated"
        self.found = self._answer(self.closed)

    def _answer(self, closed: Closed | Open) -> PrescribedMean:
        if isinstance(closed, Open):
            self.status, self.reason, self.error_kind = "not_unique", closed.reason, ""
            return PrescribedMean(low=closed.low, high=closed.high)
        self.model = closed.model
        if self.belt_speed == 0.0 and self.law.obeys("oddness"):
            self.model, self.error_kind = ModelWord.SYMMETRY, "guaranteed"
            return PrescribedMean(0j, ROUNDING * closed.loop.largest)
        if closed.model == ModelWord.SLIP_ONE_WAY and self.law.constant_sliding_friction():
            self.error_kind = "guaranteed"
        return PrescribedMean(closed.loop.mean, closed.error)

    def orbit(self) -> Orbit | None:
        """One period of the prescribed motion, and the friction of the deflection along it."""
        if isinstance(self.closed, Open):
            return None
        loop, slip = self.closed.loop, VaryingSlip.of(self.scene.signals(), self.motion.normal_load)
        # no panel of the orbit reaches over the edge of one of the loop's
        edges = np.unique(np.concatenate(([0.0, 2.0 * math.pi], loop.start % (2.0 * math.pi))))
        angle, _ = nodes(edges)
        tau, deflection = angle / self.motion.frequency, loop.at(angle, loop.deflection)
        v = slip.velocity(tau, np.zeros(1, np.int64)) - self.belt_speed
        return slip.orbit(tau, _resisted(self.law, v.real, deflection))


def _resisted(law: BristleLaw, slip: Any, deflection: Any) -> Vectors:
    """Return the friction coefficient at every slip velocity and deflection."""
    rub = np.empty(slip.size, slip.dtype)
    KernelCall(friction_of_each, law)(slip.ravel(), deflection.ravel(), rub)
    return rub.reshape(slip.shape).astype(complex)


@njit
def friction_of_each(law: Any, slip: Any, deflection: Any, rub: Any) -> None:
    """Fill rub with the friction of a bristle law at each slip velocity and deflection."""
    for i in range(slip.size):
        rub[i] = resistance(law, slip[i], deflection[i])[1]
