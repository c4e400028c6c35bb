"""The laws without a mistake: a page each, right by every check, of parameters that are all required."""

from __future__ import annotations

import math
from typing import Any

from frictionlab.laws.base import NonNegative, PerSpeed, Positive, SlidingLaw, Speed
from frictionlab.laws.compliant import Damping, Stiffness
from frictionlab.laws.memory import BristleLaw


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


def curve(law: Any, speed: float) -> float:
    """Friction of steady bristles."""
    u = speed / law.speed
    return law.mu + law.drop * math.exp(-u * u)


class Bristles(BristleLaw):
    """LuGre friction, its parameters all required.

    mu [-], > 0: friction coefficient in quick slip.
    drop [-], >= 0: how much more there is in slow slip.
    speed [scene velocity], > 0: speed of the fall.
    stiffness [1/scene length], > 0; damping [1/scene velocity], >= 0; viscosity [1/scene velocity], >= 0.

    Source: Canudas de Wit, Olsson, Astrom & Lischinsky (1995).
    """

    mu: Positive
    drop: NonNegative
    speed: Speed
    stiffness: Stiffness
    damping: Damping
    viscosity: PerSpeed

    def sliding_friction(self, speed: float) -> float:
        """The curve, and viscosity."""
        return curve(self, speed) + self.viscosity * speed

    def rate(self, v: Any, z: Any) -> Any:
        """Towards the curve."""
        return v - (self.stiffness * abs(v) / curve(self, abs(v))) * z

    def friction(self, v: Any, z: Any, dz: Any) -> Any:
        """Spring, dashpot and viscosity."""
        return self.stiffness * z + self.damping * dz + self.viscosity * v

    def constant_sliding_friction(self) -> bool:
        """Where nothing falls and nothing is viscous."""
        return self.drop == 0.0 and self.viscosity == 0.0

    def steepest_fall(self) -> float:
        """At the inflection of the Gaussian."""
        return max(0.0, math.sqrt(2.0 / math.e) * self.drop / self.speed - self.viscosity)

    def largest_deflection(self) -> float:
        """In slow slip."""
        return (self.mu + self.drop) / self.stiffness

    def largest_rate(self, speed: float) -> float:
        """That of the bristles."""
        return self.stiffness * speed / curve(self, speed)

    def rate_independent(self) -> bool:
        """Where nothing is damped."""
        return self.constant_sliding_friction() and self.damping == 0.0

    def passive(self) -> bool:
        """The bound of Barahanov & Ortega (2000)."""
        return self.viscosity >= self.damping * self.drop / self.mu

    def damps_across(self, speed: float) -> bool:
        """Where damping is not too large for the speed."""
        lost = self.damping + self.viscosity
        return super().damps_across(speed) and self.damping**2 * speed / self.mu <= 4.0 * lost


def broken(size: float, begins: float, ends: float) -> float:
    """The share of slip that bristles no longer follow."""
    share = min(max((size - begins) / (ends - begins), 0.0), 1.0)
    return share * share * (3.0 - 2.0 * share)


class BreakingAway(Bristles):
    """Elasto-plastic friction that begins to break away half way."""

    def rate(self, v: Any, z: Any) -> Any:
        """Elastic while z is small or made smaller."""
        if (z * v.conjugate()).real <= 0.0:
            return v
        most = curve(self, abs(v)) / self.stiffness
        share = broken(abs(z), 0.5 * self.mu / self.stiffness, most)
        return v - (share * abs(v) / most) * z

    def elastic_deflection(self) -> float:
        """Half of that of quick slip."""
        return 0.5 * self.mu / self.stiffness

    def elastic_unloading(self) -> bool:
        """Always."""
        return True

    def largest_rate(self, speed: float) -> float:
        """d(share size)/d(size) is at most 1 + 1.5 ends/(ends - begins)."""
        most, begins = curve(self, speed) / self.stiffness, 0.5 * self.mu / self.stiffness
        return speed / most * (1.0 + 1.5 * most / (most - begins))
