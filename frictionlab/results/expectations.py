"""Check of the expectations of a study: passed or failed, and a sentence that says by how much."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pandas as pd

from frictionlab.columns import BELT_SPEED, INPUTS, belt_speed
from frictionlab.printable import with_error
from frictionlab.results.words import counted, in_words
from frictionlab.study import Expectation

# Numbers of a study are written in decimal and swept by formula: equal means equal to nine digits.
_SAME = 1e-9

_VERDICTS = {"area": "shape", "initial": "shape_by_initial"}
_BY = {"area": "area", "initial": "initial curvature"}


@dataclass(frozen=True)
class Verdict:
    """Whether an expectation held, and what was found against what was claimed."""

    passed: bool
    sentence: str


def judge(expectation: Expectation, table: pd.DataFrame, curves: pd.DataFrame) -> Verdict:
    """The verdict on one expectation, which must hold for every row or curve it speaks of; none at all fails.

    curves: the table of curves that goes with the table.
    """
    rows = _matching(expectation.where, table if expectation.shape is None else curves)
    if rows.empty:
        found = Verdict(False, "no row of the table matches")
    elif expectation.shape is not None:
        found = _shape(expectation, rows)
    elif expectation.max_difference is not None:
        found = _difference(expectation, rows)
    elif expectation.status is not None:
        found = _status(expectation.status, rows)
    else:
        found = _comparison(expectation, rows)
    return Verdict(found.passed, f"{_about(expectation)}: {found.sentence}")


def _matching(where: dict[str, str | float], table: pd.DataFrame) -> pd.DataFrame:
    chosen = np.ones(len(table), np.bool_)
    for column, wanted in where.items():
        if column not in table:
            return table.iloc[:0]
        if isinstance(wanted, str):
            chosen &= (table[column] == wanted).to_numpy(dtype=bool)
        else:
            values = table[column].to_numpy(dtype=float)
            chosen &= np.abs(values - wanted) <= _SAME * np.maximum(np.abs(values), abs(wanted))
    return table[chosen]


def _about(expectation: Expectation) -> str:
    where = ", ".join(f"{column} {in_words(value)}" for column, value in expectation.where.items())
    return " ".join(
        part
        for part in (
            _claim(expectation),
            f"where {where}" if where else "everywhere",
            f"({expectation.because})" if expectation.because else "",
        )
        if part
    )


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
    return f"{expectation.column} {name} {in_words(value)}{within}"


def _comparator(expectation: Expectation) -> tuple[str, float]:
    for name in ("equals", "below", "above"):
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
    return Verdict(bool(passed), f"{in_words(values[worst])}{_largest_error(rows, 'row')}")


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
    which = f" in the first of {len(others)} of {len(curves)} curves" if len(curves) > 1 else ""
    return Verdict(False, f"{told}{which}")


def _measured(row: pd.Series, name: str) -> str:
    return with_error(float(row[name]), float(row[f"{name}_error"]), between=" +- ")


def _difference(expectation: Expectation, rows: pd.DataFrame) -> Verdict:
    """The two methods, scene by scene and law by law; each must have a number where the other does."""
    assert expectation.max_difference is not None
    assert expectation.below is not None
    first, second = (rows[rows["method"] == label] for label in expectation.max_difference)
    keys = _inputs(rows)
    pairs = first.merge(second, on=keys, suffixes=("", " other"), how="outer")
    if pairs.empty:
        return Verdict(False, "neither method has a row that matches")
    differences = (pairs["mean_friction"] - pairs["mean_friction other"]).abs()
    missing = int(differences.isna().sum())
    if missing:
        return Verdict(False, f"a mean is missing in {missing} of {len(pairs)} pairs of rows")
    worst = float(differences.max())
    return Verdict(worst < expectation.below, f"{in_words(worst)}{_largest_error(pairs, 'pair')}")


def _inputs(rows: pd.DataFrame) -> list[str]:
    """The input columns, without the method."""
    return [
        str(column)
        for column in rows.columns
        if (column in INPUTS and column != "method") or str(column).startswith(("scene.", "law."))
    ]


def _first(rows: pd.DataFrame) -> str:
    """The first of some rows in words: its status and why."""
    row = rows.iloc[0]
    reason = f": {row['reason']}" if isinstance(row["reason"], str) and row["reason"] else ""
    speed = belt_speed(rows)
    unit = "" if speed == BELT_SPEED else " m/s"
    scene = f" at belt speed {in_words(row[speed])}{unit}" if speed in rows else ""
    return f"the row of {row['law']} by {row['method']}{scene}, {row['status']}{reason}"


def _largest_error(rows: pd.DataFrame, what: str) -> str:
    """How many rows or pairs of rows a number speaks for, where it is more than one."""
    return f" in the worst of {len(rows)} {what}s" if len(rows) > 1 else ""


def _count(rows: pd.DataFrame) -> str:
    return counted(len(rows), "row")
