"""Closed loops of bristle laws by collocation, along a line and in the plane.

Licence (48 scenes at 1e-8, softness 1e-3 to 30): against the period map of a memory of any size as fast along a line,
0.7 to 2.2 times faster in the plane in the median of a law. That map leaves open what this answers: contacts that the
slip bends by less than a thousandth of their length.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from frictionlab.laws.memory import BristleLaw
from frictionlab.methods.prescribed.loop import ELASTIC, NOTHING_MOVES, Closed, Open, Vectors
from frictionlab.methods.prescribed.periodic_deflection import (
    Accuracy,
    closed_deflection,
    layer,
    natural_reach,
)
from frictionlab.methods.words import ModelWord
from frictionlab.motion.steppers.radau_panel import Oscillation
from frictionlab.scene.body import Motion
from frictionlab.values.quantities import Floats

FAR = 10.0
CLOSEST = 1e-12
"""Angle [rad] at which the grading towards a passage through rest ends."""
SMOOTH = 1e-3
"""Angle [rad] above which slip along a line that only touches zero needs no finer panels: friction has no kink there.
"""

_SlowPassage = tuple[float, float]
"""Where slip is slow: the angle, and how far from the real axis it vanishes."""


def plane_loop(law: BristleLaw, motion: Motion, belt_speed: float, tolerance: float) -> Closed | Open:
    """The closed loop, or why there is none."""
    slip = Oscillation(motion.velocity, motion.transverse_velocity, motion.frequency)
    if slip.along == 0 and slip.across == 0 and belt_speed == 0.0:
        return Open.up_to(law, natural_reach(law, 1.0), NOTHING_MOVES)
    if belt_speed == 0.0:
        room = _room(slip, law.elastic_deflection())
        if room > 0.0:
            return Open.up_to(law, room, ELASTIC)
    return collocated(law, slip, belt_speed, tolerance, 0j)


def collocated(
    law: BristleLaw, slip: Oscillation, belt_speed: float, tolerance: float, start: Any
) -> Closed | Open:
    """The closed loop found from a first deflection: a vector in the vectorial form, else a number."""
    circle = _circle(law) if isinstance(start, complex) else -1.0
    accuracy = Accuracy.of(law, slip, belt_speed, tolerance, circle)
    found = closed_deflection(law, slip, stretches(law, slip, belt_speed), accuracy, start)
    return found if isinstance(found, Open) else found._replace(model=ModelWord.COLLOCATION)


def _circle(law: BristleLaw) -> float:
    """Where the deflection follows the slip: nowhere in particular (-1), while unloading (0), within a circle."""
    if law.yield_deflection() < math.inf:
        return law.yield_deflection()
    return 0.0 if law.elastic_unloading() else -1.0


def _slip(slip: Oscillation, belt_speed: float, angle: Floats) -> Vectors:
    turn = np.exp(1j * angle)
    v: Vectors = (slip.along * turn).imag - belt_speed + 1j * (slip.across * turn).imag
    return v


def _room(slip: Oscillation, radius: float) -> float:
    """The largest x1 of a start whose deflection stays within the radius all the time; negative where there is none.

    Such starts are a convex set, symmetric about zero.
    """
    turn = np.exp(1j * np.linspace(0.0, 2.0 * math.pi, 1441))
    path = -((slip.along * turn).real + 1j * (slip.across * turn).real) / slip.frequency
    low, high, best = -radius, radius, -math.inf
    for _ in range(6):
        across = np.linspace(low, high, 201)
        square = radius**2 - (path.imag[:, None] + across) ** 2
        reach = (np.sqrt(np.maximum(square, 0.0)) - path.real[:, None]).min(axis=0)
        reach = np.where((square >= 0.0).all(axis=0), reach, -math.inf)
        at = int(reach.argmax())
        best = max(best, float(reach[at]))
        width = (high - low) / 50.0
        low, high = across[at] - width, across[at] + width
    return best


def stretches(law: BristleLaw, slip: Oscillation, belt_speed: float) -> Floats:
    """The parts of a period without rest inside, from one slow passage to the next."""
    passages, rows = _slow_passages(slip.along, slip.across, belt_speed), []
    for (here, depth), (there, next_depth) in _between_passages(passages, FAR):
        if there > here:
            half = 0.5 * (there - here)
            near, end = _near_ends(law, slip, belt_speed, (here, depth), next_depth)
            first, last = (
                _at_passage(slip, belt_speed, here, depth),
                _at_passage(slip, belt_speed, there, next_depth),
            )
            rows.append([here, first.real, first.imag, 0.0, half, near, FAR])
            rows.append([there, last.real, last.imag, -half, half, FAR, end])
    return np.array(rows)


def _slow_passages(along: complex, across: complex, belt_speed: float) -> list[_SlowPassage]:
    """Where in the complex plane of the angle the slip speed vanishes: (angle, distance from the real axis).

    |slip|^2 is the product of slip_1 + i slip_2 and slip_1 - i slip_2; each is p z - belt_speed + q/z in
    z = exp(i angle), and their zeros mirror each other in the real axis.
    """
    p, q = -0.5j * along + 0.5 * across, 0.5j * along.conjugate() - 0.5 * across.conjugate()
    root = cmath.sqrt(belt_speed * belt_speed - 4.0 * p * q)
    larger = max(belt_speed + root, belt_speed - root, key=abs)
    zeros = [
        top / bottom for top, bottom in ((larger, 2.0 * p), (2.0 * q, larger)) if top != 0 and bottom != 0
    ]
    return [(cmath.phase(z), abs(math.log(abs(z)))) for z in zeros]


def _between_passages(
    passages: list[_SlowPassage], none: float
) -> Iterator[tuple[_SlowPassage, _SlowPassage]]:
    """Every passage of a period and the one after it, once around; else one at 0, ``none`` deep."""
    places = sorted((angle % (2.0 * math.pi), depth) for angle, depth in passages) or [(0.0, none)]
    yield from zip(places, [*places[1:], (places[0][0] + 2.0 * math.pi, places[0][1])], strict=True)


def _near_ends(
    law: BristleLaw, slip: Oscillation, belt_speed: float, passage: _SlowPassage, next_depth: float
) -> tuple[float, float]:
    """The angles after a passage and before the next within which steps need not shorten further."""
    here, depth = passage
    if slip.across != 0.0:
        near = max(depth, min(0.01 * _layer(law, slip, belt_speed, here), 1e-3), CLOSEST)
        return near, max(next_depth, CLOSEST)
    if abs(belt_speed) < abs(slip.along):  # what is before a reversal is smooth
        return _layer(law, slip, belt_speed, here), FAR
    return max(depth, SMOOTH), max(next_depth, SMOOTH)


def _at_passage(slip: Oscillation, belt_speed: float, angle: float, depth: float) -> complex:
    """The slip where it is slowest; every slip near there is told as a difference from it, and so without noise."""
    return complex(_slip(slip, belt_speed, np.array([angle]))[0]) if depth > 1e-15 else 0j


def _layer(law: BristleLaw, slip: Oscillation, belt_speed: float, here: float) -> float:
    """The angle after a place within which the deflection begins to settle."""
    return layer(
        law, slip.frequency, lambda h: abs(complex(_slip(slip, belt_speed, np.array([here + h]))[0]))
    )
