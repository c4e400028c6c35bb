"""The friction-free response of the body."""

from __future__ import annotations

import math

from frictionlab.scene.scene import Scene


def friction_free_velocity(scene: Scene) -> float:
    """V_lin: the velocity amplitude of x1 without friction [omega_1 L], infinite at undamped resonance.

    Amplitude of the linear response to the load along x1; for a prescribed slip its own amplitude along x1.
    At belt speeds above it a body of one degree of freedom under constant sliding friction never reverses its slip;
    the curve of the mean has its kink there.

    Source: Sulollari, van Dalen & Cabboi, Eq. 6 (there the response where friction is a small perturbation).
    """
    if scene.degrees_of_freedom == 0:
        return abs(scene.motion().velocity)
    mass = scene.mass()
    stiffness = complex(mass.stiffness - mass.frequency**2, mass.damping * mass.frequency)
    force = abs(mass.force) * mass.frequency
    return force / abs(stiffness) if stiffness else math.inf
