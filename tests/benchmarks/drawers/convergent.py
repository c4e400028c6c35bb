"""Scenes that theorem T1 holds for, followed from three starts, far apart, until each repeats."""

from __future__ import annotations

import numpy as np
from campaign import WRONG, Campaign, Drawn, Keys, Unknown, Verdicts, sound
from draws_of_every_kind import Numpy, convergent_scene

from drawers.outside import followed


def draw(rng: np.random.Generator) -> Drawn:
    """A scene and a law."""
    scene, law = convergent_scene(Numpy(rng))
    return Drawn("plane" if "transverse" in scene else "line", scene, law)


def starts(scene: Keys) -> list[tuple[float, ...]]:
    """On the belt, and far ahead and behind of any motion that lasts."""
    drive, swing = scene.get("drive", {}), scene.get("belt_vibration", {}).get("velocity_amplitude", 0.0)
    far = 3.0 * (drive.get("amplitude", 0.0) + scene["normal_load"] + swing + abs(scene["belt_speed"]))
    size = 4 if "transverse" in scene else 2
    return [(), (far, -far, -far, far)[:size], (-far, far, 0.5 * far, 0.5 * far)[:size]]


def compare(one: Drawn) -> Verdicts:
    """One answer from every start, and auto's error covers the difference from it."""
    try:
        found = [followed(one, start, 1e-12, 100_000) for start in starts(one.scene)]
    except Unknown as why:
        yield f"not compared: {str(why)[-40:]}", ""
        return
    means, left = [each.mean for each in found], sum(each.error for each in found)
    yield ("compared" if np.ptp(means) <= 1e-9 + left else f"{WRONG}: two answers"), (means, left)
    state = one.answered()
    if not abs(state.mean_friction - means[0]) <= state.error + found[0].error:
        yield f"{WRONG}: uncovered", (state.mean_friction, means[0], state.error)


CAMPAIGN = Campaign(draw, sound, compare, scenes=1000, compared=1000)
