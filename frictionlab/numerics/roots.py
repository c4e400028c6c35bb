"""Zeros of many monotone functions at once."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from frictionlab.quantities import Floats


def monotone_root(function: Callable[..., Floats], low: Floats, high: Floats, *rows: Floats) -> Floats:
    """Where a function of each row crosses zero between low and high, to rounding; the nearer end where it does not.

    function(x, *rows) is elementwise: it is called with the rows that are not found yet. Chandrupatla's method, as
    scipy has it.
    """
    from scipy.optimize.elementwise import find_root

    found = find_root(function, (low, high), args=rows)
    (left, right), (below, above) = found.bracket, found.f_bracket
    nearer = np.where(np.abs(below) < np.abs(above), left, right)
    return np.where(found.success, found.x, nearer)
