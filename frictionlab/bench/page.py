"""The page of a folder of bench results: one HTML file that needs nothing else."""

from __future__ import annotations

import csv
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from frictionlab.bench.account import add_to_account, entry_of, print_of
from frictionlab.bench.report import TARGETS, cell_text, fastest, left_out, readable_rows
from frictionlab.bench.sections import SectionResult
from frictionlab.report.figures import address
from frictionlab.report.page import rendered
from frictionlab.report.tables import Grid
from frictionlab.results.words import counted
from frictionlab.runner.errors import SaveError
from frictionlab.runner.folder import check_page, write_page

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
        from frictionlab.bench.pictures import draw

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
