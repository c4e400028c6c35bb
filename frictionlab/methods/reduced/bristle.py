"""Harmonic balance of a mass on bristle friction, one harmonic, and what that leaves out.

Friction over a harmonic slip has a mean, a part in quadrature to the displacement (it damps) and a part in phase
with it (it stiffens, unlike Coulomb's). Both depend on the amplitude, and on the belt speed that biases the slip.
"""

from __future__ import annotations

import cmath
import math
import time
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from frictionlab.compile.cache import compiled
from frictionlab.dynamics.radau_panel import STAGES
from frictionlab.laws.memory import BristleLaw
from frictionlab.methods.base import Answers
from frictionlab.methods.reduced.amplitudes import Balance, balances, contact_of
from frictionlab.methods.reduced.bristle_frequency_time import Line, Settled, panel_edges, settle
from frictionlab.methods.reduced.common import ROUNDING, Harmonic, judged, motion_columns
from frictionlab.methods.reduced.contact import NODES as RADAU
from frictionlab.methods.reduced.contact import friction_over
from frictionlab.methods.refusals import suggest_shooting
from frictionlab.orbit.panels import NODES
from frictionlab.orbit.record import Orbit
from frictionlab.quantities import Floats
from frictionlab.scene.scene import Scene
from frictionlab.theory import friction_free_velocity

TEXT = "one harmonic of x1' and of the bristles' friction balanced, friction averaged over the harmonic slip"
FORGETS = 1.0 - 1e-6
"""Share of a disturbed deflection left after a period above which it is not called forgotten."""
STEADY = 0.98
"""Largest Floquet multiplier above which a motion of the drive's period is not called steady."""
SAFETY = 1.05
"""On the change of the mean from one harmonic to all."""
UNSETTLED = (
    "no useful bound on the model error: the harmonics left out do not settle (long rest on stiff bristles, or "
    "nearly undamped resonance of the contact); use shooting"
)
UNSTEADY = "the motion of one drive period is not stable, or hardly so: the mean may not be one; use shooting"
STICK_SLIP = (
    "slip that never turns under friction that falls with speed faster than damping makes up for: stick-slip may be "
    "another steady state; use shooting"
)
REMEMBERED = "slip within the bristles' elastic reach: the mean depends on where it started; use shooting"


class _Point(NamedTuple):
    """One scene's balance and its motion of all harmonics; or the reason why not."""

    balance: Balance | None
    settled: Settled | None
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
    """Answers on scenes that differ in belt speed alone, their error from the motion of all harmonics."""
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
        return _Point(None, None, "without damping and without slip reversal the free oscillation never dies")
    found, near = balances(mass, speed, law)
    if len(found) + len(near) != 1:
        return _Point(None, None, _ambiguous([balance.amplitude for balance in found], near))
    balance = found[0]
    friction = balance.friction
    if friction.multiplier > FORGETS:
        return _Point(balance, None, REMEMBERED)
    held = complex(friction.sine, friction.cosine) / balance.amplitude
    settled = settle(Line(mass, speed, law, contact_of(law), held), _velocity(scene, balance))
    reason = UNSETTLED if settled is None else _unsteady(scene, law, settled)
    return _Point(balance, settled, reason)


def _unsteady(scene: Scene, law: BristleLaw, settled: Settled) -> str:
    """Why the motion of all harmonics may not be the steady state; empty where nothing speaks against it."""
    mass = scene.mass()
    decay = math.exp(-math.pi * mass.damping / mass.frequency)
    if settled.multiplier > max(STEADY, 0.5 * (1.0 + decay)):
        return UNSTEADY
    falls = not law.constant_sliding_friction() and _steepest_fall(law) * mass.normal_load >= mass.damping
    return STICK_SLIP if falls and settled.turns == 0 else ""


def _steepest_fall(law: BristleLaw) -> float:
    """Of steady sliding friction with speed, from a comb of speeds."""
    speeds = np.logspace(-6.0, 6.0, 481)
    friction = np.array([law.sliding_friction(speed) for speed in speeds.tolist()])
    return float(np.max(-np.diff(friction) / np.diff(speeds)))


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
    """What the other harmonics change of the mean, and three times what that may be off by."""
    if point.balance is None or point.settled is None:
        return math.nan
    change = abs(point.settled.mean + point.balance.friction.mean)
    return SAFETY * change + 3.0 * point.settled.left + 100.0 * ROUNDING * law.sliding_friction(0.0)


def orbit_of_one_harmonic(scene: Scene, law: BristleLaw, balance: Balance) -> Orbit:
    """The motion about the position where its mean friction loads the spring; friction over it."""
    mass, amplitude = scene.mass(), balance.amplitude
    side = math.copysign(1.0, scene.belt_speed)
    lead = cmath.phase(mass.force) - balance.lag
    phasor = side * cmath.rect(amplitude, lead)  # seen from a belt that moves forward
    edges = panel_edges(mass, abs(scene.belt_speed), contact_of(law), np.array([phasor]))
    edges = edges - 2.0 * math.pi * math.floor(edges[0] / (2.0 * math.pi))
    friction = side * _between(_friction(scene, law, phasor, edges))
    angle = edges[:-1, None] + 0.5 * np.diff(edges)[:, None] * (1.0 + NODES)
    moving = amplitude * np.exp(1j * (angle + lead))
    position = -side * mass.normal_load * balance.friction.mean - moving.real / mass.frequency
    stick = np.zeros(len(angle), np.bool_)
    x, v, along = (part.astype(np.complex128) for part in (position, moving.imag, friction))
    return Orbit(angle / mass.frequency, x, v, along, stick)


def _friction(scene: Scene, law: BristleLaw, phasor: complex, edges: Floats) -> Floats:
    """At the Radau nodes of the panels."""
    half = 0.5 * np.diff(edges)
    angle = edges[:-1, None] + half[:, None] * (1.0 + RADAU)
    slip = (phasor * np.exp(1j * angle)).imag - abs(scene.belt_speed)
    entry = compiled(friction_over, law)
    return np.asarray(entry(contact_of(law), half / scene.frequency, slip))


def _between(friction: Floats) -> Floats:
    """From Radau nodes to those of an orbit, by the polynomial through them and the end of the panel before."""
    before = np.roll(friction[:, -1], 1)[:, None]
    at = np.concatenate([[-1.0], RADAU])
    powers = np.arange(STAGES + 1.0)
    weights = NODES[:, None] ** powers @ np.linalg.inv(at[:, None] ** powers)
    return np.concatenate([before, friction], axis=1) @ weights.T
