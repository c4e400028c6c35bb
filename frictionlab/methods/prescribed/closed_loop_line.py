"""The closed loop of a bristle law under slip along one line: by two exact legs, or by collocation."""

from __future__ import annotations

import cmath
import math
from typing import Any, NamedTuple

import numpy as np

from frictionlab.compile.call import KernelCall
from frictionlab.dynamics.radau_panel import Oscillation
from frictionlab.laws.memory import BristleLaw
from frictionlab.methods.prescribed.collocation import collocated
from frictionlab.methods.prescribed.exact_legs import POINTS, SHARES, Legs, closed_legs
from frictionlab.methods.prescribed.loop import ELASTIC, NOTHING_MOVES, Closed, Loop, Open
from frictionlab.methods.prescribed.periodic_deflection import natural_reach
from frictionlab.methods.words import ModelWord
from frictionlab.quantities import EPSILON, Floats


class Along(NamedTuple):
    """Slip along a line: phasor of the oscillation, belt speed, frequency."""

    phasor: complex
    belt_speed: float
    frequency: float

    @property
    def size(self) -> float:
        """The amplitude of the oscillation."""
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


def line_loop(law: BristleLaw, along: Along, tolerance: float) -> Closed | Open:
    """The closed loop, or the range of means and the reason where it is not unique."""
    if along.size == 0.0 and along.belt_speed == 0.0:
        return Open.up_to(law, natural_reach(law, 1.0), NOTHING_MOVES)
    room = law.elastic_deflection() - along.size / along.frequency
    if along.belt_speed == 0.0 and room > 0.0:
        return Open.up_to(law, room, ELASTIC)
    if not law.exact_path():
        slip = Oscillation(along.phasor, 0j, along.frequency, 0.0)
        return collocated(law, slip, along.belt_speed, tolerance, 0.0)
    return _legs(law, along) if along.turn > 0.0 else _one_way(law, along)


def legs_of(law: BristleLaw, along: Along, cuts: float) -> Legs:
    """The legs of a slip that reverses, under a law with an exact path."""
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
    """The loop at the phase and with the signs of the given slip."""
    start, width, slip, deflection, friction = parts
    shift = -0.5 * math.pi * along.side - cmath.phase(along.phasor)
    side = complex(-along.side, 0.0)
    return Loop(start + shift, width, points, shares, side * slip, side.real * deflection, side * friction)
