"""LuGre friction: damped bristles on a Stribeck curve."""

from __future__ import annotations

from typing import Any, ClassVar

from frictionlab.laws.decay import exp_decay
from frictionlab.laws.stribeck_bristle import StribeckBristle, stribeck_curve


class LuGre(StribeckBristle):
    """LuGre friction: damped Dahl bristles whose steady friction is a Stribeck curve g, plus viscosity.

    z' = v - |v| z stiffness/g(|v|), friction = stiffness z + damping z' + viscosity v,
    g = mu_kinetic + (mu_static - mu_kinetic) exp(-(|v|/stribeck_speed)^stribeck_exponent).

    mu_kinetic [-], > 0: coefficient in quick sliding, viscosity apart.
    mu_static [-], >= mu_kinetic: at vanishing speed; mu_kinetic where left out.
    stribeck_speed [scene velocity], > 0 (1); stribeck_exponent [-], > 0 (2).
    stiffness [1/scene length], presliding_length [scene length] (mu_kinetic/stiffness) or contact_stiffness [K_1].
    damping [1/scene velocity] or contact_damping [M omega_1], >= 0 (0).
    viscosity [1/scene velocity], >= 0 (0).

    Sources: Canudas de Wit, Olsson, Åström & Lischinsky (1995); in the plane Velenis, Tsiotras, Canudas de Wit &
    Sorine (2005); passivity: Barahanov & Ortega (2000).

    >>> import frictionlab as fl
    >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1))
    >>> law = fl.LuGre(mu_kinetic=0.3, mu_static=0.4, stribeck_speed=2, stiffness=40)
    >>> round(fl.steady_state(scene, law).mean_friction, 4)
    0.0306
    """

    in_words: ClassVar[str] = "LuGre"

    def rate(self, v: Any, z: Any) -> Any:
        """z' = v - |v| z stiffness/g."""
        speed = abs(v)
        return v - (self.bristle_stiffness * speed / stribeck_curve(self, speed)) * z

    def exact_path(self) -> bool:
        """Where g is the same at every speed."""
        return self.peak == self.mu_kinetic

    def deflected(self, z: Any, path: Any) -> Any:
        """Towards mu_kinetic/stiffness as exp(-path stiffness/mu_kinetic), for constant g."""
        length = abs(path)
        if length == 0.0:
            return z
        saturation = self.mu_kinetic / self.bristle_stiffness
        end = (saturation / length) * path
        return end + (z - end) * exp_decay(length / saturation)
