"""The linear motion after forces that switch, in H harmonics a period, those beyond as of a free mass or left out.

Coulomb friction is known from the instants at which it switches, all its harmonics in closed form. The mass answers
harmonic k by the velocity Y_k = 1/(damping + i (k Omega - stiffness/(k Omega))) per force. Far above resonance it is
a free mass, Y_k = 1/(i k Omega), whose velocity is piecewise linear between switches: the sum of all harmonics k > H.
What the free mass leaves out of them falls as k^-2 in Y_k, and so as k^-3 in the velocity after a switch.
"""

from __future__ import annotations

import math
from typing import NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from frictionlab.quantities import Floats
from frictionlab.scene.body import Mass

_Number = TypeVar("_Number", np.float64, np.complex128)


class SwitchResponse(NamedTuple):
    """Steady velocity after unit steps of force at phase 0 of every period, less the mean and what would drift.

    Steps of a periodic force add up to zero, which makes the response to all of them this one at every step, summed.
    orders [H]: 1 ... H; coefficients [H]: of exp(i k phase), real parts meant; beyond: whether those above H are
    there, as of a free mass.
    """

    frequency: float
    orders: Floats
    coefficients: NDArray[np.complex128]
    beyond: bool

    def turns(self, phase: Floats) -> NDArray[np.complex128]:
        """exp(i k phase), the harmonics along a new last axis."""
        return np.asarray(np.exp(1j * np.multiply.outer(phase, self.orders)))

    def velocity(self, phase: Floats) -> Floats:
        """At these phases after a step."""
        within = _along(self.turns(phase), self.coefficients).real
        return np.asarray(within + self.beyond_velocity(phase) if self.beyond else within)

    def slope(self, phase: Floats) -> Floats:
        """The derivative of the velocity by the phase; at a step that after it."""
        within = _along(self.turns(phase), 1j * self.orders * self.coefficients).real
        return np.asarray(within + self.beyond_slope(phase) if self.beyond else within)

    def around(self, phase: Floats) -> tuple[Floats, Floats, Floats, Floats]:
        """Velocity after a step plus that before it less twice that at it; after less before; their slopes.

        Of phases in [0, pi].
        """
        half = np.multiply.outer(0.5 * phase, self.orders)
        rise, sine = np.sin(half), np.cos(half)
        sine, fall = (
            2.0 * rise * sine,
            2.0 * rise**2,
        )  # of the whole angle: its sine, and what its cosine is below 1
        even, odd = 2.0 * self.coefficients.real, -2.0 * self.coefficients.imag
        both, apart = -_along(fall, even), _along(sine, odd)
        both_slope, apart_slope = _along(sine, -self.orders * even), _along(1.0 - fall, self.orders * odd)
        if self.beyond:
            both = both + phase * (math.pi - 0.5 * phase) / (math.pi * self.frequency)
            both_slope = both_slope + 2.0 * self.beyond_slope(phase)
        return both, apart, both_slope, apart_slope

    def displacement(self, phase: Floats) -> Floats:
        """The displacement that goes with the velocity."""
        within = _along(self.turns(phase), self.coefficients / (1j * self.orders)).real / self.frequency
        return np.asarray(within + self.beyond_displacement(phase) if self.beyond else within)

    # Sums over all k >= 1 of -cos(k phase)/(pi k^2 frequency), their slope, and their integral.
    def beyond_velocity(self, phase: Floats) -> Floats:
        p = np.mod(phase, math.tau)
        return np.asarray(-(math.pi**2 / 6.0 - 0.5 * math.pi * p + 0.25 * p**2) / (math.pi * self.frequency))

    def beyond_slope(self, phase: Floats) -> Floats:
        return np.asarray((0.5 * math.pi - 0.5 * np.mod(phase, math.tau)) / (math.pi * self.frequency))

    def beyond_displacement(self, phase: Floats) -> Floats:
        p = np.mod(phase, math.tau)
        whole = math.pi**2 * p / 6.0 - 0.25 * math.pi * p**2 + p**3 / 12.0
        return np.asarray(-whole / (math.pi * self.frequency**2))


def _along(values: NDArray[_Number], coefficients: NDArray[_Number]) -> NDArray[_Number]:
    """The sum over harmonics. (A product of matrices so small would wait for the threads of BLAS.)"""
    return np.asarray(np.einsum("...k,k->...", values, coefficients))


def switch_response(mass: Mass, harmonics: int, tail: bool) -> SwitchResponse:
    """Along the belt, in so many harmonics; with the tail, those beyond as of a free mass."""
    orders = np.arange(1.0, harmonics + 1.0)
    inertia = 1j * mass.frequency * orders
    impedance = harmonic_impedances(mass, harmonics)
    # With the tail only what differs from the free mass: 1/impedance - 1/inertia, without the cancellation.
    of_spring = mass.stiffness / inertia
    answer = -(mass.damping + of_spring) / (impedance * inertia) if tail else 1.0 / impedance
    return SwitchResponse(mass.frequency, orders, answer / (1j * math.pi * orders), tail)


def harmonic_impedances(mass: Mass, harmonics: int) -> NDArray[np.complex128]:
    """Force over velocity along the belt at the harmonics 1 ... H."""
    frequency = mass.frequency * np.arange(1.0, harmonics + 1.0)
    return np.asarray(mass.damping + 1j * (frequency - mass.stiffness / frequency))
