"""The mean friction of the full problem, by which a reduced model's error is told."""

from __future__ import annotations

import math
from typing import NamedTuple

from frictionlab.laws.base import SlidingLaw
from frictionlab.laws.memory import BristleLaw
from frictionlab.methods.exact.method import Exact
from frictionlab.methods.shooting.method import Shooting
from frictionlab.scene.scene import Scene

TOLERANCE = 1e-9
"""On the mean, relative to the friction coefficient in quick slip."""


class FullMean(NamedTuple):
    """The mean along x1, its error and the steady state's largest Floquet multiplier, NaN where it is not known; and
    the reason then.
    """

    mean: float
    error: float
    floquet: float
    reason: str


def full_mean(scene: Scene, law: SlidingLaw | BristleLaw) -> FullMean:
    """By the exact method where it takes the scene, else by shooting."""
    method = Exact() if Exact().refusal(scene, law) is None else Shooting()
    free = scene.model_copy(update={"initial": None, "dimensional": None})
    found = method.solve([free], law, TOLERANCE * law.sliding_friction(1.0))
    mean, error, floquet = (float(found.columns[name][0]) for name in ("mean_friction", "error", "floquet"))
    if found.status[0] == "ok":
        return FullMean(mean, error, floquet, "")
    unknown = "no useful bound on the model error: no one steady state is known"
    return FullMean(math.nan, math.nan, math.nan, f"{unknown} ({found.reason[0]}); use shooting")
