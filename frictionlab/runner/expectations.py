"""Check of the expectations of a study: passed or failed, and a sentence that says by how much."""

from __future__ import annotations

from collections.abc import Container, Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from frictionlab.runner.table import swept_inputs
from frictionlab.runner.words import counted, in_words
from frictionlab.study.expectations import CLAIMED, Expectation, WhereValue
from frictionlab.values.columns import BELT_SPEED, INPUTS, belt_speed, given
from frictionlab.values.printable import with_error

# Numbers of a study are written in decimal and swept by formula: equal means equal to nine digits.
_SAME = 1e-9

_VERDICTS = {"area": "shape", "initial": "shape_by_initial"}
_BY = {"area": "area", "initial": "initial curvature"}


@dataclass(frozen=True)
class Verdict:
    """Judgement on an expectation: whether it held, and what was found against what was claimed."""

    passed: bool
    sentence: str


def judge(expectation: Expectation, table: pd.DataFrame, curves: pd.DataFrame) -> Verdict:
    """Return the verdict on one expectation, which must hold for every row or curve it speaks of; none at all fails.

    curves: the table of curves that goes with the table.
    """
    whole = curves if expectation.of_curves else table
    if expectation.column is not None and expectation.column not in whole:  # that no row has
        whole = whole.assign(**{expectation.column: np.nan})
    rows = _matching(expectation.where, whole)
    if rows.empty:
        found = Verdict(False, "no row of the table matches")
    elif expectation.shape is not None:
        found = _shape(expectation, rows)
    elif expectation.max_difference is not None:
        found = _difference(expectation, rows)
    elif expectation.status is not None:
        found = _status(expectation.status, rows)
    elif expectation.minus is not None or expectation.over is not None:
        found = _beside(expectation, rows, whole)
    else:
        found = _comparison(expectation, rows)
    return Verdict(found.passed, f"{_about(expectation)}: {found.sentence}")


def expected_failures(expectations: Iterable[Expectation], table: pd.DataFrame) -> int:
    """Count the failed rows that a study expects to fail."""
    failed = table[table["status"] == "failed"]
    expected = [_matching(each.where, failed).index for each in expectations if each.status == "failed"]
    return len(set().union(*expected))


def _matching(where: dict[str, WhereValue], table: pd.DataFrame) -> pd.DataFrame:
    if any(column not in table for column in where):
        return table.iloc[:0]
    chosen = np.ones(len(table), np.bool_)
    for column, wanted in where.items():
        chosen &= _is(wanted, table[column])
    return table[chosen]


def _is(wanted: WhereValue, values: pd.Series) -> Any:
    """Select the values that are as wanted."""
    if isinstance(wanted, list):
        return np.any([_is(one, values) for one in wanted], axis=0)
    if isinstance(wanted, str):
        return (values == wanted).to_numpy(dtype=bool)
    numbers = values.to_numpy(dtype=float)
    ends = wanted if isinstance(wanted, dict) else {"from": wanted, "to": wanted}
    slack = _SAME * np.abs(numbers)
    return (ends.get("from", -np.inf) - slack <= numbers) & (numbers <= ends.get("to", np.inf) + slack)


def _about(expectation: Expectation) -> str:
    where = _chosen(expectation.where)
    return " ".join(
        part
        for part in (
            _claim(expectation),
            f"where {where}" if where else "everywhere",
            f"({expectation.because})" if expectation.because else "",
        )
        if part
    )


def _chosen(where: dict[str, WhereValue]) -> str:
    """Return what selects rows, in words."""
    return ", ".join(f"{column} {_wanted(value)}" for column, value in where.items())


def _wanted(value: WhereValue) -> str:
    if isinstance(value, dict):
        return " ".join(f"{end} {in_words(number)}" for end, number in value.items())
    return " or ".join(map(in_words, value)) if isinstance(value, list) else in_words(value)


def _claim(expectation: Expectation) -> str:
    if expectation.max_difference is not None:
        first, second = expectation.max_difference
        return f"|{first} - {second}| of mean_friction below {in_words(expectation.below)}"
    if expectation.status is not None:
        return f"status {expectation.status}"
    if expectation.shape is not None:
        return f"{expectation.shape} by {_BY[expectation.measure or 'area']}"
    within = f" within {in_words(expectation.within)}" if expectation.within is not None else ""
    name, value = _comparator(expectation)
    beside = (("less", expectation.minus), ("over", expectation.over))
    of = "".join(f" {how} that where {_chosen(other)}" for how, other in beside if other is not None)
    return f"{expectation.column}{of} {name} {in_words(value)}{within}"


def _comparator(expectation: Expectation) -> tuple[str, float]:
    for name in CLAIMED:
        value = getattr(expectation, name)
        if value is not None:
            return name, value
    raise ValueError("an expectation without a comparison")


def _comparison(expectation: Expectation, rows: pd.DataFrame) -> Verdict:
    """Worst row decides: the one that is furthest on the wrong side."""
    assert expectation.column is not None
    values = rows[expectation.column].astype(float)
    if values.isna().any():
        return Verdict(False, f"{expectation.column} is empty in {_first(rows[values.isna()])}")
    name, value = _comparator(expectation)
    within = expectation.within or 0.0
    excess = {"equals": (values - value).abs(), "below": values - value, "above": value - values}[name]
    worst = excess.idxmax()
    passed = excess[worst] <= within if name == "equals" else excess[worst] < within or excess[worst] < 0
    return Verdict(bool(passed), f"{in_words(values[worst])}{_worst(rows, worst, 'row', bool(passed))}")


def _status(wanted: str, rows: pd.DataFrame) -> Verdict:
    others = rows[rows["status"] != wanted]
    if others.empty:
        return Verdict(True, f"so in {_count(rows)}")
    return Verdict(False, f"not so in {len(others)} of {_count(rows)}: {_first(others)}")


def _shape(expectation: Expectation, curves: pd.DataFrame) -> Verdict:
    """Check of the shape of every curve; the sentence names the first that differs or is unknown."""
    measure = expectation.measure or "area"
    verdicts = curves[_VERDICTS[measure]]
    others = curves[verdicts != expectation.shape]
    row = (curves if others.empty else others).iloc[0]
    verdict, number = row[_VERDICTS[measure]], f"shape_{measure}"
    told = f"{row['reason']}" if pd.isna(verdict) else f"{verdict}, {_measured(row, number)}"
    if others.empty:
        return Verdict(True, told if len(curves) == 1 else f"so are {len(curves)} curves; the first: {told}")
    which = f" in the first of {len(others)} of {len(curves)} curves, {_whose(curves, row)}"
    return Verdict(False, f"{told}{which}" if len(curves) > 1 else told)


def _measured(row: pd.Series, name: str) -> str:
    return with_error(float(row[name]), float(row[f"{name}_error"]), between=" +- ")


def _difference(expectation: Expectation, rows: pd.DataFrame) -> Verdict:
    """Return the two methods, scene by scene and law by law; each must have a number where the other does."""
    assert expectation.max_difference is not None
    assert expectation.below is not None
    first, second = (rows[rows["method"] == label] for label in expectation.max_difference)
    pairs = _pairs(first, second, {"method"}, "mean_friction")
    if pairs.empty:
        return Verdict(False, "neither method has a row that matches")
    if missing := _missing(pairs, "mean_friction"):
        return missing
    apart = (pairs["mean_friction"] - pairs["mean_friction other"]).abs()
    worst, passed = float(apart.max()), bool(apart.max() < expectation.below)
    return Verdict(passed, f"{in_words(worst)}{_worst(pairs, apart.idxmax(), 'pair', passed)}")


def _beside(expectation: Expectation, rows: pd.DataFrame, table: pd.DataFrame) -> Verdict:
    """Column less, or over, that of the rows with other inputs; rows that have these themselves are left out."""
    assert expectation.column is not None
    differ = expectation.minus or expectation.over or {}
    equal = {name: value for name, value in expectation.where.items() if not _differs(name, differ)}
    others = _matching(equal | differ, table)
    rows = rows.drop(others.index, errors="ignore")
    if others.empty or rows.empty:
        return Verdict(False, f"no row of the table matches {_chosen(differ)}, or none beside it")
    pairs = _pairs(rows, others, differ, expectation.column)
    if missing := _missing(pairs, expectation.column):
        return missing
    own, other = pairs[expectation.column], pairs[f"{expectation.column} other"]
    compared = own - other if expectation.minus is not None else own / other
    return _comparison(expectation, pairs.assign(**{expectation.column: compared}))


def _pairs(rows: pd.DataFrame, others: pd.DataFrame, differ: Container[str], column: str) -> pd.DataFrame:
    """Rows beside those whose inputs are equal but for those that differ, the others' number beside their own."""
    keys = [name for name in (*INPUTS, *given(rows.columns)) if name in rows and not _differs(name, differ)]
    return rows.merge(others[[*keys, column]], on=keys, suffixes=("", " other"), how="outer")


def _differs(name: str, differ: Container[str]) -> bool:
    """Check whether an input is one that differs, or follows from the law where that does."""
    return name in differ or ("law" in differ and (name == "kind" or name.startswith("law.")))


def _missing(pairs: pd.DataFrame, column: str) -> Verdict | None:
    """Return the verdict on pairs of rows of which some lack a row or its number."""
    missing = int(pairs[[column, f"{column} other"]].isna().any(axis=1).sum())
    told = f"{column} is missing in {missing} of {len(pairs)} pairs of rows"
    return Verdict(False, told) if missing else None


def _first(rows: pd.DataFrame) -> str:
    """Return the first of some rows in words: its status and why."""
    row = rows.iloc[0]
    status = f", {row['status']}" if "status" in row else ""  # curves have none
    reason = f": {row['reason']}" if isinstance(row["reason"], str) and row["reason"] else ""
    return f"the row {_whose(rows, row)}{status}{reason}"


def _whose(rows: pd.DataFrame, row: pd.Series) -> str:
    """Law, method, belt speed and what else differs between rows, of one of them."""
    speed = belt_speed(rows)
    unit = "" if speed == BELT_SPEED else " m/s"
    told = [f"belt speed {in_words(row[speed])}{unit}"] if speed in rows else []
    told += [f"{name.removeprefix('scene.')} {in_words(row[name])}" for name in swept_inputs(rows)]
    return f"of {row['law']} by {row['method']}{' at ' if told else ''}{', '.join(told)}"


def _worst(rows: pd.DataFrame, at: Any, what: str, passed: bool) -> str:
    """Tell of how many rows or pairs of rows a number is the worst; of a claim that fails, whose it is."""
    if len(rows) == 1:
        return ""
    told = f" in the worst of {len(rows)} {what}s"
    return told if passed else f"{told}, that {_whose(rows, rows.loc[at])}"


def _count(rows: pd.DataFrame) -> str:
    return counted(len(rows), "row")
