"""Friction under a prescribed slip; without memory by quadrature to rounding, along the belt a closed form."""

from __future__ import annotations

import math
import time
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from frictionlab.laws.base import FrictionLaw, SlidingLaw
from frictionlab.laws.bristle import BristleLaw
from frictionlab.laws.memory import MemoryLaw
from frictionlab.methods.base import Answers, Floats, Orbit, Status
from frictionlab.methods.prescribed_bristle import BristlePoint, saturates
from frictionlab.methods.prescribed_memory import MemoryPoint
from frictionlab.methods.prescribed_motion import (
    Reading,
    prescribed_columns,
    slow_passages,
    undecided_columns,
)
from frictionlab.orbit import NODES, WEIGHTS
from frictionlab.scene import Motion, Scene
from frictionlab.theory import mean_prescribed_longitudinal

EPSILON = 2.0**-52
CLOSEST = 1e-16
"""Angle [rad] at which the refinement towards a passage through rest ends: rounding of the angle itself."""


class Integrals(NamedTuple):
    """Over one period: mean resisting coefficient (complex), heat in the contact and work taken, per unit load.

    largest: the largest coefficient met, the scale of rounding. direction: the mean direction of slip.
    """

    mean: complex
    contact: float
    taken: float
    largest: float
    direction: complex


def solve_prescribed(scenes: Sequence[Scene], law: FrictionLaw, tolerance: float) -> Answers:
    """Answer scenes of prescribed slip that differ in belt speed alone."""
    rows = [_point(scene, law, tolerance) for scene in scenes]
    columns = {name: np.array([row.columns[name] for row in rows]) for name in rows[0].columns}
    columns["seconds"] = np.array([row.seconds for row in rows])
    for row in rows:
        if row.status == "ok" and row.columns["error"] > tolerance:
            row.reason = (
                f"error {row.columns['error']:.1e} above the tolerance: rounding is all that is left in it"
            )
    return Answers(
        [row.status for row in rows],
        [row.reason for row in rows],
        [row.model for row in rows],
        [row.error_kind for row in rows],
        columns,
        lambda i: rows[i].orbit(),
    )


def _point(scene: Scene, law: FrictionLaw, tolerance: float) -> _Point | BristlePoint | MemoryPoint:
    if isinstance(law, MemoryLaw):
        return MemoryPoint(scene, law, tolerance)
    if isinstance(law, BristleLaw) and not saturates(scene, law):
        return BristlePoint(scene, law, tolerance)
    return _Point(scene, law)


class _Point:
    """One scene of prescribed slip and its answer."""

    def __init__(self, scene: Scene, law: FrictionLaw) -> None:
        self.motion, self.belt_speed, self.law = scene.motion(), scene.belt_speed, law
        self.planar = scene.transverse_slip is not None
        self.along, self.across = self.motion.velocity, self.motion.transverse_velocity
        self.size = scene.slip.velocity_amplitude if scene.slip is not None else 0.0
        self.status: Status = "ok"
        self.reason, self.model, self.error_kind = "", "", "guaranteed"
        start = time.perf_counter()
        self.columns = self._answer()
        self.seconds = time.perf_counter() - start

    def _answer(self) -> dict[str, float]:
        if self.belt_speed == 0.0 and self.along == 0.0 and self.across == 0.0:
            return self._no_slip()
        edges = slip_edges(self.motion, self.belt_speed)
        found = integrals(self.motion, self.belt_speed, self.law, edges)
        rounding = EPSILON * found.largest
        mean, error = -found.mean, 8.0 * rounding
        if self.across == 0.0 and self.law.constant_sliding_friction():
            mean = complex(found.largest * self._along_the_belt(), 0.0)
            self.model = "closed form: slip prescribed along the belt"
        elif self.belt_speed == 0.0:
            mean = 0j
            self.model = "closed form: each half period of slip undoes the other"
        else:
            finer = integrals(self.motion, self.belt_speed, self.law, halved(edges))
            mean = self._with_exact_turns(found)
            error = 4.0 * abs(self._with_exact_turns(finer) - mean) + 64.0 * rounding
            self.model = "prescribed slip: Gauss-Lobatto quadrature, panels graded towards slow slip"
            self.error_kind = "estimated"
        return self._row(mean, error, found)

    def _with_exact_turns(self, found: Integrals) -> complex:
        """The mean; along the belt, the share of friction at vanishing speed in closed form.

        What is left to quadrature then vanishes where slip does, and near V_lin nothing hangs on its sign there.
        """
        if self.across != 0.0:
            return -found.mean
        first = self.law.sliding_friction(0.0)
        return complex(first * self._along_the_belt(), 0.0) - (found.mean - first * found.direction)

    def _along_the_belt(self) -> float:
        speed, size = abs(self.belt_speed), self.size
        if not size > speed:
            return math.copysign(1.0, self.belt_speed)
        if speed < 0.5 * size:
            return float(mean_prescribed_longitudinal(self.belt_speed / size))
        # the same by the difference, which is exact here: near the kink a rounded ratio would cost half the digits
        return math.copysign(
            1.0 - 4.0 / math.pi * math.asin(math.sqrt(0.5 * (size - speed) / size)), self.belt_speed
        )

    def _no_slip(self) -> dict[str, float]:
        self.status, self.error_kind = "not_unique", ""
        self.model = "closed form"
        self.reason = "nothing moves: friction at rest may be anything up to mu"
        most = _friction_at_rest(self.law)
        return undecided_columns(self.motion, -most, most)

    def _row(self, mean: complex, error: float, found: Integrals) -> dict[str, float]:
        turns = 2.0 if abs(self.belt_speed) < abs(self.along) else 0.0
        read = Reading(mean, error, found.contact, found.taken, turns, turns)
        return prescribed_columns(self.motion, self.planar, read)

    def orbit(self) -> Orbit | None:
        """The prescribed motion and the friction along it."""
        return orbit_of_slip(self.motion, self.belt_speed, self.law, 0j) if self.status == "ok" else None


def _friction_at_rest(law: FrictionLaw) -> float:
    return law.static_friction() if isinstance(law, SlidingLaw) else law.sliding_friction(0.0)


def orbit_of_slip(motion: Motion, belt_speed: float, law: FrictionLaw, position: complex) -> Orbit:
    """One period of a harmonic motion about a mean position, and the friction along it."""
    edges = slip_edges(motion, belt_speed)
    angle, _ = nodes(np.unique(np.concatenate(([0.0, 2.0 * math.pi], edges % (2.0 * math.pi)))))
    v, turn = velocity(motion, angle), np.exp(1j * angle)
    x = -((motion.velocity * turn).real + 1j * (motion.transverse_velocity * turn).real) / motion.frequency
    friction = sliding_vectors(law, v - belt_speed)
    return Orbit(angle / motion.frequency, position + x, v, friction, np.zeros(len(angle), np.bool_))


def slip_edges(motion: Motion, belt_speed: float) -> Floats:
    """Angles between which the friction is analytic far enough around every panel."""
    return graded_circle(slow_passages(motion.velocity, motion.transverse_velocity, belt_speed))


def graded_circle(passages: list[tuple[float, float]]) -> Floats:
    """Panel edges once around, from the first passage on, refined geometrically towards each."""
    places = sorted((angle % (2.0 * math.pi), depth) for angle, depth in passages) or [(0.0, math.inf)]
    following = [*places[1:], (places[0][0] + 2.0 * math.pi, places[0][1])]
    pieces = []
    for (here, depth), (there, next_depth) in zip(places, following, strict=True):
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


def velocity(motion: Motion, angle: Floats) -> NDArray[np.complex128]:
    """x1' + i x2' at these angles of the period."""
    turn = np.exp(1j * angle)
    return (motion.velocity * turn).imag + 1j * (motion.transverse_velocity * turn).imag


def sliding_vectors(law: FrictionLaw, slip: NDArray[np.complex128]) -> NDArray[np.complex128]:
    """The friction that resists each slip; zero at rest, which is an instant without duration."""
    if law.constant_sliding_friction():
        return law.sliding_friction(1.0) * _directions(slip)
    values = [law.sliding_vector(one) if one else 0j for one in slip.ravel().tolist()]
    return np.array(values).reshape(slip.shape)


def _directions(slip: NDArray[np.complex128]) -> NDArray[np.complex128]:
    speed = np.maximum(np.abs(slip), 1e-300)  # slower than that is at rest, and its inverse overflows
    return slip / speed


def integrals(motion: Motion, belt_speed: float, law: FrictionLaw, edges: Floats) -> Integrals:
    """Quadrature over one period with these panels."""
    angle, weights = nodes(edges)
    v = velocity(motion, angle)
    slip = v - belt_speed
    friction = sliding_vectors(law, slip)
    mean = complex((weights * friction).sum() / (2.0 * math.pi))
    contact = float((weights * (friction * slip.conjugate()).real).sum()) / motion.frequency
    taken = float((weights * (friction * v.conjugate()).real).sum()) / motion.frequency
    direction = complex((weights * _directions(slip)).sum() / (2.0 * math.pi))
    return Integrals(mean, contact, taken, float(np.abs(friction).max()), direction)
