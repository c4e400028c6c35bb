"""Generalised Maxwell-slip friction: springs in parallel that stick until they break away, and then slip."""

from __future__ import annotations

import math
from typing import Annotated, Any, ClassVar, Self

from pydantic import Field, model_validator

from frictionlab import Dimension, MemoryLaw, PerSpeed, Positive, Speed, Stiffness
from frictionlab.laws.decay import steepest_slope
from frictionlab.laws.stribeck_bristle import stribeck_curve

PerTime = Annotated[Positive, Dimension(time=-1)]
"""A rate > 0 [1/s in SI, else 1/scene time]."""


class GeneralisedMaxwellSlip(MemoryLaw):
    """Generalised Maxwell-slip friction: springs in parallel, each of which remembers whether it sticks or slips.

    An element that sticks follows the slip, z' = v, until slip loads it to its breakaway alpha s(|v|)/k. From then on
    it slips, k z' = C (alpha v/|v| - k z/s(|v|)), until the slip reverses; in the plane until z.v <= 0.
    friction = sum of k z + viscosity v,
    s = mu_kinetic + (mu_static - mu_kinetic) exp(-(|v|/stribeck_speed)^stribeck_exponent).

    share [-], each > 0: the part of s that each element holds, relative to the sum of all (alpha = share/sum).
    stiffness [1/scene length], each > 0: k, the friction coefficient per deflection of each element.
    mu_kinetic [-], > 0: coefficient in quick sliding, viscosity apart.
    attraction [1/scene time], > 0: C, the rate at which a slipping element nears its part of s.
    mu_static [-], >= mu_kinetic: at vanishing speed; mu_kinetic where left out.
    stribeck_speed [scene velocity], > 0: speed of the fall, 1 where left out.
    stribeck_exponent [-], > 0: 2, where left out, makes the fall a Gaussian.
    viscosity [1/scene velocity], >= 0: adds viscosity*speed to the coefficient, 0 where left out.

    As many shares as stiffnesses, in any order. Along a line and with constant s an element breaks away at the
    friction it slips with: C then changes nothing, and the law is ``maxwell-slip``. In the plane it is a vector form
    of the paper's equation: slipping elements turn towards the slip at the rate C/s.
    Source: Al-Bender, Lampaert & Swevers (2005), along a line.
    """

    bibtex: ClassVar[str] = """
    @article{albender2005, author = {Al-Bender, F. and Lampaert, V. and Swevers, J.}, title = {The generalized
      {Maxwell}-slip model: a novel model for friction simulation and compensation}, journal = {IEEE Transactions on
      Automatic Control}, volume = {50}, pages = {1883--1887}, year = {2005}}
    """
    in_words: ClassVar[str] = "Generalised Maxwell-slip"

    share: Annotated[tuple[Positive, ...], Field(min_length=1)]
    stiffness: Annotated[tuple[Stiffness, ...], Field(min_length=1)]
    mu_kinetic: Positive
    attraction: PerTime
    mu_static: Positive | None = None
    stribeck_speed: Speed = 1.0
    stribeck_exponent: Positive = 2.0
    viscosity: PerSpeed = 0.0

    @model_validator(mode="after")
    def _of_the_same_elements(self) -> Self:
        if len(self.stiffness) != len(self.share):
            raise ValueError(
                f"stiffness: must have as many values as share, {len(self.share)}, got {len(self.stiffness)}"
            )
        return self

    @model_validator(mode="after")
    def _falls(self) -> Self:
        if self.mu_static is not None and self.mu_static < self.mu_kinetic:
            raise ValueError(
                f"mu_static: must be >= mu_kinetic = {self.mu_kinetic:g}, got {self.mu_static:g}"
            )
        return self

    @property
    def alpha(self) -> tuple[float, ...]:
        """Return the part of the sliding friction that each element holds [-]; their sum is 1."""
        return tuple(share / math.fsum(self.share) for share in self.share)

    @property
    def peak(self) -> float:
        """s at vanishing speed [-]."""
        return self.mu_kinetic if self.mu_static is None else self.mu_static

    def sliding_friction(self, speed: float) -> float:
        """s, and viscosity."""
        return stribeck_curve(self, speed) + self.viscosity * speed

    def count(self) -> int:
        """A deflection for each element."""
        return len(self.share)

    def rate(self, v: Any, memory: Any, k: int) -> Any:
        """Return the rate of an element that slips: towards alpha s/k along the slip; none at rest."""
        speed = abs(v)
        if speed == 0.0:
            return 0.0 * v
        along = (self.attraction * self.alpha[k] / (self.stiffness[k] * speed)) * v
        return along - (self.attraction / stribeck_curve(self, speed)) * memory[k]

    def friction(self, v: Any, memory: Any, rates: Any) -> Any:
        """Return the springs', and viscosity."""
        total = self.viscosity * v
        for k in range(len(self.stiffness)):
            total = total + self.stiffness[k] * memory[k]
        return total

    def steady(self, v: Any, k: int) -> Any:
        """alpha s/k, along the slip."""
        speed = abs(v)
        return (self.alpha[k] * stribeck_curve(self, speed) / (self.stiffness[k] * speed)) * v

    def remembers_stick(self) -> bool:
        """Always."""
        return True

    def breakaway(self, v: Any, k: int) -> float:
        """alpha s/k."""
        return self.alpha[k] * stribeck_curve(self, abs(v)) / self.stiffness[k]

    def stored(self, memory: Any) -> float:
        """In the springs."""
        total = 0.0
        for k in range(len(self.stiffness)):
            total += 0.5 * self.stiffness[k] * (memory[k] * memory[k].conjugate()).real
        return total

    def within(self, memory: Any) -> bool:
        """No spring is stretched further than its breakaway at vanishing speed."""
        inside = True
        for k in range(len(self.stiffness)):
            limit = self.alpha[k] * self.peak / self.stiffness[k]
            inside = inside and abs(memory[k]) <= limit * (1.0 + 1e-9)
        return inside

    def constant_sliding_friction(self) -> bool:
        """Return where mu_static = mu_kinetic and viscosity = 0."""
        return self.peak == self.mu_kinetic and self.viscosity == 0.0

    def steepest_fall(self) -> float:
        """At the inflection of s, less viscosity."""
        drop = self.peak - self.mu_kinetic
        if drop == 0.0:
            return 0.0
        return max(0.0, drop / self.stribeck_speed * steepest_slope(self.stribeck_exponent) - self.viscosity)

    def largest_rate(self, speed: float) -> float:
        """attraction/s, of an element that slips."""
        return self.attraction / stribeck_curve(self, speed)
