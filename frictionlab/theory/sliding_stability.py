"""Steady sliding on damped bristles: its impedance, its stability with a mass on a spring, and saturation.

A deflection is saturated if slip keeps it at its limit.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from frictionlab.scene.body import Mass
from frictionlab.theory.rest import friction_at_rest


@dataclass(frozen=True)
class SteadySliding:
    """Bristle contact in steady sliding at v_0, linearized for small changes of its slip velocity.

    Parameters
    ----------
    slope : float
        Slope dg/dv of the steady friction force, without viscosity [force/velocity]. It is negative
        where friction falls.
    lag : float
        Lag g/(stiffness v_0) of the bristles behind the slip [time].
    lead : float, default 0.0
        Lead damping/stiffness of the bristles [time].
    viscosity : float, default 0.0
        Viscous friction per velocity [force/velocity].
    """

    slope: float
    lag: float
    lead: float = 0.0
    viscosity: float = 0.0

    def impedance(self, s: complex) -> complex:
        """Compute the change of friction per change of slip velocity, along the slip.

        It is slope (1 + lead s)/(1 + lag s) + viscosity.

        Parameters
        ----------
        s : complex
            Complex frequency [1/time]: i Omega for a sine.

        Returns
        -------
        complex
            Impedance [force/velocity].

        References
        ----------
        Linearized Canudas de Wit et al. (1995), IEEE TAC 40, 419.
        """
        return self.slope * (1.0 + self.lead * s) / (1.0 + self.lag * s) + self.viscosity

    def stable(self, damping: float, stiffness: float) -> bool:
        """Check whether steady sliding of a unit mass on a spring and a dashpot is stable.

        The lag of the bristles stabilizes a falling characteristic.

        Parameters
        ----------
        damping : float
            Damping per unit mass [force/velocity].
        stiffness : float
            Stiffness per unit mass [force/length].

        Returns
        -------
        bool
            Whether steady sliding is stable.

        References
        ----------
        Routh (1877) on lag s^3 + b s^2 + c s + stiffness.
        """
        damped = damping + self.viscosity
        second = 1.0 + damped * self.lag + self.slope * self.lead
        first = damped + self.slope + stiffness * self.lag
        return second > 0.0 and first > 0.0 and second * first > stiffness * self.lag


def steady_deflection(law: Any, v: float) -> float:
    """Return the deflection [scene length] of a bristle in steady sliding at slip velocity v (not zero).

    It is the first deflection, from the undeflected bristle on, at which the rate is zero or changes its
    sign.
    """
    direction, still = math.copysign(1.0, v), 1e-12 * abs(v)
    low, high = 0.0, law.largest_deflection()
    if not math.isfinite(high):
        high = 1.0
        while direction * law.rate(v, direction * high) > still and high < 1e9:
            high = 2.0 * high
    while high - low > 4e-16 * high:
        middle = 0.5 * (low + high)
        if direction * law.rate(v, direction * middle) > still:
            low = middle
        else:
            high = middle
    return direction * high


def loses_energy(mass: Mass, law: Any, belt_speed: float, reach: float) -> bool:
    """Check whether every motion near steady sliding loses energy, on friction without memory.

    The motion is no farther than ``reach`` [scene velocity] from steady sliding, in the norm of energy.

    It does if no slip velocity within reach makes friction differ from that of steady sliding, in the
    direction of the motion, by more than damping takes. Slip that has reversed, and rest held by no more than
    that friction, lose energy by themselves.
    """
    speed = abs(belt_speed)
    # in a range that is small against the speed, slopes are taken over a millionth of the speed
    speeds = np.concatenate((np.linspace(max(speed - reach, 0.0), speed + reach, 129), speed * _NEAR))
    speeds = speeds[np.abs(speeds - speed) >= 0.9e-6 * speed]
    friction = np.where(speeds > 0.0, law.sliding_friction(speeds), friction_at_rest(law))
    chords = (friction - law.sliding_friction(speed)) / (speeds - speed)
    return bool((mass.normal_load * chords).min() > -mass.damping + 1e-9)


_NEAR = np.array([1.0 - 1e-6, 1.0 + 1e-6])


SHORT = 1e-7
"""Relative distance of a deflection from its limit at which its approach is measured."""


def slides_saturated(law: Any) -> bool:
    """Check whether a bristle at its limit stays there in slip of any speed along a line, at one friction."""
    if law.memory_kind != "bristle" or not law.constant_sliding_friction():
        return False
    limit, friction = law.largest_deflection(), law.sliding_friction(1.0)
    return (
        math.isfinite(limit)
        and math.isclose(law.friction(1.0, limit, 0.0), friction, rel_tol=1e-12)
        and abs(law.rate(1.0, limit)) <= 1e-12
    )
