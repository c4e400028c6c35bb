"""Base class of LuGre and elasto-plastic friction: damped bristles, a Stribeck curve and viscosity."""

from __future__ import annotations

from abc import ABC
from collections.abc import Iterator
from typing import Any

from frictionlab.laws.base import PerSpeed, Positive, Speed
from frictionlab.laws.compliant import DampedLaw
from frictionlab.laws.decay import exp_power_decay, steepest_slope


class StribeckBristle(DampedLaw, ABC):
    """Bristle law whose steady friction is a Stribeck curve g (Bo & Pavelescu, 1982), plus viscosity.

    g = mu_kinetic + (mu_static - mu_kinetic) exp(-(|v|/stribeck_speed)^stribeck_exponent),
    friction = stiffness z + damping z' + viscosity v.

    Parameters
    ----------
    mu_kinetic : float, > 0
        Friction coefficient in fast sliding, without the viscous term [-].
    mu_static : float, >= mu_kinetic, optional
        Friction coefficient at vanishing speed [-]; ``mu_kinetic`` if left out.
    stribeck_speed : float, > 0, default 1
        Speed over which the coefficient falls [scene velocity].
    stribeck_exponent : float, > 0, default 2
        Exponent of the fall [-]; 2 makes the fall a Gaussian.
    viscosity : float, >= 0, default 0
        Viscosity [1/scene velocity]: adds viscosity*speed to the coefficient.
    stiffness : float, > 0, optional
        Stiffness: friction coefficient per deflection [1/scene length]. Exactly one is given: ``stiffness``,
        ``presliding_length`` or ``contact_stiffness``.
    presliding_length : float, > 0, optional
        Presliding length, mu_kinetic/stiffness [scene length].
    contact_stiffness : float, > 0, optional
        Contact stiffness, ``stiffness`` times normal load [K_1].
    damping : float, >= 0, optional
        Damping: friction coefficient per rate of deflection [1/scene velocity]; 0 if neither it nor
        ``contact_damping`` is given.
    contact_damping : float, >= 0, optional
        Contact damping, ``damping`` times normal load [M omega_1]; given instead of ``damping``.
    planar : {"vectorial", "per-axis"}, default "vectorial"
        Form of the law in the plane, as in ``BristleLaw``.
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
        """Return mu_kinetic."""
        return self.mu_kinetic

    @property
    def peak(self) -> float:
        """Coefficient at vanishing speed [-]."""
        return self.mu_kinetic if self.mu_static is None else self.mu_static

    def sliding_friction(self, speed: float) -> float:
        """Compute the Stribeck curve plus viscosity."""
        return stribeck_curve(self, speed) + self.viscosity * speed

    def friction(self, v: Any, z: Any, dz: Any) -> Any:
        """Compute the sum of spring, dashpot and viscosity."""
        return self.bristle_stiffness * z + self.bristle_damping * dz + self.viscosity * v

    def constant_sliding_friction(self) -> bool:
        """Check whether mu_static = mu_kinetic and viscosity = 0."""
        return self.peak == self.mu_kinetic and self.viscosity == 0.0

    def largest_deflection(self) -> float:
        """Return mu_static/stiffness: the steady deflection at vanishing speed, larger than at high speed."""
        return self.peak / self.bristle_stiffness

    def largest_rate(self, speed: float) -> float:
        """Return stiffness*speed/g."""
        return self.bristle_stiffness * speed / stribeck_curve(self, speed)

    def steepest_fall(self) -> float:
        """Return the slope of the fall of g at its inflection, minus viscosity; 0 if viscosity is larger."""
        drop = self.peak - self.mu_kinetic
        if drop == 0.0:
            return 0.0
        return max(0.0, drop / self.stribeck_speed * steepest_slope(self.stribeck_exponent) - self.viscosity)

    def damps_across(self, speed: float) -> bool:
        """Check a sufficient condition that friction takes energy from motion across the slip.

        It is damping^2 speed/mu_kinetic <= 4 (damping + viscosity).
        """
        lost = self.bristle_damping + self.viscosity
        return self.bristle_damping**2 * speed / self.mu_kinetic <= 4.0 * lost

    def rate_independent(self) -> bool:
        """Check whether g is the same at every speed and there is neither damping nor viscosity."""
        return self.constant_sliding_friction() and self.bristle_damping == 0.0

    def passive(self) -> bool:
        """Check the bound viscosity >= damping*(mu_static/mu_kinetic - 1) of Barahanov & Ortega (2000)."""
        return self.viscosity >= self.bristle_damping * (self.peak / self.mu_kinetic - 1.0)


def stribeck_curve(law: Any, speed: float) -> float:
    """Compute g: from mu_static at vanishing speed down to mu_kinetic."""
    drop = law.peak - law.mu_kinetic
    if drop == 0.0:
        return law.mu_kinetic
    return law.mu_kinetic + drop * exp_power_decay(speed / law.stribeck_speed, law.stribeck_exponent)
