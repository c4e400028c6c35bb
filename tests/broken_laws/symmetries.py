"""Mistakes of sign, of direction and of units."""

from __future__ import annotations

from typing import Any

from broken_laws.case import Case
from broken_laws.twins import BreakingAway, Bristles, Falling, curve
from frictionlab.laws.base import Positive
from frictionlab.laws.compliant import Stiffness


class MissingAbs(Bristles):
    """Slip where speed should stand."""

    def rate(self, v: Any, z: Any) -> Any:
        """v z in place of |v| z."""
        return v - (self.stiffness * v.real / curve(self, abs(v))) * z


class SignedBreakaway(BreakingAway):
    """Dupont's alpha of z in place of |z|: bristles bent backwards never break away."""

    def rate(self, v: Any, z: Any) -> Any:
        """Elastic while z < 0."""
        return v if z.real < 0.0 else super().rate(v, z)


class PerAxis(Bristles):
    """Each axis for itself, called vectorial."""

    def rate(self, v: Any, z: Any) -> Any:
        """In the plane two laws of one direction."""
        if isinstance(v, complex):
            return complex(super().rate(v.real, z.real), super().rate(v.imag, z.imag))
        return super().rate(v, z)


class SquareOfFriction(Falling):
    """In the plane friction is limited on each axis."""

    def sliding_vector(self, v: complex) -> complex:
        """A square in place of a circle."""
        size = self.sliding_friction(abs(v))
        return size * v / max(abs(v.real), abs(v.imag))


class Handed(Falling):
    """Friction turned aside, to the left."""

    def sliding_vector(self, v: complex) -> complex:
        """By a hundredth."""
        along = super().sliding_vector(v)
        return along * (1.0 + 0.01j) if isinstance(v, complex) else along


class WeakerInThePlane(Falling):
    """Another coefficient in the plane."""

    def sliding_vector(self, v: complex) -> complex:
        """That of both axes, by mistake."""
        return super().sliding_vector(v) * (0.7071 if isinstance(v, complex) else 1.0)


class SpeedWithoutUnits(Falling):
    """The speed of the fall is annotated as a mere number."""

    speed: Positive


class DampingInUnitsOfStiffness(Bristles):
    """Damping is annotated as a stiffness."""

    damping: Stiffness


CASES = (
    Case(MissingAbs, Bristles, "oddness"),
    Case(SignedBreakaway, BreakingAway, "oddness"),
    Case(PerAxis, Bristles, "rotation"),
    Case(SquareOfFriction, Falling, "rotation"),
    Case(Handed, Falling, "reflection"),
    Case(WeakerInThePlane, Falling, "straight_planar_slide"),
    Case(SpeedWithoutUnits, Falling, "unit_scaling"),
    Case(DampingInUnitsOfStiffness, Bristles, "unit_scaling"),
)
