"""Body that no spring holds, as the limit of ever softer springs.

On a belt of given speed, held by a constant force, such a body repeats its motion. A spring of stiffness k holds it
by the same mean force; what its force varies by is k times the size of the motion. The motion thus depends smoothly
on k while slip reverses and rests in the same order: numbers found at three stiffnesses lie on a parabola in k, but
for terms of k^3, and its value at k = 0 is the answer. Its difference from the line through the two softest springs
is a part of the error that is stated. The other is for a reversal that appears between the softest spring and none:
it changes the mean by about k^(3/2) (a slip that dips by d below zero lasts sqrt(d), and its path is d^(3/2)).

A dashpot beside the spring, as weak as the spring, lets motions that begin apart come together.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from frictionlab.scene.scene import Scene
from frictionlab.scene.scenes import Scenes
from frictionlab.scene.units import Units
from frictionlab.values.quantities import Floats

COUNT = 3
_RATIOS = {True: 128.0, False: 256.0}
"""Frequency of the vibration over that of the stiffest spring, where friction remembers and where not: bristles come
to rest on soft springs over hundreds of periods. Each spring has half the stiffness of the one before."""
NEW_EVENT = 0.1
"""Change of the mean by a reversal that appears, over k^(3/2) and friction; .01 to .02 in the strongest case."""


def springs_for(scene: Scene, remembers: bool) -> list[Units]:
    """Return units in which ever softer springs for a scene whose body is free have stiffness 1, as its mass."""
    slowest = scene.frequency / scene.periods
    roots = [slowest / (_RATIOS[remembers] * math.sqrt(2.0) ** j) for j in range(COUNT)]
    return [Units(1.0, 1.0 / root, root**2) for root in roots]


def by_new_events(remembers: bool) -> float:
    """Return the share of friction by which events between the softest spring and none may change a mean."""
    return float(NEW_EVENT * (_RATIOS[remembers] ** 2 * 2.0 ** (COUNT - 1)) ** -1.5)


def held(scenes: Scenes, units: Units) -> Scenes:
    """Return the scenes in these units, the body on the spring that they are of."""
    found = scenes.measured(units)
    ratio = scenes.scene.frequency / scenes.scene.periods * units.time
    damping_ratio = (found.scene.damping_ratio or 0.0) * units.time + 0.5 / ratio
    scene = found.scene.model_copy(update={"spring": None, "damping_ratio": damping_ratio})
    return Scenes(scene, found.given)


def bound(scenes: Scenes) -> Scenes:
    """Return the scenes, a free body on the softest of these springs, for what does not depend on it."""
    return held(scenes, springs_for(scenes.scene, remembers=False)[-1]) if scenes.scene.is_free else scenes


def _weights(count: int) -> Floats:
    """Return the weights of values at stiffnesses 1, 1/2, 1/4, ... in that of their polynomial at 0."""
    k = 0.5 ** np.arange(count)
    return np.array([np.prod([other / (other - one) for other in k if other != one]) for one in k])


class LimitOfSprings(NamedTuple):
    """Value for no spring, and its distance from what all springs but the stiffest give."""

    value: Floats
    change: Floats


WEIGHTS_OF_SPRINGS = _weights(COUNT)
_FEWER = np.concatenate([[0.0], _weights(COUNT - 1)])


def without_spring(values: Floats) -> LimitOfSprings:
    """Return the limit of values [springs, ...] found with each spring; of equal ones that value."""
    same = values.min(axis=0) == values.max(axis=0)
    limit, fewer = (
        np.where(same, values[-1], np.tensordot(w, values, 1)) for w in (WEIGHTS_OF_SPRINGS, _FEWER)
    )
    return LimitOfSprings(limit, np.abs(limit - fewer))
