"""From a bench list (YAML) to a frozen Bench, or to every mistake in it at once, each with its line."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path as FilePath
from typing import Any

from frictionlab import columns
from frictionlab.bench.contenders import Defaults, contenders
from frictionlab.bench.failures.reader import read_failures
from frictionlab.bench.models import read_models
from frictionlab.bench.names import file_stem
from frictionlab.bench.orders import read_orders
from frictionlab.bench.record import Bench, Workload
from frictionlab.bench.references import read_references
from frictionlab.bench.sections import Section, SectionReader, SectionSource
from frictionlab.bench.stability import read_stability
from frictionlab.mistakes.notes import Notes, Path, dotted
from frictionlab.study import Mistake, Study, StudyError
from frictionlab.study.choices import items
from frictionlab.study.load import read_study
from frictionlab.study.yaml_source import Source, read_file

SECTIONS: dict[str, SectionReader] = {
    "orders": read_orders,
    "stability": read_stability,
    "failures": read_failures,
    "models": read_models,
}
"""What reads each key of a list that is neither a curve nor about curves."""
BENCH_KEYS = ("schema", "title", "scenes", "references", "methods", "peers", "repeats", "seconds", *SECTIONS)
SCENE_KEYS = ("name", "title", "scene", "laws", "sweep", "references", "methods", "peers")
OWN_STUDY = ("scene", "laws", "sweep")
BENCH_SCHEMA = 1
REPEATS, SECONDS = 30, 2.0


def load_bench(path: FilePath) -> Bench:
    """The bench list of this file. Raises StudyError with every mistake."""
    source = _source(path)
    notes, mistakes = Notes(source.notes), list[Mistake]()
    bench = _Reading(source, notes, mistakes, path).bench()
    mistakes += source.located(notes.all)
    if mistakes or bench is None:
        raise StudyError(_each_once(mistakes))
    return bench


def _source(path: FilePath) -> Source:
    """The file's values; what is no readable file is told in the words of a list."""
    try:
        return read_file(path)
    except StudyError as problem:
        raise StudyError(
            [replace(each, what=each.what.replace("study", "bench list")) for each in problem.mistakes]
        ) from None


def _each_once(mistakes: list[Mistake]) -> list[Mistake]:
    """In the order of the file; what several scenes refer to is told for the first of them."""
    found = {(mistake.place, mistake.what): mistake for mistake in reversed(mistakes)}
    return sorted(found.values(), key=lambda mistake: mistake.place or (float("inf"), 0))


class _Reading:
    """One pass over a list's values."""

    def __init__(self, source: Source, notes: Notes, mistakes: list[Mistake], path: FilePath) -> None:
        self._source, self._notes, self._mistakes, self._path = source, notes, mistakes, path
        self._tree: dict[str, Any] = source.tree

    def bench(self) -> Bench | None:
        if self._notes.mapping(self._tree, (), BENCH_KEYS) is None:
            return None
        sections = self._sections()
        asked = any(key in self._tree for key in SECTIONS)
        self._notes.head(self._tree, ("schema",) if asked else ("schema", "scenes"), BENCH_SCHEMA)
        repeats = self._notes.whole_number(self._tree.get("repeats", REPEATS), ("repeats",), 1)
        seconds = self._notes.positive(self._tree.get("seconds", SECONDS), ("seconds",))
        title = self._notes.text(self._tree.get("title", ""), ("title",))
        defaults = Defaults(
            read_references(self._tree.get("references", []), ("references",), self._path, self._notes),
            contenders(self._tree, (), self._notes),
        )
        found = self._curves(defaults) if "scenes" in self._tree or not asked else []
        bench = Bench(self._path.stem, title, tuple(found), repeats or 1, seconds or 1.0, sections)
        self._note_equal_names(bench.names)
        return bench

    def _sections(self) -> tuple[Section, ...]:
        """The sections of every key that is there."""
        return tuple(
            section
            for key, read in SECTIONS.items()
            if key in self._tree
            for section in read(SectionSource(self._tree[key], (key,), self._notes, self._study))
        )

    def _curves(self, defaults: Defaults) -> list[Workload]:
        given = self._tree.get("scenes", [])
        blocks = items(given, ("scenes",), "[{name: A, scene: {...}, laws: [...]}]", self._notes)
        return [
            work for index, block in enumerate(blocks) for work in self._workloads(block, index, defaults)
        ]

    def _workloads(self, block: Any, index: int, defaults: Defaults) -> list[Workload]:
        path: Path = ("scenes", index)
        if self._notes.mapping(block, path, SCENE_KEYS) is None:
            return []
        name = self._name(block, path)
        title = self._notes.text(block.get("title", ""), (*path, "title"))
        trusted = read_references(block.get("references", []), (*path, "references"), self._path, self._notes)
        trusted = trusted or defaults.references
        if not trusted and not self._noted("references", path):
            self._notes.add(path, "no references: give a method or values to measure errors against")
        chosen = defaults.contenders | contenders(block, path, self._notes)
        if not chosen and not self._noted("methods", path) and not self._noted("peers", path):
            self._notes.add(path, "no methods and no peers: there is nothing to measure")
        study = self._curve_study(block, path)
        if study is None:
            return []
        return [
            Workload(
                name if len(study.laws) == 1 else f"{name} {choice.label}",
                title,
                tuple(sorted((case.scene for case in cases), key=lambda scene: scene.belt_speed)),
                cases[0].law,
                tuple(chosen.values()),
                trusted,
            )
            for choice in study.laws
            if (cases := [case for case in study.cases() if case.law_label == choice.label])
        ]

    def _noted(self, key: str, path: Path) -> bool:
        """Whether this key has a mistake, in the list or in the scene: then it is not missing."""
        return self._notes.below((key,)) or self._notes.below((*path, key))

    def _name(self, block: dict[str, Any], path: Path) -> str:
        if "name" not in block:
            self._notes.add((*path, "name"), "required key is missing")
            return ""
        name = self._notes.text(block["name"], (*path, "name"))
        if isinstance(block["name"], str) and not re.fullmatch(r"\w[\w.-]*", name):
            self._notes.add((*path, "name"), "names a file: use letters, digits, points, - and _")
        return name

    def _curve_study(self, block: dict[str, Any], path: Path) -> Study | None:
        """The study of a block that sweeps the belt speed alone."""
        sweep = block.get("sweep")
        stray = [key for key in sweep if key not in columns.BELT_SPEEDS] if isinstance(sweep, dict) else []
        for key in stray:
            self._notes.on_key((*path, "sweep", key), "a bench curve sweeps the belt speed alone")
        study = self._study(block, path, stray)
        return None if stray else study

    def _study(self, block: dict[str, Any], path: Path, stray: Sequence[str] = ()) -> Study | None:
        """The scene, laws and sweep as the study they are, read by the study's own reader; mistakes of stray paths
        of the sweep are noted elsewhere.
        """
        try:
            return read_study(_part(self._source, block, path))
        except StudyError as problem:
            head = dotted(path)
            self._mistakes += [
                replace(each, path=f"{head}.{each.path}" if each.path else head)
                for each in problem.mistakes
                if each.path not in [f"sweep.{key}" for key in stray]
            ]
            return None

    def _note_equal_names(self, names: Sequence[str]) -> None:
        for name in {name for name in names if names.count(name) > 1}:
            self._notes.add(("scenes",), f"two curves are called '{name}'; give each its own name")
        files: dict[str, str] = {}
        for name in dict.fromkeys(names):
            other = files.setdefault(file_stem(name).casefold(), name)
            if other != name:
                told = f"'{other}' and '{name}' would both be written to {file_stem(name)}; rename one"
                self._notes.add(("scenes",), told)


def _part(source: Source, block: dict[str, Any], path: Path) -> Source:
    """The keys of a block that make a study, with their places in the whole file."""
    tree = {"schema": BENCH_SCHEMA} | {key: block[key] for key in OWN_STUDY if key in block}
    depth = len(path)
    keys = {at[depth:]: place for at, place in source.keys.items() if at[:depth] == path}
    values = {at[depth:]: place for at, place in source.values.items() if at[:depth] == path}
    return Source(source.name, source.text, tree, keys, values)
