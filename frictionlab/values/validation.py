"""Check of values against a record (scene, law, method), with a sentence for every mistake."""

from __future__ import annotations

import inspect
import math
import re
import types
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cache
from typing import Annotated, Any, TypeVar, Union, get_args, get_origin

from pydantic import BaseModel, TypeAdapter, ValidationError

from frictionlab.values.notes import (
    PYTHON,
    KeyPath,
    Mistake,
    Note,
    Notes,
    Unfit,
    WrongValues,
    closest,
    did_you_mean,
    dotted,
    number_text,
    value_text,
)

_RecordT = TypeVar("_RecordT", bound=BaseModel)


def nested(record: type[BaseModel], key: str) -> type[BaseModel] | None:
    """Return the record a field holds, or None for a field that holds a plain value."""
    return _record(record.model_fields[key].annotation)


def _record(kind: Any) -> type[BaseModel] | None:
    """Return the record among the alternatives of a type."""
    kinds = (each for each in _alternatives(kind) if isinstance(each, type) and issubclass(each, BaseModel))
    return next(kinds, None)


def _inside(kind: Any, step: str | int) -> Any:
    """Return the type of a field of a record, or of an item of a list or a mapping; None if there is none."""
    if (record := _record(kind)) is not None:
        return record.model_fields[step].annotation if step in record.model_fields else None
    several = (get_args(each) for each in _alternatives(kind) if get_origin(each) in (tuple, dict))
    return next((each[0] if each[-1] is ... else each[-1] for each in several), None)


def field_name(record: type[BaseModel], key: str) -> str:
    """Return the field that a key gives: that of its own name, or one that the record has it for."""
    other: Mapping[str, str] = {**getattr(record, "other_names", {}), **getattr(record, "spellings", {})}
    return other.get(key, key)


def field_path(record: type[BaseModel], path: str) -> str:
    """A dotted path of keys as that of the fields they give, as far as there are any."""
    found, owner, steps = list[str](), record, path.split(".")
    for at, key in enumerate(steps):
        found.append(field_name(owner, key))
        inside = nested(owner, found[-1]) if found[-1] in owner.model_fields else None
        if inside is None:
            return ".".join([*found, *steps[at + 1 :]])
        owner = inside
    return ".".join(found)


def number_paths(record: type[BaseModel], prefix: str = "") -> list[str]:
    """Return the dotted paths of every number a record and those inside it can hold."""
    paths: list[str] = []
    for key, field in record.model_fields.items():
        if part := nested(record, key):
            paths += number_paths(part, f"{prefix}{key}.")
        elif float in _alternatives(field.annotation):
            paths.append(prefix + key)
    return paths


def value_paths(record: type[BaseModel], prefix: str = "") -> list[str]:
    """Return the dotted paths of every value, number or not, a record and those inside it can hold."""
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
    """Return the mistake in a value for one field, by itself; None if there is none."""
    return checked_value(record, key, value)[1]


def checked_value(record: type[BaseModel], key: str, value: Any) -> tuple[Any, str | None, str]:
    """Return the value as a field holds it, the mistake in it and what was meant; no mistake if there is none."""
    try:
        return _field(record, key).validate_python(value), None, ""
    except ValidationError as problem:
        error = problem.errors(include_url=False)[0]
        return None, _value_mistake(error, value_text), _meant(error)


def placed(path: KeyPath, what: str, value: Any) -> tuple[KeyPath, str]:
    """Return where and what a mistake is; in a value that is itself a mapping it is written ``path: what``."""
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


def record_at(record: type[BaseModel], path: KeyPath) -> type[BaseModel] | None:
    """Return the record at the end of a path through nested records; None if there is none."""
    kind: Any = record
    for step in path:
        kind = _inside(kind, step)
    return _record(kind)


def build_record(record: type[_RecordT], tree: Any, path: KeyPath, notes: Notes) -> _RecordT | None:
    """Return the record of this mapping; None, with every mistake noted, if it cannot be built."""
    if notes.mapping(tree, path) is None:
        return None
    nulls = dict(_nulls(record, tree))
    for at, wanted in nulls.items():
        notes.add((*path, *at), f"must be {wanted}, got null")
    try:
        made = record.model_validate(tree)
    except ValidationError as problem:
        _Told(record, tree, path, notes).add(problem, rules=not nulls)
        return None
    return None if nulls else made


def _nulls(kind: Any, given: Any) -> Iterator[tuple[KeyPath, str]]:
    """Yield the keys that a study leaves without a value, and what each should have."""
    items = (
        enumerate(given) if isinstance(given, list) else given.items() if isinstance(given, Mapping) else ()
    )
    for key, value in items:
        record = _record(kind)
        wanted = _inside(kind, key if record is None else field_name(record, str(key)))
        if value is None and wanted is not None:
            held = [get_origin(each) or each for each in _alternatives(wanted)]
            told = (word for each, word in _NULLS.items() if each in held)
            yield (key,), "a mapping" if _record(wanted) else next(told, "a value")
        elif wanted is not None:
            yield from (((key, *below), told) for below, told in _nulls(wanted, value))


_NULLS = {float: "a number", str: "text", tuple: "a list", dict: "a mapping"}


def wrong_values(record: type[BaseModel], values: Mapping[str, Any]) -> WrongValues:
    """Return the error of values given in Python for a record that refuses them, in the sentences of studies."""
    notes = Notes(notation=PYTHON)
    try:
        record.model_validate(values)
    except ValidationError as problem:
        _Told(record, values, (), notes).add(problem)
    return WrongValues([_in_python(note, _called(record), values) for note in notes.all])


def _called(record: type[BaseModel]) -> str:
    """Return what one would type in Python to make a record."""
    return record.called() if hasattr(record, "called") else record.__name__


_SEVERAL = "one number here: fl.curve, fl.compare and fl.sweep take several"


def _in_python(note: Note, name: str, values: Mapping[str, Any]) -> Mistake:
    given = values.get(str(note.path[-1])) if len(note.path) == 1 else None
    several = note.what.startswith("must be a number") and hasattr(given, "__len__")
    hint = _SEVERAL if several and not isinstance(given, str | Mapping) else note.hint
    return Mistake(name, None, dotted(note.path), note.what, hint)


def unnamed(record: type[BaseModel], values: Sequence[Any]) -> TypeError:
    """Return what is wrong with values given without their names."""
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


_MISSING = "required key is missing"


class _Told:
    """Mistakes of values that a record refuses, as notes.

    Of a key that is one letter off it is not told as well that the right one is missing.
    """

    def __init__(
        self, record: type[BaseModel], given: Mapping[str, Any], path: KeyPath, notes: Notes
    ) -> None:
        self._record, self._given, self._path, self._notes = record, given, path, notes

    def add(self, problem: ValidationError, rules: bool = True) -> None:
        """Note every one of them; rules: those of values together, too."""
        errors: list[Any] = problem.errors(include_url=False)
        above = {each["loc"][:-1] for each in errors}  # a list is short of items that are wrong
        errors = [each for each in errors if each["type"] != "too_short" or each["loc"] not in above]
        if not rules:
            errors = [each for each in errors if not self._is_rule(each)]
        unknown = [each["loc"] for each in errors if each["type"] == "extra_forbidden"]
        there = {self._misspelt(loc) for loc in unknown}
        for error in errors:
            wanted = str(getattr(error["input"], "what", ""))
            if error["type"] == "missing" or wanted.startswith(_MISSING):
                told = "" if error["loc"] in there else wanted or _MISSING
            else:
                told = "" if error["loc"] in unknown else self._mistake(error)
            if told:
                self._notes.add(self._at(error["loc"]), told)

    def _at(self, loc: KeyPath) -> KeyPath:
        """Return the path of the value of a field: under a key of its own name, or one that the record has for it."""
        kind: Any = self._record
        given: Any = self._given
        found = list(self._path)
        for step in loc:
            if isinstance(step, int) and not isinstance(given, list | tuple):  # one value without brackets
                kind = _inside(kind, step)
                continue
            held = given if isinstance(given, Mapping) else dict(enumerate(given or ()))
            owner = _record(kind)
            others = (key for key in held if owner is not None and field_name(owner, str(key)) == step)
            key = step if step in held else next(others, step)
            found.append(key)
            given, kind = held.get(key), _inside(kind, step)
        return tuple(found)

    def _is_rule(self, error: Any) -> bool:
        return "error" in error.get("ctx", {}) and record_at(self._record, error["loc"]) is not None

    def _misspelt(self, loc: KeyPath) -> KeyPath:
        """Note an unknown key; where the one that was meant belongs."""
        owner = record_at(self._record, loc[:-1]) or self._record
        given: Any = self._given
        for step in loc[:-1]:
            given = given[step]
        key, fields = str(loc[-1]), owner.model_fields
        if why := getattr(owner, "gone_keys", {}).get(key):
            self._notes.on_key((*self._path, *loc), why)
            return loc
        required = [name for name, field in fields.items() if field.is_required()]
        shorter = {field: key for key, field in getattr(owner, "other_names", {}).items()}
        names = [shorter.get(name, field.alias or name) for name, field in fields.items()]
        self._notes.unknown_key((*self._path, *loc), names, given, required, shorter)
        left = [name for name in fields if name not in given]
        return (*loc[:-1], closest(key, left, [name for name in required if name in left]) or key)

    def _mistake(self, error: Any) -> str:
        """Return the sentence for a value, a part or the rules of one, where it is not noted here."""
        loc, text_of = error["loc"], self._notes.notation.text_of
        part = record_at(self._record, loc)
        if part is not None and self._is_rule(error):
            return self._rules(part, loc, _message(error))
        if part is not None:
            return f"must be {self._notes.notation.part.format(_called(part))}, got {text_of(error['input'])}"
        path, what = placed(self._at(loc), _value_mistake(error, text_of), error["input"])
        self._notes.add(path, what, _meant(error))
        return ""

    def _rules(self, part: type[BaseModel], loc: KeyPath, message: str) -> str:
        """Tell the rules that the values of a part break, written ``path: what; path: what`` where it is of some."""
        said: list[tuple[KeyPath, str]] = []
        for piece in message.split("; "):
            found = re.fullmatch(r"([\w.]+): (.*)", piece, re.DOTALL)
            path = tuple(found[1].split(".")) if found else ()
            record = record_at(part, path[:-1])
            if not found or record is None or path[-1] not in record.model_fields:
                return message
            said.append((path, found[2]))
        for path, what in said:
            told = (
                what.replace("required", "required key is missing", 1)
                if what.startswith("required")
                else what
            )
            self._notes.add(self._at((*loc, *path)), told)
        return ""


def _message(error: Any) -> str:
    return str(error["ctx"]["error"]) if "error" in error.get("ctx", {}) else str(error["msg"])


def _meant(error: Any) -> str:
    """Find which of the quoted names that are allowed a wrong name was meant to be."""
    if not isinstance(error["input"], str):
        return ""
    allowed = _value_mistake(error, value_text).partition("got the text")[0]
    return did_you_mean(error["input"], re.findall("'([^']*)'", allowed))


_BOUNDS = {"greater_than": (">", "gt"), "greater_than_equal": (">=", "ge")}
_BOUNDS |= {"less_than": ("<", "lt"), "less_than_equal": ("<=", "le")}
_WANTED = {"string": "text", "tuple": "a list such as [1, 2]", "int": "a whole number", "float": "a number"}
_WANTED |= {"bool": "true or false", "dict": "a mapping (key: value)"}
"""By what the name of an error begins with."""


_WITH_UNIT = re.compile(r"\s*[+-]?[\d.]+(?:[eE][+-]?\d+)?\s*[^\W\d].*")
_UNITS = " (units go with a scene in SI units: scene.dimensional)"


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
    if error["type"] == "too_short":
        return f"must be a list of at least {error['ctx']['min_length']}, got {error['ctx']['actual_length']}"
    wanted = next((what for start, what in _WANTED.items() if error["type"].startswith(start)), None)
    message = _message(error) if wanted is None else f"must be {wanted}"
    if message.startswith("must be "):
        value = error["input"].given if isinstance(error["input"], Unfit) else error["input"]
        with_unit = message == "must be a number" and _WITH_UNIT.fullmatch(str(value))
        quoted = message == "must be text" and not isinstance(value, dict | list | None)
        return f"{message}, got {given}{_UNITS if with_unit else ' (put it in quotes)' if quoted else ''}"
    return message[:1].lower() + message[1:]
