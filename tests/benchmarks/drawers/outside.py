"""The tests' own integration of any scene, which shares no code with the package, as a reference."""

from __future__ import annotations

from campaign import Drawn, Unknown
from outside_state import Outside, Unsettled, steady

import frictionlab as fl


def from_the_answer(one: Drawn, state: fl.SteadyState) -> tuple[float, float]:
    """The mean of the motion followed from a state of the answer, and its error."""
    start: tuple[float, ...] = ()
    if "slip" not in one.scene:
        first = state.orbit(1)
        parts = (
            (first.x1, first.v1, first.x2, first.v2) if "transverse" in one.scene else (first.x1, first.v1)
        )
        start = tuple(float(part[0]) for part in parts)
    found = followed(one, start)
    return found.mean, found.error


def followed(
    one: Drawn, start: tuple[float, ...] = (), tolerance: float = 1e-13, periods: int = 4000
) -> Outside:
    """The motion from a start until it repeats. Raises Unknown."""
    try:
        return steady(one.scene, one.law, start, tolerance, periods)
    except Unsettled as why:
        raise Unknown(str(why)) from None
