"""Tables of what a run found: curves, pairs, onsets, points whole, models, verdicts, what is not plainly ok."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any

import pandas as pd
from markupsafe import Markup

from frictionlab.methods.words import model_in_sentences, why_unique_in_words
from frictionlab.report.facts import CurveRows, Facts, whose
from frictionlab.report.tables import (
    Cell,
    Grid,
    grid,
    in_order,
    joined_values,
    number,
    setting,
    settings,
    size,
    symbol_html,
    unit_html,
    word_html,
)
from frictionlab.runner.expectations import Verdict
from frictionlab.runner.pairs import Difference, law_pairs
from frictionlab.runner.summary import alike, each_once, mean_span, pattern, statuses
from frictionlab.runner.words import counted
from frictionlab.values.columns import ALSO_IN_SI, RESULTS, SI, by_plain_names
from frictionlab.values.printable import MOST_DIGITS, with_error

NOT_SHOWN = Grid("", [], [])
"""A table that is not shown."""
FEW_ROWS = 4
"""A table of so few rows is shown whole."""
TOLD_ELSEWHERE = ("reason", "model")
MOST_OF_A_POINT = 12
"""Digits of a number that is told with its error."""
MOST_EXAMPLES = 3
SAYS_TESTED = "tested: "
"""Beginning of a sentence on starts, in ``reason``."""

VERDICTS = {
    True: Markup('<span class="good">passed</span>'),
    False: Markup('<span class="bad">FAILED</span>'),
}


SHAPE_HEADS = {
    "shape": "shape",
    "shape_area": "area between curve and chord",
    "reversal_end": "end of reversal",
    "reduction": "largest reduction",
    "shape_half": "share at half the range",
    "shape_initial": "curvature at rest",
    "shape_by_initial": "shape at rest",
    "model_distance": "distance to the full curve",
    "not_unique_from": "not unique from",
    "not_unique_to": "not unique to",
}
"""Columns of ``curves.csv`` that are shown, and their heads."""


def curves_grid(run: Facts) -> Grid:
    """Return one line per curve: everything equal but belt speed."""
    in_si = "mean_friction_N" in run.table
    mean = Markup("mean friction {}, least … greatest").format(symbol_html("mean_friction"))
    columns = whose(run.curves) | {
        "points": lambda curve: statuses(curve.rows).replace("_", " "),
        mean: lambda curve: mean_span(curve.rows),
        "mean friction force [N]": lambda curve: mean_span(curve.rows, unit="_N") if in_si else "",
        "largest error": lambda curve: size(curve.rows["error"].max()),
        "at": lambda curve: _worst(run, curve.rows[curve.rows["error"].notna()]),
        "kind of error": lambda curve: joined_values(curve.rows["error_kind"].dropna().unique()),
        "errors above the tolerance": lambda curve: _count_if_any(above_tolerance(run, curve.rows)),
    }
    return grid("Curves: everything equal but belt speed", columns, run.curves, "curves")


def _worst(run: Facts, known: pd.DataFrame) -> Cell:
    return "" if known.empty else setting(run.speed, known.loc[known["error"].idxmax(), run.speed])


def _count_if_any(which: pd.Series) -> str:
    return counted(int(which.sum()), "point") if which.any() else ""


def above_tolerance(run: Facts, rows: pd.DataFrame) -> pd.Series:
    """Select rows that have a larger error than asked for, whatever its kind."""
    return rows["error"] > run.saved.study.tolerance


def onset_grid(run: Facts) -> Grid:
    """Return the onsets of onsets.csv, each with its error, curve by curve; nothing where the study asks for none."""
    if run.saved.shown_onsets is None:
        return NOT_SHOWN
    curves = run.curves_of(run.saved.shown_onsets)
    onsets = [curve._replace(places=[place]) for curve in curves for place in curve.places]
    columns = whose(curves) | {
        "what": lambda onset: onset.row["onset"].replace("_", " "),
        Markup("belt speed{}").format(unit_html(run.speed)): partial(_measure, "belt_speed"),
        "how it was found": lambda onset: onset.row["how"],
    }
    return grid("Onsets along rising belt speed", columns, onsets, "onsets", "onsets.csv")


def shape_grid(run: Facts) -> Grid:
    """Return the measures of curves.csv, each with its error, the verdict first; nothing without a shape."""
    table = run.saved.curves
    known = () if table is None else table.columns[table.notna().any()]
    own = [name for name in SHAPE_HEADS if name in known]
    if table is None or {*own} <= {"reversal_end", "reduction"}:
        return NOT_SHOWN
    curves, unit = run.curves_of(table), unit_html(run.speed)
    heads = [Markup("{}{}").format(SHAPE_HEADS[name], unit if name in ALSO_IN_SI else "") for name in own]
    columns = whose(curves) | {head: partial(_measure, name) for head, name in zip(heads, own, strict=True)}
    caption = "Shape of each curve against its chord, the line from rest to the end of reversal"
    found = grid(caption, columns, curves, "curves", "curves.csv")
    missing = (
        f"A measure is missing of {counted(count, 'curve')}: {why}." for count, why in why_missing(table)
    )
    return found._replace(below=" ".join(filter(None, [found.below, *missing])))


def _measure(name: str, curve: CurveRows) -> str:
    value, error = curve.measure(name)
    return value if isinstance(value, str) else with_error(value, error)


def why_missing(curves: pd.DataFrame) -> list[tuple[int, str]]:
    """List why measures are missing: how many curves have each reason, and the reason, the commonest first."""
    reasons = curves["reason"].dropna()
    kinds = [kind for _, kind in reasons.groupby(reasons.map(pattern), sort=False)]
    return [(len(kind), alike(kind)) for kind in sorted(kinds, key=len, reverse=True)]


def pair_grids(run: Facts) -> list[Grid]:
    """Every two laws, and every two methods law by law: where their means differ most, and by how much."""
    caption = "{} in pairs: the largest difference of their mean friction at the same point"
    columns: dict[Cell, Callable[[Difference], Cell]] = {
        "law": lambda pair: pair.law,
        "pair": lambda pair: f"{pair.one} \N{MINUS SIGN} {pair.other}",
        "largest difference": lambda pair: (
            f"{'' if pair.apart else 'the same within errors: '}{with_error(pair.value, pair.error)}"
        ),
        "at": lambda pair: settings(pair.where),
        "points that differ by more than their errors": lambda pair: f"{pair.apart} of {pair.shared}",
    }
    pairs = {"Laws": law_pairs(run.table), "Methods": run.method_pairs}
    return [grid(caption.format(who), columns, found, "pairs") for who, found in pairs.items()]


def whole_grid(run: Facts) -> Grid:
    """Every number of a table of very few rows, a column for each point; nothing of a longer one.

    In SI units where the scene is given so; an error beside the number that it is of.
    """
    table = run.table
    if len(table) > FEW_ROWS:
        return NOT_SHOWN
    shown = by_plain_names(table)
    in_si = [name for name in SI if name in shown]
    names = [*RESULTS, *in_si]
    left = {*TOLD_ELSEWHERE, *map(_error_of, names), *(SI[name].column for name in in_si)} - {"mean_friction"}
    told = [name for name in names if name not in left and table[shown[name]].notna().any()]
    columns: dict[Cell, Callable[[str], Cell]] = {"quantity": lambda name: word_html(shown[name])}
    for _, row in table.iterrows():
        head = Markup("{} by {}, {}").format(row["law"], row["method"], settings(run.where(row)))
        columns[head] = partial(_written, row, shown)
    return grid("Every number found", columns, told)


def _error_of(name: str) -> str:
    """Return the column with the error of another."""
    if name.startswith("mean_friction"):
        return name.replace("mean_friction", "error")
    return f"{name.removesuffix('_J')}_error_J" if name.endswith("_J") else f"{name}_error"


def _written(row: pd.Series, shown: Mapping[str, str], name: str) -> str:
    value, error = row[shown[name]], row.get(shown.get(_error_of(name)))
    if isinstance(value, str):
        return value
    return with_error(value, error, MOST_DIGITS if pd.isna(error) else MOST_OF_A_POINT)


def models_grid(run: Facts) -> Grid:
    """List what produced the numbers: each model of the table, its sentence, and how many points it produced."""
    models = _by_sentence(run.table, "method", run.table["model"])
    said = {model: model_in_sentences(model) for _, model, *_ in models}
    rows = [
        [method, model, "" if said[model] == model else said[model], *who] for method, model, *who in models
    ]
    columns = in_order("method", "model", "what it is, and why", "points", "laws")
    return grid("What produced the numbers", columns, rows, "models")


def uniqueness_grid(run: Facts) -> Grid:
    """Tell how it is known of points that no start ends elsewhere, in sentences; by how many points."""
    table, unique = run.table, run.table["unique"]
    proved = each_once(table["model"].fillna(""), why_unique_in_words)
    how = proved.where(unique == "proved", each_once(table["reason"], _how_tested))
    kinds = _by_sentence(table, "unique", how.mask(unique == "no", "other starts end elsewhere"))
    columns = in_order("unique", "how it is known", "points", "laws")
    return grid("Whether every start ends there", columns, kinds, "kinds")


def _by_sentence(table: pd.DataFrame, by: str, sentences: pd.Series) -> list[list[str]]:
    """Cells of a column with a sentence that they share but for its numbers, and how many points of which laws."""
    told = table[["law", by]].assign(said=sentences)[table[by].notna() & sentences.notna()]
    groups = told.groupby([told[by], each_once(told["said"], pattern)], sort=False)
    return [
        [cell, alike(rows["said"].unique()), counted(len(rows), "point"), joined_values(rows["law"].unique())]
        for (cell, _), rows in groups
    ]


def _how_tested(reason: Any) -> str:
    """Find the sentence of a reason on starts; nothing where there is none."""
    return next(
        (each.removeprefix(SAYS_TESTED) for each in str(reason).split("; ") if each.startswith(SAYS_TESTED)),
        "",
    )


def verdicts_grid(verdicts: Sequence[Verdict]) -> Grid:
    """List what was expected and whether it is so, what failed first."""
    columns: dict[Cell, Callable[[Verdict], Cell]] = {
        "verdict": lambda verdict: VERDICTS[verdict.passed],
        "expectation: what was found": lambda verdict: verdict.sentence,
    }
    ordered = sorted(verdicts, key=lambda verdict: verdict.passed)
    return grid("What the study expects of its table", columns, ordered)


def with_remark(run: Facts) -> pd.Series:
    """Select rows that are ok with something to note; no model's own error, nor that starts were tested."""
    full, told = ~run.table["method"].isin(run.reduced), run.table["reason"].fillna(SAYS_TESTED)
    return (run.table["status"] == "ok") & full & ~told.str.startswith(SAYS_TESTED)


def trouble_grid(run: Facts) -> Grid:
    """Every point that is not plainly ok, those of like reasons together, with examples."""
    odd = run.table[(run.table["status"] != "ok") | with_remark(run)]
    reasons = odd["reason"].map(lambda reason: str(reason or "").partition(f"; {SAYS_TESTED}")[0])
    odd = odd.assign(reason=reasons, status=odd["status"].replace("ok", "ok, but"))
    groups = [rows for _, rows in odd.groupby([odd["status"], reasons.map(pattern)], sort=False)]
    columns: dict[Cell, Callable[[pd.DataFrame], Cell]] = {
        "status": lambda rows: rows["status"].iloc[0].replace("_", " "),
        "points": lambda rows: str(len(rows)),
        "reason": lambda rows: alike(rows["reason"]),
        "laws": lambda rows: joined_values(rows["law"].unique()),
        "methods": lambda rows: joined_values(rows["method"].unique()),
        "for example": partial(_examples, run),
    }
    groups.sort(key=lambda rows: (rows["status"].iloc[0] == "ok, but", -len(rows)))
    return grid("Points that are not plainly ok", columns, groups, "reasons")


def _examples(run: Facts, rows: pd.DataFrame) -> Markup:
    told = [_example(run, row) for _, row in rows.head(MOST_EXAMPLES).iterrows()]
    left = len(rows) - MOST_EXAMPLES
    return Markup("; ").join([*told, *([f"and {counted(left, 'point')} more"] if left > 0 else [])])


def _example(run: Facts, row: pd.Series) -> Markup:
    place = settings(run.where(row))
    if pd.isna(row["mean_low"]):
        return place
    low, high = number(row["mean_low"]), number(row["mean_high"])
    window = "" if pd.isna(row["window"]) else f" over {counted(round(row['window']), 'period')}"
    return Markup("{}: means from {} to {}{}").format(place, low, high, window)
