"""What a law says of itself and is not true."""

from __future__ import annotations

import math
from typing import Any

from broken_laws.case import Case, bug
from broken_laws.twins import BreakingAway, Bristles, Falling, curve
from frictionlab.laws.coulomb import Coulomb
from frictionlab.laws.dahl import Dahl


class UnsignedPower(Dahl):
    """An even power without its sign: beyond its limit friction grows on."""

    exponent: float = 2.0

    def rate(self, v: Any, z: Any) -> Any:
        return v * abs(1.0 - math.copysign(1.0, v.real) * z.real / self.saturation) ** self.exponent

    def no_vector_form(self) -> str:
        return "a power"


def smoothed_rate(law: Any, v: Any, z: Any) -> Any:
    """|v| as the root of v^2 + width^2: the width of a method in the law."""
    speed = math.sqrt((v * v.conjugate()).real + 1e-12)
    return v - (law.stiffness * speed / curve(law, speed)) * z


CASES = (
    bug(  # viscosity forgotten
        "SaysConstant",
        Falling,
        "constant_sliding_friction",
        constant_sliding_friction=lambda law: law.drop == 0.0,
    ),
    bug(  # that of exp(-u)
        "ExponentOffByOne",
        Falling,
        "steepest_fall",
        steepest_fall=lambda law: max(0.0, 0.5 * law.drop / law.speed - law.viscosity),
    ),
    bug("SaysMonotone", Falling, "monotone", monotone=lambda law: True),
    bug("MonotoneWithAJump", Coulomb, "monotone", examples=100, monotone=lambda law: True),
    bug("HoldsTooLittle", Falling, "static_friction", static_friction=lambda law: law.mu),
    bug(  # the width of a method in the law
        "SmoothedSliding",
        Falling,
        "not_smoothed",
        sliding_friction=lambda law, speed: Falling.sliding_friction(law, speed) * math.tanh(speed / 1e-6),
    ),
    bug("SaysVanishing", Falling, "not_smoothed", vanishes_at_rest=lambda law: True),
    bug("SmoothedBristles", Bristles, "held_at_rest", rate=smoothed_rate),
    bug(  # bristles slip however far bends further: only half of what goes is taken back
        "BoundLost", Dahl, "invariant_set", rate=lambda law, v, z: v - 0.5 * (abs(v) / law.saturation) * z
    ),
    Case(UnsignedPower, Dahl, "invariant_set"),
    bug(
        "FeedingDamping",
        Bristles,
        "passivity",
        friction=lambda law, v, z, dz: law.stiffness * z - law.damping * dz + law.viscosity * v,
    ),
    bug(  # the bound with its ratio upside down
        "BoundUpsideDown",
        Bristles,
        "passivity",
        examples=100,
        passive=lambda law: law.viscosity >= law.damping * law.drop / (law.mu + law.drop),
    ),
    bug("SaysNotPassive", Bristles, "not_passive", passive=lambda law: False),
    bug("SaysDampsAcross", Bristles, "damps_across", damps_across=lambda law, speed: law.planar != "rotated"),
    bug(  # forgets that damping knows speed
        "SaysRateIndependent",
        Bristles,
        "rate_independence",
        rate_independent=lambda law: law.constant_sliding_friction(),
    ),
    bug(  # of the peak in place of the curve
        "RateTooSmall",
        Bristles,
        "largest_rate",
        largest_rate=lambda law, speed: law.stiffness * speed / (law.mu + law.drop),
    ),
    bug(  # forgets how steeply bristles break away
        "RateOfBreakaway",
        BreakingAway,
        "largest_rate",
        largest_rate=lambda law, speed: law.stiffness * speed / curve(law, speed),
    ),
)
