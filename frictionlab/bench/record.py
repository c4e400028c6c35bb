"""Who is measured against what, and one row of what comes of it.

What a bench list measures: curves and other sections, each with a table and a summary.
"""

from __future__ import annotations

import csv
import math
import re
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, ClassVar, Literal, NamedTuple, Protocol

from pydantic import BeforeValidator, Field

from frictionlab.bench.peers.base import Peer
from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import Method
from frictionlab.scene.scene import Scene
from frictionlab.values.quantities import Floats

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


AtLeastOne = Annotated[int, Field(strict=True, ge=1)]
FILLED: Any = Field(min_length=1)


def one_of(known: Mapping[str, Any]) -> BeforeValidator:
    """Reads a name in a list as what it stands for."""

    def named(name: Any) -> Any:
        if not isinstance(name, str) or name not in known:
            raise ValueError(f"must be one of {', '.join(map(repr, known))}")
        return known[name]

    return BeforeValidator(named)


class SectionResult(ABC):
    """What a section came to.

    caption: how to read its figure; style: of that, beside the style of all. left_out: what is not installed, with
    how to install it.
    """

    kind: ClassVar[str] = "section"
    style: ClassVar[Mapping[str, Any]] = {}
    name: str
    title: str
    caption: str
    left_out: Mapping[str, str] | None = None

    @property
    def notes(self) -> list[str]:
        """Sentences below its title."""
        return []

    @abstractmethod
    def records(self) -> Sequence[Mapping[str, Any]]:
        """The rows of its CSV file."""

    @abstractmethod
    def summary(self) -> str:
        """What stdout prints."""

    def write(self, folder: Path) -> list[Path]:
        """The CSV table, written where there are rows; the folder is there. Raises OSError."""
        path, records = folder / f"{file_stem(self.name)}.csv", self.records()
        if not records:
            return []
        with path.open("w", encoding="utf-8", newline="") as file:
            writer = csv.DictWriter(file, list(records[0]), lineterminator="\n")
            writer.writeheader()
            writer.writerows(records)
        return [path]


class Section(Protocol):
    """One part of a bench list, measured as a whole: what is finished when the user interrupts is kept."""

    @property
    def name(self) -> str:
        """Names its files and answers ``--only``."""

    def measure(self, tell: Callable[[str], None]) -> SectionResult:
        """Measure it, telling what is under way."""


def file_stem(name: str) -> str:
    """A name as a file may have it: runs of all but letters, digits, points, - and _ become one _.

    >>> file_stem("W4 soft lugre")
    'W4_soft_lugre'
    """
    return re.sub(r"[^\w.-]+", "_", name)


def cell(value: float) -> float | str:
    """A number as a CSV file holds it: empty where there is none."""
    return value if math.isfinite(value) else ""
