"""Answers of one chunk of scenes, as rows of the result table.

Columns that follow from a point's inputs and its mean friction, whatever the method.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import Answers, FoundState
from frictionlab.scene.scene import Scene
from frictionlab.scene.scenes import belt_speeds_of
from frictionlab.theory import friction_free_velocity
from frictionlab.values.columns import ALSO_IN_SI, SI
from frictionlab.values.quantities import Floats


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
    """Return the presliding length [scene length]; NaN for a law without a finite one."""
    length = law.presliding() if law.memory_kind == "bristle" else math.nan
    return length if math.isfinite(length) else math.nan


def si_scales(scene: Scene) -> dict[str, float]:
    """Return the units in which the results of a scene given in SI units are to be counted: N, m/s, J, s, m."""
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
    """Return the amplitude of the drive along x1, else of the load along x2 [K_1 L]; 0 where nothing pushes."""
    load = scene.transverse.load if scene.transverse is not None else None
    forces = [abs(force.phasor(scene.frequency)) for force in (scene.drive, load) if force is not None]
    return next((force for force in forces if force > 0.0), 0.0)


def _ratio(above: Floats, below: Floats) -> Floats:
    """Their quotient; NaN where the scale below is zero or infinite."""
    usable = np.isfinite(below) & (below != 0.0)
    quotient: Floats = np.divide(above, below, out=np.full(len(below), np.nan), where=usable)
    return quotient


KeptRows = dict[int, dict[str, Floats]]
"""By the place of a point, columns of equal length."""


STATE_NUMBERS = {
    **{"period": "period", "mean_friction": "mean", "error": "error", "share": "share"},
    **{"mean_low": "low", "mean_high": "high"},
}
"""Columns of numbers of a state, and the fields they are from."""


def columns_of_states(found: Sequence[FoundState]) -> dict[str, Floats]:
    """States of one row as columns of numbers."""
    return {
        name: np.array([getattr(one, field) for one in found], float) for name, field in STATE_NUMBERS.items()
    }


class Answered(NamedTuple):
    """Some points of a chunk, by their place in it, and their answers."""

    places: list[int]
    answers: Answers


@dataclass(frozen=True)
class Part:
    """Answers of points as columns, by their places.

    kept: what stands beside the table, the ``states`` of points that have several, and what a study keeps, ``orbits``
    and ``harmonics``.
    """

    text: dict[str, list[str]]
    numbers: dict[str, Floats]
    kept: dict[str, KeptRows]


def one_part(parts: Sequence[tuple[Sequence[int], Part]], size: int) -> Part:
    """Return the parts as one, each at its places; NaN where a part has no number."""
    if len(parts) == 1 and list(parts[0][0]) == list(range(size)):
        return parts[0][1]
    names = {name: None for _, part in parts for name in part.numbers}
    numbers = {name: np.full(size, np.nan) for name in names}
    text: dict[str, list[str]] = {name: [""] * size for _, part in parts for name in part.text}
    kept: dict[str, KeptRows] = {}
    for places, part in parts:
        for name, column in part.numbers.items():
            numbers[name][list(places)] = column
        for name, words in part.text.items():
            for place, word in zip(places, words, strict=True):
                text[name][place] = word
        for name, found in part.kept.items():
            kept.setdefault(name, {}).update({places[at]: columns for at, columns in found.items()})
    return Part(text, numbers, kept)
