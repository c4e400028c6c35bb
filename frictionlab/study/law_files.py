"""Law files of a study: those under ``plugins`` and those of ``--law``."""

from __future__ import annotations

import ast
import inspect
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from pathlib import Path as FilePath
from types import MappingProxyType
from typing import Annotated, Any, Literal, NamedTuple

from pydantic import create_model

from frictionlab.laws.base import FrictionLaw
from frictionlab.study import registry
from frictionlab.study.registry import LawFile, code_of, law_name, read_law_file
from frictionlab.study.yaml_source import Source
from frictionlab.values.notes import (
    KeyPath,
    Mistake,
    Notes,
    StudyError,
    Unreadable,
    did_you_mean,
    text_of,
    value_text,
)
from frictionlab.values.units import dimension_of

KEY = "plugins"


class StudyLaws(NamedTuple):
    """Law files of a study and every law it may name. codes: SHA-256 of laws whose code is not at hand."""

    files: tuple[LawFile, ...]
    laws: registry.Laws
    codes: Mapping[str, str] = MappingProxyType({})

    def code(self, kinds: Iterable[str]) -> dict[str, str]:
        """SHA-256 of the code of those of these laws that are not frictionlab's own."""
        return {kind: code for kind in kinds if (code := self._code(kind))}

    def _code(self, kind: str) -> str:
        own = (file.code for file in self.files if kind in file.laws)
        return self.codes.get(kind) or next(own, "") or code_of(self.laws.named(kind))


Plugins = Literal["run", "refuse"]
"""Treatment of the law files that a study lists: loading them runs their code."""
LawReader = Callable[[dict[str, Any], FilePath, Notes], StudyLaws]


def add_law_files(source: Source, files: Iterable[FilePath]) -> None:
    """Append the files of ``--law`` to those of the study; their paths are relative to the current directory."""
    for file in files:
        listed = source.tree.setdefault(KEY, [])
        if isinstance(listed, list):
            source.origins[(KEY, len(listed))] = f"--law {file}"
            listed.append(str(file.absolute()))


def refuse_law_files(source: Source) -> None:
    """Raises StudyError where the study itself lists law files."""
    if KEY in source.tree:
        notes = Notes(source.notes)
        notes.on_key(
            (KEY,), "names Python code, which --no-plugins does not run; read it, then leave out --no-plugins"
        )
        raise StudyError(source.located(notes.all))


def read_laws(tree: dict[str, Any], folder: FilePath, notes: Notes) -> StudyLaws:
    """Laws of the files a study lists, each file once. Raises BrokenPlugin for a file without usable laws."""
    read = [_read(name, path, folder, notes) for name, path in listed_files(tree, notes)]
    files = tuple(dict.fromkeys(file for file in read if file is not None))
    return StudyLaws(files, laws_of(files))


def listed_files(tree: dict[str, Any], notes: Notes) -> list[tuple[str, KeyPath]]:
    """Return the files a study lists, each with its path in the study."""
    given = tree.get(KEY, [])
    if not isinstance(given, list):
        notes.add((KEY,), f"must be a list of Python files such as [my_law.py], got {value_text(given)}")
        return []
    named = [(notes.text(item, (KEY, index)), (KEY, index)) for index, item in enumerate(given)]
    return [(name, path) for name, path in named if name]


def _read(name: str, path: KeyPath, folder: FilePath, notes: Notes) -> LawFile | None:
    try:
        return read_law_file(folder / name)
    except Unreadable as problem:
        missing = not (folder / name).exists()
        there = [str(file.relative_to(folder)) for file in sorted((folder / name).parent.glob("*.py"))]
        notes.add(path, f"{folder / name}: {problem}", did_you_mean(name, there) if missing else "")
        return None


def laws_of(files: Sequence[LawFile]) -> registry.Laws:
    """Return the installed laws and those of these files. Raises BrokenPlugin where two have the same name.

    A file may be the very text of an installed law.
    """
    own: dict[str, type[FrictionLaw]] = {}
    homes = {name: file.home(name) for file in files for name in file.laws}
    for file in files:
        for name, law in file.laws.items():
            if name in registry.law_names() and not _is_installed(name, file):
                raise file.home(name).broken("an installed law has the same name; rename the class")
            if name in own:
                other = next(each.path for each in files if name in each.laws)
                raise file.home(name).broken(f"{other} has a law of the same name; rename one of the classes")
            own[name] = law
    return registry.Laws(own, homes)


def _is_installed(name: str, file: LawFile) -> bool:
    """Check whether the installed law of this name comes from the same text."""
    source = inspect.getsourcefile(registry.law_class(name))
    return source is not None and FilePath(source).read_text(encoding="utf-8") == file.text


def laws_of_files(paths: Iterable[FilePath]) -> registry.Laws:
    """Return the installed laws and those of these files. Raises StudyError for an unreadable file, BrokenPlugin."""
    files = []
    for path in paths:
        try:
            files.append(read_law_file(path))
        except Unreadable as problem:
            raise StudyError([Mistake(f"--law {path}", None, "", str(problem))]) from None
    return laws_of(list(dict.fromkeys(files)))


class SavedLaw(FrictionLaw):
    """Name and parameters of a law of a saved run: enough for a report, not for computing."""

    def sliding_friction(self, speed: float) -> float:
        raise NotImplementedError(f"the law of a saved run has no friction to compute (at {speed})")


def saved_law_reader(codes: Mapping[str, str]) -> LawReader:
    """A reader of the laws of a saved study. codes: SHA-256 of plugin laws by kind, from its provenance."""

    def bring(tree: dict[str, Any], folder: FilePath, notes: Notes) -> StudyLaws:
        files = tuple(_saved_file(folder / name) for name, _ in listed_files(tree, notes))
        laws = tree.get("laws")
        given = [law for law in laws if isinstance(law, dict)] if isinstance(laws, list) else []
        kinds = {str(law.get("kind")): law for law in given if law.get("kind") in codes}
        own = {kind: _stand_in(kind, given, files) for kind in kinds}
        return StudyLaws(files, registry.Laws(own), codes)

    return bring


def _saved_file(path: FilePath) -> LawFile:
    try:
        return LawFile(path, text_of(path), {})
    except Unreadable:  # a report needs no law
        return LawFile(path, "", {})


def _stand_in(kind: str, given: list[dict[str, Any]], files: tuple[LawFile, ...]) -> type[FrictionLaw]:
    """A law class with every parameter that a law of this kind has in the study."""
    values = {key: value for law in given if law["kind"] == kind for key, value in law.items()}
    fields: dict[str, Any] = {
        key: (_kind_of(value), None)
        for key, value in values.items()
        if str(key).isidentifier() and key not in ("kind", "label")
    }
    docstring, bibtex = _told_of_law(kind, files)
    made = create_model(kind, __base__=SavedLaw, __doc__=docstring, **fields)
    made.bibtex = bibtex
    return made


def _kind_of(value: Any) -> Any:
    """Return the type of a parameter that has this value, with the dimension of its unit."""
    unit = dimension_of(value[0] if isinstance(value, list) and value else value)
    number = isinstance(value, int | float) or (isinstance(value, str) and unit is not None)
    kind = float | None if number else Any
    return kind if unit is None else Annotated[kind, unit]


def _told_of_law(kind: str, files: tuple[LawFile, ...]) -> tuple[str, str]:
    """Docstring and BibTeX of a law, from the copy of its file, else from an installed law of the same name."""
    own = [node for file in files for node in _classes(file) if law_name(node.name) == kind]
    if own:
        return ast.get_docstring(own[0]) or "", _bibtex(own[0])
    with suppress(KeyError, registry.BrokenPlugin):
        law = registry.law_class(kind)
        return inspect.getdoc(law) or "", law.bibtex
    return "", ""


def _bibtex(law: ast.ClassDef) -> str:
    """Return the value of ``bibtex`` in a class, if it is plain text."""
    for node in law.body:
        if isinstance(node, ast.Assign | ast.AnnAssign) and isinstance(node.value, ast.Constant):
            targets = node.targets if isinstance(node, ast.Assign) else [node.target]
            if [each.id for each in targets if isinstance(each, ast.Name)] == ["bibtex"]:
                return str(node.value.value)
    return ""


def _classes(file: LawFile) -> Iterator[ast.ClassDef]:
    with suppress(SyntaxError, ValueError):
        yield from (node for node in ast.parse(file.text).body if isinstance(node, ast.ClassDef))
