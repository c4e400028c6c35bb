"""Planar scenes that are hard near rest (tests/random_scenes.py), by shooting."""

from __future__ import annotations

import numpy as np
from campaign import Campaign, Drawn, covered, sound
from random_scenes import draw_near_rest

from drawers.outside import from_the_answer


def draw(rng: np.random.Generator) -> Drawn:
    """A scene and a law."""
    scene, mu = draw_near_rest(rng)
    return Drawn("plane", scene, {"kind": "coulomb", "mu": mu}, method="shooting")


CAMPAIGN = Campaign(draw, sound, covered(from_the_answer), scenes=300)
