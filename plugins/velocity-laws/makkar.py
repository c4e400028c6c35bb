"""Makkar friction: a Stribeck peak, Coulomb friction and viscosity, all smooth in the slip velocity."""

from __future__ import annotations

import math
from typing import Annotated, ClassVar, Self

from pydantic import Field, model_validator

import frictionlab as fl

Rise = Annotated[fl.PerSpeed, Field(gt=0)]


class Makkar(fl.SlidingLaw):
    """Makkar friction: rises smoothly to about mu_kinetic + mu_excess, falls to mu_kinetic, then is viscous.

    mu_excess (tanh(excess_rise s) - tanh(excess_fall s)) + mu_kinetic tanh(kinetic_rise s) + viscosity s at slip
    speed s. Friction vanishes at rest: a body creeps where it should stick.

    Parameters
    ----------
    mu_kinetic : float, > 0
        Friction coefficient beyond the peak, less viscosity [-]: gamma_4.
    mu_excess : float, >= 0
        Height of the Stribeck peak above mu_kinetic, reached if excess_fall is far below excess_rise [-]: gamma_1.
    excess_rise : float, > 0
        Slope at which the peak rises from rest, over its height [1/scene velocity]: gamma_2.
    excess_fall : float, >= 0 and <= excess_rise
        Slope at which the peak falls again, over its height [1/scene velocity]: gamma_3.
    kinetic_rise : float, > 0
        Slope at which the kinetic part rises from rest, over mu_kinetic [1/scene velocity]: gamma_5.
    viscosity : float, >= 0, default 0
        Adds viscosity s to the coefficient [1/scene velocity]: gamma_6.

    References
    ----------
    Source: Makkar, Dixon, Sawyer & Hu (2005).
    """

    bibtex: ClassVar[str] = """
    @inproceedings{makkar2005, author = {Makkar, C. and Dixon, W. E. and Sawyer, W. G. and Hu, G.}, title = {A new
      continuously differentiable friction model for control systems design}, booktitle = {Proceedings of the 2005
      IEEE/ASME International Conference on Advanced Intelligent Mechatronics}, address = {Monterey, CA}, pages =
      {600--605}, year = {2005}}
    """
    in_words: ClassVar[str] = "Makkar et al."

    mu_kinetic: fl.Positive
    mu_excess: fl.NonNegative
    excess_rise: Rise
    excess_fall: fl.PerSpeed
    kinetic_rise: Rise
    viscosity: fl.PerSpeed = 0.0

    @model_validator(mode="after")
    def _peak_falls_no_quicker_than_it_rises(self) -> Self:
        if self.excess_fall > self.excess_rise:
            raise ValueError(
                f"excess_fall: must be at most excess_rise, {self.excess_rise:g}, got {self.excess_fall:g}"
            )
        return self

    def sliding_friction(self, speed: float) -> float:
        """Compute the coefficient at slip speed s >= 0."""
        excess = math.tanh(self.excess_rise * speed) - math.tanh(self.excess_fall * speed)
        return (
            self.mu_excess * excess
            + self.mu_kinetic * math.tanh(self.kinetic_rise * speed)
            + self.viscosity * speed
        )

    def vanishes_at_rest(self) -> bool:
        """Confirm it: friction has no jump at rest."""
        return True

    def steepest_fall(self) -> float:
        """Return the fall of the peak at rest were it not rising, less viscosity: a bound."""
        if self.excess_fall == self.excess_rise:
            return 0.0
        return max(0.0, self.mu_excess * self.excess_fall - self.viscosity)

    def monotone(self) -> bool:
        """Check whether there is no peak, or viscosity outweighs its fall."""
        return self.excess_fall == self.excess_rise or self.mu_excess * self.excess_fall <= self.viscosity
