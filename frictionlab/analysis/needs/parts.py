"""Parts of a scene and of its contact that may go, from waveforms to the fall of friction with speed."""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable
from typing import Any

from frictionlab.analysis.needs.motion import CannotGo, LesserModel
from frictionlab.laws.base import FrictionLaw
from frictionlab.laws.coulomb import Coulomb
from frictionlab.laws.stribeck import Stribeck
from frictionlab.laws.stribeck_bristle import StribeckBristle
from frictionlab.scene.scene import Body, Scene
from frictionlab.scene.signals import FULL_TURN, signal_of
from frictionlab.scene.waveforms import SINE

SHAKING = "drive", "transverse.load", "slip", "transverse_slip", "belt_vibration", "normal_load_variation"
SIZES = "unbalance", "velocity_amplitude", "amplitude"
NOTHING_ELSE = "nothing else shakes the body: without the change of its normal load nothing moves it"
TURNED = "{}: its part along the belt points backward, and no waveform says so"
NO_SUCH_LAW = "no law without memory is known with the steady friction of this law"
NO_FRICTION = "without its fall this law has no friction: mu_kinetic is 0"


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
    return model.with_scene(**changes) if changes else None


def steady_normal_load(model: LesserModel) -> LesserModel | None:
    """Return the normal load at its mean throughout."""
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
    return model.with_scene(**changes)


def without_term(name: str) -> Callable[[LesserModel], LesserModel | None]:
    """Return the body without this key of ``body``."""

    def taken(model: LesserModel) -> LesserModel | None:
        terms, without = model.scene.body_terms, Body.model_fields[name].default
        if name not in terms:
            return None
        return model.with_scene(**({"body": None} if terms == [name] else {f"body.{name}": without}))

    return taken


def without_load_across(model: LesserModel) -> LesserModel | None:
    """Return the body free to move across the belt, but without a load that way."""
    scene = model.scene
    if scene.transverse is None:
        return None
    changes: dict[str, Any] = {} if scene.transverse.load is None else {"transverse.load": None}
    changes |= _along(scene, "drive")
    return model.with_scene(**changes) if changes else None


def on_a_line(model: LesserModel) -> LesserModel | None:
    """Return the motion along the belt alone."""
    scene = model.scene
    if not scene.planar:
        return None
    changes: dict[str, Any] = {"transverse": None, "transverse_slip": None}
    if scene.degrees_of_freedom == 0 and scene.slip is None:
        changes["slip"] = {"velocity_amplitude": 0.0, "frequency": scene.frequency}
    for path in ("drive", "slip", "belt_vibration"):
        changes |= _along(scene, path)
    if scene.initial is not None:
        changes["initial"] = {"x": scene.initial.x, "velocity": scene.initial.velocity}
    return model.with_scene(**changes)


def _part(scene: Scene, path: str) -> Any:
    found: Any = scene
    for name in path.split("."):
        found = None if found is None else getattr(found, name)
    return found


def _size(part: Any) -> tuple[str, float]:
    """Return the name of its amplitude, and that."""
    return next((name, size) for name in SIZES if (size := getattr(part, name, None)) is not None)


def _along(scene: Scene, path: str) -> dict[str, Any]:
    """Return a part at an angle to the belt turned along it; nothing for any other. Raises CannotGo."""
    part = _part(scene, path)
    if part is None or not part.direction:
        return {}
    name, size = _size(part)
    share = 0.0 if part.direction % 180.0 == 90.0 else math.cos(math.radians(part.direction))
    if share < 0.0 and not (part.waveform or SINE).antisymmetric:
        raise CannotGo(TURNED.format(path))
    return {
        f"{path}.direction": 0.0 if path == "belt_vibration" else None,
        f"{path}.{name}": size * abs(share),
        f"{path}.phase": part.phase + (180.0 if share < 0.0 else 0.0),
    }


def rigid(model: LesserModel) -> LesserModel | None:
    """Without the compliance of the contact: the law without memory of the same friction at steady sliding."""
    law = model.law
    if law.memory_kind == "none":
        return None
    if law.constant_sliding_friction():
        return model.with_law(Coulomb(mu=law.sliding_friction(0.0)))
    if not isinstance(law, StribeckBristle):
        raise CannotGo(NO_SUCH_LAW)
    same = {
        name: getattr(law, name)
        for name in ("mu_kinetic", "stribeck_speed", "stribeck_exponent", "viscosity")
    }
    return model.with_law(Stribeck(mu_static=law.peak, **same))


def undamped_bristles(model: LesserModel) -> LesserModel | None:
    """Without the damping of the bristles."""
    damped = getattr(model.law, "damping", None)
    return model.with_law(model.law.model_copy(update={"damping": None})) if damped else None


def without_fall(model: LesserModel) -> LesserModel | None:
    """Friction at rest and in slow sliding no larger than in quick sliding (mu_kinetic, of Coulomb friction mu)."""
    law = model.law
    kinetic = law.mu if isinstance(law, Coulomb) else getattr(law, "mu_kinetic", None)
    field = type(law).model_fields.get("mu_static")
    static = getattr(law, "mu_static", None)
    if field is None or kinetic is None or static in (None, kinetic):
        return None
    if kinetic == 0.0:
        raise CannotGo(NO_FRICTION)
    if isinstance(law, Stribeck):
        return model.with_law(_flat(kinetic, law.viscosity))
    left = None if field.default is None else kinetic
    return model.with_law(law.model_copy(update={"mu_static": left}))


def without_viscosity(model: LesserModel) -> LesserModel | None:
    """Without friction that grows with speed."""
    law = model.law
    if not getattr(law, "viscosity", 0.0):
        return None
    if isinstance(law, Stribeck) and law.mu_static == law.mu_kinetic:
        return model.with_law(_flat(law.mu_kinetic, 0.0))
    return model.with_law(law.model_copy(update={"viscosity": 0.0}))


def _flat(mu: float, viscosity: float) -> FrictionLaw:
    return Stribeck(mu_kinetic=mu, mu_static=mu, viscosity=viscosity) if viscosity else Coulomb(mu=mu)
