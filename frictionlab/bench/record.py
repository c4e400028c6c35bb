"""The record of a bench list: frozen, with every default filled in."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

from frictionlab.bench.peers.base import Peer
from frictionlab.bench.sections import Section
from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import Method
from frictionlab.quantities import Floats
from frictionlab.scene.scene import Scene


class UnknownCurve(Exception):
    """A curve asked for by a name that is not in the list."""


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
    """One curve: scenes that differ in belt speed alone, in ascending order, and who is measured on it."""

    name: str
    title: str
    scenes: tuple[Scene, ...]
    law: FrictionLaw
    contenders: tuple[Contender, ...]
    references: tuple[ReferenceSource, ...]

    def speeds(self) -> list[float]:
        """The belt speeds."""
        return [scene.belt_speed for scene in self.scenes]


@dataclass(frozen=True)
class Bench:
    """Workloads and sections, and how long each setting of a workload may be timed: so many repeats, or so many
    seconds if that is less.
    """

    name: str
    title: str
    workloads: tuple[Workload, ...]
    repeats: int
    seconds: float
    sections: tuple[Section, ...] = ()

    @property
    def names(self) -> list[str]:
        """Of all that is measured, curves first."""
        return [work.name for work in self.workloads] + [section.name for section in self.sections]

    def only(self, names: Sequence[str]) -> Bench:
        """The curves and sections of these names alone; all where none is named. Raises UnknownCurve."""
        if unknown := [name for name in names if name not in self.names]:
            part = "curve or section" if self.sections else "curve"
            raise UnknownCurve(f"no {part} '{unknown[0]}' in the list; there are {', '.join(self.names)}")
        return replace(
            self,
            workloads=tuple(work for work in self.workloads if not names or work.name in names),
            sections=tuple(section for section in self.sections if not names or section.name in names),
        )


@dataclass(frozen=True)
class ReferenceMeans:
    """Reference values: mean friction and its error at each point, NaN where there is none."""

    label: str
    kind: str
    means: Floats
    errors: Floats
