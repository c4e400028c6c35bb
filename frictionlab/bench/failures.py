"""The failure maps of one method or peer as a section of a bench list."""

from __future__ import annotations

import math
import statistics
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import astuple, dataclass, fields
from typing import Any, ClassVar

from frictionlab.bench.failure_maps import OUTCOMES, MapOutcome, MapTruth, PointOutcome, measure_map
from frictionlab.bench.record import Contender, SectionResult, file_stem

MAPS_CAPTION = (
    "A panel at one value of its vertical axis is a curve over belt speed: shade is the error of the mean friction "
    "(left stated, right true), hatching is no number, a cross is a number that is wrong without a word."
)

CELLS = {each.name: each.name for each in fields(PointOutcome)} | {
    "stated": "stated_error",
    "true": "true_error",
}
"""The columns of a table of points, by the fields they hold."""


@dataclass(frozen=True)
class FailureResult(SectionResult):
    """What one method or peer came to on every map it was given; nothing where it is left out."""

    name: str
    title: str
    side: str
    outcomes: tuple[MapOutcome, ...] = ()
    truths: tuple[MapTruth, ...] = ()
    left_out: Mapping[str, str] | None = None

    style: ClassVar[Mapping[str, Any]] = {"hatch.linewidth": 0.5, "svg.fonttype": "none"}
    """Many panels: letters stay text."""
    caption = MAPS_CAPTION

    def counts(self) -> Counter[str]:
        """How many points of all maps came to what."""
        return sum((outcome.counts() for outcome in self.outcomes), Counter[str]())

    def records(self) -> list[dict[str, Any]]:
        """Every point of every map."""
        return [
            {"map": outcome.drawn.name, "quantity": outcome.drawn.quantity, **_record(point)}
            for outcome in self.outcomes
            for point in outcome.points
        ]

    def summary(self) -> str:
        """Counts by map, those that are wrong without a word last."""
        if self.left_out:
            return f"{self.name}: {self.left_out[self.name]}"
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
        title = f"Failure maps of {self.label}{' (peer)' if first.side == 'peer' else ''}"
        if missing := first.missing():
            return FailureResult(self.name, title, first.side, left_out={self.name: missing})
        for truth, _ in self.maps:
            tell(f"{self.name}: {truth.drawn.name}, references")
            truth.known  # noqa: B018  # found here, where it is told, and not within a time
        found = []
        for truth, contender in self.maps:
            tell(f"{self.name}: {truth.drawn.name}")
            found.append(measure_map(truth, contender))
        truths = tuple(truth for truth, _ in self.maps)
        return FailureResult(self.name, title, first.side, tuple(found), truths)


def failure_sections(maps: Sequence[tuple[MapTruth, Sequence[Contender]]]) -> list[FailureSection]:
    """A section for each contender of these maps, in the order of their first map."""
    found: dict[str, list[tuple[MapTruth, Contender]]] = {}
    for truth, contenders in maps:
        for contender in contenders:
            found.setdefault(contender.label, []).append((truth, contender))
    return [
        FailureSection(f"failures_{file_stem(label)}", label, tuple(each)) for label, each in found.items()
    ]
