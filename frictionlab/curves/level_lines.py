"""Level lines of a function of two numbers: roots on the edges of a grid, followed from edge to edge.

Places are in steps of the grid, 0 ... n - 1 along each number. Where the function changes sign along an edge its root
is found there; between two roots of a cell the line is followed by roots across the chord, until it is as good as
straight, round turning points, too, and in several pieces. Where a spline through the grid says that a line passes
between its places and crosses no edge, edges are added there. What neither shows is not seen.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from frictionlab.values.quantities import Floats

XTOL = 1e-7
"""Accuracy of a root, in steps of the grid."""
STRAIGHT = 5e-3
"""Largest distance of a line from its chords, as a share of the larger side of the grid."""
MOST_CHORDS_HALVED = 5
MOST_ADDED = 4
"""Edges added along each number, at most."""
_APART = 1e-3  # of the places at which slopes are taken [steps of the grid]
_LONGEST = 60
_FINE = 8  # places of the spline to a step of the grid

OfTwoNumbers = Callable[[Floats], tuple[Floats, Floats]]
"""Values at places [n, 2], and bounds on their errors; NaN where there is none."""


class LevelLine(NamedTuple):
    """One piece: its places in order [n, 2], how far the line may be from each along both numbers, whether closed."""

    places: Floats
    errors: Floats
    closed: bool


def level_lines(function: OfTwoNumbers, known: Floats, level: float = 0.0) -> list[LevelLine]:
    """Return the lines on which a function has a level.

    known: its values on the grid [second, first number], or values near them: beside a line they are found anew.
    """
    function = _found_once(function, level)
    grid = _with_hidden(_Grid.of(known - level), function)
    edges = grid.edges_crossed()
    if not edges:
        return []
    low, high = (grid.at([edge[end] for edge in edges]) for end in (0, 1))
    found = [*_roots(function, low, high)]
    place_of = {edge: at for at, edge in enumerate(edges)}
    chords = [
        pair for pair in _chords(function, grid, place_of) if np.isfinite([found[at] for at in pair]).all()
    ]
    chains = [[found[at] for at in chain] for chain in _chains(chords)]
    far = np.array(known.shape[::-1]) - 1.0
    chains = _followed(function, chains, STRAIGHT * float(far.max()), far)
    return [LevelLine(line, _errors(function, line, far), _is_closed(line)) for line in map(np.array, chains)]


def _found_once(function: OfTwoNumbers, level: float) -> OfTwoNumbers:
    """Return the function over its level, which is asked once for each place."""
    found: dict[tuple[float, ...], tuple[float, float]] = {}

    def remembered(places: Floats) -> tuple[Floats, Floats]:
        asked = [tuple(place) for place in np.round(places, 12).tolist()]
        if new := [*dict.fromkeys(place for place in asked if place not in found)]:
            found.update(zip(new, zip(*function(np.array(new)), strict=True), strict=True))
        values, bounds = np.array([found[place] for place in asked]).reshape(-1, 2).T
        return values - level, bounds

    return remembered


# --- the grid -------------------------------------------------------------------------------------------------------

Corner = tuple[int, int]
GridEdge = tuple[Corner, Corner]


class _Grid(NamedTuple):
    """Values [second, first number] at the crossings of lines x and y [steps of the grid]."""

    x: Floats
    y: Floats
    known: Floats

    @classmethod
    def of(cls, known: Floats) -> _Grid:
        return cls(np.arange(known.shape[1], dtype=float), np.arange(known.shape[0], dtype=float), known)

    def at(self, corners: list[Corner]) -> Floats:
        x, y = np.array(corners).reshape(-1, 2).T
        return np.stack([self.x[x], self.y[y]], axis=1)

    def edges_crossed(self) -> list[GridEdge]:
        """Return the edges between corners of different signs, as corners (first, second)."""
        found: list[GridEdge] = []
        known, above = self.known, self.known >= 0.0
        for first, second in ((1, 0), (0, 1)):
            one, other = (
                (slice(None, -second or None), slice(None, -first or None)),
                (slice(second, None), slice(first, None)),
            )
            change = (above[one] != above[other]) & np.isfinite(known[one]) & np.isfinite(known[other])
            found += [((x, y), (x + first, y + second)) for y, x in np.argwhere(change).tolist()]
        return found

    def settled(self, function: OfTwoNumbers) -> _Grid:
        """Return the grid with the function's own values at all corners beside a line."""
        known, found = self.known.copy(), set[Corner]()
        while (
            beside := {corner for edge in _Grid(self.x, self.y, known).edges_crossed() for corner in edge}
            - found
        ):
            corners = sorted(beside)
            known[tuple(np.array(corners).T[::-1])], _ = function(self.at(corners))
            found |= beside
        return _Grid(self.x, self.y, known)

    def with_lines(self, function: OfTwoNumbers, x: list[float], y: list[float]) -> _Grid:
        """Return the grid with more lines."""
        wide = _Grid(np.union1d(self.x, x), np.union1d(self.y, y), np.empty((0, 0)))
        known = np.full((len(wide.y), len(wide.x)), np.nan)
        known[np.ix_(np.isin(wide.y, self.y), np.isin(wide.x, self.x))] = self.known
        new = np.isin(wide.x, self.x, invert=True) | np.isin(wide.y, self.y, invert=True)[:, None]
        known[new], _ = function(wide.at(np.argwhere(new)[:, ::-1].tolist()))
        return _Grid(wide.x, wide.y, known)


def _with_hidden(grid: _Grid, function: OfTwoNumbers) -> _Grid:
    """Return the grid, settled, with lines through places of a sign that none of the corners around them has."""
    from scipy.interpolate import RectBivariateSpline
    from scipy.ndimage import distance_transform_edt, maximum_filter

    grid = grid.settled(function)
    there = np.isfinite(grid.known)
    if min(grid.known.shape) < 4 or not there.any():
        return grid
    nearest = distance_transform_edt(~there, return_distances=False, return_indices=True)
    spline = RectBivariateSpline(grid.y, grid.x, grid.known[tuple(nearest)])
    y, x = (np.linspace(0.0, line[-1], _FINE * (len(line) - 1) + 1) for line in (grid.y, grid.x))
    fine = spline(y, x)
    sign = np.sign(grid.known)
    cells = np.minimum(y.astype(int), len(grid.y) - 2)[:, None], np.minimum(x.astype(int), len(grid.x) - 2)
    around = np.stack([sign[cells[0] + below, cells[1] + beside] for below in (0, 1) for beside in (0, 1)])
    hidden = (np.abs(around.sum(axis=0)) == 4.0) & (np.sign(fine) != around[0])  # NaN is neither
    depth = np.where(hidden, np.abs(fine), 0.0)
    deepest = np.argwhere(hidden & (depth == maximum_filter(depth, 2 * _FINE + 1)))[:MOST_ADDED]
    if not len(deepest):
        return grid
    places = np.stack([x[deepest[:, 1]], y[deepest[:, 0]]], axis=1)
    values, _ = function(places)
    seen = [at for at, value in enumerate(values) if np.sign(value) == np.sign(fine[tuple(deepest[at])])]
    if not seen:
        return grid
    return grid.with_lines(function, *places[seen].T.tolist()).settled(function)


# --- from root to root ----------------------------------------------------------------------------------------------


def _chords(function: OfTwoNumbers, grid: _Grid, edges: dict[GridEdge, int]) -> list[tuple[int, int]]:
    """Pair the roots that a line joins: two on the edges of a cell; of four, by the sign in its middle."""
    chords, saddles = [], []
    for y in range(len(grid.y) - 1):
        for x in range(len(grid.x) - 1):
            a, b, c, d = (x, y), (x + 1, y), (x + 1, y + 1), (x, y + 1)
            around = [edges.get(edge) for edge in ((a, b), (b, c), (d, c), (a, d))]
            crossed = [at for at in around if at is not None]
            if len(crossed) == 2:
                chords.append((crossed[0], crossed[1]))
            elif len(crossed) == 4:
                saddles.append((a, c, crossed))
    if saddles:
        middle, _ = function(
            0.5 * (grid.at([a for a, _, _ in saddles]) + grid.at([c for _, c, _ in saddles]))
        )
        for ((x, y), _, (low, right, high, left)), value in zip(saddles, middle.tolist(), strict=True):
            # the line leaves the corner (x, y) to the middle
            as_corner = (value >= 0.0) == (grid.known[y, x] >= 0.0)
            chords += [(low, right), (high, left)] if as_corner else [(low, left), (right, high)]
    return chords


def _chains(chords: list[tuple[int, int]]) -> list[list[int]]:
    """Chords end to end; a closed chain has its first place again at its end."""
    beside: dict[int, list[int]] = {}
    for one, other in chords:
        beside.setdefault(one, []).append(other)
        beside.setdefault(other, []).append(one)
    left, chains = set(beside), []
    for start in sorted(beside, key=lambda at: len(beside[at])):  # ends first
        if start not in left:
            continue
        chain = [start]
        left.discard(start)
        while onward := [at for at in beside[chain[-1]] if at in left]:
            chain.append(onward[0])
            left.discard(onward[0])
        closed = len(chain) > 2 and start in beside[chain[-1]]
        chains.append([*chain, start] if closed else chain)
    return chains


def _followed(
    function: OfTwoNumbers, chains: list[list[Floats]], straight: float, far: Floats
) -> list[list[Floats]]:
    """Return the chains with places between theirs until every chord is as good as straight."""
    bent = [[True] * (len(chain) - 1) for chain in chains]
    for _ in range(MOST_CHORDS_HALVED):
        asked = [(i, k) for i, flags in enumerate(bent) for k, flag in enumerate(flags) if flag]
        if not asked:
            break
        one = np.array([chains[i][k] for i, k in asked])
        other = np.array([chains[i][k + 1] for i, k in asked])
        across = 0.5 * (other - one)[:, ::-1] * [-1.0, 1.0]
        low, high = (np.clip(0.5 * (one + other) + sign * across, 0.0, far) for sign in (-1.0, 1.0))
        roots = _roots(function, low, high)
        away = np.hypot(*(roots - 0.5 * (one + other)).T)
        for (i, k), root, distance in reversed(list(zip(asked, roots, away, strict=True))):
            on = bool(np.isfinite(distance))
            if on:
                chains[i].insert(k + 1, root)
            bent[i][k : k + 1] = [on and bool(distance > straight)] * (2 if on else 1)
    return chains


def _roots(function: OfTwoNumbers, low: Floats, high: Floats) -> Floats:
    """Return the root between two places each; NaN where there is no change of sign."""
    from scipy.optimize.elementwise import find_root

    def along(share: Floats, at: Floats) -> Floats:
        index = at.astype(int)
        return function(low[index] + share[:, None] * (high[index] - low[index]))[0]

    length = float(np.hypot(*(high - low).T).max())
    count = np.arange(len(low), dtype=np.float64)
    ends = np.zeros(len(low)), np.ones(len(low))
    found = find_root(
        along,
        ends,
        args=(count,),
        tolerances={"xatol": XTOL / max(length, XTOL), "xrtol": 0.0},
        maxiter=_LONGEST,
    )
    share = np.where(found.success, found.x, np.nan)
    return np.asarray(low + share[:, None] * (high - low))


def _errors(function: OfTwoNumbers, line: Floats, far: Floats) -> Floats:
    """Estimate how far the line is from each of its places: the error of the function over its slope, along both."""
    inward = np.where(line > 0.5 * far, -_APART, _APART)
    beside = [line + inward * axis for axis in np.eye(2)]
    values, bounds = function(np.concatenate([line, *beside]))
    here, first, second = values.reshape(3, -1)
    slope = np.stack([first - here, second - here]) / inward.T
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray((bounds[: len(line)] * np.abs(slope) / (slope**2).sum(axis=0)).T + XTOL)


def _is_closed(line: Floats) -> bool:
    return len(line) > 2 and bool((line[0] == line[-1]).all())
