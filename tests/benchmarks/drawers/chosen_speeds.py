"""Belt speeds chosen within 1e-4 to 1e-2, of Coulomb friction along the belt, which may rise like a root to V_lin.

Compared with 2000 points of the curve, crowded at V_lin: how far straight lines deviate from it, as a multiple of
what was asked.
"""

from __future__ import annotations

import numpy as np
from campaign import Campaign, Drawn, Keys, Verdicts, log_uniform

import frictionlab as fl
from frictionlab.theory import friction_free_velocity


def draw(rng: np.random.Generator) -> Drawn:
    """A scene and a law; its tolerance is what lines may be off."""
    scene: Keys = {
        "damping_ratio": log_uniform(rng, 0.01, 1),
        "normal_load": log_uniform(rng, 0.5, 50),
        "belt_speed": 1.0,
        "drive": {"unbalance": 10.0, "frequency": log_uniform(rng, 0.3, 4)},
    }
    law = {"kind": "coulomb", "mu": float(rng.uniform(0.1, 1.0))}
    limit = friction_free_velocity(fl.Scene(**scene))
    ends = limit * log_uniform(rng, 1e-3, 0.1), limit * float(rng.uniform(0.6, 3.0))
    return Drawn("line", scene, law, log_uniform(rng, 1e-4, 1e-2), ends)


def judge(one: Drawn) -> Verdicts:
    """How far lines between the chosen belt speeds are from the curve."""
    (scene, law), (start, stop) = one.made(), one.method
    asked = {"start": start, "stop": stop, "within": one.tolerance}
    table = fl.compare(scene, law, asked, columns=["mean_friction"]).table
    limit = friction_free_velocity(scene)
    near = start + (limit - start) * (1.0 - np.geomspace(1e-7, 1.0, 500))
    dense = np.union1d(np.linspace(start, stop, 1500), near)
    dense = dense[(dense >= start) & (dense <= stop)]
    exact = fl.curve(scene, law, dense, columns=["mean_friction"])["mean_friction"]
    lines = np.interp(dense, table["scene.belt_speed"], table["mean_friction"])
    off = float(np.nanmax(np.abs(lines - exact))) / one.tolerance
    yield "within what was asked" if off <= 1.0 else f"{off:.2f} times what was asked", ""


CAMPAIGN = Campaign(draw, judge, scenes=150)
