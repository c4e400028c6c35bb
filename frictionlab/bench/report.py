"""What was measured, as tables to read (Markdown), to compute with (CSV), and in brief."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from frictionlab.bench.csv_table import write_records
from frictionlab.bench.measure import BENCH_STATUSES, Row, WorkloadResult
from frictionlab.bench.names import file_stem
from frictionlab.bench.record import Contender, ReferenceMeans
from frictionlab.bench.sections import SectionResult
from frictionlab.bench.timing import Times
from frictionlab.runner.errors import SaveError

TARGETS = (1e-3, 1e-6, 1e-9, 1e-12)
HEAD = (
    "| solver | setting | points | largest error | median error | largest stated error | covered "
    "| us per point: mean and error (quartiles) | model alone | its error alone | everything | repeats "
    "| first run, s | remark |"
)


def write(done: Sequence[WorkloadResult | SectionResult], folder: Path) -> list[Path]:
    """One CSV and one Markdown table per curve, the tables of each section; the files written. Raises SaveError."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        return [path for each in done for path in _write_one(each, folder)]
    except OSError as problem:
        raise SaveError(f"cannot write the tables in {folder}: {problem.strerror or problem}") from problem


def _write_one(measured: WorkloadResult | SectionResult, folder: Path) -> list[Path]:
    if not isinstance(measured, WorkloadResult):
        return measured.write(folder)
    stem = file_stem(measured.work.name)
    table, text = folder / f"{stem}.csv", folder / f"{stem}.md"
    records = [_record(measured, row) for row in measured.rows]
    write_records(table, records)
    text.write_text(markdown(measured), encoding="utf-8")
    return [table, text]


def _record(measured: WorkloadResult, row: Row) -> dict[str, Any]:
    """A row as the CSV holds it; times in microseconds per point, empty where there is none."""
    kind = "coulomb" if measured.work.law.constant_sliding_friction() else type(measured.work.law).__name__
    told: dict[str, Any] = {
        "scene": measured.work.name,
        "law": kind.lower(),
        "solver": row.contender.label,
        "side": row.contender.side,
        "quantity": row.setting.quantity,
        "value": row.setting.value if row.setting.quantity else "",
        "points": row.points,
        **row.counts,
        "largest_error": _cell(row.largest),
        "median_error": _cell(row.median),
        "stated_error": _cell(row.stated),
        "covered": "" if row.covered is None else row.covered,
    }
    for name, times in (("mean", row.mean), ("all", row.whole), ("model", row.model)):
        values = (times.least, *times.quartiles)
        names = (f"{name}_us", f"{name}_us_q1", f"{name}_us_q2", f"{name}_us_q3")
        told |= dict(zip(names, (_cell(1e6 * value) for value in values), strict=True))
        told[f"{name}_repeats"] = times.repeats
    told["error_us"] = _cell(1e6 * row.error_alone)
    told["first_run_s"] = _cell(row.first)
    told["reference"] = row.reference.label if row.reference else ""
    told["reference_error"] = _cell(_own_error(row.reference))
    return told | {"reason": row.reason}


def _cell(value: float) -> float | str:
    return "" if math.isnan(value) else value


def _own_error(reference: ReferenceMeans | None) -> float:
    return math.nan if reference is None else largest(reference.errors)


def largest(values: Any) -> float:
    """The largest number among some, NaN where there is none."""
    return max((float(value) for value in values if math.isfinite(value)), default=math.nan)


def markdown(measured: WorkloadResult) -> str:
    """One curve's table, with what its errors are measured against."""
    work = measured.work
    speeds = work.speeds()
    lines = [f"## {work.name}{': ' + work.title if work.title else ''}", ""]
    lines += [f"{len(speeds)} belt speeds from {speeds[0]:g} to {speeds[-1]:g}.", ""]
    lines += [f"- {left_out(measured.missing)}"] if measured.missing else []
    lines += [
        *reference_lines(measured),
        "",
        HEAD,
        "|---" * (HEAD.count("|") - 1) + "|",
    ]
    for rows in _by_contender(measured):
        refused = all(row.counts["refused"] == row.points for row in rows)
        lines += [_line(rows[0], "all")] if refused else [_line(row, str(row.setting)) for row in rows]
    return "\n".join(lines) + "\n"


def _by_contender(measured: WorkloadResult) -> list[list[Row]]:
    rows: dict[str, list[Row]] = {}
    for row in measured.rows:
        rows.setdefault(row.contender.label, []).append(row)
    return list(rows.values())


def reference_lines(measured: WorkloadResult) -> list[str]:
    """Who is measured against what, how well that is known, and how far the references are apart."""
    lines = []
    for reference in measured.references:
        users = dict.fromkeys(row.contender.label for row in measured.rows if row.reference is reference)
        if users:
            error = largest(reference.errors)
            lines.append(f"- Reference of {', '.join(users)}: {reference.label}, known to {error:.1e}.")
    for i, one in enumerate(measured.references):
        for other in measured.references[:i]:
            apart = largest(abs(one.means - other.means))
            lines.append(f"- {other.label} and {one.label} differ by at most {apart:.1e}.")
    return lines


def _line(row: Row, setting: str) -> str:
    covered = "" if row.covered is None or not row.counts["ok"] else f"{row.covered}/{row.counts['ok']}"
    cells = [
        row.contender.label,
        setting,
        str(row.points),
        _power(row.largest),
        _power(row.median),
        _power(row.stated),
        covered,
        _spread(row.mean),
        _short(row.model.least),
        _short(row.error_alone),
        "" if not row.whole.repeats else _short(row.whole.least) if row.whole is not row.mean else "the same",
        str(row.mean.repeats or ""),
        "" if math.isnan(row.first) else f"{row.first:.2g}",
        point_remark(row),
    ]
    return f"| {' | '.join(cells)} |"


def point_remark(row: Row) -> str:
    """What has no number, how often and why."""
    counts = [f"{row.counts[s]} {s.replace('_', ' ')}" for s in BENCH_STATUSES if s != "ok" and row.counts[s]]
    return ": ".join(part for part in (", ".join(counts), row.reason) if part)


def _power(value: float) -> str:
    return "" if math.isnan(value) else f"{value:.1e}"


def _short(seconds: float) -> str:
    return (
        "" if math.isnan(seconds) else f"{1e6 * seconds:.3g}" if seconds < 1e-3 else f"{1e6 * seconds:,.0f}"
    )


def _spread(times: Times) -> str:
    if not times.repeats:
        return ""
    return f"{_short(times.least)} ({', '.join(map(_short, times.quartiles))})"


def bench_summary(done: Sequence[WorkloadResult | SectionResult]) -> str:
    """What every curve and section came to, and in one line the peers that are not installed."""
    missing = {
        label: told
        for each in done
        if isinstance(each, WorkloadResult)
        for label, told in each.missing.items()
    }
    told = [part_summary(each) for each in done]
    return "\n\n".join([*told, left_out(missing)] if missing else told)


def part_summary(measured: WorkloadResult | SectionResult) -> str:
    """Of a curve the time per point to reach an error, for every contender, with the ratio to the best method."""
    return _summary(measured) if isinstance(measured, WorkloadResult) else measured.summary()


def left_out(missing: Mapping[str, str]) -> str:
    """The one line on peers that are not installed, from the remedies by their labels."""
    return f"Peers left out: {', '.join(missing)} ({'; '.join(dict.fromkeys(missing.values()))})."


def _summary(measured: WorkloadResult) -> str:
    rows = measured.rows
    contenders = list({row.contender.label: row.contender for row in rows}.values())
    best = [
        min((_reach(rows, c, target) for c in contenders if c.side == "method"), default=math.inf)
        for target in TARGETS
    ]
    wide = max((len(contender.label) for contender in contenders), default=0) + 7
    title = f"{measured.work.name}: us per point to a largest error of (times the best method's)"
    lines = [title, " " * wide + "".join(f"{target:>22.0e}" for target in TARGETS)]
    for contender in contenders:
        cells = [_reach(rows, contender, target) for target in TARGETS]
        name = contender.label + (" (peer)" if contender.side == "peer" else "")
        told = "".join(f"{_ratio(cell, of):>22}" for cell, of in zip(cells, best, strict=True))
        if all(math.isinf(cell) for cell in cells):
            told = f"  {_short_of_all(rows, contender)}"
        lines.append(f"{name:<{wide}}{told}")
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
