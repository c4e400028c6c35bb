"""A folder of bench results: tables, charts, what was measured when, where and with what, and a page of it all.

The page is one HTML file that needs nothing else; ``bench.json`` holds what it says beside the tables.
"""

from __future__ import annotations

import json
import re
import textwrap
from collections.abc import Mapping, Sequence
from datetime import UTC, datetime
from functools import cache
from pathlib import Path
from typing import Any

import matplotlib as mpl
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine

from frictionlab import __version__
from frictionlab.bench.contenders import PEERS
from frictionlab.bench.result import SectionResult, file_stem, left_out_line
from frictionlab.bench.texts import TARGETS, any_cells, curve_cells, fastest, markdown_lines, without_empty
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
LETTERS_AN_INCH = 16
"""Letters of the small print."""
ACCOUNT, PAGE_NAME = "bench.json", "index.html"
ENTRY_KEYS = {
    *("kind", "name", "title", "notes", "missing", "summary", "tables", "pictures"),
    *("frictionlab", "date", "cores", "python", "platform", "processor", "packages"),
}
"""Keys that the page asks of an entry; one without them is another version's."""
MOST_ROWS_ON_PAGE = 200
ROWS_OF_MANY = 20
"""Shown of a table with more rows than a page holds."""
_DIGITS = re.compile(r"(?<=[ -])(\d+\.\d\d)\d+")
"""A coordinate: a hundredth of a point is kept of it, which takes a third off the file."""


@cache
def circumstances() -> dict[str, Any]:
    """Machine, date and versions, of the peers, too."""
    packages = [*PRINTED, *(peer.package for peer in PEERS.values())]
    found = machine_and_versions(dict.fromkeys(packages))
    day = datetime.now(UTC).strftime("%Y-%m-%d")
    return {"frictionlab": __version__, "date": day, "cores": cores(), **found}


def small_print(told: Mapping[str, Any]) -> str:
    """Machine, date and versions of an entry in a line."""
    versions = {"frictionlab": told["frictionlab"], "Python": told["python"], **told["packages"]}
    packages = ", ".join(f"{name} {number}" for name, number in versions.items())
    return f"{told['processor']}, {told['cores']} cores; {told['date']}; {packages}"


# --- what is written ----------------------------------------------------------------------------------------------


def check_folder(folder: Path) -> None:
    """Raises FolderError where a page is in the way that a person wrote."""
    check_page(folder / PAGE_NAME)


def save(measured: SectionResult, folder: Path) -> Path:
    """Write the table of a curve or section, its chart, the account of the folder and its page; where that is.

    Raises SaveError.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
        tables = write_table(measured, folder)
        pictures = draw(measured, folder)
    except OSError as problem:
        raise SaveError(f"cannot write into {folder}: {problem.strerror or problem}") from problem
    parts = read_account(folder) | {file_stem(measured.name): entry_of(measured, tables, pictures)}
    write_whole(folder / ACCOUNT, (json.dumps({"parts": parts}, indent=1) + "\n").encode())
    write_page(folder / PAGE_NAME, bench_page(folder, parts))
    return folder / PAGE_NAME


def write_table(measured: SectionResult, folder: Path) -> list[str]:
    """Write the table as CSV where it has rows, that of a curve as Markdown, too. Raises OSError."""
    if measured.table.empty:
        return []
    file = folder / f"{file_stem(measured.name)}.csv"
    measured.table.to_csv(file, index=False)
    if measured.kind == "curve":
        file.with_suffix(".md").write_text(markdown(measured, file), encoding="utf-8")
    return [file.name]


def markdown(measured: SectionResult, file: Path) -> str:
    """Return the table of a curve to read, with what its errors are measured against."""
    heading = f"## {measured.name}{': ' + measured.title if measured.title else ''}"
    notes = [*([left_out_line(measured.left_out)] if measured.left_out else []), *measured.notes]
    table = markdown_lines(without_empty(curve_cells(_table(file))))
    return "\n".join([heading, "", *(f"- {note}" for note in notes), "", *table]) + "\n"


def draw(result: SectionResult, folder: Path) -> list[dict[str, str]]:
    """Write the chart of a result, with machine, date and versions in small print. Raises OSError."""
    stem, look = file_stem(result.name), dict[Any, Any](STYLE | result.style)
    with mpl.rc_context(look):
        if (figure := result.figure()) is None:
            return []
        print_below(figure, small_print(circumstances()))
        drawn, _ = write_figure(figure, folder / f"{stem}.svg")
    drawn.write_text(_DIGITS.sub(r"\1", drawn.read_text(encoding="utf-8")), encoding="utf-8")
    return [{"file_stem": stem, "caption": result.caption}]


def print_below(figure: Figure, text: str) -> None:
    """Write small print at the lower right, in a strip that the layout and legends below pictures leave free."""
    text = textwrap.fill(text, int(LETTERS_AN_INCH * figure.get_figwidth()))
    strip = 0.12 * (1 + text.count("\n")) / figure.get_figheight()
    engine = figure.get_layout_engine()
    if isinstance(engine, ConstrainedLayoutEngine):
        engine.set(rect=(0.0, strip, 1.0, 1.0 - strip))
    for legend in (each for each in figure.legends if getattr(each, "_outside_loc", None) == "lower"):
        legend.borderaxespad += 72.0 * strip * figure.get_figheight() / legend.prop.get_size_in_points()
    figure.text(0.995, 0.1 * strip, text, ha="right", va="bottom", fontsize=6.5, color="0.3")


def entry_of(measured: SectionResult, tables: Sequence[str], pictures: Sequence[Any]) -> dict[str, Any]:
    """Return the entry of a curve or section: its files, and what is said of it."""
    said = {name: getattr(measured, name) for name in ("kind", "name", "title", "summary")}
    lists = {"notes": [*measured.notes], "missing": {**measured.left_out}}
    return {**said, **lists, "tables": [*tables], "pictures": [*pictures], **circumstances()}


def read_account(folder: Path) -> dict[str, dict[str, Any]]:
    """Return the entries of a folder by the stem of their files; none where it has no account that can be read."""
    try:
        found = json.loads((folder / ACCOUNT).read_text(encoding="utf-8"))
        entries = {str(stem): dict(entry) for stem, entry in found["parts"].items()}
        return {stem: entry for stem, entry in entries.items() if entry.keys() >= ENTRY_KEYS}
    except (OSError, ValueError, KeyError, TypeError, AttributeError):
        return {}


# --- the page -----------------------------------------------------------------------------------------------------


def bench_page(folder: Path, parts: Mapping[str, Mapping[str, Any]]) -> str:
    """Return the page of a folder with these entries of its account.

    The section of a peer that is not installed is left out: a line at the head of the page says so.
    """
    told = {stem: each for stem, each in parts.items() if each["kind"] == "curve" or not each["missing"]}
    shown = [_part(folder, stem, entry) for stem, entry in told.items()]
    curves = [part for part in shown if part["kind"] == "curve"]
    missing = {name: told for entry in parts.values() for name, told in entry["missing"].items()}
    latest = max(parts.values(), key=lambda entry: str(entry["date"]))
    dates = [str(entry["date"]) for entry in parts.values()]
    facts = [f"{counted(latest['cores'], 'core')} of {latest['processor']}"]
    facts += [" … ".join(dict.fromkeys((min(dates), max(dates))))]
    counts = {"curve": len(curves), "section": len(shown) - len(curves)}
    facts += [counted(count, noun) for noun, count in counts.items() if count]
    return rendered(
        "bench.html",
        title=f"Bench results in {folder.absolute().name}",
        facts=facts,
        overview=_overview(curves),
        missing=left_out_line(missing) if missing else "",
        parts=shown,
        versions=_versions(latest),
    )


def _part(folder: Path, stem: str, entry: Mapping[str, Any]) -> dict[str, Any]:
    """A curve or a section of the page with those of its tables that can be read; print: where it was measured."""
    pictures = [{**each, "address": address(folder / each["file_stem"])} for each in entry["pictures"]]
    told = {"anchor": f"part-{stem}", "pictures": pictures, "print": small_print(entry)}
    read = {name: table for name in entry["tables"] if not (table := _table(folder / name)).empty}
    shown = [_shown(name, table, entry["kind"]) for name, table in read.items()]
    return {**entry, **told, "tables": shown, "read": read}


def _table(file: Path) -> pd.DataFrame:
    """Return the rows of a file as texts; none where it cannot be read."""
    try:
        return pd.read_csv(file, dtype=str, keep_default_na=False)
    except (OSError, ValueError):
        return pd.DataFrame()


def _overview(curves: Sequence[Mapping[str, Any]]) -> Grid | None:
    """Return the fastest on each curve: of the methods to every error of interest, of other libraries to one."""
    heads = ["curve", *(f"to {target:.0e}" for target in TARGETS), f"other libraries, to {TARGETS[1]:.0e}"]
    asked, rows = [*(("method", target) for target in TARGETS), ("peer", TARGETS[1])], []
    for part in curves:
        for table in part["read"].values():
            rows.append([part["name"], *(fastest(table, side, target) for side, target in asked)])
    caption = "The fastest to a largest error of the mean friction, in microseconds a point"
    return Grid(caption, heads, rows) if rows else None


def _shown(name: str, table: pd.DataFrame, kind: str) -> dict[str, Any]:
    """Return the table of a file without columns that are empty in every row, and the file with all of it."""
    few = table if len(table) <= MOST_ROWS_ON_PAGE else table.head(ROWS_OF_MANY)
    cells, caption = any_cells(few), f"{name}: {counted(len(table), 'row')}"
    if kind == "curve":
        stem = name.removesuffix(".csv")
        cells, caption = curve_cells(few), f"{stem}: errors of the mean friction, and times per point"
    if len(few) < len(table):
        caption = f"{name}: the first {len(few)} of {len(table):,} rows"
    cells = without_empty(cells)
    return {"grid": Grid(caption, [*cells.columns], cells.to_numpy().tolist()), "file": name}


def _versions(entry: Mapping[str, Any]) -> Grid:
    own = {name: entry[name] for name in ("frictionlab", "python", "platform", "processor")}
    rows = [[name, str(value)] for name, value in (own | entry["packages"]).items()]
    return Grid("Machine, and versions of what is measured, peers included", ["what", "version"], rows)
