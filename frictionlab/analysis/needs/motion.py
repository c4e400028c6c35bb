"""Simpler ways to find the motion, without friction's effect on it, its higher harmonics, stick.

A scene and a law with some of their parts taken away, and the way its motion is found.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.reduced.common import line_refusal, steadied, steadied_all
from frictionlab.methods.reduced.reversals import DrivenLine, exact_response, reversals_at
from frictionlab.scene.scene import Scene
from frictionlab.scene.scenes import belt_speeds_of
from frictionlab.scene.waveforms import MOST_TERMS, Form, Term
from frictionlab.study import registry
from frictionlab.theory.linear import friction_free_response, friction_free_velocity, less
from frictionlab.theory.piecewise import Piecewise, piecewise
from frictionlab.values.quantities import Floats


class CannotGo(Exception):
    """Why a part of a model cannot be taken away, as a sentence."""


class MotionWay(Protocol):
    """A reduced model of the motion, as far as it is needed here: what it refuses, and its means without an error."""

    @property
    def name(self) -> str:
        """Return what it is called."""

    def refusal(self, scene: Scene, law: FrictionLaw) -> str | None:
        """Why it cannot do this scene and law; None where it can."""

    def model_means(self, scenes: Sequence[Scene], law: FrictionLaw) -> Floats | NDArray[np.complex128]:
        """Mean friction of the model at scenes that differ in belt speed alone; NaN where it has none."""


@dataclass(frozen=True)
class LesserModel:
    """A scene at any belt speed and a law in its scales. way: the reduced model of the motion, None for ``auto``."""

    scene: Scene
    law: FrictionLaw
    way: MotionWay | None = None

    @property
    def method(self) -> MotionWay | str:
        """Return what solves it: a reduced model, or ``auto``."""
        return self.way or "auto"

    def with_scene(self, **changes: Any) -> LesserModel:
        """With other values of the scene, as ``Scene.with_`` takes them. Raises WrongValues."""
        return replace(self, scene=self.scene.with_(**changes))

    def with_law(self, law: FrictionLaw) -> LesserModel:
        """With another law."""
        return replace(self, law=law)

    def with_way(self, way: MotionWay) -> LesserModel:
        """With a reduced model of the motion. Raises CannotGo where that refuses."""
        if reason := way.refusal(self.scene, self.law):
            raise CannotGo(reason)
        return replace(self, way=way)


Taken = Callable[[LesserModel], LesserModel | None]
"""Takes a part away; None where the model has no such part. Raises CannotGo, WrongValues."""


UNDRIVEN = "nothing shakes the body: without friction it does not move"
BENT_MOTION = "the friction-free motion of a body that is not linear has no closed form"
UNTOLD_MOTION = "the table of the body does not tell how it moves without friction: its load reaches beyond"
UNBOUNDED_MOTION = "the friction-free motion is unbounded: undamped resonance"
WITH_SPEED = "the friction that moves the body under this normal load changes with belt speed"
NO_WAVEFORM = "the friction-free motion is no sum of harmonics: no waveform of a prescribed slip says so"
ON_SAMPLES = (
    "in the plane harmonics are balanced on samples of a period, and what those miss is not told apart from what the "
    "harmonics do"
)
NOT_SINES = "the motion without rest is known for one sine along the belt under a constant normal load"
FRICTION_FREE = "mdsm"
"""Method of the friction-free motion."""
ORDERS_KEPT = (1, 3, 5, 9)
"""Harmonics to which the motion is cut."""


def friction_free_of(model: LesserModel) -> LesserModel | None:
    """Return the motion as if there were no friction, friction averaged over it."""
    if model.scene.degrees_of_freedom == 0:
        return None
    if model.scene.undriven:
        raise CannotGo(UNDRIVEN)
    averaged = _method(FRICTION_FREE)
    if averaged.refusal(model.scene, model.law) is None:
        return model.with_way(averaged)
    return LesserModel(_prescribed(model), model.law)


def cut_to(harmonics: int) -> Taken:
    """Return the motion and friction cut to so many harmonics, which balance."""
    return partial(_balanced, harmonics)


def _balanced(harmonics: int, model: LesserModel) -> LesserModel | None:
    if model.scene.degrees_of_freedom == 0:
        return None
    if not model.scene.load_along_belt_only:
        raise CannotGo(ON_SAMPLES)
    return model.with_way(_method("harmonic_balance", **({"harmonics": harmonics} if harmonics > 1 else {})))


def orders() -> tuple[int, ...]:
    """Return the numbers of harmonics that the installed balance can be cut to."""
    several = "harmonics" in registry.method_class("harmonic_balance").model_fields
    return ORDERS_KEPT if several else ORDERS_KEPT[:1]


def _method(name: str, **parameters: Any) -> MotionWay:
    found: Any = registry.method_class(name)(**parameters)
    return found


def _prescribed(model: LesserModel) -> Scene:
    """Return the scene of the friction-free motion as a prescribed slip. Raises CannotGo."""
    scene, law = model.scene, model.law
    if scene.bends:
        raise CannotGo(BENT_MOTION)
    normal = scene.normal_load_variation
    if normal is not None and not law.constant_sliding_friction():
        raise CannotGo(WITH_SPEED)
    along, across = (_oscillation(each, scene.frequency) for each in _slip_without_friction(scene, law))
    changes: dict[str, Any] = {"slip": {**along, "frequency": scene.frequency}}
    if scene.planar:
        changes["transverse_slip"] = across
    if normal is not None:
        changes["normal_load_variation"] = normal.model_copy(update={"frequency": None})
    return Scene(belt_speed=scene.belt_speed, normal_load=scene.normal_load, **changes)


def _slip_without_friction(scene: Scene, law: FrictionLaw) -> tuple[Piecewise, Piecewise]:
    """Along the belt and across it, on a belt whose mean velocity is zero. Raises CannotGo."""
    signals = scene.signals()
    if scene.remembers and (signals.load[0].pieces or signals.normal_load.pieces):
        raise CannotGo(NO_WAVEFORM)
    if scene.remembers and math.isnan(friction_free_velocity(scene, law)):
        raise CannotGo(UNTOLD_MOTION)
    free = friction_free_response(scene, law, 1)
    if free is None:
        raise CannotGo(UNBOUNDED_MOTION)
    along, across = (
        less(own, piecewise(belt, signals.edges())) for own, belt in zip(free, signals.belt, strict=True)
    )
    return along, across


def _oscillation(velocity: Piecewise, frequency: float) -> dict[str, Any]:
    """Amplitude, phase and waveform of a prescribed slip. Raises CannotGo."""
    if velocity.free is not None and (velocity.free.x.any() or velocity.free.v.any()):
        raise CannotGo(NO_WAVEFORM)
    if velocity.middle.any() or velocity.slope.any():
        raise CannotGo(NO_WAVEFORM)
    found: dict[int, complex] = {}
    for each in velocity.waves:
        order = round(each.frequency / frequency)
        if not (1 <= order <= MOST_TERMS and math.isclose(order * frequency, each.frequency)):
            raise CannotGo(NO_WAVEFORM)
        found[order] = found.get(order, 0j) + each.phasor
    if set(found) <= {1}:
        size, phase = cmath.polar(found.get(1, 0j))
        return {"velocity_amplitude": size, "phase": math.degrees(phase)}
    terms = tuple(Term(k, abs(z), math.degrees(cmath.phase(z))) for k, z in sorted(found.items()))
    return {"velocity_amplitude": 1.0, "waveform": Form("harmonics", terms)}


def slipping(model: LesserModel) -> LesserModel | None:
    """Return the motion that never rests."""
    return None if model.scene.degrees_of_freedom == 0 else model.with_way(WithoutRest())


class WithoutRest:
    """Motion of two reversals a period with all its harmonics, consistent with friction at rest or not."""

    name = "two reversals"

    def refusal(self, scene: Scene, law: FrictionLaw) -> str | None:
        """Anything but Coulomb friction along the belt under one sine."""
        steady = steadied(scene)
        return NOT_SINES if steady is None else line_refusal("the motion without rest", steady, law)

    def model_means(self, scenes: Sequence[Scene], law: FrictionLaw) -> Floats:
        """One less twice the share of forward slip, NaN without such a motion; from V_lin on slip never reverses."""
        steady = steadied_all(scenes)
        mu, speeds, mass = law.sliding_friction(1.0), belt_speeds_of(steady), steady[0].mass()
        line = DrivenLine(exact_response(mass), mu * mass.normal_load, friction_free_velocity(steady[0]))
        reverses = np.abs(speeds) < line.friction_free
        found = reversals_at(line, np.where(reverses, np.abs(speeds), 0.0))
        mean = np.where(np.isnan(found.middle), np.nan, 1.0 - 2.0 / np.pi * found.half)
        return mu * np.copysign(np.where(reverses, mean, 1.0), speeds)
