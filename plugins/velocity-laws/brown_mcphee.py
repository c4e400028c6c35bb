"""Brown-McPhee friction: a smooth rise to static friction, a fall to kinetic friction, and viscosity."""

from __future__ import annotations

import math
from typing import ClassVar, Self

from pydantic import model_validator

import frictionlab as fl


class BrownMcphee(fl.SlidingLaw):
    """Brown-McPhee friction: rises smoothly to about mu_static at transition_speed, then falls to mu_kinetic.

    With u = s/transition_speed at slip speed s it is mu_kinetic tanh(4 u) + (mu_static - mu_kinetic) u/(u^2/4 +
    3/4)^2 + viscosity s; at u = 1 without viscosity mu_static - 0.0007 mu_kinetic. Friction vanishes at rest: a body
    creeps where it should stick.

    Parameters
    ----------
    mu_kinetic : float, >= 0
        Friction coefficient at high speed, less viscosity [-].
    mu_static : float, > 0 and >= mu_kinetic
        Friction coefficient at transition_speed, its peak, but for 0.0007 mu_kinetic [-].
    transition_speed : float, > 0
        Slip speed at which friction is largest [scene velocity].
    viscosity : float, >= 0, default 0
        Adds viscosity s to the coefficient [1/scene velocity].

    References
    ----------
    Source: Brown & McPhee (2016); there the viscous force depends on the normal force, here it is in proportion.
    """

    bibtex: ClassVar[str] = """
    @article{brown2016, author = {Brown, P. and McPhee, J.}, title = {A continuous velocity-based friction model for
      dynamics and control with physically meaningful parameters}, journal = {Journal of Computational and Nonlinear
      Dynamics}, volume = {11}, number = {5}, pages = {054502}, year = {2016}}
    """
    in_words: ClassVar[str] = "Brown-McPhee"

    mu_kinetic: fl.NonNegative
    mu_static: fl.Positive
    transition_speed: fl.Speed
    viscosity: fl.PerSpeed = 0.0

    @model_validator(mode="after")
    def _static_not_below_kinetic(self) -> Self:
        if self.mu_static < self.mu_kinetic:
            raise ValueError(
                f"mu_static: must be at least mu_kinetic, {self.mu_kinetic:g}, got {self.mu_static:g}"
            )
        return self

    def sliding_friction(self, speed: float) -> float:
        """Compute the coefficient at slip speed s >= 0."""
        u = speed / self.transition_speed
        peak = u / (0.25 * u * u + 0.75) ** 2
        return (
            self.mu_kinetic * math.tanh(4.0 * u)
            + (self.mu_static - self.mu_kinetic) * peak
            + self.viscosity * speed
        )

    def vanishes_at_rest(self) -> bool:
        """Confirm it: friction has no jump at rest."""
        return True

    def steepest_fall(self) -> float:
        """Return the fall of u/(u^2/4 + 3/4)^2, 4/9 at u = sqrt(3), less viscosity: a bound."""
        fall = (self.mu_static - self.mu_kinetic) * 4.0 / (9.0 * self.transition_speed)
        return max(0.0, fall - self.viscosity)

    def monotone(self) -> bool:
        """Check whether viscosity outweighs the fall."""
        fall = (self.mu_static - self.mu_kinetic) * 4.0 / (9.0 * self.transition_speed)
        return fall <= self.viscosity
