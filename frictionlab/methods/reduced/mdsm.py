"""Direct separation of motion: the mean friction of the friction-free motion."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import ClassVar

import numpy as np

from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import Answers, beyond_linear
from frictionlab.methods.prescribed.method import solve_prescribed
from frictionlab.methods.prescribed.varying_slip import VaryingPoint, VaryingSlip, piece_at
from frictionlab.methods.reduced.common import (
    HELD,
    Modelled,
    OfOneModel,
    Sines,
    line_refusal,
    mean_position,
    modelled_along,
    plane_refusal,
    steadied,
)
from frictionlab.methods.words import ModelWord
from frictionlab.motion.orbit.record import Orbit
from frictionlab.scene.body import Motion
from frictionlab.scene.scene import Scene
from frictionlab.scene.scenes import belt_speeds_of
from frictionlab.theory import (
    friction_free_velocity,
    mean_prescribed_circular,
    mean_prescribed_longitudinal,
    mean_prescribed_transverse,
)
from frictionlab.theory.linear import friction_free_response, less
from frictionlab.theory.rest import stays_at_rest
from frictionlab.values.quantities import EPSILON, Floats


class Mdsm(OfOneModel):
    """Direct separation of motion: the fast motion as if there were no friction, friction averaged over it.

    Along the belt the mean is a closed form, in the plane a quadrature over the friction-free ellipse. A
    prescribed slip has no motion to separate. Its mean is exact: in closed form along the belt, across it and
    for a circle, by quadrature for other ellipses. The error is the effect of friction on the motion.

    Parameters
    ----------
    error : {"distance"}, default "distance"
        Kind of the error, always the distance to the mean of ``exact`` or ``shooting``.

    References
    ----------
    Source: Sulollari, van Dalen & Cabboi, Eqs. 5 and 6; in the plane the same mean over both components.

    Examples
    --------
    >>> import frictionlab as fl
    >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1))
    >>> state = fl.steady_state(scene, fl.Coulomb(mu=0.4), method="mdsm")
    >>> round(state.mean_friction, 4), state.error < 0.026
    (0.0255, True)
    """

    name: ClassVar[str] = "mdsm"
    in_words: ClassVar[str] = "closed form"

    def refusal(self, scene: Scene, law: FrictionLaw) -> str | None:
        """Friction with memory, no drive, no one steady state."""
        if law.memory_kind != "none":
            return "mdsm needs friction without memory (a sliding law)"
        if scene.degrees_of_freedom == 0:
            return None
        if reason := beyond_linear(self.name, scene):
            return reason
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
        return super().solve(scenes, law, tolerance)

    def modelled(self, scenes: Sequence[Scene], law: FrictionLaw) -> Modelled:
        """Return the friction-free motion."""
        if scenes[0].is_harmonic and _in_closed_form(scenes[0], law):
            return modelled_along(scenes, law, ModelWord.MDSM_CLOSED, _friction_free)
        return _averaged(scenes, law)


def _in_closed_form(scene: Scene, law: FrictionLaw) -> bool:
    return scene.load_along_belt_only and law.constant_sliding_friction()


def _friction_free(scene: Scene, friction: float, belt_speeds: Floats) -> Sines:
    """Return the linear response, whatever the friction."""
    free = friction_free_velocity(scene)
    ratio = belt_speeds / free if free else np.where(belt_speeds > 0.0, math.inf, 0.0)
    mean = mean_prescribed_longitudinal(np.minimum(ratio, 1.0))
    velocity = np.full(len(belt_speeds), friction_free_motion(scene).velocity)
    return mean, velocity


def friction_free_motion(scene: Scene) -> Motion:
    """Return the linear response along and across the belt."""
    mass = scene.mass()
    along = mass.damping + 1j * (mass.frequency - mass.stiffness / mass.frequency)
    across = mass.transverse_damping + 1j * (mass.frequency - mass.transverse_stiffness / mass.frequency)
    sideways = mass.transverse_force / across if mass.transverse_force else 0j
    return Motion(mass.normal_load, mass.frequency, mass.force / along, sideways)


def _averaged(scenes: Sequence[Scene], law: FrictionLaw) -> Modelled:
    """By quadrature over the friction-free motion; of sines on a belt at rest the mean is zero by symmetry."""
    points = [VaryingPoint(scene, law, _friction_free_slip(scene, law)) for scene in scenes]
    means = np.array([point.found.mean for point in points])
    reasons = [
        point.reason if point.status != "ok" else HELD if stays_at_rest(scene, law) else ""
        for scene, point in zip(scenes, points, strict=True)
    ]
    error = np.array([point.found.error for point in points])

    def orbit(i: int) -> Orbit:
        velocity, position = (friction_free_response(scenes[i], law, order) for order in (1, 0))
        assert velocity is not None
        assert position is not None
        tau, friction = points[i].slip.friction(scenes[i].belt_speed, law)
        k = piece_at(points[i].slip.along.edges, 0.5 * (tau[:, :1] + tau[:, -1:]))
        x, v = (one.at(tau, k)[0] + 1j * other.at(tau, k)[0] for one, other in (position, velocity))
        return Orbit(tau, mean_position(scenes[i], complex(means[i])) + x, v, friction, None)

    sines = scenes[0].is_harmonic
    settled = belt_speeds_of(scenes) == 0.0 if sines and law.obeys("oddness") else None
    return Modelled(
        means, reasons, ModelWord.MDSM_PLANE if sines else ModelWord.MDSM_WAVES, orbit, error, settled=settled
    )


def _friction_free_slip(scene: Scene, law: FrictionLaw) -> VaryingSlip:
    """Return the slip of the friction-free motion over the belt's vibration, about the belt's mean speed."""
    assert scene.normal_load is not None
    belt, velocity = VaryingSlip.of(scene.signals(), scene.normal_load), friction_free_response(scene, law, 1)
    assert velocity is not None
    along, across = (less(own, other) for own, other in zip(velocity, (belt.along, belt.across), strict=True))
    waves = (*along.waves, *across.waves, *belt.normal_load.waves)
    free = 1.0 if along.free or across.free else 0.0
    quickest = max([scene.frequency, free, *(wave.frequency for wave in waves)])
    return VaryingSlip(along, across, belt.normal_load, quickest)


def _answer_prescribed(scenes: Sequence[Scene], law: FrictionLaw, tolerance: float) -> Answers:
    """Return the exact mean; where there is a closed form beyond the one along the belt, by that."""
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
    """Return the mean relative to mu, and what slip it is of."""
    along, across = motion.velocity, motion.transverse_velocity
    if along == 0.0 and across != 0.0:
        mean = mean_prescribed_transverse(belt_speed / abs(across))
        return float(mean), ModelWord.SLIP_ACROSS
    turning = sorted((abs(along + 1j * across), abs(along - 1j * across)))
    if along != 0.0 and turning[0] <= 4.0 * EPSILON * turning[1]:
        mean = mean_prescribed_circular(belt_speed / abs(along))
        return float(mean), ModelWord.SLIP_ON_A_CIRCLE
    return None
