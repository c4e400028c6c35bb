"""Expectations of a study of its table: the lines under ``expect``, and their check against its columns."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Annotated, Any, Literal, Self

from pydantic import (
    BeforeValidator,
    Field,
    ValidatorFunctionWrapHandler,
    WithJsonSchema,
    WrapValidator,
    model_validator,
)

from frictionlab.laws.base import Finite, Positive, Record
from frictionlab.scene.dimensional import in_si
from frictionlab.scene.scene import Scene
from frictionlab.study.parts import natural
from frictionlab.study.written import column_of
from frictionlab.values import columns
from frictionlab.values.notes import KeyPath, Notes, did_you_mean, value_text
from frictionlab.values.units import in_units, number_before_unit
from frictionlab.values.validation import checked_value, placed, record_at

_ENDS = "from", "to"


def _or_text(value: Any, number: ValidatorFunctionWrapHandler) -> Any:
    """A number, or a text with a unit as it is: which unit it must be depends on the column."""
    return value if isinstance(value, str) and number_before_unit(value) != value else number(value)


def _two(labels: Any) -> Any:
    if not isinstance(labels, list | tuple) or len(labels) != 2:
        raise ValueError("must be a list of two method labels")
    return labels


OrText = WrapValidator(_or_text)
_WITH_UNIT: dict[str, Any] = {"type": "string", "pattern": r"^\s*[-+]?[0-9.]"}
NumberSchema = WithJsonSchema({"anyOf": [{"type": "number"}, _WITH_UNIT]})
_COMPARABLE = [
    name for name in (*columns.RESULTS, *columns.SI, *columns.CURVE_MEASURES) if name not in columns.TEXT
]
WhereValue = str | float | list[str | float] | dict[str, float]
"""Wanted value of an input: a value, one of several, or a number within a range, ``{"from": 5, "to": 20}``."""
CLAIMED = "equals", "below", "above"
_GO_WITH = {
    "status": (),
    "max_difference": ("below",),
    "shape": ("measure",),
    "column": (*CLAIMED, "within", "minus", "over"),
}
"""Four kinds of claim, each with the keys that go with it."""


class Expectation(Record):
    """Claim of a study about its table.

    where: the rows that are meant, by input columns: a value, a list, or from and to; all where left out
    minus: what is compared is the column less that of the row with these inputs and equal others
    over: what is compared is the column over that of the row with these inputs and equal others
    column: column of the table or of curves that is compared
    equals: the value of the column, but for within
    below: the column, or the largest difference, is less than this
    above: the column is more than this
    within: absolute difference that equals lets pass
    status: the status of the rows
    max_difference: labels of two methods whose means are compared
    shape: verdict on the shape of the curves, without belt speed in where
    measure: the measure that the verdict is read from; area where left out
    because: why that is expected, such as a source
    """

    where: dict[str, Any] = Field(default_factory=dict)
    minus: dict[str, Any] | None = None
    over: dict[str, Any] | None = None
    column: Annotated[str, WithJsonSchema({"enum": _COMPARABLE})] | None = None
    equals: Annotated[Finite, OrText, NumberSchema] | None = None
    below: Annotated[Finite, OrText, NumberSchema] | None = None
    above: Annotated[Finite, OrText, NumberSchema] | None = None
    within: Annotated[Positive, OrText, NumberSchema] | None = None
    status: Literal["ok", "refused", "failed", "not_unique"] | None = None
    max_difference: Annotated[tuple[str, str], BeforeValidator(_two)] | None = None
    shape: Literal["concave", "convex", "mixed", "undecided"] | None = None
    measure: Literal["area", "initial"] | None = None
    because: str = ""

    @property
    def kind(self) -> str:
        """Return the key of the claim, which is its kind."""
        return next((key for key in _GO_WITH if getattr(self, key) is not None), "column")

    @property
    def of_curves(self) -> bool:
        """Check whether it speaks of whole curves."""
        return self.shape is not None or self.column in columns.CURVE_MEASURES

    @model_validator(mode="after")
    def _one_claim(self) -> Self:
        kind, said = self.kind, [key for key in CLAIMED if getattr(self, key) is not None]
        keys = [key for key, value in self if value is not None and key not in ("where", "because", kind)]
        wrong = [
            f"{key}: {'goes with shape' if key == 'measure' else f'does not go with {kind}'}"
            for key in keys
            if key not in _GO_WITH[kind]
        ]
        if kind == "column" and self.column is None:
            wrong += ["column: required key is missing (or give status, max_difference or shape)"]
        elif kind == "column" and len(said) != 1:
            raise ValueError(
                f"give exactly one of equals, below and above, got {' and '.join(said) or 'none'}"
            )
        needed = {"max_difference": "below"}.get(kind, "within" if self.equals is not None else "")
        if needed and getattr(self, needed) is None:
            wrong += [f"{needed}: required key is missing"]
        if self.minus is not None and self.over is not None:
            wrong += ["over: give minus or over, not both"]
        if wrong:
            raise ValueError("; ".join(wrong))
        return self

    def resolved(self) -> dict[str, Any]:
        """Return the entry of a study file."""
        told = {name: natural(value) for name, value in self if value is not None and value != ""}
        return told | ({"max_difference": list(self.max_difference)} if self.max_difference else {})


@dataclass(frozen=True)
class Table:
    """Columns of the table of a study: text inputs with their values, number inputs, results, swept inputs.

    words: the words and waveforms of the scene, with their values. belt_speed: the column of the belt speed,
    nondimensional or in SI units; units: of the parameters of laws, where the scene is in SI units.
    """

    texts: Mapping[str, tuple[str, ...]]
    numbers: tuple[str, ...]
    results: tuple[str, ...]
    words: Mapping[str, tuple[str, ...]]
    swept: tuple[str, ...] = ()
    belt_speed: str = columns.BELT_SPEED
    units: Mapping[str, str] = field(default_factory=dict)


def of_table(given: Expectation, path: KeyPath, table: Table, notes: Notes) -> Expectation:
    """Return the expectation as the table has its names and numbers; what it has not is noted."""
    said: dict[str, Any] = {"where": _where(given.where, (*path, "where"), table, notes, _wanted)}
    beside = {key: value for key in ("minus", "over") if (value := getattr(given, key)) is not None}
    said |= {key: _where(value, (*path, key), table, notes, _input) for key, value in beside.items()}
    if given.column is not None:
        _column(given.column, (*path, "column"), table, notes)
    if given.of_curves:
        _of_curves(given, path, table, notes)
    if given.shape is not None:
        said["measure"] = given.measure or "area"
        notes.one_of(given.shape, (*path, "shape"), columns.SHAPES[said["measure"]])
    for at, label in enumerate(given.max_difference or ()):
        notes.one_of(label, (*path, "max_difference", at), table.texts["method"])
    if given.max_difference and len({*given.max_difference}) < 2:
        notes.add((*path, "max_difference", 1), "is the same method: give two different ones")
    for key in (*CLAIMED, "within"):
        if isinstance(value := getattr(given, key), str):
            found = in_si(given.column, given.column, value) if given.column in columns.SI else value
            read = notes.positive if key == "within" else notes.number
            said[key] = read(found, (*path, key))
    return given.model_copy(update=said)


def _where(
    given: Any, path: KeyPath, table: Table, notes: Notes, read: Callable[..., WhereValue | None]
) -> dict[str, WhereValue]:
    """Return the input columns and values that select rows; read: of one of them what it must be."""
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
    """Return what an input of rows must be: one value, one of several, or a number within a range."""
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
        return notes.one_of(value, path, table.texts[key])
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
    value: Any, path: KeyPath, column: str, known: tuple[str, ...], notes: Notes
) -> str | None:
    """A word of the scene, or a waveform as the scene gives it or as the table does: as it stands in the table."""
    if isinstance(value, str) and value in known:
        return value
    held, what, hint = _as_in_scene(column, value)
    if what is not None:
        notes.add(*placed(path, what, value), hint)
        return None
    if str(held) not in known:
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
    """Value as the scene holds it in the field of this column, what is wrong with it and what was meant."""
    *steps, key = column.removeprefix("scene.").split(".")
    record = record_at(Scene, tuple(steps))
    assert record is not None
    return checked_value(record, key, value)


def _of_curves(given: Expectation, path: KeyPath, table: Table, notes: Notes) -> None:
    """Note what does not go with whole curves: belt speeds that select rows, or none swept."""
    for name in given.where:
        if name in columns.BELT_SPEEDS:
            notes.on_key((*path, "where", name), "a shape belongs to a whole curve: leave the belt speed out")
    if not any(name in columns.BELT_SPEEDS for name in table.swept):
        notes.on_key((*path, given.kind), f"a shape needs a curve: sweep {table.belt_speed}")


def _column(given: str, path: KeyPath, table: Table, notes: Notes) -> None:
    name = result_column(given, path, (*table.results, *columns.CURVE_MEASURES), notes)
    if name in columns.TEXT:
        notes.add(path, f"'{name}' holds text; only numbers can be compared")


def result_column(
    given: Any, path: KeyPath, results: Sequence[str], notes: Notes, what: str = "result column"
) -> str | None:
    """Return the name of one of these result columns; None, noted, where it is none."""
    if not isinstance(given, str) or given not in results:
        hint = did_you_mean(given, results) if isinstance(given, str) else ""
        in_si = given in columns.SI if isinstance(given, str) else False
        needed = " (this one needs a scene given in SI units: scene.dimensional)" if in_si else ""
        notes.add(path, f"must be a {what}, got {value_text(given)}{needed}", "" if in_si else hint)
        return None
    return given
