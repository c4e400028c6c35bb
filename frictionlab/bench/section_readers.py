"""The sections of a bench list: curves, orders, stability maps, failure maps, comparisons of models."""

from __future__ import annotations

import re
from collections.abc import Sequence
from copy import deepcopy
from typing import Any

from frictionlab import columns
from frictionlab.bench.block import BenchBlock, BlockReader, Defaults
from frictionlab.bench.curve import BenchCurve
from frictionlab.bench.failures.measure import MapTruth
from frictionlab.bench.failures.record import FailureMap, NamedPoint
from frictionlab.bench.failures.section import FailureSection, by_label
from frictionlab.bench.models.record import BenchedModel
from frictionlab.bench.models.section import ModelsSection
from frictionlab.bench.orders.motions import MOTIONS
from frictionlab.bench.orders.section import OrdersSection
from frictionlab.bench.orders.solvers import ORDER_SOLVERS
from frictionlab.bench.sections import Section, file_stem
from frictionlab.bench.stability.peers import MAPPED_PEERS
from frictionlab.bench.stability.problems import PROBLEMS
from frictionlab.bench.stability.section import StabilitySection
from frictionlab.bench.stability.steppers import MAPPED_STEPPERS
from frictionlab.mistakes.notes import Path
from frictionlab.study import Study
from frictionlab.study.choices import items

ORDERS_KEYS = ("motions", "steppers", "samples")
GRIDS_OF_A_STEP = 40
STABILITY_KEYS = ("steppers", "peers", "problems", "grid")
GRID = 70
"""Settings, and rates: about 5,000 points a stepper and problem."""


def read_curves(reader: BlockReader, given: Any, path: Path, defaults: Defaults) -> list[Section]:
    """A curve for each law of each scene."""
    found: list[Section] = []
    for block in reader.blocks(given, path, (), ("name",), defaults):
        if block.name and not re.fullmatch(r"\w[\w.-]*", block.name):
            reader.notes.add((*block.path, "name"), "names a file: use letters, digits, points, - and _")
        reader.note_without_references(block)
        if study := reader.curve(block):
            for label, work in block.workloads(study):
                name = block.name if len(study.laws) == 1 else f"{block.name} {label}"
                found.append(BenchCurve(name, block.title, work))
    return found


def read_orders(reader: BlockReader, given: Any, path: Path) -> Sequence[Section]:
    """``true``, or which motions, which steppers, and how many samples of irregular errors."""
    tree = {} if given is True else reader.notes.mapping(given, path, ORDERS_KEYS)
    if tree is None:
        return ()
    motions = reader.chosen(tree, path, "motions", MOTIONS)
    solvers = reader.chosen(tree, path, "steppers", ORDER_SOLVERS)
    samples = reader.notes.whole_number(tree.get("samples", GRIDS_OF_A_STEP), (*path, "samples"), 1)
    if samples is None or reader.notes.below(path):
        return ()
    return (OrdersSection(motions, solvers, samples),)


def read_stability(reader: BlockReader, given: Any, path: Path) -> Sequence[Section]:
    """``true``, or which steppers and peers, on which problems, on a grid of how many by how many.

    To name steppers alone is to ask for no peers, and the other way round.
    """
    tree = {} if given is True else reader.notes.mapping(given, path, STABILITY_KEYS)
    if tree is None:
        return ()
    named = {"steppers", "peers"} & tree.keys() or {"steppers", "peers"}
    ours = reader.chosen(tree, path, "steppers", MAPPED_STEPPERS) if "steppers" in named else ()
    theirs = reader.chosen(tree, path, "peers", MAPPED_PEERS) if "peers" in named else ()
    problems = reader.chosen(tree, path, "problems", PROBLEMS)
    grid = reader.notes.whole_number(tree.get("grid", GRID), (*path, "grid"), 2)
    if grid is None or reader.notes.below(path):
        return ()
    return [StabilitySection(each, problems, grid) for each in (*ours, *theirs)]


def read_models(reader: BlockReader, given: Any, path: Path) -> Sequence[Section]:
    """For each scene its models: the first law on the whole scene is the richest, which others are held against."""
    more, required = ("without", "repeats", "seconds"), ("name", "sweep", "references")
    blocks = reader.blocks(given, path, more, required, Defaults())
    reader.note_equal([block.name for block in blocks], path, "comparisons of models")
    found = []
    for block in blocks:
        parts = [None, *_parts_left_out(reader, block)]
        compared = [model for part in parts for model in _models(reader, block, part)]
        if compared and not reader.notes.below(block.path):
            found.append(ModelsSection(f"models_{file_stem(block.name)}", block.title, tuple(compared)))
    return found


def _parts_left_out(reader: BlockReader, block: BenchBlock) -> list[str]:
    """The parts of the scene that simpler ones lack: dotted paths to keys that are there."""
    at, found = (*block.path, "without"), []
    given = items(block.told["without"], at, "[transverse]", reader.notes) if "without" in block.told else []
    for index, item in enumerate(given):
        part = reader.notes.text(item, (*at, index))
        if part and _cut(block.told.get("scene"), part) is None:
            reader.notes.add((*at, index), f"the scene has no '{part}'; give the path of a key of it")
        elif part:
            found.append(part)
    return found


def _cut(scene: Any, part: str) -> dict[str, Any] | None:
    """The scene without the key at this path; None where it has none."""
    left = inside = deepcopy(scene)
    *above, key = part.split(".")
    for name in above:
        inside = inside.get(name) if isinstance(inside, dict) else None
    if not isinstance(inside, dict) or key not in inside:
        return None
    del inside[key]
    return dict(left)


def _models(reader: BlockReader, block: BenchBlock, without: str | None) -> list[BenchedModel]:
    """Every law on the scene without this part."""
    told = block.told if without is None else block.told | {"scene": _cut(block.told["scene"], without)}
    study = reader.curve(block, told)
    if study is None:
        return []
    if not study.sweep:
        reader.notes.add((*block.path, "sweep"), "models are compared along one curve: sweep the belt speed")
        return []
    scene = "" if without is None else f"without {without}"
    return [BenchedModel(label, scene, work) for label, work in block.workloads(study)]


def read_failures(reader: BlockReader, given: Any, path: Path) -> Sequence[Section]:
    """A section for each method and peer that a list of maps names."""
    blocks = reader.blocks(given, path, ("points",), ("name", "sweep"), Defaults())
    read = [(drawn, block) for block in blocks if (drawn := _map(reader, block)) is not None]
    reader.note_equal([block.name for _, block in read], path, "maps")
    maps = by_label([(MapTruth(drawn), block.contenders) for drawn, block in read])
    return [
        FailureSection(f"failures_{file_stem(label)}", label, tuple(each)) for label, each in maps.items()
    ]


def _map(reader: BlockReader, block: BenchBlock) -> FailureMap | None:
    for contender in (each for each in block.contenders if len(each.solvers) > 1):
        head = "peers" if contender.side == "peer" else "methods"
        told = f"'{contender.label}': a map takes one setting; give each a label of its own"
        reader.notes.add((*block.path, head), told)
    study = reader.study(block.told, block.path)
    paths = None if study is None else _paths(reader, study, block.path)
    if study is None or paths is None or reader.notes.below(block.path):
        return None
    points = _points(reader, block, paths)
    if reader.notes.below(block.path):
        return None
    return FailureMap(block.name, block.title, study, *paths, tuple(points), block.references)


def _paths(reader: BlockReader, study: Study, path: Path) -> tuple[str, str] | None:
    """The path of the belt speed and that of the other quantity."""
    if len(study.laws) != 1:
        reader.notes.add((*path, "laws"), f"a map has one law, got {len(study.laws)}")
        return None
    speeds = [name for name in study.sweep if name in columns.BELT_SPEEDS]
    others = [name for name in study.sweep if name not in columns.BELT_SPEEDS]
    numbers = [name for name in others if all(isinstance(value, float | int) for value in study.sweep[name])]
    if len(speeds) != 1 or len(others) != 1 or others != numbers:
        reader.notes.add((*path, "sweep"), "a map sweeps the belt speed and one other number")
        return None
    return speeds[0], others[0]


def _points(reader: BlockReader, block: BenchBlock, paths: tuple[str, str]) -> list[NamedPoint]:
    """``[{name: S2, scene.belt_speed: 0.5, scene.normal_load: 10}]``."""
    notes, path = reader.notes, (*block.path, "points")
    given = block.told.get("points", [])
    found = []
    for index, item in enumerate(items(given, path, "[{name: S2, ...}]", notes) if given != [] else []):
        at: Path = (*path, index)
        if notes.mapping(item, at, ("name", *paths)) is None:
            continue
        for key in (key for key in ("name", *paths) if key not in item):
            notes.add((*at, key), "required key is missing")
        name = notes.text(item.get("name", ""), (*at, "name"))
        speed, value = (notes.number(item.get(key, 1.0), (*at, key)) for key in paths)
        if speed is not None and value is not None:
            found.append(NamedPoint(name, speed, value))
    return found
