"""Mistakes that show where laws are compiled, or in steady states."""

from __future__ import annotations

from typing import Any

from broken_laws.case import Case
from broken_laws.paths import TwiceAsFar
from broken_laws.twins import Falling
from frictionlab.laws.base import Positive
from frictionlab.laws.dahl import Dahl
from frictionlab.laws.jenkins import Jenkins
from frictionlab.laws.lugre import LuGre


class WrapsRound(Falling):
    """Counts in whole numbers, which have no end in Python and wrap round at 2^63 when compiled."""

    def sliding_friction(self, speed: float) -> float:
        """Of speed in millionths, cubed."""
        cubed = int(1e6 * min(speed, 1e6)) ** 3
        return self.mu + 1e-30 * cubed


class BeyondNumba(LuGre):
    """Written as no compiler for numbers understands."""

    def friction(self, v: Any, z: Any, dz: Any) -> Any:
        """By the names of its parameters."""
        return sum(getattr(self, name) * part for name, part in (("stiffness", z), ("damping", dz)))


class MemoryOfItsOwnLength(Dahl):
    """Springs that harden over a length that is told as a mere number: no stiffness makes it short."""

    hardening: Positive

    def friction(self, v: Any, z: Any, dz: Any) -> Any:
        """Weaker while less deflected than the length."""
        return self.bristle_stiffness * z * abs(z) / (abs(z) + self.hardening)


class StopsShort(Jenkins):
    """A slider that is told to hold more than it does."""

    def friction(self, v: Any, z: Any, dz: Any) -> Any:
        """Nine tenths of the spring's."""
        return 0.9 * self.bristle_stiffness * z


CASES = (
    Case(WrapsRound, Falling, "compiled_on_the_line"),
    Case(BeyondNumba, LuGre, "compiled_on_the_line"),
    Case(BeyondNumba, LuGre, "compiled_in_the_plane"),
    Case(StopsShort, Jenkins, "coulomb_limit_of_prescribed_slip"),
    Case(MemoryOfItsOwnLength, Dahl, "coulomb_limit_of_a_body"),
    Case(TwiceAsFar, Dahl, "two_methods"),
)
