"""Planar scenes that are hard near rest (tests/random_scenes.py), by shooting."""

from __future__ import annotations

import numpy as np
from campaign import Campaign, Drawn, sound
from random_scenes import draw_near_rest


def draw(rng: np.random.Generator) -> Drawn:
    """A scene and a law."""
    scene, mu = draw_near_rest(rng)
    return Drawn("plane", scene, {"kind": "coulomb", "mu": mu}, method="shooting")


CAMPAIGN = Campaign(draw, sound, scenes=300)
