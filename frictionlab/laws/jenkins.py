"""Jenkins friction: a spring in series with a Coulomb slider."""

from __future__ import annotations

import math
from typing import Any

from frictionlab.laws.base import Positive
from frictionlab.laws.compliant import CompliantLaw
from frictionlab.laws.decay import faded


class Jenkins(CompliantLaw):
    """Jenkins friction: a spring that carries all slip up to the force mu, and a Coulomb slider that takes the rest.

    mu [-], > 0: the slider's friction coefficient.
    stiffness [1/scene length], presliding_length [scene length] (mu/stiffness) or contact_stiffness [K_1], > 0.

    In the plane the slider is dragged as by a rope: it moves along the spring while that holds mu (a tractrix).
    Sources: Jenkins (1962); Griffin (1980); the spring is the contact stiffness of Menq, Bielak & Griffin (1986).
    """

    mu: Positive

    @property
    def reach(self) -> float:
        """The deflection at which the slider moves [scene length]."""
        return self.mu / self.bristle_stiffness

    def sliding_friction(self, speed: float) -> float:
        """mu, at every speed."""
        return self.mu

    def rate(self, v: Any, z: Any) -> Any:
        """v, less its part along the spring where that is stretched to its reach and would be stretched further."""
        along = (z * v.conjugate()).real
        if along <= 0.0 or abs(z) < self.reach:
            return v
        return v - (along / (z * z.conjugate()).real) * z

    def friction(self, v: Any, z: Any, dz: Any) -> Any:
        """The spring's."""
        return self.bristle_stiffness * z

    def constant_sliding_friction(self) -> bool:
        """Always."""
        return True

    def largest_deflection(self) -> float:
        """The slider's reach."""
        return self.reach

    def largest_rate(self, speed: float) -> float:
        """In the plane, where the spring turns towards the slip: speed/reach."""
        return speed / self.reach

    def rate_independent(self) -> bool:
        """Always."""
        return True

    def passive(self) -> bool:
        """Always: what the spring does not store, the slider takes."""
        return True

    def exact_path(self) -> bool:
        """Always."""
        return True

    def deflected(self, z: Any, path: Any) -> Any:
        """Elastic up to the reach, then the tractrix: tan(angle/2) falls as exp(-path/reach)."""
        length = abs(path)
        if length == 0.0:
            return z
        direction = path / length
        along = (z * direction.conjugate()).real
        across = (z * z.conjugate()).real - along * along
        free = math.sqrt(max(self.reach * self.reach - across, 0.0)) - along
        if length <= free:
            return z + path
        start = z + max(free, 0.0) * direction
        turn = start * direction.conjugate() / self.reach  # exp(i angle) from the slip to the spring
        left = faded((length - max(free, 0.0)) / self.reach)
        # with c = cos(angle): tan^2(angle/2) = (1 - c)/(1 + c), to be multiplied by left^2
        below, above = (1.0 - turn.real) * left * left, 1.0 + turn.real
        size = below + above
        return self.reach * (
            ((above - below) / size) * direction
            + (2.0 * left / size) * (start / self.reach - turn.real * direction)
        )

    def saturation_path(self, z: float, side: float) -> float:
        """Up to the reach."""
        return self.reach - side * z

    def elastic_deflection(self) -> float:
        """The reach."""
        return self.reach

    def elastic_unloading(self) -> bool:
        """Always."""
        return True

    def yield_deflection(self) -> float:
        """The reach."""
        return self.reach
