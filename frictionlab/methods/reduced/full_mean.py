"""The mean friction of the full problem, by which a reduced model's error is told."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.exact.method import Exact
from frictionlab.methods.shooting.method import Shooting
from frictionlab.quantities import Floats
from frictionlab.scene.scene import Scene

TOLERANCE = 1e-9
"""On the mean, relative to the friction coefficient in quick slip."""


class FullMean(NamedTuple):
    """The mean along x1 and its error, NaN where it is not known, and the reason then.

    floquet(): the largest Floquet multiplier of the steady state.
    """

    mean: float
    error: float
    floquet: Callable[[], float]
    reason: str


def full_mean(scene: Scene, law: FrictionLaw) -> FullMean:
    """By the exact method where it takes the scene, else by shooting."""
    method = Exact() if Exact().refusal(scene, law) is None else Shooting()
    free = scene.model_copy(update={"initial": None, "dimensional": None})
    found = method.solve([free], law, TOLERANCE * law.sliding_friction(1.0))
    mean, error = float(found.mean[0].real), float(found.error[0])
    if found.status[0] == "ok":
        return FullMean(mean, error, lambda: _first(found.floquet), "")
    unknown = "no useful bound on the model error: the steady state is not known"
    return FullMean(math.nan, math.nan, lambda: math.nan, f"{unknown} ({found.reason[0]}); use shooting")


def _first(floquet: Callable[[], Floats] | None) -> float:
    return math.nan if floquet is None else float(floquet()[0])
