"""Tables of a page, and how numbers and long lists are written in them.

Symbols and words of inputs and columns as HTML: the mathtext of the figures, with real letters.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cache
from html.entities import html5
from operator import itemgetter
from typing import Any, NamedTuple

import pandas as pd
from markupsafe import Markup, escape

from frictionlab.scene.waveforms import told
from frictionlab.values.columns import SHOWN_IN, symbol, typeset, unit_shown, word
from frictionlab.values.quantities import Written

_RENAMED = {"varphi": "phi", "varepsilon": "epsilon", "infty": "infin"}  # what TeX calls so
_ACCENTS = {"bar": "\u0304", "hat": "\u0302", "dot": "\u0307", "tilde": "\u0303"}
_LEVELS = {"_": "<sub>{}</sub>", "^": "<sup>{}</sup>"}
_AS_HTML: dict[str, Callable[[re.Match[str]], str]] = {
    r"\\(bar|hat|dot|tilde)\s*(?:\{([^}]*)\}|(\\[A-Za-z]+|\w))": lambda found: (
        (found[2] or found[3]) + _ACCENTS[found[1]]
    ),
    r"\\(?!mathrm)([A-Za-z]+)": lambda found: html5.get(f"{_RENAMED.get(found[1], found[1])};", found[1]),
    r"([_^])(?:\{([^}]*)\}|(\\mathrm\{[^}]*\}|.))": lambda found: _LEVELS[found[1]].format(
        found[2] or found[3]
    ),
    r"\\mathrm\{([^}]*)\}|(<[^>]*>|&\w+;)|([^\W\d_][\u0300-\u036f]*)": lambda found: (
        found[1] or found[2] or f"<i>{found[3]}</i>"
    ),
}
"""Patterns of mathtext and what stands for them: accents, names of letters, levels, then letters in italics."""


@cache
def symbol_html(name: str) -> Markup:
    """Return the symbol of an input or column; for one without a symbol the last part of its path."""
    return html(symbol(name))


def word_html(name: str) -> Markup:
    """Return the words of an input or column with its symbol and unit."""
    return html(word(name))


@cache
def unit_html(name: str) -> Markup:
    """Return the unit of an input or column with a space before it; nothing where it has none."""
    return html(f" {unit_shown(name)}") if unit_shown(name) else Markup("")


def html(text: str) -> Markup:
    """Text with mathtext between dollar signs as HTML; everything else in it is escaped."""
    parts = text.split("$")
    return Markup("").join(_math(part) if place % 2 else escape(part) for place, part in enumerate(parts))


def _math(text: str) -> Markup:
    shown = str(escape(text))
    for pattern, written in _AS_HTML.items():
        shown = re.sub(pattern, written, shown)
    return Markup(shown)


Cell = str | Markup
SHORT_SETTING = 32
"""Letters of a setting that no line ends in."""
MOST_ROWS = 200
"""Rows of one table on a page; how many more there are is said below it."""
_HYPHEN = re.compile(r"(?<![\w.])-(?=\d)")
"""Before a number; that of a power of ten stays, as programs read and write it."""


class Grid(NamedTuple):
    """A table of a page: its caption, the heads of its columns, its rows, and what is to be said below it."""

    caption: str
    head: Sequence[Cell]
    rows: Sequence[Sequence[Cell]]
    below: str = ""


def grid(
    caption: str,
    columns: Mapping[Cell, Callable[[Any], Cell]],
    of: Sequence[Any],
    what: str = "rows",
    file: str = "results.csv",
) -> Grid:
    """A table of at most ``MOST_ROWS`` things; columns that are empty in every row are left out.

    columns: heads, and what is told of a thing below each. what: the things are; file: has all of them.
    """
    cells = {head: [minus(cell(each)) for each in of[:MOST_ROWS]] for head, cell in columns.items()}
    kept = {head: told for head, told in cells.items() if any(told)}
    left = max(0, len(of) - MOST_ROWS)
    below = f"... and {left} more {what}, all of them in {file}" if left else ""
    return Grid(caption, [*kept], [*zip(*kept.values(), strict=True)], below)


def in_order(*heads: Cell) -> dict[Cell, Callable[[Any], Cell]]:
    """Columns of things that are rows of cells already."""
    return {head: itemgetter(place) for place, head in enumerate(heads)}


def settings(values: Mapping[str, Any], digits: int = 6) -> Markup:
    """Inputs with their values, those that do not apply left out."""
    told = [setting(name, value, digits) for name, value in values.items() if not pd.isna(value)]
    return Markup(", ").join(told)


def setting(name: str, value: Any, digits: int = 6) -> Markup:
    """Return one input with its value and unit, on one line where it is short."""
    unit, shown = (
        ("", f"{name}{SHOWN_IN}{value.unit}") if isinstance(value, Written) else (unit_html(name), name)
    )
    told = Markup("{} = {}{}").format(symbol_html(shown), number(value, digits), unit)
    short = len(told.striptags()) <= SHORT_SETTING
    return Markup('<span class="short">{}</span>').format(told) if short else told


def number(value: Any, digits: int = 6) -> Cell:
    """A number to so many digits, or with the unit it was written in; words; nothing for one that does not apply."""
    if isinstance(value, Written):
        return html(typeset(value.text))
    if isinstance(value, str | bool):
        return told(str(value)).words if str(value).startswith("points ") else str(value)
    return "" if value is None or pd.isna(value) else minus(f"{value:.{digits}g}")


def minus(text: Cell) -> Cell:
    """Words with a minus, not a hyphen, before their numbers; HTML as it is."""
    return text if isinstance(text, Markup) else _HYPHEN.sub("\N{MINUS SIGN}", text)


def size(value: float) -> str:
    """An error: its size to two digits; nothing for one that does not apply."""
    return "" if pd.isna(value) else f"{value:.1e}"


def the(method: str) -> str:
    """A method in a sentence: words have an article, a label has none."""
    return f"the {method}" if " " in method else method


def joined_values(words: Iterable[Cell]) -> Markup:
    """Words, each once, with commas."""
    return Markup(", ").join(map(escape, dict.fromkeys(words)))


def listed(parts: Sequence[Cell]) -> Markup:
    """Words in a row, the last one after ``and``; what holds commas itself is parted by semicolons."""
    *most, last = [escape(part) for part in parts]
    between = "; " if any("," in part for part in (*most, last)) else ", "
    return Markup("{} and {}").format(Markup(between).join(most), last) if most else last


def named(values: Mapping[str, Any]) -> Markup:
    """A curve by its law, and the values that tell it apart."""
    told = [setting(name, value) for name, value in values.items() if name != "law" and not pd.isna(value)]
    law, where = escape(str(values["law"])), Markup(" and ").join(told)
    return Markup("{} with {}").format(law, where) if where else law
