"""Dahl friction: a spring whose stiffness falls as friction approaches its limit."""

from __future__ import annotations

import math
from typing import Any, ClassVar

from frictionlab.laws.base import NonNegative, Positive
from frictionlab.laws.compliant import CompliantLaw
from frictionlab.laws.decay import exp_decay


class Dahl(CompliantLaw):
    """Dahl friction: a spring whose stiffness falls as friction approaches its limit.

    Friction T changes with slip x by dT/dx = stiffness*sgn(u)|u|^i with u = 1 - (T/mu) sgn(v) and the
    exponent i: its rate is set by the distance that remains to its limit mu. The sign function makes friction
    beyond its limit return to it for every exponent. The exponent 0 makes it an ideal spring in series with a
    slider (``jenkins``). In the plane z' = v - |v| z stiffness/mu.

    Parameters
    ----------
    mu : float, > 0
        Limit of the friction coefficient, that in steady sliding [-].
    exponent : float, >= 0, default 1
        Exponent i [-]. Only 1 has a vector form.
    stiffness : float, > 0, optional
        Stiffness: friction coefficient per deflection [1/scene length]. Exactly one is given: ``stiffness``,
        ``presliding_length`` or ``contact_stiffness``.
    presliding_length : float, > 0, optional
        Presliding length, mu/stiffness [scene length].
    contact_stiffness : float, > 0, optional
        Contact stiffness, ``stiffness`` times normal load [K_1].
    planar : {"vectorial", "per-axis"}, default "vectorial"
        Extension to the plane of the law of one direction, as in ``BristleLaw``.

    References
    ----------
    Sources: Dahl (1968); Dahl (1976); in the plane as Velenis, Tsiotras & Canudas de Wit (2002) write LuGre
    friction.

    Examples
    --------
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
        """Deflection in steady sliding [scene length]."""
        return self.mu / self.bristle_stiffness

    def sliding_friction(self, speed: float) -> float:
        """Return mu, at every speed."""
        return self.mu

    def rate(self, v: Any, z: Any) -> Any:
        """Compute z' = v - |v| z/saturation for exponent 1; else z' = v sgn(u) |u|^exponent on the line."""
        if self.exponent == 1.0:
            return v - (abs(v) / self.saturation) * z
        left = 1.0 - math.copysign(1.0, v.real) * z.real / self.saturation
        return v * math.copysign(math.fabs(left) ** self.exponent, left)

    def friction(self, v: Any, z: Any, dz: Any) -> Any:
        """Return stiffness z."""
        return self.bristle_stiffness * z

    def constant_sliding_friction(self) -> bool:
        """Return True: the coefficient is mu at every speed."""
        return True

    def no_vector_form(self) -> str:
        """Return why an exponent other than 1 has no vector form; '' for exponent 1."""
        return (
            ""
            if self.exponent == 1.0
            else "Dahl friction has a vector form for exponent 1 alone; use planar per-axis"
        )

    def largest_deflection(self) -> float:
        """Return the deflection at which the spring force is mu."""
        return self.saturation

    def elastic_deflection(self) -> float:
        """Return the deflection in steady sliding for exponent 0, else 0."""
        return self.saturation if self.exponent == 0.0 else 0.0

    def largest_rate(self, speed: float) -> float:
        """Return exponent*(speed/saturation)*u^(exponent - 1), largest at reversal (u = 2).

        It has no bound for an exponent below 1.
        """
        if self.exponent < 1.0:
            return math.inf
        return self.exponent * speed / self.saturation * 2.0 ** (self.exponent - 1.0)

    def rate_independent(self) -> bool:
        """Return True: friction depends on the path of the slip alone."""
        return True

    def passive(self) -> bool:
        """Return True: work that the spring does not store is dissipated."""
        return True

    def exact_path(self) -> bool:
        """Return True: ``deflected`` is exact, in the plane for exponent 1."""
        return True

    def deflected(self, z: Any, path: Any) -> Any:
        """Compute the deflection after a straight path: u falls as exp(-path/saturation).

        For exponents other than 1, u falls as a power of the path (physics of one direction).
        """
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
        """Compute the length of slip to the limit; finite for exponents below 1."""
        if self.exponent >= 1.0:
            return math.inf
        left = math.fabs(1.0 - side * z / self.saturation)
        return left ** (1.0 - self.exponent) * self.saturation / (1.0 - self.exponent)
