"""Springs, dashpots and shaking of a body in SI units, in whichever of their numbers they are given."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

SPRING = "stiffness_N_per_m", "natural_frequency_rad_per_s"
DASHPOT = "damping_N_s_per_m", "damping_ratio"
SWINGS = "velocity_amplitude_m_per_s", "displacement_amplitude_m", "acceleration_amplitude_m_per_s2"
"""Names of one and the same thing, of which a part gives one."""


def stiffness_of(part: Any, mass: float) -> float:
    """K of a spring [N/m], M omega^2 of a natural frequency."""
    given = part.stiffness_N_per_m
    return float(mass * part.natural_frequency_rad_per_s**2 if given is None else given)


def time_of(part: Any, mass: float) -> float:
    """1/omega [s] of the undamped mass on its spring."""
    given = part.stiffness_N_per_m
    return 1.0 / float(part.natural_frequency_rad_per_s) if given is None else math.sqrt(mass / given)


def damping_ratio_of(part: Any, mass: float) -> float:
    """C/(2 sqrt(K M)) of a dashpot."""
    given = part.damping_N_s_per_m
    if given is None:
        return float(part.damping_ratio)
    return float(given / (2.0 * math.sqrt(stiffness_of(part, mass) * mass)))


def velocity_of(shaking: Any, frequency: float) -> float:
    """The velocity amplitude [m/s] of what shakes at this circular frequency."""
    velocity, displacement, acceleration = (getattr(shaking, name) for name in SWINGS)
    if velocity is not None:
        return float(velocity)
    return float(displacement * frequency if displacement is not None else acceleration / frequency)


def own_length(scene: Any) -> float:
    """The length that scales a scene [m] that gives none: the largest amplitude without friction.

    Of each load, of the belt's vibration and of a prescribed slip as a sine of its size; normal load over stiffness
    where none has a size, of a prescribed slip 1 m.
    """
    return max((each for each in _amplitudes(scene) if 0.0 < each < math.inf), default=_at_rest(scene))


def _at_rest(scene: Any) -> float:
    if scene.table is not None:
        return float(scene.load * scene.table.values[0].real)
    return 1.0 if scene.is_prescribed else float(scene.load / stiffness_of(scene, scene.mass_kg))


def _amplitudes(scene: Any) -> Iterator[float]:
    across, belt = scene.transverse, scene.belt_vibration
    for part, load in ((scene, scene.drive), (across, across and across.load)):
        if load is not None:
            omega = scene.frequency * (getattr(load, "frequency_ratio", None) or 1.0)
            force = load.amplitude_N if load.unbalance_kg_m is None else load.unbalance_kg_m * omega**2
            yield force * _compliance(scene, part, omega)
    for part in (belt, scene.slip, scene.transverse_slip):
        if part is not None:
            omega = scene.frequency * (getattr(part, "frequency_ratio", None) or 1.0)
            yield velocity_of(part, omega) / omega


def _compliance(scene: Any, part: Any, omega: float) -> float:
    """Amplitude per force without friction [m/N]; that at rest for an undamped mass at resonance."""
    if scene.table is not None:
        return float(abs(scene.table.receptance(np.array([omega]))[0]))
    mass = scene.mass_kg
    stiffness, time = stiffness_of(part, mass), time_of(part, mass)
    ratio = omega * time
    reply = abs(complex(1.0 - ratio**2, 2.0 * damping_ratio_of(part, mass) * ratio))
    return 1.0 / (stiffness * reply) if reply > 0.0 else 1.0 / stiffness
