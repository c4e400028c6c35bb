"""Stability limit of explicit steps for a law with several memories or scalars."""

from __future__ import annotations

import math

import numpy as np

from frictionlab.laws.memory import MemoryLaw
from frictionlab.methods.march.stability import MARGIN, expected_slip
from frictionlab.numerics.steppers.bristle_rk4 import DECAY
from frictionlab.quantities import Floats
from frictionlab.scene.scene import Scene

AGE = 1.0
"""Largest step times decay rate of a scalar, so that no stage of a step becomes negative."""
SLOW = np.geomspace(1e-30, 1.0, 241)
"""Speeds at which friction near rest is evaluated, over that of the motion."""


def decay(law: MemoryLaw) -> float:
    """Largest stable step times decay rate of the memory."""
    return DECAY if law.memory_kind == "deflections" else AGE


def usual_slip(scene: Scene) -> float:
    """A slip speed of the motion, above zero [scene velocity]."""
    return expected_slip(scene) or 1.0


def first_memory(scene: Scene, law: MemoryLaw) -> Floats:
    """The memory at the start: no deflection; scalars as in steady sliding at the speed of the motion."""
    if law.memory_kind == "deflections":
        return np.zeros(law.count())
    return np.array([law.steady(usual_slip(scene), k) for k in range(law.count())])


def presliding_of(law: MemoryLaw) -> float:
    """The shortest deflection in steady sliding; 0 where none is known."""
    if law.memory_kind == "scalars":
        return 0.0
    return min(abs(law.steady(1.0, k)) for k in range(law.count()))


def springs_of(scene: Scene, law: MemoryLaw) -> Floats:
    """The stiffness of each memory in the energy norm; of a scalar, from its effect on friction."""
    speed, load = usual_slip(scene), scene.mass().normal_load
    most = law.sliding_friction(speed)
    steady = np.array([law.steady(speed, k) for k in range(law.count())])
    size = np.where(steady == 0.0, 1.0, np.abs(steady))
    slope = np.array([abs(_slope(law, speed, steady, 1e-3 * size * one)) for one in np.eye(law.count())])
    slope = np.maximum(slope / (2e-3 * size), 1e-6 * most / size)
    if law.memory_kind == "deflections":
        return np.asarray(load * slope)
    return np.asarray((load * slope / scene.mass().frequency) ** 2)


def _slope(law: MemoryLaw, speed: float, memory: Floats, shift: Floats) -> float:
    still = np.zeros(law.count())
    return float(law.friction(speed, memory + shift, still) - law.friction(speed, memory - shift, still))


def fewest_steps(scene: Scene, law: MemoryLaw) -> int:
    """Steps per period that rk4 needs: for slip as fast as that of the friction-free motion, and for a mass held by
    what the law remembers; 0 where the law names no rate.
    """
    rate = law.largest_rate(expected_slip(scene))
    if not math.isfinite(rate):
        return 0
    lap = 2.0 * math.pi / scene.frequency
    return math.ceil(MARGIN * lap * max(_quickest_when_held(scene, law) / DECAY, rate / decay(law)))


def _quickest_when_held(scene: Scene, law: MemoryLaw) -> float:
    mass = scene.mass()
    stiffness = max(mass.stiffness, mass.transverse_stiffness) + mass.normal_load * _spring(law)
    damping = max(mass.damping, mass.transverse_damping)
    damping += mass.normal_load * _dashpot(scene, law, usual_slip(scene))
    return max(math.sqrt(stiffness), damping)


def _spring(law: MemoryLaw) -> float:
    """Friction coefficient per slip from rest while the contact is elastic [1/scene length]."""
    if law.memory_kind == "scalars":
        return 0.0
    bent = 1e-6 * (presliding_of(law) or 1.0)
    return float(law.friction(0.0, np.full(law.count(), bent), np.zeros(law.count()))) / bent


def _dashpot(scene: Scene, law: MemoryLaw, speed: float) -> float:
    """Slope of friction over slip velocity at this speed; for deflections, friction from rest over the speed."""
    memory = first_memory(scene, law)
    if law.memory_kind == "deflections":
        return _at_once(law, speed, memory) / speed
    return max(0.0, (_at_once(law, 1.01 * speed, memory) - _at_once(law, speed, memory)) / (0.01 * speed))


def _at_once(law: MemoryLaw, speed: float, memory: Floats) -> float:
    """Friction at a speed with this memory."""
    rates = np.array([law.rate(speed, memory, k) for k in range(law.count())])
    return float(law.friction(speed, memory, rates))


def steps_through_rest(scene: Scene, law: MemoryLaw) -> float:
    """Steps per period that rk4 needs where slip comes to rest: the slope of friction may be steep there."""
    speeds, memory = usual_slip(scene) * SLOW, first_memory(scene, law)
    steepest = max(_at_once(law, float(speed), memory) / float(speed) for speed in speeds)
    return 2.0 * math.pi / scene.frequency * scene.mass().normal_load * steepest / DECAY
