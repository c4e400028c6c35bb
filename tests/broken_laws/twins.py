"""A sliding law without a mistake: a page, right by every check, of parameters that are all required."""

from __future__ import annotations

import math

from frictionlab.laws.base import NonNegative, PerSpeed, Positive, SlidingLaw, Speed


class Falling(SlidingLaw):
    """Friction that falls as a Gaussian of speed.

    mu [-], > 0: friction coefficient in quick slip.
    drop [-], >= 0: how much more rest holds.
    speed [scene velocity], > 0: speed of the fall.
    viscosity [1/scene velocity], >= 0: adds viscosity*speed.

    Source: Bo & Pavelescu (1982).
    """

    mu: Positive
    drop: NonNegative
    speed: Speed
    viscosity: PerSpeed

    def sliding_friction(self, speed: float) -> float:
        """The fall, and viscosity."""
        u = speed / self.speed
        return self.mu + self.drop * math.exp(-u * u) + self.viscosity * speed

    def constant_sliding_friction(self) -> bool:
        """Where nothing falls and nothing is viscous."""
        return self.drop == 0.0 and self.viscosity == 0.0

    def steepest_fall(self) -> float:
        """At the inflection of the Gaussian."""
        return max(0.0, math.sqrt(2.0 / math.e) * self.drop / self.speed - self.viscosity)

    def monotone(self) -> bool:
        """Where nothing falls."""
        return self.steepest_fall() == 0.0
