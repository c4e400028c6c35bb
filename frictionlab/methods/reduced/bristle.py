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
from frictionlab.methods.reduced.amplitudes import Balance, balances
from frictionlab.methods.reduced.common import ROUNDING, Harmonic, judged, motion_columns
from frictionlab.methods.reduced.full_mean import full_mean
from frictionlab.methods.refusals import suggest_shooting
from frictionlab.orbit.record import Orbit
from frictionlab.quantities import Floats
from frictionlab.scene.scene import Scene, Slip
from frictionlab.theory import friction_free_velocity

TEXT = "one harmonic of x1' and of the bristles' friction balanced, friction averaged over the harmonic slip"
FORGETS = 1.0 - 1e-6
"""Share of a disturbed deflection left after a period above which it is not called forgotten."""
STEADY = 0.98
"""Largest Floquet multiplier above which a motion of the drive's period is not called steady."""
TOLERANCE = 1e-9
"""On the mean friction of the loop of one harmonic."""
UNSTEADY = "the motion of one drive period is not stable, or hardly so: the mean may not be one; use shooting"
REMEMBERED = "slip within the bristles' elastic reach: the mean depends on where it started; use shooting"


class _Point(NamedTuple):
    """One scene's balance, the mean that shooting finds and its error; or the reason why not."""

    balance: Balance | None
    mean: float
    error: float
    reason: str


def bristle_refusal(name: str, scene: Scene, law: BristleLaw) -> str | None:
    """Why one harmonic cannot do this scene with a law of this kind, at any belt speed."""
    if scene.undriven:
        return f"{name} needs a drive: it starts from the driven motion"
    if scene.degrees_of_freedom == 2:
        return suggest_shooting(
            f"{name} follows bristle friction along one line: this scene has two directions", scene, law
        )
    if not math.isfinite(law.under_load(scene.mass().normal_load).largest_deflection()):
        return f"{name} needs a law that says how far its bristles can deflect; use shooting"
    if not math.isfinite(friction_free_velocity(scene)):
        return f"{name} starts from the friction-free motion, and at undamped resonance it has no bound; use shooting"
    return None


def answer_bristle(scenes: Sequence[Scene], law: BristleLaw, tolerance: float) -> Answers:
    """Answers on scenes that differ in belt speed alone, their error from the mean that shooting finds."""
    start = time.perf_counter()
    law = law.under_load(scenes[0].mass().normal_load)
    points = [_point(scene, law) for scene in scenes]
    columns = _columns(scenes, points, law)
    columns["seconds"] = np.full(len(scenes), (time.perf_counter() - start) / len(scenes))

    def orbit(i: int) -> Orbit | None:
        balance = points[i].balance
        return None if balance is None or points[i].reason else orbit_of_one_harmonic(scenes[i], law, balance)

    return judged(columns, [point.reason for point in points], TEXT, tolerance, orbit)


def _point(scene: Scene, law: BristleLaw) -> _Point:
    mass, speed = scene.mass(), abs(scene.belt_speed)
    if mass.damping == 0.0 and speed >= friction_free_velocity(scene):
        return _unknown(None, "without damping and without slip reversal the free oscillation never dies")
    found, near = balances(mass, speed, law)
    if len(found) + len(near) != 1:
        return _unknown(None, _ambiguous([balance.amplitude for balance in found], near))
    balance = found[0]
    if balance.friction.multiplier > FORGETS:
        return _unknown(balance, REMEMBERED)
    full = full_mean(scene.model_copy(update={"belt_speed": speed}), law)
    decay = math.exp(-math.pi * mass.damping / mass.frequency)
    if full.floquet > max(STEADY, 0.5 * (1.0 + decay)):
        return _unknown(balance, UNSTEADY)
    return _Point(balance, full.mean, full.error, full.reason)


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


def _columns(scenes: Sequence[Scene], points: Sequence[_Point], law: BristleLaw) -> dict[str, Floats]:
    """Every column that one harmonic gives; NaN without one."""
    mass, nothing = scenes[0].mass(), complex(math.nan, math.nan)
    period, load = 2.0 * math.pi / mass.frequency, mass.normal_load
    speeds = np.array([scene.belt_speed for scene in scenes])
    rows = np.array([_numbers(point.balance) for point in points])
    size, mean, sine, changes = rows.T
    both = zip(scenes, points, strict=True)
    velocity = np.array([_velocity(s, p.balance) if p.balance is not None else nothing for s, p in both])
    viscous, rubbed = 0.5 * mass.damping * size**2 * period, 0.5 * load * sine * size * period
    energies = {
        "energy_input": viscous + rubbed,
        "energy_viscous": viscous,
        "energy_friction": rubbed,
        "energy_contact": rubbed + np.abs(speeds) * load * mean * period,
    }
    columns = motion_columns(scenes[0], speeds, Harmonic(mean, velocity, energies, []))
    columns["reversals"] = np.where(size > np.abs(speeds), 2.0, 0.0)
    columns["force_reversals"] = changes
    columns["mean_friction"] = np.copysign(1.0, speeds) * mean
    columns["error"] = np.array([_error(point, law) for point in points])
    return columns


def _numbers(balance: Balance | None) -> list[float]:
    """Velocity amplitude, mean friction coefficient, its damping part, and how often friction changes sign."""
    if balance is None:
        return [math.nan] * 4
    friction = balance.friction
    return [balance.amplitude, -friction.mean, friction.sine, friction.sign_changes]


def _error(point: _Point, law: BristleLaw) -> float:
    """What the other harmonics change of the mean, and what that may be off by."""
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
    return replace(orbit, x=orbit.x + mass.normal_load * mean)
