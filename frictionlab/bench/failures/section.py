"""The failure maps of one method or peer as a section of a bench list."""

from __future__ import annotations

import math
import statistics
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import astuple, dataclass, fields
from typing import Any, ClassVar

from frictionlab.bench.failures.measure import OUTCOMES, MapOutcome, MapTruth, PointOutcome, measure_map
from frictionlab.bench.peers.base import Peer
from frictionlab.bench.record import Contender
from frictionlab.bench.sections import SectionResult

MAPS_CAPTION = (
    "A panel at one value of its vertical axis is a curve over belt speed: shade is the error of the mean friction "
    "(left stated, right true), hatching is no number, a cross is a number that is wrong without a word."
)

CELLS = {field.name: field.name for field in fields(PointOutcome)} | {
    "stated": "stated_error",
    "true": "true_error",
}
"""The columns of a table of points, by the fields they hold."""


@dataclass(frozen=True)
class FailureResult(SectionResult):
    """What one method or peer came to on every map it was given.

    missing: why nothing was measured, of a peer that is not installed.
    """

    name: str
    title: str
    side: str
    outcomes: tuple[MapOutcome, ...]
    truths: tuple[MapTruth, ...]
    missing: str = ""

    style: ClassVar[Mapping[str, Any]] = {"hatch.linewidth": 0.5, "svg.fonttype": "none"}
    """Many panels: letters stay text."""

    def counts(self) -> Counter[str]:
        """How many points of all maps came to what."""
        return sum((outcome.counts() for outcome in self.outcomes), Counter[str]())

    @property
    def caption(self) -> str:
        """How to read the figure."""
        return MAPS_CAPTION

    @property
    def left_out(self) -> Mapping[str, str]:
        """Itself, where nothing was measured."""
        return {self.name: self.missing} if self.missing else {}

    def records(self) -> list[dict[str, Any]]:
        """Every point of every map."""
        return [
            {"map": outcome.drawn.name, "quantity": outcome.drawn.quantity, **_record(point)}
            for outcome in self.outcomes
            for point in outcome.points
        ]

    def figure(self) -> Any:
        """A row of panels for each map; none where every point is refused."""
        if not any(outcome.has_panel for outcome in self.outcomes):
            return None
        from frictionlab.bench.failures.chart import figure_of_maps

        counts = self.counts()
        title = f"{self.title}: {counts.total():,} points, {counts['silent']:,} wrong without a word"
        return figure_of_maps(title, list(zip(self.outcomes, self.truths, strict=True)), self.side)

    def summary(self) -> str:
        """Counts by map, those that are wrong without a word last."""
        if self.missing:
            return f"{self.name}: {self.missing}"
        wide = max(len(outcome.drawn.name) for outcome in self.outcomes)
        heads = [*map(word_of, OUTCOMES), "known to"]
        lines = [f"{self.title}: points", " " * wide + "".join(f"{head:>14}" for head in heads)]
        for outcome in self.outcomes:
            counts = outcome.counts()
            numbers = "".join(f"{counts[each]:>14,}" for each in OUTCOMES)
            lines.append(f"{outcome.drawn.name:<{wide}}{numbers}{_known_to(outcome):>14}")
        total = self.counts()
        lines.append(f"{'all':<{wide}}" + "".join(f"{total[each]:>14,}" for each in OUTCOMES))
        return "\n".join(lines)


def _record(point: PointOutcome) -> dict[str, Any]:
    values = zip(CELLS.values(), astuple(point), strict=True)
    return {name: "" if value != value else value for name, value in values}


def _known_to(outcome: MapOutcome) -> str:
    """The median of the references' own errors, over the points that have one."""
    errors = [point.reference_error for point in outcome.points if math.isfinite(point.reference_error)]
    return f"{statistics.median(errors):.0e}" if errors else ""


def word_of(outcome: str) -> str:
    """An outcome as it is said."""
    return {"not_unique": "not unique", "silent": "wrong, silent"}.get(outcome, outcome)


@dataclass(frozen=True)
class FailureSection:
    """The maps one method or peer is measured on, each with its own setting."""

    name: str
    label: str
    maps: tuple[tuple[MapTruth, Contender], ...]

    def measure(self, tell: Callable[[str], None]) -> FailureResult:
        """Solve every point of every map. What the references say is found once for all sections."""
        first = self.maps[0][1]
        solver = first.solvers[0][1]
        whose = (
            self.name,
            f"Failure maps of {self.label}{' (peer)' if first.side == 'peer' else ''}",
            first.side,
        )
        if isinstance(solver, Peer) and (missing := solver.missing()):
            return FailureResult(*whose, (), (), missing)
        for truth, _ in self.maps:
            tell(f"{self.name}: {truth.drawn.name}, references")
            truth.known  # noqa: B018  # found here, where it is told, and not within a time
        found = []
        for truth, contender in self.maps:
            tell(f"{self.name}: {truth.drawn.name}")
            found.append(measure_map(truth, contender))
        return FailureResult(*whose, tuple(found), tuple(truth for truth, _ in self.maps))


def by_label(
    maps: Sequence[tuple[MapTruth, Sequence[Contender]]],
) -> dict[str, list[tuple[MapTruth, Contender]]]:
    """The maps each contender is measured on, by its label, in the order of their first map."""
    found: dict[str, list[tuple[MapTruth, Contender]]] = {}
    for truth, contenders in maps:
        for contender in contenders:
            found.setdefault(contender.label, []).append((truth, contender))
    return found
