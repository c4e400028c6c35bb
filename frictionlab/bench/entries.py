"""The methods, peers and references of a bench list: each with one setting, or a list of them to run through."""

from __future__ import annotations

import csv
from pathlib import Path as FilePath
from typing import Any

from frictionlab.bench.peers.base import Peer
from frictionlab.bench.peers.listing import PEERS
from frictionlab.bench.record import BenchSetting, Contender, ReferenceSource
from frictionlab.methods.base import Method
from frictionlab.mistakes.notes import Notes, Path
from frictionlab.mistakes.validation import build_record
from frictionlab.study.choices import items, method_choice

OWN_KEYS_OF_CONTENDER = ("tolerance", "points")
LIST_TOLERANCE = 1e-8
REFERENCE_COLUMNS = ("belt_speed", "mean_friction")


def contenders(tree: dict[str, Any], path: Path, notes: Notes) -> dict[str, Contender]:
    """The methods and peers of a list or of one of its blocks, by label; those with mistakes are noted."""
    found: dict[str, Contender] = {}
    for head in ("methods", "peers"):
        given = items(tree[head], (*path, head), "[{kind: exact}]", notes) if head in tree else []
        for index, item in enumerate(given):
            at: Path = (*path, head, index)
            contender = _contender(item, at, head, notes)
            if contender is not None and contender.label in found:
                notes.add(at, f"'{contender.label}' is there already; give each its own label")
            elif contender is not None:
                found[contender.label] = contender
    return found


def _contender(given: Any, path: Path, head: str, notes: Notes) -> Contender | None:
    item = {"kind": given} if isinstance(given, str) else given
    if notes.mapping(item, path) is None:
        return None
    points = notes.whole_number(item["points"], (*path, "points"), 1) if "points" in item else None
    varied = [key for key in item if isinstance(item[key], list)]
    if len(varied) > 1:
        notes.add((*path, varied[1]), f"only one value may be a list, and {varied[0]} is one")
        return None
    values = items(item[varied[0]], (*path, varied[0]), "[1.0e-6, 1.0e-9]", notes) if varied else [None]
    read = [_solver(item, varied[0] if varied else "", value, path, head, notes) for value in values]
    solvers = [solver for solver in read if solver is not None]
    if len(solvers) < len(values) or not solvers:
        return None
    kind = str(item["kind"])
    return Contender(str(item.get("label", kind)), kind, tuple(solvers), points)


def _solver(
    item: dict[str, Any], varied: str, value: Any, path: Path, head: str, notes: Notes
) -> tuple[BenchSetting, Method | Peer] | None:
    """The item with one of its values in place of the list."""
    item = item | {varied: value} if varied else item
    tolerance = notes.positive(item.get("tolerance", LIST_TOLERANCE), (*path, "tolerance"))
    told = {key: each for key, each in item.items() if key not in OWN_KEYS_OF_CONTENDER}
    solver = (_peer if head == "peers" else _method)(told, path, notes)
    if solver is None or tolerance is None or notes.below(path):
        return None
    return BenchSetting(varied, float(value) if varied else 0.0, tolerance), solver


def _method(told: dict[str, Any], path: Path, notes: Notes) -> Method | None:
    if told.get("kind") == "auto":
        notes.add((*path, "kind"), "auto only chooses: name the methods it chooses from")
        return None
    choice = method_choice(told, path, notes)
    return None if choice is None else choice.method


def _peer(told: dict[str, Any], path: Path, notes: Notes) -> Peer | None:
    if "kind" not in told:
        notes.add((*path, "kind"), "required key is missing")
        return None
    name = notes.one_of(told["kind"], (*path, "kind"), PEERS)
    label = notes.text(told.get("label", ""), (*path, "label"))
    if name is None or (not label and "label" in told):
        return None
    parameters = {key: value for key, value in told.items() if key not in ("kind", "label")}
    return build_record(PEERS[name], parameters, path, notes)


def references(
    tree: dict[str, Any], path: Path, folder: FilePath | None, notes: Notes
) -> tuple[ReferenceSource, ...]:
    """The references of a list or of one of its blocks; those with mistakes are noted.

    folder: that of files of values; None where a table of values is of no use.
    """
    if not (given := tree.get("references", [])) and isinstance(given, list):
        return ()
    listed = items(given, (*path, "references"), "[{kind: shooting, tolerance: 1.0e-12}]", notes)
    read = [_reference(item, (*path, "references", at), folder, notes) for at, item in enumerate(listed)]
    return tuple(trusted for trusted in read if trusted is not None)


def _reference(item: Any, path: Path, folder: FilePath | None, notes: Notes) -> ReferenceSource | None:
    if notes.mapping(item, path) is None:
        return None
    if "values" in item and folder is None:
        notes.add(path[:-1], "give methods: a table of values knows one curve of one model alone")
        return None
    if "values" in item:
        assert folder is not None
        return _values(item, path, folder, notes)
    if "tolerance" not in item:
        notes.add((*path, "tolerance"), "required key is missing")
        return None
    tolerance = notes.positive(item["tolerance"], (*path, "tolerance"))
    told = {key: value for key, value in item.items() if key != "tolerance"}
    solver = (_peer if told.get("kind") in PEERS else _method)(told, path, notes)
    if solver is None or tolerance is None:
        return None
    label = told.get("label", solver.name)
    return ReferenceSource(f"{label} at {tolerance:g}", solver.name, solver, tolerance, {})


def _values(item: dict[str, Any], path: Path, folder: FilePath, notes: Notes) -> ReferenceSource | None:
    """``{values: FILE, error: x, label: TEXT}``; the path is relative to the list."""
    notes.mapping(item, path, ("values", "error", "label"))
    if "error" not in item:
        notes.add((*path, "error"), "required key is missing: how well the values are known")
        return None
    error = notes.positive(item["error"], (*path, "error"))
    name = notes.text(item["values"], (*path, "values"))
    label = notes.text(item.get("label", name), (*path, "label"))
    table = _table(folder / name, (*path, "values"), notes) if name else None
    return None if error is None or table is None else ReferenceSource(label, "", None, error, table)


def _table(file: FilePath, path: Path, notes: Notes) -> dict[float, float] | None:
    """Mean friction by belt speed."""
    try:
        with file.open(encoding="utf-8", newline="") as text:
            rows = [[float(row[column]) for column in REFERENCE_COLUMNS] for row in csv.DictReader(text)]
    except OSError as problem:
        notes.add(path, f"cannot be read: {problem.strerror}")
    except (KeyError, TypeError, ValueError):
        notes.add(path, f"must be a CSV file of numbers with the columns {' and '.join(REFERENCE_COLUMNS)}")
    else:
        return {speed: mean for speed, mean in rows}
    return None
