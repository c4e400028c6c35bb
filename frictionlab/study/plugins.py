"""The files of laws a study brings along: its ``plugins`` and those of ``--law``."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path as FilePath
from types import MappingProxyType
from typing import Any, NamedTuple

from frictionlab import registry
from frictionlab.laws.base import FrictionLaw
from frictionlab.study.law_file import LawFile, Unreadable, code_of, read_law_file
from frictionlab.study.mistakes import Mistake, Path, StudyError, described, did_you_mean
from frictionlab.study.notes import Notes
from frictionlab.study.source import Source

KEY = "plugins"


class Brought(NamedTuple):
    """The files of laws that come with a study, and every law it may name. codes: SHA-256 of those known before."""

    files: tuple[LawFile, ...]
    laws: registry.Laws
    codes: Mapping[str, str] = MappingProxyType({})

    def code(self, kinds: Iterable[str]) -> dict[str, str]:
        """SHA-256 of the code of every law of these that is no part of frictionlab."""
        return {kind: code for kind in kinds if (code := self._code(kind))}

    def _code(self, kind: str) -> str:
        own = (file.code for file in self.files if kind in file.laws)
        return self.codes.get(kind) or next(own, "") or code_of(self.laws.named(kind))


Bring = Callable[[dict[str, Any], FilePath, Notes], Brought]


def add_law_files(source: Source, files: Iterable[FilePath]) -> None:
    """Put the files of ``--law`` behind the study's own; their paths are relative to where the command runs."""
    for file in files:
        listed = source.tree.setdefault(KEY, [])
        if isinstance(listed, list):
            source.origins[(KEY, len(listed))] = f"--law {file}"
            listed.append(str(file.absolute()))


def bring(tree: dict[str, Any], folder: FilePath, notes: Notes) -> Brought:
    """The laws of the files a study lists, each file once. Raises BrokenPlugin for a file without usable laws."""
    read = [_read(name, path, folder, notes) for name, path in listed_files(tree, notes)]
    files = tuple(dict.fromkeys(file for file in read if file is not None))
    return Brought(files, laws_of(files))


def listed_files(tree: dict[str, Any], notes: Notes) -> list[tuple[str, Path]]:
    """The files a study lists, each with its path in the study."""
    given = tree.get(KEY, [])
    if not isinstance(given, list):
        notes.add((KEY,), f"must be a list of Python files such as [my_law.py], got {described(given)}")
        return []
    named = [(notes.text(item, (KEY, index)), (KEY, index)) for index, item in enumerate(given)]
    return [(name, path) for name, path in named if name]


def _read(name: str, path: Path, folder: FilePath, notes: Notes) -> LawFile | None:
    try:
        return read_law_file(folder / name)
    except Unreadable as problem:
        there = [str(file.relative_to(folder)) for file in sorted((folder / name).parent.glob("*.py"))]
        notes.add(path, f"{folder / name}: {problem}", did_you_mean(name, there))
        return None


def laws_of(files: Sequence[LawFile]) -> registry.Laws:
    """The laws that files bring, beside those installed. Raises BrokenPlugin where two have one name."""
    own: dict[str, type[FrictionLaw]] = {}
    homes = {name: file.home(name) for file in files for name in file.laws}
    for file in files:
        for name, law in file.laws.items():
            if name in registry.law_names():
                raise file.home(name).broken("an installed law has that name; rename the class")
            if name in own:
                other = next(each.path for each in files if name in each.laws)
                raise file.home(name).broken(f"{other} has one of that name; rename one of the classes")
            own[name] = law
    return registry.Laws(own, homes)


def laws_of_files(paths: Iterable[FilePath]) -> registry.Laws:
    """The laws installed and those of these files. Raises StudyError for what is no file of text, BrokenPlugin."""
    files = []
    for path in paths:
        try:
            files.append(read_law_file(path))
        except Unreadable as problem:
            raise StudyError([Mistake(f"--law {path}", None, "", str(problem))]) from None
    return laws_of(list(dict.fromkeys(files)))
