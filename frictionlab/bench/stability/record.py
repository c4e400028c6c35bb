"""A point of a stability map, the region it lies in, and the map of one stepper."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, NamedTuple

from frictionlab.bench.stability.problems import MU, StabilityProblem

Region = Literal["right", "wrong_and_said", "wrong_and_silent"]
REGIONS: tuple[Region, ...] = ("right", "wrong_and_said", "wrong_and_silent")
WRONG = 0.01 * MU
"""A true error above this is wrong, whatever was stated or asked."""
TIMES_ASKED = 10.0
"""A peer, which states no error, may be off by so many times the tolerance that it was asked for."""


class MapPoint(NamedTuple):
    """One setting at one rate: the step taken (a usual one), the true error, and the one stated or allowed.

    held: the step times the frequency of the mass held by its bristles, 0 where that limits nothing.
    """

    value: float
    rate: float
    step: float
    status: str
    reason: str
    error: float
    stated: float
    held: float = 0.0

    @property
    def region(self) -> Region:
        """Whether it is right, and where not, whether anything tells."""
        if self.status != "ok":
            return "wrong_and_said"
        if not self.error <= self.stated:
            return "wrong_and_silent"
        return "right" if self.error <= WRONG else "wrong_and_said"


@dataclass(frozen=True)
class StepLimit:
    """Largest step times rate, infinite where any step will do.

    held: a limit of the step times the frequency of a mass held by its bristles, infinite where there is none.
    """

    predicted: float
    measured: float
    held: float = math.inf


@dataclass(frozen=True)
class StabilityMap:
    """A grid of points of one stepper on one problem; settings and rates ascend, all settings of a rate together."""

    problem: StabilityProblem
    setting: Literal["steps", "tolerance"]
    limit: StepLimit
    settings: Sequence[float]
    rates: Sequence[float]
    points: Sequence[MapPoint]

    def counts(self) -> dict[Region, int]:
        """How many points lie in each region."""
        found = Counter(point.region for point in self.points)
        return {region: found[region] for region in REGIONS}
