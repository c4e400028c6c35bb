"""Harmonic balance along the belt of friction that varies with the slip speed: answers, their errors and orbits."""

from __future__ import annotations

import math
import time
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import Answers
from frictionlab.methods.exact.method import REDUCED
from frictionlab.methods.reduced.common import Modelled, far_from_full, judged, tailless_refusal
from frictionlab.methods.reduced.sliding_harmonics import SlidingMotion, balanced_sliding, sliding_balance
from frictionlab.orbit.record import Orbit
from frictionlab.quantities import Floats
from frictionlab.scene.scene import Scene
from frictionlab.scene.scenes import belt_speeds_of

ON_LEGS = (
    "{harmonics} harmonics of x1' and of friction balanced, friction integrated between the exact reversals of their "
    "slip; those beyond left out"
)
NO_TAIL_OF_SPEED = (
    "{name} has no tail in closed form where friction varies with the slip speed: beyond {harmonics} harmonics it is "
    "not constant between switches; leave tail out, or give tail: false"
)
OF_THE_SPEED = (
    "{name} in two harmonics or more needs friction that is a function of the slip speed; use shooting"
)
CROSSES_ON = (
    "Newton's method does not settle on a motion of {harmonics} harmonics: near rest their slip crosses zero again "
    "and again; use shooting"
)


def sliding_refusal(
    name: str, scene: Scene, law: FrictionLaw, harmonics: int, tail: bool | None
) -> str | None:
    """Why H harmonics cannot do this scene and law at any belt speed; None if they can."""
    no_tail = NO_TAIL_OF_SPEED.format(name=name, harmonics=harmonics) if tail else None
    return tailless_refusal(name, scene, law, OF_THE_SPEED.format(name=name), no_tail)


def sliding_means(scenes: Sequence[Scene], law: FrictionLaw, harmonics: int) -> Floats:
    """The mean friction of the model alone; NaN where there is none."""
    return _means(scenes, _motions(scenes, law, harmonics))


def answer_sliding(scenes: Sequence[Scene], law: FrictionLaw, tolerance: float, harmonics: int) -> Answers:
    """Answers on scenes that differ in belt speed alone, their errors the distance to the full means."""
    start = time.perf_counter()
    motions = _motions(scenes, law, harmonics)
    means = _means(scenes, motions)
    without = ["" if motion else CROSSES_ON.format(harmonics=harmonics) for motion in motions]
    left_out = far_from_full(scenes, law, means, without)
    text = ON_LEGS.format(harmonics=harmonics) + (REDUCED if scenes[0].degrees_of_freedom == 2 else "")

    def orbit(i: int) -> Orbit | None:
        motion = motions[i]
        return None if motion is None else _orbit(scenes[i], law, motion, float(means[i]))

    found = Modelled(means, left_out.error, time.perf_counter() - start)
    return judged(found, left_out.reasons, text, tolerance, orbit)


def _motions(scenes: Sequence[Scene], law: FrictionLaw, harmonics: int) -> list[SlidingMotion | None]:
    """From the fastest belt on, each from the one before; where that leads nowhere from the friction-free motion."""
    what = sliding_balance(scenes[0].mass(), law, harmonics)
    found: list[SlidingMotion | None] = [None] * len(scenes)
    start = free = what.friction_free()
    for i in np.argsort(-np.abs(belt_speeds_of(scenes)), kind="stable").tolist():
        for begin in (start,) if start is free else (start, free):
            found[i] = found[i] or balanced_sliding(what, scenes[i].belt_speed, begin)
        motion = found[i]
        start = motion.velocity if motion else free
    return found


def _means(scenes: Sequence[Scene], motions: Sequence[SlidingMotion | None]) -> Floats:
    means = np.array([math.nan if motion is None else -motion.friction.mean for motion in motions])
    # On a belt at rest it vanishes by symmetry.
    still = np.array([scene.belt_speed == 0.0 for scene in scenes])
    return np.where(still & np.isfinite(means), 0.0, means)


def _orbit(scene: Scene, law: FrictionLaw, motion: SlidingMotion, mean: float) -> Orbit:
    """The motion about the position where its mean friction loads the spring."""
    mass, found = scene.mass(), motion.friction
    slip = sliding_balance(mass, law, len(motion.velocity)).slip(motion.velocity)
    orbit = slip.orbit(found.tau, found.values.astype(np.complex128))
    return replace(orbit, x=orbit.x + mass.normal_load * mean, stick=None)
