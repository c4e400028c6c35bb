"""Amontons-Coulomb friction."""

from __future__ import annotations

import math
from typing import ClassVar

from pydantic import model_validator

from frictionlab.laws.base import Positive, SlidingLaw


class Coulomb(SlidingLaw):
    """Amontons-Coulomb friction: constant coefficient in sliding; at rest, any force up to the static limit.

    Parameters
    ----------
    mu : float, > 0
        Kinetic friction coefficient, that in slip [-].
    mu_static : float, >= mu, optional
        Static friction coefficient, that at rest [-]; ``mu`` if left out.

    References
    ----------
    Sources: Amontons (1699); Coulomb (1785); in the notation of Sulollari, van Dalen & Cabboi, Eq. 3.

    Examples
    --------
    >>> import frictionlab as fl
    >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1))
    >>> round(fl.steady_state(scene, fl.Coulomb(mu=0.4)).mean_friction, 4)
    0.0506
    >>> fl.Coulomb(mu=0.4, mu_static=0.5).static_friction()
    0.5
    """

    in_words: ClassVar[str] = "Coulomb"
    mu: Positive
    mu_static: Positive | None = None

    @model_validator(mode="after")
    def _static_not_below_kinetic(self) -> Coulomb:
        if self.mu_static is not None and self.mu_static < self.mu:
            raise ValueError(f"mu_static: must be >= mu = {self.mu:g}, got {self.mu_static:g}")
        return self

    @property
    def at_rest(self) -> float:
        """Coefficient at rest [-]."""
        return self.mu if self.mu_static is None else self.mu_static

    def sliding_friction(self, speed: float) -> float:
        """Return mu, the same coefficient at every speed."""
        return self.mu

    def static_friction(self) -> float:
        """Return mu_static."""
        return self.at_rest

    def constant_sliding_friction(self) -> bool:
        """Return True: the coefficient is the same at every speed."""
        return True

    def monotone(self) -> bool:
        """Check whether mu_static = mu: Coulomb friction is then the subdifferential of mu |v|."""
        return self.at_rest == self.mu

    def steepest_fall(self) -> float:
        """Return 0, or infinity if mu_static > mu: friction then jumps at rest."""
        return 0.0 if self.monotone() else math.inf
