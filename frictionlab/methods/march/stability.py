"""Stability limit of explicit steps for a law with bristles."""

from __future__ import annotations

import math

import numpy as np

from frictionlab.laws.base import FrictionLaw
from frictionlab.laws.memory import BristleLaw, MemoryLaw
from frictionlab.numerics.steppers import bristle_rk4, exponential
from frictionlab.scene.body import Mass
from frictionlab.scene.scene import Scene
from frictionlab.theory import friction_free_velocity

MARGIN = 1.02
"""Steps used over the steps that a stability limit requires."""


def spring_of(law: BristleLaw) -> float:
    """Friction coefficient per deflection [1/scene length], from the friction of the law."""
    depth = law.presliding()
    depth = depth if math.isfinite(depth) else 1e-6
    return float(law.friction(0.0, depth, 0.0)) / depth


def dashpot_of(law: BristleLaw) -> float:
    """Friction coefficient per slip velocity while bristles follow the slip [1/scene velocity]."""
    return float(law.friction(1.0, 0.0, 1.0))


def fastest_slip(law: BristleLaw | MemoryLaw, h: float, decay: float = bristle_rk4.DECAY) -> float:
    """The slip speed at which the memory decays at the largest rate for which rk4 steps of length h are stable.

    decay: the largest step times rate.
    """
    low, high = 0.0, 1e12
    if h * law.largest_rate(high) <= decay:
        return high
    for _ in range(200):
        middle = math.sqrt(low * high) if low > 0.0 else 1e-12 if high > 1e-12 else 0.5 * high
        if h * law.largest_rate(middle) <= decay:
            low = middle
        else:
            high = middle
        if high - low <= 1e-9 * high:
            break
    return low


def friction_falls(law: FrictionLaw) -> bool:
    """Whether steady sliding friction decreases with speed anywhere."""
    speeds = np.geomspace(1e-9, 1e9, 721)
    friction = [law.sliding_friction(speed) for speed in [0.0, *speeds.tolist()]]
    return bool((np.diff(friction) < -1e-12 * friction[0]).any())


def fewest_steps(scene: Scene, law: BristleLaw, stepper: str) -> int:
    """Steps per period that an explicit stepper needs; 1 where any number is stable.

    For slip as fast as that of the friction-free motion on this belt, and for a mass held by its bristles.
    """
    if stepper == "sdirk2":
        return 1
    lap = 2.0 * math.pi / scene.frequency
    held = 0.0 if scene.degrees_of_freedom == 0 else _quickest_when_held(scene.mass(), law)
    if stepper == "exponential":
        return math.ceil(MARGIN * lap * held / exponential.DECAY)
    rate = law.largest_rate(expected_slip(scene))
    return math.ceil(MARGIN * lap * max(held, rate) / bristle_rk4.DECAY) if math.isfinite(rate) else 0


def _quickest_when_held(mass: Mass, law: BristleLaw) -> float:
    """The largest frequency, or rate of decay, of a mass held by its spring and its bristles."""
    stiffness = max(mass.stiffness, mass.transverse_stiffness) + mass.normal_load * spring_of(law)
    damping = max(mass.damping, mass.transverse_damping) + mass.normal_load * dashpot_of(law)
    return max(math.sqrt(stiffness), damping)


def expected_slip(scene: Scene) -> float:
    """The largest slip speed of the friction-free motion, and at ``scene.initial`` [scene velocity]."""
    along = friction_free_velocity(scene) + abs(scene.belt_speed)
    if scene.degrees_of_freedom == 0:
        return math.hypot(along, abs(scene.motion().transverse_velocity))
    mass, start = scene.mass(), scene.start if scene.undriven else scene.initial
    dynamic = complex(mass.transverse_stiffness - mass.frequency**2, mass.transverse_damping * mass.frequency)
    across = abs(mass.transverse_force) * mass.frequency
    speed = math.hypot(along, across / abs(dynamic) if dynamic else (math.inf if across else 0.0))
    speed = speed if math.isfinite(speed) else abs(scene.belt_speed)
    if start is not None:
        speed = max(speed, math.hypot(start.velocity - scene.belt_speed, start.velocity2))
    return speed
