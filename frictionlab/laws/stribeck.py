"""Stribeck friction: a coefficient that falls from its static value with slip speed."""

from __future__ import annotations

import math
from typing import Any, ClassVar, Literal

from pydantic import model_validator

from frictionlab.laws.base import NonNegative, PerSpeed, Positive, SlidingLaw, Speed
from frictionlab.laws.decay import exp_power_decay, steepest_slope

EXPONENTIAL, RATIONAL, CUBIC = 0.0, 1.0, 2.0


class Stribeck(SlidingLaw):
    """Stribeck friction: falls from mu_static at rest to mu_kinetic at high speed, along one of four curves.

    With u = speed/stribeck_speed and d = mu_static - mu_kinetic the curves are

    - ``exponential``: mu_kinetic + d exp(-u^stribeck_exponent)
    - ``hyperbolic``: mu_kinetic + d/(1 + u)
    - ``hess-soom``: mu_kinetic + d/(1 + u^2)
    - ``cubic``: mu_static - d (3 u - u^3)/2, which grows without bound

    Parameters
    ----------
    mu_kinetic : float, >= 0
        Friction coefficient at high speed [-]; for the cubic curve its minimum, at stribeck_speed.
    mu_static : float, > 0 and >= mu_kinetic
        Friction coefficient at rest and at vanishing speed [-].
    stribeck_speed : float, > 0, default 1
        Speed over which the coefficient falls [scene velocity].
    stribeck_exponent : float, > 0, optional
        Exponent of the exponential curve [-], 2 if left out; the other curves have none.
    viscosity : float, >= 0, default 0
        Viscosity [1/scene velocity]: adds viscosity*speed to the coefficient.
    curve : {"exponential", "hyperbolic", "hess-soom", "cubic"}, default "exponential"
        Curve along which the coefficient falls.

    References
    ----------
    Sources: exponential: Bo & Pavelescu (1982), Armstrong-Hélouvry (1991); hyperbolic: Leine, van Campen, de
    Kraker & van den Steen (1998); hess-soom: Hess & Soom (1990); cubic: Thomsen (1999), Thomsen & Fidlin
    (2003).

    Examples
    --------
    >>> import frictionlab as fl
    >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1))
    >>> law = fl.Stribeck(mu_kinetic=0.3, mu_static=0.4, stribeck_speed=2)
    >>> round(fl.steady_state(scene, law).mean_friction, 4)
    0.0306
    """

    in_words: ClassVar[str] = "Stribeck"
    mu_kinetic: NonNegative
    mu_static: Positive
    stribeck_speed: Speed = 1.0
    stribeck_exponent: Positive | None = None
    viscosity: PerSpeed = 0.0
    curve: Literal["exponential", "hyperbolic", "hess-soom", "cubic"] = "exponential"

    @model_validator(mode="before")
    @classmethod
    def _exponent_of_the_exponential(cls, data: Any) -> Any:
        if isinstance(data, dict) and data.get("curve", "exponential") == "exponential":
            return {"stribeck_exponent": 2.0, **data}
        return data

    @model_validator(mode="after")
    def _falls(self) -> Stribeck:
        problems = []
        if self.mu_static < self.mu_kinetic:
            problems = [f"mu_static: must be >= mu_kinetic = {self.mu_kinetic:g}, got {self.mu_static:g}"]
        if self.curve != "exponential" and self.stribeck_exponent is not None:
            problems += [f"stribeck_exponent: leave it out, the {self.curve} curve has none"]
        if problems:
            raise ValueError("; ".join(problems))
        return self

    @property
    def family(self) -> float:
        """Number that stands for the formula of the curve in kernels."""
        return {"exponential": EXPONENTIAL, "cubic": CUBIC}.get(self.curve, RATIONAL)

    @property
    def power(self) -> float:
        """Exponent of speed in the formula."""
        return self.stribeck_exponent or (2.0 if self.curve == "hess-soom" else 1.0)

    def sliding_friction(self, speed: float) -> float:
        """Compute the curve, viscosity included."""
        u = speed / self.stribeck_speed
        if self.family == CUBIC:
            left = 1.0 - 0.5 * u * (3.0 - u * u)
        elif self.family == EXPONENTIAL:
            left = exp_power_decay(u, self.power)
        else:
            left = 1.0 / (1.0 + u**self.power)
        return self.mu_kinetic + (self.mu_static - self.mu_kinetic) * left + self.viscosity * speed

    def constant_sliding_friction(self) -> bool:
        """Check whether mu_static = mu_kinetic and viscosity = 0."""
        return self.mu_static == self.mu_kinetic and self.viscosity == 0.0

    def monotone(self) -> bool:
        """Check whether viscosity outweighs the fall at every speed."""
        return self.steepest_fall() == 0.0

    def steepest_fall(self) -> float:
        """Return the steepest slope of the curve less viscosity; infinite for an exponent below one."""
        drop = self.mu_static - self.mu_kinetic
        if drop == 0.0:
            return 0.0
        return max(0.0, drop / self.stribeck_speed * self._steepest() - self.viscosity)

    def _steepest(self) -> float:
        """Return the largest slope over u of the curve that falls from 1 to 0."""
        if self.family == CUBIC:
            return 1.5
        if self.family == RATIONAL:
            return 1.0 if self.power == 1.0 else 0.375 * math.sqrt(3.0)
        return steepest_slope(self.power)
