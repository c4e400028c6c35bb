"""The section of a bench list that maps one stepper or peer, and what it comes to."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, Protocol

from frictionlab.bench.sections import SectionResult, cell
from frictionlab.bench.stability.problems import StabilityProblem
from frictionlab.bench.stability.record import StabilityMap

STABILITY_CAPTION = (
    "Colour is the true error of the mean friction at each step (or tolerance) and local rate; hatched: wrong, and "
    "told so (refused, failed, or within the error stated), crosses: wrong without a word; red: where the step taken "
    "times the rate is at (adaptive: near) its limit, dashed as predicted, dots as measured. Integrated: {what}."
)


class MappedSolver(Protocol):
    """A stepper or peer that can be put on the grid."""

    @property
    def name(self) -> str:
        """As in files."""

    @property
    def integrated(self) -> str:
        """What each point integrates, for the caption."""

    def problems(self) -> list[str]:
        """Those it can take."""

    def refusal(self) -> str | None:
        """Why it is not there; None when it is."""

    def map_of(self, problem: StabilityProblem, n: int) -> StabilityMap:
        """n settings by n rates."""


@dataclass(frozen=True)
class StabilityResult(SectionResult):
    """The maps of one stepper or peer, one a problem; missing: why there are none."""

    name: str
    title: str
    integrated: str
    maps: Sequence[StabilityMap]
    missing: str

    style: ClassVar[Mapping[str, Any]] = {"hatch.linewidth": 0.5, "savefig.dpi": 200}

    @property
    def caption(self) -> str:
        """How to read the picture."""
        return STABILITY_CAPTION.format(what=self.integrated)

    @property
    def left_out(self) -> Mapping[str, str]:
        """Itself, where there are no maps."""
        return {self.name: self.missing} if not self.maps else {}

    def records(self) -> list[dict[str, Any]]:
        """The points of every map, with the limits."""
        return [record for each in self.maps for record in _records(each)]

    def figure(self) -> Any:
        """A panel a problem."""
        if not self.maps:
            return None
        from frictionlab.bench.stability.chart import stability_figure

        return stability_figure(self.maps, self.title)

    def summary(self) -> str:
        """A line a problem: regions counted, limits predicted and measured."""
        if not self.maps:
            return f"{self.name}: {self.missing}"
        return "\n".join(_line(self.name, each) for each in self.maps)


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
        missing, maps = self.mapped.refusal(), list[StabilityMap]()
        if missing is None:
            for problem in (each for each in self.problems if each.name in self.mapped.problems()):
                tell(f"{self.name}: {problem.name}")
                maps.append(self.mapped.map_of(problem, self.grid))
        title = f"Stability of {self.mapped.name}"
        return StabilityResult(
            self.name, title, self.mapped.integrated, maps, missing or "takes none of these problems"
        )
