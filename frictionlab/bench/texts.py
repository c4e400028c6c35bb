"""Tables of a bench as they are read: numbers to few digits, and in brief."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

import pandas as pd

TARGETS = (1e-3, 1e-6, 1e-9, 1e-12)
MICROSECONDS = "\N{GREEK SMALL LETTER MU}s"
NO_NUMBER = ("refused", "failed", "not_unique")


def size_text(error: Any) -> str:
    """An error to two digits; empty where there is none."""
    return "" if error in ("", None) or float(error) != float(error) else f"{float(error):.1e}"


def micro_text(time: Any) -> str:
    """A time in microseconds to three digits; empty where there is none."""
    if time == "" or float(time) != float(time):
        return ""
    return f"{float(time):,.0f}" if float(time) >= 1000.0 else f"{float(time):.3g}"


def cell_text(text: float | str) -> str:
    """A number to four digits, whole ones as they are; other text as it is."""
    try:
        value = float(text)
    except ValueError:
        return str(text)
    if not math.isfinite(value):
        return str(text)
    plain = value == int(value) and abs(value) < 1e6 and "." not in str(text).removesuffix(".0")
    return f"{value:g}" if plain else f"{value:.4g}"


def remark(row: Mapping[str, Any]) -> str:
    """Tell what has no number, how often and why."""
    told = [f"{row[each]} {each.replace('_', ' ')}" for each in NO_NUMBER if int(row[each])]
    return ": ".join(part for part in (", ".join(told), row["reason"]) if part)


def who(row: Mapping[str, Any]) -> str:
    """Return the label of a method, or of a peer, which is said."""
    return str(row["solver"]) + (" (peer)" if row["side"] == "peer" else "")


CURVE_CELLS: dict[str, Callable[[Mapping[str, Any]], str]] = {
    "solver": who,
    "setting": lambda row: f"{row['quantity']} {cell_text(row['value'])}" if row["quantity"] else "as is",
    "points": lambda row: row["points"],
    "largest error": lambda row: size_text(row["largest_error"]),
    "median error": lambda row: size_text(row["median_error"]),
    "stated error": lambda row: size_text(row["stated_error"]),
    "covered": lambda row: f"{row['covered']}/{row['ok']}" if row["covered"] and int(row["ok"]) else "",
    f"mean and error, {MICROSECONDS}": lambda row: micro_text(row["mean_us"]),
    f"model alone, {MICROSECONDS}": lambda row: micro_text(row["model_us"]),
    f"its error alone, {MICROSECONDS}": lambda row: micro_text(row["error_us"]),
    f"every column, {MICROSECONDS}": lambda row: micro_text(row["all_us"]) if row["side"] == "method" else "",
    f"quartiles of mean and error, {MICROSECONDS}": lambda row: ", ".join(
        filter(None, (micro_text(row[f"mean_us_q{i}"]) for i in (1, 2, 3)))
    ),
    "first run, s": lambda row: cell_text(row["first_run_s"]),
    "remark": remark,
}
"""Columns of a curve's table to read, from a row of its file."""


def curve_cells(table: pd.DataFrame) -> pd.DataFrame:
    """Return the file of a curve as text to read."""
    rows = table.to_dict("records")
    return pd.DataFrame({head: [made(row) for row in rows] for head, made in CURVE_CELLS.items()})


def any_cells(table: pd.DataFrame) -> pd.DataFrame:
    """Another file as text to read, numbers to four digits."""
    return table.map(cell_text).rename(columns=lambda name: name.replace("_", " "))


def without_empty(table: pd.DataFrame) -> pd.DataFrame:
    """Return the columns of texts that are not empty in every row."""
    return table.loc[:, (table != "").any()]


def markdown_lines(table: pd.DataFrame) -> list[str]:
    """A table of texts as lines of Markdown."""
    lines = [[*table.columns], ["---"] * len(table.columns), *table.to_numpy().tolist()]
    return [f"| {' | '.join(line)} |" for line in lines]


def least_times(table: pd.DataFrame, target: float) -> pd.Series:
    """Least time per point [us] of each solver, at settings that answer every point to this largest error."""
    numbers = table[["ok", "points", "largest_error", "mean_us"]].apply(pd.to_numeric)
    good = (numbers["ok"] == numbers["points"]) & (numbers["largest_error"] <= target)
    return numbers.loc[good, "mean_us"].groupby(table["solver"][good]).min().dropna()


def fastest(table: pd.DataFrame, side: str, target: float) -> str:
    """Return the least time per point to this largest error, and whose it is; a dash where nothing comes so near."""
    near = least_times(table[table["side"] == side], target)
    return f"{micro_text(near.min())} by {near.idxmin()}" if len(near) else "-"


def curve_summary(name: str, table: pd.DataFrame) -> str:
    """Return the time per point to reach an error, for every contender, with the ratio to the best method."""
    title = f"{name}: us per point to a largest error of (times the best method's)"
    if table.empty:
        return title
    best = [least_times(table[table["side"] == "method"], target).min() for target in TARGETS]
    near = [least_times(table, target) for target in TARGETS]
    wide = max(map(len, table["solver"])) + 7
    lines = [title, " " * wide + "".join(f"{target:>22.0e}" for target in TARGETS)]
    for label, own in table.groupby("solver", sort=False):
        times = [each.get(label, math.nan) for each in near]
        told = "".join(f"{_ratio(time, of):>22}" for time, of in zip(times, best, strict=True))
        if all(time != time for time in times):
            told = f"  {_short_of_all(own)}"
        lines.append(f"{who(own.iloc[0]):<{wide}}{told}")
    return "\n".join(lines)


def _ratio(time: float, best: float) -> str:
    if time != time:
        return "-"
    times = time / best
    ratio = f"{times:,.0f}" if times >= 100.0 else f"{times:.2g}"
    return f"{micro_text(time)} ({ratio})" if best == best else micro_text(time)


def _short_of_all(own: pd.DataFrame) -> str:
    """Tell what a contender that reaches no target comes to: its least error, or why there is none."""
    known = own.dropna(subset="largest_error").sort_values("largest_error", kind="stable")
    if known.empty or known["ok"].iloc[0] < known["points"].iloc[0]:
        return next(filter(None, map(remark, own.to_dict("records"))), "")
    return (
        f"no nearer than {known['largest_error'].iloc[0]:.1e}, in {micro_text(known['mean_us'].iloc[0])} us"
    )
