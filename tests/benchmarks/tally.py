"""What counts of random scenes share: what became of each, and how their numbers are drawn."""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import dataclass, field

import numpy as np


class TooSlow(Exception):
    """The integration from outside would take too long."""


@dataclass
class Tally:
    """What became of the scenes."""

    found: Counter[str] = field(default_factory=Counter)
    compared: Counter[str] = field(default_factory=Counter)
    wrong: list[str] = field(default_factory=list)
    seconds: list[float] = field(default_factory=list)


def log_uniform(rng: np.random.Generator, low: float, high: float) -> float:
    """Between two positive numbers, their logarithm uniform."""
    return float(math.exp(rng.uniform(math.log(low), math.log(high))))
