"""Plain values of YAML text, with the position of every key and value, and of a Python mapping."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path as FilePath
from typing import Any

from ruamel.yaml import YAML
from ruamel.yaml.error import MarkedYAMLError, YAMLError
from ruamel.yaml.nodes import MappingNode, Node, ScalarNode, SequenceNode

from frictionlab.values.notes import (
    KeyPath,
    Mistake,
    Note,
    StudyError,
    TextPosition,
    Unreadable,
    dotted,
    text_of,
)
from frictionlab.values.printable import one_line

TOO_DEEP = "not a study: nested too deeply"

_TAG = "tag:yaml.org,2002:"
_CONTROL = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x84\x86-\x9f\ud800-\udfff\ufffe\uffff]")
_LINE_END = re.compile("\r\n|[\r\n]")  # as the YAML reader counts lines


@dataclass(frozen=True)
class UnsupportedValue:
    """Description of a value that no key of a study accepts, such as a date."""

    words: str

    def __str__(self) -> str:
        """Return the words."""
        return self.words


@dataclass
class Source:
    """Values of a study with their positions; notes: the mistakes of the YAML itself.

    keys, values: path -> position. origins: path -> the ``--set`` that set the value.
    """

    name: str
    text: str = ""
    tree: Any = None
    keys: dict[KeyPath, TextPosition] = field(default_factory=dict)
    values: dict[KeyPath, TextPosition] = field(default_factory=dict)
    origins: dict[KeyPath, str] = field(default_factory=dict)
    notes: list[Note] = field(default_factory=list)

    @cached_property
    def lines(self) -> list[str]:
        """Return the lines of the text."""
        return _LINE_END.split(self.text)

    def also_at(self, path: KeyPath, given: KeyPath) -> None:
        """Let a path stand where another one, and what is below it, is given."""
        for places in (self.keys, self.values, self.origins):
            for at in [each for each in places if each[: len(given)] == given]:
                places.setdefault((*path, *at[len(given) :]), places[at])  # type: ignore[arg-type]  # of three kinds

    def located(self, notes: Iterable[Note]) -> list[Mistake]:
        """Return the notes as mistakes, in the order of the file, those of the command line last."""
        found = dict.fromkeys(self._located(note) for note in notes)
        return sorted(found, key=lambda mistake: mistake.place or (float("inf"), 0))

    def _located(self, note: Note) -> Mistake:
        origin, place = self._where(note)
        line = self.lines[place.line - 1] if place and place.line <= len(self.lines) else ""
        return Mistake(origin, place, dotted(note.path), note.what, note.hint, line)

    def _where(self, note: Note) -> tuple[str, TextPosition | None]:
        """Return the position of the path, or of the innermost part around it that the study has."""
        if note.origin or note.place:
            return note.origin or self.name, note.place
        for length in range(len(note.path), -1, -1):
            path = note.path[:length]
            if path in self.origins:
                return self.origins[path], None
            first, second = (self.keys, self.values) if note.on_key else (self.values, self.keys)
            if place := first.get(path) or second.get(path):
                return self.name, place
        return self.name, None


def read_file(path: FilePath) -> Source:
    """Return the values of a YAML file. Raises StudyError for a file that is not readable YAML text."""
    try:
        return read_text(text_of(path), str(path))
    except Unreadable as problem:
        raise unreadable(Source(str(path)), str(problem)) from None


def read_text(text: str, name: str) -> Source:
    """Return the values of YAML text. Raises StudyError where it is empty or not YAML."""
    source = Source(name, text)
    try:
        node = _compose(source)
        if node is None:
            raise unreadable(source, "the study is empty", TextPosition(1, 1))
        source.tree = _value(source, node, ())
    except RecursionError:  # an alias of what it stands in, too
        raise unreadable(source, TOO_DEEP) from None
    return source


def read_mapping(mapping: Mapping[str, Any], name: str) -> Source:
    """Return the values of a mapping. Raises StudyError for one that no study file can hold."""
    source = Source(name)
    try:
        source.tree = _plain_value(mapping)
    except RecursionError:
        raise unreadable(source, TOO_DEEP) from None
    return source


def unreadable(source: Source, what: str, place: TextPosition | None = None) -> StudyError:
    """Return the error for a source that gives no values."""
    return StudyError(source.located([Note((), what, place=place)]))


def _compose(source: Source) -> Node | None:
    """Return the YAML node of the text; unlike values, nodes have positions and keep repeated keys."""
    if odd := _CONTROL.search(source.text):
        before = _LINE_END.split(source.text[: odd.start()])
        place = TextPosition(len(before), len(before[-1]) + 1)
        raise unreadable(source, f"is not text: character '{one_line(odd.group())}'", place)
    try:
        node: Node | None = YAML(typ="rt").compose(source.text)
        return node
    except MarkedYAMLError as problem:
        mark = problem.problem_mark or problem.context_mark
        what = " ".join(str(part).strip() for part in (problem.context, problem.problem) if part)
        at = _place(mark) if mark else None
        raise unreadable(source, f"not YAML: {what}", at) from None
    except (YAMLError, ValueError, AttributeError, TypeError, LookupError, AssertionError) as problem:
        # For some broken texts the parser raises errors of its own code.
        raise unreadable(source, f"not YAML: {[*str(problem).splitlines(), 'unreadable'][0]}") from None


def _place(mark: Any) -> TextPosition:
    return TextPosition(mark.line + 1, mark.column + 1)


def _value(source: Source, node: Any, path: KeyPath) -> Any:
    """Return the node as a plain value; its position and those below it are recorded."""
    source.values.setdefault(path, _place(node.start_mark))
    kind = str(node.tag).removeprefix(_TAG)
    if isinstance(node, ScalarNode) and kind == "timestamp":
        return UnsupportedValue(f"the date {node.value}")
    if kind not in (_SCALARS if isinstance(node, ScalarNode) else ("map", "seq")):
        what = f"the YAML tag {node.tag} has no meaning here"
        source.notes.append(Note(path, what))
        return UnsupportedValue(what)
    if isinstance(node, MappingNode):
        return _mapping(source, node, path)
    if isinstance(node, SequenceNode):
        return [_value(source, item, (*path, index)) for index, item in enumerate(node.value)]
    text = _scalar_text(node)
    try:
        return _SCALARS[kind](text)
    except ValueError:
        return text


def _mapping(source: Source, node: MappingNode, path: KeyPath) -> dict[str, Any]:
    read: dict[str, Any] = {}
    for key, item in node.value:
        place = _place(key.start_mark)
        if wrong := _fault_of_key(key):
            source.notes.append(Note(path, wrong, place=place))
            continue
        name = str(key.value)
        below = (*path, name)
        if name in read:
            what = f"given twice, first in line {source.keys[below].line}"
            source.notes.append(Note(below, what, place=place))
            continue
        source.keys[below] = place
        read[name] = _value(source, item, below)
        if isinstance(item, (MappingNode, SequenceNode)) or read[name] is None:
            # A mistake in a whole mapping or list, or in an empty value, is shown at its key.
            source.values[below] = place
    return read


def _fault_of_key(key: Node) -> str:
    if not isinstance(key, ScalarNode):
        return "a key must be a name"
    return "merge keys (<<) are not used here" if key.tag == f"{_TAG}merge" else ""


def _scalar_text(node: ScalarNode) -> str:
    """Return the text; ruamel's round-trip reader marks with a BEL where a folded one wraps.

    Two halves of a character, as JSON writes them, become one; half a character the sign of what cannot be shown.
    """
    text = str(node.value).replace("\a", "") if node.style == ">" else str(node.value)
    return text.encode("utf-16", "surrogatepass").decode("utf-16", "replace")


def _integer(text: str) -> int | float:
    digits = text.replace("_", "").lower()
    base = {"0x": 16, "0o": 8, "0b": 2}.get(digits.lstrip("+-")[:2], 10)
    return plain_number(int(digits, base)) if len(digits) < 400 else float(digits)


def _real(text: str) -> float:
    return float(text.replace("_", "").lower().replace(".inf", "inf").replace(".nan", "nan"))


def plain_number(value: int | float) -> int | float:
    """Return the number; infinity for an integer that no float can hold."""
    try:
        float(value)
    except OverflowError:
        return float("inf") if value > 0 else float("-inf")
    return value


def _plain_value(value: Any) -> Any:
    """Return the value in the types that YAML text gives."""
    if isinstance(value, Mapping):
        return {str(key): _plain_value(item) for key, item in value.items()}
    if hasattr(value, "tolist"):  # of numpy and pandas
        return _plain_value(value.tolist())
    if isinstance(value, (list, tuple, range)):
        return [_plain_value(item) for item in value]
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        return plain_number(value)
    known = value is None or isinstance(value, (str, bool))
    return value if known else UnsupportedValue(f"a {type(value).__name__}")


_SCALARS: dict[str, Any] = {
    "str": str,
    "int": _integer,
    "float": _real,
    "bool": lambda text: text.lower() in ("true", "yes", "on", "y"),
    "null": lambda _text: None,
}
