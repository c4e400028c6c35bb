"""Coulomb friction on the line, friction, frequency, damping and belt speed over decades (tests/random_scenes.py)."""

from __future__ import annotations

import numpy as np
import random_scenes
from campaign import Campaign, Drawn, covered, sound

from drawers.outside import from_the_answer


def draw(rng: np.random.Generator) -> Drawn:
    """A scene and a law."""
    scene, law = random_scenes.draw(rng)
    return Drawn("line", scene.given(), {"kind": "coulomb", "mu": law.mu}, method="exact")


CAMPAIGN = Campaign(draw, sound, covered(from_the_answer), scenes=100_000, compared=0)
