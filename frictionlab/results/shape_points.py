"""Belt speeds that a planned curve lacks for the measures of its shape, before anything is computed."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

import numpy as np

from frictionlab.laws.base import FrictionLaw
from frictionlab.quantities import Floats
from frictionlab.results.loads_in_time import start_is_known
from frictionlab.scene.scene import Scene
from frictionlab.scene.scenes import Scenes
from frictionlab.shape.interpolant import LEAST_POINTS, NO_SHARE, STEP, WIDEST_GAP
from frictionlab.theory.linear import friction_free_velocity

BEYOND = 1.05
"""The last belt speed, over the end of reversal, where that is only estimated."""
_AT_REST = 2
"""Points up to two steps of the second difference at rest."""
_DIGITS = 2
"""Of a belt speed that is told."""


def speeds_to_add(curves: Iterable[tuple[Scenes, FrictionLaw]]) -> tuple[int, list[float]]:
    """How many of these curves lack points for some measure of shape, and belt speeds that serve all, rising.

    Belt speeds in the units in which the scenes are given. The end of reversal is taken to be V_lin, as it is for
    laws of constant friction in one degree of freedom. Curves of one belt speed have no shape; those without V_lin
    are left out, and those to which no belt speed is sure to give one: of friction that changes with speed, and
    without a known start.
    """
    ends = [
        (_end(scenes.scene, law), scenes)
        for scenes, law in curves
        if len(np.unique(scenes.given)) > 1
        and law.constant_sliding_friction()
        and start_is_known(scenes.scene, law)
    ]
    lacking, added = 0, list[float]()
    for end, scenes in sorted(ends, key=lambda each: each[0]):
        if 0.0 < end < math.inf:
            lacking += bool(lacking_speeds(scenes.given, end))
            added += lacking_speeds([*scenes.given, *added], end)
    return lacking, sorted(added)


def _end(scene: Scene, law: FrictionLaw) -> float:
    """V_lin in the units in which the scene is given."""
    si = scene.dimensional
    return friction_free_velocity(scene, law) * (1.0 if si is None else si.scales.velocity)


def lacking_speeds(speeds: Floats | Sequence[float], end: float) -> list[float]:
    """Belt speeds that all measures of shape ask for, beyond those given. end: of reversal, > 0."""
    known = sorted({float(speed) for speed in speeds if speed > NO_SHARE * end})
    given = set(known)
    if not known or known[-1] < end:
        known.append(_round(BEYOND * end))
    near = 2.0 * STEP * end
    while sum(speed <= near for speed in known) < _AT_REST:
        first = min(known)
        known = sorted([*known, _round(0.8 * near if first > near else 0.5 * first)])
    while True:
        places = np.array([0.0, *(speed for speed in known if speed < end), end])
        widest = int(np.argmax(np.diff(places)))
        gap = float(places[widest + 1] - places[widest])
        if gap <= WIDEST_GAP * end and len(places) - 2 >= LEAST_POINTS:
            return [speed for speed in known if speed not in given]
        parts = max(2, math.ceil(gap / (0.95 * WIDEST_GAP * end)))
        between = (places[widest] + gap * part / parts for part in range(1, parts))
        known = sorted({*known, *map(_round, between)})


def _round(speed: float) -> float:
    """A speed that one likes to type."""
    return float(f"{speed:.{_DIGITS}g}")
