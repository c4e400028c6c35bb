"""Errors of fitted numbers: the naive ones, which take residuals for independent, and those from blocks left out.

Leaving a block b out moves the optimum by (J'J - J_b'J_b)^-1 J_b' r_b to first order (J: slopes, r: residuals); the
jackknife over blocks (Quenouille, 1956; Tukey, 1958; for dependent data Kunsch, 1989) makes an error of these moves.

Measurements in blocks that know nothing of each other: given, cycles of a path, or runs of alike residuals.

Combinations of numbers that measurements see, where they do not see the numbers themselves.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.stats import t

from frictionlab.analysis.fit.measured import Measurements
from frictionlab.values.quantities import Floats

FEWEST, MOST = 4, 60
"""Blocks that are cut where none are given."""
TIMES_AS_LONG = 4.0
"""A block against the length over which residuals are correlated."""


def blocks_of(measured: Measurements, residuals: Floats) -> tuple[NDArray[np.int64], str]:
    """Return the block of each row, from 0, and a word on where it is from."""
    if "block" in measured.table:
        return np.unique(measured.table["block"].astype(str), return_inverse=True)[1], "given"
    if measured.is_path and (cycles := _cycles(measured)) is not None:
        return cycles, "cycles of the slip"
    order = np.argsort(measured.table[measured.along].to_numpy(dtype=float), kind="stable")
    length = correlation_length(residuals[order])
    length = TIMES_AS_LONG * length if length > 1.0 else 1.0
    most = MOST if measured.is_path else len(residuals)
    count = int(np.clip(len(residuals) / length, min(FEWEST, len(residuals)), most))
    cut = np.empty(len(residuals), np.int64)
    cut[order] = np.arange(len(residuals)) * count // len(residuals)
    return cut, "runs of correlated residuals" if count < len(residuals) else "single points"


def autocorrelation(residuals: Floats, most: int) -> Floats:
    """Compute the autocorrelation of residuals in their order, at the lags from 0 to this one."""
    apart = residuals - residuals.mean()
    size = 1 << (2 * len(apart) - 1).bit_length()
    spectrum = np.abs(np.fft.rfft(apart, size)) ** 2
    found = np.fft.irfft(spectrum, size)[: most + 1]
    return np.asarray(found / found[0]) if found[0] > 0.0 else np.eye(1, most + 1)[0]


def correlation_length(residuals: Floats) -> float:
    """One and twice the sum of the autocorrelation up to its first value below 0: samples that count as one.

    One where neighbours are no more alike than independent ones may be by chance.
    """
    if len(residuals) < 4:
        return 1.0
    found = autocorrelation(residuals, len(residuals) // 2)[1:]
    if found[0] < 2.0 / math.sqrt(len(residuals)):
        return 1.0
    below = np.flatnonzero(found < 0.0)
    return 1.0 + 2.0 * float(found[: below[0] if below.size else len(found)].sum())


def _cycles(measured: Measurements) -> NDArray[np.int64] | None:
    """Whole swings of the slip about its mean, where it has several; a start before the first belongs to that."""
    slip = measured.table["slip"].to_numpy(dtype=float)
    swing = np.ptp(slip)
    high, low = slip.mean() + 0.25 * swing, slip.mean() - 0.25 * swing
    side = np.where(slip > high, 1, np.where(slip < low, -1, 0))
    known = np.flatnonzero(side)
    rises = known[1:][(side[known[1:]] == 1) & (side[known[:-1]] == -1)]
    if len(rises) < FEWEST:
        return None
    cycle = np.searchsorted(rises, np.arange(len(slip)), side="right") - 1
    last = len(rises) - 1
    return np.clip(cycle, 0, last - 1 if last > 0 else 0).astype(np.int64)


LEVEL = 0.95
"""Share of fits whose interval holds the true number."""
UNSEEN = 1e-10
"""Share of the largest curvature below which a direction is not seen at all: its error is that of this share."""


@dataclass(frozen=True, eq=False)
class Covariances:
    """Covariances of the shares of the ranges. naive: of independent residuals of one size; by_blocks: by jackknife.

    scale: variance of a residual over its stated one. quantile: of each number, standard errors of a two-sided
    interval of ``LEVEL``, by Student's distribution for as many blocks as decide it (Satterthwaite, 1946).
    """

    naive: Floats
    by_blocks: Floats
    scale: float
    quantile: Floats

    @property
    def inflation(self) -> Floats:
        """Errors from blocks over the naive ones; 1 of what is not seen."""
        naive, blocks = np.sqrt(np.diag(self.naive)), np.sqrt(np.diag(self.by_blocks))
        seen = (naive < 1.0) & (naive > 0.0)
        return np.divide(blocks, naive, out=np.ones(len(naive)), where=seen)


def covariances(slopes: Floats, residuals: Floats, blocks: NDArray[np.int64], stated: bool) -> Covariances:
    """From the slopes and residuals at the optimum. stated: whether residuals are over stated standard errors."""
    count, size = slopes.shape
    rest = max(count - size, 1)
    scale = 1.0 if stated else float(residuals @ residuals) / rest
    sizes, ways = np.linalg.eigh(slopes.T @ slopes)
    least = UNSEEN * max(float(sizes[-1]), 1e-300)
    seen, variances = sizes > least, scale / np.maximum(sizes, least)
    parts, own = [np.flatnonzero(blocks == block) for block in np.unique(blocks)], slopes @ ways[:, seen]
    curvature, moves = own.T @ own, []
    for rows in parts:
        part = own[rows]
        moves.append(
            np.linalg.solve(curvature - part.T @ part + least * np.eye(seen.sum()), part.T @ residuals[rows])
        )
    moved, number = np.array(moves) - np.mean(moves, axis=0), len(parts)
    scatter = (number - 1) / number * moved.T @ moved
    whole = np.diag(np.where(seen, 0.0, variances))
    whole[np.ix_(seen, seen)] = scatter
    naive, by_blocks = ways @ np.diag(variances) @ ways.T, ways @ whole @ ways.T
    pull = own / sizes[seen] @ ways[:, seen].T  # of each residual on each number
    shares = np.array([(pull[rows] ** 2).sum(axis=0) for rows in parts])
    squares = (shares**2).sum(axis=0)
    deciding = np.divide(
        shares.sum(axis=0) ** 2, squares, out=np.full(size, float(number)), where=squares > 0.0
    )
    return Covariances(naive, by_blocks, scale, t.ppf(0.5 + 0.5 * LEVEL, np.maximum(deciding - 1.0, 1.0)))
