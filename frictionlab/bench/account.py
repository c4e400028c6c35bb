"""What a folder of bench results holds, when, where and with what it was measured: its file ``bench.json``.

Figures of a bench, written with machine, date and versions in small print.

The page of a folder of bench results: one HTML file that needs nothing else.
"""

from __future__ import annotations

import csv
import json
import re
import textwrap
from collections.abc import Callable, Mapping, Sequence
from datetime import UTC, datetime
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import matplotlib as mpl
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine

from frictionlab import __version__
from frictionlab.bench.charts.curve import curve_figure, models_figure
from frictionlab.bench.charts.failures import failures_figure
from frictionlab.bench.charts.orders import orders_figure, stability_figure
from frictionlab.bench.curve import CurveResult, ModelsResult
from frictionlab.bench.failures import FailureResult
from frictionlab.bench.listed import PEERS
from frictionlab.bench.orders import OrdersResult
from frictionlab.bench.record import SectionResult, file_stem
from frictionlab.bench.report import TARGETS, cell_text, fastest, left_out, readable_rows
from frictionlab.bench.stability import StabilityResult
from frictionlab.charts.sheet import STYLE, write_figure
from frictionlab.report.figures import address
from frictionlab.report.page import rendered
from frictionlab.report.tables import Grid
from frictionlab.runner.files import SaveError, write_whole
from frictionlab.runner.folder import check_page, write_page
from frictionlab.runner.folder_files import cores, machine_and_versions
from frictionlab.runner.words import counted

PRINTED = ("numpy", "numba", "scipy")
"""Packages in the small print of a chart, besides the peers."""


@cache
def circumstances() -> dict[str, Any]:
    """Machine, date and versions, of the peers, too."""
    packages = [*PRINTED, *(peer.package for peer in PEERS.values())]
    found = machine_and_versions(dict.fromkeys(packages))
    day = datetime.now(UTC).strftime("%Y-%m-%d")
    return {"frictionlab": __version__, "date": day, "cores": cores(), **found}


def small_print() -> str:
    """Machine, date and versions in a line."""
    return print_of(circumstances())


def print_of(told: Mapping[str, Any]) -> str:
    """Machine, date and versions of an entry in a line."""
    versions = {"frictionlab": told["frictionlab"], "Python": told["python"], **told["packages"]}
    packages = ", ".join(f"{name} {number}" for name, number in versions.items())
    return f"{told['processor']}, {told['cores']} cores; {told['date']}; {packages}"


ACCOUNT = "bench.json"
ENTRY_KEYS = {
    *("kind", "name", "title", "notes", "missing", "summary", "tables", "pictures"),
    *("frictionlab", "date", "cores", "python", "platform", "processor", "packages"),
}
"""What the page asks of an entry; one without them is another version's."""


def entry_of(measured: SectionResult, tables: Sequence[Path], pictures: Sequence[Any]) -> dict[str, Any]:
    """The entry of a curve or section: its files, and what is said of it."""
    return {
        "kind": measured.kind,
        "name": measured.name,
        "title": measured.title,
        "notes": measured.notes,
        "missing": dict(measured.left_out or {}),
        "summary": measured.summary(),
        "tables": [path.name for path in tables if path.suffix == ".csv"],
        "pictures": [picture._asdict() for picture in pictures],
        **circumstances(),
    }


def read_account(folder: Path) -> dict[str, dict[str, Any]]:
    """The entries of a folder by the stem of their files; none where it has no account that can be read."""
    try:
        found = json.loads((folder / ACCOUNT).read_text(encoding="utf-8"))
        entries = {str(stem): dict(entry) for stem, entry in found["parts"].items()}
        return {stem: entry for stem, entry in entries.items() if entry.keys() >= ENTRY_KEYS}
    except (OSError, ValueError, KeyError, TypeError, AttributeError):
        return {}


def add_to_account(folder: Path, entries: Sequence[dict[str, Any]]) -> dict[str, dict[str, Any]]:
    """Put entries into the account of a folder, in place of older ones of the same name; all of them.

    Raises SaveError.
    """
    parts = read_account(folder) | {file_stem(entry["name"]): entry for entry in entries}
    write_whole(folder / ACCOUNT, (json.dumps({"parts": parts}, indent=1) + "\n").encode())
    return parts


_DIGITS = re.compile(r"(?<=[ -])(\d+\.\d\d)\d+")
"""A coordinate: a hundredth of a point is kept of it, which takes a third off the file."""
FIGURES_OF_SECTIONS: dict[type, Callable[[Any], Figure | None]] = {
    CurveResult: curve_figure,
    OrdersResult: orders_figure,
    StabilityResult: stability_figure,
    FailureResult: failures_figure,
    ModelsResult: models_figure,
}
"""The figure of each kind of result, None where there is nothing to draw."""


class BenchPicture(NamedTuple):
    """A chart, written as SVG and PNG under this stem; the caption is one sentence on how to read it."""

    file_stem: str
    caption: str


def draw(result: SectionResult, folder: Path) -> list[BenchPicture]:
    """Write the chart of a result, with machine, date and versions in small print. Raises OSError."""
    stem, look = file_stem(result.name), dict[Any, Any](STYLE | result.style)
    with mpl.rc_context(look):
        if (figure := FIGURES_OF_SECTIONS[type(result)](result)) is None:
            return []
        _print_below(figure, textwrap.fill(small_print(), 110))
        drawn, _ = write_figure(figure, folder / f"{stem}.svg")
    drawn.write_text(_DIGITS.sub(r"\1", drawn.read_text(encoding="utf-8")), encoding="utf-8")
    return [BenchPicture(stem, result.caption)]


def _print_below(figure: Figure, text: str) -> None:
    """Small print at the lower right, in a strip that the layout leaves free."""
    strip = 0.12 * (1 + text.count("\n")) / figure.get_figheight()
    engine = figure.get_layout_engine()
    if isinstance(engine, ConstrainedLayoutEngine):
        engine.set(rect=(0.0, strip, 1.0, 1.0 - strip))
    figure.text(0.995, 0.1 * strip, text, ha="right", va="bottom", fontsize=6.5, color="0.3")


PAGE_NAME = "index.html"
MOST_ROWS_ON_PAGE = 200
ROWS_OF_MANY = 20
"""Shown of a table with more rows than a page holds."""


def save(measured: SectionResult, folder: Path) -> Path:
    """Write the tables of a curve or section, then its charts, the account of the folder and its page; where that is.

    The tables are on disk before matplotlib is imported. Raises SaveError.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
        tables = measured.write(folder)
        pass

        pictures = draw(measured, folder)
    except OSError as problem:
        raise SaveError(f"cannot write into {folder}: {problem.strerror or problem}") from problem
    page, entry = folder / PAGE_NAME, entry_of(measured, tables, pictures)
    write_page(page, bench_page(folder, add_to_account(folder, [entry])))
    return page


def check_folder(folder: Path) -> None:
    """Raises FolderError where a page is in the way that a person wrote."""
    check_page(folder / PAGE_NAME)


def bench_page(folder: Path, parts: Mapping[str, Mapping[str, Any]]) -> str:
    """The page of a folder with these entries of its account."""
    shown = [_part(folder, stem, entry) for stem, entry in parts.items() if not _left_out(entry)]
    missing = {name: told for entry in parts.values() for name, told in entry["missing"].items()}
    latest = max(parts.values(), key=lambda entry: str(entry["date"]))
    curves = sum(part["kind"] == "curve" for part in shown)
    return rendered(
        "bench.html",
        title=f"Bench results in {folder.absolute().name}",
        facts=[
            f"{counted(latest['cores'], 'core')} of {latest['processor']}",
            " … ".join(dict.fromkeys(f(str(entry["date"]) for entry in parts.values()) for f in (min, max))),
            *([counted(curves, "curve")] if curves else []),
            *([counted(len(shown) - curves, "section")] if len(shown) > curves else []),
        ],
        overview=_overview(folder, [entry for entry in parts.values() if entry["kind"] == "curve"]),
        missing=left_out(missing) if missing else "",
        parts=shown,
        versions=_versions(latest),
    )


def _left_out(entry: Mapping[str, Any]) -> bool:
    """Whether it is the section of a peer that is not installed: a line at the head of the page says so."""
    return entry["kind"] == "section" and bool(entry["missing"])


def _part(folder: Path, stem: str, entry: Mapping[str, Any]) -> dict[str, Any]:
    """A curve or a section of the page; print: where and with what it was measured, in a line."""
    made = _curve_table if entry["kind"] == "curve" else _any_table
    return {
        **entry,
        "anchor": f"part-{stem}",
        "pictures": [{**each, "address": address(folder / each["file_stem"])} for each in entry["pictures"]],
        "tables": [found for name in entry["tables"] for found in _table(folder / name, made)],
        "print": print_of(entry),
    }


def _overview(folder: Path, curves: Sequence[Mapping[str, Any]]) -> Grid | None:
    """What is fastest on each curve: of the methods to every error of interest, of other libraries to one."""
    heads = ["curve", *(f"to {target:.0e}" for target in TARGETS), f"other libraries, to {TARGETS[1]:.0e}"]
    rows = []
    for entry in curves:
        records = [record for name in entry["tables"] for record in _records(folder / name)]
        told = [fastest(records, "method", target) for target in TARGETS]
        rows.append([entry["name"], *told, fastest(records, "peer", TARGETS[1])])
    caption = "The fastest to a largest error of the mean friction, in microseconds a point"
    return Grid(caption, heads, rows) if rows else None


def _versions(entry: Mapping[str, Any]) -> Grid:
    own = {name: entry[name] for name in ("frictionlab", "python", "platform", "processor")}
    rows = [[name, str(value)] for name, value in (own | entry["packages"]).items()]
    return Grid("Machine, and versions of what is measured, peers included", ["what", "version"], rows)


def _table(file: Path, made: Callable[[str, list[dict[str, str]]], Grid]) -> list[dict[str, Any]]:
    """The table of a file, and the file with all of it."""
    records = _records(file)
    if not records:
        return []
    few = records if len(records) <= MOST_ROWS_ON_PAGE else records[:ROWS_OF_MANY]
    grid = made(file.name, few)
    if len(few) < len(records):
        grid = grid._replace(caption=f"{file.name}: the first {len(few)} of {len(records):,} rows")
    return [{"grid": grid, "file": file.name}]


def _records(file: Path) -> list[dict[str, str]]:
    """The rows of a file; none where it cannot be read."""
    try:
        with file.open(encoding="utf-8", newline="") as text:
            return list(csv.DictReader(text))
    except OSError:
        return []


def _any_table(name: str, records: list[dict[str, str]]) -> Grid:
    """A table as its file has it, numbers to four digits, without columns that are empty in every row."""
    kept = [key for key in records[0] if any(record[key] for record in records)]
    return Grid(
        f"{name}: {counted(len(records), 'row')}",
        [key.replace("_", " ") for key in kept],
        [[cell_text(record[key]) for key in kept] for record in records],
    )


def _curve_table(name: str, records: list[dict[str, str]]) -> Grid:
    caption = f"{name.removesuffix('.csv')}: errors of the mean friction, and times per point"
    return Grid(caption, *readable_rows(records))
