"""Bouc-Wen hysteresis as a law of friction."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import Field

from frictionlab import CompliantLaw, Positive

Exponent = Annotated[Positive, Field(ge=1, le=20)]


class BoucWen(CompliantLaw):
    """Bouc-Wen friction: a spring that yields the more abruptly the larger its exponent, and saturates at mu.

    z' = v - (beta |z.v| + gamma z.v) |z|^(n-2) z, friction = stiffness z; at the limit z_max = mu/stiffness friction
    is mu, so that beta + gamma = z_max^-n: their share is what is left to choose (sigma of Ikhouane & Rodellar).

    mu [-], > 0: friction coefficient in steady sliding, its limit.
    stiffness [1/scene length], presliding_length [scene length] (mu/stiffness) or contact_stiffness [K_1], > 0.
    exponent [-], >= 1, <= 20: n; 1 where left out, a large one nearly an ideal spring that slips (``jenkins``).
    beta_share [-], > 0: beta/(beta + gamma), 0.5 where left out (beta = gamma: unloading is elastic); below 0.5 the
    spring gives back more than it stores. Exponent 1 and share 1 (gamma = 0) are ``dahl`` along a line.

    In the plane |z.v| stands for |z v|: the law turns with the slip, as Park, Wen & Ang's with its |v1 z1| + |v2 z2|
    does not, and large n is a slider dragged as by a rope.
    Sources: Bouc (1967), 4th Conf. on Nonlinear Oscillation, Prague; Wen (1976), J. Eng. Mech. Div. ASCE 102, 249;
    normalised: Ikhouane & Rodellar (2005), Nonlinear Dyn. 42, 63; passivity: Erlicher & Point (2004), C. R. Mecanique
    332, 51; in the plane: Park, Wen & Ang (1986), Earthq. Eng. Struct. Dyn. 14, 543.
    """

    mu: Positive
    exponent: Exponent = 1.0
    beta_share: Positive = 0.5

    @property
    def limit(self) -> float:
        """The deflection in steady sliding [scene length]."""
        return self.mu / self.bristle_stiffness

    def sliding_friction(self, speed: float) -> float:
        """mu, at every speed."""
        return self.mu

    def rate(self, v: Any, z: Any) -> Any:
        """The slip, less what yields."""
        size = abs(z)
        if size == 0.0:
            return v
        along = (z * v.conjugate()).real / size
        share = 1.0 if along > 0.0 else 1.0 - 2.0 * self.beta_share  # of beta |along| + gamma along
        return v - share * along * (size / self.limit) ** (self.exponent - 1.0) / self.limit * z

    def friction(self, v: Any, z: Any, dz: Any) -> Any:
        """The spring's."""
        return self.bristle_stiffness * z

    def constant_sliding_friction(self) -> bool:
        """Always."""
        return True

    def largest_deflection(self) -> float:
        """Where the spring force is mu."""
        return self.limit

    def largest_rate(self, speed: float) -> float:
        """exponent*speed/z_max at the limit, more where unloading is stiffer than 2*stiffness."""
        return self.exponent * speed / self.limit * max(1.0, 2.0 * self.beta_share - 1.0)

    def elastic_unloading(self) -> bool:
        """Where beta = gamma."""
        return self.beta_share == 0.5

    def rate_independent(self) -> bool:
        """Always."""
        return True

    def passive(self) -> bool:
        """Where beta >= |gamma|: what the spring, stiffness z^2/2, does not store is lost."""
        return self.beta_share >= 0.5

    def damps_across(self, speed: float) -> bool:
        """Where it is passive and vectorial or per axis: |z2|^2 then only falls by yielding."""
        return self.passive() and self.planar != "rotated"
