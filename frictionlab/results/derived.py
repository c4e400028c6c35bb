"""Columns that follow from a point's inputs and its mean friction, whatever the method."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from frictionlab.columns import ALSO_IN_SI, SI
from frictionlab.laws.base import FrictionLaw
from frictionlab.quantities import Floats
from frictionlab.scene.scene import Scene
from frictionlab.scene.scenes import belt_speeds_of
from frictionlab.theory import friction_free_velocity


def derived_columns(scenes: Sequence[Scene], law: FrictionLaw, mean_friction: Floats) -> dict[str, Floats]:
    """Mean friction, belt speed, friction force against their natural scales; NaN where a scale is zero.

    scenes: that differ in belt speed alone.
    ``presliding_ratio`` stays empty for laws without a presliding length.
    """
    scene, speed = scenes[0], belt_speeds_of(scenes)
    free = _friction_free(scenes, law)
    slips = np.abs(speed).tolist()
    if law.constant_sliding_friction():
        sliding = np.full(len(slips), law.sliding_friction(slips[0]))
    else:
        sliding = np.array([law.sliding_friction(each) for each in slips])
    limit = (scene.normal_load or 0.0) * sliding
    return {
        "normalized_friction": _ratio(mean_friction, sliding * np.sign(speed)),
        "velocity_ratio": _ratio(speed, free),
        "friction_to_drive": _ratio(limit, np.full(len(speed), force_amplitude(scene))),
        "presliding_ratio": _ratio(np.full(len(speed), _presliding(law) * scene.frequency), free),
    }


def _friction_free(scenes: Sequence[Scene], law: FrictionLaw) -> Floats:
    """V_lin of each; another on a belt that runs backward, and at every speed where friction that varies pulsates."""
    first, speed = scenes[0], belt_speeds_of(scenes)
    if first.is_harmonic:
        return np.full(len(speed), friction_free_velocity(first))
    pulsates = first.normal_load_variation is not None and not law.constant_sliding_friction()
    _, places, back = np.unique(speed if pulsates else np.sign(speed), return_index=True, return_inverse=True)
    return np.array([friction_free_velocity(scenes[i], law) for i in places.tolist()])[back]


def _presliding(law: Any) -> float:
    """The presliding length [scene length]; NaN for a law without a finite one."""
    length = law.presliding() if law.memory_kind == "bristle" else math.nan
    return length if math.isfinite(length) else math.nan


def si_scales(scene: Scene) -> dict[str, float]:
    """The units in which the results of a scene given in SI units are to be counted: N, m/s, J, s, m."""
    assert scene.dimensional is not None
    scales = scene.dimensional.scales
    return {
        "load": scene.dimensional.load,
        "velocity": scales.velocity,
        "energy": scales.energy,
        "drive period": 2.0 * math.pi / scene.frequency * scales.time,
        "length": scales.length,
        "time": scales.time,
        "force": scales.force,
    }


def si_columns(found: Mapping[str, Floats], scales: Mapping[str, Floats]) -> dict[str, Floats]:
    """Results in SI units."""
    told = {name: made for name, made in SI.items() if made.column in found}
    return {name: found[made.column] * scales[made.scale] for name, made in told.items()}


def beside_in_si(found: Mapping[str, Any], scales: Mapping[str, Any]) -> dict[str, Any]:
    """Columns of orbits and their like in SI units, to stand behind them; none without scales."""
    told = {name: ALSO_IN_SI[name] for name in found if name in ALSO_IN_SI}
    return {name: found[of] * scales[scale] for of, (name, scale) in told.items() if scale in scales}


def force_amplitude(scene: Scene) -> float:
    """Of the drive along x1, else of the load along x2 [K_1 L]; 0 where nothing pushes."""
    load = scene.transverse.load if scene.transverse is not None else None
    forces = [abs(force.phasor(scene.frequency)) for force in (scene.drive, load) if force is not None]
    return next((force for force in forces if force > 0.0), 0.0)


def _ratio(above: Floats, below: Floats) -> Floats:
    """Their quotient; NaN where the scale below is zero or infinite."""
    usable = np.isfinite(below) & (below != 0.0)
    quotient: Floats = np.divide(above, below, out=np.full(len(below), np.nan), where=usable)
    return quotient
