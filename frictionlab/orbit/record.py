"""The record of one period of a steady state."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from frictionlab.quantities import Floats


@dataclass(frozen=True)
class Orbit:
    """One period of a steady state in smooth pieces, each sampled at the same Gauss-Lobatto nodes.

    tau [panels, nodes] increases; x, v, friction [panels, nodes] are complex (x1 + i x2), friction being the
    coefficient along the slip velocity (what resists); stick [panels] marks pieces at rest on the belt.
    """

    tau: Floats
    x: NDArray[np.complex128]
    v: NDArray[np.complex128]
    friction: NDArray[np.complex128]
    stick: NDArray[np.bool_]
