"""Start of the search for an orbit: the mean friction of a harmonic slip, and friction as a dashpot."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from frictionlab.compile.decorators import inner
from frictionlab.motion.equation import belt_swing, equilibrium, free_cosine, free_sine, span
from frictionlab.motion.linalg import dimension, invert
from frictionlab.scene.body import BodyNumbers


@inner
def first_guess(law: Any, body: BodyNumbers, belt_speed: float, z: Any) -> float:
    """Spring deflection by the mean friction of a harmonic slip; returns friction's coefficient as a dashpot."""
    swing = body.frequency * math.hypot(abs(free_sine(body)), abs(free_cosine(body))) + belt_swing(body)
    # As if slip were the belt speed and one harmonic of the free motion: the closed form of prescribed slip.
    ratio = abs(belt_speed) / (swing + 1e-300)
    mean = law.sliding_friction(swing + abs(belt_speed)) * (
        math.asin(ratio) * 2.0 / math.pi if ratio < 1.0 else 1.0
    )
    for i in range(z.size):
        z[i] = 0.0
    stiffness = body.stiffness_mean + body.stiffness_split
    away = (free_cosine(body) - body.reference_cosine).real  # from the reference
    away = equilibrium(body, math.copysign(body.normal_load * mean, belt_speed), 0.0) + away
    z[0], z[1] = math.sqrt(stiffness) * away, body.frequency * (free_sine(body) - body.reference_sine).real
    # Friction taken as a dashpot: the force over the slip speed, with a floor that keeps it from blowing up at rest.
    return body.normal_load * law.sliding_friction(swing) / (swing + abs(belt_speed) + 1e-3)


@inner
def _free_block(damping: float, stiffness: float, period: float, jacobian: Any, at: int) -> None:
    """Monodromy minus identity of one friction-free direction, in the norm of energy."""
    s, half = math.sqrt(stiffness), 0.5 * damping
    square = stiffness - half * half
    root = math.sqrt(abs(square)) * period
    # cosh and sinh are kept from overflow: heavily overdamped, this is only a first guess of the inverse.
    if square > 0.0:
        c, sn = math.cos(root), period * (math.sin(root) / root if root > 0.0 else 1.0)
    else:
        c, sn = (
            math.cosh(min(root, 300.0)),
            period * (math.sinh(min(root, 300.0)) / root if root > 0.0 else 1.0),
        )
    decay = math.exp(-half * period)
    # In the norm of energy, where the map of an undamped mass is a rotation.
    jacobian[at, at] = decay * (c + sn * half) - 1.0
    jacobian[at, at + 1] = decay * sn * s
    jacobian[at + 1, at] = -decay * sn * s
    jacobian[at + 1, at + 1] = decay * (c - sn * half) - 1.0


@inner
def free_inverse(body: BodyNumbers, rubbing: float, inverse: Any, zero: Any) -> None:
    """Inverse of (monodromy - identity) of the body with friction as a dashpot of this coefficient."""
    n, d, period = inverse.shape[0], dimension(zero), span(body)
    jacobian = np.zeros((n, n))
    for row in range(2 * d, n):
        jacobian[row, row] = -1.0  # a bristle remembers nothing of a period ago
    damping, stiffness = body.damping_mean + body.damping_split, body.stiffness_mean + body.stiffness_split
    _free_block(damping + rubbing, stiffness, period, jacobian, 0)
    if d == 2:
        damping, stiffness = (
            body.damping_mean - body.damping_split,
            body.stiffness_mean - body.stiffness_split,
        )
        _free_block(damping + rubbing, stiffness, period, jacobian, 2)
    invert(jacobian, inverse)
