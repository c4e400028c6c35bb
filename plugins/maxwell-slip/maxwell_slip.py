"""Maxwell-slip friction: elements in parallel, each a spring in series with a Coulomb slider."""

from __future__ import annotations

from typing import Annotated, Any, ClassVar, Self

from pydantic import Field, model_validator

from frictionlab import Jenkins, MemoryLaw, Positive, Stiffness


class MaxwellSlip(MemoryLaw):
    """Maxwell-slip friction: springs in parallel, each with a slider of its own that takes what its spring cannot.

    mu [-], each > 0: the friction coefficient of each element's slider; their sum is that of steady sliding.
    stiffness [1/scene length], each > 0: the friction coefficient per deflection of each element's spring.

    As many of both as there are elements, in any order; one element is ``jenkins``. Identified as forces over
    displacements (the breakpoints of a virgin curve), divide both lists by the normal load.
    In the plane every slider is dragged as by a rope: it moves along its spring while that holds its mu (a tractrix).
    The generalised law (Al-Bender, Lampaert & Swevers, 2005) is another: its elements remember whether they stick.
    Sources: Iwan (1966); Lampaert, Swevers & Al-Bender (2002); Al-Bender, Lampaert & Swevers (2005).
    """

    bibtex: ClassVar[str] = """
    @article{iwan1966, author = {Iwan, W. D.}, title = {A distributed-element model for hysteresis and its
      steady-state dynamic response}, journal = {Journal of Applied Mechanics}, volume = {33}, pages = {893--900},
      year = {1966}}
    @article{lampaert2002, author = {Lampaert, V. and Swevers, J. and Al-Bender, F.}, title = {Modification of the
      {Leuven} integrated friction model structure}, journal = {IEEE Transactions on Automatic Control}, volume =
      {47}, pages = {683--687}, year = {2002}}
    @article{albender2005, author = {Al-Bender, F. and Lampaert, V. and Swevers, J.}, title = {The generalized
      {Maxwell}-slip model: a novel model for friction simulation and compensation}, journal = {IEEE Transactions on
      Automatic Control}, volume = {50}, pages = {1883--1887}, year = {2005}}
    """
    in_words: ClassVar[str] = "Maxwell-slip"

    mu: Annotated[tuple[Positive, ...], Field(min_length=1)]
    stiffness: Annotated[tuple[Stiffness, ...], Field(min_length=1)]

    @model_validator(mode="after")
    def _of_the_same_elements(self) -> Self:
        if len(self.stiffness) != len(self.mu):
            raise ValueError(
                f"stiffness: must have as many values as mu, {len(self.mu)}, got {len(self.stiffness)}"
            )
        return self

    @property
    def reach(self) -> tuple[float, ...]:
        """Return the deflection of each element at which its slider moves [scene length]."""
        return tuple(mu / stiffness for mu, stiffness in zip(self.mu, self.stiffness, strict=True))

    def sliding_friction(self, speed: float) -> float:
        """Every slider's, at every speed."""
        total = 0.0
        for k in range(len(self.mu)):
            total += self.mu[k]
        return total

    def count(self) -> int:
        """A deflection for each element."""
        return len(self.mu)

    def rate(self, v: Any, memory: Any, k: int) -> Any:
        """v, less its part along the spring where that is stretched to its reach and would be stretched further."""
        z = memory[k]
        along, size = (z * v.conjugate()).real, abs(z)
        if along <= 0.0 or size < self.reach[k]:
            return v
        return (
            v - (along / (size * self.reach[k])) * z
        )  # size*reach, not size^2: what a step overshot is taken back

    def friction(self, v: Any, memory: Any, rates: Any) -> Any:
        """Return the springs'."""
        total = 0.0 * v
        for k in range(len(self.stiffness)):
            total = total + self.stiffness[k] * memory[k]
        return total

    def deflected(self, memory: Any, path: Any) -> list[Any]:
        """Memory after slip along a straight ``path`` [scene length], exactly: each element's as ``Jenkins``."""
        elements = zip(self.mu, self.stiffness, memory, strict=True)
        return [Jenkins(mu=mu, stiffness=stiffness).deflected(z, path) for mu, stiffness, z in elements]

    def steady(self, v: Any, k: int) -> Any:
        """At its reach, along the slip."""
        return self.reach[k] * (v / abs(v))

    def yield_deflection(self, k: int) -> float:
        """Its reach."""
        return self.reach[k]

    def stored(self, memory: Any) -> float:
        """In the springs."""
        total = 0.0
        for k in range(len(self.stiffness)):
            total += 0.5 * self.stiffness[k] * (memory[k] * memory[k].conjugate()).real
        return total

    def within(self, memory: Any) -> bool:
        """No spring is stretched further than its reach."""
        inside = True
        for k in range(len(self.mu)):
            inside = inside and abs(memory[k]) <= self.reach[k] * (1.0 + 1e-9)
        return inside

    def constant_sliding_friction(self) -> bool:
        """Always."""
        return True

    def largest_rate(self, speed: float) -> float:
        """Return the rate of the shortest spring: where it turns towards the slip, or comes back to its reach."""
        quickest = 0.0
        for k in range(len(self.mu)):
            quickest = max(quickest, speed / self.reach[k])
        return quickest

    def rate_independent(self) -> bool:
        """Always."""
        return True

    def passive(self) -> bool:
        """Always: what the springs do not store, the sliders take."""
        return True
