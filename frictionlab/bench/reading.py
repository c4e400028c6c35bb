"""From a bench list (YAML) to a frozen Bench, or to a mistake in it, with its line."""

from __future__ import annotations

import csv
import re
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from copy import deepcopy
from dataclasses import dataclass, replace
from pathlib import Path as FilePath
from typing import Annotated, Any, Literal, NoReturn, TypeVar

from pydantic import AfterValidator, BeforeValidator, Field

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
from frictionlab.study.parts import method_choice
from frictionlab.study.study import Study
from frictionlab.study.yaml_source import Source, read_file
from frictionlab.values import columns
from frictionlab.values.notes import KeyPath, Notes, StudyError, dotted
from frictionlab.values.quantities import Positive, Record
from frictionlab.values.validation import build_record

REFERENCE_COLUMNS = ("belt_speed", "mean_friction")
OF_A_STUDY = ("scene", "laws", "sweep")

ALL_OF_IT = BeforeValidator(lambda given: {} if given is True else given)
"""Reads ``true`` as all that a section has."""
Many = Annotated[tuple[Any, ...], FILLED]


def _of_a_file(name: str) -> str:
    if not re.fullmatch(r"\w[\w.-]*", name):
        raise ValueError("names a file: use letters, digits, points, - and _")
    return name


class Measured(Record):
    """Who is measured and against whom, of a list or of one of its blocks."""

    references: tuple[dict[str, Any], ...] = ()
    methods: Many = ()
    peers: Many = ()


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
    points: Annotated[tuple[dict[str, Any], ...], FILLED] = ()


class ModelsBlock(ListItem):
    """An item of ``models``."""

    sweep: Any
    references: Annotated[tuple[dict[str, Any], ...], FILLED]
    without: Annotated[tuple[str, ...], FILLED] = ()
    repeats: AtLeastOne = 20
    seconds: Positive = 1.0


class ListKeys(Measured):
    """Keys of a bench list: its title, its sections, and who is measured on all of them."""

    schema_version: Literal[1] = Field(alias="schema")
    title: str = ""
    scenes: Many = ()
    repeats: AtLeastOne = 30
    seconds: Positive = 2.0
    orders: Annotated[OrdersSection | None, ALL_OF_IT] = None
    stability: Annotated[StabilityMaps | None, ALL_OF_IT] = None
    failures: Many = ()
    models: Many = ()


class Asked(Record):
    """What a method or peer is asked for beside its own parameters."""

    tolerance: Positive = 1e-8
    points: AtLeastOne | None = None


class Closely(Record):
    """Tolerance that a reference is solved to."""

    tolerance: Positive


class ValuesOfFile(Record):
    """Reference values from a file, relative to the list, and how well they are known."""

    values: str
    error: Positive
    label: str = ""


_RecordT = TypeVar("_RecordT", bound=Record)


def load_bench(path: FilePath) -> Bench:
    """Read the bench list of a file. Raises StudyError with the mistakes of the first block that has any."""
    source = _source(path)
    title, sections = _Reader(source, path.parent).read(source.tree)
    return Bench(path.stem, title, tuple(sections))


def _source(path: FilePath) -> Source:
    """The file's values; what is no readable file is told in the words of a list."""
    try:
        return read_file(path)
    except StudyError as problem:
        said = [replace(each, what=each.what.replace("study", "bench list")) for each in problem.mistakes]
        raise StudyError(said) from None


@dataclass(frozen=True)
class _Reader:
    """Reader of one list, which refuses it at the first block with mistakes."""

    source: Source
    folder: FilePath

    def read(self, tree: Any) -> tuple[str, list[Section]]:
        """Return the title of the list and its sections."""
        keys = self._record(ListKeys, tree, ())
        orders, stability = (each.sections() if each else () for each in (keys.orders, keys.stability))
        found = [*self._curves(keys), *orders, *stability, *self._maps(keys), *self._models(keys)]
        if not found:
            self._wrong((), "nothing to measure: give scenes, failures, models, orders or stability")
        self._refuse_equal([section.name for section in found], ("scenes",))
        return keys.title, found

    def _wrong(self, path: KeyPath, what: str) -> NoReturn:
        """Refuse the value at this path."""
        notes = Notes(self.source.notes)
        notes.add(path, what)
        raise StudyError(self.source.located(notes.all))

    @contextmanager
    def _noted(self) -> Iterator[Notes]:
        """Notes of mistakes, which are raised at the end."""
        notes = Notes(self.source.notes)
        yield notes
        if notes.all:
            raise StudyError(self.source.located(notes.all))

    def _record(self, kind: type[_RecordT], given: Any, path: KeyPath) -> _RecordT:
        """Make a record of the keys at a path. Raises StudyError with every mistake in them."""
        with self._noted() as notes:
            made = build_record(kind, given, path, notes)
        assert made is not None
        return made

    # --- blocks: a study each -------------------------------------------------------------------------------------

    def _blocks(self, kind: type[_RecordT], head: str, given: Many) -> Iterator[tuple[KeyPath, _RecordT]]:
        """Yield the blocks that a key of the list holds, each with its path."""
        for index, each in enumerate(given):
            yield (head, index), self._record(kind, each, (head, index))

    def _curves(self, keys: ListKeys) -> Iterator[Section]:
        """A curve for each law of each scene; what a scene does not say holds for all."""
        shared, trusted = self._contenders(keys, ()), self._references(keys, ())
        for path, block in self._blocks(CurveBlock, "scenes", keys.scenes):
            contenders = self._measured(block, path, shared)
            references = self._references(block, path) or trusted
            if not references:
                self._wrong(path, "no references: give a method or values to measure errors against")
            study = self._curve(_told(block), path)
            for label, work in _workloads(study, contenders, references, (keys.repeats, keys.seconds)):
                name = block.name if len(study.laws) == 1 else f"{block.name} {label}"
                yield BenchCurve(name, block.title, work)

    def _maps(self, keys: ListKeys) -> list[Section]:
        """A section for each method and peer that a list of maps names."""
        found = list[tuple[MapTruth, Sequence[Contender]]]()
        for path, block in self._blocks(MapBlock, "failures", keys.failures):
            contenders = self._measured(block, path, {})
            for each in (each for each in contenders if len(each.solvers) > 1):
                told = f"'{each.label}': a map takes one setting; give each a label of its own"
                self._wrong((*path, f"{each.side}s"), told)
            study = self._study(_told(block), path)
            paths = self._swept(study, path)
            points, references = self._points(block, path, paths), self._references(block, path, files=False)
            drawn = FailureMap(block.name, block.title, study, *paths, tuple(points), references)
            found.append((MapTruth(drawn), contenders))
        self._refuse_equal([truth.drawn.name for truth, _ in found], ("failures",))
        return [*failure_sections(found)]

    def _swept(self, study: Study, path: KeyPath) -> tuple[str, str]:
        """The path of the belt speed and that of the other quantity."""
        if len(study.laws) != 1:
            self._wrong((*path, "laws"), f"a map has one law, got {len(study.laws)}")
        speeds = [name for name in study.sweep if name in columns.BELT_SPEEDS]
        others = [name for name in study.sweep if name not in columns.BELT_SPEEDS]
        plain = all(isinstance(value, float | int) for name in others for value in study.sweep[name])
        if len(speeds) != 1 or len(others) != 1 or not plain:
            self._wrong((*path, "sweep"), "a map sweeps the belt speed and one other number")
        return speeds[0], others[0]

    def _points(self, block: MapBlock, path: KeyPath, paths: tuple[str, str]) -> Iterator[NamedPoint]:
        """``[{name: S2, scene.belt_speed: 0.5, scene.normal_load: 10}]``."""
        for index, item in enumerate(block.points):
            at, keys = (*path, "points", index), ("name", *paths)
            if item.keys() != {*keys}:
                self._wrong(at, f"give name, {paths[0]} and {paths[1]}, no other keys")
            told = dict(zip(NamedPoint.model_fields, map(item.get, keys), strict=True))
            yield self._record(NamedPoint, told, at)

    def _models(self, keys: ListKeys) -> Iterator[Section]:
        """Of each scene: the first law on all of it is the richest model, which the others are held against."""
        for path, block in self._blocks(ModelsBlock, "models", keys.models):
            contenders = self._measured(block, path, {})
            references = self._references(block, path, files=False)
            found = list[BenchedModel]()
            for lacking, told in self._scenes(block, path):
                study = self._curve(told, path)
                if not study.sweep:
                    self._wrong((*path, "sweep"), "models are compared along one curve: sweep the belt speed")
                works = _workloads(study, contenders, references, (block.repeats, block.seconds))
                found += [BenchedModel(label, lacking, work) for label, work in works]
            yield ModelsSection(f"models_{file_stem(block.name)}", block.title, tuple(found))

    def _scenes(self, block: ModelsBlock, path: KeyPath) -> Iterator[tuple[str, dict[str, Any]]]:
        """The study of a block, and that without each part of the scene that simpler ones lack."""
        told = _told(block)
        yield "", told
        for index, part in enumerate(block.without):
            if (left := _cut(block.scene, part)) is None:
                what = f"the scene has no '{part}'; give the path of a key of it"
                self._wrong((*path, "without", index), what)
            yield f"without {part}", told | {"scene": left}

    def _curve(self, told: dict[str, Any], path: KeyPath) -> Study:
        """The study of a block that sweeps the belt speed alone."""
        study = self._study(told, path)
        if not study.sweep.keys() <= {*columns.BELT_SPEEDS}:
            self._wrong((*path, "sweep"), "a bench curve sweeps the belt speed alone")
        return study

    def _study(self, told: dict[str, Any], path: KeyPath) -> Study:
        """The scene, laws and sweep as the study they are, read by the study's own reader."""
        keys, values = (
            {at[len(path) :]: place for at, place in places.items() if at[: len(path)] == path}
            for places in (self.source.keys, self.source.values)
        )
        try:
            return read_study(Source(self.source.name, self.source.text, told, keys, values))
        except StudyError as problem:
            paths = {each.path: f"{dotted(path)}.{each.path}".removesuffix(".") for each in problem.mistakes}
            raise StudyError([replace(each, path=paths[each.path]) for each in problem.mistakes]) from None

    # --- who is measured ------------------------------------------------------------------------------------------

    def _measured(
        self, block: ListItem, path: KeyPath, shared: dict[str, Contender]
    ) -> tuple[Contender, ...]:
        """The methods and peers of a block, and those of all."""
        found = shared | self._contenders(block, path)
        if not found:
            self._wrong(path, "no methods and no peers: there is nothing to measure")
        return tuple(found.values())

    def _contenders(self, told: Measured, path: KeyPath) -> dict[str, Contender]:
        """The methods and peers of a list or of one of its blocks, by label."""
        found: dict[str, Contender] = {}
        for head in ("methods", "peers"):
            for index, item in enumerate(getattr(told, head)):
                at: KeyPath = (*path, head, index)
                made = self._contender({"kind": item} if isinstance(item, str) else item, at, head)
                if made.label in found:
                    self._wrong(at, f"'{made.label}' is there already; give each its own label")
                found[made.label] = made
        return found

    def _contender(self, item: Any, path: KeyPath, head: str) -> Contender:
        """A method or peer; one of its values may be a list, which is run through."""
        with self._noted() as notes:
            notes.mapping(item, path)
        varied = [key for key in item if isinstance(item[key], list) and key not in ("kind", "points")]
        if len(varied) > 1:
            self._wrong((*path, varied[1]), f"only one value may be a list, and {varied[0]} is one")
        quantity = varied[0] if varied else ""
        values = item[quantity] if varied else [0.0]
        if not values:
            self._wrong((*path, quantity), "the list is empty; give at least one, such as [1.0e-6]")
        solvers = list[tuple[BenchSetting, Method | Peer]]()
        for value in values:
            each = item | {quantity: value} if varied else item
            asked = {key: each[key] for key in Asked.model_fields if key in each}
            setting = self._record(Asked, asked, path)
            solver = self._solver({key: each[key] for key in each if key not in asked}, path, head)
            solvers.append((BenchSetting(quantity, float(value), setting.tolerance), solver))
        kind = str(item["kind"])
        return Contender(str(item.get("label", kind)), kind, tuple(solvers), item.get("points"))

    def _solver(self, told: dict[str, Any], path: KeyPath, head: str) -> Method | Peer:
        """Make a method of these parameters, or a peer of those under the key ``peers``."""
        if head == "peers":
            with self._noted() as notes:
                name = notes.one_of(told.get("kind"), (*path, "kind"), PEERS)
                notes.text(told.get("label", ""), (*path, "label"))
            parameters = {key: value for key, value in told.items() if key not in ("kind", "label")}
            return self._record(PEERS[str(name)], parameters, path)
        if told.get("kind") == "auto":
            self._wrong((*path, "kind"), "auto only chooses: name the methods it chooses from")
        with self._noted() as notes:
            choice = method_choice(told, path, notes)
        assert choice is not None
        return choice.method

    # --- references -----------------------------------------------------------------------------------------------

    def _references(self, told: Measured, path: KeyPath, files: bool = True) -> tuple[ReferenceSource, ...]:
        """The references of a list or of one of its blocks; files: whether a table of values is of use."""
        given = enumerate(told.references)
        return tuple(self._reference(each, (*path, "references", index), files) for index, each in given)

    def _reference(self, item: dict[str, Any], path: KeyPath, files: bool) -> ReferenceSource:
        if "values" in item:
            if not files:
                self._wrong(path[:-1], "give methods: a table of values knows one curve of one model alone")
            known = self._record(ValuesOfFile, item, path)
            table = self._table(self.folder / known.values, (*path, "values"))
            return ReferenceSource(known.label or known.values, "", None, known.error, table)
        closely = self._record(Closely, {key: item[key] for key in item if key == "tolerance"}, path)
        told = {key: value for key, value in item.items() if key != "tolerance"}
        solver = self._solver(told, path, "peers" if told.get("kind") in PEERS else "methods")
        label = f"{told.get('label', solver.name)} at {closely.tolerance:g}"
        return ReferenceSource(label, solver.name, solver, closely.tolerance, {})

    def _table(self, file: FilePath, path: KeyPath) -> dict[float, float]:
        """Mean friction by belt speed."""
        try:
            with file.open(encoding="utf-8", newline="") as text:
                rows = [[float(row[name]) for name in REFERENCE_COLUMNS] for row in csv.DictReader(text)]
        except (OSError, KeyError, TypeError, ValueError) as problem:
            named = " and ".join(REFERENCE_COLUMNS)
            self._wrong(path, f"must be a CSV file of numbers with the columns {named}: {problem}")
        return {speed: mean for speed, mean in rows}

    def _refuse_equal(self, names: Sequence[str], path: KeyPath) -> None:
        """Refuse two of one name, which would be written to one file."""
        stems = [file_stem(name).casefold() for name in names]
        if same := [repr(name) for name, stem in zip(names, stems, strict=True) if stems.count(stem) > 1]:
            self._wrong(path, f"{' and '.join(same)} would be written to files of one name: rename them")


def _told(block: ListItem) -> dict[str, Any]:
    """The study of a block, as it is written."""
    return {"schema": 1} | {key: getattr(block, key) for key in OF_A_STUDY if key in block.model_fields_set}


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
