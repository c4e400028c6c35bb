"""How well a law foretells what it was not fitted to: blocks left out in turn, the law fitted to the rest."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from frictionlab.fitting.residuals import Residuals
from frictionlab.fitting.search import Optimum, descend
from frictionlab.quantities import Floats

FOLDS = 6
"""Parts that are left out in turn: whole blocks, neighbours together."""


@dataclass(frozen=True, eq=False)
class LeftOut:
    """Root mean square of what is foretold less measured, part by part: in that of the measured value."""

    squares: Floats

    @property
    def rms(self) -> float:
        """Over all parts."""
        return float(np.sqrt(self.squares.mean()))

    @property
    def error(self) -> float:
        """Its standard error, by the scatter between parts."""
        return float(self.squares.std(ddof=1) / np.sqrt(len(self.squares)) / (2.0 * self.rms or 1.0))

    def apart(self, other: LeftOut) -> tuple[float, float]:
        """How much larger the mean square is than another's, part by part, and the standard error of that."""
        more = self.squares - other.squares
        return float(more.mean()), float(more.std(ddof=1) / np.sqrt(len(more)))


def without_blocks(residuals: Residuals, best: Optimum, blocks: NDArray[np.int64]) -> LeftOut:
    """Of a model at its optimum."""
    count = int(blocks.max()) + 1
    parts = blocks * min(FOLDS, count) // count
    weights, squares = residuals.weights, []
    try:
        for part in np.unique(parts):
            own = parts == part
            residuals.weights = np.where(own, 0.0, weights)
            found = descend(residuals, best.shares)
            squares.append(float(np.mean(residuals.raw(found.shares)[own] ** 2)))
    finally:
        residuals.weights = weights
    return LeftOut(np.array(squares))
