"""Sources of a run: that of the study, then the publications behind the laws and methods that gave numbers."""

from __future__ import annotations

import ast
import inspect
import re
from collections.abc import Iterable, Sequence
from functools import cache
from importlib.metadata import entry_points, metadata
from importlib.util import find_spec
from pathlib import Path
from typing import NamedTuple

import pandas as pd

from frictionlab.runner.results import Results
from frictionlab.study import registry
from frictionlab.study.bibliography import Publication, publications, unpublished_source
from frictionlab.study.parts import LawChoice

RELEASED = {"0.2.0": "2026"}
"""Years of the versions that were released."""


def bibtex(runs: Sequence[Results]) -> str:
    """Return one entry for each publication, under a comment that says what used it; keys differ."""
    users: dict[Publication, list[str]] = {}
    for run in runs:
        users.setdefault(itself(str(run.account.get("frictionlab", ""))), ["the program"])
        for each in sources(run):
            for reference in each.references:
                users.setdefault(reference, []).append(each.what)
    whom = [", ".join(dict.fromkeys(each)) for each in users.values()]
    entries = zip(whom, with_keys_of_their_own(users), strict=True)
    return "\n\n".join(f"% {who}\n{entry}" for who, entry in entries)


def itself(version: str) -> Publication:
    """Return the entry of frictionlab. version: that which made the numbers."""
    summary = metadata("frictionlab")["Summary"]
    fields = {
        "author": "{The frictionlab authors}",
        "title": f"frictionlab: {summary[:1].lower()}{summary[1:].removesuffix('.')}",
        "note": f"Python package, version {version}",
    } | ({"year": RELEASED[version]} if version in RELEASED else {})
    lines = "".join(f"  {name} = {{{value}}},\n" for name, value in fields.items())
    return Publication("misc", "frictionlab", fields, f"@misc{{frictionlab,\n{lines}}}")


def with_keys_of_their_own(references: Iterable[Publication]) -> list[str]:
    """Return the entries as written, but for a key that another entry has already: it gets a number."""
    entries, taken = [], set[str]()
    for each in references:
        key, number = each.key, 1
        while key in taken:
            number += 1
            key = f"{each.key}-{number}"
        taken.add(key)
        kind, brace, rest = each.bibtex.partition("{")
        entries.append(kind + brace + rest.replace(each.key, key, 1))
    return entries


def law_text(law: LawChoice) -> str:
    """Return the docstring of a law."""
    return inspect.getdoc(law.law_class) or ""


def method_text(name: str) -> str:
    """Return the docstring of a method; nothing for one that is not installed here."""
    written = _written(name)
    return (ast.get_docstring(written) or "") if written else ""


def method_bibtex(name: str) -> str:
    """Return the ``bibtex`` of a method; nothing for one that is not installed here."""
    for node in written.body if (written := _written(name)) else ():
        targets = node.targets if isinstance(node, ast.Assign) else [getattr(node, "target", None)]
        if any(isinstance(target, ast.Name) and target.id == "bibtex" for target in targets):
            value = getattr(node, "value", None)
            return str(value.value) if isinstance(value, ast.Constant) else registry.method_class(name).bibtex
    return ""


@cache
def _written(name: str) -> ast.ClassDef | None:
    """Return the class of a method as its file has it: reading it is quicker than importing what it needs."""
    for door in entry_points(group=registry.METHODS, name=name):
        try:
            spec = find_spec(door.module)
            source = Path(str(spec.origin if spec else "")).read_text(encoding="utf-8")
            classes = [node for node in ast.walk(ast.parse(source)) if isinstance(node, ast.ClassDef)]
        except (ImportError, OSError, ValueError, SyntaxError):
            return None
        return next((node for node in classes if node.name == door.attr), None)
    return None


_YEAR = re.compile(r"\b1[6-9]\d\d\b|\b20\d\d\b")
_SAID = re.compile(r"\bSources?:.*", re.DOTALL)
_CHOICE = re.compile(r"\(auto: ([\w-]+)")


class Cited(NamedTuple):
    """Something used, the words in which it names its sources, and the publications those are."""

    what: str
    words: str
    references: list[Publication]


def sources(saved: Results) -> list[Cited]:
    """Return the study's source, then those of its laws, then those of its methods, each where it gave a number."""
    study, table = saved.study, saved.shown
    found = table[table["mean_friction"].notna() | (table["status"] == "not_unique")]
    laws = {law.kind: law for law in study.laws if law.kind in found["kind"].unique()}
    methods = {choice.name: "" for choice in study.methods if choice.label in found["method"].unique()}
    hows = (chosen_by_auto(found) if "auto" in methods else {}) | methods
    cited = [
        _cited("the study", study.source, ""),
        *(_cited(f"law {kind}", _named(law_text(law)), law.law_class.bibtex) for kind, law in laws.items()),
        *(
            _cited(f"method {name}{hows[name]}", _named(method_text(name)), method_bibtex(name))
            for name in (methods | hows)
        ),
    ]
    return [each for each in cited if each.words or each.references]


def published(cited: Iterable[Cited]) -> list[Publication]:
    """Return the publications among them, each once."""
    return list(dict.fromkeys(each for one in cited for each in one.references if "author" in each.fields))


def chosen_by_auto(found: pd.DataFrame) -> dict[str, str]:
    """Return the methods that ``auto`` chose, as ``model`` names them; else those that it says it chooses from."""
    installed = registry.method_names()
    said = " ".join(found["model"].dropna().unique())
    if chosen := [name for name in _CHOICE.findall(said) if name in installed]:
        return dict.fromkeys(chosen, ", which auto chose")
    ladder = re.findall(r"[\w-]+", method_text("auto").partition("\n")[0])
    return {name: ", which auto may choose" for name in ladder if name in installed and name != "auto"}


def _cited(what: str, words: str, bibtex: str) -> Cited:
    """Cite something; in its own words where nobody has an entry for it."""
    found = publications(words, bibtex)
    return Cited(what, words, found or ([unpublished_source(what, words)] if words else []))


def _named(text: str) -> str:
    """Find where a docstring names its sources: from "Source:" on, else the paragraphs that hold a year."""
    paragraphs = text.split("\n\n")
    said = [found[0] for each in paragraphs if (found := _SAID.search(each))]
    dated = [each for each in paragraphs if _YEAR.search(each)]
    return " ".join(" ".join(each.split()) for each in said or dated)
