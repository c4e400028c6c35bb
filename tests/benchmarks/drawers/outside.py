"""Campaigns against the tests' own integration of any scene, which shares no code with the package."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import random_scenes
from campaign import WRONG, Campaign, Drawn, Keys, Unknown, Verdicts, covered, sound
from draws_of_every_kind import Numpy, convergent_scene, scene_of_every_kind
from outside_state import Outside, Unsettled, steady
from varying_scenes import draw_varying

import frictionlab as fl


def followed(
    one: Drawn, start: tuple[float, ...] = (), tolerance: float = 1e-13, periods: int = 4000
) -> Outside:
    """The motion from a start until it repeats. Raises Unknown."""
    try:
        return steady(one.scene, one.law, start, tolerance, periods)
    except Unsettled as why:
        raise Unknown(str(why)) from None


def from_the_answer(one: Drawn, state: fl.SteadyState) -> tuple[float, float]:
    """The mean of the motion followed from a state of the answer, and its error."""
    start: tuple[float, ...] = ()
    if "slip" not in one.scene:
        first = state.orbit(1)
        parts = (
            (first.x1, first.v1, first.x2, first.v2) if "transverse" in one.scene else (first.x1, first.v1)
        )
        start = tuple(float(part[0]) for part in parts)
    found = followed(one, start)
    return found.mean, found.error


def on_the_line(drawn: Callable[[np.random.Generator], tuple[fl.Scene, fl.Coulomb]]) -> Callable[..., Drawn]:
    """Draws of Coulomb friction along the belt, answered by exact."""

    def draw(rng: np.random.Generator) -> Drawn:
        scene, law = drawn(rng)
        return Drawn("line", scene.given(), {"kind": "coulomb", "mu": law.mu}, method="exact")

    return draw


def near_rest(rng: np.random.Generator) -> Drawn:
    """A scene in the plane that is hard near rest."""
    scene, mu = random_scenes.draw_near_rest(rng)
    return Drawn("plane", scene, {"kind": "coulomb", "mu": mu}, method="shooting")


def every_kind(rng: np.random.Generator) -> Drawn:
    """Any scene that the contract names, and any law."""
    scene, law = scene_of_every_kind(Numpy(rng))
    return Drawn(law["kind"], scene, law)


def convergent(rng: np.random.Generator) -> Drawn:
    """A scene that theorem T1 holds for."""
    scene, law = convergent_scene(Numpy(rng))
    return Drawn("plane" if "transverse" in scene else "line", scene, law)


def starts(scene: Keys) -> list[tuple[float, ...]]:
    """On the belt, and far ahead and behind of any motion that lasts."""
    drive, swing = scene.get("drive", {}), scene.get("belt_vibration", {}).get("velocity_amplitude", 0.0)
    far = 3.0 * (drive.get("amplitude", 0.0) + scene["normal_load"] + swing + abs(scene["belt_speed"]))
    size = 4 if "transverse" in scene else 2
    return [(), (far, -far, -far, far)[:size], (-far, far, 0.5 * far, 0.5 * far)[:size]]


def from_three_starts(one: Drawn) -> Verdicts:
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


COVERED = covered(from_the_answer)
EXACT = Campaign(on_the_line(random_scenes.draw), sound, COVERED, scenes=100_000, compared=0)
VARYING = Campaign(on_the_line(draw_varying), sound, COVERED, scenes=10_000, compared=0)
EVERY_KIND = Campaign(every_kind, sound, COVERED, scenes=3000, compared=100)
NEAR_REST = Campaign(near_rest, sound, COVERED, scenes=300)
CONVERGENT = Campaign(convergent, sound, from_three_starts, scenes=1000, compared=1000)
