"""Scales of a scene given in SI units, the units that its keys end in, and laws converted to these scales.

Scales of Sulollari, van Dalen & Cabboi, Eq. 2, with omega_1 = sqrt(K_1/M): time 1/omega_1, a length L, force
K_1 L, and from these velocity omega_1 L and energy K_1 L^2. L is any length: no result in SI units depends on it.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Any, NamedTuple, TypeVar

from frictionlab.quantities import Dimension, Record, dimensions

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
"""What the key of a number of each dimension ends in where a scene is in SI units."""

_RecordT = TypeVar("_RecordT", bound=Record)


class Units(NamedTuple):
    """The units of a scene's nondimensional numbers: length L [m], time 1/omega_1 [s], force K_1 L [N], mass M [kg].

    mass: where it is left out that of the others.
    """

    length: float
    time: float
    force: float
    mass: float = math.nan

    @property
    def velocity(self) -> float:
        """omega_1 L [m/s]."""
        return self.length / self.time

    @property
    def energy(self) -> float:
        """K_1 L^2 [J]."""
        return self.force * self.length

    def of(self, dimension: Dimension) -> float:
        """The unit of a number of this dimension."""
        if dimension == UNBALANCE and not math.isnan(self.mass):
            return self.mass * self.length
        return self.force**dimension.force * self.length**dimension.length * self.time**dimension.time

    def scaled(self, value: float, dimension: Dimension) -> float:
        """A number in SI units made nondimensional."""
        if dimension == FREQUENCY:
            return value * self.time
        return value / (self.velocity if dimension == VELOCITY else self.of(dimension))


def scaled_parameters(record: Record, scales: Units) -> dict[str, float | tuple[float, ...]]:
    """The parameters of a law that have a dimension, made nondimensional."""
    values = {
        name: (getattr(record, name), scales.of(unit)) for name, unit in dimensions(type(record)).items()
    }
    return {name: _divide(value, unit) for name, (value, unit) in values.items() if value is not None}


def _divide(value: float | tuple[float, ...], unit: float) -> float | tuple[float, ...]:
    return tuple(each / unit for each in value) if isinstance(value, tuple) else value / unit


@lru_cache(maxsize=4096)  # the rows of a curve share their law
def scaled_law(law: _RecordT, scales: Units) -> _RecordT:
    """A law given in SI units, converted to the lengths and times of a scene.

    The bounds of its parameters are those of the numbers given. Raises OverflowError for a number without size.
    """
    parameters = scaled_parameters(law, scales)
    for name, value in parameters.items():
        if not _has_size(value, getattr(law, name)):
            raise OverflowError(f"{name}: {getattr(law, name)} in SI units is {value} in those of the scene")
    return law.model_copy(update=parameters) if parameters else law


def _has_size(value: float | tuple[float, ...], given: Any) -> bool:
    """Whether each converted number is finite, and zero only where the one given is."""
    if isinstance(value, tuple):
        return all(_has_size(*pair) for pair in zip(value, given, strict=True))
    return math.isfinite(value) and (value != 0.0 or given == 0.0)
