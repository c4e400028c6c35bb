"""What a run found, as tables: curves, pairs, onsets, points whole, models, verdicts, what is not plainly ok."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import pandas as pd
from markupsafe import Markup

from frictionlab.methods.words import model_in_sentences, why_unique_in_words
from frictionlab.report.facts import CurveRows, Facts, whose
from frictionlab.report.tables import (
    Cell,
    Grid,
    grid,
    joined_values,
    number,
    setting,
    settings,
    size,
    symbol_html,
    unit_html,
)
from frictionlab.runner.expectations import Verdict
from frictionlab.runner.pairs import Difference, law_pairs
from frictionlab.runner.summary import alike, each_once, mean_span, pattern, statuses
from frictionlab.runner.words import counted
from frictionlab.values.columns import ALSO_IN_SI, IN_SI_UNITS, RESULTS, SI, by_plain_names
from frictionlab.values.printable import MOST_DIGITS, with_error

NOTHING = Grid("", [], [])
"""A table that is not shown."""
FEW_ROWS = 4
"""A table of so few rows is shown whole."""
TOLD_ELSEWHERE = ("reason", "model")
MOST_OF_A_POINT = 12
"""Digits of a number that is told with its error."""
MOST_EXAMPLES = 3
SAYS_TESTED = "tested: "
"""How a sentence on starts begins, in ``reason``."""

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
_OF_CURVES = "status", "mean_friction", "mean_friction_N", "error", "error_N", "error_kind"


def curves_grid(run: Facts) -> Grid:
    """One line per curve: everything equal but belt speed."""
    head = [
        *("law", "method", "curve", "points"),
        Markup("mean friction {}, least … greatest").format(symbol_html("mean_friction")),
        "mean friction force [N]",
        *("largest error", "at", "kind of error", "errors above the tolerance"),
    ]
    narrow = run.table[[name for name in run.table if name in (run.speed, *_OF_CURVES)]]
    rows = (
        [*who, statuses(own).replace("_", " "), *_numbers(run, own)]
        for who, own in zip(whose(run.curves), (narrow.iloc[each.places] for each in run.curves), strict=True)
    )
    return grid("Curves: everything equal but belt speed", head, rows, "curves", total=len(run.curves))


def _numbers(run: Facts, rows: pd.DataFrame) -> list[Cell]:
    """Where the mean lies, and the force in SI units; the largest error, where, the kinds, how many too large."""
    spans = [mean_span(rows), mean_span(rows, unit="_N") if "mean_friction_N" in rows else ""]
    known = rows[rows["error"].notna()]
    if known.empty:
        return [*spans, *[""] * 4]
    worst = known.loc[known["error"].idxmax()]
    above = int(above_tolerance(run, known).sum())
    kinds = joined_values(known["error_kind"].dropna().unique())
    at = setting(run.speed, worst[run.speed])
    return [*spans, size(float(worst["error"])), at, kinds, counted(above, "point") if above else ""]


def above_tolerance(run: Facts, rows: pd.DataFrame) -> pd.Series:
    """Which rows have a larger error than asked for; of a long-time mean none is asked."""
    return (rows["error"] > run.saved.study.tolerance) & (rows["error_kind"] != "statistical")


def onset_grid(run: Facts) -> Grid:
    """The onsets of onsets.csv, each with its error, curve by curve; nothing where the study asks for none."""
    onsets = run.saved.shown_onsets
    if onsets is None:
        return NOTHING
    curves = run.curves_of(onsets)
    rows = (
        [
            *who,
            row["onset"].replace("_", " "),
            with_error(*run.speed_in_given_units(curve, row, "belt_speed")),
            row["how"],
        ]
        for who, curve in zip(whose(curves), curves, strict=True)
        for _, row in curve.rows.iterrows()
    )
    speed = Markup("belt speed{}").format(unit_html(run.speed))
    head = ["law", "method", "curve", "what", speed, "how it was found"]
    return grid("Onsets along rising belt speed", head, rows, "onsets", "onsets.csv", len(onsets))


def shape_grid(run: Facts) -> Grid:
    """The measures of curves.csv, each with its error, the verdict first; nothing where no curve has a shape."""
    table = run.saved.curves
    own = (
        [] if table is None else [name for name in SHAPE_HEADS if name in table and table[name].notna().any()]
    )
    if table is None or {*own} <= {"reversal_end", "reduction"}:
        return NOTHING
    curves, unit = run.curves_of(table), unit_html(run.speed)
    rows = (
        [*who, *(_measure(run, curve, row, name) for name in own)]
        for who, curve in zip(whose(curves), curves, strict=True)
        for row in [curve.rows.iloc[0]]
    )
    heads = [Markup("{}{}").format(SHAPE_HEADS[name], unit if name in ALSO_IN_SI else "") for name in own]
    caption = "Shape of each curve against its chord, the line from rest to the end of reversal"
    found = grid(caption, ["law", "method", "curve", *heads], rows, "curves", "curves.csv", len(table))
    missing = [
        f"A measure is missing of {counted(count, 'curve')}: {why}." for count, why in why_missing(table)
    ]
    return found._replace(below=" ".join(filter(None, [found.below, *missing])))


def _measure(run: Facts, curve: CurveRows, row: pd.Series, name: str) -> Cell:
    if isinstance(row[name], str):
        return row[name]
    if pd.isna(row[name]):
        return ""
    if name in ALSO_IN_SI:
        return with_error(*run.speed_in_given_units(curve, row, name))
    return (
        size(row[name])
        if name == "model_distance"
        else with_error(float(row[name]), row.get(f"{name}_error"))
    )


def why_missing(curves: pd.DataFrame) -> list[tuple[int, str]]:
    """Why measures are missing: how many curves have each reason, and the reason, the commonest first."""
    reasons = curves["reason"].dropna()
    kinds = [kind for _, kind in reasons.groupby(reasons.map(pattern), sort=False)]
    return [(len(kind), alike(kind)) for kind in sorted(kinds, key=len, reverse=True)]


def pair_grids(run: Facts) -> list[Grid]:
    """Every two laws, and every two methods law by law: where their means differ most, and by how much."""
    caption = "{} in pairs: the largest difference of their mean friction at the same point"
    head = ["law", "pair", "largest difference", "at", "points that differ by more than their errors"]
    pairs = {"Laws": law_pairs(run.table), "Methods": run.method_pairs}
    return [grid(caption.format(who), head, [*map(_pair, found)], "pairs") for who, found in pairs.items()]


def _pair(pair: Difference) -> list[Cell]:
    """Within the errors, which may be wide, what is found is told, too."""
    same = "" if pair.apart else "the same within errors: "
    differs = f"{same}{with_error(pair.value, pair.error)}"
    counts = f"{pair.apart} of {pair.shared}"
    return [pair.law, f"{pair.one} \N{MINUS SIGN} {pair.other}", differs, settings(pair.where), counts]


def whole_grid(run: Facts) -> Grid:
    """Every number of a table of very few rows, a column for each point; nothing of a longer one.

    In SI units where the scene is given so; an error beside the number that it is of.
    """
    table = run.table
    if len(table) > FEW_ROWS:
        return NOTHING
    shown = by_plain_names(table)
    in_si = [name for name in SI if name in shown]
    names = [*RESULTS, *in_si]
    left = {*TOLD_ELSEWHERE, *map(_error_of, names), *(SI[name].column for name in in_si)}
    points = [row for _, row in table.iterrows()]
    rows: list[list[Cell]] = []
    for name in names:
        if (name == "mean_friction" or name not in left) and table[shown[name]].notna().any():
            symbol, words = symbol_html(name), name.replace("_", " ")
            if name in IN_SI_UNITS:
                words = f"{SI[name].column.replace('_', ' ')} [{unit_html(shown[name]).strip()}]"
            quantity = words if str(symbol) == words else Markup("{} {}").format(words, symbol)
            rows.append(
                [quantity, *(_written(row, shown[name], shown.get(_error_of(name))) for row in points)]
            )
    told = [
        Markup("{} by {}, {}").format(row["law"], row["method"], settings(run.where(row))) for row in points
    ]
    return grid("Every number found", ["quantity", *told], rows)


def _error_of(name: str) -> str:
    """The column with the error of another."""
    if name.startswith("mean_friction"):
        return name.replace("mean_friction", "error")
    return f"{name.removesuffix('_J')}_error_J" if name.endswith("_J") else f"{name}_error"


def _written(row: pd.Series, name: str, of_error: str | None) -> str:
    value, error = row[name], None if of_error is None else row[of_error]
    if isinstance(value, str):
        return value
    return with_error(value, error, MOST_DIGITS if error is None or pd.isna(error) else MOST_OF_A_POINT)


def models_grid(run: Facts) -> Grid:
    """What produced the numbers: each model of the table, its sentence, and how many points it produced."""
    head = ["method", "model", "what it is, and why", "points", "laws"]
    rows = _by_sentence(run.table, "method", run.table["model"])
    told = [
        [method, model, "" if (said := model_in_sentences(model)) == model else said, *who]
        for method, model, *who in rows
    ]
    return grid("What produced the numbers", head, told, "models")


def uniqueness_grid(run: Facts) -> Grid:
    """How it is known of points that no start ends elsewhere, in sentences; by how many points."""
    head, unique = ["unique", "how it is known", "points", "laws"], run.table["unique"]
    proved, tested = (
        each_once(run.table["model"].fillna(""), why_unique_in_words),
        each_once(run.table["reason"], _how_tested),
    )
    how = proved.where(unique == "proved", tested).mask(unique == "no", "other starts end elsewhere")
    rows = _by_sentence(run.table, "unique", how)
    return grid("Whether every start ends there", head, rows, "kinds")


def _by_sentence(table: pd.DataFrame, by: str, sentences: pd.Series) -> list[list[Cell]]:
    """Cells of a column with a sentence that they share but for its numbers, and how many points of which laws."""
    told = table[["law", by]].assign(said=sentences)[table[by].notna() & sentences.notna()]
    groups = told.groupby([told[by], each_once(told["said"], pattern)], sort=False)
    return [
        [
            str(cell),
            alike(rows["said"].unique()),
            counted(len(rows), "point"),
            joined_values(rows["law"].unique()),
        ]
        for (cell, _), rows in groups
    ]


def _how_tested(reason: Any) -> str:
    """Of the sentences of a reason the one on starts; nothing where there is none."""
    return next(
        (each.removeprefix(SAYS_TESTED) for each in str(reason).split("; ") if each.startswith(SAYS_TESTED)),
        "",
    )


def verdicts_grid(verdicts: Sequence[Verdict]) -> Grid:
    """What was expected and whether it is so, what failed first."""
    rows = [[VERDICTS[each.passed], each.sentence] for each in sorted(verdicts, key=lambda each: each.passed)]
    return grid("What the study expects of its table", ["verdict", "expectation: what was found"], rows)


def with_remark(run: Facts) -> pd.Series:
    """Which rows are ok with something to note; no model's own error, nor that starts were tested."""
    full, told = ~run.table["method"].isin(run.reduced), run.table["reason"].fillna(SAYS_TESTED)
    return (run.table["status"] == "ok") & full & ~told.str.startswith(SAYS_TESTED)


def trouble_grid(run: Facts) -> Grid:
    """Every point that is not plainly ok, those of like reasons together, with examples."""
    odd = run.table[(run.table["status"] != "ok") | with_remark(run)]
    odd = odd.assign(reason=odd["reason"].map(_without_test, na_action="ignore"))
    groups = odd.groupby([odd["status"], odd["reason"].map(pattern)], sort=False)
    ordered = sorted(groups, key=lambda group: (group[0][0] == "ok", -len(group[1])))
    rows = [_trouble(run, str(status), rows) for (status, _), rows in ordered]
    head = ["status", "points", "reason", "laws", "methods", "for example"]
    return grid("Points that are not plainly ok", head, rows, "reasons")


def _without_test(reason: str) -> str:
    """How starts were tested is told once, of all points."""
    return reason.partition(f"; {SAYS_TESTED}")[0]


def _trouble(run: Facts, status: str, rows: pd.DataFrame) -> list[Cell]:
    told = Markup("; ").join(_example(run, row) for _, row in rows.head(MOST_EXAMPLES).iterrows())
    left = len(rows) - MOST_EXAMPLES
    more = f"; and {counted(left, 'point')} more" if left > 0 else ""
    words = status.replace("_", " ") if status != "ok" else "ok, but"
    who = joined_values(rows["law"].unique()), joined_values(rows["method"].unique())
    return [words, str(len(rows)), alike(rows["reason"].fillna("")), *who, told + more]


def _example(run: Facts, row: pd.Series) -> Markup:
    place = settings(run.where(row))
    if pd.isna(row["mean_low"]):
        return place
    low, high = number(row["mean_low"]), number(row["mean_high"])
    window = "" if pd.isna(row["window"]) else f" over {counted(round(row['window']), 'period')}"
    return Markup("{}: means from {} to {}{}").format(place, low, high, window)
