# ruff: noqa: N815 - a key ends in its unit, and N stands for newton
"""Scene in SI units and its conversion to nondimensional numbers (Sulollari, van Dalen & Cabboi, Eq. 2).

Each part of a scene is stated once, nondimensional (``parts.py``). Its SI form has the same keys, with the
unit behind those of numbers that have a dimension, the same limits and the same rules. Only springs,
dashpots, mass, weight, length and the ways to give an oscillation, from which the nondimensional numbers are
made, have keys of their own here.

People write keys without a unit, and texts with one: ``belt_speed: 2 mm/s`` and ``belt_speed_m_per_s: 2 mm/s`` are
``belt_speed_m_per_s: 0.002``. Values of a record are replaced by name or by path.
"""

from __future__ import annotations

import inspect
import math
import re
from collections.abc import Iterator, Mapping
from contextlib import suppress
from numbers import Real
from typing import TYPE_CHECKING, Any, ClassVar, Self, get_type_hints

from pydantic import create_model, model_validator

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
from frictionlab.scene.rules import (
    frequency_of,
    problems_of_free,
    problems_of_parts,
    problems_of_slip,
    replaced_by_table,
)
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
from frictionlab.values.notes import Mistake, Unfit, WrongValues
from frictionlab.values.quantities import Finite, NonNegative, Positive, Record, dimensions, given_values
from frictionlab.values.units import in_units, quantity_in
from frictionlab.values.validation import field_path

STANDARD_GRAVITY = 9.81

_SUFFIX = re.compile(
    r"_(N_s_per_m3|N_per_m3|N_s_per_m|m_per_s2|rad_per_s|N_per_m|m_per_s|(?<!_sq_)per_m|kg_m|kg|N|(?<!_per_)m|J|s)$"
)
"""Unit at the end of the key of a number, or of the name of a result."""
_WITHOUT_SUFFIX = {"phase": "deg", "direction": "deg", "amplitude": "", "damping_ratio": ""}
"""Units of numbers whose keys do not end in a unit."""


class AsWritten(ScenePart):
    """Part in SI units.

    ``other_names`` maps the keys without a unit to their fields. Each tuple in ``one_of`` names alternatives,
    of which exactly one is given, each in ``at_most_one_of`` those of which one or none is.
    """

    other_names: ClassVar[Mapping[str, str]] = {}
    one_of: ClassVar[tuple[tuple[str, ...], ...]] = ()
    at_most_one_of: ClassVar[tuple[tuple[str, ...], ...]] = ()

    if TYPE_CHECKING:  # every number may be text, and its key without a unit

        def __init__(self, **values: Any) -> None: ...

    @classmethod
    def __pydantic_init_subclass__(cls, **options: Any) -> None:
        super().__pydantic_init_subclass__(**options)
        cls.other_names = {without_unit(name): name for name in cls.model_fields if _SUFFIX.search(name)}

    @model_validator(mode="before")
    @classmethod
    def _numbers_in_si(cls, data: Any) -> Any:
        if not isinstance(data, Mapping):
            return data
        found = dict(_fields(data, cls))
        for names in (*cls._needed(found), *cls.at_most_one_of):
            _one_of(found, names, names not in cls.at_most_one_of)
        return found

    @classmethod
    def _needed(cls, _data: Mapping[str, Any]) -> tuple[tuple[str, ...], ...]:
        """Return those of ``one_of`` that these values need."""
        return cls.one_of


def without_unit(name: str) -> str:
    """Return the name of a number in SI units without its unit."""
    return _SUFFIX.sub("", name)


def unit_of(name: str) -> str | None:
    """Return the unit of the number of this name, or None if it may be no number."""
    found = _SUFFIX.search(name)
    if not found:
        return _WITHOUT_SUFFIX.get(name)
    unit = re.sub("^per_", "1/", found[1]).replace("_per_", "/").replace("_", " ")
    return re.sub(r"(?<=[a-z])(\d)", r"^\1", unit)


def in_si(key: str, name: str, value: Any) -> Any:
    """Return the value of a field, given under a key, in SI units.

    A text with a unit becomes a number; a value that is no number becomes the reason why not.
    """
    unit = unit_of(name)
    if unit is None:
        return value
    if isinstance(value, str):
        return in_units(value, unit)
    if key != name and isinstance(value, Real) and not isinstance(value, bool) and value != 0:
        kind = quantity_in(unit)
        return Unfit(
            value, f"{value:.6g} has no unit; give {kind} such as '{kind.example}', or the key {name}"
        )
    return value


def _one_of(data: dict[str, Any], names: tuple[str, ...], is_needed: bool) -> None:
    """Put in a message if more than one of the names is given, or none of those that are needed."""
    given = [name for name in names if data.get(name) is not None]
    if not given and is_needed:
        others = f" (or {' or '.join(map(without_unit, names[1:]))})" if names[1:] else ""
        data[names[0]] = Unfit(None, f"required key is missing{others}")
    for name in given[1:]:
        data[name] = Unfit(data[name], f"leave it out where {without_unit(given[0])} is given")


def _fields(data: Mapping[str, Any], part: type[AsWritten]) -> Iterator[tuple[str, Any]]:
    """Yield values by the names of their fields, with mistakes in the place of values given twice."""
    for key, value in data.items():
        name = part.other_names.get(key, key)
        if name != key and name in data:
            continue
        twice = [other for other, field in part.other_names.items() if field == key and other in data]
        yield (
            name,
            Unfit(value, f"is given as {twice[0]}, too: leave one of them out")
            if twice
            else in_si(key, name, value),
        )


def changed(
    record: type[Record], held: Record, changes: Any, others: Mapping[str, Any], within: str = ""
) -> dict[str, Any]:
    """Return the values given for a record with changes by path, which may begin with ``within``, and by name.

    Raises TypeError if the changes are no mapping.
    """
    if changes is not None and not isinstance(changes, Mapping):
        raise TypeError("with_ takes values by name, belt_speed=2, or by path, {'drive.frequency': 2}")
    all_of_them = {path.removeprefix(within): value for path, value in {**(changes or {}), **others}.items()}
    _check_alternatives(record, held, all_of_them)
    return with_values(given_values(held), dict(_as_fields(record, all_of_them)))


def _check_alternatives(record: type[Record], held: Record, changes: Mapping[str, Any]) -> None:
    """Raise WrongValues for a change to another way to say what is held, with what to write."""
    named = {field_path(record, path): path for path, value in changes.items() if value is not None}
    for group in (*getattr(record, "one_of", ()), *getattr(record, "at_most_one_of", ())):
        for name in (name for name in group if getattr(held, name) is not None and name not in named):
            new = next((named[other] for other in group if other in named), None)
            if new is not None and without_unit(name) not in changes and name not in changes:
                told = f"with_({without_unit(name)}=None, {new}={changes[new]!r})"
                raise WrongValues(
                    [Mistake("Scene", None, new, f"takes the place of {without_unit(name)}: write {told}")]
                )


def _as_fields(record: type[Record], changes: Mapping[str, Any]) -> Iterator[tuple[str, Any]]:
    """Yield values by the paths of the fields they are for."""
    for path, value in changes.items():
        field = field_path(record, path)
        key, name = (text.rpartition(".")[2] for text in (path, field))
        yield field, value if key == name else in_si(key, name, value)


def with_values(tree: Mapping[str, Any], values: Mapping[str, Any]) -> dict[str, Any]:
    """Return a copy of nested values with some replaced, by dotted path."""
    new = dict(tree)
    for path, value in values.items():
        head, _, rest = path.partition(".")
        held = new.get(head) if rest else None
        inside = given_values(held) if isinstance(held, Record) else held
        new[head] = (
            with_values(inside if isinstance(inside, Mapping) else {}, {rest: value}) if rest else value
        )
    return new


class PartInSI(AsWritten):
    """Part of a scene in SI units; ``nondimensional`` is the part that it becomes."""

    nondimensional: ClassVar[type[ScenePart]]

    if TYPE_CHECKING:  # the numbers of parts that are made below

        def __getattr__(self, name: str) -> Any: ...

    @classmethod
    def called(cls) -> str:
        """Return what one would type in Python to give it."""
        return "dict"

    @classmethod
    def key(cls, name: str) -> str:
        """Return the key under which the part has the value of a nondimensional name."""
        return key_in_si(cls.nondimensional, name)

    def scaled(self, units: Units) -> dict[str, Any]:
        """Return the values given, by the names of the nondimensional part, in these units."""
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
    """Return the key in SI units of a nondimensional name; with a dimension it ends in the unit."""
    dimension = dimensions(part).get(name)
    return name if dimension is None else f"{name}_{SUFFIXES[dimension]}"


class _Shaken(PartInSI):
    """Oscillation given by its velocity, its displacement or its acceleration.

    Parameters
    ----------
    velocity_amplitude_m_per_s : float, >= 0, optional
        Amplitude of the velocity [m/s].
    displacement_amplitude_m : float, >= 0, optional
        Amplitude of the displacement [m]: that of the velocity over the circular frequency. Given
        instead of the velocity's, for a sine alone.
    acceleration_amplitude_m_per_s2 : float, >= 0, optional
        Amplitude of the acceleration [m/s^2]: that of the velocity times the circular frequency. Given
        instead of the velocity's, for a sine alone.
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


class _Sprung(PartInSI):
    """Motion of the mass on a spring and a dashpot, each given by one of two numbers.

    Parameters
    ----------
    stiffness_N_per_m : float, > 0, optional
        Stiffness of the spring [N/m]. Exactly one is given: it or ``natural_frequency_rad_per_s``.
    natural_frequency_rad_per_s : float, > 0, optional
        Natural frequency of the mass on that spring [rad/s].
    damping_N_s_per_m : float, >= 0, optional
        Damping of the dashpot [N s/m]. Exactly one is given: it or ``damping_ratio``.
    damping_ratio : float, >= 0, optional
        Damping ratio of the motion [-].
    """

    one_of: ClassVar[tuple[tuple[str, ...], ...]] = (SPRING,)
    at_most_one_of: ClassVar[tuple[tuple[str, ...], ...]] = (DASHPOT,)
    stiffness_N_per_m: Positive | None = None
    natural_frequency_rad_per_s: Positive | None = None
    damping_N_s_per_m: NonNegative | None = None
    damping_ratio: NonNegative | None = None


class _FractionalInSI(PartInSI):
    """Force coefficient*D^order x1 beside spring and dashpot of the body, in SI units.

    Parameters
    ----------
    coefficient_N_sq_per_m : float, > 0
        Coefficient of the derivative [N s^order/m]; the derivative of a sine is (i omega)^order times it
        (Weyl).
    order : float, > 0 and <= 1
        Order of the derivative [-].
    """

    nondimensional: ClassVar[type[ScenePart]] = Fractional

    coefficient_N_sq_per_m: Positive
    order: Order

    def scaled(self, units: Units) -> dict[str, Any]:
        """Return coefficient and order in these units."""
        unit = units.force / units.length * units.time**self.order
        return {"coefficient": self.coefficient_N_sq_per_m / unit, "order": self.order}


class _ReceptanceInSI(PartInSI):
    """Frequency response of a linear body, in place of its mass, spring and dashpot, in SI units.

    Parameters
    ----------
    file : str
        CSV file with columns frequency [rad/s], real and imaginary [m/N]: parts of x1 over force, from
        frequency 0. Their names may end in their units: frequency_rad_per_s, real_m_per_N and
        imaginary_m_per_N.
    free_mass_kg : float, > 0, optional
        Mass [kg]: above the last frequency x1 over force is -1/(free mass times frequency^2).
    digest : str, default ""
        Digest of the contents of the file; found if left out. A file with other contents is then refused.
    """

    nondimensional: ClassVar[type[ScenePart]] = Receptance

    file: str
    free_mass_kg: Positive | None = None
    digest: str = ""

    @model_validator(mode="before")
    @classmethod
    def _file_alone(cls, values: Any) -> Any:
        return file_alone(values)

    @model_validator(mode="after")
    def _can_be_read(self) -> Self:
        object.__setattr__(self, "digest", digest_of(self.body(), self.digest, self.file))
        return self

    def body(self) -> TabulatedBody:
        """Return the body of the file: frequencies [rad/s] with x1 over force [m/N]."""
        return read_receptance(self.file, self.free_mass_kg, in_si=True)

    def scaled(self, units: Units) -> dict[str, Any]:
        """Return the same file, and the units it is in."""
        return super().scaled(units) | {
            "frequency_unit": units.time,
            "receptance_unit": units.force / units.length,
        }


def _in_si(part: type[ScenePart], base: type[PartInSI] = PartInSI, **inside: Any) -> Any:
    """Make the SI form of a part: the keys of its base, then those of its other values.

    ``inside`` holds the SI forms of the parts inside it.
    """
    kinds = get_type_hints(part, include_extras=True) | {name: kind | None for name, kind in inside.items()}
    fields: dict[str, Any] = {
        key: (kinds[name], ... if field.is_required() else field.default)
        for name, field in part.model_fields.items()
        if (key := key_in_si(part, name)) not in base.model_fields
    }
    name = f"{part.__name__}InSI"
    made = create_model(name, __base__=base, __module__=__name__, __doc__=_documented(part), **fields)
    made.nondimensional, made.alternatives, made.alone = part, part.alternatives, part.alone
    globals()[name] = made  # where pickle looks for it
    return made


def _documented(part: type[ScenePart]) -> str:
    """Return the docstring of a part with the keys and units of its SI form."""
    text = inspect.cleandoc(part.__doc__ or "").partition("\n\nExamples\n")[0]
    for field in dimensions(part):
        key = key_in_si(part, field)
        text = text.replace(f"``{field}``", f"``{key}``")
        text = re.sub(rf"(?ms)^{field} : (.*?)\[[^]]*\]", rf"{key} : \1[{unit_of(key)}]", text, count=1)
    return text


class InSI(PartInSI):
    """Body on a moving belt, shaken, in SI units, as ``Scene.si`` makes it; ``Dimensional`` has its parts, too."""

    one_of: ClassVar[tuple[tuple[str, ...], ...]] = (("mass_kg",), SPRING)
    at_most_one_of: ClassVar[tuple[tuple[str, ...], ...]] = (DASHPOT,)
    mass_kg: Positive | None = None
    stiffness_N_per_m: NonNegative | None = None
    natural_frequency_rad_per_s: Positive | None = None
    damping_N_s_per_m: NonNegative | None = None
    damping_ratio: NonNegative | None = None
    length_m: Positive | None = None
    gravity_m_per_s2: Positive | None = None
    normal_load_N: Positive | None = None
    belt_speed_m_per_s: Finite

    @classmethod
    def called(cls) -> str:
        """Return what one would type in Python to make it."""
        return "Scene.si"

    def scaled(self, _units: Units | None = None) -> dict[str, Any]:
        """Return the nondimensional scene as plain nested values, from which ``Scene`` is made."""
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
                "natural_frequency": scales.time / time_of(across, mass),
                "damping_ratio": damping_ratio_of(across, mass),
            }
        spring = {"spring": False} if self.is_free else {}
        return found | spring | {"damping_ratio": damping_ratio_of(self, mass)}

    @classmethod
    def _needed(cls, data: Mapping[str, Any]) -> tuple[tuple[str, ...], ...]:
        return () if _prescribed(data) or _by_table(data) else cls.one_of

    @model_validator(mode="after")
    def _one_scene(self) -> Self:
        both = self.gravity_m_per_s2 is not None and self.normal_load_N is not None
        twice = ["gravity_m_per_s2: leave it out where normal_load_N is given"] if both else []
        if self.is_free and self.damping_ratio is not None:
            twice.append("damping_ratio: is of a spring, and stiffness is 0: give damping")
        twice += problems_of_free(self, SPRING[0]) if self.is_free else []
        others = self._of_slip() if self.is_prescribed else [*self._of_table(), *problems_of_parts(self)]
        problems = [*twice, *others]
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
        """Put in values that were left out: they count as not given when the body is changed."""
        if self.normal_load_N is None and self.gravity_m_per_s2 is None:
            vars(self).update(
                {"normal_load_N": 1.0} if self.is_prescribed else {"gravity_m_per_s2": STANDARD_GRAVITY}
            )
        if self.length_m is None:
            with suppress(ZeroDivisionError, OverflowError):
                vars(self)["length_m"] = own_length(self)

    def _out_of_range(self) -> Iterator[str]:
        """Yield a message if values, in wrong units, have nondimensional numbers that overflow or vanish."""
        try:
            numbers = [*self.scales[:3], *_numbers(self.scaled())]
        except (ZeroDivisionError, OverflowError, TypeError):
            numbers = [math.inf]
        if not all(map(math.isfinite, numbers)) or min(*self.scales[:3], self.scaled()["normal_load"]) <= 0.0:
            yield "length_m: these values have no nondimensional numbers: check their units"

    @property
    def scales(self) -> Units:
        """Units L, 1/omega_1, K_1 L and M; those of a prescribed slip are L, 1/omega and the normal load."""
        length, mass = self.length_m or math.nan, self.mass_kg
        if self.table is not None:
            stiffness = 1.0 / self.table.values[0].real
            mass = self.table.mass if math.isfinite(self.table.mass) else stiffness / self.frequency**2
            return Units(length, math.sqrt(mass / stiffness), stiffness * length, mass)
        if mass is None:
            return Units(length, 1.0 / self.frequency, self.load)
        time = time_of(self, mass)
        return Units(
            length, time, mass * length / time**2 if self.is_free else stiffness_of(self, mass) * length, mass
        )

    @property
    def is_free(self) -> bool:
        """True if no spring holds the body along the belt."""
        return self.stiffness_N_per_m == 0.0

    @property
    def is_prescribed(self) -> bool:
        """True if the slip is prescribed and there is no body."""
        return self.slip is not None or self.transverse_slip is not None

    @property
    def table(self) -> TabulatedBody | None:
        """Body by its receptance, in SI units; None of any other."""
        receptance = getattr(self.body, BY_TABLE, None)
        return receptance.body() if receptance is not None else None

    @property
    def frequency(self) -> float:
        """Frequency of the drive, or of the part that gives it [rad/s]; 1 if no part does."""
        return frequency_of(self)

    @property
    def load(self) -> float:
        """Normal load [N]."""
        if self.normal_load_N is not None:
            return self.normal_load_N
        assert self.gravity_m_per_s2 is not None
        assert self.mass_kg is not None
        return self.mass_kg * self.gravity_m_per_s2


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


if TYPE_CHECKING:
    Dimensional = InSI
else:
    Dimensional = create_model(
        "Dimensional",
        __base__=InSI,
        __module__=__name__,
        **{
            name: (form | None, None)
            for name, form in {
                "drive": _in_si(Drive),
                "transverse": _in_si(Transverse, _Sprung, load=_in_si(Load)),
                "body": _in_si(
                    Body,
                    relaxation=_in_si(Relaxation),
                    fractional=_FractionalInSI,
                    receptance=_ReceptanceInSI,
                ),
                "slip": _in_si(Slip, _Shaken),
                "transverse_slip": _in_si(TransverseSlip, _Shaken),
                "belt_vibration": _in_si(BeltVibration, _Shaken),
                "normal_load_variation": _in_si(NormalLoadVariation),
                "initial": _in_si(Initial),
            }.items()
        },
    )
