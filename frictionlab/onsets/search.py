"""The place between two belt speeds at which a motion changes its kind."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

_MOST_MISSED = 3
"""Belt speeds in a row without an answer, one more of which ends a search."""
DistanceOf = Callable[[float], float | None]


class LocatedOnset(NamedTuple):
    """A value and the bound on its error; stopped: a belt speed without an answer at which the search ended."""

    value: float
    error: float
    stopped: float | None = None


class DistanceAt(NamedTuple):
    """A belt speed and a distance there, which changes its sign at the place looked for."""

    x: float
    f: float


def change_between(
    distance: DistanceOf, low: DistanceAt, high: DistanceAt, width: float, most: int
) -> LocatedOnset:
    """Where a function changes its sign between two samples of opposite sign, to a bracket of this width.

    The function is smooth on each side, with a kink or a jump where it changes its sign. So the line through the two
    nearest samples of a side tells where it ends; the next sample lies beyond that by what such estimates differ, so
    that both ends of the bracket close in. A bracket that does not shrink is halved. distance: None where it has no
    answer. most: calls.
    """
    below, above = [low], [high]
    widths = [high.x - low.x]
    missed: list[float] = []
    for _ in range(most):
        a, b = below[-1].x, above[-1].x
        if b - a <= width:
            break
        stalls = len(widths) > 3 and widths[-1] > 0.3 * widths[-4]
        x = 0.5 * (a + b) if stalls else _next(below, above, width)
        if missed:  # half way from there to the farther end
            x = 0.5 * (missed[-1] + (a if missed[-1] - a > b - missed[-1] else b))
        f = distance(x)
        if f is None:
            missed.append(x)
            if len(missed) > _MOST_MISSED:
                break
            continue
        missed.clear()
        (below if (f > 0.0) == (low.f > 0.0) else above).append(DistanceAt(x, f))
        widths = [above[-1].x - below[-1].x] if stalls else [*widths, above[-1].x - below[-1].x]
    a, b = below[-1].x, above[-1].x
    return LocatedOnset(0.5 * (a + b), 0.5 * (b - a), missed[0] if missed else None)


def _next(below: list[DistanceAt], above: list[DistanceAt], width: float) -> float:
    """The next belt speed to look at, inside the bracket."""
    a, b = below[-1].x, above[-1].x
    pairs = [pair for pair in (below[-2:], above[-2:]) if len(pair) == 2]
    ends = [place for pair in pairs for place in _zeros(*pair) if a < place < b]
    ends = ends or _zeros(below[-1], above[-1])
    if not ends:
        return 0.5 * (a + b)
    middle = sum(ends) / len(ends)
    nearer = min(middle - a, b - middle)
    beyond = max(abs(ends[0] - ends[-1]) if len(ends) > 1 else 0.1 * nearer, 0.4 * width)
    # no farther than half way to the end of the bracket on the other side
    room = b - middle if middle - a < b - middle else a - middle
    x = middle + math.copysign(min(beyond, 0.5 * abs(room)), room)
    inside = min(0.45 * width, 0.25 * (b - a))
    return min(max(x, a + inside), b - inside)


def _zeros(first: DistanceAt, second: DistanceAt) -> list[float]:
    """Where the line through two samples is zero; nothing for one that is level."""
    rise = second.f - first.f
    return [first.x - first.f * (second.x - first.x) / rise] if rise != 0.0 else []
