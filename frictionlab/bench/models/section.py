"""The section of a bench list that compares models, and what it comes to."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, NamedTuple

from frictionlab.bench.csv_table import write_records
from frictionlab.bench.measure import Row, measured_row
from frictionlab.bench.record import Bench, ReferenceMeans, Workload
from frictionlab.bench.references import reference_means
from frictionlab.bench.sections import BenchPicture

MODELS_CAPTION = (
    "Every law, scene and method on one chart: how far the mean friction is from that of the richest model, against "
    "the time of a point with its error. Points on the line are the front: nothing cheaper is nearer. Colours are "
    "models, marks are methods; a dotted tail leads to what a reduced model costs without its error."
)

NOTICEABLY = 0.9
"""Times an error: what is nearer by less is not worth its price."""


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


def front(rows: Sequence[ModelRow]) -> list[ModelRow]:
    """Of those that answer all, the ones to which none cheaper is as near, by a tenth; from the cheapest on."""
    found: list[ModelRow] = []
    answered = (each for each in rows if each.answered)
    for each in sorted(answered, key=lambda each: (each.row.mean.least, each.row.largest)):
        if not found or each.row.largest < NOTICEABLY * found[-1].row.largest:
            found.append(each)
    return found


@dataclass(frozen=True)
class ModelsResult:
    """Every method on every model of one scene."""

    name: str
    title: str
    rows: list[ModelRow]
    references: list[ReferenceMeans]

    def write(self, folder: Path) -> list[Path]:
        """One CSV. Raises OSError."""
        path, best = folder / f"{self.name}.csv", front(self.rows)
        write_records(path, [_record(each, each in best) for each in self.rows])
        return [path]

    def draw(self, folder: Path) -> list[BenchPicture]:
        """One chart. Raises OSError."""
        from frictionlab.bench.models.chart import draw_models

        draw_models(self, folder)
        return [BenchPicture(self.name, MODELS_CAPTION)]

    def summary(self) -> str:
        """The front, from the cheapest model to the nearest one."""
        lines = [f"{self.name}: errors against {self.rows[0].model.label} ({self.references[0].label})"]
        for each in front(self.rows):
            price = f"{1e6 * each.row.mean.least:,.3g} us a point"
            lines.append(f"{each.row.largest:.1e}  {price:<20}{each.model.label}: {each.label}")
        return "\n".join(lines)


def _record(each: ModelRow, best: bool) -> dict[str, Any]:
    """A row of the CSV; times in microseconds per point, empty where there is none."""
    row = each.row
    low, middle, high = row.mean.quartiles
    times = {"mean_us": row.mean.least, "mean_us_q1": low, "mean_us_q2": middle, "mean_us_q3": high}
    times |= {"model_us": row.model.least, "error_us": row.error_alone}
    return {
        "law": each.model.law,
        "scene": each.model.scene or "whole",
        "method": row.contender.label,
        "quantity": row.setting.quantity,
        "value": row.setting.value if row.setting.quantity else "",
        "points": row.points,
        **row.counts,
        "largest_error": _number(row.largest),
        "median_error": _number(row.median),
        "stated_error": _number(row.stated),
        **{name: _number(1e6 * value) for name, value in times.items()},
        "front": "yes" if best else "no",
        "reference": row.reference.label if row.reference else "",
        "reason": row.reason,
    }


def _number(value: float) -> float | str:
    return value if math.isfinite(value) else ""


@dataclass(frozen=True)
class ModelsSection:
    """Models of one scene, the richest first; limits: how often and how long each is timed."""

    name: str
    title: str
    models: tuple[BenchedModel, ...]
    limits: Bench

    def measure(self, tell: Callable[[str], None]) -> ModelsResult:
        """Measure every method on every model."""
        tell(f"{self.name}: references")
        # of the method that is the reference, too: what a model leaves out is not its error
        known = [replace(each, kind="") for each in reference_means(self.models[0].work)]
        rows = []
        for model in self.models:
            for contender in model.work.contenders:
                for setting, solver in contender.solvers:
                    tell(f"{self.name}: {model.label}, {contender.label}, {setting}")
                    row = measured_row(self.limits, model.work, known, contender, setting, solver)
                    rows.append(ModelRow(model, row))
        return ModelsResult(self.name, self.title, rows, known)
