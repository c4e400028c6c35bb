"""The section of a bench list that compares models, and what it comes to."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

from frictionlab.bench.measure import measured_row
from frictionlab.bench.models.record import BenchedModel, ModelRow, front, model_record
from frictionlab.bench.record import ReferenceMeans
from frictionlab.bench.references import reference_means
from frictionlab.bench.sections import SectionResult

MODELS_CAPTION = (
    "Every law, scene and method on one chart: how far the mean friction is from that of the richest model, against "
    "the time of a point with its error. Points on the line are the front: nothing cheaper is nearer. Colours are "
    "models, marks are methods; a dotted tail leads to what a reduced model costs without its error."
)


@dataclass(frozen=True)
class ModelsResult(SectionResult):
    """Every method on every model of one scene."""

    name: str
    title: str
    rows: list[ModelRow]
    references: list[ReferenceMeans]

    @property
    def caption(self) -> str:
        """How to read the chart."""
        return MODELS_CAPTION

    def records(self) -> list[dict[str, Any]]:
        """A row for each method on each model."""
        best = front(self.rows)
        return [model_record(each, each in best) for each in self.rows]

    def figure(self) -> Any:
        """One panel."""
        from frictionlab.bench.models.chart import models_figure

        return models_figure(self.title or self.name, self.rows, self.references)

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
