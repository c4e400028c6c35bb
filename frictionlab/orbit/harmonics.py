"""Fourier's parts of a recorded orbit: its velocity and its friction, harmonic by harmonic."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from frictionlab.orbit.panels import NODES, PER_PANEL
from frictionlab.orbit.record import Orbit
from frictionlab.quantities import EPSILON, Floats
from frictionlab.scene.scene import Scene

_TO_LEGENDRE: Floats = np.linalg.inv(np.polynomial.legendre.legvander(NODES, PER_PANEL - 1)).astype(
    np.float64
)
"""From values at the nodes of a panel to the coefficients of the Legendre polynomials."""
_STEEP = 12.0
"""Half the phase that a harmonic turns through in a panel, from which on the recurrence upwards is stable."""
_GAUSS, _SHARES = np.polynomial.legendre.leggauss(32)
_LEGENDRE_GAUSS: Floats = np.polynomial.legendre.legvander(_GAUSS, PER_PANEL - 1) * _SHARES[:, None]
_AT_ONCE = 20_000
"""Panels times harmonics, for memory."""
_ROUNDING = 64.0 * EPSILON
"""Of a harmonic of the velocity, relative to the largest: of smaller ones the phase is not known."""


class HarmonicParts(NamedTuple):
    """Harmonics 0 ... H along one direction, one entry each: of the velocity, and of the friction that resists.

    The harmonic k of a function is amplitude*sin(k theta + phase), phases in degrees, theta the phase of the load
    along x1 (of ``frequency*tau`` where there is none). Friction is the coefficient as it acts against the mass, its
    in_phase part being that in phase with the velocity harmonic, which it damps where positive, and in_quadrature
    that which leads it by 90 degrees: inertia where positive, stiffness where negative. Of k = 0 the amplitude is the
    mean with its sign; where a harmonic of the velocity is rounding, phases and parts against it are NaN.
    """

    harmonic: NDArray[np.int64]
    velocity_amplitude: Floats
    velocity_phase: Floats
    friction_amplitude: Floats
    friction_phase: Floats
    friction_in_phase: Floats
    friction_in_quadrature: Floats


def harmonic_parts(scene: Scene, orbit: Orbit, harmonics: int, across: bool = False) -> HarmonicParts:
    """The harmonics 0 ... ``harmonics`` of an orbit of a scene, of the drive's frequency; undriven, of its own.

    Every panel is the polynomial through its nodes, integrated exactly against sine and cosine however fast they turn
    (Filon). across: of x2' and of friction along x2, phases against the load along x1 still.
    """
    frequency, lead = _clock(scene, orbit)
    k = np.arange(harmonics + 1, dtype=np.int64)
    frequencies: Floats = frequency * k.astype(np.float64)
    values = [one.imag if across else one.real for one in (orbit.v, orbit.friction)]
    velocity, friction = (phasors_of_panels(orbit.tau, one, frequencies) for one in values)
    velocity, friction = (one * np.exp(-1j * lead * k) for one in (velocity, friction))
    size = np.abs(velocity)
    known = (size > _ROUNDING * size.max(initial=0.0)) & (k > 0)
    against = np.where(known, friction * velocity.conj() / np.where(known, size, 1.0), np.nan)
    return HarmonicParts(
        harmonic=k,
        velocity_amplitude=np.where(k > 0, size, velocity.imag),
        velocity_phase=np.where(known, np.angle(velocity, deg=True), np.nan),
        friction_amplitude=np.where(k > 0, np.abs(friction), friction.imag),
        friction_phase=np.where((k > 0) & (friction != 0.0), np.angle(friction, deg=True), np.nan),
        friction_in_phase=against.real,
        friction_in_quadrature=np.where(known, against.imag, np.nan),
    )


def harmonic_columns(scene: Scene, orbit: Orbit, harmonics: int) -> dict[str, Floats]:
    """The harmonics of an orbit as columns of a table; across the belt by the same names after ``transverse_``."""
    along = harmonic_parts(scene, orbit, harmonics)._asdict()
    if not scene.planar:
        return along
    across = harmonic_parts(scene, orbit, harmonics, across=True)._asdict()
    del across["harmonic"]
    return along | {f"transverse_{name}": column for name, column in across.items()}


def _clock(scene: Scene, orbit: Orbit) -> tuple[float, float]:
    """The circular frequency of harmonic 1, and the phase of the load along x1 at tau = 0 [rad]."""
    if scene.undriven:
        return 2.0 * math.pi * orbit.periods / float(orbit.tau[-1, -1] - orbit.tau[0, 0]), 0.0
    force = scene.mass().force if scene.degrees_of_freedom else 0j
    return scene.frequency, math.atan2(force.imag, force.real)


def phasors_of_panels(tau: Floats, values: Floats, frequencies: Floats) -> NDArray[np.complex128]:
    """Of each frequency the F whose Im(F exp(i frequency tau)) is the part of the values; i times the mean at 0."""
    start, end = tau[:, 0], tau[:, -1]
    half, middle = 0.5 * (end - start), 0.5 * (start + end)
    legendre = half[:, None] * (values @ _TO_LEGENDRE.T)
    parts = np.array_split(frequencies, 1 + len(tau) * len(frequencies) // _AT_ONCE)
    whole = np.concatenate([_integrals_against(part, half, middle, legendre) for part in parts])
    return np.asarray(np.where(frequencies > 0.0, 2j, 1j) * whole / (end[-1] - start[0]))


def _integrals_against(
    frequencies: Floats, half: Floats, middle: Floats, legendre: Floats
) -> NDArray[np.complex128]:
    """Of the polynomials of all panels against exp(-i frequency tau), one for each frequency."""
    turns = np.exp(-1j * np.outer(middle, frequencies))
    return np.asarray(
        np.einsum("pkn,pn,pk->k", _moments(np.outer(half, frequencies)), legendre, turns, optimize=True)
    )


def _moments(turned: Floats) -> NDArray[np.complex128]:
    """Integrals over [-1, 1] of every Legendre polynomial P_n(s) times exp(-i turned s): 2 (-i)^n j_n(turned).

    Source: DLMF 18.17.19; upwards by j_(n+1) = (2 n + 1)/x j_n - j_(n-1), DLMF 10.51.1.
    """
    turning = np.exp(-1j * np.minimum(turned, _STEEP)[..., None] * _GAUSS)
    found: NDArray[np.complex128] = np.asarray(turning @ _LEGENDRE_GAUSS, dtype=np.complex128)
    x = np.maximum(turned, _STEEP)
    last: Floats = np.cos(x) / x  # of the orders -1 and 0
    bessel: Floats = np.sin(x) / x
    for n in range(PER_PANEL):
        found[..., n] = np.where(turned < _STEEP, found[..., n], 2.0 * (-1j) ** n * bessel)
        last, bessel = bessel, (2 * n + 1) / x * bessel - last
    return found
