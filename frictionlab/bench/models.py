"""Speed against accuracy over models: what laws, simpler scenes and methods cost, and how far they are off."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

from frictionlab.bench.measure import measured_row
from frictionlab.bench.record import ReferenceMeans, Row, Workload
from frictionlab.bench.report import curve_record
from frictionlab.bench.sections import SectionResult
from frictionlab.bench.solvers import reference_means

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
