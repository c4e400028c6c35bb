"""The plan of a study: curves and points per law and method, refusals, models. Nothing is computed."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

from frictionlab import registry
from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import Method
from frictionlab.results.shape_points import speeds_to_add
from frictionlab.scene.scenes import Scenes
from frictionlab.study import Study, StudyCurve


@dataclass(frozen=True)
class Planned:
    """The points of one law and one method.

    about: belt speeds are chosen as the run goes, so that points are not known better.
    shapeless: curves that lack points for a measure of their shape, which ``add_belt_speeds`` would give them.
    """

    law: str
    kind: str
    method: str
    curves: int
    points: int
    refused: dict[str, int]
    models: dict[str, int]
    about: bool
    shapeless: int
    add_belt_speeds: list[float]

    def record(self) -> dict[str, Any]:
        """As a record of plain values."""
        return asdict(self)


def plan(study: Study) -> list[Planned]:
    """One entry per law and method, in the order of the study. Raises BrokenPlugin."""
    groups: dict[tuple[str, str], list[StudyCurve]] = {}
    for curve in study.foreseen().curves():
        groups.setdefault(curve.labels, []).append(curve)
    return [_planned(group, study) for group in groups.values()]


def _planned(curves: Sequence[StudyCurve], study: Study) -> Planned:
    tolerance, about = study.tolerance, study.chosen_range is not None
    first, refusals, models = curves[0], Counter[str](), Counter[str]()
    for curve in curves:
        method, law = curve.method.method, curve.law
        reasons = method.refusals(curve.scenes, law)
        refusals.update(reason for reason in reasons if reason is not None)
        able = [place for place, reason in enumerate(reasons) if reason is None]
        if able:
            models[_model(method, curve.scenes.taken(able), law, tolerance)] += len(able)
    given = (
        [] if about else [(curve.scenes, curve.law) for curve in curves]
    )  # chosen ones are not to be added to
    shapeless, add_belt_speeds = speeds_to_add(given)
    return Planned(
        law=first.law_label,
        kind=first.kind,
        method=first.method.label,
        curves=len(curves),
        points=sum(len(curve.rows) for curve in curves),
        refused=dict(refusals),
        models=dict(models),
        about=about,
        shapeless=shapeless,
        add_belt_speeds=add_belt_speeds,
    )


def _model(method: Method, scenes: Scenes, law: FrictionLaw, tolerance: float) -> str:
    """The model that will compute the numbers, and why; the name of a method that makes no choice."""
    auto: Any = registry.method_class("auto")
    return str(auto.foreseen(method, scenes, law, tolerance)) if isinstance(method, auto) else method.name
