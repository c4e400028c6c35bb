"""Base of reduced models: the scenes they refuse, what a model says, and its distance to the full problem."""

from __future__ import annotations

import math
import time
from abc import abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import Answers, Ledger, ReducedModel, beyond_linear
from frictionlab.methods.exact.method import Exact
from frictionlab.methods.prescribed.varying_slip import VaryingSlip
from frictionlab.methods.shooting.method import Shooting, suggest_shooting
from frictionlab.methods.words import ModelWord
from frictionlab.motion.orbit.record import Orbit
from frictionlab.scene.body import Motion
from frictionlab.scene.scene import Scene
from frictionlab.scene.scenes import belt_speeds_of
from frictionlab.theory import friction_free_velocity
from frictionlab.theory.one_harmonic import equivalent_drive
from frictionlab.theory.rest import falls_slowly, size_of_friction
from frictionlab.values.quantities import Floats

ROUNDING = 1e-10
"""Rounding of models, relative to the friction coefficient: their formulas keep twelve digits or more."""
TOLERANCE = 1e-9
"""On the mean of the full problem, relative to the friction coefficient in quick slip."""
NOT_KNOWN = "the model error is not known, for the steady state is not"
UNSTEADY = "the motion of one drive period may be unstable: the mean may not be unique; use shooting"
AT_REST = (
    "on a belt at rest one harmonic gives sliding only if the load exceeds 4/pi of mu*normal_load; use exact"
)
HELD = "the belt is at rest and static friction balances the loads: the mass may rest anywhere in a range"
DOES_NOT_DECAY = "without damping and without slip reversal the free oscillation does not decay; use exact"


class Modelled(NamedTuple):
    """Answers of a model for n scenes.

    mean: friction coefficient, x1 + i x2 where it has two directions; NaN where the model has none. reasons: why a
    scene has no answer; empty where it has. orbit(i): the motion of scene i. error: of the numbers of the model,
    beyond the rounding of formulas. steadiest: the largest Floquet multiplier of the full motion up to which its mean
    is the only one. settled: where symmetry says the mean, whatever the model leaves out.
    """

    mean: Floats | NDArray[np.complex128]
    reasons: list[str]
    text: str
    orbit: Callable[[int], Orbit | None]
    error: Floats | float = 0.0
    steadiest: float = math.inf
    settled: NDArray[np.bool_] | None = None


class OfOneModel(ReducedModel):
    """A reduced model whose answers are those of ``modelled``, their errors the distance to the full means."""

    @abstractmethod
    def modelled(self, scenes: Sequence[Scene], law: FrictionLaw) -> Modelled:
        """Return the answers for scenes that differ in belt speed alone, on ``steadied`` belts if the model can."""

    def model_means(self, scenes: Sequence[Scene], law: FrictionLaw) -> Floats | NDArray[np.complex128]:
        """Return the means of ``modelled``."""
        return self.modelled(steadied_all(scenes), law).mean

    def solve(self, scenes: Sequence[Scene], law: FrictionLaw, tolerance: float) -> Answers:
        """Answer scenes that differ in belt speed alone; errors above the tolerance are noted."""
        start = time.perf_counter()
        steady = steadied_all(scenes)
        found = self.modelled(steady, law)
        error, reasons = _left_out(steady, law, found)
        seconds = (time.perf_counter() - start) / len(scenes)
        decays = steady[0].degrees_of_freedom == 2 and steady[0].load_along_belt_only
        text = f"{found.text}; {ModelWord.X2_DECAYS}" if decays else str(found.text)
        text += f"; {ModelWord.EQUIVALENT_DRIVE}" if steady is not scenes else ""
        ledger = Ledger(len(scenes))
        for i, reason in enumerate(reasons):
            if reason:
                ledger.fail(i, reason, "refused")
                continue
            ledger.accept(i, found.mean[i], error[i], float(scenes[0].periods))
            ledger.model[i] = text
            if not error[i] <= tolerance:
                ledger.remark(i, f"model error above the tolerance {tolerance:.1e}")
        ledger.seconds[:] = seconds
        return ledger.answers(
            orbit=lambda i: None if reasons[i] else _carried(scenes[i], found.orbit(i)), balanced=False
        )


def _left_out(scenes: Sequence[Scene], law: FrictionLaw, found: Modelled) -> tuple[Floats, list[str]]:
    """Error of each mean, and why it is not known; the full problem is asked where nothing speaks against it."""
    own, reasons = found.error + np.zeros(len(scenes)), list(found.reasons)
    settled = np.zeros(len(scenes), np.bool_) if found.settled is None else found.settled
    error = np.where(settled, own, np.nan)
    asked = [i for i, reason in enumerate(reasons) if not reason and not settled[i]]
    if not asked:
        return error, reasons
    speeds = belt_speeds_of(scenes)[asked]
    # Half periods of sines mirror each other: a belt that runs the other way has minus the mean under an odd law.
    mirrored = scenes[0].is_harmonic and law.obeys("oddness")
    sides = np.copysign(1.0, speeds) if mirrored else np.ones(len(asked))
    speeds, back = np.unique(sides * speeds, return_inverse=True)
    full = full_means(scenes[0], law.under_load(scenes[0].mass().normal_load), speeds)
    rounding = ROUNDING * np.array([law.sliding_friction(speed) for speed in np.abs(speeds).tolist()])
    far = np.abs(sides * np.real(full.mean)[back] - found.mean.real[asked])
    error[asked] = far + (full.error + rounding)[back] + own[asked]
    steady = np.ones(len(speeds), np.bool_)
    if found.steadiest < math.inf and full.floquet is not None:
        steady = ~(full.floquet() > found.steadiest)
    for i, k in zip(asked, back.tolist(), strict=True):
        if not steady[k]:
            reasons[i] = UNSTEADY
        elif full.status[k] != "ok":
            reasons[i] = f"{NOT_KNOWN} ({full.reason[k]}); use shooting"
    return error, reasons


def full_means(scene: Scene, law: FrictionLaw, belt_speeds: Floats) -> Answers:
    """Return the means of a scene at other belt speeds: by the exact method where it takes them, else by shooting."""
    free = [
        scene.model_copy(update={"initial": None, "dimensional": None, "belt_speed": speed})
        for speed in belt_speeds.tolist()
    ]
    return full_answers(free, law)


def full_answers(scenes: Sequence[Scene], law: FrictionLaw) -> Answers:
    """Answer scenes that differ in belt speed alone by the exact method where it takes them, else by shooting."""
    method = Exact() if not any(Exact().refusals(scenes, law)) else Shooting()
    return method.solve(scenes, law, TOLERANCE * size_of_friction(scenes[0], law))


def _carried(scene: Scene, orbit: Orbit | None) -> Orbit | None:
    """Return the body's own motion on a belt that vibrates, from that of its equivalent drive."""
    other = equivalent_drive(scene)
    if orbit is None or other is None:
        return orbit
    turn = np.exp(1j * scene.frequency * orbit.tau)
    along, across = other.velocity * turn, other.transverse_velocity * turn
    x = orbit.x - (along.real + 1j * across.real) / scene.frequency
    return replace(orbit, x=x, v=orbit.v + along.imag + 1j * across.imag)


def steadied_all(scenes: Sequence[Scene]) -> Sequence[Scene]:
    """Scenes that differ in belt speed alone, on a belt that does not vibrate where an equivalent drive does it."""
    other = equivalent_drive(scenes[0])
    if other is None:
        return scenes
    return [other.scene.model_copy(update={"belt_speed": scene.belt_speed}) for scene in scenes]


def steadied(scene: Scene) -> Scene | None:
    """Return the same of one scene, None where more than one sine is left."""
    steady = steadied_all([scene])[0]
    return steady if steady.is_harmonic else None


def line_refusal(name: str, scene: Scene, law: FrictionLaw) -> str | None:
    """Why a reduced model of Coulomb friction along the belt cannot do this scene and law at any belt speed."""
    if reason := beyond_linear(name, scene):
        return reason
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


def line_reasons(scene: Scene, friction: float, belt_speeds: Floats, mean: Floats, without: str) -> list[str]:
    """Why there is no one steady state along the belt, or no mean of the model; empty where there are."""
    mass = scene.mass()
    held = (belt_speeds == 0.0) & (abs(mass.force) <= friction)
    undamped = (mass.damping == 0.0) & (np.abs(belt_speeds) >= friction_free_velocity(scene))
    against, texts = [held, undamped, np.isnan(mean)], [HELD, DOES_NOT_DECAY, without]
    if not np.any(against):
        return [""] * len(mean)
    found: list[str] = np.select(against, texts, "").tolist()
    return found


Sines = tuple[Floats, NDArray[np.complex128]]
"""A motion at n belt speeds >= 0: its mean relative to mu, NaN without one, and V of Im(V exp(i Omega tau))."""


def modelled_along(
    scenes: Sequence[Scene], law: FrictionLaw, text: str, found: Callable[[Scene, float, Floats], Sines]
) -> Modelled:
    """A model of Coulomb friction along the belt; found: of a scene, mu*normal_load and belt speeds >= 0."""
    mu, speeds, mass = law.sliding_friction(1.0), belt_speeds_of(scenes), scenes[0].mass()
    friction = mu * mass.normal_load
    share, velocities = found(scenes[0], friction, np.abs(speeds))
    mean = mu * np.copysign(share, speeds)

    def orbit(i: int) -> Orbit:
        sine = Motion(mass.normal_load, mass.frequency, complex(velocities[i]), 0j)
        return orbit_of_sines(sine, float(speeds[i]), law, complex(mean[i]) * mass.normal_load)

    reasons = line_reasons(scenes[0], friction, speeds, mean, AT_REST)
    return Modelled(mean, reasons, text, orbit)


def mean_position(scene: Scene, mean: complex) -> complex:
    """Return where the springs balance mean friction."""
    mass = scene.mass()
    return mass.normal_load * complex(mean.real, mean.imag / mass.transverse_stiffness)


def orbit_of_sines(motion: Motion, belt_speed: float, law: FrictionLaw, position: complex) -> Orbit:
    """A model's harmonic motion about a position and the friction along it; no model of one harmonic knows rest."""
    slip = VaryingSlip.of_sines(motion.frequency, [motion.velocity], [motion.transverse_velocity])
    orbit = slip.orbit(*slip.friction(belt_speed, law))
    return replace(orbit, x=orbit.x + position, stick=None)
