"""Coulomb friction by the reduced models, against exact on the line and shooting in the plane.

Friction over the load 1e-3 ... 2, frequency .3 ... 10, damping 1e-3 ... 1 and belt speed .01 ... 1.5 V_lin, all
log-uniform; in the plane the natural frequency and the load across, half of them in phase, too. Of the scenes on the
line half are those of tests/random_scenes.py: friction of thousandths to a thousand times the load, grazing belts.
"""

from __future__ import annotations

import math

import numpy as np
import random_scenes
from campaign import Campaign, Drawn, Keys, Unknown, covered, log_uniform, sound

import frictionlab as fl
from frictionlab.theory import friction_free_velocity

MU = 0.4
MODELS = "mdsm", "harmonic_balance"


def draw(rng: np.random.Generator) -> Drawn | None:
    """A scene, its law and a model; one in the plane is answered by mdsm."""
    planar = rng.random() < 0.3
    if not planar and rng.random() < 0.5:
        scene, law = random_scenes.draw(rng)
        keys, mu = scene.given(), law.mu
    else:
        keys, mu = _moderate(rng, planar), MU
    if not math.isfinite(friction_free_velocity(fl.Scene(**keys))):
        return None
    model = "mdsm" if planar else str(rng.choice(MODELS))
    kind = f"{model}, {'plane' if planar else 'line'}"
    return Drawn(kind, keys, {"kind": "coulomb", "mu": mu}, method=model)


def _moderate(rng: np.random.Generator, planar: bool) -> Keys:
    load, frequency = log_uniform(rng, 0.1, 100), log_uniform(rng, 0.3, 10)
    scene: Keys = {
        "damping_ratio": log_uniform(rng, 1e-3, 1),
        "normal_load": log_uniform(rng, 1e-3, 2) * load / MU,
        "belt_speed": 0.0,
        "drive": {"amplitude": load, "frequency": frequency},
    }
    if planar:
        phase = 0.0 if rng.random() < 0.5 else float(rng.uniform(0, 360))
        scene["transverse"] = {
            "natural_frequency": log_uniform(rng, 0.3, 10),
            "damping_ratio": log_uniform(rng, 1e-3, 1),
            "load": {"amplitude": load * log_uniform(rng, 0.01, 10), "phase": phase},
        }
    scene["belt_speed"] = log_uniform(rng, 0.01, 1.5) * friction_free_velocity(fl.Scene(**scene))
    return scene


def full(one: Drawn, _state: fl.SteadyState) -> tuple[float, float]:
    """The mean of the full model, and its error."""
    method = "shooting" if "transverse" in one.scene else "exact"
    found = fl.steady_state(*one.made(), method=method, tolerance=1e-9)
    if found.status != "ok":
        raise Unknown(found.reason)
    return found.mean_friction, found.error


CAMPAIGN = Campaign(draw, sound, covered(full), scenes=2000, compared=2000)
