"""Wall time of a warm task: the least of repeated runs, and how they spread."""

from __future__ import annotations

import gc
import math
import time
from collections.abc import Callable
from typing import NamedTuple

import numpy as np


class Times(NamedTuple):
    """Least wall time [s] of repeated runs, their quartiles, and how many there were."""

    least: float
    quartiles: tuple[float, float, float]
    repeats: int

    def each_of(self, points: int) -> Times:
        """The same per point of so many."""
        low, middle, high = (quartile / points for quartile in self.quartiles)
        return Times(self.least / points, (low, middle, high), self.repeats)


NO_TIME = Times(math.nan, (math.nan,) * 3, 0)


def time_task(task: Callable[[], object], repeats: int, seconds: float) -> Times:
    """Run a task so many times, or for so long if that is less, but once at least; the caller has warmed it up."""
    spent: list[float] = []
    collecting = gc.isenabled()
    gc.disable()
    try:
        while not spent or (len(spent) < repeats and sum(spent) < seconds):
            start = time.perf_counter()
            task()
            spent.append(time.perf_counter() - start)
    finally:
        if collecting:
            gc.enable()
    low, middle, high = np.percentile(spent, (25, 50, 75)).tolist()
    return Times(min(spent), (low, middle, high), len(spent))
