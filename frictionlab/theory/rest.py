"""Static equilibrium of the mass on a belt at rest."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from frictionlab.laws.base import FrictionLaw
from frictionlab.scene.scene import Scene

CREEP = 1e-9
"""Slip speed at which the friction of slow slip is evaluated."""


def friction_at_rest(law: Any) -> float:
    """The friction coefficient at the onset of slip."""
    if law.memory_kind == "none":
        return float(law.static_friction())
    at_rest: float = law.sliding_friction(0.0)
    return at_rest or float(law.sliding_friction(CREEP))  # a law that is zero at rest: in slow slip


def can_hold(scene: Scene, law: FrictionLaw) -> bool:
    """Whether static friction can balance the loads at all times where the spring is not bent."""
    mass = scene.mass()
    along, across = mass.force, mass.transverse_force
    # the longer half axis of the ellipse of loads
    sizes = abs(along) ** 2 + abs(across) ** 2 + abs(along**2 + across**2)
    return math.sqrt(0.5 * sizes) <= mass.normal_load * friction_at_rest(law)


def stays_at_rest(scene: Scene, law: FrictionLaw) -> bool:
    """Whether static friction balances the loads at all times on a belt at rest; bristles always deflect: False."""
    return law.memory_kind == "none" and scene.belt_speed == 0.0 and resting_range(scene, law) >= 0.0


def resting_range(scene: Scene, law: FrictionLaw) -> float:
    """The largest mean friction coefficient of a mass at rest on a belt at rest; negative where rest is impossible.

    The spring force k and friction balance the load: |load - k| <= limit at all times, a convex set of k symmetric
    about zero; the mean is k1/normal_load.
    """
    mass = scene.mass()
    limit = mass.normal_load * friction_at_rest(law)
    angle = np.linspace(0.0, np.pi, 721)  # the other half of the ellipse of loads follows by symmetry
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
