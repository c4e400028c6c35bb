"""Rate-and-state friction on every kind of scene (tests/draws_of_every_kind.py), against LSODA."""

from __future__ import annotations

import numpy as np
from campaign import Campaign, Drawn, Unknown, covered, sound
from draws_of_every_kind import Numpy, creeping_scene
from outside_creep import REPEATS, Creep

import frictionlab as fl

PERIODS = 400


def draw(rng: np.random.Generator) -> Drawn:
    """A scene and a law."""
    scene, law = creeping_scene(Numpy(rng))
    if "slip" in scene:
        kind = "prescribed"
    elif "frequency" not in str(scene):
        kind = "undriven"
    else:
        kind = "plane" if "transverse" in scene else "line"
    return Drawn(kind, scene, law, float(rng.choice([1e-5, 1e-7, 1e-8])))


def followed(one: Drawn, state: fl.SteadyState) -> tuple[float, float]:
    """The mean by LSODA, and how far it may be off."""
    if one.kind == "undriven":  # see undriven.py
        raise Unknown("no period is known")
    return Creep(one.scene, one.law).mean(PERIODS), 3.0 * REPEATS


CAMPAIGN = Campaign(draw, sound, covered(followed), scenes=500, compared=60)
