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

    z' = v - alpha |v| z stiffness/g(|v|), friction = stiffness z + damping z' + viscosity v, with the
    Stribeck curve g of LuGre friction. alpha = 0 where z.v <= 0 or |z| <= z_ba, and 1 where |z| >= z_max =
    g/stiffness. In between alpha = (1 + sin(pi (|z| - (z_max + z_ba)/2)/(z_max - z_ba)))/2, with z_ba =
    breakaway_ratio*mu_kinetic/stiffness. Below z_ba nothing drifts. In the plane alpha is that of |z|,
    switched off wherever z.v <= 0.

    Parameters
    ----------
    mu_kinetic : float, > 0
        Friction coefficient in quick sliding, viscosity apart [-].
    mu_static : float, >= mu_kinetic, optional
        Friction coefficient at vanishing speed [-]; ``mu_kinetic`` if left out.
    stribeck_speed : float, > 0, default 1
        Speed over which the coefficient falls [scene velocity].
    stribeck_exponent : float, > 0, default 2
        Exponent of the fall [-]; 2 makes the fall a Gaussian.
    viscosity : float, >= 0, default 0
        Viscosity [1/scene velocity]: adds viscosity*speed to the coefficient.
    breakaway_ratio : float, > 0 and < 1, default 0.7
        Breakaway deflection z_ba as a fraction of mu_kinetic/stiffness [-].
    stiffness : float, > 0, optional
        Stiffness: friction coefficient per deflection [1/scene length]. Exactly one is given: ``stiffness``,
        ``presliding_length`` or ``contact_stiffness``.
    presliding_length : float, > 0, optional
        Presliding length, mu_kinetic/stiffness [scene length].
    contact_stiffness : float, > 0, optional
        Contact stiffness, ``stiffness`` times normal load [K_1].
    damping : float, >= 0, optional
        Damping: friction coefficient per rate of deflection [1/scene velocity]; 0 if neither it nor
        ``contact_damping`` is given.
    contact_damping : float, >= 0, optional
        Contact damping, ``damping`` times normal load [M omega_1]; given instead of ``damping``.
    planar : {"vectorial", "per-axis"}, default "vectorial"
        Extension to the plane of the law of one direction, as in ``BristleLaw``.

    References
    ----------
    Sources: Dupont, Armstrong & Hayward (2000); Dupont, Hayward, Armstrong & Altpeter (2002).

    Examples
    --------
    >>> import frictionlab as fl
    >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1))
    >>> law = fl.ElastoPlastic(mu_kinetic=0.4, stiffness=40)
    >>> round(fl.steady_state(scene, law).mean_friction, 4), round(law.elastic_deflection(), 4)
    (0.0507, 0.007)
    """

    in_words: ClassVar[str] = "Elasto-plastic"
    breakaway_ratio: Share = 0.7

    def rate(self, v: Any, z: Any) -> Any:
        """Compute z' = v - alpha |v| z stiffness/g."""
        if (z * v.conjugate()).real <= 0.0:
            return v
        speed = abs(v)
        curve = stribeck_curve(self, speed) / self.bristle_stiffness
        begins = self.breakaway_ratio * self.mu_kinetic / self.bristle_stiffness
        return v - (breakaway_share(abs(z), begins, curve) * speed / curve) * z

    def largest_rate(self, speed: float) -> float:
        """Return speed stiffness/g times a bound on d(alpha |z|)/d|z|.

        The derivative is largest halfway between z_ba and z_max.
        With t = pi (|z| - middle)/(z_max - z_ba) the derivative is
        (1 + sin t + t cos t)/2 + pi middle/(2 (z_max - z_ba)) cos t, its first part never above 1.2.
        """
        curve = stribeck_curve(self, speed)
        begins = self.breakaway_ratio * self.mu_kinetic / curve
        steepest = 1.2 + 0.25 * math.pi * (1.0 + begins) / (1.0 - begins)
        return steepest * self.bristle_stiffness * speed / curve

    def elastic_deflection(self) -> float:
        """Return the breakaway deflection z_ba."""
        return self.breakaway_ratio * self.mu_kinetic / self.bristle_stiffness

    def elastic_unloading(self) -> bool:
        """Return True: alpha is 0 wherever z.v <= 0."""
        return True


def breakaway_share(size: float, begins: float, ends: float) -> float:
    """Compute alpha: the share of slip, 0 to 1, that bristles of deflection ``size`` do not follow."""
    if size <= begins:
        return 0.0
    if size >= ends:
        return 1.0
    return 0.5 + 0.5 * math.sin(math.pi * (size - 0.5 * (begins + ends)) / (ends - begins))
