"""The failure maps of one method or peer as a section of a bench list."""

from __future__ import annotations

import csv
import math
import statistics
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import astuple, dataclass, fields
from pathlib import Path

from frictionlab.bench.failures.measure import OUTCOMES, MapOutcome, MapTruth, PointOutcome, measure_map
from frictionlab.bench.failures.record import GridRow
from frictionlab.bench.forecast import Expected, Forecast
from frictionlab.bench.peers.base import Peer
from frictionlab.bench.record import Contender
from frictionlab.bench.sections import BenchPicture
from frictionlab.bench.solvers import seconds_per_point

CELLS = {field.name: field.name for field in fields(PointOutcome)} | {
    "stated": "stated_error",
    "true": "true_error",
}
"""The columns of a table of points, by the fields they hold."""


@dataclass(frozen=True)
class FailureResult:
    """What one method or peer came to on every map it was given.

    missing: why nothing was measured, of a peer that is not installed.
    """

    name: str
    label: str
    side: str
    outcomes: tuple[MapOutcome, ...]
    truths: tuple[MapTruth, ...]
    missing: str = ""

    @property
    def title(self) -> str:
        """Whose maps these are."""
        return f"Failure maps of {self.label}{' (peer)' if self.side == 'peer' else ''}"

    def counts(self) -> Counter[str]:
        """How many points of all maps came to what."""
        return sum((outcome.counts() for outcome in self.outcomes), Counter[str]())

    def write(self, folder: Path) -> list[Path]:
        """``failures_<label>.csv``: every point of every map."""
        if self.missing:
            return []
        file = folder / f"{self.name}.csv"
        with file.open("w", encoding="utf-8", newline="") as text:
            writer = csv.writer(text, lineterminator="\n")
            writer.writerow(["map", "quantity", *CELLS.values()])
            for outcome in self.outcomes:
                for point in outcome.points:
                    row = ["" if cell != cell else cell for cell in astuple(point)]
                    writer.writerow([outcome.drawn.name, outcome.drawn.quantity, *row])
        return [file]

    def draw(self, folder: Path) -> list[BenchPicture]:
        """One figure, a row of panels for each map."""
        if self.missing:
            return []
        from frictionlab.bench.failures.chart import draw_maps

        return draw_maps(self, folder)

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
        if isinstance(solver, Peer) and (missing := solver.missing()):
            return FailureResult(self.name, self.label, first.side, (), (), missing)
        for truth, _ in self.maps:
            tell(f"{self.name}: {truth.drawn.name}, references")
            truth.known  # noqa: B018  # found here, where it is told, and not within a time
        forecast = Forecast(
            Expected(truth.drawn.name, _seconds(row, contender))
            for truth, contender in self.maps
            for row in (*truth.drawn.rows, *truth.drawn.named_rows)
        )
        found = []
        for truth, contender in self.maps:
            tell(f"{self.name}: {truth.drawn.name} ({forecast})")
            found.append(measure_map(truth, contender, forecast.done))
        return FailureResult(
            self.name, self.label, first.side, tuple(found), tuple(truth for truth, _ in self.maps)
        )


def _seconds(row: GridRow, contender: Contender) -> float:
    """A guess of what a row of a map costs."""
    setting, solver = contender.solvers[0]
    return seconds_per_point(solver, row.scenes[-1], row.law, setting.tolerance) * len(row.scenes)


def by_label(
    maps: Sequence[tuple[MapTruth, Sequence[Contender]]],
) -> dict[str, list[tuple[MapTruth, Contender]]]:
    """The maps each contender is measured on, by its label, in the order of their first map."""
    found: dict[str, list[tuple[MapTruth, Contender]]] = {}
    for truth, contenders in maps:
        for contender in contenders:
            found.setdefault(contender.label, []).append((truth, contender))
    return found
