"""The plan of a study: curves and points per law and method, refusals, models, cost. Nothing is computed."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

from frictionlab import registry
from frictionlab.runner.chunks import chunk_by_curve
from frictionlab.study import Study, StudyCase


@dataclass(frozen=True)
class Planned:
    """The points of one law and one method. seconds: expected kernel time on one core, once compiled."""

    law: str
    kind: str
    method: str
    curves: int
    points: int
    refused: dict[str, int]
    models: dict[str, int]
    seconds: float

    def record(self) -> dict[str, Any]:
        """As a record of plain values."""
        return asdict(self)


def plan(study: Study) -> list[Planned]:
    """One entry per law and method, in the order of the study. Raises BrokenPlugin."""
    cases = study.cases()
    groups: dict[tuple[str, str], list[StudyCase]] = {}
    for case in cases:
        groups.setdefault((case.law_label, case.method_label), []).append(case)
    return [_planned(group, study.tolerance) for group in groups.values()]


def _planned(cases: Sequence[StudyCase], tolerance: float) -> Planned:
    first = cases[0]
    reasons = [case.method.refusal(case.scene, case.law) for case in cases]
    able = [case for case, reason in zip(cases, reasons, strict=True) if reason is None]
    return Planned(
        law=first.law_label,
        kind=first.kind,
        method=first.method_label,
        curves=len(chunk_by_curve(cases)),
        points=len(cases),
        refused=dict(Counter(reason for reason in reasons if reason is not None)),
        models=dict(Counter(_model(case) for case in able)),
        seconds=sum(case.method.cost(case.scene, case.law, tolerance) for case in able),
    )


def _model(case: StudyCase) -> str:
    """The model that will compute the number, and why; the name of a method that makes no choice."""
    auto: Any = registry.method_class("auto")
    if not isinstance(case.method, auto):
        return case.method.name
    method, why = auto.choice(case.method, case.scene, case.law)
    return f"{method.name} ({why})"
