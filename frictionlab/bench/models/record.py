"""Models of one scene, what a method comes to on each, and which are worth their price."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

from frictionlab.bench.record import Row, Workload
from frictionlab.bench.sections import cell

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


def model_record(each: ModelRow, best: bool) -> dict[str, Any]:
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
        "largest_error": cell(row.largest),
        "median_error": cell(row.median),
        "stated_error": cell(row.stated),
        **{name: cell(1e6 * value) for name, value in times.items()},
        "front": "yes" if best else "no",
        "reference": row.reference.label if row.reference else "",
        "reason": row.reason,
    }
