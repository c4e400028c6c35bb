"""Harmonic balance of a mass on bristle friction, one harmonic: all amplitudes at which it balances.

Friction over a harmonic slip has a mean, a part in quadrature to the displacement (it damps) and a part in phase
with it (it stiffens, unlike Coulomb's). Both depend on the amplitude, and on the belt speed that biases the slip.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from frictionlab.laws.memory import BristleLaw
from frictionlab.methods.prescribed.bristle import BristlePoint
from frictionlab.methods.reduced.common import ROUNDING, TOLERANCE, Modelled
from frictionlab.methods.reduced.loops import Friction, Loops
from frictionlab.methods.refusals import suggest_shooting
from frictionlab.orbit.record import Orbit
from frictionlab.quantities import Floats
from frictionlab.scene.body import Mass
from frictionlab.scene.scene import Scene, Slip
from frictionlab.scene.scenes import belt_speeds_of
from frictionlab.theory import friction_free_velocity

BALANCED_LOOP = (
    "one harmonic of x1' and of the bristles' friction balanced, friction averaged over the harmonic slip"
)
STEADY = 0.98
"""Largest Floquet multiplier of a motion of one drive period that counts as stable."""
NO_DECAY = "without damping and without slip reversal the free oscillation does not decay"
REMEMBERED = "slip within the elastic range of the bristles: the mean depends on the start; use shooting"
AMBIGUOUS = "one harmonic balances at velocity amplitudes {exactly}{nearly} (contact resonance); use shooting"
PER_DECADE = 30
"""Amplitudes evaluated per decade below the largest; fewer at smaller ones."""
NEAR, DECADES = 3, 9
"""Decades of amplitude looked at closely, and at all."""
NEARLY = 0.2
"""Residual force, relative to the load, that the neglected harmonics may balance."""
SHARPENED = 1e-6
"""Width [amplitude] to which a minimum of the residual, that may hide a pair of balances, is found."""


class OneBalance(NamedTuple):
    """One harmonic of motion: x1' = amplitude*sin(theta); friction over it, and by how much it lags the load."""

    amplitude: float
    friction: Friction
    lag: float


class _Point(NamedTuple):
    """One scene's balance where there is one alone, and why the scene has no answer."""

    balance: OneBalance | None
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


def bristles(scenes: Sequence[Scene], law: BristleLaw) -> Modelled:
    """The one balance of each of scenes that differ in belt speed alone."""
    mass, speeds = scenes[0].mass(), belt_speeds_of(scenes)
    law = law.under_load(mass.normal_load)
    points = [_point(mass, speed, law) for speed in np.abs(speeds).tolist()]
    means = [math.nan if point.balance is None else -point.balance.friction.mean for point in points]
    mean = np.copysign(1.0, speeds) * means

    def orbit(i: int) -> Orbit | None:
        return _orbit(scenes[i], law, points[i].balance, float(mean[i]))

    reasons = [point.reason for point in points]
    rounding = np.full(len(speeds), 100.0 * ROUNDING * law.sliding_friction(0.0))
    decay = math.exp(-math.pi * mass.damping / mass.frequency)
    return Modelled(mean, reasons, BALANCED_LOOP, orbit, rounding, max(STEADY, 0.5 * (1.0 + decay)))


def _point(mass: Mass, belt_speed: float, law: BristleLaw) -> _Point:
    reader = _Reader(mass, belt_speed, law)
    found, near = reader.balances()
    if len(found) + len(near) != 1:
        return _Point(None, _ambiguous([balance.amplitude for balance in found], near))
    if mass.damping == 0.0 and belt_speed >= abs(mass.force / reader.impedance):
        return _Point(found[0], NO_DECAY)
    return _Point(found[0], REMEMBERED if reader.loops.elastic(found[0].amplitude) else "")


def _ambiguous(amplitudes: list[float], near: list[float]) -> str:
    """The reason where one harmonic leaves open which amplitude is the motion's."""
    exactly = ", ".join(f"{amplitude:.4g}" for amplitude in amplitudes) or "none"
    nearly = f", and nearly at {', '.join(f'{amplitude:.4g}' for amplitude in near)}" if near else ""
    return AMBIGUOUS.format(exactly=exactly, nearly=nearly)


def _orbit(scene: Scene, law: BristleLaw, balance: OneBalance | None, mean: float) -> Orbit | None:
    """The motion about the position where its mean friction loads the spring, its slip taken as prescribed."""
    if balance is None:
        return None
    mass = scene.mass()
    lead = math.degrees(cmath.phase(mass.force) - balance.lag)
    slip = Slip(velocity_amplitude=balance.amplitude, frequency=mass.frequency, phase=lead)
    prescribed = Scene(belt_speed=scene.belt_speed, normal_load=mass.normal_load, slip=slip)
    orbit = BristlePoint(prescribed, law, TOLERANCE).orbit()
    return None if orbit is None else replace(orbit, x=orbit.x + mass.normal_load * mean, stick=None)


class _Reader:
    """Reads friction over harmonic slip at a belt speed >= 0, and what the load exceeds or lacks.

    Law per unit normal load, all in scene scales; the mass damped or off resonance.
    """

    def __init__(self, mass: Mass, belt_speed: float, law: BristleLaw) -> None:
        self.mass, self.belt_speed = mass, belt_speed
        self.impedance = mass.damping + 1j * (mass.frequency - mass.stiffness / mass.frequency)
        self.loops = Loops(law, belt_speed, mass.frequency)
        self.steady = mass.normal_load * law.sliding_friction(0.0)
        self.unturned = belt_speed if law.constant_sliding_friction() else 0.0

    def balances(self) -> tuple[list[OneBalance], list[float]]:
        """Every balance by rising amplitude, and amplitudes where the load is nearly balanced, if not by these."""
        from scipy.optimize import brentq

        amplitudes = self._looked_at()
        excess = np.array([self.excess(v) for v in amplitudes])
        dips = self._dips(amplitudes, excess)
        missed = [self.excess(dip) for dip in dips]
        sides = np.sign(np.interp(dips, amplitudes, excess)) * missed / abs(self.mass.force)
        near = [float(v) for v, lack in zip(dips, sides.tolist(), strict=True) if 0.0 < lack <= NEARLY]
        order = np.argsort(np.concatenate([amplitudes, dips]), kind="stable")
        amplitudes, excess = (
            np.concatenate([amplitudes, dips])[order],
            np.concatenate([excess, missed])[order],
        )
        above = excess > 0.0
        ends = [amplitudes[i : i + 2].tolist() for i in np.flatnonzero(above[1:] != above[:-1])]
        roots = [float(brentq(self.excess, low, high, xtol=4e-16 * high)) for low, high in ends]
        return [self._balance(root) for root in roots], near

    def excess(self, amplitude: float) -> float:
        """The force this amplitude asks for, less the load's; below ``unturned`` friction is constant."""
        if amplitude <= self.unturned:
            return abs(self.impedance) * amplitude - abs(self.mass.force)
        return abs(self._pull(amplitude, self.loops.friction(amplitude))) - abs(self.mass.force)

    def _pull(self, amplitude: float, friction: Friction) -> complex:
        """The force that the motion requires."""
        return self.impedance * amplitude + self.mass.normal_load * friction.first

    def _balance(self, amplitude: float) -> OneBalance:
        friction = self.loops.friction(amplitude)
        return OneBalance(amplitude, friction, cmath.phase(self._pull(amplitude, friction)))

    def _looked_at(self) -> Floats:
        """Amplitudes that enclose every balance, and where the load is nearly balanced.

        Above the largest, friction that steady sliding bounds cannot balance inertia, and what grows with speed
        damps. Below the least it cannot balance the load: its harmonic is at most twice that of steady sliding, or
        half more than at the largest amplitude.
        """
        force, size = abs(self.mass.force), abs(self.impedance)
        most = max((force + 2.0 * self.steady) / size, self.belt_speed, 1e-300)
        while self.excess(most) <= 0.0:
            most *= 1.5
        held = max(2.0 * self.steady, 1.5 * self.mass.normal_load * abs(self.loops.friction(most).first))
        least = ((1.0 - NEARLY) * force - held) / size
        near = np.linspace(0.0, NEAR, NEAR * PER_DECADE + 1)
        steps = np.concatenate([near, np.arange(NEAR, DECADES, 0.125)[1:]])
        amplitudes = np.maximum(most * 10.0 ** -steps[::-1], least)
        return np.unique(np.concatenate([amplitudes, [self.unturned] if self.unturned > least else []]))

    def _dips(self, amplitudes: Floats, excess: Floats) -> list[float]:
        """The minima of the residual between amplitudes, where two balances may lie close together."""
        from scipy.optimize import minimize_scalar

        size, side = np.abs(excess), np.sign(excess)
        least = (size[1:-1] <= size[:-2]) & (size[1:-1] <= size[2:])
        least &= (side[:-2] == side[1:-1]) & (side[1:-1] == side[2:])
        found = []
        for i in np.flatnonzero(least).tolist():
            ends, sharp = amplitudes[[i, i + 2]].tolist(), {"xatol": SHARPENED * amplitudes[i + 1]}
            dip = minimize_scalar(
                lambda v, s: s * self.excess(v), args=(side[i],), bounds=ends, method="bounded", options=sharp
            )
            found.append(float(dip.x))
        return found
