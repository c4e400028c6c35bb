"""What a law says of itself and is not true."""

from __future__ import annotations

import math
from typing import Any

from broken_laws.case import Case
from broken_laws.twins import BreakingAway, Bristles, Falling, curve
from frictionlab.laws.coulomb import Coulomb
from frictionlab.laws.dahl import Dahl


class SaysConstant(Falling):
    """Calls a falling curve constant."""

    def constant_sliding_friction(self) -> bool:
        """Viscosity forgotten."""
        return self.drop == 0.0


class ExponentOffByOne(Falling):
    """The slope of the fall, of an exponent one less."""

    def steepest_fall(self) -> float:
        """That of exp(-u)."""
        return max(0.0, 0.5 * self.drop / self.speed - self.viscosity)


class SaysMonotone(Falling):
    """Calls a falling curve monotone."""

    def monotone(self) -> bool:
        """Always."""
        return True


class MonotoneWithAJump(Coulomb):
    """Forgets that rest holds more."""

    def monotone(self) -> bool:
        """Always."""
        return True


class HoldsTooLittle(Falling):
    """At rest the friction of quick slip."""

    def static_friction(self) -> float:
        """mu."""
        return self.mu


class SmoothedSliding(Falling):
    """The width of a method in the law."""

    def sliding_friction(self, speed: float) -> float:
        """tanh over a millionth."""
        return super().sliding_friction(speed) * math.tanh(speed / 1e-6)


class SaysVanishing(Falling):
    """Dry friction that calls itself a film of fluid."""

    def vanishes_at_rest(self) -> bool:
        """Always."""
        return True


class SmoothedBristles(Bristles):
    """The width of a method in the law."""

    def rate(self, v: Any, z: Any) -> Any:
        """|v| as the root of v^2 + width^2."""
        speed = math.sqrt((v * v.conjugate()).real + 1e-12)
        return v - (self.stiffness * speed / curve(self, speed)) * z


class BoundLost(Dahl):
    """Bristles that slip however far bends further."""

    def rate(self, v: Any, z: Any) -> Any:
        """Only half of what goes is taken back."""
        return v - 0.5 * (abs(v) / self.saturation) * z


class UnsignedPower(Dahl):
    """An even power without its sign: beyond its limit friction grows on."""

    exponent: float = 2.0

    def rate(self, v: Any, z: Any) -> Any:
        """|u|^exponent."""
        return v * abs(1.0 - math.copysign(1.0, v.real) * z.real / self.saturation) ** self.exponent

    def no_vector_form(self) -> str:
        """None."""
        return "a power"


class FeedingDamping(Bristles):
    """Damping of the wrong sign."""

    def friction(self, v: Any, z: Any, dz: Any) -> Any:
        """Minus damping."""
        return self.stiffness * z - self.damping * dz + self.viscosity * v


class BoundUpsideDown(Bristles):
    """The bound of passivity with its ratio upside down."""

    def passive(self) -> bool:
        """Less than is needed."""
        return self.viscosity >= self.damping * self.drop / (self.mu + self.drop)


class SaysNotPassive(Bristles):
    """Denies what it has."""

    def passive(self) -> bool:
        """Never."""
        return False


class SaysDampsAcross(Bristles):
    """Damping at any speed across."""

    def damps_across(self, speed: float) -> bool:
        """Always."""
        return self.planar != "rotated"


class SaysRateIndependent(Bristles):
    """Forgets that damping knows speed."""

    def rate_independent(self) -> bool:
        """Where friction is constant."""
        return self.constant_sliding_friction()


class RateTooSmall(Bristles):
    """The rate of slow slip, at every speed."""

    def largest_rate(self, speed: float) -> float:
        """Of the peak in place of the curve."""
        return self.stiffness * speed / (self.mu + self.drop)


class RateOfBreakaway(BreakingAway):
    """Forgets how steeply bristles break away."""

    def largest_rate(self, speed: float) -> float:
        """That of LuGre bristles."""
        return self.stiffness * speed / curve(self, speed)


CASES = (
    Case(SaysConstant, Falling, "constant_sliding_friction"),
    Case(ExponentOffByOne, Falling, "steepest_fall"),
    Case(SaysMonotone, Falling, "monotone"),
    Case(MonotoneWithAJump, Coulomb, "monotone", examples=100),
    Case(HoldsTooLittle, Falling, "static_friction"),
    Case(SmoothedSliding, Falling, "not_smoothed"),
    Case(SaysVanishing, Falling, "not_smoothed"),
    Case(SmoothedBristles, Bristles, "held_at_rest"),
    Case(BoundLost, Dahl, "invariant_set"),
    Case(UnsignedPower, Dahl, "invariant_set"),
    Case(FeedingDamping, Bristles, "passivity"),
    Case(BoundUpsideDown, Bristles, "passivity", examples=100),
    Case(SaysNotPassive, Bristles, "not_passive"),
    Case(SaysDampsAcross, Bristles, "damps_across"),
    Case(SaysRateIndependent, Bristles, "rate_independence"),
    Case(RateTooSmall, Bristles, "largest_rate"),
    Case(RateOfBreakaway, BreakingAway, "largest_rate"),
)
