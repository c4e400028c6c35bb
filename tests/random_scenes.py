"""Random scenes over decades of friction, frequency, damping and belt speed.

Over-represented on the line: belt speeds that graze the kink, V_lin (1 +- 1e-3 ... 1e-9), and friction above the
load.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from frictionlab.laws.coulomb import Coulomb
from frictionlab.scene.scene import Drive, Scene


def draw(rng: np.random.Generator) -> tuple[Scene, Coulomb]:
    """One scene and its law."""
    frequency = 1.0 if rng.random() < 0.1 else float(10.0 ** rng.uniform(-3, 3))
    damping = float(
        rng.choice(
            [0.0, 1.0, 10.0 ** rng.uniform(-4, 2), 10.0 ** rng.uniform(-2, 0)], p=[0.04, 0.03, 0.46, 0.47]
        )
    )
    load = float(10.0 ** rng.uniform(-2, 2))
    ratio = 10.0 ** (rng.uniform(-3, 3) if rng.random() < 0.6 else rng.uniform(-0.1, 1))
    mu = float(10.0 ** rng.uniform(-1.3, 0.3))
    stiffness = math.hypot((1.0 - frequency) * (1.0 + frequency), 2.0 * damping * frequency)
    v_lin = load * frequency / stiffness if stiffness else load
    scene = Scene(
        damping_ratio=damping,
        normal_load=load * ratio / mu,
        belt_speed=float(_belt_speed(rng, v_lin)),
        drive=Drive(amplitude=load, frequency=frequency, phase=float(rng.uniform(0, 360))),
    )
    return scene, Coulomb(mu=mu)


def _belt_speed(rng: np.random.Generator, v_lin: float) -> float:
    side = -1.0 if rng.random() < 0.3 else 1.0
    kind = rng.random()
    if kind < 0.3:
        return side * v_lin * (1.0 - 10.0 ** rng.uniform(-9, -3) * rng.choice([1.0, -1.0], p=[0.8, 0.2]))
    if kind < 0.5:
        return side * v_lin * 10.0 ** rng.uniform(-6, 0)
    if kind < 0.6:
        return side * v_lin * 10.0 ** rng.uniform(-3, 1)
    if kind < 0.64:
        return 0.0
    return side * v_lin * rng.uniform(0, 1.05)


def draw_near_rest(rng: np.random.Generator) -> tuple[dict[str, Any], float]:
    """The keys of a scene in the plane that is hard near rest, and mu.

    Over-represented: friction above the loads, belts far slower than the free motion, and so long sticks and slow
    climbs; the two loads may differ by decades.
    """
    frequency, load = float(10.0 ** rng.uniform(-0.7, 0.7)), float(10.0 ** rng.uniform(-1.0, 2.0))
    damping, across_damping = (float(value) for value in 10.0 ** rng.uniform(-2.0, 0.0, 2))
    natural = float(10.0 ** rng.uniform(-0.5, 1.0))
    across = load * float(10.0 ** (rng.uniform(-3.0, 0.0) if rng.random() < 0.4 else rng.uniform(-0.5, 0.5)))
    friction = max(load, across) * 10.0 ** (
        rng.uniform(0.0, 2.0) if rng.random() < 0.7 else rng.uniform(-1.0, 0.0)
    )
    mu = float(10.0 ** rng.uniform(-1.3, 0.3))
    swing = load * frequency / math.hypot(1.0 - frequency**2, 2.0 * damping * frequency)
    slowness = rng.uniform(-6.0, -2.0) if rng.random() < 0.7 else rng.uniform(-2.0, 0.2)
    scene = {
        "damping_ratio": damping,
        "normal_load": float(friction / mu),
        "belt_speed": float(rng.choice([-1.0, 1.0]) * swing * 10.0**slowness),
        "drive": {"amplitude": load, "frequency": frequency, "phase": float(rng.uniform(0.0, 360.0))},
        "transverse": {
            "natural_frequency": natural,
            "damping_ratio": across_damping,
            "load": {"amplitude": across, "phase": float(rng.choice([0.0, rng.uniform(0.0, 360.0)]))},
        },
    }
    return scene, mu
