"""What a run found, as tables: curves in brief, errors, models, and every point that is not plainly ok."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import pandas as pd
from markupsafe import Markup, escape

from frictionlab.columns import RESULTS, belt_speed
from frictionlab.report.markup import symbol_html
from frictionlab.report.tables import (
    Cell,
    CurveRows,
    Grid,
    curve_rows,
    grid,
    joined_values,
    number,
    setting,
    settings,
    size,
    value_range,
)
from frictionlab.results.expectations import Verdict
from frictionlab.results.summary import alike, pattern, statuses
from frictionlab.results.table import swept_inputs
from frictionlab.results.words import counted
from frictionlab.runner.saved import Saved

FEW_ROWS = 4
"""A table of so few rows is shown whole."""
MOST_EXAMPLES = 3
TOLD_ELSEWHERE = ("reason", "model")
SAYS_TESTED, SAYS_PROVED = "tested: ", "unique: "
"""How sentences on uniqueness begin, in ``reason`` and in ``model``."""


def brief_grid(curves: Sequence[CurveRows]) -> Grid:
    """One line per curve."""
    head = [
        "law",
        "method",
        "curve",
        "points",
        Markup("mean friction {}").format(symbol_html("mean_friction")),
    ]
    rows = [
        [curve.law, curve.method, curve.name, statuses(curve.rows), value_range(curve.rows["mean_friction"])]
        for curve in curves
    ]
    return grid("Curves: everything equal but belt speed", head, rows, "curves")


def shape_grid(curves: pd.DataFrame, told: Sequence[str]) -> Grid:
    """The measures of curves.csv, each with its error; told: the inputs that tell curves apart."""
    measures = [name for name in curves.columns if f"{name}_error" in curves]
    last_input = max([place for place, name in enumerate(curves.columns) if _is_input(name)], default=-1)
    own = [
        name
        for name in curves.columns[last_input + 1 :]
        if not (name.endswith("_error") and name.removesuffix("_error") in measures)
    ]
    rows = [
        [curve.law, curve.method, curve.name, *(_measure(curve.rows.iloc[0], name) for name in own)]
        for curve in curve_rows(curves, [name for name in told if name in curves])
    ]
    head = ["law", "method", "curve", *(name.replace("_", " ") for name in own)]
    return grid("Shape of the curves, from curves.csv", head, rows, "curves")


def onset_grid(onsets: pd.DataFrame, told: Sequence[str]) -> Grid:
    """The onsets of onsets.csv, each with its error, curve by curve; told: the inputs that tell curves apart."""
    rows = [
        [
            curve.law,
            curve.method,
            curve.name,
            row["onset"].replace("_", " "),
            _measure(row, "belt_speed"),
            row["how"],
        ]
        for curve in curve_rows(onsets, [name for name in told if name in onsets])
        for _, row in curve.rows.iterrows()
    ]
    head = ["law", "method", "curve", "what", "belt speed", "how it was found"]
    return grid("Onsets along rising belt speed, from onsets.csv", head, rows, "onsets")


def _is_input(name: str) -> bool:
    return name in ("law", "kind", "method") or name.startswith(("scene.", "law."))


def _measure(row: pd.Series, name: str) -> str:
    value, error = row[name], row.get(f"{name}_error")
    if value is None or pd.isna(value):
        return ""
    return number(value) if error is None or pd.isna(error) else f"{number(value)} ± {error:.1g}"


def whole_grid(table: pd.DataFrame) -> Grid | None:
    """Every number of a table of very few rows, a column for each point; None for a longer one."""
    if len(table) > FEW_ROWS:
        return None
    names = [
        name for name in [*RESULTS, *_si(table)] if name not in TOLD_ELSEWHERE and table[name].notna().any()
    ]
    rows = [[_quantity(name), *(_written(name, value) for value in table[name])] for name in names]
    swept = swept_inputs(table)
    head = ["quantity", *(_point(table.iloc[place], swept) for place in range(len(table)))]
    return grid("Every number found", head, rows)


def _si(table: pd.DataFrame) -> list[str]:
    return list(table.columns[list(table.columns).index(list(RESULTS)[-1]) + 1 :])


def _quantity(name: str) -> Cell:
    shown = symbol_html(name)
    words = name.replace("_", " ")
    return words if str(shown) == words else Markup("{} {}").format(words, shown)


def _written(name: str, value: Any) -> str:
    if isinstance(value, str) or pd.isna(value):
        return value if isinstance(value, str) else ""
    return size(value) if name.startswith("error") else f"{value:.10g}"


def errors_grid(curves: Sequence[CurveRows], tolerance: float) -> Grid:
    """Largest and median error per curve, of which kind they are, and where the largest is."""
    head = ["law", "method", "curve", "largest error", "at", "median error", "kind", "above the tolerance"]
    rows = [_errors(curve, tolerance) for curve in curves if curve.rows["error"].notna().any()]
    return grid("Errors of the mean friction", head, rows, "curves")


def _errors(curve: CurveRows, tolerance: float) -> list[Cell]:
    error = curve.rows["error"]
    worst = curve.rows.loc[error.idxmax()]
    above = int((error > tolerance).sum())
    return [
        curve.law,
        curve.method,
        curve.name,
        size(float(error.max())),
        _speed(worst),
        size(float(error.median())),
        joined_values(curve.rows.loc[error.notna(), "error_kind"].dropna()),
        counted(above, "point") if above else "none",
    ]


def _speed(row: pd.Series) -> Markup:
    name = belt_speed(row.index)
    return setting(name, row[name])


def models_grid(table: pd.DataFrame) -> Grid:
    """What produced the numbers, in the methods' own sentences, with how many points each produced."""
    told = table[table["model"].notna()]
    groups = told.groupby([told["method"], told["model"].map(pattern)], sort=False)
    rows = [
        [str(method), alike(rows["model"]), counted(len(rows), "point"), joined_values(rows["law"])]
        for (method, _), rows in groups
    ]
    return grid("What produced the numbers", ["method", "model, and why", "points", "laws"], rows, "models")


def trouble_grid(table: pd.DataFrame) -> Grid:
    """Every point that is not plainly ok, those of like reasons together, with examples."""
    # that starts were tested is told in a table of its own
    plain = (table["status"] == "ok") & table["reason"].fillna(SAYS_TESTED).str.startswith(SAYS_TESTED)
    odd = table[~plain]
    groups = odd.groupby([odd["status"], odd["reason"].map(pattern)], sort=False)
    ordered = sorted(groups, key=lambda group: (group[0][0] == "ok", -len(group[1])))
    swept = swept_inputs(table)
    rows = [_trouble(str(status), rows, swept) for (status, _), rows in ordered]
    head = ["status", "points", "reason", "laws", "methods", "for example"]
    return grid("Points that are not plainly ok", head, rows, "reasons")


def uniqueness_grid(table: pd.DataFrame) -> Grid:
    """How it is known of points that no start ends elsewhere, in the methods' own sentences; by how many points."""
    told = table[table["unique"].notna()]
    how = told["model"].where(told["unique"] == "proved", told["reason"]).map(_how_unique)
    groups = told.assign(how=how).groupby([told["unique"], how.map(pattern)], sort=False)
    rows = [
        [str(verdict), alike(rows["how"]), counted(len(rows), "point"), joined_values(rows["law"])]
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


def _trouble(status: str, rows: pd.DataFrame, swept: Sequence[str]) -> list[Cell]:
    shown = min(len(rows), MOST_EXAMPLES)
    told = Markup("; ").join(_example(rows.iloc[place], swept) for place in range(shown))
    more = f"; and {counted(len(rows) - shown, 'point')} more" if len(rows) > shown else ""
    words = status.replace("_", " ") if status != "ok" else "ok, but"
    who = joined_values(rows["law"]), joined_values(rows["method"])
    return [words, str(len(rows)), alike(rows["reason"].fillna("")), *who, told + more]


def _example(row: pd.Series, swept: Sequence[str]) -> Markup:
    place = _place(row, swept)
    if pd.isna(row["mean_low"]):
        return place
    low, high = number(row["mean_low"]), number(row["mean_high"])
    window = "" if pd.isna(row["window"]) else f" over {row['window']:.6g} periods"
    return Markup("{}: means from {} to {}{}").format(place, low, high, window)


def _place(row: pd.Series, swept: Sequence[str]) -> Markup:
    """Where a point is: its belt speed, and what else is swept."""
    where = settings({name: row[name] for name in swept})
    return Markup("{}, {}").format(_speed(row), where) if where else _speed(row)


def _point(row: pd.Series, swept: Sequence[str]) -> Markup:
    """Which point it is."""
    return Markup("{} by {}, {}").format(row["law"], row["method"], _place(row, swept))


def verdicts_grid(verdicts: Sequence[Verdict]) -> Grid:
    """What was expected and whether it is so, what failed first."""
    ordered = sorted(verdicts, key=lambda verdict: verdict.passed)
    rows = [[_verdict(each), each.sentence] for each in ordered]
    return grid("What the study expects of its table", ["verdict", "expectation: what was found"], rows)


def _verdict(verdict: Verdict) -> Markup:
    return Markup('<span class="{}">{}</span>').format(
        *(("good", "passed") if verdict.passed else ("bad", "FAILED"))
    )


def sentence_of_errors(saved: Saved) -> Markup:
    """The largest error of all, against the tolerance."""
    error = saved.table["error"].dropna()
    asked = f"{saved.study.tolerance:g}"
    if error.empty:
        return escape(f"No point has a number, so none has an error. The tolerance asked for was {asked}.")
    return escape(
        f"Every mean friction carries a bound on its absolute error. The largest is {error.max():.1e}, the median "
        f"{error.median():.1e}; the tolerance asked for was {asked}."
    )


def curves_of(saved: Saved) -> list[CurveRows]:
    """The curves of a run."""
    return curve_rows(saved.table, swept_inputs(saved.table))
