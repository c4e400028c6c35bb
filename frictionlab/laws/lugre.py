"""LuGre friction: damped bristles on a Stribeck curve."""

from __future__ import annotations

from typing import Any, ClassVar

from frictionlab.laws.decay import exp_decay
from frictionlab.laws.stribeck_bristle import StribeckBristle, stribeck_curve


class LuGre(StribeckBristle):
    """LuGre friction: damped Dahl bristles whose steady friction is a Stribeck curve g, plus viscosity.

    z' = v - |v| z stiffness/g(|v|), friction = stiffness z + damping z' + viscosity v,
    g = mu_kinetic + (mu_static - mu_kinetic) exp(-(|v|/stribeck_speed)^stribeck_exponent).

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
    Sources: Canudas de Wit, Olsson, Åström & Lischinsky (1995); in the plane Velenis, Tsiotras, Canudas de
    Wit & Sorine (2005); passivity: Barahanov & Ortega (2000).

    Examples
    --------
    >>> import frictionlab as fl
    >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1))
    >>> law = fl.LuGre(mu_kinetic=0.3, mu_static=0.4, stribeck_speed=2, stiffness=40)
    >>> round(fl.steady_state(scene, law).mean_friction, 4)
    0.0306
    """

    in_words: ClassVar[str] = "LuGre"

    def rate(self, v: Any, z: Any) -> Any:
        """Compute z' = v - |v| z stiffness/g."""
        speed = abs(v)
        return v - (self.bristle_stiffness * speed / stribeck_curve(self, speed)) * z

    def exact_path(self) -> bool:
        """Check whether g is the same at every speed; ``deflected`` is then exact."""
        return self.peak == self.mu_kinetic

    def deflected(self, z: Any, path: Any) -> Any:
        """Compute the deflection after a straight path for constant g.

        It tends to mu_kinetic/stiffness as exp(-path stiffness/mu_kinetic).
        """
        length = abs(path)
        if length == 0.0:
            return z
        saturation = self.mu_kinetic / self.bristle_stiffness
        end = (saturation / length) * path
        return end + (z - end) * exp_decay(length / saturation)
