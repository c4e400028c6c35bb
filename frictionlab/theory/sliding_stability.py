"""Steady sliding on damped bristles: its impedance and its stability with a mass on a spring.

When a deflection that grows along the slip stays at its limit.
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
    """A bristle contact in steady sliding at v_0, linearized for small changes of its slip velocity.

    slope [force/velocity]: dg/dv of its steady friction force, viscosity apart; negative where friction falls. lag
    [time]: g/(stiffness v_0), by which bristles lag behind the slip. lead [time]: damping/stiffness of the
    bristles. viscosity [force/velocity].
    """

    slope: float
    lag: float
    lead: float = 0.0
    viscosity: float = 0.0

    def impedance(self, s: complex) -> complex:
        """Change of friction per change of slip velocity along the slip: slope (1 + lead s)/(1 + lag s) + viscosity.

        s [1/time]: i Omega for a sine. Source: linearized Canudas de Wit et al. (1995), IEEE TAC 40, 419.
        """
        return self.slope * (1.0 + self.lead * s) / (1.0 + self.lag * s) + self.viscosity

    def stable(self, damping: float, stiffness: float) -> bool:
        """Whether steady sliding of a unit mass on this spring and dashpot is stable.

        The lag of the bristles stabilizes a falling characteristic. damping [force/velocity] and stiffness
        [force/length] per unit mass. Source: Routh (1877) on lag s^3 + b s^2 + c s + stiffness.
        """
        damped = damping + self.viscosity
        second = 1.0 + damped * self.lag + self.slope * self.lead
        first = damped + self.slope + stiffness * self.lag
        return second > 0.0 and first > 0.0 and second * first > stiffness * self.lag


def steady_deflection(law: Any, v: float) -> float:
    """The deflection [scene length] of a bristle in steady sliding at slip velocity v (not zero).

    From the undeflected bristle, which slip bends, up to where its rate is zero or turns round.
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
    """Whether every motion no farther than this from steady sliding loses energy, on friction without memory.

    It does where no slip velocity within its reach makes friction differ from that of steady sliding in the
    direction of the motion by more than damping takes. Slip that has turned round, and rest where it holds by
    no more than that, lose energy by themselves. reach [scene velocity]: in the norm of energy.
    """
    speed = abs(belt_speed)
    # where the range is small against the speed the slopes are those of a millionth of it
    speeds = np.concatenate((np.linspace(max(speed - reach, 0.0), speed + reach, 129), speed * _NEAR))
    speeds = speeds[np.abs(speeds - speed) >= 0.9e-6 * speed]
    friction = np.where(speeds > 0.0, law.sliding_friction(speeds), friction_at_rest(law))
    chords = (friction - law.sliding_friction(speed)) / (speeds - speed)
    return bool((mass.normal_load * chords).min() > -mass.damping + 1e-9)


_NEAR = np.array([1.0 - 1e-6, 1.0 + 1e-6])


SHORT = 1e-7
"""Share of the limit that a deflection lacks where its approach is measured."""


def saturates(law: Any) -> bool:
    """Whether slip that only turns leaves a deflection at its limit, with one friction at every speed.

    A ``rotated`` deflection moves with |v|: wherever the way slid has no end it grows until it stays at its limit.
    Friction is then that of sliding, along the slip.
    """
    if law.planar_form() != "rotated" or not law.constant_sliding_friction():
        return False
    limit, friction = law.largest_deflection(), law.sliding_friction(1.0)
    short = (1.0 - SHORT) * limit
    return (
        math.isfinite(limit)
        and math.isclose(law.friction(1.0, limit, 0.0), friction, rel_tol=1e-9)
        and math.isclose(law.rate(2.0, short), 2.0 * law.rate(1.0, short), rel_tol=1e-9)
    )


def slides_saturated(law: Any) -> bool:
    """Whether a bristle at its limit stays there in slip of any speed along a line, at one friction."""
    if law.memory_kind != "bristle" or not law.constant_sliding_friction():
        return False
    limit, friction = law.largest_deflection(), law.sliding_friction(1.0)
    return (
        math.isfinite(limit)
        and math.isclose(law.friction(1.0, limit, 0.0), friction, rel_tol=1e-12)
        and abs(law.rate(1.0, limit)) <= 1e-12
    )


def remaining_share(law: Any, path: Any) -> Any:
    """What is left of a small lack of deflection after a path slid [scene length], of what there was before."""
    limit = law.largest_deflection()
    return np.exp(-path * law.rate(1.0, (1.0 - SHORT) * limit) / (SHORT * limit))
