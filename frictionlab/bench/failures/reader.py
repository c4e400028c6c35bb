"""The failure maps of a bench list, from its key ``failures``."""

from __future__ import annotations

from pathlib import Path as FilePath
from typing import Any

from frictionlab import columns
from frictionlab.bench.contenders import contenders
from frictionlab.bench.failures.measure import MapTruth
from frictionlab.bench.failures.record import FailureMap, NamedPoint
from frictionlab.bench.failures.section import FailureSection, by_label
from frictionlab.bench.names import file_stem
from frictionlab.bench.record import Contender
from frictionlab.bench.references import read_references
from frictionlab.bench.sections import Section, SectionSource
from frictionlab.mistakes.notes import Notes, Path
from frictionlab.study import Study
from frictionlab.study.choices import items

MAP_KEYS = ("name", "title", "scene", "laws", "sweep", "points", "references", "methods", "peers")
EXAMPLE = "[{name: damping, scene: {...}, laws: [...], sweep: {...}, methods: [exact]}]"


def read_failures(source: SectionSource) -> tuple[Section, ...]:
    """A section for each method and peer that a list of maps names; mistakes are noted."""
    blocks = items(source.value, source.path, EXAMPLE, source.notes)
    read = [_map(block, (*source.path, index), source) for index, block in enumerate(blocks)]
    maps = [each for each in read if each is not None]
    names = [truth.drawn.name for truth, _ in maps]
    for name in sorted({name for name in names if names.count(name) > 1}):
        source.notes.add(source.path, f"two maps are called '{name}'; give each its own name")
    return tuple(
        FailureSection(f"failures_{file_stem(label)}", label, tuple(given))
        for label, given in by_label(maps).items()
    )


def _map(block: Any, path: Path, source: SectionSource) -> tuple[MapTruth, list[Contender]] | None:
    notes = source.notes
    if notes.mapping(block, path, MAP_KEYS) is None:
        return None
    for key in ("name", "sweep"):
        if key not in block:
            notes.add((*path, key), "required key is missing")
    name, title = (notes.text(block.get(key, ""), (*path, key)) for key in ("name", "title"))
    references = read_references(block.get("references", []), (*path, "references"), FilePath(), notes)
    if any(trusted.solver is None for trusted in references):
        notes.add((*path, "references"), "give methods: a table of values has no place for a second quantity")
    given = list(contenders(block, path, notes).values())
    _note_several(block, path, given, notes)
    if not given and not notes.below((*path, "methods")) and not notes.below((*path, "peers")):
        notes.add(path, "no methods and no peers: there is nothing to measure")
    study = source.study(block, path)
    paths = None if study is None else _paths(study, path, notes)
    if study is None or paths is None or notes.below(path):
        return None
    points = _points(block.get("points", []), (*path, "points"), paths, notes)
    if notes.below(path):
        return None
    return MapTruth(FailureMap(name, title, study, *paths, tuple(points), references)), given


def _note_several(block: dict[str, Any], path: Path, given: list[Contender], notes: Notes) -> None:
    for contender in given:
        if len(contender.solvers) > 1:
            head = "peers" if contender.side == "peer" else "methods"
            notes.add(
                (*path, head), f"'{contender.label}': a map takes one setting; give each a label of its own"
            )


def _paths(study: Study, path: Path, notes: Notes) -> tuple[str, str] | None:
    """The path of the belt speed and that of the other quantity."""
    if len(study.laws) != 1:
        notes.add((*path, "laws"), f"a map has one law, got {len(study.laws)}")
        return None
    speeds = [name for name in study.sweep if name in columns.BELT_SPEEDS]
    others = [name for name in study.sweep if name not in columns.BELT_SPEEDS]
    numbers = [name for name in others if all(isinstance(value, float | int) for value in study.sweep[name])]
    if len(speeds) != 1 or len(others) != 1 or others != numbers:
        notes.add((*path, "sweep"), "a map sweeps the belt speed and one other number")
        return None
    return speeds[0], others[0]


def _points(given: Any, path: Path, paths: tuple[str, str], notes: Notes) -> list[NamedPoint]:
    """``[{name: S2, scene.belt_speed: 0.5, scene.normal_load: 10}]``."""
    listed = items(given, path, "[{name: S2, scene.belt_speed: 0.5, ...}]", notes) if given != [] else []
    found = []
    for index, item in enumerate(listed):
        at: Path = (*path, index)
        if notes.mapping(item, at, ("name", *paths)) is None:
            continue
        for key in ("name", *paths):
            if key not in item:
                notes.add((*at, key), "required key is missing")
        name = notes.text(item.get("name", ""), (*at, "name"))
        speed, value = (notes.number(item.get(key, 1.0), (*at, key)) for key in paths)
        if speed is not None and value is not None:
            found.append(NamedPoint(name, speed, value))
    return found
