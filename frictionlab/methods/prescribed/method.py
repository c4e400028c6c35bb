"""Mean friction under a prescribed slip velocity.

Licence of bristles that end saturated (8 scenes): 5 times faster than following a
deflection that stays at its limit (4 to 5.7 times), with the same 13 digits.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import PROVED, TESTED, Answers
from frictionlab.methods.prescribed.bristle import BristlePoint, along_one_line
from frictionlab.methods.prescribed.memory import MemoryPoint
from frictionlab.methods.prescribed.varying_axes import AxesPoint
from frictionlab.methods.prescribed.varying_legs import LegsPoint
from frictionlab.methods.prescribed.varying_slip import VaryingPoint
from frictionlab.methods.under_way import each_told
from frictionlab.methods.words import ModelWord
from frictionlab.scene.scene import Scene
from frictionlab.theory.saturation import saturates

Point = VaryingPoint | BristlePoint | AxesPoint | LegsPoint | MemoryPoint

POINTS: dict[str, Callable[[Scene, Any, float], Point]] = {
    "none": lambda scene, law, _tolerance: VaryingPoint(scene, law),
    "bristle": lambda scene, law, tolerance: _bristle_point(scene, law, tolerance),
    "deflections": MemoryPoint,
    "scalars": MemoryPoint,
}
"""What answers a scene of prescribed slip, by what the law remembers."""


def _bristle_point(scene: Scene, law: Any, tolerance: float) -> Point:
    line = along_one_line(scene, law)
    if not line and law.planar_form() == "per-axis":
        return AxesPoint(scene, lambda axis: _bristle_point(axis, law, tolerance))
    if scene.is_harmonic:
        return BristlePoint(scene, law, tolerance)
    # in a contact that keeps its stiffness, deflections change with the normal load, too
    known = line and law.exact_path() and not scene.constant_contact
    return LegsPoint(scene, law) if known else MemoryPoint(scene, law, tolerance)


def _point(scene: Scene, law: FrictionLaw, tolerance: float) -> Point:
    turns = not along_one_line(scene, law) and not scene.constant_contact
    slides_on = turns and saturates(law.under_load(scene.motion().normal_load))
    return POINTS["none" if slides_on else law.memory_kind](scene, law, tolerance)


def _told_uniqueness(row: Point) -> str:
    """How it is known of a point that is ok that no memory at the start leads elsewhere; said in its model or reason.

    Of bristles nothing is asked: the deflection that repeats is looked for as if there were one.
    """
    if row.status != "ok" or isinstance(row, BristlePoint | LegsPoint | AxesPoint):
        return ""
    if isinstance(row, MemoryPoint):
        row.reason = f"{row.reason}; {row.tested}" if row.reason else row.tested
        return TESTED
    row.model = f"{row.model}; {ModelWord.BY_SLIP}"
    return PROVED


def solve_prescribed(scenes: Sequence[Scene], law: FrictionLaw, tolerance: float) -> Answers:
    """Answer scenes of prescribed slip that differ in belt speed alone."""
    rows = [_point(scene, law, tolerance) for scene in each_told(scenes)]
    for row in rows:
        if row.status == "ok" and row.found.error > tolerance:
            row.reason = f"error {row.found.error:.1e} above the tolerance: only rounding errors remain"
    found = [row.found for row in rows]
    unique = [_told_uniqueness(row) for row in rows]
    ok = np.array([row.status == "ok" for row in rows])
    low = np.array([each.low for each in found])
    return Answers(
        status=[row.status for row in rows],
        reason=[row.reason for row in rows],
        model=[row.model for row in rows],
        error_kind=[row.error_kind for row in rows],
        mean=np.array([each.mean for each in found]),
        error=np.array([each.error for each in found]),
        period=np.where(ok, float(scenes[0].periods), np.nan),
        mean_low=low,
        mean_high=np.array([each.high for each in found]),
        window=np.where(np.isnan(low), np.nan, 1.0),
        unique=unique,
        seconds=np.array([row.seconds for row in rows]),
        orbit=lambda i: rows[i].orbit(),
    )
