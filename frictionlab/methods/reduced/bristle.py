"""Harmonic balance of a mass on bristle friction, one harmonic: all amplitudes at which it balances.

Friction over a harmonic slip has a mean, a part in quadrature to the displacement (it damps) and a part in phase
with it (it stiffens, unlike Coulomb's). Both depend on the amplitude, and on the belt speed that biases the slip.

Mean and first harmonic of bristle friction over a harmonic slip, from its closed loop.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from frictionlab.compile.call import KernelCall
from frictionlab.compile.decorators import njit
from frictionlab.laws.memory import BristleLaw
from frictionlab.methods.prescribed import exact_legs
from frictionlab.methods.prescribed.bristle import Along, BristlePoint, friction_of_each, legs_of
from frictionlab.methods.prescribed.collocation import stretches
from frictionlab.methods.prescribed.periodic_deflection import POINTS, SHARES, Accuracy, Closing
from frictionlab.methods.reduced.common import ROUNDING, TOLERANCE, Modelled
from frictionlab.methods.shooting.method import suggest_shooting
from frictionlab.methods.words import ModelWord
from frictionlab.motion.orbit.record import Orbit
from frictionlab.motion.steppers.radau_panel import Oscillation
from frictionlab.scene.body import Mass
from frictionlab.scene.scene import Scene, Slip
from frictionlab.scene.scenes import belt_speeds_of
from frictionlab.theory import friction_free_velocity
from frictionlab.values.quantities import Floats

_PER_STEP = 3e-8
"""Error per step of collocation, of order nine: over a period it is below 1e-9 of the friction."""
_SAMPLES = 64


class Friction(NamedTuple):
    """Friction coefficient over the slip amplitude*sin(theta) - belt_speed: its mean and its first harmonic.

    first: the coefficient of sin(theta), in quadrature to the displacement, + i times that of cos(theta).
    """

    mean: float
    first: complex


class Loops:
    """The closed loops of a law at a belt speed >= 0 and a frequency, each found from the one before."""

    def __init__(self, law: BristleLaw, belt_speed: float, frequency: float) -> None:
        self.law, self.belt_speed, self.frequency = law, belt_speed, frequency
        self._of_legs = KernelCall(harmonics_of_legs, law)
        self._last = 0.0

    def elastic(self, amplitude: float) -> bool:
        """Whether the slip stays within the elastic range of the contact, where it settles on no one loop."""
        return self.belt_speed == 0.0 and amplitude < self.law.elastic_deflection() * self.frequency

    def friction(self, amplitude: float) -> Friction:
        """Over this slip; of an elastic contact, from its middle."""
        along = Along(complex(amplitude), self.belt_speed, self.frequency)
        if self.elastic(amplitude) or (along.turn == 0.0 and self.law.exact_path()):
            mean, first = self._at_known_deflections(amplitude)
        elif self.law.exact_path():
            mean, first = self._of_legs(legs_of(self.law, along, 1.0))
            first *= cmath.exp(-1j * (along.turn - math.pi))
        else:
            return self._collocated(amplitude)
        # Of the slip belt_speed + amplitude*cos(psi), which is minus this one at psi = theta + pi/2.
        return Friction(-mean / math.tau, first / math.pi)

    def _at_known_deflections(self, amplitude: float) -> tuple[float, complex]:
        """Elastic deflections follow the slip; slip that goes one way has saturated those of an exact path."""
        psi = np.arange(_SAMPLES) * (math.tau / _SAMPLES)
        z = amplitude / self.frequency * np.sin(psi)
        if not self.elastic(amplitude):
            z = np.full(_SAMPLES, self.law.largest_deflection())
        rub = np.empty(_SAMPLES)
        KernelCall(friction_of_each, self.law)(self.belt_speed + amplitude * np.cos(psi), z, rub)
        return _summed(psi, rub * (math.tau / _SAMPLES))

    def _collocated(self, amplitude: float) -> Friction:
        slip = Oscillation(complex(amplitude), 0j, self.frequency)
        scale = Accuracy.of(self.law, slip, self.belt_speed, 1.0).scale
        parts = stretches(self.law, slip, self.belt_speed)
        closing = Closing(self.law, slip, parts, scale, _PER_STEP)
        period, self._last, _ = closing.closed(self._last)
        if period is None:
            return Friction(math.nan, complex(math.nan))
        width = period.width[:, None]
        mean, first = _summed(period.start[:, None] + width * POINTS, width * SHARES * period.friction)
        return Friction(mean / math.tau, 1j * first / math.pi)


def _summed(psi: Any, shares: Any) -> tuple[float, complex]:
    """The integrals of friction, and of friction times exp(-i psi), from its shares."""
    return float(shares.sum()), complex((shares * np.exp(-1j * psi)).sum())


@njit
def harmonics_of_legs(law: Any, legs: exact_legs.Legs) -> Any:
    """The same of the closed loop of two exact legs, the angle from the start of the forward one."""
    start, width, _, _, friction = exact_legs.closed_legs(law, legs)
    mean, first = 0.0, 0j
    for panel in range(start.size):
        for node in range(exact_legs.POINTS.size):
            share = width[panel] * exact_legs.SHARES[node] * friction[panel, node]
            angle = start[panel] + width[panel] * exact_legs.POINTS[node]
            mean += share
            first += share * complex(math.cos(angle), -math.sin(angle))
    return mean, first


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
    if not law.obeys("oddness"):
        return f"{name} needs bristles that are alike to both sides: this law is not odd; use shooting"
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
