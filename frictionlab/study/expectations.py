"""Reading of the ``expect`` lines of a study and their check against the columns of its table."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from frictionlab.scene.dimensional import in_si
from frictionlab.scene.scene import Scene
from frictionlab.study.parts import Expectation, WhereValue
from frictionlab.study.written import column_of
from frictionlab.values import columns
from frictionlab.values.notes import KeyPath, Notes, did_you_mean, value_text
from frictionlab.values.units import in_units
from frictionlab.values.validation import checked_value, placed, record_at

EXPECTATION_KEYS = (
    *("where", "minus", "over", "column", "equals", "below", "above", "within"),
    *("status", "max_difference", "shape", "measure", "because"),
)
_COMPARISONS = ("equals", "below", "above")
_ENDS = ("from", "to")


@dataclass(frozen=True)
class Table:
    """The columns of the table of a study: text inputs with their values, number inputs, results, swept inputs.

    words: the words and waveforms of the scene, with their values. The values of a text column are None where
    mistakes leave them uncertain; belt_speed: the column of the belt speed, nondimensional or in SI units; units: of
    the parameters of laws, where the scene is in SI units.
    """

    texts: Mapping[str, tuple[str, ...] | None]
    numbers: tuple[str, ...]
    results: tuple[str, ...]
    words: Mapping[str, tuple[str, ...] | None]
    swept: tuple[str, ...] = ()
    belt_speed: str = columns.BELT_SPEED
    units: Mapping[str, str] = field(default_factory=dict)


def expectations(given: Any, table: Table, notes: Notes) -> tuple[Expectation, ...]:
    """Every expectation without a mistake; mistakes are noted."""
    if not isinstance(given, list):
        notes.add(("expect",), f"must be a list, got {value_text(given)}")
        return ()
    read = [_expectation(item, ("expect", index), table, notes) for index, item in enumerate(given)]
    return tuple(expectation for expectation in read if expectation is not None)


def _expectation(given: Any, path: KeyPath, table: Table, notes: Notes) -> Expectation | None:
    if notes.mapping(given, path) is None:
        return None
    for key in given:
        if key not in EXPECTATION_KEYS:
            notes.unknown_key((*path, key), EXPECTATION_KEYS)
    where = _where(given.get("where", {}), (*path, "where"), table, notes, _wanted)
    said = _claim(given, path, table, notes)
    if "because" in given:
        said["because"] = notes.text(given["because"], (*path, "because"))
    return None if notes.below(path) else Expectation(where=where, **said)


def _where(
    given: Any, path: KeyPath, table: Table, notes: Notes, read: Callable[..., WhereValue | None]
) -> dict[str, WhereValue]:
    """The input columns and values that select rows; read: of one of them what it must be."""
    where: dict[str, WhereValue] = {}
    for key, value in (notes.mapping(given, path) or {}).items():
        if key not in table.texts and key not in table.words and column_of(key) not in table.numbers:
            names = (*table.texts, *table.numbers, *table.words)
            hint = did_you_mean(key, names)
            notes.on_key((*path, key), "is no input column of this study's table", hint)
        elif (found := read(value, (*path, key), key, table, notes)) is not None:
            where[column_of(key)] = found
    return where


def _wanted(given: Any, path: KeyPath, key: str, table: Table, notes: Notes) -> WhereValue | None:
    """What an input of rows must be: one value, one of several, or a number within a range."""
    if isinstance(given, list):
        read = [_input(value, (*path, index), key, table, notes) for index, value in enumerate(given)]
        return [value for value in read if value is not None]
    if not isinstance(given, dict) or key in table.words:
        return _input(given, path, key, table, notes)
    notes.mapping(given, path, _ENDS)
    if not given:
        notes.add(path, "give from, to or both")
    ends = {end: _input(given[end], (*path, end), key, table, notes) for end in _ENDS if end in given}
    return {end: value for end, value in ends.items() if isinstance(value, float)}


def _input(value: Any, path: KeyPath, key: str, table: Table, notes: Notes) -> str | float | None:
    """One value of an input column."""
    if key in table.texts:
        return _known_text(value, path, table.texts[key], notes)
    if key in table.words:
        return _word_of_scene(value, path, key, table.words[key], notes)
    return _number(_written(key, column_of(key), value, table), path, column_of(key), notes)


def _written(key: str, column: str, value: Any, table: Table) -> Any:
    """A number of an input or result, in SI units written as text with a unit, too."""
    if column in table.units:
        return in_units(value, table.units[column]) if isinstance(value, str) else value
    in_the_scales_of_the_scene = column.startswith("scene.") and not column.startswith("scene.dimensional.")
    return (
        value
        if in_the_scales_of_the_scene
        else in_si(key.rpartition(".")[2], column.rpartition(".")[2], value)
    )


def _word_of_scene(
    value: Any, path: KeyPath, column: str, known: tuple[str, ...] | None, notes: Notes
) -> str | None:
    """A word of the scene, or a waveform as the scene gives it or as the table does: as it stands in the table."""
    if isinstance(value, str) and value in (known or ()):
        return value
    held, what, hint = _as_in_scene(column, value)
    if what is not None:
        notes.add(*placed(path, what, value), hint)
        return None
    if known is not None and str(held) not in known:
        notes.add(path, f"the table has {', '.join(known)} alone, got {held}")
    return str(held)


def _number(value: Any, path: KeyPath, column: str, notes: Notes) -> float | None:
    """A number, or what the scene takes for one, such as the ratio 3/2."""
    if isinstance(value, str) and column.startswith("scene."):
        held, what, _ = _as_in_scene(column, value)
        if what is None:
            return float(held)
    return notes.number(value, path)


def _as_in_scene(column: str, value: Any) -> tuple[Any, str | None, str]:
    """The value as the scene holds it in the field of this column, what is wrong with it and what was meant."""
    *steps, key = column.removeprefix("scene.").split(".")
    record = record_at(Scene, tuple(steps))
    assert record is not None
    return checked_value(record, key, value)


def _known_text(value: Any, path: KeyPath, known: tuple[str, ...] | None, notes: Notes) -> str | None:
    return notes.text(value, path) if known is None else notes.one_of(value, path, known)


def _claim(given: dict[str, Any], path: KeyPath, table: Table, notes: Notes) -> dict[str, Any]:
    """The claim about the rows: a number, a status, a difference of two methods, or the shape of a curve."""
    if "status" in given:
        _only(given, ("status",), path, notes)
        statuses = tuple(status for status in columns.STATUSES if status != "killed")
        return {"status": notes.one_of(given["status"], (*path, "status"), statuses)}
    if "max_difference" in given:
        return _difference(given, path, table, notes)
    return _shape(given, path, table, notes) if "shape" in given else _comparison(given, path, table, notes)


def _difference(given: dict[str, Any], path: KeyPath, table: Table, notes: Notes) -> dict[str, Any]:
    _only(given, ("max_difference", "below"), path, notes)
    pair, at = given["max_difference"], (*path, "max_difference")
    below = _positive(given, "below", path, notes)
    if not (isinstance(pair, list) and len(pair) == 2):
        notes.add(at, f"must be a list of two method labels, got {value_text(pair)}")
        return {}
    labels = [_known_text(label, (*at, i), table.texts["method"], notes) for i, label in enumerate(pair)]
    if labels[0] is not None and labels[0] == labels[1]:
        notes.add((*at, 1), "is the same method: give two different ones")
    return {"max_difference": tuple(labels), "below": below}


def _shape(given: dict[str, Any], path: KeyPath, table: Table, notes: Notes) -> dict[str, Any]:
    """A verdict on whole curves."""
    _only(given, ("shape", "measure"), path, notes)
    _of_curves(given, "shape", path, table, notes)
    measure = notes.one_of(given.get("measure", "area"), (*path, "measure"), tuple(columns.SHAPES))
    shapes = columns.SHAPES.get(str(measure), columns.SHAPES["area"])
    return {"shape": notes.one_of(given["shape"], (*path, "shape"), shapes), "measure": measure}


def _of_curves(given: dict[str, Any], key: str, path: KeyPath, table: Table, notes: Notes) -> None:
    """Note what does not go with whole curves: belt speeds that select rows, or none swept."""
    where = given.get("where")
    for name in where if isinstance(where, dict) else ():
        if name in columns.BELT_SPEEDS:
            notes.on_key((*path, "where", name), "a shape belongs to a whole curve: leave the belt speed out")
    if not any(name in columns.BELT_SPEEDS for name in table.swept):
        notes.on_key((*path, key), f"a shape needs a curve: sweep {table.belt_speed}")


def _comparison(given: dict[str, Any], path: KeyPath, table: Table, notes: Notes) -> dict[str, Any]:
    if "measure" in given:
        notes.on_key((*path, "measure"), "goes with shape")
    column = None
    if "column" not in given:
        notes.add((*path, "column"), "required key is missing (or give status, max_difference or shape)")
    else:
        column = _column(given["column"], (*path, "column"), table, notes)
    if column in columns.CURVE_MEASURES:
        _of_curves(given, "column", path, table, notes)
    chosen = [key for key in _COMPARISONS if key in given]
    if len(chosen) != 1:
        notes.add(path, f"give exactly one of equals, below and above, got {' and '.join(chosen) or 'none'}")
    if column in columns.SI:
        given = given | {
            key: in_si(column, column, given[key]) for key in (*chosen, "within") if key in given
        }
    said: dict[str, Any] = {key: notes.number(given[key], (*path, key)) for key in chosen}
    if "within" in given or "equals" in given:
        said["within"] = _positive(given, "within", path, notes)
    beside = [key for key in ("minus", "over") if key in given]
    if len(beside) > 1:
        notes.on_key((*path, "over"), "give minus or over, not both")
    said |= {key: _where(given[key], (*path, key), table, notes, _input) for key in beside}
    return {"column": column, **said}


def _column(given: Any, path: KeyPath, table: Table, notes: Notes) -> str | None:
    name = result_column(given, path, (*table.results, *columns.CURVE_MEASURES), notes)
    if name in columns.TEXT:
        notes.add(path, f"'{name}' holds text; only numbers can be compared")
    return name


def result_column(
    given: Any, path: KeyPath, results: Sequence[str], notes: Notes, what: str = "result column"
) -> str | None:
    """The name of one of these result columns; None, noted, where it is none."""
    if not isinstance(given, str) or given not in results:
        hint = did_you_mean(given, results) if isinstance(given, str) else ""
        in_si = given in columns.SI if isinstance(given, str) else False
        needed = " (this one needs a scene given in SI units: scene.dimensional)" if in_si else ""
        notes.add(path, f"must be a {what}, got {value_text(given)}{needed}", "" if in_si else hint)
        return None
    return given


def _positive(given: dict[str, Any], key: str, path: KeyPath, notes: Notes) -> float | None:
    if key not in given:
        notes.add((*path, key), "required key is missing")
        return None
    return notes.positive(given[key], (*path, key))


def _only(given: dict[str, Any], own: tuple[str, ...], path: KeyPath, notes: Notes) -> None:
    """Note the keys that belong to another kind of expectation."""
    for key in given:
        if key in EXPECTATION_KEYS and key not in (*own, "where", "because"):
            notes.on_key((*path, key), f"does not go with {own[0]}")
