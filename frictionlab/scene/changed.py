"""The values of a record with some replaced, by name or by path."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from frictionlab.mistakes.validation import field_path
from frictionlab.quantities import Record, given_values
from frictionlab.scene.as_written import in_si


def changed(record: Record, tree: Mapping[str, Any], changes: Any, others: Mapping[str, Any]) -> Any:
    """The record made again from its values with changes by path and others by name.

    Raises WrongValues, TypeError.
    """
    if changes is not None and not isinstance(changes, Mapping):
        raise TypeError("with_ takes values by name, belt_speed=2, or by path, {'drive.frequency': 2}")
    given = _as_fields(type(record), {**(changes or {}), **others})
    return type(record)(**with_values(tree, dict(given)))


def _as_fields(record: type[Record], changes: Mapping[str, Any]) -> Iterator[tuple[str, Any]]:
    """Values by the paths of the fields they are for."""
    for path, value in changes.items():
        field = field_path(record, path)
        key, name = (each.rpartition(".")[2] for each in (path, field))
        yield field, value if key == name else in_si(key, name, value)


def with_values(tree: Mapping[str, Any], values: Mapping[str, Any]) -> dict[str, Any]:
    """A copy of nested values with some replaced, by dotted path."""
    new = dict(tree)
    for path, value in values.items():
        head, _, rest = path.partition(".")
        held = new.get(head) if rest else None
        inside = given_values(held) if isinstance(held, Record) else held
        new[head] = (
            with_values(inside if isinstance(inside, Mapping) else {}, {rest: value}) if rest else value
        )
    return new
