"""What a scene needs: ``fl.needs``, and the same of every curve of a study."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike

from frictionlab import registry
from frictionlab.columns import NEEDS
from frictionlab.laws.base import FrictionLaw
from frictionlab.least_model.answers import Curves
from frictionlab.least_model.lesser import LesserModel
from frictionlab.least_model.search import Search, Without
from frictionlab.least_model.sentences import last_sentence, model_in_words, sentence
from frictionlab.quantities import Floats
from frictionlab.results.words import counted
from frictionlab.runner.arguments import given_law, given_scene, given_speeds, given_tolerance
from frictionlab.scene.scene import Scene
from frictionlab.study import Study
from frictionlab.study.study import law_in_scene

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SHARE = 0.01
"""The tolerance on the mean, of the friction of steady sliding at the quickest belt speed, where none is given."""
FINER = 1e-3
"""The error of the means asked for, of that tolerance."""


@dataclass(frozen=True)
class Needs:
    """What one curve needs.

    table: a row per set of things taken away, with the columns of ``columns.NEEDS``. sentences: the same for reading.
    smallest: the smallest model within the tolerance, the full one where nothing may go. label: what tells this curve
    from others of its study. failed: whether the full scene lacks an answer that it should have at some points.
    """

    table: pd.DataFrame
    sentences: list[str]
    smallest: LesserModel
    label: str = ""
    failed: bool = False

    def plot(self) -> Figure:
        """Bars of the change without each thing against the tolerance."""
        from frictionlab.charts.needs import needs_figure  # with matplotlib, which takes a second

        return needs_figure(self.table)


def needs(
    scene: Scene, law: FrictionLaw, belt_speed: ArrayLike | None = None, within: float | None = None
) -> Needs:
    """What a scene needs: each of its parts is taken away, the smaller model solved, and the means compared.

    belt_speed [scene velocity; m/s for a scene in SI units]: of the curve, that of the scene where left out.
    within: the tolerance on the mean friction coefficient; 1 % of steady sliding friction at the quickest belt speed
    where left out. Raises ValueError or TypeError for what makes no sense, BrokenPlugin.
    """
    scene, law = given_scene(scene), given_law(law)
    si = scene.dimensional
    own = scene.belt_speed if si is None else si.belt_speed_m_per_s
    speeds = np.unique(given_speeds(own if belt_speed is None else belt_speed))
    scaled = speeds if si is None else speeds / si.scales.velocity
    tolerance = None if within is None else given_tolerance(within)
    return _of_curve(scene, law, scaled, tolerance, registry.INSTALLED_LAWS, {})


def needs_of_study(study: Study, within: float | None = None) -> Iterator[Needs]:
    """The same of every curve of a study: of every scene and law, whatever its methods. Raises BrokenPlugin."""
    kinds = {choice.kind: choice.law_class for choice in study.laws}
    laws = registry.Laws(kinds)
    named = {law: kind for kind, law in kinds.items()}
    seen = set()
    for curve in study.curves():
        scenes = curve.scenes
        key = curve.law_label, curve.given_law, scenes.scene
        if key not in seen:
            seen.add(key)
            speeds = np.unique(scenes.belt_speeds)
            yield _of_curve(scenes.scene, curve.given_law, speeds, within, laws, named, _label(study, curve))


def _label(study: Study, curve: Any) -> str:
    """The law and the swept values that tell a curve from the others of its study."""
    scene, law = curve.scenes.scene.values(), curve.given_law.model_dump(mode="json")
    told = [curve.law_label] if len(study.laws) > 1 else []
    for path in study.sweep:
        owner, _, name = path.rpartition(".")
        if path.startswith("scene.") and not name.startswith("belt_speed"):
            told.append(f"{path.removeprefix('scene.')} {scene.get(path.removeprefix('scene.'))}")
        elif owner == f"laws.{curve.law_label}":
            told.append(f"{name} {law[name]}")
    return ", ".join(told)


def _of_curve(
    scene: Scene,
    law: FrictionLaw,
    speeds: Floats,
    within: float | None,
    laws: registry.Laws,
    kinds: Mapping[type, str],
    label: str = "",
) -> Needs:
    full = LesserModel(scene.model_copy(update={"dimensional": None}), law_in_scene(law, scene))
    quickest = float(np.abs(speeds).max())
    tolerance = SHARE * full.law.sliding_friction(quickest) if within is None else within
    curves = Curves(speeds, FINER * tolerance, kinds)
    search = Search(full, curves, tolerance, laws)
    singles = search.singles()
    pairs = search.pairs(singles)
    smallest = search.smallest(singles, pairs)
    rows = [*singles, *pairs, *search.whole(singles)]
    if smallest is not None and smallest not in rows:
        rows.append(smallest)
    answers = curves.of(full)
    told = [*_open(answers), *map(sentence, rows), last_sentence(smallest, full, tolerance)]
    table = pd.DataFrame(
        [_record(each, label, tolerance, each is smallest) for each in rows], columns=[*NEEDS]
    )
    least = full if smallest is None or smallest.model is None else smallest.model
    return Needs(table, told, least, label, bool(answers["status"].isin(["failed", "killed"]).any()))


def _open(answers: pd.DataFrame) -> list[str]:
    """What is said of belt speeds at which the full scene has no one answer."""
    rest = answers[answers["status"] != "ok"]
    if rest.empty:
        return []
    why = (rest["status"] + ": " + rest["reason"].astype("str")).value_counts().index[0]
    where = f"{counted(len(rest), 'belt speed')} of {len(answers)}"
    return [f"left out: {where} at which the full scene has no one mean ({why})"]


def _record(each: Without, label: str, within: float, smallest: bool) -> dict[str, Any]:
    found = each.change
    return {
        "curve": label,
        "without": " + ".join(each.names),
        "verdict": found.verdict,
        "change": found.mean.value,
        "change_error": found.mean.error,
        "belt_speed": found.belt_speed,
        "within": within,
        "reduction_change": found.reduction.value,
        "reduction_change_error": found.reduction.error,
        "shape": found.shapes[0],
        "shape_without": found.shapes[1],
        "smallest": smallest,
        "model": "" if each.model is None else model_in_words(each.model),
        "reason": found.reason,
    }
