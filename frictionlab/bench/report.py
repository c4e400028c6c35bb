"""The rows of a curve, as tables to compute with (CSV), to read (Markdown, HTML), and in brief."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from frictionlab.bench.record import BENCH_STATUSES, Contender, ReferenceMeans, Row, cell

TARGETS = (1e-3, 1e-6, 1e-9, 1e-12)


def curve_record(row: Row, scene: str, law: str) -> dict[str, Any]:
    """A row as the CSV holds it; times in microseconds per point, empty where there is none."""
    told: dict[str, Any] = {
        "scene": scene,
        "law": law,
        "solver": row.contender.label,
        "side": row.contender.side,
        "quantity": row.setting.quantity,
        "value": row.setting.value if row.setting.quantity else "",
        "points": row.points,
        **row.counts,
        "largest_error": cell(row.largest),
        "median_error": cell(row.median),
        "stated_error": cell(row.stated),
        "covered": "" if row.covered is None else row.covered,
    }
    for name, times in (("mean", row.mean), ("all", row.whole), ("model", row.model)):
        values = (times.least, *times.quartiles)
        names = (f"{name}_us", f"{name}_us_q1", f"{name}_us_q2", f"{name}_us_q3")
        told |= dict(zip(names, (cell(1e6 * value) for value in values), strict=True))
        told[f"{name}_repeats"] = times.repeats
    told["error_us"] = cell(1e6 * row.error_alone)
    told["first_run_s"] = cell(row.first)
    told["reference"] = row.reference.label if row.reference else ""
    told["reference_error"] = cell(largest(row.reference.errors) if row.reference else math.nan)
    return told | {"reason": row.reason}


def largest(values: Any) -> float:
    """The largest number among some, NaN where there is none."""
    return max((float(value) for value in values if math.isfinite(value)), default=math.nan)


CURVE_CELLS: dict[str, Callable[[Mapping[str, Any]], str]] = {
    "solver": lambda row: row["solver"] + (" (peer)" if row["side"] == "peer" else ""),
    "setting": lambda row: f"{row['quantity']} {cell_text(row['value'])}" if row["quantity"] else "as is",
    "points": lambda row: str(row["points"]),
    "largest error": lambda row: _size(row["largest_error"]),
    "median error": lambda row: _size(row["median_error"]),
    "stated error": lambda row: _size(row["stated_error"]),
    "covered": lambda row: (
        "" if row["covered"] == "" or not int(row["ok"]) else f"{row['covered']}/{row['ok']}"
    ),
    "mean and error, \N{GREEK SMALL LETTER MU}s": lambda row: _micro(row["mean_us"]),
    "model alone, \N{GREEK SMALL LETTER MU}s": lambda row: _micro(row["model_us"]),
    "its error alone, \N{GREEK SMALL LETTER MU}s": lambda row: _micro(row["error_us"]),
    "every column, \N{GREEK SMALL LETTER MU}s": lambda row: (
        _micro(row["all_us"]) if row["side"] == "method" else ""
    ),
    "quartiles of mean and error, \N{GREEK SMALL LETTER MU}s": lambda row: ", ".join(
        filter(None, (_micro(row[f"mean_us_q{i}"]) for i in (1, 2, 3)))
    ),
    "first run, s": lambda row: cell_text(row["first_run_s"]),
    "remark": lambda row: _remark({status: int(row[status]) for status in BENCH_STATUSES}, row["reason"]),
}
"""The columns of a curve's table to read, from a record or a row of its file."""


def readable_rows(records: Sequence[Mapping[str, Any]]) -> tuple[list[str], list[list[str]]]:
    """Heads and rows to read, without columns that are empty in every row."""
    rows = [[made(each) for made in CURVE_CELLS.values()] for each in records]
    kept = [place for place in range(len(CURVE_CELLS)) if any(row[place] for row in rows)]
    heads = list(CURVE_CELLS)
    return [heads[place] for place in kept], [[row[place] for place in kept] for row in rows]


def fastest(records: Sequence[Mapping[str, Any]], side: str, target: float) -> str:
    """The least time per point [us] to this largest error, and whose it is; a dash where nothing comes so near."""
    near = [
        (float(row["mean_us"]), row["solver"])
        for row in records
        if row["side"] == side and row["largest_error"] and float(row["largest_error"]) <= target
        if row["ok"] == row["points"] and row["mean_us"]
    ]
    return f"{_micro(min(near)[0])} by {min(near)[1]}" if near else "-"


def markdown_lines(records: Sequence[Mapping[str, Any]]) -> list[str]:
    """The same as lines of Markdown."""
    heads, rows = readable_rows(records)
    lines = [heads, ["---"] * len(heads), *rows] if heads else []
    return [f"| {' | '.join(line)} |" for line in lines]


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


def _size(error: float | str) -> str:
    return "" if error == "" else f"{float(error):.1e}"


def _micro(time: float | str) -> str:
    return "" if time == "" else f"{float(time):,.0f}" if float(time) >= 1000.0 else f"{float(time):.3g}"


def point_remark(row: Row) -> str:
    """What has no number, how often and why."""
    return _remark(row.counts, row.reason)


def _remark(counts: Mapping[str, int], reason: str) -> str:
    told = [f"{counts[s]} {s.replace('_', ' ')}" for s in BENCH_STATUSES if s != "ok" and counts[s]]
    return ": ".join(part for part in (", ".join(told), reason) if part)


def reference_lines(references: Sequence[ReferenceMeans], rows: Sequence[Row]) -> list[str]:
    """Who is measured against what, how well that is known, and how far the references are apart."""
    lines = []
    for reference in references:
        users = dict.fromkeys(row.contender.label for row in rows if row.reference is reference)
        if users:
            error = largest(reference.errors)
            lines.append(f"Reference of {', '.join(users)}: {reference.label}, known to {error:.1e}.")
    for i, one in enumerate(references):
        for other in references[:i]:
            apart = largest(abs(one.means - other.means))
            lines.append(f"{other.label} and {one.label} differ by at most {apart:.1e}.")
    return lines


def left_out(missing: Mapping[str, str]) -> str:
    """The one line on peers that are not installed, from the remedies by their labels."""
    return f"Peers left out: {', '.join(missing)} ({'; '.join(dict.fromkeys(missing.values()))})."


def curve_summary(name: str, rows: Sequence[Row]) -> str:
    """The time per point to reach an error, for every contender, with the ratio to the best method."""
    contenders = list({row.contender.label: row.contender for row in rows}.values())
    best = [
        min((_reach(rows, c, target) for c in contenders if c.side == "method"), default=math.inf)
        for target in TARGETS
    ]
    wide = max((len(contender.label) for contender in contenders), default=0) + 7
    title = f"{name}: us per point to a largest error of (times the best method's)"
    lines = [title, " " * wide + "".join(f"{target:>22.0e}" for target in TARGETS)]
    for contender in contenders:
        cells = [_reach(rows, contender, target) for target in TARGETS]
        who = contender.label + (" (peer)" if contender.side == "peer" else "")
        told = "".join(f"{_ratio(cell, of):>22}" for cell, of in zip(cells, best, strict=True))
        if all(math.isinf(cell) for cell in cells):
            told = f"  {_short_of_all(rows, contender)}"
        lines.append(f"{who:<{wide}}{told}")
    return "\n".join(lines)


def _short_of_all(rows: Sequence[Row], contender: Contender) -> str:
    """What a contender that reaches no target comes to: its least error, or why there is none."""
    own = [row for row in rows if row.contender is contender]
    nearest = min(
        (row for row in own if math.isfinite(row.largest)), key=lambda row: row.largest, default=None
    )
    remarks = [point_remark(row) for row in own if point_remark(row)]
    if nearest is None or nearest.counts["ok"] < nearest.points:
        return next(iter(remarks), "")
    return f"no nearer than {nearest.largest:.1e}, in {_short(nearest.mean.least)} us"


def _reach(rows: Sequence[Row], contender: Contender, target: float) -> float:
    """The least time per point [s] of the settings that answer every point within the target; infinite without."""
    own = [row for row in rows if row.contender is contender and row.counts["ok"] == row.points]
    return min((row.mean.least for row in own if row.largest <= target), default=math.inf)


def _ratio(cell: float, best: float) -> str:
    if math.isinf(cell):
        return "-"
    times = cell / best
    ratio = f"{times:,.0f}" if times >= 100.0 else f"{times:.2g}"
    return f"{_short(cell)} ({ratio})" if math.isfinite(best) else _short(cell)


def _short(seconds: float) -> str:
    return (
        "" if math.isnan(seconds) else f"{1e6 * seconds:.3g}" if seconds < 1e-3 else f"{1e6 * seconds:,.0f}"
    )
