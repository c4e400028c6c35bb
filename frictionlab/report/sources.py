"""Whom a run draws on: the study's source, then the publications behind the laws and methods that gave numbers."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import NamedTuple

import pandas as pd

from frictionlab import registry
from frictionlab.bibliography import Reference, publications, remark
from frictionlab.report.documents import law_text, method_bibtex, method_text
from frictionlab.saved import Saved

_YEAR = re.compile(r"\b1[6-9]\d\d\b|\b20\d\d\b")
_SAID = re.compile(r"\bSources?:.*", re.DOTALL)
_CHOICE = re.compile(r"\(auto: ([\w-]+)")


class Cited(NamedTuple):
    """Something used, the words in which it names its sources, and the publications those are."""

    what: str
    words: str
    references: list[Reference]


def sources(saved: Saved) -> list[Cited]:
    """The study's source, then those of its laws, then those of its methods, each where it gave a number."""
    study, found = saved.study, _with_numbers(saved.table)
    laws = {law.kind: law for law in study.laws if law.kind in set(found["kind"])}
    methods = _each(choice.name for choice in study.methods if choice.label in set(found["method"]))
    hows = dict.fromkeys(methods, "") | ({} if "auto" not in methods else chosen_by_auto(found))
    cited = [
        _cited("the study", study.source, ""),
        *(_cited(f"law {kind}", _named(law_text(law)), law.law_class.bibtex) for kind, law in laws.items()),
        *(_of_method(name, "" if name in methods else how) for name, how in hows.items()),
    ]
    return [each for each in cited if each.words or each.references]


def published(cited: Iterable[Cited]) -> list[Reference]:
    """The publications among them, each once."""
    return list(dict.fromkeys(each for one in cited for each in one.references if "author" in each.fields))


def _with_numbers(table: pd.DataFrame) -> pd.DataFrame:
    return table[table["mean_friction"].notna() | (table["status"] == "not_unique")]


def _each(names: Iterable[str]) -> list[str]:
    return list(dict.fromkeys(names))


def chosen_by_auto(found: pd.DataFrame) -> dict[str, str]:
    """The methods that ``auto`` chose, as ``model`` names them; else those that it says it chooses from."""
    installed = registry.method_names()
    models = found["model"].dropna().unique()
    chosen = _each(name for model in models for name in _CHOICE.findall(model) if name in installed)
    if chosen:
        return dict.fromkeys(chosen, ", which auto chose")
    ladder = _each(re.findall(r"[\w-]+", method_text("auto").partition("\n")[0]))
    return {name: ", which auto may choose" for name in ladder if name in installed and name != "auto"}


def _of_method(name: str, how: str) -> Cited:
    return _cited(f"method {name}{how}", _named(method_text(name)), method_bibtex(name))


def _cited(what: str, words: str, bibtex: str) -> Cited:
    """What nobody has an entry for is cited in its own words."""
    found = publications(words, bibtex)
    return Cited(what, words, found or ([remark(what, words)] if words else []))


def _named(text: str) -> str:
    """Where a docstring names its sources: from "Source:" on, else the paragraphs that hold a year."""
    paragraphs = text.split("\n\n")
    said = [found[0] for each in paragraphs if (found := _SAID.search(each))]
    dated = [each for each in paragraphs if _YEAR.search(each)]
    return " ".join(" ".join(each.split()) for each in said or dated)
