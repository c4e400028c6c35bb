"""Steady sliding on damped bristles: its impedance and its stability with a mass on a spring."""

from __future__ import annotations

from dataclasses import dataclass


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
