"""Harmonic balance in the plane, two harmonics or more: answers on samples, their errors and orbits."""

from __future__ import annotations

import math
import time
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import Answers
from frictionlab.methods.reduced.common import Modelled, far_from_full, judged, tailless_refusal
from frictionlab.methods.reduced.sampled_harmonics import (
    PlanarMotion,
    balanced_in_the_plane,
    friction_vectors,
    planar_balance,
)
from frictionlab.orbit.panels import NODES
from frictionlab.orbit.record import Orbit
from frictionlab.scene.scene import Scene
from frictionlab.scene.scenes import belt_speeds_of

SAMPLED = "{harmonics} harmonics of planar motion and of friction balanced on samples, those beyond left out"
NO_TAIL = (
    "{name} has no tail in closed form where friction turns instead of switching (two directions): leave tail out, "
    "or give tail: false"
)
ALONG_THE_SLIP = (
    "{name} in the plane needs friction along the slip, a function of its speed alone; use shooting"
)
NOT_SETTLED = (
    "Newton's method does not settle on a motion of {harmonics} harmonics: slip passes too near rest for so few; use "
    "shooting"
)
_PANELS_PER_HARMONIC = 2
_FEWEST_PANELS = 16


def planar_refusal(name: str, scene: Scene, law: FrictionLaw, tail: bool | None) -> str | None:
    """Why H harmonics on samples cannot do this scene and law at any belt speed; None if they can."""
    no_tail = NO_TAIL.format(name=name) if tail else None
    return tailless_refusal(name, scene, law, ALONG_THE_SLIP.format(name=name), no_tail)


def planar_means(scenes: Sequence[Scene], law: FrictionLaw, harmonics: int) -> NDArray[np.complex128]:
    """The mean friction of the model alone; NaN where there is none."""
    return _means(scenes, _motions(scenes, law, harmonics))


def answer_planar(scenes: Sequence[Scene], law: FrictionLaw, tolerance: float, harmonics: int) -> Answers:
    """Answers on scenes that differ in belt speed alone, their errors the distance to the full means."""
    start = time.perf_counter()
    motions = _motions(scenes, law, harmonics)
    means = _means(scenes, motions)
    without = ["" if motion else NOT_SETTLED.format(harmonics=harmonics) for motion in motions]
    left_out = far_from_full(scenes, law, means.real, without)

    def orbit(i: int) -> Orbit | None:
        motion = motions[i]
        return None if motion is None else _orbit(scenes[i], law, motion, complex(means[i]))

    found = Modelled(means, left_out.error, time.perf_counter() - start)
    return judged(found, left_out.reasons, SAMPLED.format(harmonics=harmonics), tolerance, orbit)


def _motions(scenes: Sequence[Scene], law: FrictionLaw, harmonics: int) -> list[PlanarMotion | None]:
    """From the fastest belt on, each from the one before; where that leads nowhere from the friction-free motion."""
    what = planar_balance(scenes[0].mass(), law, harmonics)
    found: list[PlanarMotion | None] = [None] * len(scenes)
    start = what.friction_free()
    for i in np.argsort(-np.abs(belt_speeds_of(scenes)), kind="stable").tolist():
        motion = balanced_in_the_plane(what, scenes[i].belt_speed, start)
        found[i] = motion or balanced_in_the_plane(what, scenes[i].belt_speed, what.friction_free())
        start = motion.velocity if motion else start
    return found


def _means(scenes: Sequence[Scene], motions: Sequence[PlanarMotion | None]) -> NDArray[np.complex128]:
    nothing = complex(math.nan, math.nan)
    means = np.array([nothing if motion is None else -complex(*motion.mean) for motion in motions])
    # On a belt at rest both vanish by symmetry.
    still = np.array([scene.belt_speed == 0.0 for scene in scenes])
    return np.where(still & np.isfinite(means), 0j, means)


def _orbit(scene: Scene, law: FrictionLaw, motion: PlanarMotion, mean: complex) -> Orbit:
    """The motion about the position where its mean friction loads the springs."""
    mass, harmonics = scene.mass(), motion.velocity.shape[1]
    edges = np.linspace(0.0, math.tau, 1 + max(_FEWEST_PANELS, _PANELS_PER_HARMONIC * harmonics))
    half = 0.5 * np.diff(edges)[:, None]
    angle = edges[:-1, None] + half * (1.0 + NODES)
    orders = np.arange(1.0, harmonics + 1.0)
    turns = np.exp(1j * np.multiply.outer(angle, orders))
    v = [np.einsum("pnk,k->pn", turns, row).real for row in motion.velocity]
    x = [np.einsum("pnk,k->pn", turns, row / (1j * mass.frequency * orders)).real for row in motion.velocity]
    slip = np.stack([(v[0] - scene.belt_speed).ravel(), v[1].ravel()])
    friction = friction_vectors(law, slip)[0].reshape(2, *angle.shape)
    position = mass.normal_load * complex(mean.real, mean.imag / mass.transverse_stiffness)
    return Orbit(
        angle / mass.frequency,
        position + x[0] + 1j * x[1],
        v[0] + 1j * v[1],
        friction[0] + 1j * friction[1],
        None,
    )
