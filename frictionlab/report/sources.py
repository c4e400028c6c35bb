"""Whom a study draws on: its own source, and what the laws and methods it used say of theirs."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import NamedTuple

from frictionlab import registry
from frictionlab.report.documents import law_text, method_text
from frictionlab.saved import Saved

_YEAR = re.compile(r"\b1[6-9]\d\d\b|\b20\d\d\b")
_CHOICE = re.compile(r"\(auto: ([\w-]+)")


class Cited(NamedTuple):
    """Something used, and the words in which it names its sources."""

    what: str
    words: str


def sources(saved: Saved) -> list[Cited]:
    """The study's source, then those of its laws, then those of the methods that did the work."""
    study = saved.study
    own = [Cited("the study", study.source)]
    laws = [Cited(f"law {name}", _named(law_text(name))) for name in _each(law.kind for law in study.laws)]
    named = _each(choice.name for choice in study.methods)
    methods = [Cited(f"method {name}", _named(method_text(name))) for name in named]
    if "auto" in named:
        methods += [_of_auto(name, how) for name, how in chosen_by_auto(saved).items() if name not in named]
    return [cited for cited in [*own, *laws, *methods] if cited.words]


def _each(names: Iterable[str]) -> list[str]:
    return list(dict.fromkeys(names))


def chosen_by_auto(saved: Saved) -> dict[str, str]:
    """The methods that ``auto`` chose, as ``model`` names them; else those that it says it chooses from."""
    installed = registry.method_names()
    models = saved.table["model"].dropna().unique()
    chosen = _each(name for model in models for name in _CHOICE.findall(model) if name in installed)
    if chosen:
        return dict.fromkeys(chosen, "which auto chose")
    ladder = _each(re.findall(r"[\w-]+", method_text("auto").partition("\n")[0]))
    return {name: "which auto may choose" for name in ladder if name in installed and name != "auto"}


def _of_auto(name: str, how: str) -> Cited:
    return Cited(f"method {name}, {how}", _named(method_text(name)))


def _named(text: str) -> str:
    """The paragraphs of a docstring that name sources: those that say so, else those that hold a year."""
    paragraphs = text.split("\n\n")
    said = [each for each in paragraphs if each.startswith(("Source:", "Sources:"))]
    dated = [each for each in paragraphs if _YEAR.search(each)]
    return " ".join(" ".join(each.split()) for each in said or dated)
