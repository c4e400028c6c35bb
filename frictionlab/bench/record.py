"""Who is measured against what, and one row of what comes of it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal, NamedTuple

from frictionlab.bench.peers.base import Peer
from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import Method
from frictionlab.quantities import Floats
from frictionlab.scene.scene import Scene

BENCH_STATUSES = ("ok", "refused", "failed", "not_unique")


@dataclass(frozen=True)
class BenchSetting:
    """A setting of a solver: the quantity that is varied, its value, and the tolerance."""

    quantity: str
    value: float
    tolerance: float

    def __str__(self) -> str:
        """``tolerance 1e-06``, or ``as is`` where nothing is varied."""
        return f"{self.quantity} {self.value:g}" if self.quantity else "as is"


@dataclass(frozen=True)
class Contender:
    """A method or a peer under one label, with one solver per setting; points: of the curve, None for all."""

    label: str
    kind: str
    solvers: tuple[tuple[BenchSetting, Method | Peer], ...]
    points: int | None

    @property
    def side(self) -> Literal["method", "peer"]:
        """Whether it is a method of frictionlab or a peer."""
        return "peer" if isinstance(self.solvers[0][1], Peer) else "method"

    def missing(self) -> str | None:
        """How to install a peer that is not there."""
        solver = self.solvers[0][1]
        return solver.missing() if isinstance(solver, Peer) else None


@dataclass(frozen=True)
class ReferenceSource:
    """The source of reference values: a method or peer at a small tolerance, or values from a file.

    kind: of the method or peer; empty for values, which are by belt speed. tolerance: asked of the solver, or the
    error of the values.
    """

    label: str
    kind: str
    solver: Method | Peer | None
    tolerance: float
    values: dict[float, float]


@dataclass(frozen=True)
class Workload:
    """Scenes that differ in belt speed alone, in ascending order, and who is measured on them.

    repeats, seconds: how long each setting may be timed: so many times, or so long if that is less.
    """

    scenes: tuple[Scene, ...]
    law: FrictionLaw
    contenders: tuple[Contender, ...]
    references: tuple[ReferenceSource, ...]
    repeats: int
    seconds: float

    def speeds(self) -> list[float]:
        """The belt speeds."""
        return [scene.belt_speed for scene in self.scenes]

    def missing(self) -> dict[str, str]:
        """The peers that are not installed, by label, with how to install them."""
        return {each.label: told for each in self.contenders if (told := each.missing())}


@dataclass(frozen=True)
class ReferenceMeans:
    """Reference values: mean friction and its error at each point, NaN where there is none."""

    label: str
    kind: str
    means: Floats
    errors: Floats


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


@dataclass(frozen=True)
class Row:
    """One contender at one setting on one workload; points: those it was given, times: per point that has an answer.

    model: of a reduced model for its mean friction alone; mean: for the mean friction and its error, of a reduced
    model the price of its error included; whole: with every other column; first: processor time [s] of the
    whole curve where no kernel is compiled yet, NaN where that was not measured. ``covered``: points whose
    stated error, with the reference's own, covers their error; None without a reference, and for a peer, which states
    none.
    """

    contender: Contender
    setting: BenchSetting
    points: int
    counts: dict[str, int]
    reason: str
    largest: float
    median: float
    stated: float
    covered: int | None
    mean: Times
    whole: Times
    reference: ReferenceMeans | None
    model: Times = NO_TIME
    first: float = math.nan

    @property
    def error_alone(self) -> float:
        """Seconds per point that a reduced model's stated error costs; NaN of others."""
        return self.mean.least - self.model.least
