"""Reading of YAML text to plain values, with the position of every key and value."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path as FilePath
from typing import Any

from ruamel.yaml import YAML
from ruamel.yaml.error import MarkedYAMLError, YAMLError
from ruamel.yaml.nodes import MappingNode, Node, ScalarNode, SequenceNode

from frictionlab.mistakes.notes import Mistake, Note, Path, StudyError, TextPosition, dotted
from frictionlab.printable import lone_surrogate, one_line, with_joined_pairs

LARGEST_YAML_FILE = 5_000_000
"""Bytes; and letters of the values, where aliases repeat them."""
MOST_NODES = 50_000
DEEPEST = 20
"""Mappings and lists inside each other."""
TOO_DEEP = "not a study: nested too deeply"
SAVED = 10
"""A study that a run saved may be so many times larger: it has its defaults, and no aliases."""

_TAG = "tag:yaml.org,2002:"
_CONTROL = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x84\x86-\x9f\ud800-\udfff\ufffe\uffff]")
_LINE_END = re.compile("\r\n|[\r\n]")  # as the YAML reader counts lines


@dataclass(frozen=True)
class UnsupportedValue:
    """The description of a value that no key of a study accepts, such as a date."""

    words: str

    def __str__(self) -> str:
        """The words."""
        return self.words


@dataclass
class Source:
    """The values of a study with their positions; notes: the mistakes of the YAML itself.

    keys, values: path -> position. origins: path -> the ``--set`` that set the value. refused: substitute path of a
    ``--set`` that could not be carried out -> the path it refers to. room: how many times as large as a file that a
    person writes it may be.
    """

    name: str
    text: str = ""
    tree: Any = None
    keys: dict[Path, TextPosition] = field(default_factory=dict)
    values: dict[Path, TextPosition] = field(default_factory=dict)
    origins: dict[Path, str] = field(default_factory=dict)
    refused: dict[Path, Path] = field(default_factory=dict)
    notes: list[Note] = field(default_factory=list)
    room: int = 1

    @cached_property
    def lines(self) -> list[str]:
        """The lines of the text."""
        return _LINE_END.split(self.text)

    def located(self, notes: Iterable[Note]) -> list[Mistake]:
        """The notes as mistakes, in the order of the file, those of the command line last."""
        found = dict.fromkeys(self._located(note) for note in notes)
        return sorted(found, key=lambda mistake: mistake.place or (float("inf"), 0))

    def _located(self, note: Note) -> Mistake:
        origin, place = (self.name, note.place) if note.place else self._where(note)
        line = self.lines[place.line - 1] if place and place.line <= len(self.lines) else ""
        path = dotted(self.refused.get(note.path, note.path))
        return Mistake(origin, place, path, note.what, note.hint, line)

    def _where(self, note: Note) -> tuple[str, TextPosition | None]:
        """The position of the path, or of the innermost part around it that the study has."""
        for length in range(len(note.path), -1, -1):
            path = note.path[:length]
            if path in self.origins:
                return self.origins[path], None
            first, second = (self.keys, self.values) if note.on_key else (self.values, self.keys)
            if place := first.get(path) or second.get(path):
                return self.name, place
        return self.name, None


def read_file(path: FilePath, room: int = 1) -> Source:
    """The values of a YAML file. Raises StudyError for a file that is not readable YAML text."""
    return read_text(_text_of(path, room), str(path), room)


def read_text(text: str, name: str, room: int = 1) -> Source:
    """The values of YAML text. Raises StudyError where it is empty or not YAML."""
    source = Source(name, text, room=room)
    node = _compose(source)
    if node is None:
        raise _unreadable(source, "the study is empty", TextPosition(1, 1))
    source.tree = _NodeReader(source).value(node, ())
    return source


def _text_of(path: FilePath, room: int) -> str:
    nothing = Source(str(path))
    try:
        if path.is_dir():
            raise _unreadable(nothing, "is a folder; a study is a file")
        if path.exists() and not path.is_file():
            raise _unreadable(nothing, "is not an ordinary file")
        if path.exists() and path.stat().st_size > LARGEST_YAML_FILE * room:
            raise _unreadable(
                nothing, f"is larger than {LARGEST_YAML_FILE // 10**6} MB; a study is a short text"
            )
        return path.read_bytes().decode("utf-8-sig")
    except FileNotFoundError:
        raise _unreadable(nothing, "no such file") from None
    except UnicodeDecodeError as problem:
        raise _unreadable(
            nothing, f"is not UTF-8 text (byte {problem.start + 1}); save it as UTF-8"
        ) from None
    except (OSError, ValueError) as problem:
        reason = problem.strerror if isinstance(problem, OSError) else str(problem)
        raise _unreadable(nothing, f"cannot be read: {reason}") from None


def _unreadable(source: Source, what: str, place: TextPosition | None = None) -> StudyError:
    return StudyError(source.located([Note((), what, place=place)]))


def _compose(source: Source) -> Node | None:
    """The YAML node of the text; unlike values, nodes have positions and keep repeated keys."""
    if odd := _CONTROL.search(source.text):
        before = _LINE_END.split(source.text[: odd.start()])
        place = TextPosition(len(before), len(before[-1]) + 1)
        raise _unreadable(source, f"is not text: character '{one_line(odd.group())}'", place)
    if source.text.count(",") + source.text.count("\n") > MOST_NODES * source.room:
        raise _too_many(source)
    try:
        node: Node | None = YAML(typ="rt").compose(source.text)
        return node
    except MarkedYAMLError as problem:
        mark = problem.problem_mark or problem.context_mark
        what = " ".join(str(part).strip() for part in (problem.context, problem.problem) if part)
        at = TextPosition(mark.line + 1, mark.column + 1) if mark else None
        raise _unreadable(source, f"not YAML: {what}", at) from None
    except RecursionError:
        raise _unreadable(source, TOO_DEEP) from None
    except (YAMLError, ValueError, AttributeError, TypeError, LookupError, AssertionError) as problem:
        # For some broken texts the parser raises errors of its own code.
        raise _unreadable(source, f"not YAML: {[*str(problem).splitlines(), 'unreadable'][0]}") from None


def _too_many(source: Source, place: TextPosition | None = None) -> StudyError:
    what = f"has more than {MOST_NODES * source.room} values; write those of a sweep as {{start, stop, num}}"
    return _unreadable(source, what, place)


class _NodeReader:
    """One pass over the nodes of a source."""

    def __init__(self, source: Source) -> None:
        self._source = source
        self._open: set[int] = set()
        self._count = 0
        self._letters = 0

    def value(self, node: Node, path: Path) -> Any:
        """The node as a plain value; its position and those below it are recorded."""
        place = TextPosition(node.start_mark.line + 1, node.start_mark.column + 1)
        self._source.values.setdefault(path, place)
        self._count += 1
        if self._count > MOST_NODES * self._source.room:
            raise _too_many(self._source, place)
        if isinstance(node, ScalarNode):
            return self._scalar(node, path)
        if id(node) in self._open:
            return self._odd(path, "contains itself")
        if len(path) > DEEPEST:
            raise _unreadable(self._source, TOO_DEEP, place)
        if not str(node.tag).startswith((_TAG + "map", _TAG + "seq")):
            return self._odd(path, f"the YAML tag {node.tag} has no meaning here")
        self._open.add(id(node))
        read = self._mapping(node, path) if isinstance(node, MappingNode) else self._list(node, path)
        self._open.discard(id(node))
        return read

    def _list(self, node: Node, path: Path) -> list[Any]:
        return [self.value(item, (*path, index)) for index, item in enumerate(node.value)]

    def _mapping(self, node: MappingNode, path: Path) -> dict[str, Any]:
        read: dict[str, Any] = {}
        for key, item in node.value:
            place = TextPosition(key.start_mark.line + 1, key.start_mark.column + 1)
            if (name := self._key(key, path, place)) is None:
                continue
            below = (*path, name)
            if name in read:
                what = f"given twice, first in line {self._source.keys[below].line}"
                self._source.notes.append(Note(below, what, place=place))
                continue
            self._source.keys[below] = place
            read[name] = self.value(item, below)
            if isinstance(item, (MappingNode, SequenceNode)) or read[name] is None:
                # A mistake in a whole mapping or list, or in an empty value, is shown at its key.
                self._source.values[below] = place
        return read

    def _key(self, key: Node, path: Path, place: TextPosition) -> str | None:
        if not isinstance(key, ScalarNode):
            self._source.notes.append(Note(path, "a key must be a name", place=place))
        elif key.tag == _TAG + "merge":
            self._source.notes.append(Note(path, "merge keys (<<) are not used here", place=place))
        elif half := lone_surrogate(name := with_joined_pairs(str(key.value))):
            self._source.notes.append(Note(path, f"a key holds {half}, half a character", place=place))
        else:
            return name
        return None

    def _scalar(self, node: ScalarNode, path: Path) -> Any:
        kind = str(node.tag).removeprefix(_TAG)
        if kind == "timestamp":
            return UnsupportedValue(f"the date {node.value}")
        if kind not in _SCALARS:
            return self._odd(path, f"the YAML tag {node.tag} has no meaning here")
        text = with_joined_pairs(_scalar_text(node))
        self._letters += len(text)
        if self._letters > LARGEST_YAML_FILE * self._source.room:
            raise _unreadable(
                self._source, f"holds more than {LARGEST_YAML_FILE * self._source.room} letters"
            )
        if half := lone_surrogate(text):
            return self._odd(path, f"holds {half}, half a character")
        try:
            return _SCALARS[kind](text)
        except ValueError:
            return text

    def _odd(self, path: Path, what: str) -> UnsupportedValue:
        self._source.notes.append(Note(path, what))
        return UnsupportedValue(what)


def _scalar_text(node: ScalarNode) -> str:
    """The text; ruamel's round-trip reader marks with a BEL where a folded one wraps."""
    return str(node.value).replace("\a", "") if node.style == ">" else str(node.value)


def _integer(text: str) -> int | float:
    digits = text.replace("_", "").lower()
    base = {"0x": 16, "0o": 8, "0b": 2}.get(digits.lstrip("+-")[:2], 10)
    return plain_number(int(digits, base)) if len(digits) < 400 else float(digits)


def _real(text: str) -> float:
    return float(text.replace("_", "").lower().replace(".inf", "inf").replace(".nan", "nan"))


def plain_number(value: int | float) -> int | float:
    """The number; infinity for an integer that no float can hold."""
    try:
        float(value)
    except OverflowError:
        return float("inf") if value > 0 else float("-inf")
    return value


_SCALARS: dict[str, Any] = {
    "str": str,
    "int": _integer,
    "float": _real,
    "bool": lambda text: text.lower() in ("true", "yes", "on", "y"),
    "null": lambda _text: None,
}
