"""From a bench list (YAML) to a frozen Bench, or to every mistake in it at once, each with its line."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path as FilePath
from typing import Any

from frictionlab.bench import section_readers
from frictionlab.bench.block import BlockReader, Defaults
from frictionlab.bench.entries import contenders, references
from frictionlab.bench.listed import Bench
from frictionlab.bench.sections import Section, file_stem
from frictionlab.mistakes.notes import Notes, Path
from frictionlab.study import Mistake, StudyError
from frictionlab.study.yaml_source import Source, read_file

SectionReader = Callable[[BlockReader, Any, Path], Sequence[Section]]
"""The sections of the value of a key; empty, noted, where there is a mistake."""
SECTIONS: dict[str, SectionReader] = {
    "orders": section_readers.read_orders,
    "stability": section_readers.read_stability,
    "failures": section_readers.read_failures,
    "models": section_readers.read_models,
}
"""What reads each key of a list that is neither a curve nor about curves."""
BENCH_KEYS = ("schema", "title", "scenes", "references", "methods", "peers", "repeats", "seconds", *SECTIONS)
BENCH_SCHEMA = 1
REPEATS, SECONDS = 30, 2.0


def load_bench(path: FilePath) -> Bench:
    """The bench list of this file. Raises StudyError with every mistake."""
    source = _source(path)
    blocks = BlockReader(source, Notes(source.notes))
    bench = _bench(source.tree, blocks, path)
    mistakes = blocks.mistakes + source.located(blocks.notes.all)
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


def _bench(tree: Any, blocks: BlockReader, path: FilePath) -> Bench | None:
    notes = blocks.notes
    if notes.mapping(tree, (), BENCH_KEYS) is None:
        return None
    asked = any(key in tree for key in SECTIONS)
    notes.head(tree, ("schema",) if asked else ("schema", "scenes"), BENCH_SCHEMA)
    title = notes.text(tree.get("title", ""), ("title",))
    repeats = notes.whole_number(tree.get("repeats", REPEATS), ("repeats",), 1)
    seconds = notes.positive(tree.get("seconds", SECONDS), ("seconds",))
    sections: list[Section] = []
    if "scenes" in tree or not asked:
        folder = path.parent
        own = references(tree, (), folder, notes), contenders(tree, (), notes)
        defaults = Defaults(*own, repeats or 1, seconds or 1.0, folder)
        sections += section_readers.read_curves(blocks, tree.get("scenes", []), ("scenes",), defaults)
    for key, read in SECTIONS.items():
        if key in tree:
            sections += read(blocks, tree[key], (key,))
    _note_equal_names([section.name for section in sections], notes)
    return Bench(path.stem, title, tuple(sections))


def _note_equal_names(names: Sequence[str], notes: Notes) -> None:
    for name in {name for name in names if names.count(name) > 1}:
        notes.add(("scenes",), f"two curves are called '{name}'; give each its own name")
    files: dict[str, str] = {}
    for name in dict.fromkeys(names):
        other = files.setdefault(file_stem(name).casefold(), name)
        if other != name:
            told = f"'{other}' and '{name}' would both be written to {file_stem(name)}; rename one"
            notes.add(("scenes",), told)
