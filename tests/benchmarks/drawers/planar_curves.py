"""Curves of 24 belt speeds in the plane, whose orbits shooting closes several at a time, against each alone."""

from __future__ import annotations

import numpy as np
from campaign import WRONG, Campaign, Drawn, Keys, Verdicts, log_uniform

import frictionlab as fl
from frictionlab.theory import friction_free_velocity

POINTS, TRUTH = 24, 1e-12


def draw(rng: np.random.Generator) -> Drawn:
    """A scene of loads, dampings and frequencies over decades, Coulomb or convergent Stribeck friction."""
    across = {"amplitude": log_uniform(rng, 0.14, 20), "phase": float(rng.uniform(-180, 180))}
    scene: Keys = {
        "damping_ratio": log_uniform(rng, 0.02, 1),
        "normal_load": log_uniform(rng, 0.05, 12),
        "belt_speed": 1.0,
        "drive": {"amplitude": log_uniform(rng, 0.4, 20), "frequency": log_uniform(rng, 0.4, 6)},
        "transverse": {
            "natural_frequency": log_uniform(rng, 0.3, 12),
            "damping_ratio": log_uniform(rng, 0.02, 1),
            "load": across,
        },
    }
    law: Keys = {"kind": "coulomb", "mu": float(rng.uniform(0.05, 0.9))}
    if rng.random() < 0.4:
        falls = {"mu_kinetic": 0.3, "mu_static": 0.35, "stribeck_speed": log_uniform(rng, 1, 50)}
        law = {"kind": "stribeck", **falls}
    tolerance = float(rng.choice([1e-2, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10]))
    return Drawn(f"{tolerance:g}", scene, law, tolerance)


def judge(one: Drawn) -> Verdicts:
    """Each point, but where the one that is solved alone has no answer."""
    scene, law = one.made()
    speeds = np.linspace(0.01, 1.3, POINTS) * friction_free_velocity(scene)
    table = fl.curve(scene, law, speeds, "shooting", one.tolerance)
    for speed, row in zip(speeds, table.itertuples(), strict=True):
        alone = fl.steady_state(scene.at(float(speed)), law, method="shooting", tolerance=TRUTH)
        if row.status != "ok" or alone.status != "ok":
            yield f"{row.status}, alone {alone.status}", ""
            continue
        off = abs(row.mean_friction - alone.mean_friction)
        right = off <= row.error + alone.error
        yield ("ok" if right else f"{WRONG}: uncovered"), (float(speed), off, row.error, alone.error)


CAMPAIGN = Campaign(draw, judge, scenes=40)
