"""V_lin between the points of a sweep, from its formula."""

from __future__ import annotations

import math
from collections.abc import Mapping

from frictionlab.columns import BELT_SPEEDS, without_shown_unit
from frictionlab.scene.scene import Scene, with_values
from frictionlab.study import Study
from frictionlab.theory import friction_free_velocity
from frictionlab.units.shown import ShownUnit


def v_lin_of(study: Study, values: Mapping[str, float | str]) -> float:
    """That of the scene with these inputs, by their columns and as those show them.

    NaN where it asks for the law, and where there is no such scene, as there is none of a normal load below zero.
    """
    given = {}
    for shown, value in values.items():
        name = without_shown_unit(shown)
        size = study.units.get(name, ShownUnit("")).size
        given[name.removeprefix("scene.")] = value if isinstance(value, str) else value * size
    try:
        scene = Scene.model_validate(with_values(study.scene.given(), given))
    except ValueError:
        return math.nan
    if scene.normal_load_variation is not None:
        return math.nan
    si = scene.dimensional
    unit = 1.0 if si is None else si.scales.velocity / study.units.get(BELT_SPEEDS[1], ShownUnit("")).size
    return unit * friction_free_velocity(scene)
