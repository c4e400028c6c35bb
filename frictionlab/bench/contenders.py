"""The methods and peers of a bench list: each with one setting, or a list of them to run through."""

from __future__ import annotations

from typing import Any, NamedTuple

from frictionlab.bench.peers.base import Peer
from frictionlab.bench.peers.listing import PEERS
from frictionlab.bench.record import BenchSetting, Contender, ReferenceSource
from frictionlab.methods.base import Method
from frictionlab.mistakes.notes import Notes, Path, value_text
from frictionlab.mistakes.validation import build_record
from frictionlab.study.choices import items, method_choice

OWN_KEYS_OF_CONTENDER = ("tolerance", "points")
TOLERANCE = 1e-8


class Defaults(NamedTuple):
    """What holds for every scene that does not say otherwise."""

    references: tuple[ReferenceSource, ...]
    contenders: dict[str, Contender]


def contenders(tree: dict[str, Any], path: Path, notes: Notes) -> dict[str, Contender]:
    """The methods and peers of a list or of one of its scenes, by label; those with mistakes are noted."""
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
    tolerance = notes.number(item.get("tolerance", TOLERANCE), (*path, "tolerance"))
    if tolerance is not None and tolerance <= 0.0:
        notes.add((*path, "tolerance"), f"must be > 0, got {value_text(tolerance)}")
    told = {key: each for key, each in item.items() if key not in OWN_KEYS_OF_CONTENDER}
    solver = _method(told, path, notes) if head == "methods" else peer_of(told, path, notes)
    if solver is None or tolerance is None or notes.below(path):
        return None
    return BenchSetting(varied, float(value) if varied else 0.0, tolerance), solver


def _method(told: dict[str, Any], path: Path, notes: Notes) -> Method | None:
    if told.get("kind") == "auto":
        notes.add((*path, "kind"), "auto only chooses: name the methods it chooses from")
        return None
    choice = method_choice(told, path, notes)
    return None if choice is None else choice.method


def peer_of(told: dict[str, Any], path: Path, notes: Notes) -> Peer | None:
    """The peer of an item without tolerance and points; None, noted, where there is a mistake."""
    if "kind" not in told:
        notes.add((*path, "kind"), "required key is missing")
        return None
    name = notes.one_of(told["kind"], (*path, "kind"), PEERS)
    label = notes.text(told.get("label", ""), (*path, "label"))
    if name is None or (not label and "label" in told):
        return None
    parameters = {key: value for key, value in told.items() if key not in ("kind", "label")}
    return build_record(PEERS[name], parameters, path, notes)
