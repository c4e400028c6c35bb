"""What a law says of itself and is not true."""

from __future__ import annotations

import math
from typing import Any

from broken_laws.case import Case, bug
from broken_laws.twins import Falling
from frictionlab.laws.coulomb import Coulomb
from frictionlab.laws.dahl import Dahl
from frictionlab.laws.elasto_plastic import ElastoPlastic
from frictionlab.laws.lugre import LuGre
from frictionlab.laws.stribeck_bristle import stribeck_curve


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
    return v - (law.bristle_stiffness * speed / stribeck_curve(law, speed)) * z


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
    bug("SmoothedLuGre", LuGre, "held_at_rest", rate=smoothed_rate),
    bug(  # bristles slip however far bends further: only half of what goes is taken back
        "BoundLost", Dahl, "invariant_set", rate=lambda law, v, z: v - 0.5 * (abs(v) / law.saturation) * z
    ),
    Case(UnsignedPower, Dahl, "invariant_set"),
    bug(
        "FeedingDamping",
        LuGre,
        "passivity",
        friction=lambda law, v, z, dz: (
            law.bristle_stiffness * z - law.bristle_damping * dz + law.viscosity * v
        ),
    ),
    bug(  # the bound with its ratio upside down
        "BoundUpsideDown",
        LuGre,
        "passivity",
        examples=100,
        passive=lambda law: law.viscosity >= law.bristle_damping * (1.0 - law.mu_kinetic / law.peak),
    ),
    bug("SaysNotPassive", LuGre, "not_passive", passive=lambda law: False),
    bug("SaysDampsAcross", LuGre, "damps_across", damps_across=lambda law, speed: True),
    bug(  # forgets that damping knows speed
        "SaysRateIndependent",
        LuGre,
        "rate_independence",
        rate_independent=lambda law: law.constant_sliding_friction(),
    ),
    bug(  # of the peak in place of the curve
        "RateTooSmall",
        LuGre,
        "largest_rate",
        largest_rate=lambda law, speed: law.bristle_stiffness * speed / law.peak,
    ),
    bug(  # forgets how steeply bristles break away
        "RateOfBreakaway",
        ElastoPlastic,
        "largest_rate",
        largest_rate=lambda law, speed: law.bristle_stiffness * speed / stribeck_curve(law, speed),
    ),
)
