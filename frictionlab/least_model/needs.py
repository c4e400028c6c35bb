"""What a scene needs: ``fl.needs``, and the same of every curve of a study."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import ArrayLike

from frictionlab import registry
from frictionlab.columns import BELT_SPEEDS
from frictionlab.laws.base import FrictionLaw
from frictionlab.least_model.answers import Curves
from frictionlab.least_model.lesser import LesserModel
from frictionlab.least_model.result import GivenUnits, Needs, needs_from
from frictionlab.least_model.search import LeastSearch, each_reason_once
from frictionlab.quantities import Written
from frictionlab.results.words import in_words
from frictionlab.runner.arguments import given_law, given_scene, given_speeds, given_tolerance
from frictionlab.runner.progress import ProgressAsked, progress_told
from frictionlab.scene.as_written import without_unit
from frictionlab.scene.scene import Scene
from frictionlab.scene.scenes import Scenes
from frictionlab.study import Study, StudyCurve
from frictionlab.study.axes import FRICTION
from frictionlab.study.grid import law_in_scene
from frictionlab.study.parts import coefficient_of
from frictionlab.units.shown import ShownUnit, units_written

USUAL_SHARE = 0.01
"""The tolerance on the mean, of the friction of steady sliding at the quickest belt speed, where none is given."""
ANSWERS_FINER = 1e-3
"""The error of the means asked for, of that tolerance."""


@dataclass(frozen=True)
class _Asked:
    """Laws by name, the registered names of laws of files, the time a point may take [s], the unit of belt speeds."""

    laws: registry.Laws = registry.INSTALLED_LAWS
    kinds: Mapping[type, str] = field(default_factory=dict)
    seconds_per_point: float = math.inf
    speed: ShownUnit | None = None


def needs(
    scene: Scene,
    law: FrictionLaw,
    belt_speed: ArrayLike | None = None,
    within: float | None = None,
    progress: ProgressAsked = None,
) -> Needs:
    """What a scene needs: each of its parts is taken away, the smaller model solved, and the means compared.

    belt_speed [omega_1 L; m/s for a scene in SI units]: of the curve, that of the scene where left out.
    within [-]: the tolerance on the mean friction coefficient; 1 % of steady sliding friction at the quickest belt
    speed where left out.
    progress: whether to tell on stderr from the third second on how far it is; None where a terminal or a notebook
    shows it.

    >>> import frictionlab as fl
    >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1))
    >>> found = fl.needs(scene, fl.Coulomb(mu=0.4))
    >>> found.sentences[0]
    'harmonics above 9 are not needed: without them the mean changes by 1.91e-06 at belt speed 5'

    Raises ValueError or TypeError for what makes no sense, BrokenPlugin.
    """
    scene, law = given_scene(scene), given_law(law)
    si = scene.dimensional
    own = scene.belt_speed if si is None else si.belt_speed_m_per_s
    scenes = Scenes(scene, np.unique(given_speeds(own if belt_speed is None else belt_speed)))
    asked = _Asked(speed=units_written({"": own}).get(""))
    tolerance = None if within is None else given_tolerance(within, "within")
    with progress_told(progress, "taking parts away", ""):
        return _of_curve(scenes, law, tolerance, asked)


def needs_of_study(study: Study, within: float | None = None) -> Iterator[Needs]:
    """The same of every curve of a study, whatever its methods and its tolerance. Raises BrokenPlugin."""
    kinds = {choice.law_class: choice.kind for choice in study.laws}
    laws = registry.Laws({choice.kind: choice.law_class for choice in study.laws})
    asked = _Asked(laws, kinds, study.seconds_per_point, study.units.get(BELT_SPEEDS[1]))
    first = study.methods[0].label
    for curve in study.foreseen().curves():
        if curve.method.label != first:
            continue
        found, label = _of_curve(curve.scenes, curve.given_law, within, asked), _label(study, curve)
        yield replace(found, table=found.table.assign(curve=label), label=label)


def _label(study: Study, curve: StudyCurve) -> str:
    """The law and the swept values that tell a curve from the others of its study."""
    scene, law = curve.scenes.scene.values(), curve.given_law.model_dump(mode="json")
    told = [curve.law_label] if len(study.laws) > 1 else []
    for path in study.sweep:
        owner, _, name = path.rpartition(".")
        inside = path.removeprefix("scene.")
        if path.startswith("scene.") and not name.startswith("belt_speed"):
            value = scene.get(inside)
            brief = without_unit(inside) if isinstance(value, Written) else inside
            told.append(f"{brief.removeprefix('dimensional.')} {in_words(value)}")
        elif path == FRICTION:
            name = coefficient_of(type(curve.given_law))
            told.append(f"{name} {in_words(law[name])}")
        elif owner == f"laws.{curve.law_label}":
            told.append(f"{name} {in_words(law[name])}")
    return ", ".join(told)


def _of_curve(scenes: Scenes, law: FrictionLaw, within: float | None, asked: _Asked) -> Needs:
    scene, scenes = scenes.scene, Scenes(scenes.scene, np.unique(scenes.given))
    si = scene.dimensional
    units = None if si is None else GivenUnits(si.scales, asked.speed or ShownUnit("m/s"))
    full = LesserModel(scene.model_copy(update={"dimensional": None}), law_in_scene(law, scene))
    quickest = float(np.abs(scenes.belt_speeds).max())
    tolerance = USUAL_SHARE * full.law.sliding_friction(quickest) if within is None else within
    curves = Curves(scenes, ANSWERS_FINER * tolerance, asked.kinds, asked.seconds_per_point)
    answers = curves.of(full)
    if not (answers["status"] == "ok").any():
        return needs_from(full, answers, [], None, tolerance, units)
    search = LeastSearch(full, curves, tolerance, asked.laws)
    singles = search.singles()
    pairs = search.pairs(singles)
    smallest = search.smallest(singles, pairs)
    rows = [*each_reason_once(singles), *pairs, *search.whole(singles)]
    if smallest is not None and smallest not in rows:
        rows.append(smallest)
    return needs_from(full, answers, rows, smallest, tolerance, units)
