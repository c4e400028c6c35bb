"""Loads by which curves are read in scenes that have more than one sine along the belt and one across it.

Belt speeds that a planned curve lacks for the measures of its shape, before anything is computed.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from frictionlab.curves.ends import Loads
from frictionlab.curves.interpolant import LEAST_POINTS, NO_SHARE, STEP, WIDEST_GAP
from frictionlab.laws.base import FrictionLaw
from frictionlab.runner.part import force_amplitude
from frictionlab.scene.free_body import bound
from frictionlab.scene.scene import Scene
from frictionlab.scene.scenes import Scenes
from frictionlab.scene.signals import Signal
from frictionlab.scene.waveforms import told
from frictionlab.theory.linear import friction_free_velocity
from frictionlab.theory.piecewise import piecewise
from frictionlab.theory.prescribed import mean_direction
from frictionlab.theory.rest import can_hold, resting_range
from frictionlab.values.quantities import Floats

_ADDED = "body", "belt_vibration", "normal_load_variation"
KEYS = "waveform", "direction", "frequency_ratio", "offset", "spring", *_ADDED
LOPSIDED = (
    "loads, belt, normal load or springs are not mirrored half a period later: the limit of friction at vanishing "
    "belt speed is not known"
)
ONE_SIDED = "friction is not the same to both sides: its limit at vanishing belt speed is not known"
JUMPS = (
    "friction jumps at the end of reversal, where slip rests for a part of the period: it has no shape there"
)
STICKS = (
    "the body sticks to a belt of vanishing speed: the start of its curve is known for constant friction, linear "
    "springs and loads along the belt"
)
STICKS_ELASTICALLY = (
    "the body may stick elastically to a slow belt: the start of its curve is known for sines on a belt of steady "
    "speed"
)


def varies(given: Mapping[str, Any]) -> bool:
    """Check whether the inputs of a row have more than sines along and across the belt."""
    parts = (name.split(".") for name, value in given.items() if value is not None and value == value)
    return any(path[0] == "scene" and path[1] != "dimensional" and {*path} & {*KEYS} for path in parts)


def scene_of(given: Mapping[str, Any]) -> Scene:
    """Return the scene of a row, on a belt at rest and without a start."""
    tree: dict[str, Any] = {"belt_speed": 0.0}
    for name, value in given.items():
        path = name.split(".")
        if path[0] == "scene" and path[1] != "dimensional" and value is not None and value == value:
            held = tree
            for key in path[1:-1]:
                held = held.setdefault(key, {})
            held[path[-1]] = told(value) if path[-1] == "waveform" else value
    return Scene(**(tree | {"initial": None}))


def loads_of(given: Mapping[str, Any], law: FrictionLaw | None) -> Loads:
    """Return the loads of a row; law: as methods received it, None where it is not known."""
    scene = bound(Scenes.of([scene_of(given)]))[0]
    prescribed = scene.degrees_of_freedom == 0
    remembers = law is not None and law.memory_kind != "none"
    along = (0j if prescribed else scene.mass().force) if scene.is_harmonic else 0j
    across = 0.0 if scene.load_along_belt_only else 1.0
    start, unknown = _start(scene, law)
    return Loads(
        along=along,
        across=0j if prescribed else complex(across),
        across_slip=across if prescribed else 0.0,
        static_limit=math.nan,
        prescribed=prescribed,
        unknown_start=unknown,
        start=start,
        lags=remembers and scene.constant_contact,
        # where forces are not told, in shares of the largest
        normal_load=(scene.normal_load or 0.0)
        / (1.0 if scene.is_harmonic else force_amplitude(scene) or math.nan),
        varying=law is not None and not law.constant_sliding_friction(),
    )


def start_is_known(scene: Scene, law: FrictionLaw) -> bool:
    """Check whether a curve of this scene has a known mean friction at vanishing belt speed."""
    scene = bound(Scenes.of([scene]))[0]
    varied = scene.belt_vibration is not None or scene.normal_load_variation is not None
    if not scene.is_harmonic or varied or scene.body_terms or not law.obeys("oddness"):
        return not _start(scene, law)[1]
    holds = law.memory_kind == "none" and scene.degrees_of_freedom > 0 and can_hold(scene, law)
    return not holds or (scene.load_along_belt_only and law.monotone())


def _start(scene: Scene, law: FrictionLaw | None) -> tuple[float, str]:
    """Return the mean friction at vanishing belt speed, or why it is not known; zero if both directions are alike.

    A body that the belt can hold at rest has there the largest mean friction at which it does not slip.
    """
    remembers = law is not None and law.memory_kind != "none"
    prescribed = scene.degrees_of_freedom == 0
    if prescribed and not remembers and _rests_at_its_largest(scene):
        return math.nan, JUMPS
    if law is not None and not law.obeys("oddness"):
        return math.nan, ONE_SIDED
    if (
        not prescribed
        and not remembers
        and law is not None
        and (most := resting_range(scene, law)) > -math.inf
    ):
        # the belt carries the body until friction just gives way at the peak of the load
        constant = law.constant_sliding_friction() and law.monotone() and not scene.body_terms
        return (most, "") if constant and scene.load_along_belt_only else (math.nan, STICKS)
    if not repeats_mirrored(scene):
        along = prescribed and scene.load_along_belt_only
        if along and law is not None and not remembers and law.constant_sliding_friction():
            return law.sliding_friction(1.0) * _direction(scene), ""
        return math.nan, LOPSIDED
    if law is not None and (law.memory_kind == "deflections" or law.elastic_deflection() > 0.0):
        return math.nan, STICKS_ELASTICALLY
    return (math.nan, STICKS) if law is None and not prescribed else (0.0, "")


def _rests_at_its_largest(scene: Scene) -> bool:
    """Check whether a slip along the belt keeps its largest velocity for a while, as a square one does."""
    signals = scene.signals()
    slip = piecewise(signals.belt[0], signals.edges())
    flat = np.abs(slip.middle[(slip.slope == 0.0) & (slip.curvature() == 0.0)])
    return scene.load_along_belt_only and bool(np.any(flat >= (1.0 - 1e-12) * slip.size()))


def _direction(scene: Scene) -> float:
    """Mean Coulomb friction of a slip along a belt at rest, relative to its coefficient."""
    assert scene.normal_load is not None
    signals = scene.signals()
    edges = signals.edges()
    load = piecewise(signals.normal_load.scaled(1.0 / scene.normal_load), edges, 1.0)
    return mean_direction(piecewise(signals.belt[0], edges), load).mean


def repeats_mirrored(scene: Scene) -> bool:
    """Check whether half a period later loads and belt are opposite, and the normal load the same.

    Never of a spring that is not the same to both sides.
    """
    if scene.body is not None and scene.body.curvature:
        return False
    signals = scene.signals()
    # times without any pattern of their own
    tau = signals.period * np.mod(np.sqrt(2.0) * np.arange(1, 65), 1.0)

    def keeps(signal: Signal, sign: float) -> bool:
        now, later = signal(tau), signal(tau + 0.5 * signals.period)
        return bool(np.abs(later - sign * now).max() <= 1e-9 * np.abs(now).max())

    return all(keeps(each, -1.0) for each in (*signals.load, *signals.belt)) and keeps(
        signals.normal_load, 1.0
    )


BEYOND = 1.05
"""Last belt speed, over the end of reversal, where that is only estimated."""
_AT_REST = 2
"""Points up to two steps of the second difference at rest."""
_DIGITS = 2
"""Digits of a belt speed that is told."""


def speeds_to_add(curves: Iterable[tuple[Scenes, FrictionLaw]]) -> tuple[int, list[float]]:
    """Return how many of these curves lack points for some measure of shape, and belt speeds that serve all, rising.

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
