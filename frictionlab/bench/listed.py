"""A bench list (YAML): its sections read, or the mistakes in it told with their lines; chosen and measured."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path as FilePath
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field

from frictionlab.bench.contenders import FILLED, LIST_FOLDER, AtLeastOne, Measured, built
from frictionlab.bench.curve import BenchCurve, CurveBlock, workloads
from frictionlab.bench.failure_maps import FailureMap
from frictionlab.bench.failures import failure_sections
from frictionlab.bench.models import ModelsBlock, ModelsSection
from frictionlab.bench.orders import OrdersSection
from frictionlab.bench.result import Section, SectionResult, Tell, file_stem, left_out_line
from frictionlab.bench.stability import StabilityMaps
from frictionlab.compile.call import compiling_at_once
from frictionlab.study.yaml_source import Source, read_file
from frictionlab.values.notes import KeyPath, Notes, StudyError
from frictionlab.values.quantities import Positive
from frictionlab.values.validation import build_record

ALL_OF_IT = BeforeValidator(lambda given: {} if given is True else given)
"""Reads ``true`` as all that a section has."""


def _block(kind: type[Any]) -> BeforeValidator:
    """Return the validator that reads a block; a mistake in it is told by its path in the block."""
    return BeforeValidator(lambda given: built(kind, given))


class ListKeys(Measured):
    """Keys of a bench list: its title, its sections, and who is measured on all of them."""

    schema_version: Literal[1] = Field(alias="schema")
    title: str = ""
    scenes: Annotated[tuple[Annotated[Any, _block(CurveBlock)], ...], FILLED] = ()
    repeats: AtLeastOne = 30
    seconds: Positive = 2.0
    orders: Annotated[OrdersSection | None, ALL_OF_IT] = None
    stability: Annotated[StabilityMaps | None, ALL_OF_IT] = None
    failures: Annotated[tuple[Annotated[Any, _block(FailureMap)], ...], FILLED] = ()
    models: Annotated[tuple[Annotated[Any, _block(ModelsBlock)], ...], FILLED] = ()

    def curves(self, notes: Notes) -> Iterator[BenchCurve]:
        """A curve for each law of each scene; what a scene does not say holds for all."""
        shared = {each.label: each for each in self.contenders}
        for index, block in enumerate(self.scenes):
            contenders = shared | {each.label: each for each in block.contenders}
            references = block.references or self.references
            if not contenders:
                notes.add(("scenes", index), "no methods and no peers: there is nothing to measure")
            if not references:
                what = "no references: give a method or values to measure errors against"
                notes.add(("scenes", index), what)
            for label, work in workloads(block.study, references, self.repeats, self.seconds):
                name = block.name if len(block.study.laws) == 1 else f"{block.name} {label}"
                yield BenchCurve(name, block.title, work, tuple(contenders.values()))


class UnknownCurve(Exception):
    """A curve asked for by a name that is not in the list."""


@dataclass(frozen=True)
class Bench:
    """Sections of a list, curves first."""

    name: str
    title: str
    sections: tuple[Section, ...]

    @property
    def names(self) -> list[str]:
        """Names of all that is measured."""
        return [section.name for section in self.sections]

    @property
    def curves(self) -> list[BenchCurve]:
        """Return the curves among them."""
        return [section for section in self.sections if isinstance(section, BenchCurve)]

    @property
    def parts(self) -> str:
        """Return what its sections are called."""
        return "curves" if len(self.curves) == len(self.sections) else "curves and sections"

    def only(self, names: Sequence[str]) -> Bench:
        """Return the curves and sections of these names alone; all where none is named. Raises UnknownCurve."""
        if unknown := [name for name in names if name not in self.names]:
            part = "curve" if self.parts == "curves" else "curve or section"
            raise UnknownCurve(f"no {part} '{unknown[0]}' in the list; there are {', '.join(self.names)}")
        chosen = [each for each in self.sections if not names or each.name in names]
        return replace(self, sections=tuple(chosen))


def load_bench(path: FilePath) -> Bench:
    """Read the bench list of a file. Raises StudyError with its mistakes."""
    source, token = _source(path), LIST_FOLDER.set(path.parent)
    notes = Notes(source.notes)
    try:
        keys = build_record(ListKeys, source.tree, (), notes)
    finally:
        LIST_FOLDER.reset(token)
    sections = [] if keys is None else _sections(keys, notes)
    if notes.all:
        raise StudyError(source.located(notes.all))
    assert keys is not None
    return Bench(path.stem, keys.title, tuple(sections))


def _sections(keys: ListKeys, notes: Notes) -> list[Section]:
    """Return the sections of a list, curves first."""
    sections = list[Section](keys.curves(notes))
    sections += [keys.orders] if keys.orders else []
    sections += keys.stability.sections() if keys.stability else []
    sections += failure_sections(keys.failures)
    sections += [ModelsSection(block) for block in keys.models]
    if not sections:
        notes.add((), "nothing to measure: give scenes, failures, models, orders or stability")
    _refuse_equal([each.name for each in sections], ("scenes",), notes)
    _refuse_equal([each.name for each in keys.failures], ("failures",), notes)
    return sections


def _refuse_equal(names: Sequence[str], path: KeyPath, notes: Notes) -> None:
    """Note two of one name, which would be written to one file."""
    stems = [file_stem(name).casefold() for name in names]
    if same := [repr(name) for name, stem in zip(names, stems, strict=True) if stems.count(stem) > 1]:
        notes.add(path, f"{' and '.join(same)} would be written to files of one name: rename them")


def _source(path: FilePath) -> Source:
    """Return the file's values; what is no readable file is told in the words of a list."""
    try:
        return read_file(path)
    except StudyError as problem:
        said = [replace(each, what=each.what.replace("study", "bench list")) for each in problem.mistakes]
        raise StudyError(said) from None


def measure(bench: Bench, tell: Tell, first_runs: bool = False) -> Iterator[SectionResult]:
    """Measure the sections of a list, and hand each out as soon as it is finished.

    first_runs: of curves the first setting of each method without kernels, too.
    """
    with compiling_at_once():  # what is timed is machine code
        for section in bench.sections:
            if isinstance(section, BenchCurve):
                section = replace(section, first_runs=first_runs)
            yield section.measure(tell)


def bench_summary(done: Sequence[SectionResult]) -> str:
    """Tell what every curve and section came to, and in one line the peers that are not installed."""
    missing = {label: why for each in done if each.kind == "curve" for label, why in each.left_out.items()}
    told = [each.summary for each in done]
    return "\n\n".join([*told, left_out_line(missing)] if missing else told)
