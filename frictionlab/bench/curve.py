"""One curve of a bench list: every method and peer on it, and what they come to.

Speed against accuracy over models: what laws, simpler scenes and methods cost, and how far they are off.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, ClassVar, NamedTuple

from frictionlab.bench import report
from frictionlab.bench.measure import measured_row, reference_means, with_first_run
from frictionlab.bench.record import ReferenceMeans, Row, SectionResult, Workload, file_stem
from frictionlab.bench.report import curve_record

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


MODELS_CAPTION = (
    "Every law, scene and method on one chart: how far the mean friction is from that of the richest model, against "
    "the time of a point with its error. Points on the line are the front: nothing cheaper is nearer. Colours are "
    "models, marks are methods; a dotted tail leads to what a reduced model costs without its error."
)
NOTICEABLY = 0.9
"""Times an error: what is nearer by less is not worth its price."""
OF_A_CURVE = (
    *("quantity", "value", "points", "ok", "refused", "failed", "not_unique"),
    *("largest_error", "median_error", "stated_error"),
    *("mean_us", "mean_us_q1", "mean_us_q2", "mean_us_q3", "model_us", "error_us"),
)
"""Columns of a curve's table that a table of models has, too."""


class BenchedModel(NamedTuple):
    """A law on a scene, whole or without a part of it."""

    law: str
    scene: str
    work: Workload

    @property
    def label(self) -> str:
        """The law, and what the scene lacks."""
        return f"{self.law}, {self.scene}" if self.scene else self.law


class ModelRow(NamedTuple):
    """A method at one setting on a model; its errors are those against the richest model."""

    model: BenchedModel
    row: Row

    @property
    def label(self) -> str:
        """The method with its setting."""
        setting = self.row.setting
        return self.row.contender.label + (f", {setting}" if setting.quantity else "")

    @property
    def answered(self) -> bool:
        """Whether it has an answer with an error at every belt speed that it was given."""
        return self.row.counts["ok"] == self.row.points and math.isfinite(self.row.largest)

    def record(self, best: bool) -> dict[str, Any]:
        """A row of the CSV."""
        told = curve_record(self.row, self.model.scene or "whole", self.model.law)
        return {
            **{"law": told["law"], "scene": told["scene"], "method": told["solver"]},
            **{name: told[name] for name in OF_A_CURVE},
            **{"front": "yes" if best else "no", "reference": told["reference"], "reason": told["reason"]},
        }


def front(rows: Sequence[ModelRow]) -> list[ModelRow]:
    """Of those that answer all, the ones to which none cheaper is as near, by a tenth; from the cheapest on."""
    found: list[ModelRow] = []
    answered = (each for each in rows if each.answered)
    for each in sorted(answered, key=lambda each: (each.row.mean.least, each.row.largest)):
        if not found or each.row.largest < NOTICEABLY * found[-1].row.largest:
            found.append(each)
    return found


@dataclass(frozen=True)
class ModelsResult(SectionResult):
    """Every method on every model of one scene."""

    name: str
    title: str
    rows: list[ModelRow]
    references: list[ReferenceMeans]
    caption = MODELS_CAPTION

    def records(self) -> list[dict[str, Any]]:
        """A row for each method on each model."""
        best = front(self.rows)
        return [each.record(each in best) for each in self.rows]

    def summary(self) -> str:
        """The front, from the cheapest model to the nearest one."""
        lines = [f"{self.name}: errors against {self.rows[0].model.label} ({self.references[0].label})"]
        for each in front(self.rows):
            price = f"{1e6 * each.row.mean.least:,.3g} us a point"
            lines.append(f"{each.row.largest:.1e}  {price:<20}{each.model.label}: {each.label}")
        return "\n".join(lines)


@dataclass(frozen=True)
class ModelsSection:
    """Models of one scene, the richest first."""

    name: str
    title: str
    models: tuple[BenchedModel, ...]

    def measure(self, tell: Callable[[str], None]) -> ModelsResult:
        """Measure every method on every model."""
        tell(f"{self.name}: references")
        # of the method that is the reference, too: what a model leaves out is not its error
        known = [replace(each, kind="") for each in reference_means(self.models[0].work)]
        rows = []
        for model in self.models:
            for contender in model.work.contenders:
                for at, (setting, _) in enumerate(contender.solvers):
                    tell(f"{self.name}: {model.label}, {contender.label}, {setting}")
                    rows.append(ModelRow(model, measured_row(model.work, known, contender, at)))
        return ModelsResult(self.name, self.title, rows, known)
