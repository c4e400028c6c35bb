"""Least squares from many starts: where each ends, which end is best, and how many agree with it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares
from scipy.stats import qmc

from frictionlab.fitting.residuals import Residuals
from frictionlab.quantities import Floats

STARTS = 8
SAME_END = 1e-3
"""Ends agree where their sums of squares differ by less, relatively, and no share of a range by ten times it."""
ON_A_BOUND = 1e-4
"""Share of a range within which a number counts as on its end."""


@dataclass(frozen=True, eq=False)
class Optimum:
    """Where a search ended: shares of the ranges, residuals over their standard errors, half their sum of squares."""

    shares: Floats
    residuals: Floats
    cost: float


@dataclass(frozen=True, eq=False)
class SearchEnds:
    """The best of all ends, other minima, and how many starts ended at the best."""

    best: Optimum
    others: list[Optimum]
    agreeing: int
    starts: int


def search(
    residuals: Residuals, starts: int = STARTS, tell: Callable[[str], None] | None = None
) -> SearchEnds:
    """Search from a Latin hypercube of starts over the ranges."""
    count = len(residuals.model.free)
    drawn = qmc.LatinHypercube(count, seed=1).random(starts)
    ends = []
    for place, start in enumerate(drawn, 1):
        ends.append(descend(residuals, start))
        if tell is not None:
            tell(f"{residuals.model.words}: start {place} of {starts}")
    best = min(ends, key=lambda end: end.cost)
    same = [end for end in ends if _same(end, best)]
    others: list[Optimum] = []
    for end in sorted(ends, key=lambda end: end.cost):
        if not any(_same(end, other) for other in [best, *others]) and end.cost < 4.0 * best.cost:
            others.append(end)
    return SearchEnds(best, others, len(same), starts)


def descend(
    residuals: Residuals, start: Floats, moving: NDArray[np.bool_] | None = None, closeness: float = 1e-8
) -> Optimum:
    """The minimum next to a start. moving: which numbers may move, all where left out. closeness: relative."""
    moves = np.ones(len(start), np.bool_) if moving is None else moving
    if not moves.any():
        found = residuals(start)
        return Optimum(np.array(start), found, 0.5 * float(found @ found))

    def whole(part: Floats) -> Floats:
        shares = np.array(start, dtype=float)
        shares[moves] = part
        return shares

    done = least_squares(
        lambda part: residuals(whole(part)),
        np.clip(start[moves], 1e-6, 1.0 - 1e-6),
        jac=lambda part: residuals.slopes(whole(part), np.flatnonzero(moves)),
        bounds=(0.0, 1.0),
        x_scale=0.1,
        ftol=closeness,
        xtol=closeness,
        gtol=1e-12,
        max_nfev=60,
    )
    return Optimum(whole(done.x), done.fun, float(done.cost))


def _same(one: Optimum, other: Optimum) -> bool:
    near = abs(one.cost - other.cost) <= SAME_END * max(one.cost, other.cost) + 1e-24
    return bool(near and np.abs(one.shares - other.shares).max() <= 10.0 * SAME_END)
