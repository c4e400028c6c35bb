"""Keys and numbers of a part in SI units as people write them, and copies of records with other values.

``belt_speed: 2 mm/s`` and ``belt_speed_m_per_s: 2 mm/s`` are ``belt_speed_m_per_s: 0.002``. Values of a
record are replaced by name or by path.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from numbers import Real
from typing import TYPE_CHECKING, Any, ClassVar

from pydantic import model_validator

from frictionlab.scene.parts import ScenePart
from frictionlab.values.notes import Unfit
from frictionlab.values.quantities import Record, given_values
from frictionlab.values.units import in_units, quantity_in
from frictionlab.values.validation import field_path

_SUFFIX = re.compile(
    r"_(N_s_per_m3|N_per_m3|N_s_per_m|m_per_s2|rad_per_s|N_per_m|m_per_s|(?<!_sq_)per_m|kg_m|kg|N|(?<!_per_)m|J|s)$"
)
"""Unit at the end of the key of a number, or of the name of a result."""
_WITHOUT_SUFFIX = {"phase": "deg", "direction": "deg", "amplitude": "", "damping_ratio": ""}
"""Units of numbers whose keys do not end in a unit."""


class AsWritten(ScenePart):
    """Part in SI units.

    ``other_names`` maps the keys without a unit to their fields. Each tuple in ``one_of`` names alternatives,
    of which exactly one is given.
    """

    other_names: ClassVar[Mapping[str, str]] = {}
    one_of: ClassVar[tuple[tuple[str, ...], ...]] = ()

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
        for names in cls._needed(found):
            _one_of(found, names)
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
    if key != name and isinstance(value, Real) and not isinstance(value, bool):
        kind = quantity_in(unit)
        return Unfit(
            value, f"{value:.6g} has no unit; give {kind} such as '{kind.example}', or the key {name}"
        )
    return value


def _one_of(data: dict[str, Any], names: tuple[str, ...]) -> None:
    """Put in a message if not exactly one of the names is given."""
    given = [name for name in names if data.get(name) is not None]
    if not given:
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
    return with_values(given_values(held), dict(_as_fields(record, all_of_them)))


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
