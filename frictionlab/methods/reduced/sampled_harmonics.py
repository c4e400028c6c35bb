"""H harmonics of planar motion and of friction without memory balanced on samples (alternating frequency and time).

Friction is taken at equally spaced instants and its harmonics from there by FFT. It is smooth as long as the slip
velocity does not pass through zero, and its harmonics then fall exponentially; the closer to zero slip passes, the
more of them, and of samples, it takes. Newton's method with the derivative of friction by the slip velocity, whose
harmonics couple every harmonic of motion with every other.

Source: Cameron & Griffin, J. Appl. Mech. 56 (1989), 149-154, of alternating frequency and time.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from frictionlab.compile.interpret import interpreted_on_arrays
from frictionlab.compile.law_lanes import friction_by_lane
from frictionlab.laws.base import FrictionLaw
from frictionlab.quantities import Floats
from frictionlab.scene.body import Mass

_SAMPLES_PER_HARMONIC = 8, 64
"""At first, and where Newton's method does not settle because slip is near rest at one of so few."""
_FEWEST_SAMPLES = 128
_MOST_STEPS = 40
_SHORTEST_STEP = 1e-3
_CLOSED = 1e-12
"""Force that balance lacks, relative to load and friction."""
_SLOWEST = 1e-12
"""Slip speed below which friction is as at this one, relative to the largest; the law gives none at rest."""
_NUDGE = 1e-6
"""Relative change of speed for the slope of a law."""


class PlanarBalance(NamedTuple):
    """A mass and a law, and the impedances and forces along both directions (direction, harmonic).

    samples: of a period, once it is known how many.
    """

    mass: Mass
    law: FrictionLaw
    impedance: NDArray[np.complex128]
    force: NDArray[np.complex128]
    samples: int = 0

    def sampled(self, per_harmonic: int) -> PlanarBalance:
        """With so many samples, a power of two."""
        wanted = max(_FEWEST_SAMPLES, per_harmonic * self.impedance.shape[1])
        return self._replace(samples=int(2 ** math.ceil(math.log2(wanted))))

    def friction_free(self) -> NDArray[np.complex128]:
        """Velocities without friction; a velocity is the real part of the sum of V_k exp(i k angle)."""
        return self.force / self.impedance

    def slip(self, velocity: NDArray[np.complex128], belt_speed: float) -> Floats:
        """Slip velocities at the samples (direction, sample)."""
        count = self.samples
        spectrum = np.zeros((2, count // 2 + 1), np.complex128)
        spectrum[:, 1 : velocity.shape[1] + 1] = 0.5 * count * velocity
        spectrum[0, 0] = -belt_speed * count
        return np.asarray(np.fft.irfft(spectrum, count, axis=1))


class PlanarMotion(NamedTuple):
    """Velocities (direction, harmonic 1 ... H), and the friction coefficient's mean along both directions."""

    velocity: NDArray[np.complex128]
    mean: Floats


def planar_balance(mass: Mass, law: FrictionLaw, harmonics: int) -> PlanarBalance:
    """Of a mass under loads of one sine; phases are of angle = frequency*tau."""
    orders = np.arange(1.0, harmonics + 1.0)
    rate = mass.frequency * orders
    along = mass.damping + 1j * (rate - mass.stiffness / rate)
    across = mass.transverse_damping + 1j * (rate - mass.transverse_stiffness / rate)
    force = np.zeros((2, harmonics), np.complex128)
    force[:, 0] = -1j * np.array([mass.force, mass.transverse_force])  # Im(F e) = Re(-i F e)
    return PlanarBalance(mass, law, np.stack([along, across]), force)


def friction_vectors(law: FrictionLaw, slip: Floats) -> tuple[Floats, Floats, Floats]:
    """Friction that resists the slip velocities (direction, sample), the coefficient, and its slope by the speed."""
    speed = np.hypot(slip[0], slip[1])
    speed = np.maximum(speed, _SLOWEST * max(float(speed.max()), 1e-300))
    of_speed = interpreted_on_arrays(friction_by_lane)
    size = np.asarray(of_speed(law, speed)) + 0.0 * speed
    faster = np.asarray(of_speed(law, (1.0 + _NUDGE) * speed)) + 0.0 * speed
    return size / speed * slip, size, (faster - size) / (_NUDGE * speed)


def balanced_in_the_plane(
    what: PlanarBalance, belt_speed: float, start: NDArray[np.complex128]
) -> PlanarMotion | None:
    """The motion that Newton's method finds from these velocities; None where it does not settle."""
    tries = (_settled(what.sampled(count), belt_speed, start) for count in _SAMPLES_PER_HARMONIC)
    return next((motion for motion in tries if motion is not None), None)


def _settled(what: PlanarBalance, belt_speed: float, start: NDArray[np.complex128]) -> PlanarMotion | None:
    velocity, scale = start, np.abs(what.force).sum() + what.mass.normal_load * what.law.sliding_friction(1.0)
    missing, slip, mean = _missing(what, velocity, belt_speed)
    size = float(np.abs(missing).max())
    for _ in range(_MOST_STEPS):
        if size <= _CLOSED * scale:
            return PlanarMotion(velocity, mean)
        step = _newton_step(what, slip, missing)
        if step is None:
            return None
        share = 1.0
        while True:
            tried = velocity + share * step
            found = _missing(what, tried, belt_speed)
            left = float(np.abs(found[0]).max())
            if left < (1.0 - 0.1 * share) * size or share < _SHORTEST_STEP:
                break
            share *= 0.5
        if share < _SHORTEST_STEP:
            # As far as rounding lets it: a step that gains nothing from near the end.
            return PlanarMotion(velocity, mean) if size <= 1e4 * _CLOSED * scale else None
        velocity, (missing, slip, mean), size = tried, found, left
    return None


def _missing(
    what: PlanarBalance, velocity: NDArray[np.complex128], belt_speed: float
) -> tuple[NDArray[np.complex128], Floats, Floats]:
    """The force that every harmonic lacks, the slip at the samples and the mean friction."""
    slip = what.slip(velocity, belt_speed)
    spectrum = np.fft.rfft(friction_vectors(what.law, slip)[0], axis=1) / slip.shape[1]
    friction = 2.0 * spectrum[:, 1 : velocity.shape[1] + 1]
    missing = what.impedance * velocity + what.mass.normal_load * friction - what.force
    return missing, slip, spectrum[:, 0].real


def _newton_step(
    what: PlanarBalance, slip: Floats, missing: NDArray[np.complex128]
) -> NDArray[np.complex128] | None:
    """Solve for the change of the velocities that removes what is missing, real and imaginary parts apart."""
    harmonics = missing.shape[1]
    derivatives = _derivatives(what.law, slip) * what.mass.normal_load
    spectra = np.fft.fft(derivatives, axis=-1) / slip.shape[1]
    orders = np.arange(1, harmonics + 1)
    # The change of harmonic j by harmonic k, and by its complex conjugate.
    direct = spectra[:, :, orders[:, None] - orders[None, :]]
    mirrored = spectra[:, :, orders[:, None] + orders[None, :]]
    for direction in range(2):
        direct[direction, direction] += np.diag(what.impedance[direction])
    whole = np.block([[real_block(direct[a, b], mirrored[a, b]) for b in range(2)] for a in range(2)])
    side = np.concatenate([part for row in missing for part in (row.real, row.imag)])
    try:
        change = np.linalg.solve(whole, -side).reshape(2, 2, harmonics)
    except np.linalg.LinAlgError:
        return None
    return np.asarray(change[:, 0] + 1j * change[:, 1])


def real_block(direct: NDArray[np.complex128], mirrored: NDArray[np.complex128]) -> Floats:
    """Of direct*V + mirrored*conj(V), by the real and the imaginary part of V."""
    together, apart = direct + mirrored, direct - mirrored
    return np.block([[together.real, -apart.imag], [together.imag, apart.real]])


def _derivatives(law: FrictionLaw, slip: Floats) -> Floats:
    """Of friction by slip velocity (direction, direction, sample): across the slip size/speed, along it the slope."""
    friction, size, slope = friction_vectors(law, slip)
    way = friction / size
    speed = np.hypot(slip[0], slip[1])
    speed = np.maximum(speed, _SLOWEST * max(float(speed.max()), 1e-300))
    turning = size / speed
    along = way[:, None] * way[None, :]
    return np.asarray(turning * np.eye(2)[:, :, None] + (slope - turning) * along)
