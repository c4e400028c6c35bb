"""H harmonics of motion along the belt and of friction that varies with the slip speed, balanced by Newton's method.

Friction is integrated over panels that end where slip reverses and grow from there, so that its jump at rest costs no
accuracy. The derivative of its harmonics has two parts: the slope of friction along every leg, and the jump, which
moves with the reversals.

Source: Cameron & Griffin, J. Appl. Mech. 56 (1989), 149-154, of alternating frequency and time.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.prescribed.quadrature import nodes
from frictionlab.methods.prescribed.varying_slip import VaryingSlip, piece_at
from frictionlab.methods.reduced.sampled_harmonics import friction_vectors, real_block
from frictionlab.methods.reduced.switch_response import harmonic_impedances
from frictionlab.quantities import Floats
from frictionlab.scene.body import Mass
from frictionlab.scene.signals import Wave
from frictionlab.theory.piecewise import Piecewise

Phasors = NDArray[np.complex128]
_MOST_STEPS = 40
_SHORTEST_STEP = 1e-3
_CLOSED = 1e-11
"""Force that balance lacks, relative to load and friction."""
_ROUNDED = 1e3
"""How many times that may be left where no step gains anything more."""


class SlidingBalance(NamedTuple):
    """A mass and a law, and the impedance and the load of every harmonic."""

    mass: Mass
    law: FrictionLaw
    impedance: Phasors
    force: Phasors

    def friction_free(self) -> Phasors:
        """Velocities without friction; a velocity is the imaginary part of the sum of V_k exp(i k frequency tau)."""
        return self.force / self.impedance

    def slip(self, velocity: Phasors) -> VaryingSlip:
        """The motion as a prescribed one, panels as short as products of two harmonics need them."""
        frequency = self.mass.frequency
        edges, nothing = np.array([0.0, math.tau / frequency]), np.zeros(1)
        waves = tuple(Wave(frequency * (k + 1), complex(each)) for k, each in enumerate(velocity))
        still = Piecewise(edges, nothing, nothing)
        along, load = still._replace(waves=waves), still._replace(middle=np.ones(1))
        return VaryingSlip(along, still, load, 0.5 * frequency * max(4, len(velocity)))


class Rubbed(NamedTuple):
    """Friction over a slip: times at the nodes, its values there, harmonics 1 ... H, its mean, and the force that
    every harmonic lacks; spectrum: of its derivative by the slip, harmonics 0 ... 2 H."""

    tau: Floats
    values: Floats
    mean: float
    missing: Phasors
    spectrum: Phasors


class SlidingMotion(NamedTuple):
    """Velocities of the harmonics, and the friction along them."""

    velocity: Phasors
    friction: Rubbed


def sliding_balance(mass: Mass, law: FrictionLaw, harmonics: int) -> SlidingBalance:
    """Of a damped mass under a load of one sine."""
    force = np.zeros(harmonics, np.complex128)
    force[0] = mass.force
    return SlidingBalance(mass, law, harmonic_impedances(mass, harmonics), force)


def balanced_sliding(what: SlidingBalance, belt_speed: float, start: Phasors) -> SlidingMotion | None:
    """The motion that Newton's method finds from these velocities; None where it does not settle."""
    scale = abs(what.mass.force) + what.mass.normal_load * what.law.sliding_friction(1.0)
    velocity, found = start, _rubbed(what, start, belt_speed)
    size = _largest(found)
    for _ in range(_MOST_STEPS):
        if size <= _CLOSED * scale:
            return SlidingMotion(velocity, found)
        step = _newton_step(what, found)
        if step is None:
            return None
        share = 1.0
        while share >= _SHORTEST_STEP:
            tried = velocity + share * step
            rubbed = _rubbed(what, tried, belt_speed)
            if _largest(rubbed) < (1.0 - 0.1 * share) * size:
                break
            share *= 0.5
        if share < _SHORTEST_STEP:
            return SlidingMotion(velocity, found) if size <= _ROUNDED * _CLOSED * scale else None
        velocity, found, size = tried, rubbed, _largest(rubbed)
    return None


def _largest(found: Rubbed) -> float:
    return float(np.abs(found.missing).max())


def _rubbed(what: SlidingBalance, velocity: Phasors, belt_speed: float) -> Rubbed:
    """Friction over the slip of these velocities, to which its reversals are computed first."""
    slip, frequency, harmonics = what.slip(velocity), what.mass.frequency, len(velocity)
    along = slip.along.minus(belt_speed)
    turns = along.crossings().tau
    edges, pieces = slip.panels(belt_speed, turns)
    tau, weights = nodes(edges)
    speeds = along.at(tau, pieces[:, None])[0]
    # Rounding may give the ends of a panel the wrong sign: that of its middle holds for all of it.
    speeds = np.copysign(speeds, speeds[:, [speeds.shape[1] // 2]]).ravel()
    _, size, slope = friction_vectors(what.law, np.stack([speeds, 0.0 * speeds]))
    values = np.copysign(size, speeds)
    share = weights.ravel() * frequency / math.tau
    angles, turned = frequency * tau.ravel(), frequency * turns
    rates = along.at(turns, piece_at(along.edges, turns))[1] / frequency
    jumps = 2.0 * what.law.sliding_friction(0.0) / np.maximum(np.abs(rates), 1e-300) / math.tau
    of_friction = _spectrum(share * values, angles, harmonics)
    of_slope = _spectrum(share * slope, angles, 2 * harmonics) + _spectrum(jumps, turned, 2 * harmonics)
    missing = what.impedance * velocity + what.mass.normal_load * 2j * of_friction[1:] - what.force
    return Rubbed(tau, values.reshape(tau.shape), float(of_friction[0].real), missing, of_slope)


def _spectrum(weighed: Floats, angles: Floats, harmonics: int) -> Phasors:
    """Sums of exp(-i k angle) for k from 0 on: one power after the other, for a table would not fit in memory."""
    turn = np.exp(-1j * angles)
    power, found = weighed.astype(np.complex128), np.empty(harmonics + 1, np.complex128)
    for k in range(harmonics + 1):
        found[k] = power.sum()
        power *= turn
    return found


def _newton_step(what: SlidingBalance, found: Rubbed) -> Phasors | None:
    """The change of the velocities that removes what is missing, real and imaginary parts apart."""
    harmonics = len(found.missing)
    orders = np.arange(1, harmonics + 1)
    apart, together = orders[:, None] - orders[None, :], orders[:, None] + orders[None, :]
    around = what.mass.normal_load * np.concatenate([found.spectrum, np.conj(found.spectrum[:0:-1])])
    direct = around[apart] + np.diag(what.impedance)
    whole = real_block(direct, -around[together])
    try:
        change = np.linalg.solve(whole, -np.concatenate([found.missing.real, found.missing.imag]))
    except np.linalg.LinAlgError:
        return None
    return np.asarray(change[:harmonics] + 1j * change[harmonics:])
