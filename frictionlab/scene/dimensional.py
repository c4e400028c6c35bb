# ruff: noqa: N815 - a key ends in its unit, and N stands for newton
"""A scene in SI units and its conversion to nondimensional numbers.

Scales of Sulollari, van Dalen & Cabboi, Eq. 2, with omega_1 = sqrt(K_1/M): time 1/omega_1, a length L, force
K_1 L, and from these velocity omega_1 L and energy K_1 L^2. L is any length: no result in SI units depends on it.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import cache, lru_cache
from typing import Any, Literal, NamedTuple, TypeVar, get_args

from pydantic import model_validator

from frictionlab.quantities import Dimension, Finite, NonNegative, Positive, Record
from frictionlab.scene.rules import SHAKEN, problems_of_parts
from frictionlab.scene.waveforms import SINE, Ratio, Waveform

STANDARD_GRAVITY = 9.81

_RecordT = TypeVar("_RecordT", bound=Record)


class Units(NamedTuple):
    """The units of a scene's nondimensional numbers: length L [m], time 1/omega_1 [s], force K_1 L [N]."""

    length: float
    time: float
    force: float

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
        return self.force**dimension.force * self.length**dimension.length * self.time**dimension.time


class _Force(Record):
    """A periodic force by its unbalance or its amplitude; what has no unit as in the nondimensional scene.

    unbalance_kg_m [kg m], >= 0: the force has the amplitude unbalance_kg_m*omega^2; or instead
    amplitude_N [N], >= 0: its amplitude.
    """

    unbalance_kg_m: NonNegative | None = None
    amplitude_N: NonNegative | None = None
    phase: Finite = 0.0
    waveform: Waveform | None = None

    @model_validator(mode="after")
    def _one_of_two(self) -> _Force:
        if (self.unbalance_kg_m is None) == (self.amplitude_N is None):
            raise ValueError("give exactly one of unbalance_kg_m and amplitude_N")
        return self

    def scaled(self, mass: float, scales: Units) -> dict[str, Any]:
        """unbalance/(M L) or amplitude/(K_1 L), and what has no unit."""
        if self.unbalance_kg_m is not None:
            return {"unbalance": self.unbalance_kg_m / (mass * scales.length), **_without_unit(self)}
        assert self.amplitude_N is not None
        return {"amplitude": self.amplitude_N / scales.force, **_without_unit(self)}


class DimensionalDrive(_Force):
    """The force along x1: unbalance_kg_m*omega^2 (or amplitude_N) times waveform(omega t + phase).

    unbalance_kg_m [kg m], >= 0: the force has the amplitude unbalance_kg_m*omega^2; or instead
    amplitude_N [N], >= 0: its amplitude.
    phase [degrees]: the force is the waveform at its frequency*time + phase.
    waveform: sine where left out, square, triangle, sawtooth or {harmonics: [{order, amplitude, phase}, ...]}.
    frequency_rad_per_s [rad/s], > 0: omega, of the drive; everything else that vibrates has it in some ratio.
    direction [degrees]: from x1 towards x2, in scenes with ``transverse``; along x1 where left out.

    >>> import frictionlab as fl
    >>> fl.DimensionalDrive(amplitude_N=20, frequency_rad_per_s=300, waveform="square")
    DimensionalDrive(amplitude_N=20, waveform='square', frequency_rad_per_s=300)
    """

    frequency_rad_per_s: Positive
    direction: Finite | None = None


class DimensionalLoad(_Force):
    """The force along x2, across the belt, beside a drive along x1.

    unbalance_kg_m [kg m], >= 0: the force has the amplitude unbalance_kg_m*(frequency of the drive)^2; or instead
    amplitude_N [N], >= 0: its amplitude.
    phase [degrees]: the force is the waveform at its frequency*time + phase.
    waveform: sine where left out, square, triangle, sawtooth or {harmonics: [{order, amplitude, phase}, ...]}.
    frequency_ratio [-]: its frequency in shares of the drive's, p/q; 1 where left out.

    >>> import frictionlab as fl
    >>> fl.DimensionalLoad(unbalance_kg_m=0.01, frequency_ratio=2)
    DimensionalLoad(unbalance_kg_m=0.01, frequency_ratio=2)
    """

    frequency_ratio: Ratio | None = None


class DimensionalBeltVibration(Record):
    """The belt's velocity beside belt_speed_m_per_s: velocity_amplitude_m_per_s times the waveform.

    velocity_amplitude_m_per_s [m/s], >= 0: of the belt's vibration.
    frequency_rad_per_s [rad/s], > 0: only where nothing else has a frequency.

    What has no unit is as for ``BeltVibration``.

    >>> import frictionlab as fl
    >>> fl.DimensionalBeltVibration(velocity_amplitude_m_per_s=0.02, frequency_rad_per_s=300)
    DimensionalBeltVibration(velocity_amplitude_m_per_s=0.02, frequency_rad_per_s=300)
    """

    velocity_amplitude_m_per_s: NonNegative
    phase: Finite = 0.0
    waveform: Waveform = SINE
    direction: Finite = 0.0
    frequency_ratio: Ratio | None = None
    frequency_rad_per_s: Positive | None = None

    def scaled(self, scales: Units) -> dict[str, Any]:
        """The nondimensional one."""
        size = {"velocity_amplitude": self.velocity_amplitude_m_per_s / scales.velocity}
        return size | _without_unit(self) | _scaled_frequency(self, scales)


class DimensionalNormalLoadVariation(Record):
    """The normal load as its mean times 1 + amplitude*waveform; all as for ``NormalLoadVariation``.

    amplitude [-], >= 0: the varying share of the normal load.
    frequency_rad_per_s [rad/s], > 0: only where nothing else has a frequency.

    >>> import frictionlab as fl
    >>> fl.DimensionalNormalLoadVariation(amplitude=0.3, frequency_rad_per_s=300)
    DimensionalNormalLoadVariation(amplitude=0.3, frequency_rad_per_s=300)
    """

    amplitude: NonNegative
    phase: Finite = 0.0
    waveform: Waveform = SINE
    frequency_ratio: Ratio | None = None
    contact: Literal["per_load", "constant"] = "per_load"
    frequency_rad_per_s: Positive | None = None

    def scaled(self, scales: Units) -> dict[str, Any]:
        """The nondimensional one."""
        return {"amplitude": self.amplitude} | _without_unit(self) | _scaled_frequency(self, scales)


_WITHOUT_UNIT = "phase", "waveform", "direction", "frequency_ratio", "contact"


def _without_unit(part: Record) -> dict[str, Any]:
    """The values of a part that are the same in all units."""
    return {name: value for name, value in part if name in _WITHOUT_UNIT and value is not None}


def _scaled_frequency(part: Any, scales: Units) -> dict[str, float]:
    omega: float | None = part.frequency_rad_per_s
    return {} if omega is None else {"frequency": omega * scales.time}


class DimensionalTransverse(Record):
    """The motion of the same mass along x2, across the belt.

    stiffness_N_per_m [N/m], > 0: K_2, of the spring across the belt.
    damping_N_s_per_m [N s/m], >= 0: C_2, of the dashpot across the belt.
    load: the force across the belt; none where left out.

    >>> import frictionlab as fl
    >>> fl.DimensionalTransverse(stiffness_N_per_m=500, damping_N_s_per_m=2)
    DimensionalTransverse(stiffness_N_per_m=500, damping_N_s_per_m=2)
    """

    stiffness_N_per_m: Positive
    damping_N_s_per_m: NonNegative
    load: DimensionalLoad | None = None


class DimensionalInitial(Record):
    """Where the mass starts, for scenes whose steady state depends on it.

    x_m [m]: position along the belt, from where the spring is undeflected.
    velocity_m_per_s [m/s]: along the belt.
    x2_m [m]: position across the belt.
    velocity2_m_per_s [m/s]: across the belt.

    >>> import frictionlab as fl
    >>> fl.DimensionalInitial(x_m=0.001)
    DimensionalInitial(x_m=0.001)
    """

    x_m: Finite = 0.0
    velocity_m_per_s: Finite = 0.0
    x2_m: Finite = 0.0
    velocity2_m_per_s: Finite = 0.0


class Dimensional(Record):
    """A body on a moving belt, shaken, in SI units.

    mass_kg [kg], > 0: M.
    stiffness_N_per_m [N/m], > 0: K_1, of the spring along the belt.
    damping_N_s_per_m [N s/m], >= 0: C_1, of the dashpot along the belt.
    length_m [m], > 0: L, the length scale of the nondimensional columns; no result in SI units depends on it.
    gravity_m_per_s2 [m/s^2], > 0: the normal load is the weight; 9.81 where normal_load_N is left out.
    normal_load_N [N], > 0: the normal load, instead of gravity_m_per_s2.
    belt_speed_m_per_s [m/s]: V_b.

    Leave ``transverse`` out for one degree of freedom.
    Raises WrongValues with every mistake in the values.

    >>> import frictionlab as fl
    >>> body = {"mass_kg": 1, "stiffness_N_per_m": 400, "damping_N_s_per_m": 4, "length_m": 0.001}
    >>> drive = fl.DimensionalDrive(amplitude_N=20, frequency_rad_per_s=20)
    >>> scene = fl.Scene(dimensional=fl.Dimensional(**body, belt_speed_m_per_s=0.05, drive=drive))
    >>> scene.damping_ratio, scene.normal_load, scene.belt_speed
    (0.1, 24.525, 2.5)
    >>> round(fl.steady_state(scene, fl.Coulomb(mu=0.4)).si["mean_friction_N"], 4)
    0.0332

    Source: Sulollari, van Dalen & Cabboi, Eq. 2.
    """

    mass_kg: Positive
    stiffness_N_per_m: Positive
    damping_N_s_per_m: NonNegative
    length_m: Positive
    gravity_m_per_s2: Positive | None = None
    normal_load_N: Positive | None = None
    belt_speed_m_per_s: Finite
    drive: DimensionalDrive | None = None
    transverse: DimensionalTransverse | None = None
    belt_vibration: DimensionalBeltVibration | None = None
    normal_load_variation: DimensionalNormalLoadVariation | None = None
    initial: DimensionalInitial | None = None

    @model_validator(mode="before")
    @classmethod
    def _weight_unless_a_load_is_given(cls, data: Any) -> Any:
        if isinstance(data, dict) and "normal_load_N" not in data:
            return {"gravity_m_per_s2": STANDARD_GRAVITY, **data}
        return data

    @model_validator(mode="after")
    def _one_scene(self) -> Dimensional:
        problems = [*self._parts_that_do_not_go_together(), *self._out_of_range()]
        if problems:
            raise ValueError("; ".join(problems))
        return self

    def _parts_that_do_not_go_together(self) -> Iterator[str]:
        if self.gravity_m_per_s2 is not None and self.normal_load_N is not None:
            yield "gravity_m_per_s2: leave it out where normal_load_N is given"
        yield from problems_of_parts(self, "frequency_rad_per_s")

    def _out_of_range(self) -> Iterator[str]:
        """Values in wrong units whose nondimensional numbers overflow or vanish."""
        try:
            numbers = [*self.scales, *_numbers(self.scaled())]
        except (ZeroDivisionError, OverflowError):
            numbers = [math.inf]
        if not all(map(math.isfinite, numbers)) or min(*self.scales, self.scaled()["normal_load"]) <= 0.0:
            yield "length_m: these values have no nondimensional numbers: check their units"

    @property
    def scales(self) -> Units:
        """L, 1/omega_1 and K_1 L."""
        time = math.sqrt(self.mass_kg / self.stiffness_N_per_m)
        return Units(self.length_m, time, self.stiffness_N_per_m * self.length_m)

    @property
    def load(self) -> float:
        """The normal load [N]."""
        if self.normal_load_N is not None:
            return self.normal_load_N
        assert self.gravity_m_per_s2 is not None
        return self.mass_kg * self.gravity_m_per_s2

    def scaled(self) -> dict[str, Any]:
        """The nondimensional scene as plain nested values (Eq. 2)."""
        found: dict[str, Any] = {
            "damping_ratio": self._damping_ratio(self.damping_N_s_per_m, self.stiffness_N_per_m),
            "normal_load": self.load / self.scales.force,
            "belt_speed": self.belt_speed_m_per_s / self.scales.velocity,
        }
        if self.drive is not None:
            frequency = _scaled_frequency(self.drive, self.scales)
            found["drive"] = self.drive.scaled(self.mass_kg, self.scales) | frequency
        if self.transverse is not None:
            found["transverse"] = self._scaled_transverse(self.transverse)
        for name in SHAKEN:
            if (part := getattr(self, name)) is not None:
                found[name] = part.scaled(self.scales)
        if self.initial is not None:
            found["initial"] = self._scaled_initial(self.initial)
        return found

    def _damping_ratio(self, damping: float, stiffness: float) -> float:
        return damping / (2.0 * math.sqrt(stiffness * self.mass_kg))

    def _scaled_transverse(self, across: DimensionalTransverse) -> dict[str, Any]:
        found: dict[str, Any] = {
            "natural_frequency": math.sqrt(across.stiffness_N_per_m / self.stiffness_N_per_m),
            "damping_ratio": self._damping_ratio(across.damping_N_s_per_m, across.stiffness_N_per_m),
        }
        if across.load is not None:
            found["load"] = across.load.scaled(self.mass_kg, self.scales)
        return found

    def _scaled_initial(self, initial: DimensionalInitial) -> dict[str, float]:
        """Only the values that are given: a scene with one degree of freedom refuses x2 and velocity2."""
        given = initial.model_dump(exclude_unset=True)
        units = {"m": self.scales.length, "m_per_s": self.scales.velocity}
        parts = {key: key.partition("_") for key in given}
        return {name: given[key] / units[unit] for key, (name, _, unit) in parts.items()}


def _numbers(tree: dict[str, Any]) -> Iterator[float]:
    for value in tree.values():
        if isinstance(value, dict):
            yield from _numbers(value)
        elif isinstance(value, float):
            yield value


@cache
def dimensions(record: type[Record]) -> dict[str, Dimension]:
    """The dimension of every field of a record that has one."""
    found = {
        name: _dimension(field.annotation, field.metadata) for name, field in record.model_fields.items()
    }
    return {name: dimension for name, dimension in found.items() if dimension is not None}


def _dimension(annotation: Any, metadata: Any) -> Dimension | None:
    """The ``Dimension`` in the annotation of a type, or of one of the alternatives of an optional type."""
    for mark in metadata:
        if isinstance(mark, Dimension):
            return mark
    inner = (
        _dimension(None, kind.__metadata__) for kind in get_args(annotation) if hasattr(kind, "__metadata__")
    )
    return next((dimension for dimension in inner if dimension is not None), None)


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
