"""Speed against accuracy over models: what laws, simpler scenes and methods cost, and how far they are off."""

from __future__ import annotations

from collections.abc import Iterator
from copy import deepcopy
from dataclasses import dataclass
from functools import cached_property, partial
from typing import Annotated, Any

import numpy as np
import pandas as pd
from pydantic import model_validator

from frictionlab.bench.blocks import OwnBlock, refuse_other_sweeps
from frictionlab.bench.charts import models_figure
from frictionlab.bench.contenders import FILLED, AReference, AtLeastOne
from frictionlab.bench.curve import largest_error, measured_row, workloads
from frictionlab.bench.result import SectionResult, Tell, file_stem
from frictionlab.study.study import Study
from frictionlab.values.quantities import Positive

MODELS_CAPTION = (
    "Every law, scene and method on one chart: how far the mean friction is from that of the richest model, against "
    "the time of a point with its error. Points on the line are the front: nothing cheaper is nearer. Colours are "
    "models, marks are methods; a dotted tail leads to what a reduced model costs without its error."
)
NOTICEABLY = 0.9
"""Times an error: what is nearer by less is not worth its price."""
WHOLE = "whole"
OF_CURVES_ALONE = "^model$|side|covered|repeats|all_us|model_us_q|first_run|reference_error"
"""Columns of a row that a table of models lacks."""


class ModelsBlock(OwnBlock):
    """An item of ``models``: the first law on the whole scene is the richest model, which others are held against."""

    references: Annotated[tuple[AReference, ...], FILLED]
    without: Annotated[tuple[str, ...], FILLED] = ()
    repeats: AtLeastOne = 20
    seconds: Positive = 1.0

    @model_validator(mode="after")
    def _has_models(self) -> ModelsBlock:
        for _, study in self.studies:
            refuse_other_sweeps(study)
            if not study.sweep:
                raise ValueError("sweep: models are compared along one curve: sweep the belt speed")
        return self

    @cached_property
    def studies(self) -> list[tuple[str, Study]]:
        """Study on the whole scene, and that without each part that simpler scenes lack, by what is left out."""
        return [(WHOLE, self.study), *self._simpler()]

    def _simpler(self) -> Iterator[tuple[str, Study]]:
        for index, part in enumerate(self.without):
            left = inside = deepcopy(self.scene)
            *above, key = part.split(".")
            try:
                for name in above:
                    inside = inside[name]
                del inside[key]
            except (KeyError, TypeError):
                what = f"the scene has no '{part}'; give the path of a key of it"
                raise ValueError(f"without[{index}]: {what}") from None
            yield f"without {part}", self.study_of(scene=left)


@dataclass(frozen=True)
class ModelsSection:
    """Models of one scene, the richest first."""

    block: ModelsBlock

    @property
    def name(self) -> str:
        """Return the name of its files."""
        return f"models_{file_stem(self.block.name)}"

    def measure(self, tell: Tell) -> SectionResult:
        """Measure every method on every model."""
        block, rows = self.block, list[dict[str, Any]]()
        tell(f"{self.name}: references")
        works = []
        for scene, study in block.studies:
            for law, work in workloads(study, block.references, block.repeats, block.seconds):
                works.append(({"law": law, "scene": scene}, work))
        # of the method that is the reference, too: what a model leaves out is not its error
        known = [(each._replace(kind=""), found) for each, found in works[0][1].known()]
        for model, work in works:
            for contender in block.contenders:
                for setting in contender.settings:
                    tell(f"{self.name}: {model_label(model)}, {contender.label}, {setting}")
                    rows.append(model | measured_row(work, known, contender, setting))
        table = pd.DataFrame(rows)
        table["model"] = table.apply(model_label, axis=1)
        best, title = front(table), block.title or self.name
        on_front = np.where(table.index.isin(best.index), "yes", "no")
        shown = table.loc[:, ~table.columns.str.contains(OF_CURVES_ALONE)]
        shown = shown.rename(columns={"solver": "method"})
        shown.insert(shown.columns.get_loc("reference"), "front", on_front)
        head = f"{self.name}: errors against {table['model'][0]} ({block.references[0].label})"
        figure = partial(models_figure, title, table, best, largest_error(known))
        return SectionResult(self.name, block.title, shown, _summary(head, best), figure, MODELS_CAPTION)


def _summary(head: str, best: pd.DataFrame) -> str:
    """Return the front, from the cheapest model to the nearest one."""
    lines = [head]
    for _, row in best.iterrows():
        price = f"{row['mean_us']:,.3g} us a point"
        setting = f", {row['quantity']} {row['value']:g}" if row["quantity"] else ""
        lines.append(f"{row['largest_error']:.1e}  {price:<20}{row['model']}: {row['solver']}{setting}")
    return "\n".join(lines)


def model_label(row: Any) -> str:
    """Return the law, and what the scene lacks."""
    return str(row["law"] if row["scene"] == WHOLE else f"{row['law']}, {row['scene']}")


def front(table: pd.DataFrame) -> pd.DataFrame:
    """Return, of rows that answer all, those to which none cheaper is as near, by a tenth; from the cheapest on."""
    answered = table[(table["ok"] == table["points"]) & table["largest_error"].notna()]
    rising = answered.sort_values(["mean_us", "largest_error"])
    best, least = list[Any](), float("inf")
    for at, error in rising["largest_error"].items():
        if error < NOTICEABLY * least:
            best, least = [*best, at], error
    return rising.loc[best]
