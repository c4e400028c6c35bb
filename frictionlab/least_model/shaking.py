"""Parts of the scene that may go: waveforms, the change of the normal load, what moves or acts across the belt."""

from __future__ import annotations

import cmath
import math
from typing import Any

from frictionlab.least_model.lesser import CannotGo, LesserModel
from frictionlab.scene.scene import Scene
from frictionlab.scene.signals import FULL_TURN, signal_of
from frictionlab.scene.waveforms import SINE

SHAKING = "drive", "transverse.load", "slip", "transverse_slip", "belt_vibration", "normal_load_variation"
SIZES = "unbalance", "velocity_amplitude", "amplitude"
NOTHING_ELSE = "nothing else shakes the body: without the change of its normal load nothing moves it"
TURNED = "{}: its part along the belt points backward, and no waveform says so"


def sines(model: LesserModel) -> LesserModel | None:
    """Every waveform as its first harmonic."""
    changes: dict[str, Any] = {}
    for path in SHAKING:
        part = _part(model.scene, path)
        if part is not None and part.waveform not in (None, SINE):
            first = signal_of(part.waveform, 1.0, part.phase).harmonic(1.0, FULL_TURN)
            name, size = _size(part)
            changes[f"{path}.waveform"] = SINE
            changes[f"{path}.{name}"] = size * abs(first)
            changes[f"{path}.phase"] = math.degrees(cmath.phase(first))
    return _changed(model, changes)


def steady_normal_load(model: LesserModel) -> LesserModel | None:
    """The normal load at its mean throughout."""
    scene = model.scene
    part, belt = scene.normal_load_variation, scene.belt_vibration
    if part is None:
        return None
    if scene.drive is None and belt is None and scene.degrees_of_freedom > 0:
        raise CannotGo(NOTHING_ELSE)
    changes: dict[str, Any] = {"normal_load_variation": None}
    if part.frequency is not None and belt is not None:
        changes["belt_vibration.frequency"] = part.frequency * (belt.frequency_ratio or 1.0)
        changes["belt_vibration.frequency_ratio"] = None
    return _changed(model, changes)


def without_load_across(model: LesserModel) -> LesserModel | None:
    """The body free to move across the belt, but without a load that way."""
    scene = model.scene
    if scene.transverse is None:
        return None
    changes: dict[str, Any] = {}
    if scene.transverse.load is not None:
        changes["transverse.load"] = None
    if _aslant(scene, "drive"):
        changes |= _along(scene, "drive")
    return _changed(model, changes)


def on_a_line(model: LesserModel) -> LesserModel | None:
    """The motion along the belt alone."""
    scene = model.scene
    if not scene.planar:
        return None
    changes: dict[str, Any] = {"transverse": None, "transverse_slip": None}
    if scene.degrees_of_freedom == 0 and scene.slip is None:
        changes["slip"] = {"velocity_amplitude": 0.0, "frequency": scene.frequency}
    for path in ("drive", "slip", "belt_vibration"):
        if _aslant(scene, path):
            changes |= _along(scene, path)
    if scene.initial is not None:
        changes["initial"] = {"x": scene.initial.x, "velocity": scene.initial.velocity}
    return _changed(model, changes)


def _changed(model: LesserModel, changes: dict[str, Any]) -> LesserModel | None:
    if not changes:
        return None
    return model.with_scene(**changes)


def _part(scene: Scene, path: str) -> Any:
    found: Any = scene
    for name in path.split("."):
        found = None if found is None else getattr(found, name)
    return found


def _size(part: Any) -> tuple[str, float]:
    """The name of its amplitude, and that."""
    return next((name, size) for name in SIZES if (size := getattr(part, name, None)) is not None)


def _aslant(scene: Scene, path: str) -> bool:
    part = _part(scene, path)
    return part is not None and bool(part.direction)


def _along(scene: Scene, path: str) -> dict[str, Any]:
    """Of a part at an angle to the belt that along it. Raises CannotGo."""
    part = _part(scene, path)
    name, size = _size(part)
    share = 0.0 if part.direction % 180.0 == 90.0 else math.cos(math.radians(part.direction))
    if share < 0.0 and not (part.waveform or SINE).antisymmetric:
        raise CannotGo(TURNED.format(path))
    return {
        f"{path}.direction": 0.0 if path == "belt_vibration" else None,
        f"{path}.{name}": size * abs(share),
        f"{path}.phase": part.phase + (180.0 if share < 0.0 else 0.0),
    }
