"""Mistakes in the record: what it is told by, what may be done to it, what it keeps."""

from __future__ import annotations

import math
import random
from typing import Any, ClassVar

from broken_laws.case import Case, bug
from broken_laws.twins import Falling
from frictionlab.laws.base import NonNegative, PerSpeed
from frictionlab.laws.coulomb import Coulomb
from frictionlab.laws.dahl import Dahl
from frictionlab.laws.lugre import LuGre
from frictionlab.laws.stribeck_bristle import stribeck_curve


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


class Shares(Falling):
    """Keeps the curve of the first law that was asked, for all of them."""

    curve: ClassVar[dict[float, float]] = {}

    def sliding_friction(self, speed: float) -> float:
        return self.curve.setdefault(speed, super().sliding_friction(speed))


class LeavesBehind(LuGre):
    """Friction of the rate that was asked for last, whoever asked."""

    left: ClassVar[list[float]] = [0.0]

    def rate(self, v: Any, z: Any) -> Any:
        self.left[0] = super().rate(v, z)
        return self.left[0]

    def friction(self, v: Any, z: Any, dz: Any) -> Any:
        return super().friction(v, z, self.left[0])


class CountsInstances(Falling):
    """Friction less for each law that was made: state that all of them share."""

    made: ClassVar[list[int]] = [0]

    def model_post_init(self, _: Any) -> None:
        self.made[0] += 1

    def sliding_friction(self, speed: float) -> float:
        return super().sliding_friction(speed) * (1.0 + 1e-6 * self.made[0])


def falls_short(law: Any, speed: float) -> float:
    """Fast slip has no answer."""
    return Falling.sliding_friction(law, speed) * (1.0 if speed < 1e3 * law.speed else float("nan"))


def of_a_direction(law: Any, v: Any, z: Any) -> Any:
    """v/|v| of nothing at rest."""
    return abs(v) * (v / abs(v) - law.bristle_stiffness / stribeck_curve(law, abs(v)) * z)


def overflowing(law: Any, speed: float) -> float:
    """One over exp(u^2), which overflows."""
    return law.mu + law.drop / math.exp((speed / law.speed) ** 2) + law.viscosity * speed


def scattered(law: Any, v: Any, z: Any, dz: Any) -> Any:
    """By chance."""
    return LuGre.friction(law, v, z, dz) * random.uniform(0.999, 1.001)


CASES = (
    Case(WithoutSource, Falling, "documented"),
    Case(WithoutMeaning, Falling, "documented"),
    Case(Changeable, Falling, "frozen"),
    Case(ListDefault, Coulomb, "frozen"),
    Case(Lenient, Falling, "unknown_parameters_refused"),
    Case(Converts, Falling, "limits_kept"),
    Case(DefaultBeyondLimits, Coulomb, "defaults_valid"),
    bug("WholeNumber", Falling, "answers", sliding_vector=lambda law, v: 1 if v.real > 0.0 else -1),
    bug("NotANumber", Falling, "answers", sliding_friction=falls_short),
    bug(
        "ComplexOnTheLine",
        LuGre,
        "answers",
        friction=lambda law, v, z, dz: LuGre.friction(law, v, z, dz) + 0j,
    ),
    bug("DividesAtRest", LuGre, "extremes", rate=of_a_direction),
    bug("Overflows", Falling, "extremes", sliding_friction=overflowing),
    bug("Random", LuGre, "repeatable", friction=scattered),
    Case(LeavesBehind, LuGre, "repeatable"),
    Case(Shares, Falling, "parameters_matter"),
    Case(CountsInstances, Falling, "instances_apart"),
    bug(
        "IgnoresViscosity",
        Falling,
        "parameters_matter",
        sliding_friction=lambda law, speed: law.mu + law.drop * math.exp(-((speed / law.speed) ** 2)),
    ),
    bug(  # the exponent is never used
        "IgnoresExponent",
        Dahl,
        "parameters_matter",
        rate=lambda law, v, z: v - (abs(v) / law.saturation) * z,
        deflected=lambda law, z, path: z,
        no_vector_form=lambda law: "",
    ),
)
