"""What a page's tables are made of, and how numbers and long lists are written in them."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from itertools import islice
from typing import Any, NamedTuple

import pandas as pd
from markupsafe import Markup, escape

from frictionlab.report.markup import symbol_html, unit_html

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
    head: Sequence[Cell],
    rows: Iterable[Sequence[Cell]],
    what: str = "rows",
    file: str = "results.csv",
    total: int = 0,
) -> Grid:
    """A table without columns that are empty in every row, of at most ``MOST_ROWS`` of all its rows.

    what: they are; file: has all of them. total: how many they are, of an iterator.
    """
    shown = list(islice(rows, MOST_ROWS))
    left = (len(rows) if isinstance(rows, list) else total) - len(shown)
    kept = [place for place in range(len(head)) if any(row[place] for row in shown)]
    below = f"... and {left} more {what}, all of them in {file}" if left else ""
    written = [[minus(row[place]) for place in kept] for row in shown]
    return Grid(caption, [head[place] for place in kept], written, below)


def settings(values: Mapping[str, Any], digits: int = 6) -> Markup:
    """Inputs with their values, those that do not apply left out."""
    told = [setting(name, value, digits) for name, value in values.items() if not pd.isna(value)]
    return Markup(", ").join(told)


def setting(name: str, value: Any, digits: int = 6) -> Markup:
    """One input with its value and unit, on one line where it is short."""
    told = Markup("{} = {}{}").format(symbol_html(name), number(value, digits), unit_html(name))
    short = len(told.striptags()) <= SHORT_SETTING
    return Markup('<span class="short">{}</span>').format(told) if short else told


def number(value: Any, digits: int = 6) -> Cell:
    """A number to so many digits; nothing for one that does not apply."""
    if isinstance(value, str):
        return value
    if value is None or pd.isna(value):
        return ""
    return minus(f"{value:.{digits}g}")


def minus(text: Cell) -> Cell:
    """Words with a minus, not a hyphen, before their numbers; HTML as it is."""
    return text if isinstance(text, Markup) else _HYPHEN.sub("\N{MINUS SIGN}", text)


def size(value: float) -> str:
    """An error: its size to two digits; nothing for one that does not apply."""
    return "" if pd.isna(value) else f"{value:.1e}"


def the(method: str) -> str:
    """A method in a sentence: words have an article, a label has none."""
    return f"the {method}" if " " in method else method


def begun(sentence: Markup) -> Markup:
    """A sentence that begins with words of ours, with a capital."""
    ours = sentence.startswith(("the ", "at "))
    return Markup(sentence[:1].upper() + sentence[1:]) if ours else sentence


def joined_values(words: Iterable[Cell]) -> Markup:
    """Words, each once, with commas."""
    return Markup(", ").join(map(escape, dict.fromkeys(words)))


def listed(parts: Sequence[Cell]) -> Markup:
    """Words in a row, the last one after ``and``; what holds commas itself is parted by semicolons."""
    *most, last = [escape(part) for part in parts]
    between = "; " if any("," in part for part in (*most, last)) else ", "
    return Markup("{} and {}").format(Markup(between).join(most), last) if most else last


def named(values: Mapping[str, Any], one_law: bool) -> Markup:
    """A curve by its law, left out where there is only one, and the values that tell it apart."""
    told = [setting(name, value) for name, value in values.items() if name != "law" and not pd.isna(value)]
    law, where = escape(str(values["law"])), Markup(" and ").join(told)
    if not where or one_law:
        return where or law
    return Markup("{} with {}").format(law, where)
