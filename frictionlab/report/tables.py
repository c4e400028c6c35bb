"""What a page's tables are made of, and how numbers and long lists are written in them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

import pandas as pd
from markupsafe import Markup, escape

from frictionlab.report.markup import symbol_html, unit_html

Cell = str | Markup
SHORT_SETTING = 32
"""Letters of a setting that no line ends in."""
MOST_ROWS = 200
"""Rows of one table on a page; how many more there are is said below it."""


class Grid(NamedTuple):
    """A table of a page: its caption, the heads of its columns, its rows, and what is to be said below it."""

    caption: str
    head: Sequence[Cell]
    rows: Sequence[Sequence[Cell]]
    below: str = ""


class CurveRows(NamedTuple):
    """The rows of one law and method that differ in belt speed alone; where: what else was swept, and its value."""

    law: str
    method: str
    where: Mapping[str, Any]
    rows: pd.DataFrame

    @property
    def name(self) -> Markup:
        """What tells the curve from the others of its law and method."""
        return settings(self.where)

    @property
    def key(self) -> str:
        """Law, method and values as one word, the same in every table that has the curve."""
        return f"{self.law}, {self.method}, {self.name}"


def grid(
    caption: str,
    head: Sequence[Cell],
    rows: Sequence[Sequence[Cell]],
    what: str = "rows",
    file: str = "results.csv",
    left: int = 0,
) -> Grid:
    """A table without columns that are empty in every row, of at most ``MOST_ROWS`` rows.

    file: has all of them. left: how many are left out already.
    """
    kept = [place for place in range(len(head)) if any(row[place] for row in rows)]
    shown = [[row[place] for place in kept] for row in rows[:MOST_ROWS]]
    left += len(rows) - len(shown)
    below = f"... and {left} more {what}, all of them in {file}" if left else ""
    return Grid(caption, [head[place] for place in kept], shown, below)


def curve_rows(table: pd.DataFrame, told: Sequence[str]) -> list[CurveRows]:
    """The curves of a table, in its order, told apart by these inputs besides law and method."""
    groups = table.groupby(["law", "method", *told], sort=False, dropna=False)
    return [
        CurveRows(str(law), str(method), dict(zip(told, values, strict=True)), rows)
        for (law, method, *values), rows in groups
    ]


def whose(curves: Sequence[CurveRows]) -> list[list[Cell]]:
    """Of each curve its law, its method where there are several, and what tells it from the others."""
    several = len({curve.method for curve in curves}) > 1
    return [[curve.law, curve.method if several else "", curve.name] for curve in curves]


def settings(values: Mapping[str, Any]) -> Markup:
    """Inputs with their values, those that do not apply left out."""
    told = [setting(name, value) for name, value in values.items() if not pd.isna(value)]
    return Markup(", ").join(told)


def setting(name: str, value: Any) -> Markup:
    """One input with its value and unit, on one line where it is short."""
    told = Markup("{} = {}{}").format(symbol_html(name), number(value), unit_html(name))
    return (
        Markup('<span class="short">{}</span>').format(told)
        if len(told.striptags()) <= SHORT_SETTING
        else told
    )


def number(value: Any) -> str:
    """A number to six digits; nothing for one that does not apply."""
    if isinstance(value, str):
        return value
    if value is None or pd.isna(value):
        return ""
    return f"{value:.6g}"


def size(value: float) -> str:
    """An error: its size to two digits; nothing for one that does not apply."""
    return "" if pd.isna(value) else f"{value:.1e}"


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
    law = escape(str(values["law"]))
    told = [setting(name, value) for name, value in values.items() if name != "law" and not pd.isna(value)]
    where = Markup(" and ").join(told)
    if not where:
        return law
    return where if one_law else Markup("{} with {}").format(law, where)
