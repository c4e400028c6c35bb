"""Symbols and words of inputs and columns as HTML: the mathtext of the figures, with real letters."""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import cache
from html.entities import html5

from markupsafe import Markup, escape

from frictionlab.columns import symbol, unit_shown, word

_RENAMED = {"varphi": "phi", "varepsilon": "epsilon"}  # what TeX calls so
_ACCENTS = {"bar": "\u0304", "hat": "\u0302", "dot": "\u0307", "tilde": "\u0303"}
_LEVELS = {"_": "sub", "^": "sup"}
_TOKEN = re.compile(
    r"\\mathrm\{(?P<upright>[^}]*)\}"
    r"|\\(?P<accent>bar|hat|dot|tilde)\s*(?:\{(?P<braced>[^}]*)\}|(?P<under>\\[A-Za-z]+|\w))"
    r"|\\(?P<name>[A-Za-z]+)|\{(?P<group>[^}]*)\}|(?P<level>[_^])|(?P<plain>.)"
)


@cache
def symbol_html(name: str) -> Markup:
    """The symbol of an input or column; for one without a symbol the last part of its path."""
    return html(symbol(name))


def word_html(name: str) -> Markup:
    """The words of an input or column with its symbol and unit."""
    return html(word(name))


@cache
def unit_html(name: str) -> Markup:
    """The unit of an input or column with a space before it; nothing where it has none."""
    return html(f" {unit_shown(name)}") if unit_shown(name) else Markup("")


def html(text: str) -> Markup:
    """Text with mathtext between dollar signs as HTML; everything else in it is escaped."""
    parts = text.split("$")
    return Markup("").join(_math(part) if place % 2 else escape(part) for place, part in enumerate(parts))


def _math(text: str) -> Markup:
    shown, level = Markup(""), ""
    for token in _TOKEN.finditer(text):
        if token["level"]:
            level = _LEVELS[token["level"]]
            continue
        atom = _atom(token)
        shown += Markup("<{0}>{1}</{0}>").format(Markup(level), atom) if level else atom
        level = ""
    return shown


def _atom(token: re.Match[str]) -> Markup:
    if token["upright"] is not None:
        return escape(token["upright"])
    if token["group"] is not None:
        return _math(token["group"])
    if token["accent"]:
        return _italic("".join(_letters(token["braced"] or token["under"])) + _ACCENTS[token["accent"]])
    return _italic("".join(_letters(token[0])))


def _letters(text: str) -> Iterator[str]:
    for name, plain in re.findall(r"\\([A-Za-z]+)|(.)", text):
        yield html5.get(f"{_RENAMED.get(name, name)};", name) or plain


def _italic(text: str) -> Markup:
    return Markup("<i>{}</i>").format(text) if text[:1].isalpha() else escape(text)
