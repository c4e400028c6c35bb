"""Bliman-Sorine friction: a spring that yields, and a slower one that pulls the other way."""

from __future__ import annotations

import math
from typing import Annotated, Any, ClassVar

from pydantic import Field

from frictionlab import Length, MemoryLaw, NonNegative, Positive


class BlimanSorine(MemoryLaw):
    """Bliman-Sorine friction of second order: a spring that yields, less a slower one.

    z1' = v - |v| z1/(ratio L), z2' = v - |v| z2/L, friction = f1 z1/(ratio L) - f2 z2/L, with L = presliding_length,
    f2 = mu_slow and f1 = mu_kinetic + mu_slow. Over the path s of slip, dx/ds = A x + B sgn(v), friction = C x.
    A first slip from rest has the friction f1 (1 - exp(-s/(ratio L))) - f2 (1 - exp(-s/L)): largest, ``peak``, after
    ``peak_path``, and mu_kinetic in the end. The source gives it along a line; in the plane v is a vector here.

    Parameters
    ----------
    mu_kinetic : float, > 0
        Friction coefficient in steady sliding, f1 - f2 [-].
    mu_slow : float, >= 0
        Coefficient f2 of the slower spring, which pulls with the slip [-]. 0 makes it ``dahl`` with presliding_length
        ratio L.
    presliding_length : float, > 0
        Path L of slip after which 1/e of the deflection of the slower spring is left to come [scene length].
    ratio : float, > 0, < 1
        Path of the quicker spring over that of the slower one [-].

    References
    ----------
    Source: Bliman & Sorine (1995)
    """

    bibtex: ClassVar[str] = """
    @inproceedings{bliman1995, author = {Bliman, P.-A. and Sorine, M.}, title = {Easy-to-use realistic dry friction
      models for automatic control}, booktitle = {Proceedings of the 3rd European Control Conference}, address =
      {Rome}, pages = {3788--3794}, year = {1995}}
    """
    in_words: ClassVar[str] = "Bliman-Sorine"

    mu_kinetic: Positive
    mu_slow: NonNegative
    presliding_length: Length
    ratio: Annotated[Positive, Field(lt=1)]

    @property
    def mu_quick(self) -> float:
        """Coefficient of the quicker spring, f1 [-]."""
        return self.mu_kinetic + self.mu_slow

    @property
    def lengths(self) -> tuple[float, ...]:
        """Deflections of the springs in steady sliding [scene length], the quicker one first."""
        return (self.ratio * self.presliding_length, self.presliding_length)

    @property
    def stiffnesses(self) -> tuple[float, ...]:
        """Coefficients per deflection [1/scene length]; the second spring pulls with the slip."""
        return (self.mu_quick / self.lengths[0], -self.mu_slow / self.lengths[1])

    @property
    def storage(self) -> tuple[float, ...]:
        """Coefficients P11, P12, P22 [1/scene length] of the stored work (P11 z1^2 + P22 z2^2)/2 + P12 z1 z2.

        It is the least that makes the law passive: P B = C' (Kalman, Yakubovich & Popov) leaves one number free, and
        -(A' P + P A) is singular at its least value. It exists wherever f1 >= f2.
        """
        f1, f2, ratio, length = self.mu_quick, self.mu_slow, self.ratio, self.presliding_length
        root = math.sqrt(self.mu_kinetic * (f1 - ratio**2 * f2))
        whole = f1 - ratio * f2 + root
        free = 2.0 * ratio / whole
        quick = (1.0 + free * f2) * ratio / f1
        slow = f1 * (1.0 + ratio) ** 2 / (whole * (f1 + ratio * f2 + root))
        k1, k2 = self.stiffnesses
        return (length * quick * k1**2, length * free * k1 * k2, length * slow * k2**2)

    @property
    def peak_path(self) -> float:
        """Slip from rest at which friction is largest [scene length]; infinite without the slower spring."""
        if self.mu_slow == 0.0:
            return math.inf
        return self.lengths[0] / (1.0 - self.ratio) * math.log(self.mu_quick / (self.ratio * self.mu_slow))

    @property
    def peak(self) -> float:
        """Largest friction coefficient on the first slip from rest [-], that of stiction."""
        falls = self.ratio / (1.0 - self.ratio)
        return (
            self.mu_kinetic
            + self.mu_slow * (1.0 - self.ratio) * (self.ratio * self.mu_slow / self.mu_quick) ** falls
        )

    def count(self) -> int:
        """Return 2."""
        return 2

    def sliding_friction(self, speed: float) -> float:
        """Return mu_kinetic, at every speed."""
        return self.mu_kinetic

    def rate(self, v: Any, memory: Any, k: int) -> Any:
        """Compute v - |v| z/length of the k-th spring."""
        return v - (abs(v) / self.lengths[k]) * memory[k]

    def friction(self, v: Any, memory: Any, rates: Any) -> Any:
        """Compute the force of the quicker spring, less that of the slower one."""
        return self.stiffnesses[0] * memory[0] + self.stiffnesses[1] * memory[1]

    def steady(self, v: Any, k: int) -> Any:
        """Return the length of the k-th spring, along the slip."""
        return self.lengths[k] * (v / abs(v))

    def within(self, memory: Any) -> bool:
        """Check that no deflection is longer than in steady sliding."""
        longest = 1.0 + 1e-9
        return abs(memory[0]) <= self.lengths[0] * longest and abs(memory[1]) <= self.lengths[1] * longest

    def stored(self, memory: Any) -> float:
        """Compute (P11 |z1|^2 + P22 |z2|^2)/2 + P12 z1.z2."""
        quick, slow = memory[0], memory[1]
        own = (
            self.storage[0] * (quick * quick.conjugate()).real
            + self.storage[2] * (slow * slow.conjugate()).real
        )
        return 0.5 * own + self.storage[1] * (quick * slow.conjugate()).real

    def passive(self) -> bool:
        """Return True: f1/(1 + ratio^2 w^2) >= f2/(1 + w^2) at every frequency w over the path, as f1 > f2."""
        return True

    def constant_sliding_friction(self) -> bool:
        """Return True."""
        return True

    def rate_independent(self) -> bool:
        """Return True: friction depends on the path of the slip alone."""
        return True

    def largest_rate(self, speed: float) -> float:
        """Return that of the quicker spring."""
        return speed / self.lengths[0]
