"""Check of values against a record (scene, law, method), with a sentence for every mistake."""

from __future__ import annotations

import inspect
import math
import re
import types
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from functools import cache
from typing import Annotated, Any, TypeVar, Union, get_args, get_origin

from pydantic import BaseModel, TypeAdapter, ValidationError

from frictionlab.mistakes.notes import (
    PYTHON,
    Mistake,
    Note,
    Notes,
    Path,
    WrongValues,
    closest,
    did_you_mean,
    dotted,
    number_text,
    value_text,
)

_RecordT = TypeVar("_RecordT", bound=BaseModel)


def nested(record: type[BaseModel], key: str) -> type[BaseModel] | None:
    """The record a field holds, or None for a field that holds a plain value."""
    for kind in _alternatives(record.model_fields[key].annotation):
        if isinstance(kind, type) and issubclass(kind, BaseModel):
            return kind
    return None


def number_paths(record: type[BaseModel], prefix: str = "") -> list[str]:
    """The dotted paths of every number a record and those inside it can hold."""
    paths: list[str] = []
    for key, field in record.model_fields.items():
        if part := nested(record, key):
            paths += number_paths(part, f"{prefix}{key}.")
        elif float in _alternatives(field.annotation):
            paths.append(prefix + key)
    return paths


def value_paths(record: type[BaseModel], prefix: str = "") -> list[str]:
    """The dotted paths of every value, number or not, a record and those inside it can hold."""
    paths: list[str] = []
    for key in record.model_fields:
        part = nested(record, key)
        paths += value_paths(part, f"{prefix}{key}.") if part else [prefix + key]
    return paths


def _alternatives(annotation: Any) -> list[Any]:
    if get_origin(annotation) in (Union, types.UnionType):
        return [kind for part in get_args(annotation) for kind in _alternatives(part)]
    return [get_args(annotation)[0] if get_origin(annotation) is Annotated else annotation]


def wrong_value(record: type[BaseModel], key: str, value: Any) -> str | None:
    """The mistake in a value for one field, by itself; None if there is none."""
    return checked_value(record, key, value)[1]


def checked_value(record: type[BaseModel], key: str, value: Any) -> tuple[Any, str | None, str]:
    """The value as a field holds it, the mistake in it and what was meant; no mistake if there is none."""
    try:
        return _field(record, key).validate_python(value), None, ""
    except ValidationError as problem:
        error = problem.errors(include_url=False)[0]
        return None, _value_mistake(error, value_text), _meant(error)


def placed(path: Path, what: str, value: Any) -> tuple[Path, str]:
    """Where and what a mistake is; in a value that is itself a mapping it is written ``path: what``."""
    found = re.fullmatch(r"([\w.\[\]]+): (.*)", what, re.DOTALL)
    if not found or not isinstance(value, Mapping):
        return path, what
    steps = re.findall(r"\[(\d+)\]|(\w+)", found[1])
    return (*path, *(int(place) if place else name for place, name in steps)), found[2]


@cache
def _field(record: type[BaseModel], key: str) -> TypeAdapter[Any]:
    field = record.model_fields[key]
    kind: Any = field.annotation
    return TypeAdapter(Annotated[(kind, *field.metadata)] if field.metadata else kind)


def valid_number(record: type[BaseModel], key: str) -> float:
    """A number that this field accepts: 1, or 0.5 for shares."""
    return 1.0 if wrong_value(record, key, 1.0) is None else 0.5


def record_at(record: type[BaseModel], path: Path) -> type[BaseModel] | None:
    """The record at the end of a path through nested records; None if there is none."""
    found: type[BaseModel] | None = record
    for key in path:
        found = nested(found, str(key)) if found and key in found.model_fields else None
    return found


def build_record(record: type[_RecordT], tree: Any, path: Path, notes: Notes) -> _RecordT | None:
    """The record of this mapping; None, with every mistake noted, if it cannot be built."""
    if notes.mapping(tree, path) is None:
        return None
    check = _Check(record, path, notes)
    made = check.made(tree)
    assert isinstance(made, record)
    return made if check.right else None


def wrong_values(record: type[BaseModel], values: Mapping[str, Any]) -> WrongValues:
    """What is wrong with values that Python code gave for a record that refuses them, in the sentences of studies."""
    notes = Notes(notation=PYTHON)
    _Check(record, (), notes).made(values)
    return WrongValues([_in_python(note, record.__name__, values) for note in notes.all])


_SEVERAL = "one number here: fl.curve, fl.compare and fl.sweep take several"


def _in_python(note: Note, name: str, values: Mapping[str, Any]) -> Mistake:
    given = values.get(str(note.path[-1])) if len(note.path) == 1 else None
    several = note.what.startswith("must be a number") and hasattr(given, "__len__")
    hint = _SEVERAL if several and not isinstance(given, str | Mapping) else note.hint
    return Mistake(name, None, dotted(note.path), note.what, hint)


def unnamed(record: type[BaseModel], values: Sequence[Any]) -> TypeError:
    """What is wrong with values given without their names."""
    names = list(inspect.signature(record).parameters)
    if len(values) == 1 and isinstance(values[0], Mapping):
        return TypeError(f"{record.__name__} takes its values by name: write {record.__name__}(**values)")
    if len(values) == 1 and isinstance(values[0], record):
        return TypeError(
            f"{record.__name__} takes its values by name, and this is a {record.__name__} already"
        )
    if len(values) > len(names):
        return TypeError(f"{record.__name__} takes {', '.join(names) or 'no values'}, each by its name")
    given = ", ".join(f"{name}={_shown(value)}" for name, value in zip(names, values, strict=False))
    return TypeError(f"{record.__name__} takes its values by name: write {record.__name__}({given})")


def _shown(value: Any) -> str:
    return repr(value) if isinstance(value, str) else PYTHON.text_of(value)


class _Check:
    """One look at the values of a record, those of its parts first.

    Others stand in for mistaken ones, so that the rules of the whole are asked all the same.
    """

    def __init__(self, record: type[BaseModel], path: Path, notes: Notes) -> None:
        self._record, self._path, self._notes = record, path, notes
        self._spelt: dict[str, str] = {}
        self._filled_in: set[str] = set()
        self.right = True

    def made(self, given: Mapping[str, Any]) -> BaseModel:
        """The record; where it is not right, one that stands in for it."""
        values = {name: self._part(name, value) for name, value in self._spelled(given).items()}
        values = {name: value for name, value in values.items() if value is not _NOTHING}
        try:
            return self._record.model_validate(values)
        except ValidationError as problem:
            self.right = False
            errors = problem.errors(include_url=False)
        if not errors[0]["loc"]:
            return self._ruled_out(errors)
        for error in errors:
            self._mistaken(error, values)
        try:
            return self._record.model_validate(values)
        except ValidationError as problem:
            # a rule of one value refuses what stands in for it: only rules of the whole are told
            return self._ruled_out([each for each in problem.errors(include_url=False) if not each["loc"]])

    def _ruled_out(self, errors: Sequence[Any]) -> BaseModel:
        """Note what the values are not together, right as each may be."""
        for error in errors:
            self._rule(error)
        return _stand_in(self._record)

    def _note(self, name: str | int, *deeper: str | int, what: str, hint: str = "") -> None:
        self.right = False
        self._notes.add((*self._path, self._spelt.get(str(name), name), *deeper), what, hint)

    def _spelled(self, given: Mapping[str, Any]) -> dict[str, Any]:
        """The values by the names of fields; an unknown key is noted, and taken for the one most like it."""
        fields = self._record.model_fields
        required = [name for name, field in fields.items() if field.is_required()]
        values = {name: value for name, value in given.items() if name in fields}
        for key in (key for key in given if key not in fields):
            self.right = False
            self._notes.unknown_key((*self._path, key), fields, given, required)
            missing = [name for name in required if name not in values]
            meant = closest(str(key), [name for name in fields if name not in values], missing)
            if meant is not None and closest(str(key), fields, missing) in (None, meant):
                values[meant], self._spelt[meant] = given[key], key
        return values

    def _part(self, name: str, value: Any) -> Any:
        """A value, of a part the record; a key without a value is a mistake in a study."""
        part = nested(self._record, name)
        if part is not None and isinstance(value, Mapping):
            check = _Check(part, (*self._path, self._spelt.get(name, name)), self._notes)
            made = check.made(value)
            self.right = self.right and check.right
            return made
        if value is None and self._notes.notation is not PYTHON:
            wanted = "a mapping" if part else "a number" if self._is_number(name) else "a value"
            self._note(name, what=f"must be {wanted}, got null")
            return _stand_in(part) if part else _NOTHING
        return value

    def _is_number(self, name: str) -> bool:
        return name in number_paths(self._record)

    def _mistaken(self, error: Any, values: dict[str, Any]) -> None:
        """Note the mistake in one value, for which another then stands in."""
        name, *deeper = error["loc"]
        part = nested(self._record, name)
        if error["type"] == "missing":
            self._note(name, what="required key is missing")
        elif part is not None:
            wanted = self._notes.notation.part.format(part.__name__)
            given = self._notes.notation.text_of(error["input"])
            self._note(name, what=f"must be {wanted}, got {given}")
            values[name] = _stand_in(part)
            return
        else:
            what = _value_mistake(error, self._notes.notation.text_of)
            path, what = placed((name, *deeper), what, error["input"])
            self._note(*path, what=what, hint=_meant(error))
        values.pop(name, None)
        if self._is_number(name):
            values[name] = valid_number(self._record, name)
            self._filled_in.add(name)

    def _rule(self, error: Any) -> None:
        """Note what the values are not together: of one of them, or of the whole."""
        for path, what in self._said(_message(error)):
            required = what.startswith("required")
            if any(f"{name} = " in what for name in self._filled_in):  # a number that nobody gave
                continue
            told = what.replace("required", "required key is missing", 1) if required else what
            if path:
                self._note(*path, what=told)
            else:
                self._notes.add(self._path, told)

    def _said(self, message: str) -> list[tuple[Path, str]]:
        """The paths and messages in the message of a record, written ``path: what; path: what``."""
        said: list[tuple[Path, str]] = []
        for piece in message.split("; "):
            found = re.fullmatch(r"([\w.]+): (.*)", piece, re.DOTALL)
            path = tuple(found[1].split(".")) if found else ()
            record = record_at(self._record, path[:-1])
            if not found or record is None or path[-1] not in record.model_fields:
                return [((), message)]
            said.append((path, found[2]))
        return said


_NOTHING = object()
"""In place of a value that was left out."""


def _stand_in(part: type[BaseModel]) -> BaseModel:
    """A record with a one for every number that it requires, and where rules ask for one more, for that."""
    numbers = [name for name in number_paths(part) if name in part.model_fields]
    required = {name: valid_number(part, name) for name in numbers if part.model_fields[name].is_required()}
    for more in ({}, *({name: 1.0} for name in numbers)):
        with suppress(ValidationError):
            return part.model_validate(required | more)
    return part.model_construct(None, **required)


def _message(error: Any) -> str:
    return str(error["ctx"]["error"]) if "error" in error.get("ctx", {}) else str(error["msg"])


def _meant(error: Any) -> str:
    """Which of the quoted names that are allowed a wrong name was meant to be."""
    if not isinstance(error["input"], str):
        return ""
    allowed = _value_mistake(error, value_text).partition("got the text")[0]
    return did_you_mean(error["input"], re.findall("'([^']*)'", allowed))


_BOUNDS = {"greater_than": (">", "gt"), "greater_than_equal": (">=", "ge")}
_BOUNDS |= {"less_than": ("<", "lt"), "less_than_equal": ("<=", "le")}


def _value_mistake(error: Any, text_of: Callable[[Any], str]) -> str:
    """An error in a single value as a sentence."""
    given = text_of(error["input"])
    if isinstance(error["input"], float) and not math.isfinite(error["input"]):
        return f"must be a finite number, got {given}"
    if error["type"] in _BOUNDS:
        sign, name = _BOUNDS[error["type"]]
        return f"must be {sign} {number_text(error['ctx'][name])}, got {given}"
    if error["type"] == "literal_error":
        return f"must be {error['ctx']['expected']}; got {given}"
    if error["type"] == "string_type":
        return f"must be text, got {given}"
    if error["type"] == "tuple_type":
        return f"must be a list such as [1, 2], got {given}"
    if error["type"] == "too_short":
        return f"must be a list of at least {error['ctx']['min_length']}, got {error['ctx']['actual_length']}"
    message = _message(error)
    if error["type"].startswith("int"):
        return f"must be a whole number, got {given}"
    if error["type"].startswith("float"):
        return f"must be a number, got {given}"
    if error["type"].startswith("bool"):
        return f"must be true or false, got {given}"
    if message.startswith("must be "):
        return f"{message}, got {given}"
    return message[:1].lower() + message[1:]
