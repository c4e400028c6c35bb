"""One period of a steady state at equally spaced times.

Fourier's parts of a recorded orbit: its velocity and its friction, harmonic by harmonic.
"""

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
"""Coefficients, of the powers of a place from 1 on, of the integral of the polynomial through values at the nodes."""


class Samples(NamedTuple):
    """One period of a steady state at n equally spaced times [nondimensional, scales of ``scene``].

    friction [-] is the force that resists slip over the mean normal load; load [K_1 L] is the force that drives the
    mass, at a jump that after it; slip is the velocity against the belt; normal_load [K_1 L] with its variation; work
    [K_1 L^2] what friction has done on the body since the beginning. memory [count, n]: what the law remembers.
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
        """As columns by name; each memory as ``memory_<k>``, with a direction also ``memory_<k>_transverse``."""
        found = self._asdict()
        memory, directed = found.pop("memory"), found.pop("directed")
        for k, values in enumerate(memory):
            found[memory_column(k)] = values.real
            if directed:
                found[memory_column(k, across=True)] = values.imag
        return found


def memory_column(k: int, across: bool = False) -> str:
    """The name of the column of the k-th memory."""
    return f"memory_{k}_transverse" if across else f"memory_{k}"


def memory_columns(law: FrictionLaw) -> list[str]:
    """The names of its columns of memory."""
    directions = (False,) if law.memory_kind == "scalars" else (False, True)
    return [memory_column(k, across) for k in range(law.count()) for across in directions]


def sample(orbit: Orbit, scene: Scene, law: FrictionLaw, n: int) -> Samples:
    """The orbit at n equally spaced times tau = 0 ... its period (end not included)."""
    step = np.ptp(orbit.tau) / orbit.periods / n
    return sample_at(orbit, scene, law, orbit.tau[0, 0] + np.arange(n, dtype=np.float64) * step)


def sample_at(orbit: Orbit, scene: Scene, law: FrictionLaw, times: Floats) -> Samples:
    """The orbit at these times [1/omega_1], within those it is recorded at; law: in the scales of the scene."""
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
    """The velocity against the belt; of a prescribed slip the oscillation is that of the body."""
    belts = scene.signals().belt if scene.degrees_of_freedom else (Signal(), Signal())
    return np.asarray(v - scene.belt_speed - belts[0](times) - 1j * belts[1](times))


def work_of(orbit: Orbit, scene: Scene) -> float:
    """What friction does on the body over the whole record [K_1 L^2]."""
    assert scene.normal_load is not None
    return float(_work(orbit, scene.normal_load, np.array([len(orbit.tau) - 1]), np.array([1.0]))[0])


def _work(orbit: Orbit, normal_load: float, panels: NDArray[np.int64], places: Floats) -> Floats:
    """What friction has done on the body from the beginning of the orbit to places in these panels."""
    power = orbit.friction.real * orbit.v.real
    # across the belt friction may not be known, where nothing moves
    power = -normal_load * (power + np.where(orbit.v.imag == 0.0, 0.0, orbit.friction.imag * orbit.v.imag))
    half = 0.5 * (orbit.tau[:, -1] - orbit.tau[:, 0])
    before = np.concatenate(([0.0], np.cumsum(half * (power @ WEIGHTS))))
    primitive = places[:, None] ** _POWERS - (-1.0) ** _POWERS
    within = ((primitive @ _PRIMITIVE) * power[panels]).sum(axis=1)
    return np.asarray(before[panels] + half[panels] * within)


def _memory(
    orbit: Orbit, scene: Scene, law: FrictionLaw, contact: Contact, at: tuple[Floats, NDArray[np.int64]]
) -> NDArray[np.complex128]:
    """What the law remembers at samples [count, n], NaN where the record does not tell it.

    at: the weights that interpolate each sample from the nodes of its panel, and the panels.
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
