"""What a run found, as tables: every number of a few points, what produced the numbers, what was expected."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import pandas as pd
from markupsafe import Markup

from frictionlab.columns import RESULTS, SI
from frictionlab.printable import with_error
from frictionlab.report.markup import symbol_html
from frictionlab.report.tables import Cell, Grid, grid, joined_values
from frictionlab.report.trouble import SAYS_PROVED, SAYS_TESTED, place_of
from frictionlab.results.expectations import Verdict
from frictionlab.results.summary import alike, each_once, pattern
from frictionlab.results.table import swept_inputs
from frictionlab.results.words import counted

FEW_ROWS = 4
"""A table of so few rows is shown whole."""
TOLD_ELSEWHERE = ("reason", "model")
MOST_OF_A_POINT = 12
"""Digits of a number that is told with its error."""


def whole_grid(table: pd.DataFrame) -> Grid | None:
    """Every number of a table of very few rows, a column for each point; None for a longer one.

    In SI units where the scene is given so; an error beside the number that it is of.
    """
    if len(table) > FEW_ROWS:
        return None
    names = [*RESULTS, *(name for name in SI if name in table)]
    left = {*TOLD_ELSEWHERE, *map(_error_of, names), *(SI[name].column for name in SI if name in table)}
    shown = [name for name in names if name == "mean_friction" or name not in left]
    rows = [
        [_quantity(name), *(_written(row, name) for _, row in table.iterrows())]
        for name in shown
        if table[name].notna().any()
    ]
    swept = swept_inputs(table)
    head = ["quantity", *(_point(table.iloc[place], swept) for place in range(len(table)))]
    return grid("Every number found", head, rows)


def _quantity(name: str) -> Cell:
    shown = symbol_html(name)
    words = name.replace("_", " ")
    return words if str(shown) == words else Markup("{} {}").format(words, shown)


def _error_of(name: str) -> str:
    """The column with the error of another."""
    if name.startswith("mean_friction"):
        return name.replace("mean_friction", "error")
    return f"{name.removesuffix('_J')}_error_J" if name.endswith("_J") else f"{name}_error"


def _written(row: pd.Series, name: str) -> str:
    value = row[name]
    if isinstance(value, str):
        return value
    error = row.get(_error_of(name))
    return (
        with_error(value, error)
        if error is None or pd.isna(error)
        else with_error(value, error, MOST_OF_A_POINT)
    )


def _point(row: pd.Series, swept: Sequence[str]) -> Markup:
    """Which point it is."""
    return Markup("{} by {}, {}").format(row["law"], row["method"], place_of(row, swept))


def models_grid(table: pd.DataFrame) -> Grid:
    """What produced the numbers, in the methods' own sentences, with how many points each produced."""
    told = table[table["model"].notna()]
    groups = told.groupby([told["method"], each_once(told["model"], pattern)], sort=False)
    rows = [
        [str(method), alike(rows["model"].unique()), counted(len(rows), "point"), joined_values(rows["law"])]
        for (method, _), rows in groups
    ]
    return grid("What produced the numbers", ["method", "model, and why", "points", "laws"], rows, "models")


def uniqueness_grid(table: pd.DataFrame) -> Grid:
    """How it is known of points that no start ends elsewhere, in the methods' own sentences; by how many points."""
    told = table[table["unique"].notna()]
    how = told["model"].where(told["unique"] == "proved", told["reason"])
    how = each_once(how, _how_unique)
    groups = told.assign(how=how).groupby([told["unique"], each_once(how, pattern)], sort=False)
    rows = [
        [str(verdict), alike(rows["how"].unique()), counted(len(rows), "point"), joined_values(rows["law"])]
        for (verdict, _), rows in groups
    ]
    return grid(
        "Whether every start ends there", ["unique", "how it is known", "points", "laws"], rows, "kinds"
    )


def _how_unique(sentences: Any) -> str:
    """Of the sentences of a model or a reason the one on uniqueness; nothing where there is none."""
    parts = str(sentences).partition(" (auto: ")[0].split("; ")
    return next(
        (part.partition(": ")[2] for part in parts if part.startswith((SAYS_TESTED, SAYS_PROVED))), ""
    )


def verdicts_grid(verdicts: Sequence[Verdict]) -> Grid:
    """What was expected and whether it is so, what failed first."""
    ordered = sorted(verdicts, key=lambda verdict: verdict.passed)
    rows = [[_verdict(each), each.sentence] for each in ordered]
    return grid("What the study expects of its table", ["verdict", "expectation: what was found"], rows)


def _verdict(verdict: Verdict) -> Markup:
    return Markup('<span class="{}">{}</span>').format(
        *(("good", "passed") if verdict.passed else ("bad", "FAILED"))
    )
