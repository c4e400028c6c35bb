"""Harmonic balance of a mass on bristle friction, one harmonic, and what that leaves out.

Friction over a harmonic slip has a mean, a part in quadrature to the displacement (it damps) and a part in phase
with it (it stiffens, unlike Coulomb's). Both depend on the amplitude, and on the belt speed that biases the slip.
"""

from __future__ import annotations

import cmath
import math
import time
from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from frictionlab.laws.memory import BristleLaw
from frictionlab.methods.base import Answers
from frictionlab.methods.prescribed.bristle import BristlePoint
from frictionlab.methods.prescribed.memory import FORGETS
from frictionlab.methods.reduced.amplitudes import Balance, balances
from frictionlab.methods.reduced.common import ROUNDING, Modelled, judged
from frictionlab.methods.reduced.full_mean import full_means
from frictionlab.methods.refusals import suggest_shooting
from frictionlab.orbit.record import Orbit
from frictionlab.quantities import Floats
from frictionlab.scene.scene import Scene, Slip
from frictionlab.theory import friction_free_velocity

TEXT = "one harmonic of x1' and of the bristles' friction balanced, friction averaged over the harmonic slip"
STEADY = 0.98
"""Largest Floquet multiplier of a motion of one drive period that counts as stable."""
TOLERANCE = 1e-9
"""On the mean friction of the loop of one harmonic."""
UNSTEADY = "the motion of one drive period may be unstable: the mean may not be unique; use shooting"
REMEMBERED = "slip within the elastic range of the bristles: the mean depends on the start; use shooting"


class _Point(NamedTuple):
    """One scene's balance, the mean that shooting finds and its error; or the reason why not."""

    balance: Balance | None
    mean: float
    error: float
    reason: str


def bristle_refusal(name: str, scene: Scene, law: BristleLaw) -> str | None:
    """Why one harmonic does not apply to this scene and law at any belt speed; None if it does."""
    if scene.undriven:
        return f"{name} needs a drive: it starts from the driven motion"
    if scene.degrees_of_freedom == 2:
        return suggest_shooting(
            f"{name} follows bristle friction along one line: this scene has two directions", scene, law
        )
    if not math.isfinite(law.under_load(scene.mass().normal_load).largest_deflection()):
        return f"{name} needs a law with a largest deflection; use shooting"
    if not math.isfinite(friction_free_velocity(scene)):
        return f"{name} starts from the friction-free motion, which is unbounded at undamped resonance; use shooting"
    return None


def bristle_means(scenes: Sequence[Scene], law: BristleLaw) -> Floats:
    """The mean friction of the one balance of each scene, without its error; NaN where there is not one."""
    law = law.under_load(scenes[0].mass().normal_load)
    found = [balances(scene.mass(), abs(scene.belt_speed), law) for scene in scenes]
    only = [exact[0] if len(exact) == 1 and not near else None for exact, near in found]
    return np.array([_mean(scene, balance) for scene, balance in zip(scenes, only, strict=True)])


def answer_bristle(scenes: Sequence[Scene], law: BristleLaw, tolerance: float) -> Answers:
    """Answers on scenes that differ in belt speed alone, their error from the mean that shooting finds."""
    start = time.perf_counter()
    law = law.under_load(scenes[0].mass().normal_load)
    points = [_point(scene, law) for scene in scenes]
    means = np.array([_mean(scene, point.balance) for scene, point in zip(scenes, points, strict=True)])
    errors = np.array([_error(point, law) for point in points])

    def orbit(i: int) -> Orbit | None:
        balance = points[i].balance
        return None if balance is None else orbit_of_one_harmonic(scenes[i], law, balance)

    found = Modelled(means, errors, time.perf_counter() - start)
    return judged(found, [point.reason for point in points], TEXT, tolerance, orbit)


def _point(scene: Scene, law: BristleLaw) -> _Point:
    mass, speed = scene.mass(), abs(scene.belt_speed)
    if mass.damping == 0.0 and speed >= friction_free_velocity(scene):
        return _unknown(None, "without damping and without slip reversal the free oscillation does not decay")
    found, near = balances(mass, speed, law)
    if len(found) + len(near) != 1:
        return _unknown(None, _ambiguous([balance.amplitude for balance in found], near))
    balance = found[0]
    if balance.friction.multiplier > FORGETS:
        return _unknown(balance, REMEMBERED)
    full = full_means([scene.model_copy(update={"belt_speed": speed})], law)
    decay = math.exp(-math.pi * mass.damping / mass.frequency)
    if full.floquet()[0] > max(STEADY, 0.5 * (1.0 + decay)):
        return _unknown(balance, UNSTEADY)
    return _Point(balance, float(full.mean[0]), float(full.error[0]), full.reasons[0])


def _unknown(balance: Balance | None, reason: str) -> _Point:
    return _Point(balance, math.nan, math.nan, reason)


def _ambiguous(amplitudes: list[float], near: list[float]) -> str:
    """The reason where one harmonic leaves open which amplitude is the motion's."""
    exactly = ", ".join(f"{amplitude:.4g}" for amplitude in amplitudes) or "none"
    nearly = f", and nearly at {', '.join(f'{amplitude:.4g}' for amplitude in near)}" if near else ""
    return f"one harmonic balances at velocity amplitudes {exactly}{nearly} (contact resonance); use shooting"


def _velocity(scene: Scene, balance: Balance) -> complex:
    """Phasor of x1'."""
    return cmath.rect(balance.amplitude, cmath.phase(scene.mass().force) - balance.lag)


def _mean(scene: Scene, balance: Balance | None) -> float:
    """Mean friction coefficient."""
    return math.nan if balance is None else -math.copysign(1.0, scene.belt_speed) * balance.friction.mean


def _error(point: _Point, law: BristleLaw) -> float:
    """The change of the mean by the other harmonics, and its error."""
    if point.balance is None:
        return math.nan
    change = abs(point.mean + point.balance.friction.mean)
    return change + point.error + 100.0 * ROUNDING * law.sliding_friction(0.0)


def orbit_of_one_harmonic(scene: Scene, law: BristleLaw, balance: Balance) -> Orbit | None:
    """The motion about the position where its mean friction loads the spring, its slip taken as prescribed."""
    mass = scene.mass()
    lead = math.degrees(cmath.phase(mass.force) - balance.lag)
    slip = Slip(velocity_amplitude=balance.amplitude, frequency=mass.frequency, phase=lead)
    prescribed = Scene(belt_speed=scene.belt_speed, normal_load=mass.normal_load, slip=slip)
    orbit = BristlePoint(prescribed, law, TOLERANCE).orbit()
    if orbit is None:
        return None
    mean = -math.copysign(1.0, scene.belt_speed) * balance.friction.mean
    return replace(orbit, x=orbit.x + mass.normal_load * mean, stick=None)
