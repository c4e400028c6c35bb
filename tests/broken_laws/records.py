"""Mistakes in the record: what it is told by, what may be done to it, what it keeps."""

from __future__ import annotations

import math
import random
from typing import Any, ClassVar

from broken_laws.case import Case
from broken_laws.twins import Bristles, Falling, curve
from frictionlab.laws.base import NonNegative, PerSpeed
from frictionlab.laws.coulomb import Coulomb
from frictionlab.laws.dahl import Dahl


class WithoutSource(Falling):
    """Friction that falls, as everybody knows."""


class WithoutMeaning(Falling):
    """Friction that falls (Bo & Pavelescu, 1982)."""

    extra: PerSpeed


class Changeable(Falling, frozen=False):
    """Parameters can be set."""


class ListDefault(Coulomb):
    """A default that can be changed."""

    weights: list[float] = [1.0]  # noqa: RUF012


class Lenient(Falling, extra="ignore"):
    """Takes any parameter."""


class Converts(Falling):
    """Takes words for numbers."""

    mu: float


class DefaultBeyondLimits(Coulomb):
    """A default below its limit."""

    wear: NonNegative = -1.0


class WholeNumber(Falling):
    """Answers with a whole number."""

    def sliding_vector(self, v: complex) -> complex:
        """One way or the other."""
        return 1 if v.real > 0.0 else -1


class NotANumber(Falling):
    """Fast slip has no answer."""

    def sliding_friction(self, speed: float) -> float:
        """0 times infinity."""
        return super().sliding_friction(speed) * (1.0 if speed < 1e3 * self.speed else float("nan"))


class ComplexOnTheLine(Bristles):
    """Forgets that the line has no second direction."""

    def friction(self, v: Any, z: Any, dz: Any) -> Any:
        """Complex everywhere."""
        return super().friction(v, z, dz) + 0j


class DividesAtRest(Bristles):
    """Takes the direction of slip by dividing."""

    def rate(self, v: Any, z: Any) -> Any:
        """v/|v| of nothing."""
        return abs(v) * (v / abs(v) - self.stiffness / curve(self, abs(v)) * z)


class Overflows(Falling):
    """Writes the fall as one over a growing exponential."""

    def sliding_friction(self, speed: float) -> float:
        """exp(u^2) overflows."""
        return self.mu + self.drop / math.exp((speed / self.speed) ** 2) + self.viscosity * speed


class Random(Bristles):
    """Rough by chance."""

    def friction(self, v: Any, z: Any, dz: Any) -> Any:
        """Scattered by a thousandth."""
        return super().friction(v, z, dz) * random.uniform(0.999, 1.001)


class Shares(Falling):
    """Keeps the curve of the first law that was asked, for all of them."""

    curve: ClassVar[dict[float, float]] = {}

    def sliding_friction(self, speed: float) -> float:
        """By speed alone, whatever the parameters."""
        return self.curve.setdefault(speed, super().sliding_friction(speed))


class LeavesBehind(Bristles):
    """Friction of the rate that was asked for last, whoever asked."""

    left: ClassVar[list[float]] = [0.0]

    def rate(self, v: Any, z: Any) -> Any:
        """Kept on the side."""
        self.left[0] = super().rate(v, z)
        return self.left[0]

    def friction(self, v: Any, z: Any, dz: Any) -> Any:
        """Of the rate kept."""
        return super().friction(v, z, self.left[0])


class CountsInstances(Falling):
    """State that every law made shares."""

    made: ClassVar[list[int]] = [0]

    def model_post_init(self, _: Any) -> None:
        """One more."""
        self.made[0] += 1

    def sliding_friction(self, speed: float) -> float:
        """Less for each law that was made."""
        return super().sliding_friction(speed) * (1.0 + 1e-6 * self.made[0])


class IgnoresViscosity(Falling):
    """A parameter that does nothing."""

    def sliding_friction(self, speed: float) -> float:
        """The fall alone."""
        return self.mu + self.drop * math.exp(-((speed / self.speed) ** 2))


class IgnoresExponent(Dahl):
    """A power that is never used."""

    def rate(self, v: Any, z: Any) -> Any:
        """That of exponent 1."""
        return v - (abs(v) / self.saturation) * z

    def deflected(self, z: Any, path: Any) -> Any:
        """Not asked."""
        return z

    def no_vector_form(self) -> str:
        """It has one."""
        return ""


CASES = (
    Case(WithoutSource, Falling, "documented"),
    Case(WithoutMeaning, Falling, "documented"),
    Case(Changeable, Falling, "frozen"),
    Case(ListDefault, Coulomb, "frozen"),
    Case(Lenient, Falling, "unknown_parameters_refused"),
    Case(Converts, Falling, "limits_kept"),
    Case(DefaultBeyondLimits, Coulomb, "defaults_valid"),
    Case(WholeNumber, Falling, "answers"),
    Case(NotANumber, Falling, "answers"),
    Case(ComplexOnTheLine, Bristles, "answers"),
    Case(DividesAtRest, Bristles, "extremes"),
    Case(Overflows, Falling, "extremes"),
    Case(Random, Bristles, "repeatable"),
    Case(LeavesBehind, Bristles, "repeatable"),
    Case(Shares, Falling, "parameters_matter"),
    Case(CountsInstances, Falling, "instances_apart"),
    Case(IgnoresViscosity, Falling, "parameters_matter"),
    Case(IgnoresExponent, Dahl, "parameters_matter"),
)
