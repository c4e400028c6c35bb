"""A block of a bench list: a scene with laws and a sweep, and who is measured on it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path as FilePath
from typing import Any, NamedTuple, TypeVar

from frictionlab import columns
from frictionlab.bench.entries import contenders, references
from frictionlab.bench.record import Contender, ReferenceSource, Workload
from frictionlab.mistakes.notes import Notes, Path, dotted
from frictionlab.study import Mistake, Study, StudyError
from frictionlab.study.choices import items
from frictionlab.study.load import read_study
from frictionlab.study.yaml_source import Source

OWN_STUDY = ("scene", "laws", "sweep")
BLOCK_KEYS = ("name", "title", *OWN_STUDY, "references", "methods", "peers")
EXAMPLE = "[{name: A, scene: {...}, laws: [...], sweep: {...}, methods: [exact]}]"
Named = TypeVar("Named")


class Defaults(NamedTuple):
    """What holds for every block that does not say otherwise; folder: of its tables of values, None for none."""

    references: tuple[ReferenceSource, ...] = ()
    contenders: Mapping[str, Contender] = {}
    repeats: int = 20
    seconds: float = 1.0
    folder: FilePath | None = None


@dataclass(frozen=True)
class BenchBlock:
    """A block without mistakes but for what its section asks beside; told: its keys as they are written."""

    path: Path
    told: dict[str, Any]
    name: str
    title: str
    contenders: tuple[Contender, ...]
    references: tuple[ReferenceSource, ...]
    repeats: int
    seconds: float

    def workloads(self, study: Study) -> Iterator[tuple[str, Workload]]:
        """The curve of each law, by its label."""
        for choice in study.laws:
            cases = [case for case in study.cases() if case.law_label == choice.label]
            scenes = sorted((case.scene for case in cases), key=lambda scene: scene.belt_speed)
            timed = self.repeats, self.seconds
            yield (
                choice.label,
                Workload(tuple(scenes), cases[0].law, self.contenders, self.references, *timed),
            )


@dataclass
class BlockReader:
    """Reads blocks of a list; mistakes: those of their studies, located."""

    source: Source
    notes: Notes
    mistakes: list[Mistake] = field(default_factory=list)

    def blocks(
        self, given: Any, path: Path, more: Sequence[str], required: Sequence[str], defaults: Defaults
    ) -> list[BenchBlock]:
        """Every block of a list, more: its keys beside those of all blocks; mistakes are noted."""
        listed = items(given, path, EXAMPLE, self.notes)
        read = [self._block(item, (*path, i), more, required, defaults) for i, item in enumerate(listed)]
        return [block for block in read if block is not None]

    def _block(
        self, given: Any, path: Path, more: Sequence[str], required: Sequence[str], defaults: Defaults
    ) -> BenchBlock | None:
        notes = self.notes
        if notes.mapping(given, path, (*BLOCK_KEYS, *more)) is None:
            return None
        for key in (key for key in required if key not in given):
            notes.add((*path, key), "required key is missing")
        name, title = (notes.text(given.get(key, ""), (*path, key)) for key in ("name", "title"))
        own = given.keys() & {*more}
        repeats, seconds = defaults.repeats, defaults.seconds
        if "repeats" in own:
            repeats = notes.whole_number(given["repeats"], (*path, "repeats"), 1) or 1
        if "seconds" in own:
            seconds = notes.positive(given["seconds"], (*path, "seconds")) or 1.0
        trusted = references(given, path, defaults.folder, notes) or defaults.references
        chosen = {**defaults.contenders, **contenders(given, path, notes)}
        if not chosen and not self._noted("methods", path) and not self._noted("peers", path):
            notes.add(path, "no methods and no peers: there is nothing to measure")
        return BenchBlock(path, given, name, title, tuple(chosen.values()), trusted, repeats, seconds)

    def _noted(self, key: str, path: Path) -> bool:
        """Whether this key has a mistake, in the list or in the block: then it is not missing."""
        return self.notes.below((key,)) or self.notes.below((*path, key))

    def note_without_references(self, block: BenchBlock) -> None:
        """Errors are measured against something."""
        if not block.references and not self._noted("references", block.path):
            told = "no references: give a method or values to measure errors against"
            self.notes.add(block.path, told)

    def curve(self, block: BenchBlock, told: dict[str, Any] | None = None) -> Study | None:
        """The study of a block that sweeps the belt speed alone; told: in place of what the block says."""
        told = block.told if told is None else told
        sweep = told.get("sweep")
        stray = [key for key in sweep if key not in columns.BELT_SPEEDS] if isinstance(sweep, dict) else []
        for key in stray:
            self.notes.on_key((*block.path, "sweep", key), "a bench curve sweeps the belt speed alone")
        study = self.study(told, block.path, stray)
        return None if stray else study

    def study(self, told: dict[str, Any], path: Path, stray: Sequence[str] = ()) -> Study | None:
        """The scene, laws and sweep as the study they are, read by the study's own reader; mistakes of stray paths
        of the sweep are noted elsewhere.
        """
        try:
            return read_study(self._part(told, path))
        except StudyError as problem:
            head = dotted(path)
            self.mistakes += [
                replace(each, path=f"{head}.{each.path}" if each.path else head)
                for each in problem.mistakes
                if each.path not in [f"sweep.{key}" for key in stray]
            ]
            return None

    def _part(self, told: dict[str, Any], path: Path) -> Source:
        """The keys of a block that make a study, with their places in the whole file."""
        tree = {"schema": 1} | {key: told[key] for key in OWN_STUDY if key in told}
        keys, values = (
            {at[len(path) :]: place for at, place in places.items() if at[: len(path)] == path}
            for places in (self.source.keys, self.source.values)
        )
        return Source(self.source.name, self.source.text, tree, keys, values)

    def chosen(
        self, tree: dict[str, Any], path: Path, key: str, known: Mapping[str, Named]
    ) -> tuple[Named, ...]:
        """What a list names; all there is where the key is left out."""
        at = (*path, key)
        named = items(tree[key], at, f"[{next(iter(known))}]", self.notes) if key in tree else list(known)
        read = [self.notes.one_of(name, (*at, i), known) for i, name in enumerate(named)]
        return tuple(known[name] for name in read if name is not None)

    def note_equal(self, names: Sequence[str], path: Path, what: str) -> None:
        """Two blocks of one name would be written to one file."""
        for name in sorted({name for name in names if names.count(name) > 1}):
            self.notes.add(path, f"two {what} are called '{name}'; give each its own name")
