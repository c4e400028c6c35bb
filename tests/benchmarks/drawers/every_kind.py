"""Every kind of scene that the contract names, and any law (tests/draws_of_every_kind.py), by auto at 1e-8."""

from __future__ import annotations

import numpy as np
from campaign import Campaign, Drawn, covered, sound
from draws_of_every_kind import Numpy, scene_of_every_kind

from drawers.outside import from_the_answer


def draw(rng: np.random.Generator) -> Drawn:
    """A scene and a law."""
    scene, law = scene_of_every_kind(Numpy(rng))
    return Drawn(law["kind"], scene, law)


CAMPAIGN = Campaign(draw, sound, covered(from_the_answer), scenes=3000, compared=100)
