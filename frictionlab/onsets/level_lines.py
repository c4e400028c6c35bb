"""Level lines of a function of two numbers: roots on the edges of a grid, followed from edge to edge.

Places are in steps of the grid, 0 ... n - 1 along each number. Where the function changes sign along an edge its root
is found there; between two roots of a cell the line is followed by roots across the chord, until it is as good as
straight, round turning points, too, and in several pieces. What crosses no edge of the grid is not seen.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from scipy.optimize import elementwise

from frictionlab.quantities import Floats

XTOL = 1e-7
"""Of a root, in steps of the grid."""
STRAIGHT = 5e-3
"""How far a line may leave its chords, as a share of the larger side of the grid."""
MOST_HALVINGS = 5
_APART = 1e-3  # of the places at which slopes are taken [steps of the grid]
_LONGEST = 60

OfTwoNumbers = Callable[[Floats], tuple[Floats, Floats]]
"""Values at places [n, 2], and bounds on their errors; NaN where there is none."""


class LevelLine(NamedTuple):
    """One piece: its places in order [n, 2], how far the line may be from each along both numbers, whether closed."""

    places: Floats
    errors: Floats
    closed: bool


def level_lines(function: OfTwoNumbers, known: Floats) -> list[LevelLine]:
    """The lines on which a function is zero. known: its values on the grid [second, first number]."""
    edges = _edges_crossed(known)
    if not edges:
        return []
    ends = np.array(edges, dtype=np.float64)
    roots = _roots(function, ends[:, 0], ends[:, 1])
    found = [np.asarray(each) for each in roots]
    place_of = {edge: at for at, edge in enumerate(edges)}
    chords = [
        pair for pair in _chords(function, known, place_of) if np.isfinite([found[at] for at in pair]).all()
    ]
    chains = [[found[at] for at in chain] for chain in _chains(chords)]
    chains = _followed(function, chains, STRAIGHT * (max(known.shape) - 1), np.array(known.shape[::-1]) - 1.0)
    return [LevelLine(line, _errors(function, line), _is_closed(line)) for line in map(np.array, chains)]


Edge = tuple[tuple[int, int], tuple[int, int]]


def _edges_crossed(known: Floats) -> list[Edge]:
    """The edges of the grid between places of different signs, as places (first, second)."""
    found: list[Edge] = []
    above = known >= 0.0
    for first, second in ((1, 0), (0, 1)):
        one, other = (
            (slice(None, -second or None), slice(None, -first or None)),
            (slice(second, None), slice(first, None)),
        )
        change = (above[one] != above[other]) & np.isfinite(known[one]) & np.isfinite(known[other])
        found += [((x, y), (x + first, y + second)) for y, x in np.argwhere(change).tolist()]
    return found


def _chords(function: OfTwoNumbers, known: Floats, edges: dict[Edge, int]) -> list[tuple[int, int]]:
    """Which roots a line joins: two on the edges of a cell; of four, by the sign in the middle of the cell."""
    chords, saddles = [], []
    for y in range(known.shape[0] - 1):
        for x in range(known.shape[1] - 1):
            a, b, c, d = (x, y), (x + 1, y), (x + 1, y + 1), (x, y + 1)
            around = [edges.get(edge) for edge in ((a, b), (b, c), (d, c), (a, d))]
            crossed = [at for at in around if at is not None]
            if len(crossed) == 2:
                chords.append((crossed[0], crossed[1]))
            elif len(crossed) == 4:
                saddles.append((x, y, crossed))
    if saddles:
        middle, _ = function(np.array([(x + 0.5, y + 0.5) for x, y, _ in saddles]))
        for (x, y, (low, right, high, left)), value in zip(saddles, middle.tolist(), strict=True):
            as_corner = (value >= 0.0) == (
                known[y, x] >= 0.0
            )  # the line leaves the corner (x, y) to the middle
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
    """The chains with places between theirs until every chord is as good as straight."""
    bent = [[True] * (len(chain) - 1) for chain in chains]
    for _ in range(MOST_HALVINGS):
        asked = [(i, k) for i, flags in enumerate(bent) for k, flag in enumerate(flags) if flag]
        if not asked:
            break
        one = np.array([chains[i][k] for i, k in asked])
        other = np.array([chains[i][k + 1] for i, k in asked])
        across = 0.5 * (other - one)[:, ::-1] * [-1.0, 1.0]
        low, high = (_inside(0.5 * (one + other) + sign * across, far) for sign in (-1.0, 1.0))
        roots = _roots(function, low, high)
        away = np.hypot(*(roots - 0.5 * (one + other)).T)
        for (i, k), root, distance in reversed(list(zip(asked, roots, away, strict=True))):
            on = bool(np.isfinite(distance))
            if on:
                chains[i].insert(k + 1, root)
            bent[i][k : k + 1] = [on and bool(distance > straight)] * (2 if on else 1)
    return chains


def _inside(places: Floats, far: Floats) -> Floats:
    return np.clip(places, 0.0, far)


def _roots(function: OfTwoNumbers, low: Floats, high: Floats) -> Floats:
    """The root between two places each; NaN where there is no change of sign."""

    def along(share: Floats, at: Floats) -> Floats:
        index = at.astype(int)
        return function(low[index] + share[:, None] * (high[index] - low[index]))[0]

    length = float(np.hypot(*(high - low).T).max())
    count = np.arange(len(low), dtype=np.float64)
    ends = np.zeros(len(low)), np.ones(len(low))
    found = elementwise.find_root(
        along,
        ends,
        args=(count,),
        tolerances={"xatol": XTOL / max(length, XTOL), "xrtol": 0.0},
        maxiter=_LONGEST,
    )
    share = np.where(found.success, found.x, np.nan)
    return np.asarray(low + share[:, None] * (high - low))


def _errors(function: OfTwoNumbers, line: Floats) -> Floats:
    """How far the line may be from each of its places: the error of the function over its slope, along both."""
    steps = _APART * np.array([[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]])
    around = np.maximum(line[None] + steps[:, None], 0.0)
    values, bounds = function(np.concatenate([line, around.reshape(-1, 2)]))
    beside = values[len(line) :].reshape(4, -1)
    width = np.stack([around[0, :, 0] - around[1, :, 0], around[2, :, 1] - around[3, :, 1]])
    slope = np.stack([beside[0] - beside[1], beside[2] - beside[3]]) / width
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray((bounds[: len(line)] * np.abs(slope) / (slope**2).sum(axis=0)).T + XTOL)


def _is_closed(line: Floats) -> bool:
    return len(line) > 2 and bool((line[0] == line[-1]).all())
