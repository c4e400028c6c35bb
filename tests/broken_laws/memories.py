"""Mistakes of laws that remember scalars or several deflections."""

from __future__ import annotations

from typing import Annotated, Any, Self

from generalised_maxwell_slip import GeneralisedMaxwellSlip
from memory_laws import Elements
from pydantic import Field, model_validator
from rate_and_state import RateAndState

from broken_laws.case import Case, bug
from frictionlab.laws.base import Positive
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


class Declared(Springs):
    """The same, its yield surfaces declared."""

    def yield_deflection(self, k: int) -> float:
        return self.reach[k]


class Unscaled(RateAndState):
    """Rate-and-state friction that does not know its units."""

    slip_length: Positive
    reference_speed: Positive = 1.0


class Sticking(GeneralisedMaxwellSlip):
    """Elements that remember whether they stick."""


class BreaksAwayUnasked(Springs):
    """Sliders that break away, though nothing remembers it."""

    def breakaway(self, v: Any, k: int) -> float:
        return self.reach[k]


def by_axis(law: Any, v: Any, memory: Any, k: int) -> Any:
    """In the plane two laws of one direction."""
    if not isinstance(v, complex):
        return Springs.rate(law, v, memory, k)
    one, two = ([each.real for each in memory], [each.imag for each in memory])
    return complex(Springs.rate(law, v.real, one, k), Springs.rate(law, v.imag, two, k))


def in_series(law: Any, v: Any, memory: Any, k: int) -> Any:
    """Less slip where the element before has reached half way."""
    share = 0.5 if k > 0 and abs(memory[k - 1]) > 0.5 * law.reach[k - 1] else 1.0
    return Springs.rate(law, share * v, memory, k)


CASES = (
    bug(  # backward springs bend for ever
        "SignedElements",
        Springs,
        "oddness",
        rate=lambda law, v, memory, k: v if memory[k].real < 0.0 else Springs.rate(law, v, memory, k),
    ),
    bug("BackwardsLost", Springs, "invariant_set", rate=lambda law, v, memory, k: v),  # sliders never let go
    bug("ElementsApart", Springs, "rotation", rate=by_axis),
    bug(  # all but the first spring drag their sliders at nine tenths of what is declared
        "SecondYieldsEarly",
        Declared,
        "yield_deflection",
        rate=lambda law, v, memory, k: Springs.rate(
            law, v, [z / 0.9 for z in memory] if k > 0 else memory, k
        ),
    ),
    bug("InSeries", Springs, "uncoupled", rate=in_series),
    bug(
        "BreaksAwayLate",
        Sticking,
        "breakaway",
        breakaway=lambda law, v, k: 1.1 * Sticking.breakaway(law, v, k),
    ),
    bug(
        "CreepsAtRest",
        Sticking,
        "breakaway",
        rate=lambda law, v, memory, k: Sticking.rate(law, v, memory, k) if v else -law.attraction * memory[k],
    ),
    bug("YieldsToo", Sticking, "breakaway", yield_deflection=lambda law, k: law.breakaway(0.0, k)),
    Case(BreaksAwayUnasked, Sticking, "breakaway"),
    bug("StoresTwice", Springs, "passivity", stored=lambda law, memory: 0.5 * Springs.stored(law, memory)),
    Case(Unscaled, RateAndState, "unit_scaling"),
    bug(
        "SteadyTwice",
        RateAndState,
        "steady_sliding",
        steady=lambda law, v, k: 2.0 * RateAndState.steady(law, v, k),
    ),
    bug(  # slip takes a constant from ages, below zero
        "GrowsYounger",
        RateAndState,
        "invariant_set",
        rate=lambda law, v, memory, k: 1.0 - 50.0 * abs(v) / law.slip_length,
    ),
    bug(
        "RenewsQuicker",
        RateAndState,
        "largest_rate",
        largest_rate=lambda law, speed: 0.5 * RateAndState.largest_rate(law, speed),
    ),
    bug(  # friction that does not turn round
        "Backwards",
        RateAndState,
        "oddness",
        friction=lambda law, v, memory, rates: (
            RateAndState.friction(law, abs(v), memory, rates) * (1.0 if v.real > 0.0 else -0.99)
        ),
    ),
)
