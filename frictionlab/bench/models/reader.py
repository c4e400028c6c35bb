"""The comparisons of models in a bench list, from its key ``models``."""

from __future__ import annotations

from copy import deepcopy
from pathlib import Path as FilePath
from typing import Any

from frictionlab import columns
from frictionlab.bench.contenders import contenders
from frictionlab.bench.models.section import BenchedModel, ModelsSection
from frictionlab.bench.names import file_stem
from frictionlab.bench.record import Bench, Contender, ReferenceSource, Workload
from frictionlab.bench.references import read_references
from frictionlab.bench.sections import Section, SectionSource
from frictionlab.mistakes.notes import Notes, Path
from frictionlab.study import LawChoice, Study
from frictionlab.study.choices import items

MODEL_KEYS = (
    *("name", "title", "scene", "laws", "sweep", "without", "references", "methods", "peers"),
    *("repeats", "seconds"),
)
EXAMPLE_OF_MODELS = "[{name: resonance, scene: {...}, laws: [...], sweep: {...}, methods: [exact]}]"
REPEATS_OF_MODELS, SECONDS_OF_MODELS = 20, 1.0


def read_models(source: SectionSource) -> tuple[Section, ...]:
    """A section for each scene whose models are compared; mistakes are noted."""
    blocks = items(source.value, source.path, EXAMPLE_OF_MODELS, source.notes)
    read = [_section(block, (*source.path, index), source) for index, block in enumerate(blocks)]
    sections = [each for each in read if each is not None]
    names = [each.name for each in sections]
    for name in sorted({name for name in names if names.count(name) > 1}):
        source.notes.add(
            source.path, f"two comparisons of models are called '{name}'; give each its own name"
        )
    return tuple(sections)


def _section(block: Any, path: Path, source: SectionSource) -> ModelsSection | None:
    """The first law on the whole scene is the richest model; the others are measured against it."""
    notes = source.notes
    if notes.mapping(block, path, MODEL_KEYS) is None:
        return None
    for key in ("name", "sweep", "references"):
        if key not in block:
            notes.add((*path, key), "required key is missing")
    name, title = (notes.text(block.get(key, ""), (*path, key)) for key in ("name", "title"))
    repeats = notes.whole_number(block.get("repeats", REPEATS_OF_MODELS), (*path, "repeats"), 1)
    seconds = notes.positive(block.get("seconds", SECONDS_OF_MODELS), (*path, "seconds"))
    trusted = read_references(block.get("references", []), (*path, "references"), FilePath(), notes)
    if any(each.solver is None for each in trusted):
        notes.add((*path, "references"), "give methods: a table of values knows one model alone")
    given = tuple(contenders(block, path, notes).values())
    if not given and not notes.below((*path, "methods")) and not notes.below((*path, "peers")):
        notes.add(path, "no methods and no peers: there is nothing to measure")
    models = [
        model
        for without in (None, *_left_out(block, path, notes))
        for model in _models(block, without, path, source, given, trusted)
    ]
    if notes.below(path) or not models or repeats is None or seconds is None:
        return None
    return ModelsSection(
        f"models_{file_stem(name)}", title, tuple(models), Bench(name, title, (), repeats, seconds)
    )


def _left_out(block: dict[str, Any], path: Path, notes: Notes) -> list[str]:
    """The parts of the scene that simpler ones lack: dotted paths to keys that are there."""
    given = items(block["without"], (*path, "without"), "[transverse]", notes) if "without" in block else []
    found = []
    for index, item in enumerate(given):
        part = notes.text(item, (*path, "without", index))
        if part and _cut(block["scene"], part) is None:
            notes.add((*path, "without", index), f"the scene has no '{part}'; give the path of a key of it")
        elif part:
            found.append(part)
    return found


def _cut(scene: Any, part: str) -> dict[str, Any] | None:
    """The scene without the key at this path; None where it has none."""
    left = deepcopy(scene)
    *above, key = part.split(".")
    inside = left
    for name in above:
        inside = inside.get(name) if isinstance(inside, dict) else None
    if not isinstance(inside, dict) or key not in inside:
        return None
    del inside[key]
    return dict(left)


def _models(
    block: dict[str, Any],
    without: str | None,
    path: Path,
    source: SectionSource,
    given: tuple[Contender, ...],
    trusted: tuple[ReferenceSource, ...],
) -> list[BenchedModel]:
    """Every law on the scene without this part."""
    whole = block if without is None else block | {"scene": _cut(block["scene"], without)}
    study = source.study(whole, path)
    if study is None:
        return []
    stray = [key for key in study.sweep if key not in columns.BELT_SPEEDS]
    if stray or not study.sweep:
        source.notes.add((*path, "sweep"), "models are compared along one curve: sweep the belt speed alone")
        return []
    return [_model(study, choice, without, given, trusted) for choice in study.laws]


def _model(
    study: Study,
    choice: LawChoice,
    without: str | None,
    given: tuple[Contender, ...],
    trusted: tuple[ReferenceSource, ...],
) -> BenchedModel:
    cases = sorted(
        (case for case in study.cases() if case.law_label == choice.label),
        key=lambda case: case.scene.belt_speed,
    )
    scene = "" if without is None else f"without {without}"
    name = f"{choice.label} {scene}".strip()
    scenes = tuple(case.scene for case in cases)
    return BenchedModel(choice.label, scene, Workload(name, "", scenes, cases[0].law, given, trusted))
