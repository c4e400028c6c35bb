"""Gonthier friction: a bristle, and a memory of how long the contact has dwelt."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Annotated, Any, ClassVar, Self

from pydantic import Field, model_validator

from frictionlab import Dimension, MemoryLaw, PerSpeed, Positive, Speed, Stiffness

Time = Annotated[Positive, Dimension(time=1)]
"""A time > 0 [s in SI, else scene time]."""


class Gonthier(MemoryLaw):
    """Gonthier friction: a bristle that slow slip bends and quick slip drags, limited by its dwell.

    z' = s v + (1 - s) (mu_kinetic v/|v| - stiffness z)/bristle_damping with s = exp(-(|v|/stribeck_speed)^2), 1 at
    rest and 0 in quick sliding. The dwell nears s: its rate is s less itself, over dwell_time where it grows and over
    bristle_damping/stiffness where it falls. friction = f + viscosity v with f = stiffness z + bristle_damping z' but
    no longer than mu_kinetic + (mu_static - mu_kinetic) dwell.

    The source smooths v/|v| at low speed; here it is exact, as 1 - s vanishes at rest. Slip that stays far below
    stribeck_speed bends the bristle without bound, though friction keeps its limit. Second in the memory is
    ``length`` times 1 + dwell, which has a size in quick sliding, too. It does not turn with the slip: two
    checks of the battery ask that of every deflection.

    Parameters
    ----------
    mu_kinetic : float, > 0
        Friction coefficient in quick sliding, viscosity apart [-].
    mu_static : float, >= mu_kinetic
        Limit of friction after a long dwell [-].
    stiffness : float, > 0
        Friction coefficient per deflection of the bristle, sigma_0 [1/scene length].
    bristle_damping : float, > 0
        Friction coefficient per rate of the deflection, sigma_1 [1/scene velocity].
    stribeck_speed : float, > 0
        Slip speed beyond which a contact slides [scene velocity].
    dwell_time : float, > 0
        Time in which friction at rest nears mu_static [scene time].
    viscosity : float, >= 0, default 0
        Friction coefficient per slip speed, sigma_2 [1/scene velocity].

    References
    ----------
    Source: Gonthier, McPhee, Lange & Piedboeuf (2004)
    """

    bibtex: ClassVar[str] = """
    @article{gonthier2004, author = {Gonthier, Y. and McPhee, J. and Lange, C. and Piedboeuf, J.-C.}, title = {A
      regularized contact model with asymmetric damping and dwell-time dependent friction}, journal = {Multibody
      System Dynamics}, volume = {11}, pages = {209--233}, year = {2004}}
    """
    in_words: ClassVar[str] = "Gonthier"
    expected_failures: ClassVar[Mapping[str, str]] = dict.fromkeys(
        ("oddness", "rotation"),
        "the dwell has no direction that could turn; friction itself turns with the slip",
    )

    mu_kinetic: Positive
    mu_static: Positive
    stiffness: Stiffness
    bristle_damping: Annotated[PerSpeed, Field(gt=0)]
    stribeck_speed: Speed
    dwell_time: Time
    viscosity: PerSpeed = 0.0

    @model_validator(mode="after")
    def _grows(self) -> Self:
        if self.mu_static < self.mu_kinetic:
            raise ValueError(
                f"mu_static: must be >= mu_kinetic = {self.mu_kinetic:g}, got {self.mu_static:g}"
            )
        return self

    @property
    def bristle_time(self) -> float:
        """Time in which a bristle that slides relaxes, sigma_1/sigma_0 [scene time]."""
        return self.bristle_damping / self.stiffness

    @property
    def length(self) -> float:
        """Deflection of a bristle that slides quickly; also the unit in which the dwell is kept [scene length]."""
        return self.mu_kinetic / self.stiffness

    def count(self) -> int:
        """Return 2: the deflection, and the dwell."""
        return 2

    def sliding_friction(self, speed: float) -> float:
        """Compute the friction of a bristle that has settled, and viscosity."""
        slides = -math.expm1(-((speed / self.stribeck_speed) ** 2))
        limit = self.mu_static - (self.mu_static - self.mu_kinetic) * slides
        if slides > 0.0:
            limit = min(limit, self.mu_kinetic + self.bristle_damping * speed * (1.0 - slides) / slides)
        return limit + self.viscosity * speed

    def rate(self, v: Any, memory: Any, k: int) -> Any:
        """Compute the rate of the deflection, or of the dwell."""
        speed = abs(v)
        slides = -math.expm1(-((speed / self.stribeck_speed) ** 2))
        if k == 1:
            missing = (2.0 - slides) * self.length - memory[1]
            return missing / (self.dwell_time if missing.real >= 0.0 else self.bristle_time)
        if speed == 0.0:
            return 0.0 * v
        pulled = (self.mu_kinetic / speed) * v - self.stiffness * memory[0]
        return (1.0 - slides) * v + (slides / self.bristle_damping) * pulled

    def steady(self, v: Any, k: int) -> Any:
        """Return where the bristle has settled, or the dwell."""
        speed = abs(v)
        slides = -math.expm1(-((speed / self.stribeck_speed) ** 2))
        if k == 1:
            return (2.0 - slides) * self.length + 0.0 * v
        drawn = self.bristle_damping * (1.0 - slides) / max(slides, 1e-300)
        return ((self.mu_kinetic / speed + drawn) / self.stiffness) * v

    def friction(self, v: Any, memory: Any, rates: Any) -> Any:
        """Compute the force of the bristle, up to its limit, and viscosity.

        It is, with z' put in, s (stiffness z + bristle_damping v) + (1 - s) mu_kinetic v/|v|.
        """
        speed = abs(v)
        stick = math.exp(-((speed / self.stribeck_speed) ** 2))
        slides = -math.expm1(-((speed / self.stribeck_speed) ** 2))
        force = stick * (self.stiffness * memory[0] + self.bristle_damping * v)
        if speed > 0.0:
            force = force + (slides * self.mu_kinetic / speed) * v
        dwell = max(0.0, memory[1].real / self.length - 1.0)
        limit = self.mu_kinetic + (self.mu_static - self.mu_kinetic) * dwell
        size = abs(force)
        if size > limit:
            force = (limit / size) * force
        return force + self.viscosity * v

    def largest_rate(self, speed: float) -> float:
        """Return the rate at which a bristle that slides relaxes, or a dwell begins."""
        return max(1.0 / self.bristle_time, 1.0 / self.dwell_time)
