"""Base class of LuGre and elasto-plastic friction: damped bristles, a Stribeck curve and viscosity."""

from __future__ import annotations

from abc import ABC
from collections.abc import Iterator
from typing import Any

from frictionlab.laws.base import PerSpeed, Positive, Speed
from frictionlab.laws.compliant import DampedLaw
from frictionlab.laws.decay import exp_power_decay, steepest_slope


class StribeckBristle(DampedLaw, ABC):
    """A bristle law whose steady friction is a Stribeck curve g (Bo & Pavelescu, 1982), plus viscosity.

    g = mu_kinetic + (mu_static - mu_kinetic) exp(-(|v|/stribeck_speed)^stribeck_exponent),
    friction = stiffness z + damping z' + viscosity v.

    mu_kinetic [-], > 0: coefficient in quick sliding, viscosity apart.
    mu_static [-], >= mu_kinetic: at vanishing speed; mu_kinetic where left out.
    stribeck_speed [scene velocity], > 0: speed of the fall.
    stribeck_exponent [-], > 0: 2 makes the fall a Gaussian.
    viscosity [1/scene velocity], >= 0: adds viscosity*speed to the coefficient.
    """

    mu_kinetic: Positive
    mu_static: Positive | None = None
    stribeck_speed: Speed = 1.0
    stribeck_exponent: Positive = 2.0
    viscosity: PerSpeed = 0.0

    def _problems(self) -> Iterator[str]:
        yield from super()._problems()
        if self.mu_static is not None and self.mu_static < self.mu_kinetic:
            yield f"mu_static: must be >= mu_kinetic = {self.mu_kinetic:g}, got {self.mu_static:g}"

    def saturated_friction(self) -> float:
        """mu_kinetic."""
        return self.mu_kinetic

    @property
    def peak(self) -> float:
        """The coefficient at vanishing speed [-]."""
        return self.mu_kinetic if self.mu_static is None else self.mu_static

    def sliding_friction(self, speed: float) -> float:
        """The Stribeck curve, and viscosity."""
        return stribeck_curve(self, speed) + self.viscosity * speed

    def friction(self, v: Any, z: Any, dz: Any) -> Any:
        """Spring, dashpot and viscosity."""
        return self.bristle_stiffness * z + self.bristle_damping * dz + self.viscosity * v

    def constant_sliding_friction(self) -> bool:
        """Where mu_static = mu_kinetic and viscosity = 0."""
        return self.peak == self.mu_kinetic and self.viscosity == 0.0

    def largest_deflection(self) -> float:
        """mu_static/stiffness: the steady deflection at vanishing speed, larger than at high speed."""
        return self.peak / self.bristle_stiffness

    def largest_rate(self, speed: float) -> float:
        """stiffness*speed/g."""
        return self.bristle_stiffness * speed / stribeck_curve(self, speed)

    def steepest_fall(self) -> float:
        """At the inflection of the curve, less viscosity."""
        drop = self.peak - self.mu_kinetic
        if drop == 0.0:
            return 0.0
        return max(0.0, drop / self.stribeck_speed * steepest_slope(self.stribeck_exponent) - self.viscosity)

    def damps_across(self, speed: float) -> bool:
        """damping^2 speed/mu_kinetic <= 4 (damping + viscosity)."""
        lost = self.bristle_damping + self.viscosity
        return super().damps_across(speed) and self.bristle_damping**2 * speed / self.mu_kinetic <= 4.0 * lost

    def rate_independent(self) -> bool:
        """Where g is the same at every speed and there is neither damping nor viscosity."""
        return self.constant_sliding_friction() and self.bristle_damping == 0.0

    def passive(self) -> bool:
        """viscosity >= damping*(mu_static/mu_kinetic - 1), the bound of Barahanov & Ortega (2000)."""
        return self.viscosity >= self.bristle_damping * (self.peak / self.mu_kinetic - 1.0)


def stribeck_curve(law: Any, speed: float) -> float:
    """g: from mu_static at vanishing speed down to mu_kinetic."""
    drop = law.peak - law.mu_kinetic
    if drop == 0.0:
        return law.mu_kinetic
    return law.mu_kinetic + drop * exp_power_decay(speed / law.stribeck_speed, law.stribeck_exponent)
