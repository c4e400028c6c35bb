"""Mistakes of laws that remember scalars or several deflections."""

from __future__ import annotations

from typing import Any

from generalised_maxwell_slip import GeneralisedMaxwellSlip
from maxwell_slip import MaxwellSlip
from rate_and_state import RateAndState

from broken_laws.case import Case, bug
from frictionlab.laws.base import Positive


class Unscaled(RateAndState):
    """Rate-and-state friction that does not know its units."""

    slip_length: Positive
    reference_speed: Positive = 1.0


class Sticking(GeneralisedMaxwellSlip):
    """Elements that remember whether they stick."""


class BreaksAwayUnasked(MaxwellSlip):
    """Sliders that break away, though nothing remembers it."""

    def breakaway(self, v: Any, k: int) -> float:
        return self.reach[k]


def by_axis(law: Any, v: Any, memory: Any, k: int) -> Any:
    """In the plane two laws of one direction."""
    if not isinstance(v, complex):
        return MaxwellSlip.rate(law, v, memory, k)
    one, two = ([each.real for each in memory], [each.imag for each in memory])
    return complex(MaxwellSlip.rate(law, v.real, one, k), MaxwellSlip.rate(law, v.imag, two, k))


def in_series(law: Any, v: Any, memory: Any, k: int) -> Any:
    """Less slip where the element before has reached half way."""
    share = 0.5 if k > 0 and abs(memory[k - 1]) > 0.5 * law.reach[k - 1] else 1.0
    return MaxwellSlip.rate(law, share * v, memory, k)


CASES = (
    bug(  # backward springs bend for ever
        "SignedElements",
        MaxwellSlip,
        "oddness",
        rate=lambda law, v, memory, k: v if memory[k].real < 0.0 else MaxwellSlip.rate(law, v, memory, k),
    ),
    # sliders never let go
    bug("BackwardsLost", MaxwellSlip, "invariant_set", rate=lambda law, v, memory, k: v),
    bug("ElementsApart", MaxwellSlip, "rotation", rate=by_axis),
    bug(  # all but the first spring drag their sliders at nine tenths of what is declared
        "SecondYieldsEarly",
        MaxwellSlip,
        "yield_deflection",
        rate=lambda law, v, memory, k: MaxwellSlip.rate(
            law, v, [z / 0.9 for z in memory] if k > 0 else memory, k
        ),
    ),
    bug("InSeries", MaxwellSlip, "uncoupled", rate=in_series),
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
    bug(
        "StoresTwice",
        MaxwellSlip,
        "passivity",
        stored=lambda law, memory: 0.5 * MaxwellSlip.stored(law, memory),
    ),
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
