"""Check of values against a record (scene, law, method), with a sentence for every mistake."""

from __future__ import annotations

import inspect
import math
import re
import types
from collections.abc import Callable, Mapping, Sequence
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

# Each round corrects the mistakes it finds, so that the next finds those they hid; a deep study needs four rounds.
_ROUNDS = 10


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
    made = _Check(record, _copied(tree), path, notes).built()
    assert made is None or isinstance(made, record)
    return made


def wrong_values(record: type[BaseModel], values: Mapping[str, Any]) -> WrongValues:
    """What is wrong with values that Python code gave for a record that refuses them, in the sentences of studies."""
    notes = Notes(notation=PYTHON)
    _Check(record, _copied(values), (), notes).built()
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


def _copied(tree: Mapping[str, Any]) -> dict[str, Any]:
    """A copy whose mappings can be changed."""
    return {key: _copied(value) if isinstance(value, dict) else value for key, value in tree.items()}


def _shown(value: Any) -> str:
    return repr(value) if isinstance(value, str) else PYTHON.text_of(value)


class _Check:
    """The check of one mapping: mistakes are noted, then corrected to find the mistakes they hide."""

    def __init__(self, record: type[BaseModel], tree: dict[str, Any], path: Path, notes: Notes) -> None:
        self._record, self._tree, self._path, self._notes = record, tree, path, notes
        self._spelt: dict[Path, Path] = {}
        self._filled_in: set[str] = set()
        self._clean = True

    def built(self) -> BaseModel | None:
        if self._notes.notation is not PYTHON:
            self._drop_nulls(self._tree, self._record, ())
        for _ in range(_ROUNDS):
            try:
                record = self._record.model_validate(self._tree)
                return record if self._clean else None
            except ValidationError as problem:
                self._clean = False
                errors = problem.errors(include_url=False)
                misspelt_first = sorted(errors, key=lambda error: error["type"] != "extra_forbidden")
                if not any([self._mended(error) for error in misspelt_first]):
                    return None
        return None

    def _note(self, inside: Path, what: str, hint: str = "") -> None:
        self._clean = False
        add = self._notes.on_key if what == "not available yet" else self._notes.add
        add(self._path + self._spelt.get(inside, inside), what, hint)

    def _drop_nulls(self, tree: dict[str, Any], record: type[BaseModel], inside: Path) -> None:
        """A key without a value is a mistake, even where the record itself can do without the key."""
        for key in [key for key in tree if key in record.model_fields]:
            part = nested(record, key)
            if tree[key] is None:
                wanted = "a mapping" if part else "a number" if key in number_paths(record) else "a value"
                self._note((*inside, key), f"must be {wanted}, got null")
                if part is None:
                    del tree[key]
                else:
                    tree[key] = _ones(part)
            elif part and isinstance(tree[key], dict):
                self._drop_nulls(tree[key], part, (*inside, key))

    def _mended(self, error: Any) -> bool:
        """Note one error; whether the tree was corrected, so that another round may find more."""
        inside: Path = error["loc"]
        if error["type"] == "extra_forbidden":
            return self._unknown(inside)
        if error["type"] == "missing" and self._at(inside) is not None:
            return True  # a misspelt key that was meant to be this one
        if error["type"] == "missing":
            self._note(inside, "required key is missing")
            return self._filled(inside)
        if error["type"] in ("model_type", "model_attributes_type", "dict_type"):
            self._note(inside, self._no_part(error))
            return self._replaced(inside)
        if error["type"] == "value_error" and record_at(self._record, inside) is not None:
            return any([self._rule(inside, part, what) for part, what in self._said(inside, _message(error))])
        what = _value_mistake(error, self._notes.notation.text_of)
        self._note(*placed(inside, what, error["input"]), _meant(error))
        return self._filled(inside) if self._is_number(inside) else self._dropped(inside)

    def _no_part(self, error: Any) -> str:
        given = self._notes.notation.text_of(error["input"])
        return f"must be {self._notes.notation.part.format(error['ctx']['class_name'])}, got {given}"

    def _rule(self, whole: Path, inside: Path, what: str) -> bool:
        """A rule of a record on itself or on one of its keys, such as a key that is not available yet."""
        required = what.startswith("required")
        if not any(f"{name} = " in what for name in self._filled_in):  # a number that nobody gave
            self._note(inside, what.replace("required", "required key is missing", 1) if required else what)
        if required:
            return self._filled(inside)
        return self._replaced(inside) if inside == whole else self._dropped(inside)

    def _said(self, inside: Path, message: str) -> list[tuple[Path, str]]:
        """The paths and messages in the message of a record, written ``path: what; path: what``."""
        said = []
        for piece in message.split("; "):
            found = re.fullmatch(r"([\w.]+): (.*)", piece, re.DOTALL)
            if not found or not self._known((*inside, *found[1].split("."))):
                return [(inside, message)]
            said.append(((*inside, *found[1].split(".")), found[2]))
        return said

    def _known(self, inside: Path) -> bool:
        """Whether the last step of a path is a field of the record there, or a key of the mapping there."""
        record = record_at(self._record, inside[:-1])
        tree = self._at(inside[:-1])
        fields = record.model_fields if record else ()
        return inside[-1] in fields or (isinstance(tree, dict) and inside[-1] in tree)

    def _unknown(self, inside: Path) -> bool:
        """An unknown key; the check continues as if the most similar key were given."""
        record, tree = record_at(self._record, inside[:-1]), self._at(inside[:-1])
        fields = record.model_fields if record else {}
        allowed, required = list(fields), [name for name, field in fields.items() if field.is_required()]
        self._notes.unknown_key(self._path + inside, allowed, tree, required)
        value = tree.pop(inside[-1])
        missing = [name for name in required if name not in tree]
        meant = closest(str(inside[-1]), [name for name in allowed if name not in tree], missing)
        if meant is not None and closest(str(inside[-1]), allowed, missing) in (None, meant):
            tree[meant] = value
            self._spelt[(*inside[:-1], meant)] = inside
        return True

    def _at(self, inside: Path) -> Any:
        tree: Any = self._tree
        for step in inside:
            tree = tree.get(step) if isinstance(tree, dict) else None
        return tree

    def _is_number(self, inside: Path) -> bool:
        """Whether the field at this path holds a number."""
        record = record_at(self._record, inside[:-1])
        return bool(inside) and record is not None and str(inside[-1]) in number_paths(record)

    def _filled(self, inside: Path) -> bool:
        """Insert a valid number, if the field holds a number."""
        record, tree = record_at(self._record, inside[:-1]), self._at(inside[:-1])
        if record is None or not self._is_number(inside) or not isinstance(tree, dict):
            return False
        filler = valid_number(record, str(inside[-1]))
        held = tree.get(inside[-1])
        if isinstance(held, int | float) and held == filler:
            return False
        tree[inside[-1]] = filler
        self._filled_in.add(str(inside[-1]))
        return True

    def _replaced(self, inside: Path) -> bool:
        """Replace an invalid record by one of ones, since other rules depend on its presence."""
        parent, tree = record_at(self._record, inside[:-1]), self._at(inside[:-1])
        part = nested(parent, str(inside[-1])) if inside and parent else None
        if part is None or not isinstance(tree, dict):
            return False
        held = tree.get(inside[-1])
        if isinstance(held, dict) and held == _ones(part):
            return False
        tree[inside[-1]] = _ones(part)
        return True

    def _dropped(self, inside: Path) -> bool:
        tree = self._at(inside[:-1])
        if not inside or not isinstance(tree, dict) or inside[-1] not in tree:
            return False
        del tree[inside[-1]]
        return True


def _ones(record: type[BaseModel]) -> dict[str, float]:
    """A one for every number that a record requires."""
    numbers = [key for key in number_paths(record) if key in record.model_fields]
    return {key: valid_number(record, key) for key in numbers if record.model_fields[key].is_required()}


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
