"""The keys ``data`` and ``free`` of a study: measured files, how their columns are called, and what may be fitted."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path as FilePath
from typing import Any

from frictionlab.values.notes import Notes, did_you_mean, value_text

DATA_KEYS, RANGE_KEYS = ("file", "columns"), ("from", "to", "spacing")
SPACINGS = "linear", "log"
KINDS_OF_FILE = ".csv", ".tsv", ".txt", ".parquet"
"""Ends of names; those of text may be followed by .gz."""
SLIP_ALONE: dict[str, Any] = {"belt_speed": 1, "slip": {"velocity_amplitude": 1, "frequency": 1}}
"""The scene of a study of slip over time, which needs none: nothing of it is used by a fit."""


@dataclass(frozen=True)
class DataFiles:
    """Files with measurements, as a study names them. columns: ours -> theirs."""

    files: tuple[str, ...]
    columns: Mapping[str, str] = field(default_factory=dict)

    def resolved(self) -> dict[str, Any]:
        """The entry of a study file."""
        columns = {"columns": dict(self.columns)} if self.columns else {}
        return {"file": self.files[0] if len(self.files) == 1 else list(self.files), **columns}


def read_data(tree: dict[str, Any], notes: Notes, folder: FilePath | None) -> dict[str, Any]:
    """``data`` and ``free`` of a study, mistakes noted. folder: of its files; None: they are not looked for."""
    told: dict[str, Any] = {}
    if "data" in tree and (given := notes.mapping(tree["data"], ("data",), DATA_KEYS)) is not None:
        told["data"] = _data(given, notes, folder)
    if "free" in tree:
        if "data" not in tree:
            notes.on_key(("free",), "needs data: the measurements that numbers are fitted to")
        ranges = notes.mapping(tree["free"], ("free",))
        for name, value in (ranges or {}).items():
            read_range(value, name, notes)
        told["free"] = ranges or {}
    return told


def _data(given: dict[str, Any], notes: Notes, folder: FilePath | None) -> DataFiles:
    if "file" not in given:
        notes.add(("data", "file"), "required key is missing")
    files = given.get("file", [])
    several = isinstance(files, list)
    named = []
    for place, name in enumerate(files if several else [files]):
        path: tuple[Any, ...] = ("data", "file", place) if several else ("data", "file")
        if not (text := notes.text(name, path)):
            continue
        end = text.removesuffix(".gz")
        if not end.endswith(KINDS_OF_FILE):
            notes.add(
                path,
                f"must be a file {', '.join(KINDS_OF_FILE)} (text may be .gz, too), got {value_text(text)}",
            )
        elif folder is not None and not (folder / text).is_file():
            there = [each.name for each in folder.glob("*") if each.is_file()] if folder.is_dir() else []
            notes.add(path, f"there is no file {folder / text}", did_you_mean(text, there))
        named.append(text)
    if several and not files:
        notes.add(("data", "file"), "the list is empty; give at least one, such as [measured.csv]")
    columns = notes.mapping(given.get("columns", {}), ("data", "columns")) or {}
    known = {str(ours): notes.text(theirs, ("data", "columns", ours)) for ours, theirs in columns.items()}
    return DataFiles(tuple(named), known)


def read_range(value: Any, name: str, notes: Notes) -> tuple[float, float, str | None] | None:
    """Ends and spacing of the range of a free number, a pair or from, to and spacing; None, noted, if it is none."""
    path: tuple[Any, ...] = ("free", name)
    spacing = None
    if isinstance(value, dict):
        given = notes.mapping(value, path, RANGE_KEYS) or {}
        for end in RANGE_KEYS[:2]:
            if end not in given:
                notes.add((*path, end), "required key is missing")
        if "spacing" in given:
            spacing = notes.one_of(given["spacing"], (*path, "spacing"), SPACINGS)
        ends = [given.get("from"), given.get("to")]
        places: list[tuple[Any, ...]] = [(*path, "from"), (*path, "to")]
    elif isinstance(value, Sequence) and not isinstance(value, str) and len(value) == 2:
        ends, places = list(value), [(*path, 0), (*path, 1)]
    else:
        notes.add(path, f"must be a range such as [0.1, 1.0], got {value_text(value)}")
        return None
    low, high = (
        None if end is None else notes.number(end, place) for end, place in zip(ends, places, strict=True)
    )
    if low is None or high is None:
        return None
    if not low < high:
        notes.add(path, f"must rise, got {low:g} to {high:g}")
    elif spacing == "log" and not low > 0.0:
        notes.add(path, f"a log range must begin above 0, got {low:g}")
    return low, high, spacing
