"""Random scenes of one degree of freedom over decades of friction, frequency, damping and belt speed.

Over-represented: belt speeds that graze the kink, V_lin (1 +- 1e-3 ... 1e-9), and friction above the load.
"""

from __future__ import annotations

import math

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
