"""Combinations of numbers that measurements see, where they do not see the numbers themselves."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from frictionlab.printable import with_error
from frictionlab.quantities import Floats

LARGE = 0.5
"""Relative error of a combination that is not seen."""
PART = 0.3
SAME_PARTS = 1.25
"""Ratio of the parts of two numbers up to which they count as a product or a quotient."""


def unseen_sentence(names: Sequence[str], values: Floats, relative: Floats) -> str:
    """On the combination that is least seen; '' where all are. relative: covariance of the values over themselves."""
    if len(names) < 2 or not np.isfinite(relative).all():
        return ""
    sizes, ways = np.linalg.eigh(relative)
    way = ways[:, -1]
    parts = [int(part) for part in np.flatnonzero(np.abs(way) > PART)]
    if math.sqrt(max(sizes[-1], 0.0)) < LARGE or len(parts) < 2:
        return ""
    together = " and ".join(names[part] for part in parts)
    if len(parts) > 2 or not 1.0 / SAME_PARTS < abs(way[parts[0]] / way[parts[1]]) < SAME_PARTS:
        return f"a combination of {together} is not seen: they may change together"
    one, other = parts
    seen = np.zeros(len(names))
    seen[one], seen[other] = 1.0, -math.copysign(1.0, way[one] * way[other])
    value = float(values[one] * values[other] ** seen[other])
    error = abs(value) * math.sqrt(max(float(seen @ relative @ seen), 0.0))
    sign = "*" if seen[other] > 0 else "/"
    return f"only {names[one]}{sign}{names[other]} is seen: {with_error(value, error)}"
