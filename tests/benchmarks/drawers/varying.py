"""Waveforms, vibrating belts and changing normal loads on the line (tests/varying_scenes.py)."""

from __future__ import annotations

import numpy as np
from campaign import Campaign, Drawn, covered, sound
from varying_scenes import draw_varying

from drawers.outside import from_the_answer


def draw(rng: np.random.Generator) -> Drawn:
    """A scene and a law."""
    scene, law = draw_varying(rng)
    return Drawn("line", scene.given(), {"kind": "coulomb", "mu": law.mu}, method="exact")


CAMPAIGN = Campaign(draw, sound, covered(from_the_answer), scenes=10_000, compared=0)
