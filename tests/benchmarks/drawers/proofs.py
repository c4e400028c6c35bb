"""Proofs of exact's means: one sine over decades; waveforms, vibrating belts and changing normal loads; an ulp from
where legs come and go; from the orbit of another belt speed. A proved mean may not be farther from the estimated one
than both errors.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import random_scenes
from campaign import WRONG, Campaign, Drawn, Verdicts
from certified.motion import NotProved
from certified.prove import prove, starts_of
from varying_scenes import draw_varying

from frictionlab.methods.base import Answers
from frictionlab.methods.exact.method import Exact
from frictionlab.theory.rest import is_unique

KINDS = {
    "one sine": 0.61,
    "waveforms, belts, normal loads": 0.16,
    "an ulp from a leg": 0.08,
    "from another orbit": 0.15,
}
OTHER = 1.1
"""Of the belt speed, that of the other orbit."""


def provable(one: Drawn, speed: float | None = None) -> Answers | None:
    """The answer, at another belt speed where told, if the error of that is an estimate and theorem T1 holds."""
    scene, law = one.made()
    scene = scene if speed is None else scene.model_copy(update={"belt_speed": float(speed)})
    if not is_unique(scene, law) or Exact().refusal(scene, law):
        return None
    answers = Exact().solve([scene], law, 1e-8)
    return answers if (answers.status[0], answers.error_kind[0]) == ("ok", "estimated") else None


def draw(rng: np.random.Generator) -> Drawn | None:
    """A scene and a law; None for one that is not proved."""
    kind = str(rng.choice([*KINDS], p=[*KINDS.values()]))
    scene, law = (draw_varying if kind.startswith("waveforms") else random_scenes.draw)(rng)
    one = Drawn(kind, scene.given(), {"kind": "coulomb", "mu": law.mu})
    if kind == "an ulp from a leg":
        return next_to_a_bifurcation(rng, one)
    return one if provable(one) is not None else None


def legs(one: Drawn, speed: float) -> tuple[int, ...] | None:
    """The signs of the legs, from whichever makes the tuple least."""
    if (answers := provable(one, speed)) is None:
        return None
    scene, _ = one.made()
    signs = [
        each.sign for each in starts_of(answers.orbit(0), 2.0 * math.pi * scene.periods / scene.frequency)
    ]
    return tuple(min(signs[i:] + signs[:i] for i in range(len(signs))))


def next_to_a_bifurcation(rng: np.random.Generator, one: Drawn) -> Drawn | None:
    """The scene at one of the last two doubles before and after a belt speed at which a leg comes or goes."""
    low, high = 0.7 * abs(one.scene["belt_speed"]), 1.3 * abs(one.scene["belt_speed"])
    first, last = legs(one, low), legs(one, high)
    if one.scene["damping_ratio"] < 1e-3 or first is None or first == last:
        return None
    while low < (middle := 0.5 * (low + high)) < high:
        low, high = (middle, high) if legs(one, middle) == first else (low, middle)
    speed = float(rng.choice([np.nextafter(low, 0.0), low, high, np.nextafter(high, math.inf)]))
    found = replace(one, scene=one.scene | {"belt_speed": speed})
    return found if provable(found) is not None else None


def judge(one: Drawn) -> Verdicts:
    """The proof of one mean."""
    (scene, law), answers = one.made(), provable(one)
    assert answers is not None
    other = one.kind == "from another orbit"
    trial = provable(one, OTHER * scene.belt_speed) if other else answers
    if trial is None:
        yield "no other orbit", ""
        return
    try:
        proved = prove(scene, law.mu, trial.orbit(0))
    except NotProved as why:
        yield f"not proved: {why}", ""
        return
    apart = abs(proved.mean - answers.mean[0]) > answers.error[0] + proved.error
    yield (f"{WRONG}: contradicts" if apart else "proved"), (proved, answers.mean[0], answers.error[0])


CAMPAIGN = Campaign(draw, judge, scenes=3250)
