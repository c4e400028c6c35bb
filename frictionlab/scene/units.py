"""Scales of a scene given in SI units, the units that its keys end in, and laws converted to these scales.

Scales of Sulollari, van Dalen & Cabboi, Eq. 2, with omega_1 = sqrt(K_1/M): time 1/omega_1, a length L, force
K_1 L, and from these velocity omega_1 L and energy K_1 L^2. L is any length: no result in SI units depends on
it.

Springs, dashpots and oscillations of a body in SI units are read from whichever of their numbers are given.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import lru_cache
from typing import Any, NamedTuple, TypeVar

import numpy as np

from frictionlab.values.quantities import Dimension, Record, dimensions

LENGTH, VELOCITY, FREQUENCY = Dimension(length=1), Dimension(length=1, time=-1), Dimension(time=-1)
FORCE, UNBALANCE = Dimension(force=1), Dimension(force=1, time=2)
TIME, STIFFNESS, CURVATURE = Dimension(time=1), Dimension(force=1, length=-1), Dimension(length=-1)
MASS = Dimension(force=1, length=-1, time=2)
CUBIC_STIFFNESS, CUBIC_DAMPING = Dimension(force=1, length=-3), Dimension(force=1, length=-3, time=1)
SUFFIXES = {
    LENGTH: "m",
    VELOCITY: "m_per_s",
    FREQUENCY: "rad_per_s",
    FORCE: "N",
    UNBALANCE: "kg_m",
    TIME: "s",
    STIFFNESS: "N_per_m",
    MASS: "kg",
    CURVATURE: "per_m",
    CUBIC_STIFFNESS: "N_per_m3",
    CUBIC_DAMPING: "N_s_per_m3",
}
"""Units at the end of the key of a number, by its dimension, if a scene is in SI units."""

_RecordT = TypeVar("_RecordT", bound=Record)


class Units(NamedTuple):
    """Units of a scene's nondimensional numbers: L [m], time 1/omega_1 [s], force K_1 L [N], mass M [kg].

    mass: that of the other three units if it is left out.
    """

    length: float
    time: float
    force: float
    mass: float = math.nan

    @property
    def velocity(self) -> float:
        """Unit of velocity, omega_1 L [m/s]."""
        return self.length / self.time

    @property
    def energy(self) -> float:
        """Unit of energy, K_1 L^2 [J]."""
        return self.force * self.length

    def of(self, dimension: Dimension) -> float:
        """Return the unit of a number of this dimension."""
        if dimension == UNBALANCE and not math.isnan(self.mass):
            return self.mass * self.length
        return self.force**dimension.force * self.length**dimension.length * self.time**dimension.time

    def scaled(self, value: float, dimension: Dimension) -> float:
        """Return a number in SI units made nondimensional."""
        if dimension == FREQUENCY:
            return value * self.time
        return value / (self.velocity if dimension == VELOCITY else self.of(dimension))


def scaled_parameters(record: Record, scales: Units) -> dict[str, float | tuple[float, ...]]:
    """Return the parameters of a law that have a dimension, made nondimensional."""
    values = {
        name: (getattr(record, name), scales.of(unit)) for name, unit in dimensions(type(record)).items()
    }
    return {name: _divide(value, unit) for name, (value, unit) in values.items() if value is not None}


def _divide(value: float | tuple[float, ...], unit: float) -> float | tuple[float, ...]:
    return tuple(number / unit for number in value) if isinstance(value, tuple) else value / unit


@lru_cache(maxsize=4096)  # the rows of a curve share their law
def scaled_law(law: _RecordT, scales: Units) -> _RecordT:
    """Return a law given in SI units, converted to the lengths and times of a scene.

    The bounds of its parameters are those of the numbers given. Raises OverflowError for a number that
    becomes zero or infinite.
    """
    parameters = scaled_parameters(law, scales)
    for name, value in parameters.items():
        if not _has_size(value, getattr(law, name)):
            raise OverflowError(f"{name}: {getattr(law, name)} in SI units is {value} in those of the scene")
    return law.model_copy(update=parameters) if parameters else law


def measured(record: _RecordT, scales: Units) -> _RecordT:
    """Return a nondimensional law or scene, with its parts, in other units, which have any size."""
    parts = {name: measured(part, scales) for name, part in record if isinstance(part, Record)}
    return record.model_copy(update=parts | scaled_parameters(record, scales))


def _has_size(value: float | tuple[float, ...], given: Any) -> bool:
    """Check whether each converted number is finite, and zero only if the one given is."""
    if isinstance(value, tuple):
        return all(_has_size(*pair) for pair in zip(value, given, strict=True))
    return math.isfinite(value) and (value != 0.0 or given == 0.0)


SPRING = "stiffness_N_per_m", "natural_frequency_rad_per_s"
DASHPOT = "damping_N_s_per_m", "damping_ratio"
SWINGS = "velocity_amplitude_m_per_s", "displacement_amplitude_m", "acceleration_amplitude_m_per_s2"
"""Names of the same quantity, of which a part gives one."""


def stiffness_of(part: Any, mass: float) -> float:
    """Compute the stiffness [N/m]: K of a spring, M omega^2 of a natural frequency."""
    given = part.stiffness_N_per_m
    return float(mass * part.natural_frequency_rad_per_s**2 if given is None else given)


def time_of(part: Any, mass: float) -> float:
    """Compute 1/omega [s] of the undamped mass on its spring; without one it is that of the vibration."""
    given = part.stiffness_N_per_m
    if given == 0.0:
        return 1.0 / float(part.frequency)
    return 1.0 / float(part.natural_frequency_rad_per_s) if given is None else math.sqrt(mass / given)


def damping_ratio_of(part: Any, mass: float) -> float:
    """Compute the damping ratio C/(2 M omega) of a dashpot, 0 without one."""
    given = part.damping_N_s_per_m
    if given is None:
        return float(part.damping_ratio or 0.0)
    return float(given * time_of(part, mass) / (2.0 * mass))


def velocity_of(shaking: Any, frequency: float) -> float:
    """Compute the velocity amplitude [m/s] of an oscillation at this circular frequency."""
    velocity, displacement, acceleration = (getattr(shaking, name) for name in SWINGS)
    if velocity is not None:
        return float(velocity)
    return float(displacement * frequency if displacement is not None else acceleration / frequency)


def own_length(scene: Any) -> float:
    """Compute the length [m] that scales a scene that gives none: the largest amplitude without friction.

    Amplitudes are those of each load, and of the belt's vibration and a prescribed slip as a sine of its
    size. If none has a size the length is normal load over stiffness, of a prescribed slip 1 m.
    """
    return max(
        (amplitude for amplitude in _amplitudes(scene) if 0.0 < amplitude < math.inf), default=_at_rest(scene)
    )


def _at_rest(scene: Any) -> float:
    if scene.table is not None:
        return float(scene.load * scene.table.values[0].real)
    if scene.is_prescribed:
        return 1.0
    stiffness = stiffness_of(scene, scene.mass_kg) or scene.mass_kg / time_of(scene, scene.mass_kg) ** 2
    return float(scene.load / stiffness)


def _amplitudes(scene: Any) -> Iterator[float]:
    across, belt = scene.transverse, scene.belt_vibration
    for part, load in ((scene, scene.drive), (across, across and across.load)):
        if load is not None:
            omega = scene.frequency * (getattr(load, "frequency_ratio", None) or 1.0)
            force = load.amplitude_N or 0.0 if load.unbalance_kg_m is None else load.unbalance_kg_m * omega**2
            yield force * _compliance(scene, part, omega)
    for part in (belt, scene.slip, scene.transverse_slip):
        if part is not None:
            omega = scene.frequency * (getattr(part, "frequency_ratio", None) or 1.0)
            yield velocity_of(part, omega) / omega


def _compliance(scene: Any, part: Any, omega: float) -> float:
    """Compute amplitude per force without friction [m/N]; that at rest for an undamped mass at resonance."""
    if scene.table is not None:
        return float(abs(scene.table.receptance(np.array([omega]))[0]))
    mass = scene.mass_kg
    stiffness, time = stiffness_of(part, mass), time_of(part, mass)
    ratio = omega * time
    held, unit = (1.0, stiffness) if stiffness > 0.0 else (0.0, mass / time**2)
    reply = abs(complex(held - ratio**2, 2.0 * damping_ratio_of(part, mass) * ratio))
    return 1.0 / (unit * reply) if reply > 0.0 else 1.0 / unit
