"""Friction under a prescribed slip; without memory by quadrature to rounding, along the belt a closed form.

Licence: right to 13 digits at V_lin, too, where a slip of any waveform has a double root, known to 1e-7 alone
(varying_slip.py), and half its time.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from frictionlab.compile.call import KernelCall
from frictionlab.compile.decorators import njit
from frictionlab.dynamics.motion import SLIP_ROUNDING
from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.prescribed.motion import (
    SlowPassage,
    between_passages,
    displacement,
    slow_passages,
    velocity,
)
from frictionlab.orbit.panels import NODES, WEIGHTS
from frictionlab.orbit.record import Orbit
from frictionlab.quantities import Floats
from frictionlab.scene.body import Motion

CLOSEST = 1e-16
"""Angle [rad] at which the refinement towards a passage through rest ends: rounding of the angle itself."""


class Integrals(NamedTuple):
    """Over one period: mean resisting coefficient (complex), the largest met (the scale of rounding), and the mean
    direction of slip."""

    mean: complex
    largest: float
    direction: complex


def orbit_of_slip(motion: Motion, belt_speed: float, law: FrictionLaw, position: complex) -> Orbit:
    """One period of a harmonic motion about a mean position, and the friction along it."""
    edges = np.concatenate((slip_edges(motion, belt_speed), _reversals(motion, belt_speed)))
    angle, _ = nodes(np.unique(np.concatenate(([0.0, 2.0 * math.pi], edges % (2.0 * math.pi)))))
    v, x = velocity(motion, angle), displacement(motion, angle)
    slip = np.where(np.abs(v - belt_speed) <= SLIP_ROUNDING * np.abs(v), 0.0, v - belt_speed)
    friction = sliding_vectors(law, slip)
    return Orbit(angle / motion.frequency, position + x, v, friction, np.zeros(len(angle), np.bool_))


def _reversals(motion: Motion, belt_speed: float) -> Floats:
    """The angles at which a slip along the belt changes its sign: no panel passes one unseen."""
    size = abs(motion.velocity)
    if motion.transverse_velocity != 0.0 or not abs(belt_speed) < size:
        return np.empty(0)
    first = math.asin(belt_speed / size)
    return np.array([first, math.pi - first]) - np.angle(motion.velocity)


def slip_edges(motion: Motion, belt_speed: float) -> Floats:
    """Angles between which the friction is analytic far enough around every panel."""
    return graded_circle(slow_passages(motion.velocity, motion.transverse_velocity, belt_speed))


def graded_circle(passages: list[SlowPassage]) -> Floats:
    """Panel edges once around, from the first passage on, refined geometrically towards each."""
    pieces = []
    for (here, depth), (there, next_depth) in between_passages(passages, math.inf):
        half = 0.5 * (there - here)
        pieces += [here + _graded(half, depth), (there - _graded(half, next_depth))[::-1]]
    return np.unique(np.concatenate(pieces))


def _graded(length: float, depth: float) -> Floats:
    """Steps from 0 to ``length`` of at most half the distance to a singularity ``depth`` away from 0."""
    ends = [0.0]
    while ends[-1] < length:
        step = min(math.pi / 8.0, 0.5 * length, 0.5 * max(ends[-1], depth, CLOSEST))
        ends.append(min(ends[-1] + step, length))
    return np.array(ends)


def halved(edges: Floats) -> Floats:
    """The panels cut in two."""
    return np.unique(np.concatenate((edges, 0.5 * (edges[1:] + edges[:-1]))))


def nodes(edges: Floats) -> tuple[Floats, Floats]:
    """Gauss-Lobatto nodes and weights of every panel."""
    half = 0.5 * np.diff(edges)[:, None]
    return edges[:-1, None] + half * (1.0 + NODES), half * WEIGHTS


def sliding_vectors(law: FrictionLaw, slip: NDArray[np.complex128]) -> NDArray[np.complex128]:
    """The friction that resists each slip; zero at rest, which is an instant without duration."""
    if law.constant_sliding_friction():
        return law.sliding_friction(1.0) * _directions(slip)
    friction = np.empty(slip.size, np.complex128)
    KernelCall(friction_of_slips, law)(slip.ravel(), friction)
    return friction.reshape(slip.shape)


@njit
def friction_of_slips(law: Any, slip: Any, friction: Any) -> None:
    """Fill friction with that of a law without memory at each slip velocity."""
    for i in range(slip.size):
        friction[i] = law.sliding_vector(slip[i]) if slip[i] != 0.0 else 0j


def _directions(slip: NDArray[np.complex128]) -> NDArray[np.complex128]:
    speed = np.maximum(np.abs(slip), 1e-300)  # slower than that is at rest, and its inverse overflows
    return slip / speed


def integrals(motion: Motion, belt_speed: float, law: FrictionLaw, edges: Floats) -> Integrals:
    """Quadrature over one period with these panels."""
    angle, weights = nodes(edges)
    slip = velocity(motion, angle) - belt_speed
    friction = sliding_vectors(law, slip)
    with np.errstate(invalid="ignore"):  # where a law gives no number, neither is the mean
        mean = complex((weights * friction).sum() / (2.0 * math.pi))
    direction = complex((weights * _directions(slip)).sum() / (2.0 * math.pi))
    return Integrals(mean, float(np.abs(friction).max()), direction)
