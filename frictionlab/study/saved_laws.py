"""The laws of a study that a run kept, as the study tells of them: nothing that came from outside is executed."""

from __future__ import annotations

import ast
import inspect
from collections.abc import Iterator, Mapping
from contextlib import suppress
from pathlib import Path as FilePath
from typing import Any, NamedTuple

from pydantic import create_model

from frictionlab import registry
from frictionlab.laws.base import FrictionLaw
from frictionlab.study.law_file import LawFile, Unreadable, law_name, text_of
from frictionlab.study.notes import Notes
from frictionlab.study.plugins import Bring, Brought, listed_files


class Told(NamedTuple):
    """What a law says of itself."""

    docstring: str
    bibtex: str


class SavedLaw(FrictionLaw):
    """A law by its name and parameters alone: enough to tell of a run, not to repeat it."""

    def sliding_friction(self, speed: float) -> float:
        raise NotImplementedError(f"the law of a saved run cannot be asked for friction (at {speed})")


def as_saved(codes: Mapping[str, str]) -> Bring:
    """A reader of a saved study. codes: SHA-256 of its laws from outside, by kind, as its account has them."""

    def bring(tree: dict[str, Any], folder: FilePath, notes: Notes) -> Brought:
        files = tuple(_kept(folder / name) for name, _ in listed_files(tree, notes))
        laws = tree.get("laws")
        given = [law for law in laws if isinstance(law, dict)] if isinstance(laws, list) else []
        kinds = {str(law.get("kind")): law for law in given if law.get("kind") in codes}
        own = {kind: _stand_in(kind, given, _told(kind, files)) for kind in kinds}
        return Brought(files, registry.Laws(own), codes)

    return bring


def _kept(path: FilePath) -> LawFile:
    try:
        return LawFile(path, text_of(path), {})
    except Unreadable:  # a report of the run needs no law
        return LawFile(path, "", {})


def _stand_in(kind: str, given: list[dict[str, Any]], told: Told) -> type[FrictionLaw]:
    """A record of all the parameters that any law of this kind has in the study."""
    values = {key: value for law in given if law["kind"] == kind for key, value in law.items()}
    fields: dict[str, Any] = {
        key: ((float | None) if isinstance(value, int | float) else Any, None)
        for key, value in values.items()
        if key not in ("kind", "label")
    }
    made = create_model(kind, __base__=SavedLaw, __doc__=told.docstring, **fields)
    made.bibtex = told.bibtex
    return made


def _told(kind: str, files: tuple[LawFile, ...]) -> Told:
    """What the law says of itself in the copy of its file; else what one of its name says that is installed."""
    own = [node for file in files for node in _classes(file) if law_name(node.name) == kind]
    if own:
        return Told(ast.get_docstring(own[0]) or "", _bibtex(own[0]))
    with suppress(KeyError, registry.BrokenPlugin):
        law = registry.law_class(kind)
        return Told(inspect.getdoc(law) or "", law.bibtex)
    return Told("", "")


def _bibtex(law: ast.ClassDef) -> str:
    """What the class assigns to ``bibtex``, where that is plain text."""
    for node in law.body:
        if isinstance(node, ast.Assign | ast.AnnAssign) and isinstance(node.value, ast.Constant):
            targets = node.targets if isinstance(node, ast.Assign) else [node.target]
            if [each.id for each in targets if isinstance(each, ast.Name)] == ["bibtex"]:
                return str(node.value.value)
    return ""


def _classes(file: LawFile) -> Iterator[ast.ClassDef]:
    with suppress(SyntaxError, ValueError):
        yield from (node for node in ast.parse(file.text).body if isinstance(node, ast.ClassDef))
