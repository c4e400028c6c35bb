# ruff: noqa: N815 - a key ends in its unit, and N stands for newton
"""A scene in SI units and its conversion to nondimensional numbers (Sulollari, van Dalen & Cabboi, Eq. 2).

Each part of a scene is stated once, nondimensional (``parts.py``): its SI form has the same keys, with the unit
behind those of numbers that have a dimension, the same limits and the same rules. Only springs, dashpots, mass,
weight and length, of which the nondimensional numbers are made, have keys of their own here.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping
from contextlib import suppress
from typing import TYPE_CHECKING, Any, ClassVar, Self, cast, get_type_hints

from pydantic import create_model, model_validator

from frictionlab.scene.as_written import AsWritten, changed
from frictionlab.scene.parts import (
    BY_TABLE,
    BeltVibration,
    Body,
    Drive,
    Fractional,
    Initial,
    Load,
    NormalLoadVariation,
    Order,
    Receptance,
    Relaxation,
    ScenePart,
    Slip,
    Transverse,
    TransverseSlip,
    digest_of,
    file_alone,
)
from frictionlab.scene.receptance import TabulatedBody, read_receptance
from frictionlab.scene.rules import problems_of_parts, problems_of_slip, replaced_by_table
from frictionlab.scene.units import (
    DASHPOT,
    SPRING,
    SUFFIXES,
    SWINGS,
    Units,
    damping_ratio_of,
    own_length,
    stiffness_of,
    time_of,
    velocity_of,
)
from frictionlab.scene.waveforms import SINE
from frictionlab.values.quantities import Finite, NonNegative, Positive, dimensions, given_values

STANDARD_GRAVITY = 9.81


class PartInSI(AsWritten):
    """A part of a scene in SI units; nondimensional: what it becomes."""

    nondimensional: ClassVar[type[ScenePart]]

    @classmethod
    def key(cls, name: str) -> str:
        """Under which the part has the value of this nondimensional name."""
        return key_in_si(cls.nondimensional, name)

    def scaled(self, units: Units) -> dict[str, Any]:
        """The values given, as those of the nondimensional part."""
        found: dict[str, Any] = {}
        kinds = dimensions(self.nondimensional)
        for name in self.nondimensional.model_fields:
            key = self.key(name)
            value = getattr(self, key) if key in self.model_fields_set else None
            if isinstance(value, PartInSI):
                found[name] = value.scaled(units)
            elif value is not None:
                found[name] = units.scaled(value, kinds[name]) if name in kinds else value
        return found


def key_in_si(part: type[ScenePart], name: str) -> str:
    """The key of a value in SI units by its nondimensional name: a number with a dimension ends in its unit."""
    dimension = dimensions(part).get(name)
    return name if dimension is None else f"{name}_{SUFFIXES[dimension]}"


class _Shaken(PartInSI):
    """What shakes with one velocity, displacement or acceleration.

    velocity_amplitude_m_per_s [m/s], >= 0: of its velocity; or instead, of a sine,
    displacement_amplitude_m [m], >= 0: of its displacement, the velocity's over the circular frequency; or instead
    acceleration_amplitude_m_per_s2 [m/s^2], >= 0: of its acceleration, the velocity's times it.
    """

    one_of: ClassVar[tuple[tuple[str, ...], ...]] = (SWINGS,)
    velocity_amplitude_m_per_s: NonNegative | None = None
    displacement_amplitude_m: NonNegative | None = None
    acceleration_amplitude_m_per_s2: NonNegative | None = None

    @model_validator(mode="after")
    def _a_sine(self) -> Self:
        waveform = getattr(self, "waveform", None)
        for name in SWINGS[1:]:
            if getattr(self, name) is not None and waveform not in (None, SINE):
                raise ValueError(f"{name}: of a sine alone: give velocity_amplitude with this waveform")
        return self


def _in_si(part: type[ScenePart], example: str, base: type[PartInSI] = PartInSI, **inside: Any) -> Any:
    """The SI form of a part that has no keys of its own in SI units, but for those of its base.

    inside: the SI forms of the parts inside it.
    """
    kinds = get_type_hints(part, include_extras=True) | {name: kind | None for name, kind in inside.items()}
    fields: dict[str, Any] = {
        key: (kinds[name], ... if field.is_required() else field.default)
        for name, field in part.model_fields.items()
        if (key := key_in_si(part, name)) not in base.model_fields
    }
    name = f"Dimensional{part.__name__}"
    said = _documented(part, name, example)
    made = create_model(name, __base__=base, __module__=__name__, __doc__=said, **fields)
    made.nondimensional, made.alternatives = part, part.alternatives
    return made


def _documented(part: type[ScenePart], name: str, example: str) -> str:
    """The docstring of a part with the keys and units of its SI form."""
    paragraphs = [each for each in (part.__doc__ or "").split("\n\n") if not each.lstrip().startswith(">>> ")]
    text = "\n\n".join(paragraphs).rstrip().replace(".", ", in SI units.", 1)
    for field, dimension in dimensions(part).items():
        key, unit = key_in_si(part, field), SUFFIXES[dimension].replace("_per_", "/").replace("_", " ")
        text = re.sub(rf"(?m)^( *){field} \[[^]]*\]", rf"\1{key} [{unit}]", text)
    return f"{text}\n\n    >>> import frictionlab as fl\n    >>> fl.{name}({example})\n    {name}({example})\n    "


class DimensionalFractional(PartInSI):
    """A force coefficient*D^order x1 beside spring and dashpot, in SI units.

    coefficient_N_sq_per_m [N s^order/m], > 0: of the derivative, (i omega)^order of a sine (Weyl).
    order [-], 0 < order <= 1: of the derivative.

    >>> import frictionlab as fl
    >>> fl.DimensionalFractional(coefficient_N_sq_per_m=2, order=0.5)
    DimensionalFractional(coefficient_N_sq_per_m=2, order=0.5)
    """

    nondimensional: ClassVar[type[ScenePart]] = Fractional

    coefficient_N_sq_per_m: Positive
    order: Order

    def scaled(self, units: Units) -> dict[str, Any]:
        """The values given, as those of the nondimensional part."""
        unit = units.force / units.length * units.time**self.order
        return {"coefficient": self.coefficient_N_sq_per_m / unit, "order": self.order}


class DimensionalReceptance(PartInSI):
    """What a linear body answers, measured or computed by others, in place of mass, spring and dashpot, in SI units.

    file: a CSV file with columns frequency [rad/s], real and imaginary [m/N] of x1 over force, from frequency 0;
    their names may end in their units, frequency_rad_per_s, real_m_per_N and imaginary_m_per_N.
    free_mass_kg [kg], > 0: above the last frequency x1 over force is -1/(free mass times frequency^2).
    digest: found where it is left out, of what the file says; a file that says something else is then refused.

    >>> import frictionlab as fl
    >>> fl.DimensionalReceptance(file="no_such_file.csv", free_mass="2 kg")
    Traceback (most recent call last):
    frictionlab.values.notes.WrongValues: DimensionalReceptance: there is no file no_such_file.csv
    """

    nondimensional: ClassVar[type[ScenePart]] = Receptance

    file: str
    free_mass_kg: Positive | None = None
    digest: str = ""

    @model_validator(mode="before")
    @classmethod
    def _file_alone(cls, given: Any) -> Any:
        return file_alone(given)

    @model_validator(mode="after")
    def _can_be_read(self) -> Self:
        object.__setattr__(self, "digest", digest_of(self.body(), self.digest, self.file))
        return self

    def body(self) -> TabulatedBody:
        """The body of the file, in SI units."""
        return read_receptance(self.file, self.free_mass_kg, in_si=True)

    def scaled(self, units: Units) -> dict[str, Any]:
        """The same file, and the units it is in."""
        return super().scaled(units) | {
            "frequency_unit": units.time,
            "receptance_unit": units.force / units.length,
        }


if TYPE_CHECKING:
    DimensionalBody = PartInSI
    DimensionalDrive = PartInSI
    DimensionalRelaxation = PartInSI
    DimensionalLoad = PartInSI
    DimensionalBeltVibration = PartInSI
    DimensionalNormalLoadVariation = PartInSI
    DimensionalInitial = PartInSI
    DimensionalSlip = PartInSI
    DimensionalTransverseSlip = PartInSI
else:
    DimensionalDrive = _in_si(Drive, "amplitude_N=20, waveform='square', frequency_rad_per_s=300")
    DimensionalLoad = _in_si(Load, "unbalance_kg_m=0.01, frequency_ratio=2")
    DimensionalBeltVibration = _in_si(
        BeltVibration, "displacement_amplitude_m=5e-06, frequency_rad_per_s=300", _Shaken
    )
    DimensionalNormalLoadVariation = _in_si(NormalLoadVariation, "amplitude=0.3, frequency_rad_per_s=300")
    DimensionalRelaxation = _in_si(Relaxation, "stiffness_N_per_m=50, time_s=0.01")
    DimensionalBody = _in_si(
        Body,
        "cubic_stiffness_N_per_m3=5000",
        relaxation=DimensionalRelaxation,
        fractional=DimensionalFractional,
        receptance=DimensionalReceptance,
    )
    DimensionalInitial = _in_si(Initial, "x_m=0.001")
    DimensionalSlip = _in_si(Slip, "displacement_amplitude_m=5e-06, frequency_rad_per_s=300", _Shaken)
    DimensionalTransverseSlip = _in_si(
        TransverseSlip, "velocity_amplitude_m_per_s=0.02, frequency_rad_per_s=300", _Shaken
    )


class DimensionalTransverse(PartInSI):
    """The motion of the same mass along x2, across the belt.

    stiffness_N_per_m [N/m], > 0: K_2, of the spring across the belt; or instead
    natural_frequency_rad_per_s [rad/s], > 0: of the mass on it.
    damping_N_s_per_m [N s/m], >= 0: C_2, of the dashpot across the belt; or instead
    damping_ratio [-], >= 0: of the motion across it.
    load: the force across the belt; none where left out.

    >>> import frictionlab as fl
    >>> fl.DimensionalTransverse(stiffness_N_per_m=500, damping_N_s_per_m=2)
    DimensionalTransverse(stiffness_N_per_m=500, damping_N_s_per_m=2)
    """

    nondimensional: ClassVar[type[ScenePart]] = Transverse

    one_of: ClassVar[tuple[tuple[str, ...], ...]] = (SPRING, DASHPOT)
    stiffness_N_per_m: Positive | None = None
    natural_frequency_rad_per_s: Positive | None = None
    damping_N_s_per_m: NonNegative | None = None
    damping_ratio: NonNegative | None = None
    load: DimensionalLoad | None = None


class Dimensional(AsWritten):
    """A body on a moving belt, shaken, in SI units.

    mass_kg [kg], > 0: M.
    stiffness_N_per_m [N/m], > 0: K_1, of the spring along the belt; or instead
    natural_frequency_rad_per_s [rad/s], > 0: omega_1, of the mass on it.
    damping_N_s_per_m [N s/m], >= 0: C_1, of the dashpot along the belt; or instead
    damping_ratio [-], >= 0: of the motion along it.
    length_m [m], > 0: L, the length scale of the nondimensional columns; no result in SI units depends on it. Left
    out, it is the largest amplitude without friction, of each load and of the belt's vibration as a sine of its size;
    normal load over stiffness where nothing shakes.
    gravity_m_per_s2 [m/s^2], > 0: the normal load is the weight; 9.81 where normal_load_N is left out.
    normal_load_N [N], > 0: the normal load, instead of gravity_m_per_s2.
    belt_speed_m_per_s [m/s]: V_b.

    ``slip`` and ``transverse_slip`` prescribe a motion in place of mass, spring, dashpot and loads; normal_load_N is
    then 1 where it is left out. ``body.receptance`` stands for mass, spring and dashpot, too; K_1 is then that of the
    body at rest, M the free mass, where there is none K_1 over the square of the drive's frequency.
    Every number may be text with a unit, its key without one: ``belt_speed="2 mm/s"``, ``frequency="60 Hz"``.
    Leave ``transverse`` out for one degree of freedom.
    Raises WrongValues with every mistake in the values.

    >>> import frictionlab as fl
    >>> body = {"mass": "1 kg", "stiffness": "400 N/m", "damping": "4 N s/m", "length": "1 mm"}
    >>> drive = fl.DimensionalDrive(amplitude="20 N", frequency_rad_per_s=20)
    >>> scene = fl.Scene(dimensional=fl.Dimensional(**body, belt_speed="50 mm/s", drive=drive))
    >>> scene.damping_ratio, scene.normal_load, scene.belt_speed
    (0.1, 24.525, 2.5)
    >>> round(fl.steady_state(scene, fl.Coulomb(mu=0.4)).si["mean_friction_N"], 4)
    0.0332

    Source: Sulollari, van Dalen & Cabboi, Eq. 2.
    """

    one_of: ClassVar[tuple[tuple[str, ...], ...]] = (("mass_kg",), SPRING, DASHPOT)
    mass_kg: Positive | None = None
    stiffness_N_per_m: Positive | None = None
    natural_frequency_rad_per_s: Positive | None = None
    damping_N_s_per_m: NonNegative | None = None
    damping_ratio: NonNegative | None = None
    length_m: Positive | None = None
    gravity_m_per_s2: Positive | None = None
    normal_load_N: Positive | None = None
    belt_speed_m_per_s: Finite
    drive: DimensionalDrive | None = None
    transverse: DimensionalTransverse | None = None
    body: DimensionalBody | None = None
    slip: DimensionalSlip | None = None
    transverse_slip: DimensionalTransverseSlip | None = None
    belt_vibration: DimensionalBeltVibration | None = None
    normal_load_variation: DimensionalNormalLoadVariation | None = None
    initial: DimensionalInitial | None = None

    def with_(self, changes: Mapping[str, Any] | None = None, /, **others: Any) -> Dimensional:
        """The same body with other values: ``with_({"drive.frequency": "60 Hz"}, mass="2 kg")``; None leaves one out.

        >>> import frictionlab as fl
        >>> body = {"mass": "1 kg", "stiffness": "400 N/m", "damping": "4 N s/m"}
        >>> fl.Dimensional(**body, belt_speed="50 mm/s").with_(belt_speed="6 cm/s", damping=None, damping_ratio=0.1)
        Dimensional(mass_kg=1, stiffness_N_per_m=400, damping_ratio=0.1, belt_speed_m_per_s=0.06)

        Raises WrongValues, TypeError.
        """
        return cast(Dimensional, changed(self, given_values(self), changes, others))

    @classmethod
    def _needed(cls, data: Mapping[str, Any]) -> tuple[tuple[str, ...], ...]:
        return () if _prescribed(data) or _by_table(data) else cls.one_of

    @model_validator(mode="after")
    def _one_scene(self) -> Dimensional:
        both = self.gravity_m_per_s2 is not None and self.normal_load_N is not None
        twice = ["gravity_m_per_s2: leave it out where normal_load_N is given"] if both else []
        told = self._of_slip() if self.is_prescribed else [*self._of_table(), *problems_of_parts(self)]
        problems = [*twice, *told]
        if not problems:
            self._fill()
            problems = [*self._out_of_range()]
        if problems:
            raise ValueError("; ".join(problems))
        return self

    def _of_slip(self) -> list[str]:
        body = "mass_kg", *SPRING, *DASHPOT, "gravity_m_per_s2"
        stray = [name for name in body if getattr(self, name) is not None]
        return [f"{name}: leave it out with a prescribed slip" for name in stray] or problems_of_slip(self)

    def _of_table(self) -> list[str]:
        if self.table is None:
            return []
        own = "mass_kg", *SPRING, *DASHPOT, "gravity_m_per_s2", "transverse"
        missing = ["normal_load_N: required, body.receptance tells no weight"]
        return [*replaced_by_table(self, own), *(missing if self.normal_load_N is None else [])]

    def _fill(self) -> None:
        """Put in what was left out: it counts as not given where the body is changed."""
        if self.normal_load_N is None and self.gravity_m_per_s2 is None:
            vars(self).update(
                {"normal_load_N": 1.0} if self.is_prescribed else {"gravity_m_per_s2": STANDARD_GRAVITY}
            )
        if self.length_m is None:
            with suppress(ZeroDivisionError, OverflowError):
                vars(self)["length_m"] = own_length(self)

    def _out_of_range(self) -> Iterator[str]:
        """Values in wrong units whose nondimensional numbers overflow or vanish."""
        try:
            numbers = [*self.scales[:3], *_numbers(self.scaled())]
        except (ZeroDivisionError, OverflowError, TypeError):
            numbers = [math.inf]
        if not all(map(math.isfinite, numbers)) or min(*self.scales[:3], self.scaled()["normal_load"]) <= 0.0:
            yield "length_m: these values have no nondimensional numbers: check their units"

    @property
    def scales(self) -> Units:
        """L, 1/omega_1, K_1 L and M; of a prescribed slip L, 1/omega and the normal load."""
        length, mass = self.length_m or math.nan, self.mass_kg
        if self.table is not None:
            stiffness = 1.0 / self.table.values[0].real
            mass = self.table.mass if math.isfinite(self.table.mass) else stiffness / self.frequency**2
            return Units(length, math.sqrt(mass / stiffness), stiffness * length, mass)
        if mass is None:
            return Units(length, 1.0 / self.frequency, self.load)
        return Units(length, time_of(self, mass), stiffness_of(self, mass) * length, mass)

    @property
    def is_prescribed(self) -> bool:
        """Whether the slip is prescribed and there is no body."""
        return self.slip is not None or self.transverse_slip is not None

    @property
    def table(self) -> TabulatedBody | None:
        """The body by its receptance, in SI units; None of any other."""
        receptance = getattr(self.body, BY_TABLE, None)
        return receptance.body() if receptance is not None else None

    @property
    def frequency(self) -> float:
        """Of the drive, or of what else gives it [rad/s]; 1 where nothing does."""
        slips = self.slip, self.transverse_slip
        parts: tuple[Any, ...] = (self.drive, *slips, self.belt_vibration, self.normal_load_variation)
        found = (part.frequency_rad_per_s for part in parts if part is not None)
        return next((float(each) for each in found if each is not None), 1.0)

    @property
    def load(self) -> float:
        """The normal load [N]."""
        if self.normal_load_N is not None:
            return self.normal_load_N
        assert self.gravity_m_per_s2 is not None
        assert self.mass_kg is not None
        return self.mass_kg * self.gravity_m_per_s2

    def scaled(self) -> dict[str, Any]:
        """The nondimensional scene as plain nested values."""
        scales, mass, across = self.scales, self.mass_kg, self.transverse
        found: dict[str, Any] = {
            name: part.scaled(scales) for name, part in self if isinstance(part, PartInSI)
        }
        for name in ("belt_vibration", "slip", "transverse_slip"):
            if (part := getattr(self, name)) is not None:
                frequency = self.frequency * (getattr(part, "frequency_ratio", None) or 1.0)
                found[name]["velocity_amplitude"] = velocity_of(part, frequency) / scales.velocity
        found |= {
            "normal_load": self.load / scales.force,
            "belt_speed": self.belt_speed_m_per_s / scales.velocity,
        }
        if mass is None:
            return found
        if across is not None:
            found["transverse"] |= {
                "natural_frequency": math.sqrt(stiffness_of(across, mass) / stiffness_of(self, mass)),
                "damping_ratio": damping_ratio_of(across, mass),
            }
        return found | {"damping_ratio": damping_ratio_of(self, mass)}


def _by_table(data: Mapping[str, Any]) -> bool:
    body = data.get("body")
    found = body.get(BY_TABLE) if isinstance(body, Mapping) else getattr(body, BY_TABLE, None)
    return found is not None


def _prescribed(data: Mapping[str, Any]) -> bool:
    return any(data.get(name) is not None for name in ("slip", "transverse_slip"))


def _numbers(tree: dict[str, Any]) -> Iterator[float]:
    for value in tree.values():
        if isinstance(value, dict):
            yield from _numbers(value)
        elif isinstance(value, float):
            yield value
