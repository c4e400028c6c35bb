"""Mistakes of sign, of direction and of units."""

from __future__ import annotations

from typing import Any

from broken_laws.case import Case
from broken_laws.twins import BreakingAway, Bristles, Falling, curve
from frictionlab.laws.base import NonNegative, Positive
from frictionlab.laws.compliant import Stiffness


class MissingAbs(Bristles):
    """Slip where speed should stand."""

    def rate(self, v: Any, z: Any) -> Any:
        """v z in place of |v| z."""
        return v - (self.stiffness * v.real / curve(self, abs(v))) * z


class SignSlip(Bristles):
    """A minus too many in one direction."""

    def friction(self, v: Any, z: Any, dz: Any) -> Any:
        """Viscosity of speed in place of slip."""
        return self.stiffness * z + self.damping * dz + self.viscosity * abs(v)


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


class ViscosityWithoutUnits(Falling):
    """Viscosity is annotated as a mere number."""

    viscosity: NonNegative


class DampingInUnitsOfStiffness(Bristles):
    """Damping is annotated as a stiffness."""

    damping: Stiffness


class HiddenLength(Bristles):
    """A length written into the law."""

    def friction(self, v: Any, z: Any, dz: Any) -> Any:
        """Springs that harden over a thousandth of a scene length."""
        return super().friction(v, z, dz) * (1.0 + abs(z) / (1e-3 + abs(z)))


CASES = (
    Case(MissingAbs, Bristles, "oddness"),
    Case(SignSlip, Bristles, "oddness"),
    Case(SignedBreakaway, BreakingAway, "oddness"),
    Case(PerAxis, Bristles, "rotation"),
    Case(SquareOfFriction, Falling, "rotation"),
    Case(Handed, Falling, "reflection"),
    Case(WeakerInThePlane, Falling, "straight_planar_slide"),
    Case(SpeedWithoutUnits, Falling, "unit_scaling"),
    Case(ViscosityWithoutUnits, Falling, "unit_scaling"),
    Case(DampingInUnitsOfStiffness, Bristles, "unit_scaling"),
    Case(HiddenLength, Bristles, "unit_scaling"),
)
