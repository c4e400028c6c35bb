"""What is read from a steady state: means, harmonics, extremes, energies, stick.

An orbit is one period in smooth panels, each sampled at the same Gauss-Lobatto nodes, so that quadrature and
interpolation are exact to rounding on panels short against the motion. Positions, velocities and friction are
complex, x1 + i x2, in one degree of freedom too.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from frictionlab.kernel import inner
from frictionlab.methods.base import Floats, Orbit
from frictionlab.scene import Mass, Scene

PER_PANEL = 10
_legendre = np.polynomial.legendre.Legendre.basis(PER_PANEL - 1)
NODES: Floats = np.concatenate(([-1.0], _legendre.deriv().roots().real, [1.0]))
WEIGHTS: Floats = 2.0 / (PER_PANEL * (PER_PANEL - 1) * _legendre(NODES) ** 2)
_differences = NODES[:, None] - NODES[None, :] + np.eye(PER_PANEL)
BARYCENTRIC: Floats = 1.0 / _differences.prod(axis=1)
_ratios = BARYCENTRIC[None, :] / BARYCENTRIC[:, None] / _differences * (1.0 - np.eye(PER_PANEL))
DERIVATIVE: Floats = _ratios - np.diag(_ratios.sum(axis=1))

READ = (
    "mean_friction",
    "mean_position",
    "mean_friction_transverse",
    "mean_position_transverse",
    "velocity_amplitude",
    "velocity_harmonic",
    "velocity_phase",
    "transverse_velocity_amplitude",
    "transverse_velocity_harmonic",
    "transverse_velocity_phase",
    "stick_fraction",
    "reversals",
    "force_reversals",
    "energy_input",
    "energy_viscous",
    "energy_friction",
    "energy_contact",
)
"""What ``read`` returns, in this order. The mean positions are there for the mean balance: <x1> = N mean_friction,
omega_r^2 <x2> = N mean_friction_transverse."""


class Sums(NamedTuple):
    """Integrals over one period."""

    duration: float
    position: complex
    friction: complex
    harmonic_1: complex
    harmonic_2: complex
    input: float
    viscous: float
    by_friction: float
    stick: float


@inner
def read(tau: Any, x: Any, v: Any, friction: Any, stick: Any, mass: Mass, belt_speed: float) -> Any:
    """Everything of ``READ`` from one period: arrays [panels, nodes], stick [panels]."""
    sums = _integrals(tau, x, v, friction, stick, mass)
    period = sums.duration
    part = np.empty(tau.shape)
    out = np.empty(17)
    out[0] = -sums.friction.real / period
    out[1] = sums.position.real / period
    out[2] = -sums.friction.imag / period
    out[3] = sums.position.imag / period
    out[5] = abs(sums.harmonic_1) * 2.0 / period
    out[6] = _lead(sums.harmonic_1, mass.force)
    out[8] = abs(sums.harmonic_2) * 2.0 / period
    out[9] = _lead(sums.harmonic_2, mass.force)
    out[10] = sums.stick / period
    out[13] = sums.input
    out[14] = sums.viscous
    out[15] = sums.by_friction * mass.normal_load
    out[16] = out[15] - belt_speed * sums.friction.real * mass.normal_load
    _component(friction, 1.0, part)
    out[12] = _sign_changes(part, 0.0, stick, False)
    _component(v, 1.0, part)
    out[11] = _sign_changes(part, belt_speed, stick, True)
    out[4] = 0.5 * (_highest(part, 1.0, stick) + _highest(part, -1.0, stick))
    _component(v, -1j, part)
    out[7] = 0.5 * (_highest(part, 1.0, stick) + _highest(part, -1.0, stick))
    return out


@inner
def _component(values: Any, direction: complex, out: Any) -> None:
    """The real part of direction*values: direction 1 for x1, -1j for x2."""
    for panel in range(values.shape[0]):
        for node in range(values.shape[1]):
            out[panel, node] = (direction * values[panel, node]).real


@inner
def _integrals(tau: Any, x: Any, v: Any, friction: Any, stick: Any, mass: Mass) -> Sums:
    duration, stuck = 0.0, 0.0
    position, rubbed, harmonic_1, harmonic_2 = 0j, 0j, 0j, 0j
    put_in, viscous, taken = 0.0, 0.0, 0.0
    for panel in range(tau.shape[0]):
        half = 0.5 * (tau[panel, -1] - tau[panel, 0])
        duration += 2.0 * half
        stuck += 2.0 * half if stick[panel] else 0.0
        for node in range(tau.shape[1]):
            weight = half * WEIGHTS[node]
            angle = mass.frequency * tau[panel, node]
            turn = complex(math.cos(angle), math.sin(angle))
            velocity, rub = v[panel, node], friction[panel, node]
            position += weight * x[panel, node]
            rubbed += weight * rub
            harmonic_1 += weight * velocity.real * turn.conjugate()
            harmonic_2 += weight * velocity.imag * turn.conjugate()
            load_1, load_2 = (mass.force * turn).imag, (mass.transverse_force * turn).imag
            put_in += weight * (load_1 * velocity.real + load_2 * velocity.imag)
            viscous += weight * (mass.damping * velocity.real**2 + mass.transverse_damping * velocity.imag**2)
            taken += weight * (rub.real * velocity.real + rub.imag * velocity.imag)
    return Sums(duration, position, rubbed, harmonic_1, harmonic_2, put_in, viscous, taken, stuck)


@inner
def _lead(harmonic: complex, force: complex) -> float:
    """Phase [degrees] by which A sin(Omega tau + phase), given as its integral, leads the force; NaN without one."""
    if force == 0 or harmonic == 0:
        return np.nan
    ratio = 1j * harmonic * force.conjugate()
    return math.degrees(math.atan2(ratio.imag, ratio.real))


@inner
def _highest(values: Any, sign: float, stick: Any) -> float:
    """The maximum of sign * the panel polynomials, interior maxima included."""
    highest = -1e300
    row, slope = np.empty(values.shape[1]), np.empty(values.shape[1])
    for panel in range(values.shape[0]):
        for node in range(values.shape[1]):
            row[node] = sign * values[panel, node]
            highest = max(highest, row[node])
        _differentiate(row, slope)
        for node in range(1, values.shape[1]):
            if not stick[panel] and slope[node - 1] > 0.0 >= slope[node]:
                at = _zero(slope, NODES[node - 1], NODES[node])
                highest = max(highest, _interpolate(row, at))
    return highest


@inner
def _differentiate(values: Any, slope: Any) -> None:
    for row in range(values.size):
        total = 0.0
        for column in range(values.size):
            total += DERIVATIVE[row, column] * values[column]
        slope[row] = total


@inner
def _interpolate(values: Any, at: float) -> float:
    """The polynomial through the nodes (barycentric formula; Berrut & Trefethen, 2004)."""
    above, below = 0.0, 0.0
    for node in range(values.size):
        gap = at - NODES[node]
        if gap == 0.0:
            return values[node]
        above += BARYCENTRIC[node] / gap * values[node]
        below += BARYCENTRIC[node] / gap
    return above / below


@inner
def _zero(values: Any, low: float, high: float) -> float:
    """A zero of the panel polynomial between two nodes of opposite sign (Illinois regula falsi)."""
    at_low, at_high = _interpolate(values, low), _interpolate(values, high)
    middle, side = high, 0
    for _ in range(40):
        if at_high == at_low or high - low < 1e-9:
            break
        middle = (low * at_high - high * at_low) / (at_high - at_low)
        value = _interpolate(values, middle)
        if (value > 0.0) == (at_high > 0.0):
            high, at_high, at_low = middle, value, 0.5 * at_low if side > 0 else at_low
            side = 1
        else:
            low, at_low, at_high = middle, value, 0.5 * at_high if side < 0 else at_high
            side = -1
    return middle


@inner
def _sign_changes(values: Any, level: float, stick: Any, skip_stick: bool) -> int:
    """Crossings of the level once around the period, seen at interior nodes: on events it is met, not crossed."""
    changes, first, last = 0, 0.0, 0.0
    for panel in range(values.shape[0]):
        for node in range(1, values.shape[1] - 1):
            value = values[panel, node] - level
            if (skip_stick and stick[panel]) or value == 0.0:
                continue
            first = value if first == 0.0 else first
            changes += 1 if last * value < 0.0 else 0
            last = value
    return changes + (1 if first * last < 0.0 else 0)


class Samples(NamedTuple):
    """One period of a steady state at n equally spaced times [nondimensional, scales of ``scene``].

    friction and load are forces' coefficients: friction [-] resists the slip; load [K_1 L] drives the mass.
    """

    tau: Floats
    x1: Floats
    v1: Floats
    x2: Floats
    v2: Floats
    friction: Floats
    friction_transverse: Floats
    load: Floats
    load_transverse: Floats


def sample(orbit: Orbit, scene: Scene, n: int) -> Samples:
    """The orbit at n equally spaced times tau = 0 ... its period (end not included)."""
    times: Floats = orbit.tau[0, 0] + np.arange(n, dtype=np.float64) * (np.ptp(orbit.tau) / n)
    panels = np.clip(np.searchsorted(orbit.tau[:, 0], times, side="right") - 1, 0, len(orbit.tau) - 1)
    start, end = orbit.tau[panels, 0], orbit.tau[panels, -1]
    weights = interpolation_weights((2.0 * times - start - end) / (end - start))
    x, v, rub = ((weights * part[panels]).sum(axis=1) for part in (orbit.x, orbit.v, orbit.friction))
    turn = np.exp(1j * scene.frequency * times)
    force, force_2 = (
        (scene.mass().force, scene.mass().transverse_force) if scene.degrees_of_freedom else (0j, 0j)
    )
    loads = (force * turn).imag, (force_2 * turn).imag
    return Samples(times, x.real, v.real, x.imag, v.imag, rub.real, rub.imag, *loads)


def interpolation_weights(at: Floats) -> Floats:
    """Rows of weights that interpolate from the nodes to each place in [-1, 1]."""
    gaps = at[:, None] - NODES[None, :]
    hit = gaps == 0.0
    weights = BARYCENTRIC / np.where(hit, 1.0, gaps)
    weights = np.where(hit.any(axis=1, keepdims=True), hit.astype(float), weights)
    return weights / weights.sum(axis=1, keepdims=True)
