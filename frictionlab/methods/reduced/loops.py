"""Mean and first harmonic of bristle friction over a harmonic slip, from its closed loop."""

from __future__ import annotations

import cmath
import math
from typing import Any, NamedTuple

import numpy as np

from frictionlab.compile.call import KernelCall
from frictionlab.compile.decorators import njit
from frictionlab.dynamics.radau_panel import Oscillation
from frictionlab.laws.memory import BristleLaw
from frictionlab.methods.prescribed import exact_legs
from frictionlab.methods.prescribed.bristle import friction_of_each
from frictionlab.methods.prescribed.closed_loop_line import Along, legs_of
from frictionlab.methods.prescribed.collocation import stretches
from frictionlab.methods.prescribed.periodic_deflection import POINTS, SHARES, Accuracy, Closing

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
        slip = Oscillation(complex(amplitude), 0j, self.frequency, 0.0)
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
