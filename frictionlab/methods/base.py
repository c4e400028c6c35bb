"""What every steady-state method is: it says what it accepts, refuses the rest with a reason, solves curves."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import ClassVar, Literal

from frictionlab.laws.base import FrictionLaw
from frictionlab.orbit.record import Orbit
from frictionlab.quantities import Floats, Record
from frictionlab.scene.scene import Scene

Status = Literal["ok", "refused", "failed", "not_unique", "killed"]


@dataclass(frozen=True)
class Answers:
    """What a method found on n scenes that differ in belt speed alone, one entry per scene.

    columns: table column -> n floats, NaN where the column does not apply. orbit(i): the orbit of scene i, made
    when asked for; None without one.
    """

    status: list[Status]
    reason: list[str]
    model: list[str]
    error_kind: list[str]
    columns: dict[str, Floats]
    orbit: Callable[[int], Orbit | None] = field(repr=False)


class Method(Record, ABC):
    """A way to find steady states; its fields are the parameters a study may set.

    Its sources are told as those of a law: by name in the docstring, their BibTeX entries in ``bibtex``.
    """

    name: ClassVar[str]
    bibtex: ClassVar[str] = ""

    @abstractmethod
    def refusal(self, scene: Scene, law: FrictionLaw) -> str | None:
        """Why this method cannot do this scene and law, as a sentence; None when it can."""

    @abstractmethod
    def solve(self, scenes: Sequence[Scene], law: FrictionLaw, tolerance: float) -> Answers:
        """Answer scenes that differ in belt speed alone, in ascending order; none of them refused."""

    @abstractmethod
    def cost(self, scene: Scene, law: FrictionLaw, tolerance: float) -> float:
        """Expected kernel time per point [s], once compiled; for planning only."""


def refused(reasons: Sequence[str]) -> Answers:
    """The answers of a method that cannot do these scenes."""
    n = len(reasons)
    return Answers(["refused"] * n, list(reasons), [""] * n, [""] * n, {}, lambda i: None)
