"""Points that are not plainly ok: those of another status, and those with a remark."""

from __future__ import annotations

from collections.abc import Sequence

import pandas as pd
from markupsafe import Markup

from frictionlab.columns import belt_speed
from frictionlab.report.tables import Cell, Grid, grid, joined_values, number, settings
from frictionlab.results.summary import alike, pattern
from frictionlab.results.table import swept_inputs
from frictionlab.results.words import counted

MOST_EXAMPLES = 3
SAYS_TESTED, SAYS_PROVED = "tested: ", "unique: "
"""How sentences on uniqueness begin, in ``reason`` and in ``model``."""


def with_remark(table: pd.DataFrame) -> pd.Series:
    """Which rows are ok with something to note; that starts were tested is told in a table of its own."""
    return (table["status"] == "ok") & ~table["reason"].fillna(SAYS_TESTED).str.startswith(SAYS_TESTED)


def trouble_grid(table: pd.DataFrame) -> Grid:
    """Every point that is not plainly ok, those of like reasons together, with examples."""
    odd = table[(table["status"] != "ok") | with_remark(table)]
    groups = odd.groupby([odd["status"], odd["reason"].map(pattern)], sort=False)
    ordered = sorted(groups, key=lambda group: (group[0][0] == "ok", -len(group[1])))
    swept = swept_inputs(table)
    rows = [_trouble(str(status), rows, swept) for (status, _), rows in ordered]
    head = ["status", "points", "reason", "laws", "methods", "for example"]
    return grid("Points that are not plainly ok", head, rows, "reasons")


def _trouble(status: str, rows: pd.DataFrame, swept: Sequence[str]) -> list[Cell]:
    shown = min(len(rows), MOST_EXAMPLES)
    told = Markup("; ").join(_example(rows.iloc[place], swept) for place in range(shown))
    more = f"; and {counted(len(rows) - shown, 'point')} more" if len(rows) > shown else ""
    words = status.replace("_", " ") if status != "ok" else "ok, but"
    who = joined_values(rows["law"]), joined_values(rows["method"])
    return [words, str(len(rows)), alike(rows["reason"].fillna("")), *who, told + more]


def _example(row: pd.Series, swept: Sequence[str]) -> Markup:
    place = place_of(row, swept)
    if pd.isna(row["mean_low"]):
        return place
    low, high = number(row["mean_low"]), number(row["mean_high"])
    window = "" if pd.isna(row["window"]) else f" over {row['window']:.6g} periods"
    return Markup("{}: means from {} to {}{}").format(place, low, high, window)


def place_of(row: pd.Series, swept: Sequence[str]) -> Markup:
    """Where a point is: its belt speed, and what else is swept."""
    speed = belt_speed(row.index)
    return settings({speed: row[speed]} | {name: row[name] for name in swept})
