"""One curve of a bench list: every method and peer on it, and what they come to."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar

from frictionlab.bench import report
from frictionlab.bench.measure import measured_row, with_first_run
from frictionlab.bench.record import ReferenceMeans, Row, Workload
from frictionlab.bench.sections import SectionResult, file_stem
from frictionlab.bench.solvers import reference_means

CAPTION = (
    "Lower is nearer the reference, further left is cheaper: read what each error costs along a level line."
)


@dataclass(frozen=True)
class CurveResult(SectionResult):
    """A curve with its references and rows; left_out: peers that are not installed, with the remedy."""

    kind: ClassVar[str] = "curve"

    name: str
    title: str
    work: Workload
    references: list[ReferenceMeans]
    rows: list[Row]
    left_out: Mapping[str, str] | None = None
    caption = CAPTION

    @property
    def notes(self) -> list[str]:
        """The belt speeds, and who is measured against what."""
        speeds = self.work.speeds()
        span = f"{len(speeds)} belt speeds from {speeds[0]:g} to {speeds[-1]:g}."
        return [span, *report.reference_lines(self.references, self.rows)]

    def records(self) -> Sequence[Mapping[str, Any]]:
        """A row for each setting."""
        kind = "coulomb" if self.work.law.constant_sliding_friction() else type(self.work.law).__name__
        return [report.curve_record(row, self.name, kind.lower()) for row in self.rows]

    def markdown(self) -> str:
        """The table, with what its errors are measured against."""
        heading = f"## {self.name}{': ' + self.title if self.title else ''}"
        notes = [*([report.left_out(self.left_out)] if self.left_out else []), *self.notes]
        lines = [heading, "", *(f"- {note}" for note in notes), "", *report.markdown_lines(self.records())]
        return "\n".join(lines) + "\n"

    def write(self, folder: Path) -> list[Path]:
        """The table as CSV and as Markdown. Raises OSError."""
        text = folder / f"{file_stem(self.name)}.md"
        text.write_text(self.markdown(), encoding="utf-8")
        return [*super().write(folder), text]

    def summary(self) -> str:
        """The time per point to reach an error, for every contender, with the ratio to the best method."""
        return report.curve_summary(self.name, self.rows)


@dataclass(frozen=True)
class BenchCurve:
    """A workload with a name; first_runs: whether the first setting of each method is timed without kernels, too."""

    name: str
    title: str
    work: Workload
    first_runs: bool = False

    def measure(self, tell: Callable[[str], None]) -> CurveResult:
        """Every contender that is installed, at every setting."""
        missing = self.work.missing()
        there = [each for each in self.work.contenders if each.label not in missing]
        steps = 1 + sum(len(each.solvers) for each in there)
        tell(f"{self.name}: references (1 of {steps})")
        found, rows = reference_means(self.work), list[Row]()
        for contender in there:
            for at, (setting, _) in enumerate(contender.solvers):
                tell(f"{self.name}: {contender.label}, {setting} ({len(rows) + 2} of {steps})")
                row = measured_row(self.work, found, contender, at)
                rows.append(with_first_run(row, self.work) if self.first_runs else row)
        return CurveResult(self.name, self.title, self.work, found, rows, missing)
