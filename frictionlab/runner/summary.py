"""Summary of a run in a few lines of text: a line per curve, verdicts on expectations, path of the table."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd

from frictionlab.runner.expectations import Verdict
from frictionlab.runner.results import Results
from frictionlab.runner.table import swept_inputs
from frictionlab.runner.words import counted, in_words
from frictionlab.scene.dimensional import without_unit
from frictionlab.values.columns import SHOWN_IN, belt_speed
from frictionlab.values.printable import PLUS_MINUS, with_error
from frictionlab.values.units import in_shown_units

RowArrays = Mapping[str, np.ndarray]
"""Columns of some rows of a table."""
_NUMBER = re.compile(r"[-+]?\d+(?:\.\d*)?(?:e[-+]?\d+)?", re.IGNORECASE)


def pattern(sentence: Any) -> str:
    """Replace each number of a text by #; return '' for anything but a text."""
    return _NUMBER.sub("#", sentence) if isinstance(sentence, str) else ""


def each_once(column: pd.Series, told: Callable[[Any], str]) -> pd.Series:
    """Apply ``told`` to each cell; it is called once per distinct value."""
    places, different = pd.factorize(column, use_na_sentinel=False)
    return pd.Series(np.array([told(each) for each in different], dtype=object)[places], column.index)


def alike(sentences: Iterable[str]) -> str:
    """Merge sentences that differ only in numbers: each number that differs becomes 'least ... greatest'."""
    first, *others = dict.fromkeys(sentences)
    values = zip(*(_NUMBER.findall(each) for each in (first, *others)), strict=False)
    ends = iter([" ... ".join(dict.fromkeys((min(one, key=float), max(one, key=float)))) for one in values])
    return _NUMBER.sub(lambda found: next(ends, found[0]), first)


MOST_REASONS = 10
SEVERAL_STATES = "not_unique: keep: {attractors: 8} lists the states, scene.initial chooses one"
WORDS_OF_MODELS = "words of models in full: frictionlab columns"
CURVES_TOLD = 20
"""Largest number of curves that a summary lists, one line each."""


def summary(run: Results) -> str:
    """Write the results of a run as text: curves, models, reasons, verdicts, path of the table."""
    table = in_shown_units(run.shown, run.study.units)
    told = ", ".join(f"{count} {status}" for status, count in run.counts.items())
    parts = [
        [run.study.title] if run.study.title else [],
        [f"{counted(run.size, 'point')}: {told}"],
        [f"of {counted(len(table), 'point')} spread over them:"] if run.is_thinned else [],
        ["", *_curve_lines(table)],
        _model_lines(table),
        _reasons(table),
        [SEVERAL_STATES] * (run.counts.get("not_unique", 0) > 0 and run.study.keep.attractors is None),
        verdict_lines(run.verdicts),
        [f"table in {run.table_file}"] if run.table_file else [],
    ]
    return "\n".join(line for part in parts for line in part)


_HEAD = ("law", "method", "curve", "points", "mean_friction", "largest error", "model")


def _curve_lines(table: pd.DataFrame) -> list[str]:
    """Write one line per curve, for the first ``CURVES_TOLD`` curves.

    Points of a curve differ only in belt speed.
    """
    keys = ["law", "method", *swept_inputs(table)]
    groups = table.groupby(keys, sort=False, dropna=False)
    models = _models(table)
    read = {name: table[name].to_numpy() for name in ("mean_friction", "error", "status", "model")}
    found = sorted(groups.indices.items(), key=lambda one: int(one[1].min()))
    lines = [
        _curve_line(dict(zip(keys, key, strict=True)), {name: read[name][at] for name in read}, models)
        for key, at in found[:CURVES_TOLD]
    ]
    left = len(found) - len(lines)
    return [*columns([_HEAD, *lines]), *([f"... and {counted(left, 'more curve')}"] if left else [])]


def _models(table: pd.DataFrame) -> dict[str, int]:
    """Return a number for each model, because its sentence is too long for the line of a curve.

    Models whose sentences differ only in numbers share one.
    """
    found = table["model"].dropna().unique()
    numbers = {form: number for number, form in enumerate(dict.fromkeys(map(pattern, found)), 1)}
    return {model: numbers[pattern(model)] for model in found}


def _model_lines(table: pd.DataFrame) -> list[str]:
    models = _models(table)
    groups = {number: [model for model in models if models[model] == number] for number in models.values()}
    told = [f"model {number}: {alike(group)}" for number, group in groups.items()]
    return [*told, WORDS_OF_MODELS] if told else []


def _curve_line(inputs: dict[str, Any], rows: RowArrays, models: dict[str, int]) -> tuple[str, ...]:
    law, method = str(inputs.pop("law")), str(inputs.pop("method"))
    where = ", ".join(_setting(name, x) for name, x in inputs.items() if x == x)
    errors = rows["error"][~np.isnan(rows["error"])]
    error = f"{errors.max():.1e}" if len(errors) else ""
    used = ", ".join(
        dict.fromkeys(str(models[each]) for each in dict.fromkeys(rows["model"]) if each in models)
    )
    return law, method, where, statuses(rows), mean_span(rows, " ... ", " +- "), error, used


def mean_span(
    rows: RowArrays | pd.DataFrame,
    to: str = " \N{HORIZONTAL ELLIPSIS} ",
    between: str = PLUS_MINUS,
    unit: str = "",
) -> str:
    """Write the least and the greatest mean friction of rows, each with its error; '' if none has a number.

    unit: end of the names of the columns, ``_N`` for a force.
    """
    means, errors = (np.asarray(rows[f"{name}{unit}"], dtype=float) for name in ("mean_friction", "error"))
    if np.isnan(means).all():
        return ""
    ends = int(np.nanargmin(means)), int(np.nanargmax(means))
    told = [with_error(float(means[end]), float(errors[end]), between=between) for end in ends]
    return to.join(dict.fromkeys(told))


def _setting(name: str, value: Any) -> str:
    """Write an input and its value, without the prefixes ``scene.`` and ``dimensional.``."""
    brief, _, unit = name.removeprefix("scene.").removeprefix("dimensional.").partition(SHOWN_IN)
    return f"{without_unit(brief)} {in_words(value)} {unit}" if unit else f"{brief} {in_words(value)}"


def statuses(rows: RowArrays | pd.DataFrame) -> str:
    """Count the rows of each status, in words."""
    return ", ".join(f"{count} {status}" for status, count in Counter(rows["status"]).most_common())


def columns(rows: Sequence[Sequence[str]]) -> list[str]:
    """Write rows of words as lines with aligned columns; columns empty below their head are left out."""
    kept = [column for column in zip(*rows, strict=True) if any(column[1:]) or len(rows) == 1]
    padded = [[cell.ljust(max(map(len, column))) for cell in column] for column in kept]
    return ["  ".join(line).rstrip() for line in zip(*padded, strict=True)]


def _reasons(table: pd.DataFrame) -> list[str]:
    """List the reasons of points that are not ok, the largest groups of points first.

    Points are grouped by law (and method, if there are several), status and the first words of the reason.
    """
    rest, by_methods = table[table["status"] != "ok"], table["method"].nunique() > 1
    whose = rest["law"] + (" by " + rest["method"] if by_methods else "")
    begins = each_once(rest["reason"], lambda reason: pattern(reason).partition(":")[0])
    groups = [rows for _, rows in rest.groupby([whose, rest["status"], begins], sort=False)]
    lines = [
        f"{whose[rows.index[0]]}, {len(rows)} {rows['status'].iloc[0]} at {_speeds(rows)}: {_first(rows['reason'])}"
        for rows in sorted(groups, key=len, reverse=True)
    ]
    more = [f"... and {len(lines) - MOST_REASONS} more reasons"] if len(lines) > MOST_REASONS else []
    return ["", *lines[:MOST_REASONS], *more] if lines else []


def _speeds(rows: pd.DataFrame) -> str:
    """Write the range of belt speeds of rows."""
    name = belt_speed(rows)
    _, _, unit = name.partition(SHOWN_IN)
    ends = dict.fromkeys(f"{end:.4g}" for end in (rows[name].min(), rows[name].max()))
    return f"belt speed{'s' if len(ends) > 1 else ''} {' ... '.join(ends)} {unit}".rstrip()


def _first(reasons: pd.Series) -> str:
    """Return the most frequent reason of a group and the number of its other reasons."""
    counts = reasons.value_counts()
    others = f" ({counted(len(counts) - 1, 'other')} in the table)" if len(counts) > 1 else ""
    return f"{next(iter(counts.index), '')}{others}"


def verdict_lines(verdicts: Sequence[Verdict]) -> list[str]:
    """Count the expectations that passed and failed; write out each failed one."""
    failed = [verdict for verdict in verdicts if not verdict.passed]
    counts = {"passed": len(verdicts) - len(failed), "FAILED": len(failed)}
    told = ", ".join(f"{count} {word}" for word, count in counts.items() if count)
    return [f"expect: {told}", *failed_lines(failed)] if verdicts else []


def failed_lines(verdicts: Sequence[Verdict]) -> list[str]:
    """Write a line for each expectation that failed."""
    return [f"expect FAILED: {verdict.sentence}" for verdict in verdicts if not verdict.passed]
