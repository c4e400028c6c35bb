"""Reading of a study file (or a mapping of the same shape) to a Study, or to all of its mistakes at once.

Whether every point of the grid of a study can be built, and is one of few enough.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Container, Mapping, Sequence
from dataclasses import replace
from pathlib import Path as FilePath
from typing import Any

from frictionlab.laws.base import FrictionLaw
from frictionlab.scene.scene import Scene
from frictionlab.scene.units import SPRING
from frictionlab.study import registry
from frictionlab.study.axes import (
    FINEST_WITHIN,
    FRICTION,
    LINKED,
    MOST_CHOSEN,
    SCENE,
    STATIC,
    WITHIN,
    GridValue,
    SpeedRange,
    owner_of,
)
from frictionlab.study.expectations import Table, of_table, result_column
from frictionlab.study.figure_options import check_against, check_boundaries
from frictionlab.study.grid import StudyGrid, grid_size
from frictionlab.study.keys import (
    SLIP_ALONE,
    STUDY_KEYS,
    DataFiles,
    FreeRange,
    Keep,
    StudyKeys,
    column_in_si,
    range_in_numbers,
)
from frictionlab.study.law_files import LawReader, StudyLaws, read_laws
from frictionlab.study.overrides import apply_overrides
from frictionlab.study.parts import (
    SCHEMA,
    LawChoice,
    MethodChoice,
    coefficient_of,
    label_of,
    law_choices,
    method_choices,
)
from frictionlab.study.sweep_targets import swept_paths
from frictionlab.study.sweeps import Sweeps, read_sweeps
from frictionlab.study.written import column_of, read_law_numbers, scene_is_in_si, units_of_law
from frictionlab.study.yaml_source import Source
from frictionlab.values import columns
from frictionlab.values.notes import KeyPath, Notes, StudyError, did_you_mean, number_text
from frictionlab.values.quantities import dimensions
from frictionlab.values.validation import build_record, number_paths

LARGEST_GRID = 100_000_000
LARGEST_CHECK = 20_000
"""Points that are built to check a grid; of a larger one the ends and evenly spaced values of each sweep."""
LARGEST_KEPT = {
    "orbit": (50_000_000, "{count} samples of {size} points are more than {most}"),
    "harmonics": (10_000_000, "{count} harmonics of {size} points are more than {most}"),
    "attractors": (100_000, "{count} starts at {size} points are more than {most}"),
}
"""Largest count of what is kept in all, and the sentence where it is more."""


def note_impossible_points(grid: StudyGrid, keys: StudyKeys, notes: Notes) -> None:
    """Build the whole grid and note points that cannot be built, or a grid that is too large."""
    if (size := grid_size(grid)) > LARGEST_GRID:
        notes.add(("sweep",), f"the grid has {size} points, more than {LARGEST_GRID}")
    elif grid.chosen_range is not None:
        _build(lambda: grid.scenes_along, (SCENE,), grid, notes)
        if not notes.all:
            _note_choice(grid, grid.chosen_range, keys.tolerance, notes)
    if not notes.all:
        _note_too_much_kept(grid_size(grid.foreseen()), keys.keep, notes)
    if not notes.all:
        _build_all(_thinned(grid), notes)


def _note_choice(grid: StudyGrid, along: SpeedRange, tolerance: float, notes: Notes) -> None:
    path: KeyPath = ("sweep", next(path for path, each in grid.ranges.items() if each is along), WITHIN)
    about, least = grid_size(grid.foreseen()), FINEST_WITHIN * tolerance
    if along.within < least:
        said = f"must be >= {number_text(float(f'{least:.6g}'))}, {FINEST_WITHIN:g} times tolerance"
        notes.add(path, f"{said}, got {number_text(along.within)}")
    elif about > MOST_CHOSEN:
        what = f"belt speeds are chosen for {MOST_CHOSEN} at most: give num"
        notes.add(path, f"the grid has about {about} points; {what}")


def _note_too_much_kept(size: int, keep: Keep, notes: Notes) -> None:
    for key, (most, said) in LARGEST_KEPT.items():
        if (count := getattr(keep, key) or 0) * size > most:
            notes.add(("keep", key), said.format(count=count, size=size, most=most))


def _build_all(grid: StudyGrid, notes: Notes) -> None:
    _build(lambda: grid.scenes_along, (SCENE,), grid, notes)
    for index, choice in enumerate(grid.laws if not notes.all else ()):
        own = f"laws.{choice.label}.", ""
        laws = _build(lambda law=choice: grid.laws_in_scenes(law), own, grid, notes)  # type: ignore[misc]  # of a lambda
        if laws is not None and not all(map(_has_a_stiffness, laws)):
            notes.on_key(("laws", index), "these values give no finite stiffness > 0: check their units")


def _has_a_stiffness(law: Any) -> bool:
    """Check whether a compliant law keeps a presliding length and a stiffness > 0, neither infinite."""
    if not law.compliant:
        return True
    return 0.0 < law.bristle_stiffness < math.inf and 0.0 < law.presliding() < math.inf


def _thinned(grid: StudyGrid) -> StudyGrid:
    """Return the grid with few enough values of each sweep, its ends among them, to build every point."""
    while grid_size(grid) > LARGEST_CHECK:
        longest = max(grid.axes, key=len)
        if len(longest) == 2:
            break
        grid = replace(grid, sweep=grid.sweep | longest.thinned().values)
    return grid


def _build(build: Callable[[], Any], owners: Container[str], grid: StudyGrid, notes: Notes) -> Any:
    """Return what is built; None, noted, of values that are right one by one but invalid together.

    owners: of the sweeps they are of.
    """
    try:
        return build()
    except (StudyError, OverflowError) as problem:
        own = [path for path in grid.sweep if owner_of(path) in owners]
        what = str(problem) if isinstance(problem, OverflowError) else problem.mistakes[0].what
        notes.on_key(_place(own[-1], grid) if own else ("laws",), what)
        return None


def _place(swept: str, grid: StudyGrid) -> KeyPath:
    """Return where in a study a sweep is."""
    entry = next((index for index, paths in enumerate(grid.links) if swept in paths), None)
    return ("sweep", swept) if entry is None else ("sweep", LINKED, entry, swept)


REQUIRED = ("schema", "scene", "laws")
DEFAULT_METHODS = ("auto",)
HERE = FilePath()


def read_values(
    source: Source,
    overrides: Sequence[str] = (),
    folder: FilePath = HERE,
    bring: LawReader = read_laws,
    with_files: bool = True,
) -> dict[str, Any]:
    """Values of a ``Study``. Raises StudyError with every mistake, BrokenPlugin for a law that cannot be used.

    overrides: ``path=value``. folder: that of the law files and measurements it names. with_files: whether
    measurements have to be there.
    """
    if isinstance(source.tree, dict):
        apply_overrides(source, overrides)
        for part in source.tree.keys() & {"scene", "sweep"}:
            source.tree[part] = _placed(source.tree[part], folder, part)
    notes = Notes(source.notes)
    data = folder if with_files else None
    told = _StudyReader(source, notes, lambda tree: bring(tree, folder, notes), data).values()
    if told is None or notes.all:
        raise StudyError(source.located(notes.all))
    return told


def _placed(at: Any, folder: FilePath, name: str, depth: int = 8) -> Any:
    """Return a part of a study with files of waveforms and receptances where they are, not deeper than they can lie.

    A study names them from its own folder. name: that of the part, in which an item is named as its list.
    """
    if isinstance(at, str) and name.endswith("waveform.file"):
        return str(folder / at)
    if isinstance(at, str) and name.endswith(("body.receptance", "body.receptance.file")):
        return str((folder / at).resolve())
    if isinstance(at, dict) and depth:
        return {key: _placed(value, folder, f"{name}.{key}", depth - 1) for key, value in at.items()}
    if isinstance(at, list) and depth:
        return [_placed(value, folder, name, depth - 1) for value in at]
    return at


class _StudyReader:
    """One pass over the values of a study: laws before sweeps, sweeps before the scene, the table last."""

    def __init__(
        self,
        source: Source,
        notes: Notes,
        bring: Callable[[dict[str, Any]], StudyLaws],
        data_folder: FilePath | None,
    ) -> None:
        self._source, self._notes, self._bring, self._data_folder = source, notes, bring, data_folder
        self._tree: dict[str, Any] = source.tree
        self._known = registry.Laws()

    def values(self) -> dict[str, Any] | None:
        if self._notes.mapping(self._tree, ()) is None:
            return None
        if "data" in self._tree:
            self._tree.setdefault("scene", dict(SLIP_ALONE))
        self._keys()
        brought = self._bring(self._tree)
        self._known = brought.laws
        read_law_numbers(self._tree, self._known)
        sweep = self._sweep()
        laws = law_choices(self._tree["laws"], self._known, self._notes) if "laws" in self._tree else ()
        methods = method_choices(self._tree.get("methods", list(DEFAULT_METHODS)), self._notes)
        given = {name: value for name, value in self._tree.items() if name in StudyKeys.model_fields}
        keys = build_record(StudyKeys, given, (), self._notes)
        there = "scene" in self._tree
        scene = build_record(Scene, self._tree["scene"], ("scene",), self._notes) if there else None
        if self._notes.all or scene is None or keys is None:
            return None
        told = dict(keys) | self._referring(keys, scene, sweep, laws, methods)
        told["code"] = brought.code(choice.kind for choice in laws)
        told["plugins"] = brought.files
        along: dict[str, Any] = {"scene": scene, "laws": laws, "methods": methods, "sweep": sweep.sweep}
        along |= {"ranges": sweep.ranges, "links": sweep.links}
        if not self._notes.all:
            note_impossible_points(StudyGrid(**along), keys, self._notes)
        return along | told

    def _keys(self) -> None:
        for key in self._tree:
            if key == "dimensional":
                self._notes.on_key((key,), "is a part of the scene: write scene: {dimensional: {...}}")
            elif key not in STUDY_KEYS:
                self._notes.unknown_key((key,), STUDY_KEYS)
        self._notes.head(self._tree, REQUIRED, SCHEMA)

    def _sweep(self) -> Sweeps:
        found = read_sweeps(self._tree, self._known, self._notes)
        for name, path in found.written.items():
            self._source.also_at((*path[:-1], name), path)
        for missing, sweep in found.stand_ins.items():
            if sweep in self._source.origins:
                self._source.origins[missing] = self._source.origins[sweep]
            elif place := self._source.keys.get(sweep):
                self._source.values[missing] = place
        for path in self._source.origins:
            name = self._swept_name(path, found)
            if name in found.sweep and path not in found.stand_ins:
                key = LINKED if any(name in entry for entry in found.links) else name
                self._notes.add(path, f"the study sweeps {name}: set sweep.{key} instead")
        return found

    def _swept_name(self, path: KeyPath, found: Sweeps) -> str:
        """Return the name under which a sweep would vary the value at this path."""
        if len(path) == 3 and path[0] == "laws" and isinstance(path[1], int):
            law = self._tree["laws"][path[1]]
            kind = law.get("kind")
            if FRICTION in found.sweep and kind in self._known.names():
                name = coefficient_of(self._known.named(kind))
                if path[2] == name and law.get(STATIC) is None:
                    return FRICTION
            return f"laws.{label_of(law)}.{path[2]}"
        return column_of(".".join(map(str, path)))

    def _referring(
        self,
        keys: StudyKeys,
        scene: Scene,
        sweep: Sweeps,
        laws: tuple[LawChoice, ...],
        methods: tuple[MethodChoice, ...],
    ) -> dict[str, Any]:
        """Return the values of keys that refer to other parts; what these do not have is noted."""
        notes, table = self._notes, self._table(scene, sweep, laws, methods)
        check_against(keys.figures, table.texts["law"], notes)
        check_boundaries(keys.boundaries, sweep, notes)
        files = keys.data.file if keys.data is not None else ()
        for index, name in enumerate(files):
            self._check_file(name, ("data", "file", *([index] if len(files) > 1 else [])))
        self._check_units(keys.data)
        classes, in_si = [choice.law_class for choice in laws], scene.dimensional is not None
        free = {name: self._range(name, each, classes, in_si) for name, each in (keys.free or {}).items()}
        expect = [of_table(each, ("expect", k), table, notes) for k, each in enumerate(keys.expect)]
        may_be_free = scene.is_free or any(path.endswith((".spring", SPRING[0])) for path in sweep.sweep)
        columns = self._columns(keys.columns, table, may_be_free)
        return {"expect": tuple(expect), "columns": columns, "free": free or None}

    def _check_units(self, given: DataFiles | None) -> None:
        """Note units of measurements that are none, or of what has none."""
        for name, unit in (given.units if given is not None else {}).items():
            if not scene_is_in_si(self._tree):
                self._notes.on_key(("data", "units"), "go with a scene in SI units: scene.dimensional")
                continue
            try:
                column_in_si(name, unit)
            except ValueError as problem:
                self._notes.add(("data", "units", name), str(problem))

    def _range(
        self, name: str, given: FreeRange, classes: list[type[FrictionLaw]], in_si: bool
    ) -> FreeRange | None:
        found, wrong = range_in_numbers(name, given, classes, in_si)
        if wrong:
            self._notes.add(("free", name), wrong)
        return found

    def _check_file(self, name: str, path: KeyPath) -> None:
        """Note a file of measurements that is not there."""
        folder = self._data_folder
        if folder is not None and not (folder / name).is_file():
            there = [each.name for each in folder.glob("*") if each.is_file()] if folder.is_dir() else []
            self._notes.add(path, f"there is no file {folder / name}", did_you_mean(name, there))

    def _columns(
        self, given: tuple[str, ...] | None, table: Table, may_be_free: bool
    ) -> tuple[str, ...] | None:
        known, what = (*table.results, *columns.GROUPS), "result column or a group of them"
        for index, name in enumerate(given or ()):
            result_column(name, ("columns", index), known, self._notes, what)
            if name.startswith("drift") and not may_be_free:
                self._notes.add(("columns", index), "is of a body that no spring holds: give spring: false")
        return None if given is None else tuple(dict.fromkeys(given))

    def _table(
        self, scene: Scene, sweep: Sweeps, laws: tuple[LawChoice, ...], methods: tuple[MethodChoice, ...]
    ) -> Table:
        """Return the columns that ``where`` may name."""
        values = scene.values()
        kinds = tuple(dict.fromkeys(law.kind for law in laws))
        classes = [self._known.named(kind) for kind in kinds]
        parameters = {f"law.{name}": None for law in classes for name in number_paths(law)}
        inputs = [*(f"scene.{path}" for path in values), *parameters]
        in_si_units = scene_is_in_si(self._tree)
        if in_si_units:
            inputs += dict.fromkeys(f"{columns.SCALED}{name}" for law in classes for name in dimensions(law))
        words = _words(values, sweep.sweep)
        units = {f"law.{name}": unit for law in classes for name, unit in units_of_law(law).items()}
        return Table(
            {
                "law": tuple(each.label for each in laws),
                "kind": kinds,
                "method": tuple(each.label for each in methods),
            },
            tuple(name for name in inputs if name not in words),
            tuple(columns.results(inputs)),
            words,
            swept_paths(self._tree),
            columns.belt_speed(inputs),
            units if in_si_units else {},
        )


def _words(
    values: Mapping[str, Any], sweep: Mapping[str, tuple[GridValue, ...]]
) -> dict[str, tuple[str, ...]]:
    """Return the columns of a scene's words and waveforms, and what each can hold."""
    numbers = number_paths(Scene)
    found: dict[str, tuple[str, ...]] = {}
    for path, value in values.items():
        if path not in numbers:
            # a scene in SI units has its words in both scales
            names = (f"scene.{path}", f"scene.dimensional.{path}")
            swept = next((sweep[name] for name in names if name in sweep), (value,))
            found[f"scene.{path}"] = tuple(map(str, swept))
    return found
