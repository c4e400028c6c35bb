"""All amplitudes at which one harmonic of motion and of bristle friction balance."""

from __future__ import annotations

import cmath
import math
from typing import NamedTuple

import numpy as np

from frictionlab.compile.call import KernelCall
from frictionlab.laws.memory import BristleLaw
from frictionlab.methods.reduced.contact import HarmonicContact, Harmonics, harmonic_friction
from frictionlab.quantities import Floats
from frictionlab.scene.body import Mass

PER_DECADE = 30
"""Amplitudes evaluated per decade below the largest; fewer at smaller ones."""
NEAR = 3
DECADES = 9
"""Decades of amplitude looked at closely, and at all."""
NEARLY = 0.2
"""Residual force, relative to the load, that the neglected harmonics may balance."""
SHARPENED = 24
"""Steps towards the nearest approach of two neighbours that may hide a pair of balances."""


class Balance(NamedTuple):
    """One harmonic of motion: x1' = amplitude*sin(theta); friction over it, and by how much it lags the load."""

    amplitude: float
    friction: Harmonics
    lag: float


class Balances(NamedTuple):
    """All of them by rising amplitude; amplitudes where the load is nearly balanced, if not by these."""

    found: list[Balance]
    near: list[float]


def balances(mass: Mass, belt_speed: float, law: BristleLaw) -> Balances:
    """Every balance at a belt speed >= 0.

    Law per unit normal load, all in scene scales; the mass damped or off resonance.
    """
    reader = _Reader(mass, belt_speed, law)
    amplitudes = reader.looked_at()
    excess = np.array([reader.excess(v) for v in amplitudes])
    dips = _dips(reader, amplitudes, excess)
    missed = [reader.excess(dip) for dip in dips]
    sides = np.sign(np.interp(dips, amplitudes, excess)) * missed / abs(mass.force)
    near = [float(v) for v, lack in zip(dips, sides.tolist(), strict=True) if 0.0 < lack <= NEARLY]
    order = np.argsort(np.concatenate([amplitudes, dips]), kind="stable")
    amplitudes, excess = np.concatenate([amplitudes, dips])[order], np.concatenate([excess, missed])[order]
    above = excess > 0.0
    changes = np.flatnonzero(above[1:] != above[:-1]).tolist()
    ends = [_crossing(reader, amplitudes[i : i + 2]) for i in changes]
    return Balances([reader.balance(amplitude) for amplitude in ends], near)


class _Reader:
    """Reads friction over harmonic slip, and what the load exceeds or lacks."""

    def __init__(self, mass: Mass, belt_speed: float, law: BristleLaw) -> None:
        self.mass, self.belt_speed = mass, belt_speed
        self.impedance = mass.damping + 1j * (mass.frequency - mass.stiffness / mass.frequency)
        self.contact, self._steady = contact_of(law), law.sliding_friction(0.0)
        self._friction = KernelCall(harmonic_friction, law)
        self.unturned = belt_speed if law.constant_sliding_friction() else 0.0

    def friction(self, amplitude: float) -> Harmonics:
        speed, frequency = self.belt_speed, self.mass.frequency
        return Harmonics(*self._friction(self.contact, amplitude, speed, frequency))

    def pull(self, amplitude: float, friction: Harmonics) -> complex:
        """The force that the motion requires."""
        return self.impedance * amplitude + self.mass.normal_load * complex(friction.sine, friction.cosine)

    def excess(self, amplitude: float) -> float:
        """The force this amplitude asks for, less the load's; below ``unturned`` friction is constant."""
        if amplitude <= self.unturned:
            return abs(self.impedance) * amplitude - abs(self.mass.force)
        return abs(self.pull(amplitude, self.friction(amplitude))) - abs(self.mass.force)

    def balance(self, amplitude: float) -> Balance:
        friction = self.friction(amplitude)
        return Balance(amplitude, friction, cmath.phase(self.pull(amplitude, friction)))

    def looked_at(self) -> Floats:
        """Amplitudes that enclose every balance: above the largest, friction cannot balance inertia."""
        most = max(self._reach(), self.belt_speed, 1e-300)
        for _ in range(200):
            friction = self.friction(most)
            held = self.mass.normal_load * math.hypot(friction.sine, friction.cosine)
            if abs(self.impedance) * most - held > abs(self.mass.force):
                break
            most *= 1.5
        near = np.linspace(0.0, NEAR, NEAR * PER_DECADE + 1)
        steps = np.concatenate([near, np.arange(NEAR, DECADES, 0.125)[1:]])
        amplitudes = most * 10.0 ** -steps[::-1]
        return np.unique(np.concatenate([amplitudes, [self.unturned] if self.unturned else []]))

    def _reach(self) -> float:
        """The amplitude that load and steady friction can drive together, its harmonic at most twice its size."""
        friction = 2.0 * self.mass.normal_load * self._steady
        return (abs(self.mass.force) + friction) / abs(self.impedance)


def contact_of(law: BristleLaw) -> HarmonicContact:
    """How kernels follow a law."""
    return HarmonicContact(float(law.exact_path()), law.largest_deflection())


def _dips(reader: _Reader, amplitudes: Floats, excess: Floats) -> list[float]:
    """The minima of the residual between amplitudes, where two balances may lie close together."""
    size, side = np.abs(excess), np.sign(excess)
    least = (size[1:-1] <= size[:-2]) & (size[1:-1] <= size[2:])
    least &= (side[:-2] == side[1:-1]) & (side[1:-1] == side[2:])
    return [
        _nearest(reader, amplitudes[i], amplitudes[i + 2], float(side[i]))
        for i in np.flatnonzero(least).tolist()
    ]


def _nearest(reader: _Reader, low: float, high: float, side: float) -> float:
    """Golden section for the least of side*excess."""
    share = 0.5 * (math.sqrt(5.0) - 1.0)
    inner, outer = high - share * (high - low), low + share * (high - low)
    at_inner, at_outer = side * reader.excess(inner), side * reader.excess(outer)
    for _ in range(SHARPENED):
        if min(at_inner, at_outer) <= 0.0:
            break
        if at_inner < at_outer:
            high, outer, at_outer = outer, inner, at_inner
            inner = high - share * (high - low)
            at_inner = side * reader.excess(inner)
        else:
            low, inner, at_inner = inner, outer, at_outer
            outer = low + share * (high - low)
            at_outer = side * reader.excess(outer)
    return inner if at_inner < at_outer else outer


def _crossing(reader: _Reader, ends: Floats) -> float:
    """Where the excess crosses zero between two amplitudes, by Brent's method."""
    from scipy.optimize import brentq

    low, high = ends.tolist()
    return float(brentq(reader.excess, low, high, xtol=4e-16 * high))
