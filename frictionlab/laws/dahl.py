"""Dahl friction: a spring whose stiffness falls as friction approaches its limit."""

from __future__ import annotations

import math
from typing import Any, ClassVar

from frictionlab.laws.base import NonNegative, Positive
from frictionlab.laws.compliant import CompliantLaw
from frictionlab.laws.decay import exp_decay


class Dahl(CompliantLaw):
    """Dahl friction approaches its limit at a rate set by the remaining distance, dT/dx = stiffness*sgn(u)|u|^i.

    mu [-], > 0: friction coefficient in steady sliding, its limit; u = 1 - (T/mu) sgn(v).
    stiffness [1/scene length], presliding_length [scene length] or contact_stiffness [K_1], > 0: exactly one.
    exponent [-], >= 0: i; 1 where left out, 0 an ideal spring in series with a slider (``jenkins``). Only 1 has a
    vector form. The sign function makes friction beyond its limit return to it for every exponent.
    Sources: Dahl (1968); Dahl (1976); in the plane z' = v - |v| z stiffness/mu, as Velenis, Tsiotras & Canudas de Wit
    (2002) write LuGre friction.

    >>> import frictionlab as fl
    >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1))
    >>> law = fl.Dahl(mu=0.4, stiffness=40)
    >>> round(fl.steady_state(scene, law).mean_friction, 4), law.presliding()
    (0.0507, 0.01)
    """

    in_words: ClassVar[str] = "Dahl"
    mu: Positive
    exponent: NonNegative = 1.0

    @property
    def saturation(self) -> float:
        """The deflection in steady sliding [scene length]."""
        return self.mu / self.bristle_stiffness

    def sliding_friction(self, speed: float) -> float:
        """mu, at every speed."""
        return self.mu

    def rate(self, v: Any, z: Any) -> Any:
        """z' = v - |v| z/saturation for exponent 1; else v sgn(u) |u|^exponent, along one direction."""
        if self.exponent == 1.0:
            return v - (abs(v) / self.saturation) * z
        left = 1.0 - math.copysign(1.0, v.real) * z.real / self.saturation
        return v * math.copysign(math.fabs(left) ** self.exponent, left)

    def friction(self, v: Any, z: Any, dz: Any) -> Any:
        """stiffness z."""
        return self.bristle_stiffness * z

    def constant_sliding_friction(self) -> bool:
        """Always."""
        return True

    def no_vector_form(self) -> str:
        """For every exponent but 1."""
        return (
            ""
            if self.exponent == 1.0
            else "Dahl friction has a vector form for exponent 1 alone; use planar rotated or per-axis"
        )

    def largest_deflection(self) -> float:
        """Where the spring force is mu."""
        return self.saturation

    def elastic_deflection(self) -> float:
        """That of steady sliding for exponent 0, else 0."""
        return self.saturation if self.exponent == 0.0 else 0.0

    def largest_rate(self, speed: float) -> float:
        """exponent*(speed/saturation)*u^(exponent - 1), largest at reversal (u = 2), or without bound below one."""
        if self.exponent < 1.0:
            return math.inf
        return self.exponent * speed / self.saturation * 2.0 ** (self.exponent - 1.0)

    def rate_independent(self) -> bool:
        """Always."""
        return True

    def passive(self) -> bool:
        """Always: work that the spring does not store is dissipated."""
        return True

    def exact_path(self) -> bool:
        """Always, in the plane for exponent 1."""
        return True

    def deflected(self, z: Any, path: Any) -> Any:
        """u falls as exp(-path/saturation), for other exponents as a power of the path (physics of one direction)."""
        length = abs(path)
        if length == 0.0:
            return z
        end = (self.saturation / length) * path
        if self.exponent == 1.0:
            return end + (z - end) * exp_decay(length / self.saturation)
        left, steeper = 1.0 - z.real / end.real, self.exponent - 1.0
        if left == 0.0:
            return end
        gone = steeper * (length / self.saturation) * math.fabs(left) ** steeper
        if gone <= -1.0:  # for an exponent below one: the limit was reached on the way
            return end
        return end - end * (left * math.exp(-math.log1p(gone) / steeper))  # log1p: for exponents near 1

    def saturation_path(self, z: float, side: float) -> float:
        """Finite for exponents below one."""
        if self.exponent >= 1.0:
            return math.inf
        left = math.fabs(1.0 - side * z / self.saturation)
        return left ** (1.0 - self.exponent) * self.saturation / (1.0 - self.exponent)
