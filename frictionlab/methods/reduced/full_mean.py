"""The mean friction of the full problem, by which a reduced model's error is told."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.exact.method import Exact
from frictionlab.methods.shooting.method import Shooting
from frictionlab.quantities import Floats
from frictionlab.scene.scene import Scene

TOLERANCE = 1e-9
"""On the mean, relative to the friction coefficient in quick slip."""
NOT_KNOWN = "the model error is not known, for the steady state is not"


class FullMeans(NamedTuple):
    """Means along x1 and their errors, NaN where they are not known, and the reasons then, else ''.

    floquet(): the largest Floquet multiplier of each steady state.
    """

    mean: Floats
    error: Floats
    floquet: Callable[[], Floats]
    reasons: list[str]


def full_means(scenes: Sequence[Scene], law: FrictionLaw) -> FullMeans:
    """Of scenes that differ in belt speed alone: by the exact method where it takes them, else by shooting."""
    free = [scene.model_copy(update={"initial": None, "dimensional": None}) for scene in scenes]
    method = Exact() if not any(Exact().refusals(free, law)) else Shooting()
    found = method.solve(free, law, TOLERANCE * law.sliding_friction(1.0))
    nothing = np.full(len(scenes), np.nan)
    known = np.array([status == "ok" for status in found.status])
    reasons = [
        "" if ok else f"{NOT_KNOWN} ({reason}); use shooting"
        for ok, reason in zip(known, found.reason, strict=True)
    ]
    mean, error = (np.where(known, values, np.nan) for values in (np.real(found.mean), found.error))
    return FullMeans(mean, error, found.floquet or (lambda: nothing), reasons)
