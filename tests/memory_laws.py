"""Laws of other memory than one bristle deflection, for tests: several deflections, and one positive scalar."""

from __future__ import annotations

import math
from typing import Any

from maxwell_slip import MaxwellSlip
from rate_and_state import RateAndState

from frictionlab.laws.base import Positive
from frictionlab.laws.memory import MemoryLaw

AGEING = RateAndState(mu=0.4, a=0.01, b=0.015, slip_length=0.05)


def elements(stiffness: tuple[float, ...], reach: tuple[float, ...]) -> MaxwellSlip:
    """The plugin's law told by the reach of each element."""
    return MaxwellSlip(mu=[k * z for k, z in zip(stiffness, reach, strict=True)], stiffness=stiffness)


class Elements(MaxwellSlip):
    """The same friction by other rates, of which nothing is declared: what a step overshot is never taken back."""

    def rate(self, v: Any, memory: Any, k: int) -> Any:
        """v, less its part along the spring where that is stretched to its reach."""
        z = memory[k]
        along = (z * v.conjugate()).real
        if along <= 0.0 or abs(z) < self.reach[k]:
            return v
        return v - (along / (z * z.conjugate()).real) * z

    def yield_deflection(self, k: int) -> float:
        """Not told."""
        return math.inf


class BrokenAway(MemoryLaw):
    """Elasto-plastic friction (Dupont et al., 2002) of constant sliding friction, as a memory of one number.

    Its rate jumps where a stretched deflection begins to be unloaded, which it does not declare.
    mu [-], stiffness [1/scene length], > 0; breakaway_ratio [-], in (0, 1).
    """

    mu: Positive
    stiffness: Positive
    breakaway_ratio: Positive = 0.7

    def sliding_friction(self, speed: float) -> float:
        """At every speed."""
        return self.mu

    def rate(self, v: Any, memory: Any, k: int) -> Any:
        """v, less what does not stretch the bristle."""
        z, ends = memory[k], self.mu / self.stiffness
        if (z * v.conjugate()).real <= 0.0:
            return v
        begins, size = self.breakaway_ratio * ends, abs(z)
        share = 0.5 + 0.5 * math.sin(math.pi * (size - 0.5 * (begins + ends)) / (ends - begins))
        share = 0.0 if size <= begins else 1.0 if size >= ends else share
        return v - (share * abs(v) / ends) * z

    def friction(self, v: Any, memory: Any, rates: Any) -> Any:
        """The spring's."""
        return self.stiffness * memory[0]

    def steady(self, v: Any, k: int) -> Any:
        """The whole of sliding friction."""
        return (self.mu / self.stiffness) * (v / abs(v))

    def largest_rate(self, speed: float) -> float:
        """As the bristle law's."""
        ends = 1.0 - self.breakaway_ratio
        return (1.2 + 0.25 * math.pi * (1.0 + self.breakaway_ratio) / ends) * self.stiffness * speed / self.mu
