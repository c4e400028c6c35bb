"""The section of a bench list that maps one stepper or peer, and what it comes to."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

from pydantic import Field

from frictionlab.bench.record import FILLED, SectionResult, cell, one_of
from frictionlab.bench.stability_grid import PROBLEMS, MappedSolver, StabilityMap, StabilityProblem
from frictionlab.bench.stability_solvers import MAPPED_PEERS, MAPPED_STEPPERS
from frictionlab.values.quantities import Record

STABILITY_CAPTION = (
    "Colour is the true error of the mean friction at each step (or tolerance) and local rate; hatched: wrong, and "
    "told so (refused, failed, or within the error stated), crosses: wrong without a word; red: where the step taken "
    "times the rate is at (adaptive: near) its limit, dashed as predicted, dots as measured. Integrated: {what}."
)


@dataclass(frozen=True)
class StabilityResult(SectionResult):
    """The maps of one stepper or peer, one a problem; none where it is left out."""

    name: str
    title: str
    caption: str
    maps: Sequence[StabilityMap]
    left_out: Mapping[str, str] | None = None

    style: ClassVar[Mapping[str, Any]] = {"hatch.linewidth": 0.5, "savefig.dpi": 200}

    def records(self) -> list[dict[str, Any]]:
        """The points of every map, with the limits."""
        return [record for each in self.maps for record in _records(each)]

    def summary(self) -> str:
        """A line a problem: regions counted, limits predicted and measured."""
        lines = [_line(self.name, each) for each in self.maps]
        return "\n".join(lines or [f"{name}: {why}" for name, why in (self.left_out or {}).items()])


def _line(name: str, drawn: StabilityMap) -> str:
    counts = ", ".join(f"{n} {region.replace('_', ' ')}" for region, n in drawn.counts().items())
    limit = drawn.limit
    bound = (
        f"step*rate at most {limit.measured:.3f} (predicted {limit.predicted:.3f})"
        if math.isfinite(limit.predicted) or math.isfinite(limit.measured)
        else "no step is too long"
    )
    return f"{name}, {drawn.problem.name}: {len(drawn.points)} points: {counts}; {bound}"


def _records(drawn: StabilityMap) -> Iterator[dict[str, Any]]:
    """The points as the CSV holds them; empty where there is no number, or no limit."""
    limit = drawn.limit
    for point in drawn.points:
        yield {
            "problem": drawn.problem.name,
            "setting": drawn.setting,
            "value": point.value,
            "rate": point.rate,
            "step": cell(point.step),
            "step_times_rate": cell(point.step * point.rate),
            "predicted_limit": cell(limit.predicted),
            "measured_limit": cell(limit.measured),
            "status": point.status,
            "error": cell(point.error),
            "stated": cell(point.stated),
            "region": point.region,
            "reason": point.reason,
        }


@dataclass(frozen=True)
class StabilitySection:
    """One stepper or peer on some problems, n settings by n rates."""

    mapped: MappedSolver
    problems: tuple[StabilityProblem, ...]
    grid: int

    @property
    def name(self) -> str:
        """That of its files."""
        return f"stability_{self.mapped.name}"

    def measure(self, tell: Callable[[str], None]) -> StabilityResult:
        """Map every problem that it can take."""
        missing, maps = self.mapped.missing(), list[StabilityMap]()
        for problem in self.problems if not missing else ():
            if problem.name in self.mapped.problems:
                tell(f"{self.name}: {problem.name}")
                maps.append(self.mapped.map_of(problem, self.grid))
        left_out = None if maps else {self.name: missing or "takes none of these problems"}
        caption = STABILITY_CAPTION.format(what=self.mapped.integrated)
        return StabilityResult(self.name, f"Stability of {self.mapped.name}", caption, maps, left_out)


class StabilityMaps(Record):
    """Which steppers and peers, all where neither is named; on which problems; a grid of how many by how many."""

    steppers: Annotated[tuple[Annotated[Any, one_of(MAPPED_STEPPERS)], ...], FILLED] = ()
    peers: Annotated[tuple[Annotated[Any, one_of(MAPPED_PEERS)], ...], FILLED] = ()
    problems: Annotated[tuple[Annotated[Any, one_of(PROBLEMS)], ...], FILLED] = (*PROBLEMS.values(),)
    grid: Annotated[int, Field(strict=True, ge=2)] = 70
    """Settings, and rates: about 5,000 points a stepper and problem."""

    def sections(self) -> list[StabilitySection]:
        """One for each stepper and peer."""
        named = (*self.steppers, *self.peers) or (*MAPPED_STEPPERS.values(), *MAPPED_PEERS.values())
        return [StabilitySection(each, self.problems, self.grid) for each in named]
