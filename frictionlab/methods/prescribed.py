"""Coulomb friction under a prescribed slip: a closed form along the belt, quadrature to rounding in the plane."""

from __future__ import annotations

import cmath
import math
import time
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import Answers, Floats, Orbit, Status
from frictionlab.orbit import NODES, WEIGHTS
from frictionlab.scene import Motion, Scene
from frictionlab.theory import mean_prescribed_longitudinal

EPSILON = 2.0**-52
CLOSEST = 1e-16
"""Angle [rad] at which the refinement towards a passage through rest ends: rounding of the angle itself."""


class Integrals(NamedTuple):
    """Over one period: mean resisting coefficient (complex), heat in the contact and work taken, per unit load."""

    mean: complex
    contact: float
    taken: float


def solve_prescribed(scenes: Sequence[Scene], law: FrictionLaw, tolerance: float) -> Answers:
    """Answer scenes of prescribed slip that differ in belt speed alone."""
    start = time.perf_counter()
    coefficient = law.sliding_friction(1.0)
    rows = [_Point(scene, coefficient) for scene in scenes]
    columns = {name: np.array([row.columns[name] for row in rows]) for name in rows[0].columns}
    columns["seconds"] = np.full(len(rows), (time.perf_counter() - start) / len(rows))
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


class _Point:
    """One scene of prescribed slip and its answer."""

    def __init__(self, scene: Scene, coefficient: float) -> None:
        self.motion, self.belt_speed, self.coefficient = scene.motion(), scene.belt_speed, coefficient
        self.planar = scene.transverse_slip is not None
        self.along, self.across = self.motion.velocity, self.motion.transverse_velocity
        self.status: Status = "ok"
        self.reason, self.model, self.error_kind = "", "", "guaranteed"
        self.columns = self._answer()

    def _answer(self) -> dict[str, float]:
        if self.belt_speed == 0.0 and self.along == 0.0 and self.across == 0.0:
            return self._no_slip()
        edges = self._edges()
        found = _integrals(self.motion, self.belt_speed, edges)
        mean, error = complex(-found.mean), 8.0 * EPSILON
        if self.across == 0.0:
            mean = complex(self._along_the_belt(), 0.0)
            self.model = "closed form: slip prescribed along the belt"
        elif self.belt_speed == 0.0:
            mean = 0j
            self.model = "closed form: each half period of slip undoes the other"
        else:
            finer = _integrals(self.motion, self.belt_speed, _halved(edges))
            error = 4.0 * abs(finer.mean - found.mean) + 64.0 * EPSILON
            self.model = "prescribed slip: Gauss-Lobatto quadrature, panels graded towards slow slip"
            self.error_kind = "estimated"
        return self._row(mean, error, found)

    def _along_the_belt(self) -> float:
        size = abs(self.along)
        if size == 0.0:
            return math.copysign(1.0, self.belt_speed)
        return float(mean_prescribed_longitudinal(self.belt_speed / size))

    def _no_slip(self) -> dict[str, float]:
        self.status, self.error_kind = "not_unique", ""
        self.model = "closed form"
        self.reason = "nothing moves: friction at rest may be anything up to mu"
        nothing = dict.fromkeys(self._row(0j, 0.0, Integrals(0j, 0.0, 0.0)), math.nan)
        return nothing | {"mean_low": -self.coefficient, "mean_high": self.coefficient, "window": 1.0}

    def _row(self, mean: complex, error: float, found: Integrals) -> dict[str, float]:
        """Every column that applies; nothing is driven or damped, so no energy is put in or lost to viscosity."""
        force = self.coefficient * self.motion.normal_load
        turns = 2.0 if abs(self.belt_speed) < abs(self.along) else 0.0
        nan, a, c = math.nan, abs(self.along), abs(self.across)
        return {
            "mean_friction": self.coefficient * mean.real,
            "error": self.coefficient * error,
            "mean_low": nan,
            "mean_high": nan,
            "window": nan,
            "mean_friction_transverse": self.coefficient * mean.imag if self.planar else nan,
            "velocity_amplitude": a,
            "velocity_harmonic": a,
            "velocity_phase": nan,
            "transverse_velocity_amplitude": c if self.planar else nan,
            "transverse_velocity_harmonic": c if self.planar else nan,
            "transverse_velocity_phase": nan,
            "stick_fraction": 0.0,
            "reversals": turns,
            "force_reversals": turns,
            "energy_input": nan,
            "energy_viscous": nan,
            "energy_friction": force * found.taken,
            "energy_contact": force * found.contact,
            "period": 1.0,
            "floquet": nan,
        }

    def _edges(self) -> Floats:
        """Angles between which the friction is analytic far enough around every panel."""
        return _graded_circle(slow_passages(self.along, self.across, self.belt_speed))

    def orbit(self) -> Orbit | None:
        """The prescribed motion and the friction along it."""
        if self.status != "ok":
            return None
        edges = self._edges()
        edges = np.unique(np.concatenate(([0.0, 2.0 * math.pi], edges % (2.0 * math.pi))))
        angle, _ = _nodes(edges)
        turn = np.exp(1j * angle)
        v = (self.along * turn).imag + 1j * (self.across * turn).imag
        x = -((self.along * turn).real + 1j * (self.across * turn).real) / self.motion.frequency
        friction = self.coefficient * _direction(v - self.belt_speed)
        return Orbit(angle / self.motion.frequency, x, v, friction, np.zeros(len(angle), np.bool_))


def slow_passages(along: complex, across: complex, belt_speed: float) -> list[tuple[float, float]]:
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


def _graded_circle(passages: list[tuple[float, float]]) -> Floats:
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


def _halved(edges: Floats) -> Floats:
    return np.unique(np.concatenate((edges, 0.5 * (edges[1:] + edges[:-1]))))


def _nodes(edges: Floats) -> tuple[Floats, Floats]:
    half = 0.5 * np.diff(edges)[:, None]
    return edges[:-1, None] + half * (1.0 + NODES), half * WEIGHTS


def _direction(slip: NDArray[np.complex128]) -> NDArray[np.complex128]:
    """Unit vectors; zero at rest, which is an instant without duration."""
    speed = np.abs(slip)
    return slip / np.where(speed > 0.0, speed, 1.0)


def _integrals(motion: Motion, belt_speed: float, edges: Floats) -> Integrals:
    angle, weights = _nodes(edges)
    turn = np.exp(1j * angle)
    v = (motion.velocity * turn).imag + 1j * (motion.transverse_velocity * turn).imag
    slip = v - belt_speed
    direction = _direction(slip)
    mean = complex((weights * direction).sum() / (2.0 * math.pi))
    contact = float((weights * np.abs(slip)).sum()) / motion.frequency
    taken = float((weights * (direction * v.conjugate()).real).sum()) / motion.frequency
    return Integrals(mean, contact, taken)
