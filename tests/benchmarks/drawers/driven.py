"""Driven scenes of every law, on the line and in the plane, with a period map of their own."""

from __future__ import annotations

import random

import numpy as np
from campaign import Drawn

from drawers import every_law
from frictionlab.methods.shooting.decoupled import axes_apart
from frictionlab.study.grid import law_in_scene


def draw(rng: np.random.Generator) -> Drawn | None:
    """A driven scene with its law; None for one without a period map of its own."""
    one = every_law.draw(random.Random(int(rng.integers(2**32))))
    if one["freedom"] == 0 or "drive" not in one["scene"] or one["scene"]["belt_speed"] == 0.0:
        return None
    if one["law"]["kind"] in every_law.PLUGINS:
        return None
    scene = {name: value for name, value in one["scene"].items() if name != "initial"}
    exact = one["freedom"] == 1 and one["family"] == "coulomb" and rng.random() < 0.5
    kind = f"{one['family']}, {'line' if one['freedom'] == 1 else 'plane'}"
    found = Drawn(kind, scene, one["law"], method="exact" if exact else "shooting")
    made, law = found.made()
    return None if axes_apart(made, law_in_scene(law, made)) else found
