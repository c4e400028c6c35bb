"""What curves are read by in scenes that have more than one sine along the belt and one across it."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from typing import Any

import numpy as np

from frictionlab.laws.base import FrictionLaw
from frictionlab.scene.scene import Scene
from frictionlab.scene.signals import Signal
from frictionlab.shape.ends import Loads
from frictionlab.theory.rest import can_hold

KEYS = "waveform", "direction", "frequency_ratio", "belt_vibration", "normal_load_variation"
LOPSIDED = (
    "loads, belt and normal load do not repeat mirrored half a period later: the limit of friction at vanishing belt "
    "speed is not known"
)
STICKS = "the body sticks to a belt of vanishing speed: the start of its curve is known for one sine along the belt"
STICKS_ELASTICALLY = (
    "the body may stick elastically to a slow belt: the start of its curve is known for sines on a belt of steady "
    "speed"
)


def varies(given: Mapping[str, Any]) -> bool:
    """Whether the inputs of a row have more than sines along and across the belt."""
    parts = (name.split(".") for name, value in given.items() if value is not None and value == value)
    return any(path[0] == "scene" and path[1] != "dimensional" and {*path} & {*KEYS} for path in parts)


def scene_of(given: Mapping[str, Any]) -> Scene:
    """The scene of a row, on a belt at rest."""
    tree: dict[str, Any] = {"belt_speed": 0.0}
    for name, value in given.items():
        path = re.findall(r"[^.\[\]]+", name)
        if path[0] == "scene" and path[1] != "dimensional" and value is not None and value == value:
            held = tree
            for key in path[1:-1]:
                held = held.setdefault(key, {})
            held[path[-1]] = value
    return Scene(**_with_lists(tree))


def _with_lists(tree: Any) -> Any:
    """Mappings whose keys are 0, 1, 2 ... as lists."""
    if not isinstance(tree, dict):
        return tree
    inside = {key: _with_lists(value) for key, value in tree.items()}
    return [inside[key] for key in sorted(inside, key=int)] if "0" in inside else inside


def loads_of(scene: Scene, law: FrictionLaw | None) -> Loads:
    """The loads of a scene on a belt at rest; law: as methods received it, None where it is not known."""
    prescribed = scene.degrees_of_freedom == 0
    remembers = law is not None and law.memory_kind != "none"
    along = (0j if prescribed else scene.mass().force) if scene.is_harmonic else 0j
    across = 0.0 if scene.load_along_belt_only else 1.0
    return Loads(
        along=along,
        across=0j if prescribed else complex(across),
        across_slip=across if prescribed else 0.0,
        static_limit=math.nan,
        prescribed=prescribed,
        unknown_start=_unknown_start(scene, law),
        symmetric=True,
        lags=remembers and scene.constant_contact,
    )


def _unknown_start(scene: Scene, law: FrictionLaw | None) -> str:
    """Why friction at vanishing belt speed is not zero by symmetry; '' where it is."""
    if not repeats_mirrored(scene):
        return LOPSIDED
    if law is not None and (law.memory_kind == "deflections" or law.elastic_deflection() > 0.0):
        return STICKS_ELASTICALLY
    remembers = law is not None and law.memory_kind != "none"
    if scene.degrees_of_freedom > 0 and not remembers and (law is None or can_hold(scene, law)):
        return STICKS
    return ""


def repeats_mirrored(scene: Scene) -> bool:
    """Whether half a period later loads and belt are the opposite of what they were, and the normal load the same."""
    signals = scene.signals()
    # times without any pattern of their own
    tau = signals.period * np.mod(np.sqrt(2.0) * np.arange(1, 65), 1.0)

    def keeps(signal: Signal, sign: float) -> bool:
        now, later = signal(tau), signal(tau + 0.5 * signals.period)
        return bool(np.abs(later - sign * now).max() <= 1e-9 * np.abs(now).max())

    return all(keeps(each, -1.0) for each in (*signals.load, *signals.belt)) and keeps(
        signals.normal_load, 1.0
    )
