"""Direct separation of motion: the mean friction of the friction-free motion."""

from __future__ import annotations

import math
import time
from collections.abc import Sequence
from dataclasses import replace
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import Answers, ReducedModel
from frictionlab.methods.prescribed.method import solve_prescribed
from frictionlab.methods.prescribed.quadrature import integrals, slip_edges
from frictionlab.methods.reduced.common import (
    ROUNDING,
    Harmonic,
    Modelled,
    answer_line,
    answer_steadied,
    far_from_full,
    judged,
    line_means,
    line_refusal,
    model_orbit,
    plane_refusal,
    steadied,
    steadied_all,
)
from frictionlab.methods.reduced.waveforms import answer_waveforms, waveform_means
from frictionlab.orbit.record import Orbit
from frictionlab.quantities import EPSILON, Floats
from frictionlab.scene.body import Motion
from frictionlab.scene.scene import Scene
from frictionlab.theory import (
    friction_free_velocity,
    mean_prescribed_circular,
    mean_prescribed_longitudinal,
    mean_prescribed_transverse,
)
from frictionlab.theory.rest import friction_at_rest

ALONG = "direct separation of motion: closed-form mean over the friction-free motion (Eqs. 5, 6)"
PLANE = "direct separation of motion: quadrature over the friction-free motion"


class Mdsm(ReducedModel):
    """Direct separation of motion: the fast motion as if there were no friction, friction averaged over it.

    Along the belt a closed form, in the plane a quadrature over the friction-free ellipse. A prescribed slip has no
    motion to separate: its mean is exact, in closed form along the belt, across it and for a circle, by quadrature
    for other ellipses. The error is what friction does to the motion: the distance to the mean of ``exact`` or
    ``shooting``.

    Source: Sulollari, van Dalen & Cabboi, Eqs. 5 and 6; in the plane the same mean over both components.

    >>> import frictionlab as fl
    >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1))
    >>> state = fl.steady_state(scene, fl.Coulomb(mu=0.4), method="mdsm")
    >>> round(state.mean_friction, 4), state.error < 0.026
    (0.0255, True)
    """

    name: ClassVar[str] = "mdsm"

    def refusal(self, scene: Scene, law: FrictionLaw) -> str | None:
        """Friction with memory, no drive, no one steady state."""
        if law.memory_kind != "none":
            return "mdsm needs friction without memory (a sliding law)"
        if scene.degrees_of_freedom == 0:
            return None
        if scene.undriven:
            return "mdsm needs a drive: it averages over the driven motion"
        steady = steadied(scene)
        if steady is not None and _in_closed_form(steady, law):
            return line_refusal(self.name, steady, law)
        return plane_refusal(self.name, scene, law)

    def solve(self, scenes: Sequence[Scene], law: FrictionLaw, tolerance: float) -> Answers:
        """Answer scenes that differ in belt speed alone."""
        if scenes[0].degrees_of_freedom == 0:
            return _answer_prescribed(scenes, law, tolerance)
        if steadied(scenes[0]) is None:
            return answer_waveforms(scenes, law, tolerance)
        return answer_steadied(scenes, lambda others: _answer_sines(others, law, tolerance))

    def model_means(self, scenes: Sequence[Scene], law: FrictionLaw) -> Floats | NDArray[np.complex128]:
        """Of the friction-free motion."""
        if steadied(scenes[0]) is None:
            return waveform_means(scenes, law)
        steady = steadied_all(scenes)
        if _in_closed_form(steady[0], law):
            return line_means(steady, law, friction_free)
        motion = friction_free_motion(steady[0])
        return np.array([_plane_mean(scene, law, motion)[0] for scene in steady])

    def cost(self, scene: Scene, law: FrictionLaw, tolerance: float) -> float:
        """Nearly all of it for the error: the full answer."""
        if scene.degrees_of_freedom == 0 or not _in_closed_form(scene, law):
            return 3e-3
        return 5e-5 * max(1.0, 1.0 / scene.frequency)


def _answer_sines(scenes: Sequence[Scene], law: FrictionLaw, tolerance: float) -> Answers:
    if _in_closed_form(scenes[0], law):
        return answer_line(scenes, law, tolerance, ALONG, friction_free)
    return _answer_plane(scenes, law, tolerance)


def _in_closed_form(scene: Scene, law: FrictionLaw) -> bool:
    return scene.load_along_belt_only and law.constant_sliding_friction()


def friction_free(scene: Scene, friction: float, belt_speeds: Floats) -> Harmonic:
    """The linear response, whatever the friction."""
    free, motion = friction_free_velocity(scene), friction_free_motion(scene)
    ratio = belt_speeds / free if free else np.where(belt_speeds > 0.0, math.inf, 0.0)
    mean = mean_prescribed_longitudinal(np.minimum(ratio, 1.0))
    velocity = np.full(len(belt_speeds), motion.velocity)
    return Harmonic(mean, velocity, [""] * len(belt_speeds))


def friction_free_motion(scene: Scene) -> Motion:
    """The linear response along and across the belt."""
    mass = scene.mass()
    along = mass.damping + 1j * (mass.frequency - mass.stiffness / mass.frequency)
    across = mass.transverse_damping + 1j * (mass.frequency - mass.transverse_stiffness / mass.frequency)
    sideways = mass.transverse_force / across if mass.transverse_force else 0j
    return Motion(mass.normal_load, mass.frequency, mass.force / along, sideways)


def _answer_plane(scenes: Sequence[Scene], law: FrictionLaw, tolerance: float) -> Answers:
    start = time.perf_counter()
    motion = friction_free_motion(scenes[0])
    means, rounding = (
        np.array(values)
        for values in zip(*(_plane_mean(scene, law, motion) for scene in scenes), strict=True)
    )
    at_rest = [scene.belt_speed == 0.0 for scene in scenes]
    left_out = far_from_full(scenes, law, means.real, ["at rest" if rest else "" for rest in at_rest])
    reasons = [
        _at_rest(scene, law) if rest else reason
        for scene, rest, reason in zip(scenes, at_rest, left_out.reasons, strict=True)
    ]
    errors = rounding + np.where(at_rest, 0.0, left_out.error)

    def orbit(i: int) -> Orbit:
        return model_orbit(motion, scenes[i].belt_speed, law, _position(scenes[i], means[i]))

    return judged(Modelled(means, errors, time.perf_counter() - start), reasons, PLANE, tolerance, orbit)


def _plane_mean(scene: Scene, law: FrictionLaw, motion: Motion) -> tuple[complex, float]:
    """Mean friction over the friction-free motion, and the error of its quadrature."""
    found = integrals(motion, scene.belt_speed, law, slip_edges(motion, scene.belt_speed))
    return (0j if scene.belt_speed == 0.0 else -found.mean), ROUNDING * found.largest


def _at_rest(scene: Scene, law: FrictionLaw) -> str:
    """Why the mean over a belt at rest, zero by symmetry, is not the only one; empty where it is."""
    mass = scene.mass()
    forward = abs(mass.force + 1j * mass.transverse_force)
    backward = abs(mass.force.conjugate() + 1j * mass.transverse_force.conjugate())
    if 0.5 * (forward + backward) > friction_at_rest(law) * mass.normal_load:
        return ""
    return "the belt is at rest and static friction balances the loads: the mass may rest anywhere in a range"


def _position(scene: Scene, mean: complex) -> complex:
    """The mean position, at which the springs balance mean friction."""
    mass = scene.mass()
    return mass.normal_load * complex(mean.real, mean.imag / mass.transverse_stiffness)


def _answer_prescribed(scenes: Sequence[Scene], law: FrictionLaw, tolerance: float) -> Answers:
    """The exact mean; where there is a closed form beyond the one along the belt, by that."""
    answers = solve_prescribed(scenes, law, tolerance)
    if not law.constant_sliding_friction() or not scenes[0].is_harmonic:
        return answers
    mu, model = law.sliding_friction(1.0), list(answers.model)
    reason, kind = list(answers.reason), list(answers.error_kind)
    mean, error = answers.mean.copy(), answers.error.copy()
    for i, scene in enumerate(scenes):
        closed = _closed_form(scene.motion(), scene.belt_speed) if answers.status[i] == "ok" else None
        if closed is not None:
            mean[i], model[i] = complex(mu * closed[0], mean[i].imag), closed[1]
            error[i], kind[i], reason[i] = 32.0 * EPSILON * mu, "guaranteed", ""
    return replace(answers, mean=mean, error=error, model=model, error_kind=kind, reason=reason)


def _closed_form(motion: Motion, belt_speed: float) -> tuple[float, str] | None:
    """The mean relative to mu, and what slip it is of."""
    along, across = motion.velocity, motion.transverse_velocity
    if along == 0.0 and across != 0.0:
        return float(
            mean_prescribed_transverse(belt_speed / abs(across))
        ), "closed form: slip prescribed across the belt"
    turning = sorted((abs(along + 1j * across), abs(along - 1j * across)))
    if along != 0.0 and turning[0] <= 4.0 * EPSILON * turning[1]:
        return float(
            mean_prescribed_circular(belt_speed / abs(along))
        ), "closed form: slip prescribed on a circle"
    return None
