"""Mistakes of sign, of direction and of units."""

from __future__ import annotations

from typing import Any

from broken_laws.case import Case, bug
from broken_laws.twins import Falling
from frictionlab.laws.base import Positive
from frictionlab.laws.compliant import Stiffness
from frictionlab.laws.elasto_plastic import ElastoPlastic
from frictionlab.laws.lugre import LuGre
from frictionlab.laws.stribeck_bristle import stribeck_curve


class SpeedWithoutUnits(Falling):
    """The speed of the fall is annotated as a mere number."""

    speed: Positive


class DampingInUnitsOfStiffness(LuGre):
    """Damping is annotated as a stiffness."""

    damping: Stiffness


def by_axis(law: Any, v: Any, z: Any) -> Any:
    """In the plane two laws of one direction, called vectorial."""
    if isinstance(v, complex):
        return complex(LuGre.rate(law, v.real, z.real), LuGre.rate(law, v.imag, z.imag))
    return LuGre.rate(law, v, z)


def within_a_square(law: Any, v: complex) -> complex:
    """A square in place of a circle limits friction in the plane."""
    return law.sliding_friction(abs(v)) * v / max(abs(v.real), abs(v.imag))


def turned_aside(law: Any, v: complex) -> complex:
    """By a hundredth, to the left."""
    return Falling.sliding_vector(law, v) * (1.0 + 0.01j if isinstance(v, complex) else 1.0)


def weaker_in_the_plane(law: Any, v: complex) -> complex:
    """That of both axes, by mistake."""
    return Falling.sliding_vector(law, v) * (0.7071 if isinstance(v, complex) else 1.0)


CASES = (
    bug(  # slip where speed should stand
        "MissingAbs",
        LuGre,
        "oddness",
        rate=lambda law, v, z: v - (law.bristle_stiffness * v.real / stribeck_curve(law, abs(v))) * z,
    ),
    bug(  # Dupont's alpha of z in place of |z|: bristles bent backwards never break away
        "SignedBreakaway",
        ElastoPlastic,
        "oddness",
        rate=lambda law, v, z: v if z.real < 0.0 else ElastoPlastic.rate(law, v, z),
    ),
    bug("PerAxis", LuGre, "rotation", rate=by_axis),
    bug("SquareOfFriction", Falling, "rotation", sliding_vector=within_a_square),
    bug("Handed", Falling, "reflection", sliding_vector=turned_aside),
    bug("WeakerInThePlane", Falling, "straight_planar_slide", sliding_vector=weaker_in_the_plane),
    Case(SpeedWithoutUnits, Falling, "unit_scaling"),
    Case(DampingInUnitsOfStiffness, LuGre, "unit_scaling"),
)
