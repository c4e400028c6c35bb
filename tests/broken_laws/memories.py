"""Mistakes of laws that remember scalars or several deflections."""

from __future__ import annotations

from typing import Annotated, Any, Self

from generalised_maxwell_slip import GeneralisedMaxwellSlip
from memory_laws import Ageing, Elements
from pydantic import Field, model_validator

from broken_laws.case import Case
from frictionlab.laws.base import Speed
from frictionlab.laws.compliant import Length, Stiffness


class Springs(Elements):
    """Maxwell-slip friction that refuses lists of two lengths, and knows its units."""

    stiffness: Annotated[tuple[Stiffness, ...], Field(min_length=1)]
    reach: Annotated[tuple[Length, ...], Field(min_length=1)]

    @model_validator(mode="after")
    def _as_many_of_both(self) -> Self:
        if len(self.reach) != len(self.stiffness):
            raise ValueError("reach: as many values as stiffness")
        return self


class Renewed(Ageing):
    """Rate-and-state friction that knows its units."""

    slip_length: Length = 0.05
    reference_speed: Speed = 1.0


class SignedElements(Springs):
    """Sliders that hold one way only."""

    def rate(self, v: Any, memory: Any, k: int) -> Any:
        """Backward springs bend for ever."""
        return v if memory[k].real < 0.0 else super().rate(v, memory, k)


class BackwardsLost(Springs):
    """Sliders that never let go."""

    def rate(self, v: Any, memory: Any, k: int) -> Any:
        """All slip goes into the springs."""
        return v


class ElementsApart(Springs):
    """In the plane each axis for itself."""

    def rate(self, v: Any, memory: Any, k: int) -> Any:
        """Two laws of one direction."""
        if not isinstance(v, complex):
            return super().rate(v, memory, k)
        one, two = ([each.real for each in memory], [each.imag for each in memory])
        return complex(super().rate(v.real, one, k), super().rate(v.imag, two, k))


class Declared(Springs):
    """The same, its yield surfaces declared."""

    def yield_deflection(self, k: int) -> float:
        """The reach."""
        return self.reach[k]


class SecondYieldsEarly(Declared):
    """All but the first spring drag their sliders before they reach as far as declared."""

    def rate(self, v: Any, memory: Any, k: int) -> Any:
        """At nine tenths."""
        return super().rate(v, [z / 0.9 for z in memory] if k > 0 else memory, k)


class InSeries(Springs):
    """Elements of which each takes the slip that the one before it leaves."""

    def rate(self, v: Any, memory: Any, k: int) -> Any:
        """Less where the one before has reached half way."""
        share = 0.5 if k > 0 and abs(memory[k - 1]) > 0.5 * self.reach[k - 1] else 1.0
        return super().rate(share * v, memory, k)


class Sticking(GeneralisedMaxwellSlip):
    """Elements that remember whether they stick."""


class BreaksAwayLate(Sticking):
    """Elements that stick for longer than they can hold."""

    def breakaway(self, v: Any, k: int) -> float:
        """A tenth further."""
        return 1.1 * super().breakaway(v, k)


class CreepsAtRest(Sticking):
    """Elements that relax where nothing slips."""

    def rate(self, v: Any, memory: Any, k: int) -> Any:
        """Towards no deflection."""
        return super().rate(v, memory, k) if v != 0.0 else -self.attraction * memory[k]


class YieldsToo(Sticking):
    """Elements with a yield surface where they break away."""

    def yield_deflection(self, k: int) -> float:
        """Breakaway at rest."""
        return self.breakaway(0.0, k)


class BreaksAwayUnasked(Springs):
    """Sliders that break away, though nothing remembers it."""

    def breakaway(self, v: Any, k: int) -> float:
        """The reach."""
        return self.reach[k]


class StoresTwice(Springs):
    """Springs that hold less than told."""

    def stored(self, memory: Any) -> float:
        """Half."""
        return 0.5 * super().stored(memory)


class SteadyTwice(Ageing):
    """A steady age of twice what the rate tends to."""

    def steady(self, v: Any, k: int) -> Any:
        """Twice."""
        return 2.0 * super().steady(v, k)


class GrowsYounger(Ageing):
    """Ages that slip takes below zero."""

    def rate(self, v: Any, memory: Any, k: int) -> Any:
        """Slip takes a constant."""
        return 1.0 - 50.0 * abs(v) / self.slip_length


class RenewsQuicker(Ageing):
    """A largest rate half of what it is."""

    def largest_rate(self, speed: float) -> float:
        """Half."""
        return 0.5 * super().largest_rate(speed)


class Backwards(Ageing):
    """Friction that does not turn round."""

    def friction(self, v: Any, memory: Any, rates: Any) -> Any:
        """Along the speed."""
        return super().friction(abs(v), memory, rates) * (1.0 if v.real > 0.0 else -0.99)


CASES = (
    Case(SignedElements, Springs, "oddness"),
    Case(BackwardsLost, Springs, "invariant_set"),
    Case(ElementsApart, Springs, "rotation"),
    Case(SecondYieldsEarly, Declared, "yield_deflection"),
    Case(InSeries, Springs, "uncoupled"),
    Case(BreaksAwayLate, Sticking, "breakaway"),
    Case(CreepsAtRest, Sticking, "breakaway"),
    Case(YieldsToo, Sticking, "breakaway"),
    Case(BreaksAwayUnasked, Sticking, "breakaway"),
    Case(StoresTwice, Springs, "passivity"),
    Case(Ageing, Renewed, "unit_scaling"),
    Case(SteadyTwice, Ageing, "steady_sliding"),
    Case(GrowsYounger, Ageing, "invariant_set"),
    Case(RenewsQuicker, Ageing, "largest_rate"),
    Case(Backwards, Ageing, "oddness"),
)
