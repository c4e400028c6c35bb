"""Errors of fitted numbers: the naive ones, which take residuals for independent, and those from blocks left out.

Leaving a block b out moves the optimum by (J'J - J_b'J_b)^-1 J_b' r_b to first order (J: slopes, r: residuals); the
jackknife over blocks (Quenouille, 1956; Tukey, 1958; for dependent data Kunsch, 1989) makes an error of these moves.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.stats import t

from frictionlab.quantities import Floats

LEVEL = 0.95
"""Of every interval."""
UNSEEN = 1e-10
"""Share of the largest curvature below which a direction is not seen at all: its error is that of this share."""


@dataclass(frozen=True, eq=False)
class Covariances:
    """Of the shares of the ranges. naive: residuals independent, of one size; by_blocks: by the jackknife.

    scale: variance of a residual over its stated one; quantile: standard errors of a two-sided interval of ``LEVEL``.
    """

    naive: Floats
    by_blocks: Floats
    scale: float
    quantile: float

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
    return Covariances(naive, by_blocks, scale, float(t.ppf(0.5 + 0.5 * LEVEL, max(number - 1, 1))))
