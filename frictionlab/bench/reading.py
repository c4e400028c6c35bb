"""From a bench list (YAML) to a frozen Bench, or to every mistake in it at once, each with its line."""

from __future__ import annotations

import csv
import re
from collections.abc import Iterator, Sequence
from copy import deepcopy
from dataclasses import dataclass, field, replace
from pathlib import Path as FilePath
from typing import Annotated, Any, TypeVar

from pydantic import AfterValidator

from frictionlab.bench.curve import BenchCurve, BenchedModel, ModelsSection
from frictionlab.bench.failure_maps import FailureMap, MapTruth, NamedPoint
from frictionlab.bench.failures import failure_sections
from frictionlab.bench.listed import PEERS, Bench
from frictionlab.bench.orders import OrdersSection
from frictionlab.bench.peers.base import Peer
from frictionlab.bench.record import (
    FILLED,
    AtLeastOne,
    BenchSetting,
    Contender,
    ReferenceSource,
    Section,
    Workload,
    file_stem,
)
from frictionlab.bench.stability import StabilityMaps
from frictionlab.methods.base import Method
from frictionlab.study.load import read_study
from frictionlab.study.parts import items, method_choice
from frictionlab.study.study import Study
from frictionlab.study.yaml_source import Source, read_file
from frictionlab.values import columns
from frictionlab.values.notes import KeyPath, Mistake, Notes, StudyError, dotted
from frictionlab.values.quantities import Positive, Record
from frictionlab.values.validation import build_record

BENCH_SCHEMA = 1
REFERENCE_COLUMNS = ("belt_speed", "mean_friction")
OF_A_STUDY = ("scene", "laws", "sweep")

Many = Annotated[tuple[Any, ...], FILLED]


def _of_a_file(name: str) -> str:
    if not re.fullmatch(r"\w[\w.-]*", name):
        raise ValueError("names a file: use letters, digits, points, - and _")
    return name


class Measured(Record):
    """Who is measured and against whom, of a list or of one of its blocks."""

    references: tuple[Any, ...] = ()
    methods: Many = ()
    peers: Many = ()


class ListKeys(Measured):
    """The keys of a list, but for its schema."""

    title: str = ""
    scenes: Many = ()
    repeats: AtLeastOne = 30
    seconds: Positive = 2.0
    orders: Any = None
    stability: Any = None
    failures: Many = ()
    models: Many = ()


class ListItem(Measured):
    """A study, whose keys are checked by the reader of studies, and who is measured on it."""

    name: str
    title: str = ""
    scene: Any = None
    laws: Any = None
    sweep: Any = None


class CurveBlock(ListItem):
    """An item of ``scenes``."""

    name: Annotated[str, AfterValidator(_of_a_file)]


class MapBlock(ListItem):
    """An item of ``failures``."""

    sweep: Any
    points: Many = ()


class ModelsBlock(ListItem):
    """An item of ``models``."""

    sweep: Any
    references: Many
    without: Annotated[tuple[str, ...], FILLED] = ()
    repeats: AtLeastOne = 20
    seconds: Positive = 1.0


class Asked(Record):
    """What a method or peer is asked for beside its own parameters."""

    tolerance: Positive = 1e-8
    points: AtLeastOne | None = None


class ValuesOfFile(Record):
    """Reference values from a file, relative to the list, and how well they are known."""

    values: str
    error: Positive
    label: str = ""


_KeysT = TypeVar("_KeysT", bound=Measured)


def load_bench(path: FilePath) -> Bench:
    """The bench list of this file. Raises StudyError with every mistake."""
    source = _source(path)
    reader = _Reader(source, path.parent, Notes(source.notes))
    title, sections = reader.read(source.tree)
    if mistakes := reader.mistakes + source.located(reader.notes.all):
        raise StudyError(_each_once(mistakes))
    return Bench(path.stem, title, tuple(sections))


def _source(path: FilePath) -> Source:
    """The file's values; what is no readable file is told in the words of a list."""
    try:
        return read_file(path)
    except StudyError as problem:
        said = [replace(each, what=each.what.replace("study", "bench list")) for each in problem.mistakes]
        raise StudyError(said) from None


def _each_once(mistakes: list[Mistake]) -> list[Mistake]:
    """In the order of the file; what several scenes refer to is told for the first of them."""
    found = {(mistake.place, mistake.what): mistake for mistake in reversed(mistakes)}
    return sorted(found.values(), key=lambda mistake: mistake.place or (float("inf"), 0))


@dataclass
class _Reader:
    """One pass over the values of a list; mistakes: those of the studies in it, located."""

    source: Source
    folder: FilePath
    notes: Notes
    mistakes: list[Mistake] = field(default_factory=list)

    def read(self, tree: Any) -> tuple[str, list[Section]]:
        """The title, and every section; empty where there are mistakes."""
        notes, names = self.notes, ListKeys.model_fields
        if notes.mapping(tree, (), ("schema", *names)) is None:
            return "", []
        sections = tree.keys() & {"orders", "stability", "failures", "models"}
        notes.head(tree, ["schema"] if sections else ["schema", "scenes"], BENCH_SCHEMA)
        told = {key: value for key, value in tree.items() if key in names}
        if (keys := build_record(ListKeys, told, (), notes)) is None:
            return "", []
        found = [*self._curves(keys), *self._records(keys), *self._maps(keys), *self._models(keys)]
        self._note_equal([section.name for section in found], ("scenes",))
        return keys.title, found

    def _records(self, keys: ListKeys) -> Iterator[Section]:
        """Sections that are one record each; ``true`` asks for all they have."""
        for head, kind in (("orders", OrdersSection), ("stability", StabilityMaps)):
            if (given := getattr(keys, head)) is None:
                continue
            made: Any = build_record(kind, {} if given is True else given, (head,), self.notes)
            if made is not None:
                yield from made.sections()

    # --- blocks: a study each -------------------------------------------------------------------------------------

    def _blocks(self, kind: type[_KeysT], keys: ListKeys, head: str) -> Iterator[tuple[KeyPath, _KeysT]]:
        """The blocks of a key of the list, with their places; none whose own keys are wrong."""
        for index, given in enumerate(getattr(keys, head)):
            if (block := build_record(kind, given, (head, index), self.notes)) is not None:
                yield (head, index), block

    def _curves(self, keys: ListKeys) -> Iterator[Section]:
        """A curve for each law of each scene; what a scene does not say holds for all."""
        if not keys.scenes:
            return
        shared, trusted = self._contenders(keys, ()), self._references(keys, ())
        for path, block in self._blocks(CurveBlock, keys, "scenes"):
            references = self._references(block, path) or trusted
            contenders = self._measured(block, path, shared)
            if not references and not self.notes.all:
                self.notes.add(path, "no references: give a method or values to measure errors against")
            study = self._curve(_told(block), path)
            if study is None:
                continue
            for label, work in _workloads(study, contenders, references, (keys.repeats, keys.seconds)):
                name = block.name if len(study.laws) == 1 else f"{block.name} {label}"
                yield BenchCurve(name, block.title, work)

    def _maps(self, keys: ListKeys) -> list[Section]:
        """A section for each method and peer that a list of maps names."""
        found = list[tuple[MapTruth, Sequence[Contender]]]()
        for path, block in self._blocks(MapBlock, keys, "failures"):
            contenders = self._measured(block, path)
            references = self._references(block, path, files=False)
            for contender in (each for each in contenders if len(each.solvers) > 1):
                told = f"'{contender.label}': a map takes one setting; give each a label of its own"
                self.notes.add((*path, f"{contender.side}s"), told)
            study = self._study(_told(block), path)
            paths = None if study is None else self._swept(study, path)
            if study is not None and paths is not None:
                points = tuple(self._points(block, path, paths))
                drawn = FailureMap(block.name, block.title, study, *paths, points, references)
                found.append((MapTruth(drawn), contenders))
        self._note_equal([truth.drawn.name for truth, _ in found], ("failures",))
        return [*failure_sections(found)]

    def _swept(self, study: Study, path: KeyPath) -> tuple[str, str] | None:
        """The path of the belt speed and that of the other quantity."""
        if len(study.laws) != 1:
            self.notes.add((*path, "laws"), f"a map has one law, got {len(study.laws)}")
            return None
        speeds = [name for name in study.sweep if name in columns.BELT_SPEEDS]
        others = [name for name in study.sweep if name not in columns.BELT_SPEEDS]
        plain = all(isinstance(value, float | int) for name in others for value in study.sweep[name])
        if len(speeds) != 1 or len(others) != 1 or not plain:
            self.notes.add((*path, "sweep"), "a map sweeps the belt speed and one other number")
            return None
        return speeds[0], others[0]

    def _points(self, block: MapBlock, path: KeyPath, paths: tuple[str, str]) -> Iterator[NamedPoint]:
        """``[{name: S2, scene.belt_speed: 0.5, scene.normal_load: 10}]``."""
        notes, keys = self.notes, ("name", *paths)
        for index, item in enumerate(block.points):
            at: KeyPath = (*path, "points", index)
            if notes.mapping(item, at, keys) is None:
                continue
            for key in (key for key in keys if key not in item):
                notes.add((*at, key), "required key is missing")
            name = notes.text(item.get("name", ""), (*at, "name"))
            speed, value = (notes.number(item.get(key, 1.0), (*at, key)) for key in paths)
            if speed is not None and value is not None:
                yield NamedPoint(name, speed, value)

    def _models(self, keys: ListKeys) -> Iterator[Section]:
        """Of each scene: the first law on all of it is the richest model, which the others are held against."""
        for path, block in self._blocks(ModelsBlock, keys, "models"):
            contenders = self._measured(block, path)
            references = self._references(block, path, files=False)
            found = list[BenchedModel]()
            for lacking, told in self._scenes(block, path):
                if (study := self._curve(told, path)) is None:
                    continue
                if not study.sweep:
                    what = "models are compared along one curve: sweep the belt speed"
                    self.notes.add((*path, "sweep"), what)
                works = _workloads(study, contenders, references, (block.repeats, block.seconds))
                found += [BenchedModel(label, lacking, work) for label, work in works]
            if found:
                yield ModelsSection(f"models_{file_stem(block.name)}", block.title, tuple(found))

    def _scenes(self, block: ModelsBlock, path: KeyPath) -> Iterator[tuple[str, dict[str, Any]]]:
        """The study of a block, and that without each part of the scene that simpler ones lack."""
        told = _told(block)
        yield "", told
        for index, part in enumerate(block.without):
            if (left := _cut(block.scene, part)) is None:
                what = f"the scene has no '{part}'; give the path of a key of it"
                self.notes.add((*path, "without", index), what)
            else:
                yield f"without {part}", told | {"scene": left}

    def _curve(self, told: dict[str, Any], path: KeyPath) -> Study | None:
        """The study of a block that sweeps the belt speed alone."""
        sweep = told.get("sweep")
        stray = [key for key in sweep if key not in columns.BELT_SPEEDS] if isinstance(sweep, dict) else []
        for key in stray:
            self.notes.on_key((*path, "sweep", key), "a bench curve sweeps the belt speed alone")
        if isinstance(sweep, dict) and stray:  # their own mistakes matter no more
            told = {**told, "sweep": {key: value for key, value in sweep.items() if key not in stray}}
        study = self._study(told, path)
        return None if stray else study

    def _study(self, told: dict[str, Any], path: KeyPath) -> Study | None:
        """The scene, laws and sweep as the study they are, read by the study's own reader."""
        keys, values = (
            {at[len(path) :]: place for at, place in places.items() if at[: len(path)] == path}
            for places in (self.source.keys, self.source.values)
        )
        try:
            return read_study(Source(self.source.name, self.source.text, told, keys, values))
        except StudyError as problem:
            head = dotted(path)
            self.mistakes += [
                replace(each, path=f"{head}.{each.path}".removesuffix(".")) for each in problem.mistakes
            ]
            return None

    # --- who is measured ------------------------------------------------------------------------------------------

    def _measured(
        self, block: ListItem, path: KeyPath, shared: dict[str, Contender] | None = None
    ) -> tuple[Contender, ...]:
        """The methods and peers of a block, and those of all."""
        found = (shared or {}) | self._contenders(block, path)
        if not found and not self.notes.all:
            self.notes.add(path, "no methods and no peers: there is nothing to measure")
        return tuple(found.values())

    def _contenders(self, told: Measured, path: KeyPath) -> dict[str, Contender]:
        """The methods and peers of a list or of one of its blocks, by label."""
        found: dict[str, Contender] = {}
        for head in ("methods", "peers"):
            for index, item in enumerate(getattr(told, head)):
                at: KeyPath = (*path, head, index)
                made = self._contender({"kind": item} if isinstance(item, str) else item, at, head)
                if made is not None and made.label in found:
                    self.notes.add(at, f"'{made.label}' is there already; give each its own label")
                elif made is not None:
                    found[made.label] = made
        return found

    def _contender(self, item: Any, path: KeyPath, head: str) -> Contender | None:
        """A method or peer; one of its values may be a list, which is run through."""
        if self.notes.mapping(item, path) is None:
            return None
        varied = [key for key in item if isinstance(item[key], list) and key != "points"]
        if len(varied) > 1:
            self.notes.add((*path, varied[1]), f"only one value may be a list, and {varied[0]} is one")
            return None
        quantity = varied[0] if varied else ""
        values = items(item[quantity], (*path, quantity), "[1.0e-6]", self.notes) if varied else [0.0]
        solvers, points = list[tuple[BenchSetting, Method | Peer]](), None
        for value in values:
            each = item | {quantity: value} if varied else item
            asked = {key: each[key] for key in Asked.model_fields if key in each}
            setting = build_record(Asked, asked, path, self.notes)
            told = {key: value for key, value in each.items() if key not in asked}
            solver = self._peer(told, path) if head == "peers" else self._method(told, path)
            if setting is None or solver is None or self.notes.below(path):
                return None
            solvers.append((BenchSetting(quantity, float(value), setting.tolerance), solver))
            points = setting.points
        kind = str(item["kind"])
        return Contender(str(item.get("label", kind)), kind, tuple(solvers), points) if solvers else None

    def _method(self, told: dict[str, Any], path: KeyPath) -> Method | None:
        if told.get("kind") == "auto":
            self.notes.add((*path, "kind"), "auto only chooses: name the methods it chooses from")
            return None
        choice = method_choice(told, path, self.notes)
        return None if choice is None else choice.method

    def _peer(self, told: dict[str, Any], path: KeyPath) -> Peer | None:
        name = self.notes.one_of(told.get("kind"), (*path, "kind"), PEERS)
        if name is None or not self.notes.text(told.get("label", name), (*path, "label")):
            return None
        parameters = {key: value for key, value in told.items() if key not in ("kind", "label")}
        return build_record(PEERS[name], parameters, path, self.notes)

    # --- references -----------------------------------------------------------------------------------------------

    def _references(self, told: Measured, path: KeyPath, files: bool = True) -> tuple[ReferenceSource, ...]:
        """The references of a list or of one of its blocks; files: whether a table of values is of use."""
        places = [(*path, "references", index) for index in range(len(told.references))]
        read = [self._reference(item, at, files) for item, at in zip(told.references, places, strict=True)]
        return tuple(trusted for trusted in read if trusted is not None)

    def _reference(self, item: Any, path: KeyPath, files: bool) -> ReferenceSource | None:
        if self.notes.mapping(item, path) is None:
            return None
        if "values" in item:
            return self._values(item, path, files)
        if "tolerance" not in item:
            self.notes.add((*path, "tolerance"), "required key is missing")
            return None
        asked = build_record(Asked, {"tolerance": item["tolerance"]}, path, self.notes)
        told = {key: value for key, value in item.items() if key != "tolerance"}
        solver = self._peer(told, path) if told.get("kind") in PEERS else self._method(told, path)
        if solver is None or asked is None:
            return None
        label = f"{told.get('label', solver.name)} at {asked.tolerance:g}"
        return ReferenceSource(label, solver.name, solver, asked.tolerance, {})

    def _values(self, item: dict[str, Any], path: KeyPath, files: bool) -> ReferenceSource | None:
        if not files:
            self.notes.add(path[:-1], "give methods: a table of values knows one curve of one model alone")
            return None
        told = build_record(ValuesOfFile, item, path, self.notes)
        table = None if told is None else self._table(self.folder / told.values, (*path, "values"))
        if told is None or table is None:
            return None
        return ReferenceSource(told.label or told.values, "", None, told.error, table)

    def _table(self, file: FilePath, path: KeyPath) -> dict[float, float] | None:
        """Mean friction by belt speed."""
        try:
            with file.open(encoding="utf-8", newline="") as text:
                rows = [[float(row[name]) for name in REFERENCE_COLUMNS] for row in csv.DictReader(text)]
        except OSError as problem:
            self.notes.add(path, f"cannot be read: {problem.strerror}")
        except (KeyError, TypeError, ValueError):
            named = " and ".join(REFERENCE_COLUMNS)
            self.notes.add(path, f"must be a CSV file of numbers with the columns {named}")
        else:
            return {speed: mean for speed, mean in rows}
        return None

    def _note_equal(self, names: Sequence[str], path: KeyPath) -> None:
        """Two of one name would be written to one file."""
        stems = [file_stem(name).casefold() for name in names]
        for place, name in enumerate(names):
            if (first := stems.index(stems[place])) != place:
                what = f"'{names[first]}' and '{name}' would both be written to {file_stem(name)}"
                self.notes.add(path, f"{what}; give each a name of its own")


def _told(block: ListItem) -> dict[str, Any]:
    """The study of a block, as it is written."""
    own = {key: getattr(block, key) for key in OF_A_STUDY if key in block.model_fields_set}
    return {"schema": 1, **own}


def _workloads(
    study: Study,
    contenders: tuple[Contender, ...],
    references: tuple[ReferenceSource, ...],
    timed: tuple[int, float],
) -> Iterator[tuple[str, Workload]]:
    """The curve of each law, by its label."""
    for choice in study.laws:
        cases = [case for case in study.cases() if case.law_label == choice.label]
        scenes = sorted((case.scene for case in cases), key=lambda scene: scene.belt_speed)
        yield choice.label, Workload(tuple(scenes), cases[0].law, contenders, references, *timed)


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
