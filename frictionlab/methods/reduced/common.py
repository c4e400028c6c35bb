"""Code of all reduced models of Coulomb friction along a line: accepted scenes, model error, results.

A reduced model gives the motion as one harmonic. What it leaves out is told by its distance from the mean friction of
the full problem.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from frictionlab.compile.law_lanes import takes_lanes
from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import Answers, Status
from frictionlab.methods.exact.method import REDUCED
from frictionlab.methods.prescribed.motion import displacement, velocity
from frictionlab.methods.prescribed.quadrature import orbit_of_slip
from frictionlab.methods.reduced.full_mean import full_means
from frictionlab.methods.refusals import suggest_shooting
from frictionlab.orbit.record import Orbit
from frictionlab.quantities import Floats
from frictionlab.scene.body import Motion
from frictionlab.scene.scene import Scene
from frictionlab.scene.scenes import belt_speeds_of
from frictionlab.theory import friction_free_velocity
from frictionlab.theory.equivalent_drive import equivalent_drive
from frictionlab.theory.uniqueness import falls_slowly

ROUNDING = 1e-10
"""Of models, relative to the friction coefficient: their formulas keep twelve digits or more."""


@dataclass(frozen=True)
class Harmonic:
    """A model's motion at n belt speeds >= 0: Im(velocity exp(i Omega tau)), and the mean relative to mu.

    reasons: why the model has no answer at a belt speed; empty where it has.
    """

    mean: Floats
    velocity: NDArray[np.complex128]
    reasons: list[str]


class LeftOut(NamedTuple):
    """The error of each point of a model, and why it is not known; empty where it is."""

    error: Floats
    reasons: list[str]


class Modelled(NamedTuple):
    """Mean and error of every point of a model, and the seconds of all."""

    mean: Floats | NDArray[np.complex128]
    error: Floats
    seconds: float


UNBOUNDED_ENERGIES = "; energies are those of this motion, without an error"
"""Said of every row: what one harmonic leaves out is known in the mean friction alone."""

EQUIVALENT = "; the belt's vibration as the drive that is equivalent to it"

Model = Callable[[Scene, float, Floats], Harmonic]
"""(scene, friction = mu*normal_load, belt speeds >= 0) -> the model's motion."""


def line_refusal(name: str, scene: Scene, law: FrictionLaw) -> str | None:
    """Why a reduced model of motion along the belt cannot do this scene and law at any belt speed."""
    if scene.undriven:
        return f"{name} needs a drive: it starts from the driven motion"
    if not scene.load_along_belt_only:
        return suggest_shooting(f"{name} works along one line: this scene has a transverse load", scene, law)
    if law.memory_kind != "none":
        return f"{name} needs friction without memory (Coulomb)"
    if not law.constant_sliding_friction():
        return f"{name} needs friction that does not vary with speed (Coulomb)"
    if not law.monotone():
        return f"{name} has no error bound for mu_static above mu; use shooting"
    if not math.isfinite(friction_free_velocity(scene)):
        return f"{name} starts from the friction-free motion, which is unbounded at undamped resonance; use exact"
    return None


def plane_refusal(name: str, scene: Scene, law: FrictionLaw) -> str | None:
    """Why the steady state of a motion in the plane may not be unique at any belt speed; None where it is."""
    mass = scene.mass()
    damping = [mass.damping] if scene.load_along_belt_only else [mass.damping, mass.transverse_damping]
    if min(damping) == 0.0:
        return f"{name} needs damping in every driven direction: without it the motion depends on the start"
    if not falls_slowly(scene, law):
        return f"{name} needs damping that outweighs the fall of friction: else the steady state may not be unique"
    return None


def tailless_refusal(
    name: str, scene: Scene, law: FrictionLaw, wants: str, no_tail: str | None
) -> str | None:
    """Why harmonics of friction that varies with the slip speed cannot do this at any belt speed; None if they can.

    wants: of a law whose friction is no function of the slip speed. no_tail: where a tail is asked for, why there is
    none.
    """
    if scene.undriven:
        return f"{name} needs a drive: it starts from the driven motion"
    if not takes_lanes(law):
        return wants
    return no_tail or plane_refusal(name, scene, law)


def steadied(scene: Scene) -> Scene | None:
    """The scene that a reduced model answers: the same, or that of the drive equivalent to its belt's vibration."""
    if scene.is_harmonic:
        return scene
    other = equivalent_drive(scene)
    return None if other is None else other.scene


def answer_steadied(scenes: Sequence[Scene], answer: Callable[[Sequence[Scene]], Answers]) -> Answers:
    """The answers of scenes on belts that vibrate by those of their equivalent drives, with the body's own motion."""
    other = equivalent_drive(scenes[0])
    if other is None:
        return answer(scenes)
    found = answer(steadied_all(scenes))
    carried = Motion(1.0, scenes[0].frequency, other.velocity, other.transverse_velocity)

    def orbit(i: int) -> Orbit | None:
        one = found.orbit(i)
        if one is None:
            return None
        angle = scenes[0].frequency * one.tau
        return replace(one, x=one.x + displacement(carried, angle), v=one.v + velocity(carried, angle))

    said = [text + EQUIVALENT if text else text for text in found.model]
    return replace(found, model=said, orbit=orbit, orbits=None)


def point_refusal(scene: Scene, friction: float) -> str:
    """Why the steady state at this belt speed is not unique; empty where it is."""
    mass = scene.mass()
    if scene.belt_speed == 0.0 and abs(mass.force) <= friction:
        return (
            "the belt is at rest and static friction balances the load: the mass may rest anywhere in a range"
        )
    if mass.damping == 0.0 and abs(scene.belt_speed) >= friction_free_velocity(scene):
        return "without damping and without slip reversal the free oscillation does not decay; use exact"
    return ""


def steadied_all(scenes: Sequence[Scene]) -> Sequence[Scene]:
    """Scenes that differ in belt speed alone as a reduced model takes them: on a belt that does not vibrate."""
    other = equivalent_drive(scenes[0])
    if other is None:
        return scenes
    return [other.scene.model_copy(update={"belt_speed": scene.belt_speed}) for scene in scenes]


def line_means(scenes: Sequence[Scene], law: FrictionLaw, model: Model) -> Floats:
    """The mean friction of a model along the belt, without its error."""
    mu, speeds = law.sliding_friction(1.0), belt_speeds_of(scenes)
    found = model(scenes[0], mu * scenes[0].mass().normal_load, np.abs(speeds))
    answered = np.array([not reason for reason in found.reasons])
    return np.where(answered, mu * np.copysign(found.mean, speeds), np.nan)


def answer_line(
    scenes: Sequence[Scene], law: FrictionLaw, tolerance: float, text: str, model: Model
) -> Answers:
    """Answers of a model on scenes that differ in belt speed alone."""
    start = time.perf_counter()
    mu = law.sliding_friction(1.0)
    speeds = belt_speeds_of(scenes)
    friction = mu * scenes[0].mass().normal_load
    found = model(scenes[0], friction, np.abs(speeds))
    mean = mu * np.copysign(found.mean, speeds)
    against = [
        point_refusal(scene, friction) or own for scene, own in zip(scenes, found.reasons, strict=True)
    ]
    left_out = far_from_full(scenes, law, mean, against)
    seconds = time.perf_counter() - start
    text += REDUCED if scenes[0].degrees_of_freedom == 2 else ""

    def orbit(i: int) -> Orbit:
        return _orbit(scenes[i], law, found, i)

    return judged(Modelled(mean, left_out.error, seconds), left_out.reasons, text, tolerance, orbit)


def far_from_full(
    scenes: Sequence[Scene], law: FrictionLaw, mean: Floats, against: Sequence[str] = ()
) -> LeftOut:
    """By the distance of these means from those of the full problem, asked for where nothing speaks against it."""
    reasons = list(against) or [""] * len(scenes)
    asked = [i for i, reason in enumerate(reasons) if not reason]
    error = np.full(len(scenes), np.nan)
    if asked:
        full = full_means([scenes[i] for i in asked], law)
        speeds = np.abs(belt_speeds_of([scenes[i] for i in asked]))
        size = ROUNDING * np.array([law.sliding_friction(speed) for speed in speeds.tolist()])
        error[asked] = np.abs(full.mean - mean[asked]) + full.error + size
        for i, reason in zip(asked, full.reasons, strict=True):
            reasons[i] = reason
    return LeftOut(error, reasons)


def judged(
    found: Modelled, reasons: Sequence[str], text: str, tolerance: float, orbit: Callable[[int], Orbit | None]
) -> Answers:
    """Results: points with a reason are refused, errors above the tolerance noted."""
    status: list[Status] = ["refused" if reason else "ok" for reason in reasons]
    against = np.array([bool(reason) for reason in reasons])
    said = [
        reason or (f"model error above the tolerance {tolerance:.1e}" if not error <= tolerance else "")
        for reason, error in zip(reasons, found.error, strict=True)
    ]
    return Answers(
        status=status,
        reason=said,
        model=["" if reason else text + UNBOUNDED_ENERGIES for reason in reasons],
        error_kind=["" if reason else "estimated" for reason in reasons],
        mean=np.where(against, np.nan, found.mean),
        error=np.where(against, np.nan, found.error),
        period=np.where(against, np.nan, 1.0),
        seconds=np.full(len(reasons), found.seconds / len(reasons)),
        orbit=lambda i: None if reasons[i] else orbit(i),
        balanced=False,
    )


def model_orbit(motion: Motion, belt_speed: float, law: FrictionLaw, position: complex) -> Orbit:
    """A model's harmonic motion about a position and the friction along it; no model of one harmonic knows rest."""
    return replace(orbit_of_slip(motion, belt_speed, law, position), stick=None)


def _orbit(scene: Scene, law: FrictionLaw, found: Harmonic, i: int) -> Orbit:
    """The model's motion about the position where its mean friction loads the spring."""
    mass = scene.mass()
    motion = Motion(mass.normal_load, mass.frequency, complex(found.velocity[i]), 0j)
    pulled = mass.normal_load * law.sliding_friction(1.0) * math.copysign(found.mean[i], scene.belt_speed)
    return model_orbit(motion, scene.belt_speed, law, complex(pulled, 0.0))
