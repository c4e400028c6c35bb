"""Answers of a model at the points of measurements, and their distance from what was measured.

Least squares from many starts: where each ends, which end is best, and how many agree with it.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares
from scipy.stats import qmc

from frictionlab.analysis.fit.along_path import friction_along
from frictionlab.analysis.fit.free import Model
from frictionlab.analysis.fit.measured import Measurements
from frictionlab.laws.faults import CannotCompile
from frictionlab.runner.steady_state import steady_states
from frictionlab.scene.scenes import Scenes
from frictionlab.values.quantities import Floats

FIT_TOLERANCE = 1e-9
"""Asked of mean friction: far below what measurements tell, and below what difference quotients see."""
SLOPE_STEP = 1e-5
"""Share of a range by which a number is changed for a derivative."""
UNANSWERED_AS = 10.0
"""A point without a number counts as so many spreads of what was measured."""


@dataclass(eq=False)
class Residuals:
    """Differences of a model from measurements, row by row; it counts how often the model was asked.

    error: the largest of the numbers of the model. threads: derivatives that are computed at once. unanswered, why:
    rows without a number when last asked, and why the last one had none.
    """

    model: Model
    measured: Measurements
    threads: int = 1
    evaluations: int = 0
    error: float = 0.0
    unanswered: int = 0
    why: str = ""
    _known: dict[bytes, Floats] = field(default_factory=dict, repr=False)

    def __post_init__(self) -> None:
        values = self.measured.values
        self.spread = float(np.std(values)) or float(np.abs(values).max()) or 1.0
        self.weights = np.ones(len(values)) if self.measured.sigma is None else 1.0 / self.measured.sigma

    def said(self, shares: Floats) -> Floats:
        """Return what the model says, row by row; NaN where it has no number."""
        key = np.asarray(shares, dtype=float).tobytes()
        found = self._known.get(key)
        if found is None:
            if len(self._known) > 200:
                self._known.clear()
            self.evaluations += 1
            try:
                law, scene = self.model.at(shares)
                found = self._path(law) if self.measured.is_path else self._curve(law, scene)
            except CannotCompile:
                raise
            except (ValueError, ArithmeticError) as problem:  # numbers that make no law
                self.why = str(problem)
                found = np.full(len(self.measured.values), math.nan)
            self._known[key] = found
        return found

    def raw(self, shares: Floats) -> Floats:
        """Said less measured; ``UNANSWERED_AS`` spreads where nothing is said."""
        apart = self.said(shares) - self.measured.values
        self.unanswered = int(np.isnan(apart).sum())
        return np.where(np.isnan(apart), UNANSWERED_AS * self.spread, apart)

    def __call__(self, shares: Floats) -> Floats:
        """Return the same over the stated standard errors, where there are some."""
        return self.raw(shares) * self.weights

    def slopes(self, shares: Floats, numbers: Iterable[int] | None = None) -> Floats:
        """d(residual)/d(share), a column for each of these numbers, all where left out: differences inwards."""
        here = self(shares)

        def column(k: int) -> Floats:
            there = np.array(shares, dtype=float)
            there[k] += SLOPE_STEP if there[k] < 0.5 else -SLOPE_STEP
            return (self(there) - here) / (there[k] - shares[k])

        with ThreadPoolExecutor(self.threads) as pool:
            return np.column_stack([*pool.map(column, range(len(shares)) if numbers is None else numbers)])

    def _path(self, law: Any) -> Floats:
        table, found = self.measured.table, np.empty(len(self.measured.values))
        times, slips = (table[name].to_numpy(dtype=float) for name in ("time", "slip"))
        for piece in self.measured.pieces:
            found[piece] = friction_along(
                law, times[piece], slips[piece], float(self.measured.values[piece][0])
            )
        return found

    def _curve(self, law: Any, scene: Any) -> Floats:
        measured, found = self.measured, np.full(len(self.measured.values), math.nan)
        given = measured.table[measured.along].to_numpy(dtype=float)
        for changed, places in measured.groups:
            different, back = np.unique(given[places], return_inverse=True)
            here = Scenes(scene.with_(**changed) if changed else scene, different)
            part = steady_states(here, law, FIT_TOLERANCE, ["mean_friction"])
            numbers, statuses = part.numbers, part.text["status"]
            self.why = next(
                (part.text["reason"][i] for i, each in enumerate(statuses) if each != "ok"), self.why
            )
            found[places] = numbers["mean_friction"][back]
            self.error = max(self.error, float(np.nan_to_num(numbers["error"]).max()))
        return found


STARTS = 8
SAME_END = 1e-3
"""Ends agree where their sums of squares differ by less, relatively, and no share of a range by ten times it."""
ON_A_BOUND = 1e-4
"""Share of a range within which a number counts as on its end."""


@dataclass(frozen=True, eq=False)
class Optimum:
    """End of a search: shares of the ranges, residuals over their standard errors, half their sum of squares."""

    shares: Floats
    residuals: Floats
    cost: float


@dataclass(frozen=True, eq=False)
class SearchEnds:
    """Best of all ends, other minima, and how many starts ended at the best."""

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
        new = not any(_same(end, other) for other in [best, *others]) and end.cost < 4.0 * best.cost
        if new and np.isfinite(residuals.said(end.shares)).all():  # else its numbers make no law
            others.append(end)
    return SearchEnds(best, others, len(same), starts)


def descend(
    residuals: Residuals, start: Floats, moving: NDArray[np.bool_] | None = None, closeness: float = 1e-8
) -> Optimum:
    """Return the minimum next to a start. moving: which numbers may move, all where left out. closeness: relative."""
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
