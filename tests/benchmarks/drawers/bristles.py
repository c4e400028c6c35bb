"""Bristle laws on the line and in the plane: driven scenes of ``every_law.py``, presliding lengths down to 1e-6.

Answers are compared with scipy's LSODA on the interpreted law, followed from the answer's own position and velocity,
bristles at rest, until the mean of a period of the response repeats, with CALLS calls of the equations of motion at
most. Jenkins friction, whose rate jumps, is not compared.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from campaign import Campaign, Drawn, Unknown, covered, law_of, log_uniform, sound

import frictionlab as fl
from drawers import driven
from frictionlab.bench.peers.equations import OnBristles, one_period

CALLS = 1_500_000
SETTLED = 3e-10
"""Of the mean, still to come, where a motion is taken to have settled."""


def draw(rng: np.random.Generator) -> Drawn | None:
    """A scene and a law; None for one of another kind."""
    one = driven.draw(rng)
    if one is None or law_of(one.law).memory_kind != "bristle":
        return None
    length = one.law["presliding_length"] * log_uniform(rng, 1e-2, 1)
    tolerance = float(rng.choice([1e-4, 1e-6, 1e-8]))
    return Drawn(one.kind, one.scene, one.law | {"presliding_length": length}, tolerance)


def followed(one: Drawn, state: fl.SteadyState) -> tuple[float, float]:
    """The mean over a period of the response by LSODA, and what may still be to come with the rounding of steps."""
    if one.law["kind"] == "jenkins":
        raise Unknown("its rate jumps")
    if state.floquet > 0.995:
        raise Unknown("a multiplier above 0.995")
    rough, fine = (_settled(one, state, rtol) for rtol in (1e-9, 1e-11))
    return fine[0], fine[1] + abs(fine[0] - rough[0])


def _settled(one: Drawn, state: fl.SteadyState, rtol: float) -> tuple[float, float]:
    scene, law = one.made()
    motion = OnBristles(scene, law, CALLS)
    turns = round(state.period) if state.period > 0.0 else 1
    place = _start(motion, state)
    means: list[float] = []
    while (left := _left(means, state.floquet)) > SETTLED:
        total = 0.0
        for _ in range(turns):
            end = one_period(motion, place, "odeint", rtol)
            place, total = np.append(end[:-1], 0.0), total - float(end[-1])
        means.append(total / (turns * motion.period))
    return means[-1], left


def _start(motion: OnBristles, state: fl.SteadyState) -> Any:
    first = state.orbit(1)
    x1, v1, x2, v2 = (float(part[0]) for part in (first.x1, first.v1, first.x2, first.v2))
    return np.array([x1, v1, x2, v2, 0.0, 0.0, 0.0] if motion.planar else [x1, v1, 0.0, 0.0])


def _left(means: list[float], multiplier: float) -> float:
    """What is still to come of changes that shrink by the multiplier or as they did, whichever is slower."""
    if len(means) < 4:
        return math.inf
    changes = np.abs(np.diff(means[-4:]))
    seen = math.sqrt(changes[-1] / changes[-3]) if changes[-3] > 0.0 else 0.0
    ratio = min(max(seen, multiplier if math.isfinite(multiplier) else 0.9, 0.1), 0.999)
    return float(changes.max() if changes[-1] < 1e-13 else changes[-1] * ratio / (1.0 - ratio))


CAMPAIGN = Campaign(draw, sound, covered(followed), scenes=2000, compared=200)
