"""Bristle laws on the line and in the plane.

Damping .02 ... .5, frequency .3 ... 5, friction over load .01 ... 2, belt speed .01 ... 1.5 V_lin and presliding
length over the friction-free amplitude 1e-6 ... 1e2, all log-uniform. Answers are compared with scipy's LSODA on the
interpreted law, followed from the answer's own position and velocity, bristles at rest, until the mean of a period
of the response repeats, with CALLS calls of the equations of motion at most. Jenkins friction, whose rate jumps, is
not compared.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from campaign import Campaign, Drawn, Keys, Unknown, covered, log_uniform, sound

import frictionlab as fl
from frictionlab.bench.peers.equations import OnBristles
from frictionlab.bench.peers.scipy_steps import one_period
from frictionlab.theory import friction_free_velocity

LAWS = "dahl", "dahl exponent", "lugre", "lugre stribeck", "elasto-plastic", "jenkins"
CALLS = 1_500_000
SETTLED = 3e-10
"""Of the mean, still to come, where a motion is taken to have settled."""


def draw(rng: np.random.Generator) -> Drawn:
    """A scene, half of them in the plane, and a law."""
    load, frequency, planar = log_uniform(rng, 0.1, 100), log_uniform(rng, 0.3, 5), bool(rng.random() < 0.5)
    mu = log_uniform(rng, 0.1, 1.0)
    scene: Keys = {
        "damping_ratio": log_uniform(rng, 0.02, 0.5),
        "normal_load": log_uniform(rng, 0.01, 2) * load / mu,
        "belt_speed": 0.0,
        "drive": {"amplitude": load, "frequency": frequency, "phase": float(rng.uniform(0, 360))},
    }
    if planar:
        phase = 0.0 if rng.random() < 0.5 else float(rng.uniform(0, 360))
        scene["transverse"] = {
            "natural_frequency": log_uniform(rng, 0.3, 5),
            "damping_ratio": log_uniform(rng, 0.02, 0.5),
            "load": {"amplitude": load * log_uniform(rng, 0.1, 10), "phase": phase},
        }
    v_lin = friction_free_velocity(fl.Scene(**scene))
    kind = str(rng.choice([kind for kind in LAWS if not planar or kind != "dahl exponent"]))
    law = _law(rng, kind, mu, v_lin) | {"presliding_length": log_uniform(rng, 1e-6, 1e2) * v_lin / frequency}
    if planar and rng.random() < 0.2:
        law["planar"] = str(rng.choice(["rotated", "per-axis"]))
    scene["belt_speed"] = log_uniform(rng, 0.01, 1.5) * v_lin
    name = f"{kind}, {'plane' if planar else 'line'}"
    return Drawn(name, scene, law, float(rng.choice([1e-4, 1e-6, 1e-8])))


def _law(rng: np.random.Generator, kind: str, mu: float, v_lin: float) -> Keys:
    if kind in ("dahl", "jenkins"):
        return {"kind": kind, "mu": mu}
    if kind == "dahl exponent":
        return {"kind": "dahl", "mu": mu, "exponent": float(rng.uniform(0.5, 2.0))}
    law: Keys = {"kind": kind.partition(" ")[0], "mu_kinetic": mu}
    if rng.random() < 0.7:  # damping up to that of the load of friction at the speed of the mass
        law["damping"] = log_uniform(rng, 1e-4, 1.0) * mu / v_lin
    if kind == "elasto-plastic":
        law["breakaway_ratio"] = float(rng.uniform(0.1, 0.95))
    if kind == "lugre stribeck":
        law["mu_static"] = mu * float(rng.uniform(1, 2))
        law["stribeck_speed"] = log_uniform(rng, 0.01, 1) * v_lin
        law["viscosity"] = log_uniform(rng, 1e-3, 0.3) * mu / v_lin if rng.random() < 0.5 else 0.0
    return law


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
