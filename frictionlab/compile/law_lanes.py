"""The friction of a law without memory at several speeds of slip at once."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import numpy as np

from frictionlab.compile.decorators import inner
from frictionlab.compile.interpret import interpreted_on_arrays, run_on_arrays_as
from frictionlab.compile.lane_arrays import lane, with_lane
from frictionlab.compile.lanes import LANE_COUNT
from frictionlab.laws.base import FrictionLaw

PROBES = 1e-12, 1e-3, 0.3, 1.0, 10.0, 3e3
"""Speeds at which the text of a law on an array is held against the law."""


def takes_lanes(law: FrictionLaw) -> bool:
    """Whether friction is along the slip and a function of its speed alone."""
    return law.memory_kind == "none" and type(law).sliding_vector is FrictionLaw.sliding_vector


@inner
def friction_by_lane(law: Any, speeds: Any) -> Any:
    """The coefficient at each of these speeds; lane by lane, for laws branch on speed."""
    found = speeds
    for k in range(LANE_COUNT):
        found = with_lane(found, k, law.sliding_friction(lane(speeds, k)))
    return found


def _friction_of_array(law: FrictionLaw, speeds: np.ndarray) -> Any:
    text = interpreted_on_arrays(type(law).sliding_friction)
    return text(law, speeds) if _serves(law) else _one_by_one(law, speeds)


run_on_arrays_as(friction_by_lane, _friction_of_array)


def _one_by_one(law: FrictionLaw, speeds: np.ndarray) -> np.ndarray:
    return np.array([law.sliding_friction(speed) for speed in speeds.tolist()])


@lru_cache(maxsize=64)
def _serves(law: FrictionLaw) -> bool:
    """Whether the text of the law means the same on an array."""
    speeds = np.array(PROBES)
    try:
        found = interpreted_on_arrays(type(law).sliding_friction)(law, speeds)
        return bool(np.allclose(found + 0.0 * speeds, _one_by_one(law, speeds), rtol=1e-13, atol=0.0))
    except (TypeError, ValueError, ArithmeticError, AttributeError, LookupError):  # it takes one number alone
        return False
