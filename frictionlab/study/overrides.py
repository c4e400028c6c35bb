"""``--set path=value``: a value of the study replaced from the command line."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Any

from frictionlab.study.written import column_of
from frictionlab.study.yaml_source import Source, read_text
from frictionlab.values.notes import KeyPath, Note, StudyError, did_you_mean, dotted

_RANGE = ("start", "stop", "num", "spacing", "within")


def apply_overrides(source: Source, overrides: Iterable[str]) -> None:
    """Apply every override to the values of a source; overrides that cannot be applied are noted."""
    for text in overrides:
        _Override(source, text).apply()


class _Override:
    """One ``path=value``."""

    def __init__(self, source: Source, text: str) -> None:
        self._source = source
        self._origin = f"--set {text}"
        self._target, self._equals, self._written = text.partition("=")

    def apply(self) -> None:
        target = self._target.strip()
        if not self._equals or not target:
            return self._refuse((), "write path=value, for example scene.belt_speed=5")
        try:
            value = read_text(self._written, self._origin).tree if self._written.strip() else None
        except StudyError as problem:
            return self._refuse((), f"the value is {problem.mistakes[0].what}")
        path = self._path(target)
        if path is not None and any(set_[: len(path)] == path for set_ in self._source.origins):
            return self._refuse(path, "set twice")
        return None if path is None else self._put(path, value)

    def _refuse(self, path: KeyPath, what: str, hint: str = "") -> None:
        self._source.notes.append(Note(path, what, hint, origin=self._origin))

    def _path(self, target: str) -> KeyPath | None:
        head, _, rest = target.partition(".")
        if head == "sweep" and rest:
            return self._sweep(rest)
        if head in ("laws", "methods") and rest:
            return self._labelled(head, rest)
        steps: list[str | int] = []
        for part in target.split("."):
            if not (found := re.fullmatch(r"([^\[\]]+)((?:\[\d{1,6}\])*)", part)):
                self._refuse((), f"'{target}' is no path such as scene.belt_speed or laws[0].mu")
                return None
            steps += [found[1], *map(int, re.findall(r"\d+", found[2]))]
        return tuple(steps)

    def _sweep(self, rest: str) -> KeyPath:
        """A swept path is a single key that contains points; the parts of a range are keys below it."""
        key, _, part = rest.rpartition(".")
        swept = {column_of(each): each for each in map(str, self._under("sweep"))}
        given = swept.get(column_of(key))
        return ("sweep", given, part) if part in _RANGE and given is not None else ("sweep", rest)

    def _under(self, key: str) -> Any:
        found = self._source.tree.get(key)
        return found if isinstance(found, (dict, list)) else ()

    def _labelled(self, head: str, rest: str) -> KeyPath | None:
        label, _, key = rest.rpartition(".")
        labels = [_label(item) for item in self._under(head)]
        if key and label in labels:
            return (head, labels.index(label), key)
        given = label or rest
        self._refuse((), f"no {head[:-1]} is labelled '{given}'; there are {', '.join(labels) or 'none'}",
                     did_you_mean(given, labels))  # fmt: skip
        return None

    def _put(self, path: KeyPath, value: Any) -> None:
        at = self._source.tree
        for length, step in enumerate(path[:-1]):
            at = self._stepped(at, path[: length + 1], step)
            if at is None:
                return
        if isinstance(path[-1], int) and not (isinstance(at, list) and path[-1] < len(at)):
            return self._refuse(path, f"there is no item [{path[-1]}]")
        if isinstance(path[-1], str) and not isinstance(at, dict):
            return self._refuse(path, "there is no mapping to set it in")
        if isinstance(at, dict):
            self._leave_out_others(at, path)
        at[path[-1]] = value
        self._forget(path)
        self._source.origins[path] = self._origin

    def _leave_out_others(self, at: dict[str, Any], path: KeyPath) -> None:
        """Remove other keys of the same value: ``belt_speed`` beside ``belt_speed_m_per_s``."""
        above = path[:-1] if path[0] == "scene" else ()
        column = column_of(dotted((*above, path[-1])))
        for other in [key for key in at if key != path[-1] and column_of(dotted((*above, key))) == column]:
            del at[other]
            self._forget((*path[:-1], other))

    def _stepped(self, at: Any, path: KeyPath, step: str | int) -> Any:
        """Return the value one step down; a mapping that the study lacks is added."""
        if isinstance(at, dict) and isinstance(step, str):
            if step not in at:
                at[step] = {}
                self._source.origins[path] = self._origin
            return at[step]
        if isinstance(at, list) and isinstance(step, int) and step < len(at):
            return at[step]
        what = f"there is no item [{step}]" if isinstance(step, int) else f"there is no '{step}' to set it in"
        return self._refuse(path, what)

    def _forget(self, path: KeyPath) -> None:
        """Remove the positions and the mistakes of the value that was replaced."""
        source = self._source
        for places in (source.keys, source.values):
            for known in [known for known in places if known[: len(path)] == path]:
                del places[known]
        source.notes[:] = [note for note in source.notes if note.origin or note.path[: len(path)] != path]


def _label(item: Any) -> str:
    """Return the label of a law or method as written in the file."""
    if isinstance(item, dict):
        return str(item.get("label", item.get("kind", "")))
    return str(item)
