"""What is known of the closed orbits of a curve: a row of numbers for each, under names.

Kernels fill a table: an array each would make them compile for minutes. Python reads the columns of it.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from frictionlab.compile.decorators import inner
from frictionlab.quantities import Floats

MEAN, ACROSS, ERROR, MAPS, STUCK, CLOSEST, COLUMNS = range(7)


class ClosedOrbits(NamedTuple):
    """Of each orbit [n] its mean friction, along the belt and across, the error of that, the maps it took, the share
    of the period at rest and the slowest slip.

    maps: 0 in closed form; negative where no orbit was found in so many. NaN all where none was looked for.
    """

    mean: Floats
    across: Floats
    error: Floats
    maps: Floats
    stuck: Floats
    closest: Floats

    @classmethod
    def of(cls, table: Any) -> ClosedOrbits:
        """Those of a table [n, COLUMNS]."""
        return cls(*np.asarray(table).T)

    @property
    def found(self) -> NDArray[np.bool_]:
        """Whether each is known."""
        return np.asarray(self.maps >= 0.0)


@inner
def write_orbit(row: Any, mean: Any, error: float, maps: float, rests: Any) -> None:
    """Fill the row of an orbit; rests: the share of the period at rest, and the slowest slip."""
    row[MEAN], row[ACROSS] = mean.real, mean.imag
    row[ERROR], row[MAPS] = error, maps
    row[STUCK], row[CLOSEST] = rests
