"""The order that theory gives each solver on each kind of motion, and why."""

from __future__ import annotations

import math
from typing import NamedTuple


class TheoryOfOrder(NamedTuple):
    """An order, NaN where errors fall otherwise than by a power, and the reason; plain: without a logarithm."""

    order: float
    reason: str
    plain: bool = True


_OWN = "of the formula itself: all is smooth"
_REVERSAL = "a reversal inside a step: the grid knows its sign, not its share"
_CORNER = "rates have a corner where slip reverses: second order is kept, no higher one"
_BLIND = "blind to stick: chatter of one step's impulse"
_ENDS = "projection: friction is continuous where stick begins and ends"
_LOGARITHM = "the dip grows with what it changes: h log 1/h, which looks like less or more than 1 for long"
_FASTER = "slip stays many widths from rest: faster than any power"
_WIDTH = "friction is off while slip is within a width of rest: a time in proportion to it"
_TOLERANCE = "the error follows the tolerance; steps adapt, so not smoothly"
_CLOSED_FORM = "closed form between events: rounding at any tolerance"

_OF_TWO_STAGES = {
    "bristle_dragged": TheoryOfOrder(2.0, _OWN),
    "bristle_soft": TheoryOfOrder(2.0, _CORNER),
    "bristle_stiff": TheoryOfOrder(2.0, _CORNER),
}
_THEORY: dict[str, dict[str, TheoryOfOrder]] = {
    "rk4": {
        "smooth": TheoryOfOrder(4.0, _OWN),
        "crossing": TheoryOfOrder(1.0, _REVERSAL),
        "grazing": TheoryOfOrder(1.0, _LOGARITHM, plain=False),
        "stick": TheoryOfOrder(1.0, _BLIND),
        "bristle_dragged": TheoryOfOrder(4.0, _OWN),
        "bristle_soft": TheoryOfOrder(2.0, _CORNER),
        "bristle_stiff": TheoryOfOrder(2.0, _CORNER),
        "plane_near_rest": TheoryOfOrder(
            4.0, "of the formula itself, once a step is shorter than the turn; rounding comes first"
        ),
    },
    "moreau_0.5": {
        "smooth": TheoryOfOrder(2.0, _OWN),
        "crossing": TheoryOfOrder(1.0, _REVERSAL),
        "grazing": TheoryOfOrder(
            2.0, "what the amplitude's error, of order 2, exceeds the belt by is projected"
        ),
        "stick": TheoryOfOrder(2.0, _ENDS),
        "plane_near_rest": TheoryOfOrder(2.0, _OWN),
    },
    "moreau_1": {
        "smooth": TheoryOfOrder(1.0, _OWN),
        "crossing": TheoryOfOrder(1.0, _REVERSAL),
        "grazing": TheoryOfOrder(
            math.nan, "its damping of order 1 keeps slip from rest: friction is constant"
        ),
        "stick": TheoryOfOrder(1.0, _OWN),
        "plane_near_rest": TheoryOfOrder(1.0, _OWN),
    },
    "exponential": _OF_TWO_STAGES,
    "sdirk2": _OF_TWO_STAGES,
    "smoothed": {
        "smooth": TheoryOfOrder(math.nan, _FASTER),
        "crossing": TheoryOfOrder(1.0, _WIDTH),
        "grazing": TheoryOfOrder(1.0, _LOGARITHM, plain=False),
        "stick": TheoryOfOrder(1.0, _WIDTH),
        "plane_near_rest": TheoryOfOrder(math.nan, _FASTER),
    },
}


def theory_of(solver: str, motion: str) -> TheoryOfOrder:
    """What theory says of a solver on a motion."""
    if solver in _THEORY:
        return _THEORY[solver][motion]
    return (
        TheoryOfOrder(math.nan, _CLOSED_FORM)
        if solver == "exact"
        else TheoryOfOrder(1.0, _TOLERANCE, plain=False)
    )
