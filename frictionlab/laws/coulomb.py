"""Amontons-Coulomb friction."""

from __future__ import annotations

from typing import Any

from pydantic import model_validator

from frictionlab.laws.base import Positive, SlidingLaw


class Coulomb(SlidingLaw):
    """Amontons-Coulomb friction: a constant coefficient against the slip, any vector up to it at rest.

    mu [-], > 0: friction coefficient, at rest and in slip.

    Sources: Amontons (1699); Coulomb (1785); in the notation of Sulollari, van Dalen & Cabboi, Eq. 3.
    """

    mu: Positive

    @model_validator(mode="before")
    @classmethod
    def _refuse_what_has_not_come(cls, data: Any) -> Any:
        if isinstance(data, dict) and "mu_static" in data:
            raise ValueError("mu_static: not available yet")
        return data

    def sliding_friction(self, speed: float) -> float:
        """The same coefficient at every speed."""
        return self.mu

    def constant_sliding_friction(self) -> bool:
        """Always."""
        return True

    def monotone(self) -> bool:
        """Always: Coulomb friction is the subdifferential of mu |v|."""
        return True
