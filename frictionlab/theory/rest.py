"""When the mass stays at rest on a belt at rest, and the friction that can hold it there."""

from __future__ import annotations

import numpy as np

from frictionlab.laws.base import FrictionLaw, SlidingLaw
from frictionlab.scene.scene import Scene

CREEP = 1e-9
"""Slip speed that counts as slow."""


def friction_at_rest(law: FrictionLaw) -> float:
    """The coefficient that slip must overcome to begin, slowly."""
    if isinstance(law, SlidingLaw):
        return law.static_friction()
    return law.sliding_friction(0.0) or law.sliding_friction(
        CREEP
    )  # regularised at rest it is that of slow slip


def stays_at_rest(scene: Scene, law: FrictionLaw) -> bool:
    """Whether friction can hold the loads for ever on a belt at rest; a bristle always gives a little."""
    if not isinstance(law, SlidingLaw):
        return False
    return scene.belt_speed == 0.0 and resting_range(scene, law) >= 0.0


def resting_range(scene: Scene, law: SlidingLaw) -> float:
    """The largest mean friction coefficient of a mass at rest on a belt at rest; negative where none can rest.

    The spring holds k, friction the rest of the load: |load - k| <= limit all the time, a convex set of k,
    symmetric about zero; the mean is k1/normal_load.
    """
    mass = scene.mass()
    limit = mass.normal_load * law.static_friction()
    angle = np.linspace(0.0, np.pi, 721)  # the other half of the ellipse of loads mirrors this one
    turn = np.exp(1j * angle)
    load = (mass.force * turn).imag + 1j * (mass.transverse_force * turn).imag
    load = np.concatenate([load, -load])
    low, high, best = -limit, limit, -np.inf
    for _ in range(6):
        across = np.linspace(low, high, 201)
        room = limit**2 - (load.imag[:, None] - across) ** 2
        half = np.sqrt(np.maximum(room, 0.0))
        upper, lower = (load.real[:, None] + half).min(axis=0), (load.real[:, None] - half).max(axis=0)
        reach = np.where((room >= 0.0).all(axis=0) & (lower <= upper), upper, -np.inf)
        at = int(reach.argmax())
        best = max(best, float(reach[at]))
        width = (high - low) / 50.0
        low, high = across[at] - width, across[at] + width
    return best / mass.normal_load
