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
from frictionlab.methods.reduced.loops import Loops
from frictionlab.methods.refusals import suggest_shooting
from frictionlab.methods.words import ModelWord
from frictionlab.orbit.record import Orbit
from frictionlab.quantities import Floats
from frictionlab.scene.body import Mass
from frictionlab.scene.scene import Scene, Slip
from frictionlab.scene.scenes import belt_speeds_of
from frictionlab.theory import friction_free_velocity

LOOPS_ROUNDING = 99.0 * ROUNDING
"""Of friction over a loop, relative to steady friction, beyond that of formulas."""
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
    """One harmonic of motion, Im(velocity exp(i angle)), and the mean of friction over it."""

    velocity: complex
    mean: float


def bristle_refusal(name: str, scene: Scene, law: BristleLaw) -> str | None:
    """Why one harmonic does not apply to this driven scene and law at any belt speed; None if it does."""
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
    means = [math.nan if balance is None else -balance.mean for balance, _ in points]
    mean, reasons = np.copysign(1.0, speeds) * means, [reason for _, reason in points]

    def orbit(i: int) -> Orbit | None:
        return _orbit(scenes[i], law, points[i][0], float(mean[i]))

    rounding = LOOPS_ROUNDING * law.sliding_friction(0.0)
    decay = math.exp(-math.pi * mass.damping / mass.frequency)
    return Modelled(
        mean, reasons, ModelWord.ONE_OF_BRISTLES, orbit, rounding, max(STEADY, 0.5 * (1.0 + decay))
    )


def _point(mass: Mass, belt_speed: float, law: BristleLaw) -> tuple[OneBalance | None, str]:
    """The balance at a belt speed >= 0 where there is one alone, and why it is no answer."""
    reader = _Reader(mass, belt_speed, law)
    found, near = reader.balances()
    if len(found) + len(near) != 1:
        exactly, nearly = (", ".join(f"{amplitude:.4g}" for amplitude in each) for each in (found, near))
        nearly = f", and nearly at {nearly}" if near else ""
        return None, AMBIGUOUS.format(exactly=exactly or "none", nearly=nearly)
    balance = reader.balance(found[0])
    if mass.damping == 0.0 and belt_speed >= abs(mass.force / reader.impedance):
        return balance, NO_DECAY
    return balance, REMEMBERED if reader.loops.elastic(found[0]) else ""


def _orbit(scene: Scene, law: BristleLaw, balance: OneBalance | None, mean: float) -> Orbit | None:
    """The motion about the position where its mean friction loads the spring, its slip taken as prescribed."""
    if balance is None:
        return None
    mass = scene.mass()
    size, lead = cmath.polar(balance.velocity)
    slip = Slip(velocity_amplitude=size, frequency=mass.frequency, phase=math.degrees(lead))
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

    def balances(self) -> tuple[list[float], list[float]]:
        """All amplitudes that balance, rising, and those at which the load is nearly balanced, if not by these."""
        from scipy.optimize import brentq

        amplitudes = self._looked_at()
        excess = np.array([self.excess(v) for v in amplitudes])
        dips = self._dips(amplitudes, excess)
        missed = np.array([self.excess(dip) for dip in dips])
        lacks = np.sign(np.interp(dips, amplitudes, excess)) * missed / abs(self.mass.force)
        near = [dip for dip, lack in zip(dips, lacks.tolist(), strict=True) if 0.0 < lack <= NEARLY]
        amplitudes, excess = np.concatenate([amplitudes, dips]), np.concatenate([excess, missed])
        order = np.argsort(amplitudes, kind="stable")
        ends, above = amplitudes[order].tolist(), excess[order] > 0.0
        changes = np.flatnonzero(above[1:] != above[:-1]).tolist()
        return [float(brentq(self.excess, *ends[i : i + 2], xtol=4e-16 * ends[i + 1])) for i in changes], near

    def excess(self, amplitude: float) -> float:
        """The force this amplitude asks for, less the load's; below ``unturned`` friction is constant."""
        first = 0j if amplitude <= self.unturned else self.loops.friction(amplitude).first
        return abs(self._pull(amplitude, first)) - abs(self.mass.force)

    def balance(self, amplitude: float) -> OneBalance:
        """The motion of an amplitude that balances."""
        mean, first = self.loops.friction(amplitude)
        turned = cmath.phase(self.mass.force) - cmath.phase(self._pull(amplitude, first))
        return OneBalance(cmath.rect(amplitude, turned), mean)

    def _pull(self, amplitude: float, first: complex) -> complex:
        """The force that the motion requires, whose friction has this first harmonic."""
        return self.impedance * amplitude + self.mass.normal_load * first

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

        def nearest(i: int) -> float:
            ends, sharp = amplitudes[[i, i + 2]].tolist(), {"xatol": SHARPENED * amplitudes[i + 1]}
            found = minimize_scalar(lambda v: side[i] * self.excess(v), bounds=ends, options=sharp)
            return float(found.x)

        return [nearest(i) for i in np.flatnonzero(least).tolist()]
