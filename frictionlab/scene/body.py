"""Numbers of a scene for kernels: mass, springs, dashpots, loads, and the friction-free response."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from frictionlab.scene.varying import of_one_sine, packed


class Bends(NamedTuple):
    """Coefficients of the nonlinear force along x1.

    The force is spring_2 x^2 + spring_3 x^3 + (dashpot_1 x + dashpot_2 x^2) x'.

    sine, cosine: approximately those of the motion without friction, by one harmonic; searches begin there,
    it is no reference motion. some: empty if all coefficients are 0, which compilers then know.

    Licence of kernels of their own for linear bodies: as numbers that are 0 the coefficients make curves 6 to 12 %
    slower (list ``standard`` of the benchmarks).
    """

    spring_2: float
    spring_3: float
    dashpot_1: float
    dashpot_2: float
    sine: float = 0.0
    cosine: float = 0.0
    some: Any = (1.0,)


NO_BENDS = Bends(0.0, 0.0, 0.0, 0.0, some=())


class Mass(NamedTuple):
    """Numbers of a free scene for kernels; every force is Im(phasor exp(i frequency tau)).

    varying: everything that changes in time, if that is more than these forces, which are then the harmonics
    of the loads at this frequency; else empty. bends: empty if springs and dashpots are linear.
    """

    damping: float
    stiffness: float
    transverse_damping: float
    transverse_stiffness: float
    normal_load: float
    frequency: float
    force: complex
    transverse_force: complex
    varying: Any = ()
    bends: Any = ()


def one_harmonic_motions(mass: Mass, rub: float = 0.0) -> list[complex]:
    """Compute phasors of x1 that balance the load by one harmonic, of a body that bends.

    ``rub`` is a force against velocity.
    """
    return list(_balanced(mass.bends[:4], mass.damping, mass.stiffness, mass.frequency, mass.force, rub))


@lru_cache(maxsize=64)  # the belt speeds of a curve share them
def _balanced(
    bends: tuple[float, float, float, float],
    damping: float,
    stiffness: float,
    omega: float,
    force: complex,
    rub: float,
) -> tuple[complex, ...]:
    """Compute these phasors from the coefficients of a body; one tuple serves all belt speeds of a curve."""
    spring_2, spring_3, _, dashpot_2 = bends
    load = abs(force)
    if load == 0.0:
        return ()
    # an even spring softens by the shift of the mean that it brings
    cubic = 0.75 * spring_3 - (5.0 / 6.0) * spring_2**2 / stiffness
    amplitudes = load / max(stiffness, omega**2) * np.geomspace(1e-3, 1e3, 3001)
    damped = omega * (damping + 0.25 * dashpot_2 * amplitudes**2) + rub / amplitudes
    dynamic = stiffness + cubic * amplitudes**2 - omega**2 + 1j * damped
    missing = amplitudes * np.abs(dynamic) - load
    return tuple(complex(force / dynamic[i]) for i in np.flatnonzero(missing[:-1] * missing[1:] < 0.0))


def with_free_motion(mass: Mass) -> Mass:
    """Return the mass with its motion without friction, that of the least amplitude, in ``bends``."""
    free = next(iter(one_harmonic_motions(mass)), 0j)
    return mass._replace(bends=mass.bends._replace(sine=free.real, cosine=free.imag))


def for_kernels(mass: Mass) -> Mass:
    """Return the mass with everything that varies in one table, and with coefficients of bends where it has none."""
    mass = mass._replace(bends=mass.bends or NO_BENDS)
    bare = planar_numbers(mass, 1.0)
    one = of_one_sine(bare.load_sine, bare.load_cosine, mass.frequency)
    balanced = bare.balanced_sine, bare.balanced_cosine
    return mass._replace(varying=packed(mass.varying or one, balanced, mass.frequency))


class BodyNumbers(NamedTuple):
    """Numbers of a free scene, for kernels that run on the line (``float``) and in the plane (``complex``).

    A constant that differs between x1 and x2 acts as mean*x + split*conj(x), x = x1 + i x2. The motion is the
    sum of a harmonic reference, the friction-free response where that is bounded, and the deviation from it.
    ``balanced`` is the force that the reference motion takes, all of the ``load`` except at undamped
    resonance and if loads are ``varying``. A sine/cosine pair stands for sine*sin(Omega tau) +
    cosine*cos(Omega tau). A period map spans ``periods`` periods of the drive. If ``prescribed``, friction
    does not change the motion, which is the reference.

    ``load`` and ``normal_load`` are the numbers of motion/equation.py, where they become functions of time;
    elsewhere ``normal_load``, the mean, only measures accuracies and step sizes.

    If the body bends, there is no reference along x1.
    """

    damping_mean: float
    damping_split: float
    stiffness_mean: float
    stiffness_split: float
    normal_load: float
    frequency: float
    load_sine: Any
    load_cosine: Any
    balanced_sine: Any
    balanced_cosine: Any
    reference_sine: Any
    reference_cosine: Any
    periods: float
    prescribed: bool = False
    varying: Any = ()
    bends: Any = NO_BENDS


def on_the_line(mass: Mass, periods: float = 1.0) -> BodyNumbers:
    """Return the body with motion along the belt alone.

    It is the part along the belt of a body in the plane that has the same numbers across.
    """
    alike = mass._replace(
        transverse_damping=mass.damping, transverse_stiffness=mass.stiffness, transverse_force=0j
    )
    plane = in_the_plane(alike, periods)
    numbers: list[Any] = [number.real if isinstance(number, complex) else number for number in plane]
    return BodyNumbers(*numbers)


def in_the_plane(mass: Mass, periods: float = 1.0) -> BodyNumbers:
    """Return the body with both motions."""
    return planar_numbers(for_kernels(mass), periods)


def planar_numbers(mass: Mass, periods: float) -> BodyNumbers:
    """Return the body with both motions, of a mass as kernels have it."""
    along = mass.damping, mass.stiffness, mass.frequency, mass.force
    across = mass.transverse_damping, mass.transverse_stiffness, mass.frequency, mass.transverse_force
    reference, reference_2 = _friction_free(*along), _friction_free(*across)
    if len(mass.bends.some) > 0:
        reference = 0j
    force, force_2 = mass.force, mass.transverse_force
    taken = force if reference != 0 else 0j
    taken_2 = force_2 if reference_2 != 0 else 0j
    return BodyNumbers(
        damping_mean=0.5 * (mass.damping + mass.transverse_damping),
        damping_split=0.5 * (mass.damping - mass.transverse_damping),
        stiffness_mean=0.5 * (mass.stiffness + mass.transverse_stiffness),
        stiffness_split=0.5 * (mass.stiffness - mass.transverse_stiffness),
        normal_load=mass.normal_load,
        frequency=mass.frequency,
        load_sine=complex(force.real, force_2.real),
        load_cosine=complex(force.imag, force_2.imag),
        balanced_sine=complex(taken.real, taken_2.real),
        balanced_cosine=complex(taken.imag, taken_2.imag),
        reference_sine=complex(reference.real, reference_2.real),
        reference_cosine=complex(reference.imag, reference_2.imag),
        periods=periods,
        prescribed=False,
        varying=mass.varying,
        bends=mass.bends,
    )


def _friction_free(damping: float, stiffness: float, frequency: float, force: complex) -> complex:
    """Compute the phasor of the friction-free response; 0 at undamped resonance, where it has no bound."""
    dynamic = complex(stiffness - frequency**2, damping * frequency)
    return force / dynamic if dynamic != 0 else 0j


def restoring_force(body: BodyNumbers, x: Any, v: Any) -> Any:
    """Compute the force of linear springs and dashpots per unit mass.

    It is to be subtracted from the acceleration.
    """
    damping = body.damping_mean * v + body.damping_split * v.conjugate()
    return damping + body.stiffness_mean * x + body.stiffness_split * x.conjugate()


def bent_force(body: BodyNumbers, x: Any, v: Any) -> Any:
    """Compute the force of springs and dashpots per unit mass."""
    if len(body.bends.some) == 0:
        return restoring_force(body, x, v)
    bends, x1 = body.bends, x.real
    spring = (bends.spring_2 + bends.spring_3 * x1) * x1 * x1
    return restoring_force(body, x, v) + (spring + (bends.dashpot_1 + bends.dashpot_2 * x1) * x1 * v.real)


def bent_slopes(body: BodyNumbers, x: Any, v: Any) -> BodyNumbers:
    """Return the body with the linear springs and dashpots that it has beside this motion."""
    bends, x1 = body.bends, x.real
    if len(bends.some) == 0:
        return body
    spring = (2.0 * bends.spring_2 + 3.0 * bends.spring_3 * x1) * x1
    spring = 0.5 * (spring + (bends.dashpot_1 + 2.0 * bends.dashpot_2 * x1) * v.real)
    dashpot = 0.5 * (bends.dashpot_1 + bends.dashpot_2 * x1) * x1
    none = Bends(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, bends.some)
    return BodyNumbers(
        body.damping_mean + dashpot, body.damping_split + dashpot, body.stiffness_mean + spring,
        body.stiffness_split + spring, body.normal_load, body.frequency, body.load_sine, body.load_cosine,
        body.balanced_sine, body.balanced_cosine, body.reference_sine, body.reference_cosine, body.periods,
        body.prescribed, body.varying, none,
    )  # fmt: skip


def span(body: BodyNumbers) -> float:
    """Return the time that one period map covers."""
    return 2.0 * math.pi * body.periods / body.frequency


class Motion(NamedTuple):
    """Numbers of a prescribed slip for kernels: velocities Im(phasor exp(i frequency tau)).

    varying: everything that changes in time, if that is more than these velocities; else empty. The
    oscillation of the slip is then that of a belt, and the velocities are its harmonics at this frequency.
    """

    normal_load: float
    frequency: float
    velocity: complex
    transverse_velocity: complex
    varying: Any = ()
