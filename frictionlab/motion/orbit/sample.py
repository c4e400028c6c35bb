"""Samples of one period of a steady state at equal times, and harmonics of its velocity and friction."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from frictionlab.laws.base import FrictionLaw
from frictionlab.laws.memory import BristleLaw
from frictionlab.motion.orbit.memory import Contact, deflections, followed
from frictionlab.motion.orbit.record import Orbit
from frictionlab.motion.orbit.recorder import NODES, PER_PANEL, WEIGHTS, interpolation_weights
from frictionlab.scene.scene import Scene
from frictionlab.scene.signals import Signal
from frictionlab.values.quantities import EPSILON, Floats

_POWERS = np.arange(1, PER_PANEL + 1)
_PRIMITIVE: Floats = np.linalg.inv(np.vander(NODES, increasing=True)) / _POWERS[:, None]
"""Coefficients of the integral of the polynomial through values at the nodes, for powers of the place from 1
on."""


class Samples(NamedTuple):
    """Period of a steady state at n equally spaced times [nondimensional, scales of ``scene``].

    friction [-] is the force that resists slip over the mean normal load. load [K_1 L] is the force that
    drives the mass; at a jump it is the one after the jump. slip is the velocity against the belt.
    normal_load [K_1 L] includes its variation. work [K_1 L^2] is the work of friction on the body since the
    beginning. memory [count, n] is the memory of the law.
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
    slip: Floats
    slip_transverse: Floats
    normal_load: Floats
    work: Floats
    memory: NDArray[np.complex128]
    directed: bool  # whether memories have a direction

    def columns(self) -> dict[str, Floats]:
        """Return columns by name, each memory as ``memory_<k>``.

        A memory with a direction also has ``memory_<k>_transverse``.
        """
        found = self._asdict()
        memory, directed = found.pop("memory"), found.pop("directed")
        for k, values in enumerate(memory):
            found[memory_column(k)] = values.real
            if directed:
                found[memory_column(k, across=True)] = values.imag
        return found


def memory_column(k: int, across: bool = False) -> str:
    """Return the name of the column of the k-th memory."""
    return f"memory_{k}_transverse" if across else f"memory_{k}"


def sample(orbit: Orbit, scene: Scene, law: FrictionLaw, n: int) -> Samples:
    """Sample the orbit at n equally spaced times tau = 0 ... its period (end not included)."""
    step = np.ptp(orbit.tau) / orbit.periods / n
    return sample_at(orbit, scene, law, orbit.tau[0, 0] + np.arange(n, dtype=np.float64) * step)


def sample_at(orbit: Orbit, scene: Scene, law: FrictionLaw, times: Floats) -> Samples:
    """Sample the orbit at these times [1/omega_1], within its recorded times.

    law: in the scales of the scene.
    """
    panels = np.clip(np.searchsorted(orbit.tau[:, 0], times, side="right") - 1, 0, len(orbit.tau) - 1)
    start, end = orbit.tau[panels, 0], orbit.tau[panels, -1]
    places = (2.0 * times - start - end) / (end - start)
    weights = interpolation_weights(places)
    x, v, rub = ((weights * part[panels]).sum(axis=1) for part in (orbit.x, orbit.v, orbit.friction))
    signals = scene.signals()
    along, across = (load(times) for load in signals.load)
    slip = _slip(scene, v, times)
    assert scene.normal_load is not None
    pressed = scene.normal_load + signals.normal_load(times)
    along_belt = not orbit.v.imag.any()  # nothing moves across it
    contact = Contact(slip, rub, pressed / scene.normal_load, along_belt, scene.constant_contact)
    memory = _memory(orbit, scene, law, contact, (weights, panels))
    work = _work(orbit, scene.normal_load, panels, places)
    motion = x.real, v.real, x.imag, v.imag, rub.real, rub.imag
    around = along, across, slip.real, slip.imag, pressed
    return Samples(times, *motion, *around, work, memory, law.memory_kind != "scalars")


def _slip(scene: Scene, v: NDArray[np.complex128], times: Floats) -> NDArray[np.complex128]:
    """Return the velocity against the belt; under a prescribed slip all oscillation is that of the body."""
    belts = scene.signals().belt if scene.degrees_of_freedom else (Signal(), Signal())
    return np.asarray(v - scene.belt_speed - belts[0](times) - 1j * belts[1](times))


def work_of(orbit: Orbit, scene: Scene) -> float:
    """Return the work of friction on the body over the whole record [K_1 L^2]."""
    assert scene.normal_load is not None
    return float(_work(orbit, scene.normal_load, np.array([len(orbit.tau) - 1]), np.array([1.0]))[0])


def _work(orbit: Orbit, normal_load: float, panels: NDArray[np.int64], places: Floats) -> Floats:
    """Return the work of friction on the body from the beginning of the orbit to places in these panels."""
    power = orbit.friction.real * orbit.v.real
    # friction across the belt may be unknown where nothing moves
    power = -normal_load * (power + np.where(orbit.v.imag == 0.0, 0.0, orbit.friction.imag * orbit.v.imag))
    half = 0.5 * (orbit.tau[:, -1] - orbit.tau[:, 0])
    before = np.concatenate(([0.0], np.cumsum(half * (power @ WEIGHTS))))
    primitive = places[:, None] ** _POWERS - (-1.0) ** _POWERS
    within = ((primitive @ _PRIMITIVE) * power[panels]).sum(axis=1)
    return np.asarray(before[panels] + half[panels] * within)


def _memory(
    orbit: Orbit, scene: Scene, law: FrictionLaw, contact: Contact, at: tuple[Floats, NDArray[np.int64]]
) -> NDArray[np.complex128]:
    """Return the memory of the law at samples [count, n], NaN where the record does not determine it.

    at: weights that interpolate each sample from the nodes of its panel, and the panels.
    """
    weights, panels = at
    if law.count() == 0:
        return np.empty((0, len(weights)), np.complex128)
    known = np.full((law.count(), len(weights)), np.nan + 0j)
    if isinstance(law, BristleLaw):
        known = deflections(law, contact)[None]
    if not np.isnan(known).any():
        return known
    assert scene.normal_load is not None
    share = 1.0 + scene.signals().normal_load(orbit.tau) / scene.normal_load
    slip = _slip(scene, orbit.v, orbit.tau)
    whole = contact._replace(slip=slip, friction=orbit.friction, share=share)
    found = followed(law, orbit.tau, whole)
    if found is None:
        return known
    return np.asarray((weights[:, :, None] * found[panels]).sum(axis=1).T)


_TO_LEGENDRE: Floats = np.linalg.inv(np.polynomial.legendre.legvander(NODES, PER_PANEL - 1)).astype(
    np.float64
)
"""Matrix from values at the nodes of a panel to the coefficients of the Legendre polynomials."""
_STEEP = 12.0
"""Half the phase of a harmonic in a panel, from which on the recurrence upwards is stable."""
_GAUSS, _SHARES = np.polynomial.legendre.leggauss(32)
_LEGENDRE_GAUSS: Floats = np.polynomial.legendre.legvander(_GAUSS, PER_PANEL - 1) * _SHARES[:, None]
_AT_ONCE = 20_000
"""Largest product of panels and harmonics that are computed at once, which limits memory."""
_ROUNDING = 64.0 * EPSILON
"""Harmonic of the velocity, relative to the largest, below which rounding leaves no phase."""


class HarmonicParts(NamedTuple):
    """Harmonics 0 ... H of velocity and of resisting friction along one direction, one entry each.

    The harmonic k of a function is amplitude*sin(k theta + phase), phases in degrees. theta is the phase of
    the load along x1, or of ``frequency*tau`` without a load. Friction is the coefficient as it acts against
    the mass. Its in_phase part is in phase with the velocity harmonic, which it damps where positive. Its
    in_quadrature part leads the velocity by 90 degrees: inertia where positive, stiffness where negative. For
    k = 0 the amplitude is the mean with its sign. If a harmonic of the velocity is rounding, phases and parts
    against it are NaN.
    """

    harmonic: NDArray[np.int64]
    velocity_amplitude: Floats
    velocity_phase: Floats
    friction_amplitude: Floats
    friction_phase: Floats
    friction_in_phase: Floats
    friction_in_quadrature: Floats


def harmonic_parts(scene: Scene, orbit: Orbit, harmonics: int, across: bool = False) -> HarmonicParts:
    """Return the harmonics 0 ... ``harmonics`` of an orbit; undriven, those of its own frequency.

    Every panel is the polynomial through its nodes, integrated exactly against sine and cosine however fast
    they turn (Filon). across: harmonics of x2' and of friction along x2; phases are still relative to the
    load along x1.
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
    """Return the harmonics of an orbit as columns of a table.

    Columns of motion across the belt have the same names after ``transverse_``.
    """
    along = harmonic_parts(scene, orbit, harmonics)._asdict()
    if not scene.planar:
        return along
    across = harmonic_parts(scene, orbit, harmonics, across=True)._asdict()
    del across["harmonic"]
    return along | {f"transverse_{name}": column for name, column in across.items()}


def _clock(scene: Scene, orbit: Orbit) -> tuple[float, float]:
    """Return the circular frequency of harmonic 1, and the phase of the load along x1 at tau = 0 [rad]."""
    if scene.undriven:
        return 2.0 * math.pi * orbit.periods / float(orbit.tau[-1, -1] - orbit.tau[0, 0]), 0.0
    force = scene.mass().force if scene.degrees_of_freedom else 0j
    return scene.frequency, math.atan2(force.imag, force.real)


def phasors_of_panels(tau: Floats, values: Floats, frequencies: Floats) -> NDArray[np.complex128]:
    """Return for each frequency the F whose Im(F exp(i frequency tau)) is that part of the values.

    For frequency 0 it is i times the mean.
    """
    start, end = tau[:, 0], tau[:, -1]
    half, middle = 0.5 * (end - start), 0.5 * (start + end)
    legendre = half[:, None] * (values @ _TO_LEGENDRE.T)
    parts = np.array_split(frequencies, 1 + len(tau) * len(frequencies) // _AT_ONCE)
    whole = np.concatenate([_integrals_against(part, half, middle, legendre) for part in parts])
    return np.asarray(np.where(frequencies > 0.0, 2j, 1j) * whole / (end[-1] - start[0]))


def _integrals_against(
    frequencies: Floats, half: Floats, middle: Floats, legendre: Floats
) -> NDArray[np.complex128]:
    """Integrate the polynomials of all panels against exp(-i frequency tau), for each frequency."""
    turns = np.exp(-1j * np.outer(middle, frequencies))
    return np.asarray(
        np.einsum("pkn,pn,pk->k", _moments(np.outer(half, frequencies)), legendre, turns, optimize=True)
    )


def _moments(turned: Floats) -> NDArray[np.complex128]:
    """Integrate every Legendre polynomial P_n(s) times exp(-i turned s) over [-1, 1]: 2 (-i)^n j_n(turned).

    Source: DLMF 18.17.19; upwards by j_(n+1) = (2 n + 1)/x j_n - j_(n-1), DLMF 10.51.1.
    """
    turning = np.exp(-1j * np.minimum(turned, _STEEP)[..., None] * _GAUSS)
    found: NDArray[np.complex128] = np.asarray(turning @ _LEGENDRE_GAUSS, dtype=np.complex128)
    x = np.maximum(turned, _STEEP)
    last: Floats = np.cos(x) / x  # orders -1 and 0
    bessel: Floats = np.sin(x) / x
    for n in range(PER_PANEL):
        found[..., n] = np.where(turned < _STEEP, found[..., n], 2.0 * (-1j) ** n * bessel)
        last, bessel = bessel, (2 * n + 1) / x * bessel - last
    return found
