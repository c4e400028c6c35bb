"""Elasto-plastic friction (Dupont): bristles that are purely elastic below their breakaway deflection."""

from __future__ import annotations

import math
from typing import Annotated, Any, ClassVar

from pydantic import Field

from frictionlab.laws.base import Positive
from frictionlab.laws.stribeck_bristle import StribeckBristle, stribeck_curve

Share = Annotated[Positive, Field(lt=1)]


class ElastoPlastic(StribeckBristle):
    """Elasto-plastic friction: LuGre bristles that are purely elastic below breakaway and on unloading.

    z' = v - alpha |v| z stiffness/g(|v|), friction = stiffness z + damping z' + viscosity v; alpha = 0 where
    z.v <= 0 or |z| <= z_ba, 1 where |z| >= z_max = g/stiffness, in between (1 + sin(pi (|z| - (z_max + z_ba)/2)
    /(z_max - z_ba)))/2, with z_ba = breakaway_ratio*mu_kinetic/stiffness. Below z_ba nothing drifts.

    breakaway_ratio [-], > 0, < 1 (0.7): z_ba in shares of mu_kinetic/stiffness.

    The other parameters are those of LuGre friction:
    mu_kinetic [-], > 0; mu_static [-], >= mu_kinetic, the same where left out; stribeck_speed [scene velocity], > 0
    (1); stribeck_exponent [-], > 0 (2); stiffness [1/scene length], presliding_length [scene length]
    (mu_kinetic/stiffness) or contact_stiffness [K_1]; damping [1/scene velocity] or contact_damping [M omega_1],
    >= 0 (0); viscosity [1/scene velocity], >= 0 (0).

    Sources: Dupont, Armstrong & Hayward (2000); Dupont, Hayward, Armstrong & Altpeter (2002). In the plane alpha
    is that of |z|, switched off wherever z.v <= 0.

    >>> import frictionlab as fl
    >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1))
    >>> law = fl.ElastoPlastic(mu_kinetic=0.4, stiffness=40)
    >>> round(fl.steady_state(scene, law).mean_friction, 4), round(law.elastic_deflection(), 4)
    (0.0507, 0.007)
    """

    in_words: ClassVar[str] = "Elasto-plastic"
    breakaway_ratio: Share = 0.7

    def rate(self, v: Any, z: Any) -> Any:
        """z' = v - alpha |v| z stiffness/g."""
        if (z * v.conjugate()).real <= 0.0:
            return v
        speed = abs(v)
        curve = stribeck_curve(self, speed) / self.bristle_stiffness
        begins = self.breakaway_ratio * self.mu_kinetic / self.bristle_stiffness
        return v - (breakaway_share(abs(z), begins, curve) * speed / curve) * z

    def largest_rate(self, speed: float) -> float:
        """speed stiffness/g times the largest d(alpha |z|)/d|z|, which is steepest halfway between z_ba and z_max.

        With t = pi (|z| - middle)/(z_max - z_ba): (1 + sin t + t cos t)/2 + pi middle/(2 (z_max - z_ba)) cos t, its
        first part never above 1.2.
        """
        curve = stribeck_curve(self, speed)
        begins = self.breakaway_ratio * self.mu_kinetic / curve
        steepest = 1.2 + 0.25 * math.pi * (1.0 + begins) / (1.0 - begins)
        return steepest * self.bristle_stiffness * speed / curve

    def elastic_deflection(self) -> float:
        """z_ba."""
        return self.breakaway_ratio * self.mu_kinetic / self.bristle_stiffness

    def elastic_unloading(self) -> bool:
        """Always."""
        return True


def breakaway_share(size: float, begins: float, ends: float) -> float:
    """alpha: the share of slip, 0 to 1, that bristles of deflection ``size`` do not follow."""
    if size <= begins:
        return 0.0
    if size >= ends:
        return 1.0
    return 0.5 + 0.5 * math.sin(math.pi * (size - 0.5 * (begins + ends)) / (ends - begins))
