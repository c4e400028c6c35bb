"""Reading of a study file (or a mapping of the same shape) to a Study, or to all of its mistakes at once."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path as FilePath
from typing import Any

from frictionlab import columns, registry
from frictionlab.mistakes.notes import Notes, Path, StudyError
from frictionlab.mistakes.validation import build_record, number_paths, value_paths
from frictionlab.quantities import dimensions
from frictionlab.scene.scene import Scene
from frictionlab.study.axes import FRICTION, LINKED, STATIC, GridValue
from frictionlab.study.choices import items, label_of, law_choice, method_choice, note_equal_labels
from frictionlab.study.data import SLIP_ALONE, read_data
from frictionlab.study.expectations import Table, expectations, result_column
from frictionlab.study.figure_options import read_figure_options
from frictionlab.study.grid import StudyGrid
from frictionlab.study.law_files import LawReader, StudyLaws, read_laws
from frictionlab.study.level_lines import BOUNDARIES_KEY, read_boundaries
from frictionlab.study.overrides import apply_overrides
from frictionlab.study.parts import LIMIT_KEY, SCHEMA, LawChoice, MethodChoice, coefficient_of
from frictionlab.study.possible import note_impossible_points
from frictionlab.study.sweep_targets import swept_paths
from frictionlab.study.sweeps import Sweeps, read_sweeps
from frictionlab.study.written import column_of, read_law_numbers, scene_is_in_si, units_of_law
from frictionlab.study.yaml_source import Source

STUDY_KEYS = (
    *("schema", "title", "source", "scene", "plugins", "laws", "methods", "tolerance"),
    *("sweep", "expect", "keep", "columns", "limit", "figures", "boundaries", "data", "free"),
)
KEPT = {"orbit": 2, "attractors": 1, "harmonics": 1}
"""What ``keep`` may ask for, and the least count of each."""
REQUIRED = ("schema", "scene", "laws")
DEFAULT_TOLERANCE = 1e-8
DEFAULT_METHODS = ("auto",)
HERE = FilePath()


def read_values(
    source: Source,
    overrides: Sequence[str] = (),
    folder: FilePath = HERE,
    bring: LawReader = read_laws,
    with_files: bool = True,
) -> dict[str, Any]:
    """The values of a ``Study``. Raises StudyError with every mistake, BrokenPlugin for a law that cannot be used.

    overrides: ``path=value``. folder: that of the law files and measurements it names. with_files: whether
    measurements have to be there.
    """
    if isinstance(source.tree, dict):
        apply_overrides(source, overrides)
        _place_receptance(source.tree, folder)
    notes = Notes(source.notes)
    data = folder if with_files else None
    told = _StudyReader(source, notes, lambda tree: bring(tree, folder, notes), data).values()
    if told is None or notes.all:
        raise StudyError(source.located(notes.all))
    return told


def _place_receptance(tree: dict[str, Any], folder: FilePath) -> None:
    """Say where the file of scene.body.receptance is: a study names it from its own folder."""
    scene = tree.get("scene")
    for part in (scene, scene.get("dimensional")) if isinstance(scene, dict) else ():
        if isinstance(part, dict):
            _place_file(part.get("body"), folder)


def _place_file(at: Any, folder: FilePath) -> None:
    if isinstance(at, dict) and isinstance(at.get("receptance"), dict):
        at, key = at["receptance"], "file"
    else:
        key = "receptance"
    if isinstance(at, dict) and isinstance(at.get(key), str):
        at[key] = str((folder / at[key]).resolve())


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
        self._labels: dict[str, tuple[str, ...] | None] = {}
        """Of laws and methods; None where a mistake leaves them open, and what refers to them is not checked."""

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
        laws, methods = self._laws(), self._methods()
        scene = (
            build_record(Scene, self._tree["scene"], ("scene",), self._notes)
            if "scene" in self._tree
            else None
        )
        self._labels = {
            head: None if self._notes.below((head,)) else tuple(each.label for each in choices)
            for head, choices in (("laws", laws), ("methods", methods))
        }
        told = self._plain_values()
        told["expect"] = expectations(self._tree.get("expect", []), self._table(scene, sweep), self._notes)
        told["columns"] = self._columns(scene)
        if BOUNDARIES_KEY in self._tree:
            told[BOUNDARIES_KEY] = read_boundaries(self._tree[BOUNDARIES_KEY], sweep, self._notes)
        if self._notes.all or scene is None:
            return None
        told["code"] = brought.code(choice.kind for choice in laws)
        told["plugins"] = brought.files
        swept = {"sweep": sweep.sweep, "ranges": sweep.ranges, "links": sweep.links}
        along: dict[str, Any] = {"scene": scene, "laws": laws, "methods": methods, **swept}
        note_impossible_points(StudyGrid(**along), told, self._notes)
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

    def _swept_name(self, path: Path, found: Sweeps) -> str:
        """The name under which a sweep would vary the value at this path."""
        if len(path) == 3 and path[0] == "laws" and isinstance(path[1], int):
            law = self._tree["laws"][path[1]]
            kind = law.get("kind")
            if FRICTION in found.sweep and kind in self._known.names():
                name = coefficient_of(self._known.named(kind))
                if path[2] == name and law.get(STATIC) is None:
                    return FRICTION
            return f"laws.{label_of(law)}.{path[2]}"
        return column_of(".".join(map(str, path)))

    def _laws(self) -> tuple[LawChoice, ...]:
        if "laws" not in self._tree:
            return ()
        given = items(self._tree["laws"], ("laws",), "[{kind: coulomb, mu: 0.4}]", self._notes)
        note_equal_labels(given, "laws", self._notes)
        read = [
            law_choice(item, ("laws", index), self._known, self._notes) for index, item in enumerate(given)
        ]
        return tuple(choice for choice in read if choice is not None)

    def _methods(self) -> tuple[MethodChoice, ...]:
        given = items(self._tree.get("methods", list(DEFAULT_METHODS)), ("methods",), "[auto]", self._notes)
        note_equal_labels(given, "methods", self._notes)
        read = [method_choice(item, ("methods", index), self._notes) for index, item in enumerate(given)]
        return tuple(choice for choice in read if choice is not None)

    def _plain_values(self) -> dict[str, Any]:
        tree, notes = self._tree, self._notes
        words = [key for key in ("title", "source") if key in tree]
        told: dict[str, Any] = {key: notes.text(tree[key], (key,)) for key in words}
        told["tolerance"] = notes.positive(tree.get("tolerance", DEFAULT_TOLERANCE), ("tolerance",))
        keep = notes.mapping(tree.get("keep", {}), ("keep",), tuple(KEPT)) or {}
        for name in keep.keys() & KEPT.keys():
            told[f"keep_{name}"] = notes.whole_number(keep[name], ("keep", name), KEPT[name])
        limit = notes.mapping(tree.get("limit", {}), ("limit",), (LIMIT_KEY,)) or {}
        if LIMIT_KEY in limit:
            told[LIMIT_KEY] = notes.positive(limit[LIMIT_KEY], ("limit", LIMIT_KEY))
        told |= read_data(tree, notes, self._data_folder)
        if "figures" in tree:
            told["figures"] = read_figure_options(tree["figures"], self._labels["laws"], notes)
        return told

    def _columns(self, scene: Scene | None) -> tuple[str, ...] | None:
        if "columns" not in self._tree:
            return None
        if self._tree["columns"] == columns.ALL:
            return (columns.ALL,)
        given = items(self._tree["columns"], ("columns",), "[floquet, energies], or all", self._notes)
        known = (*self._table(scene, Sweeps()).results, *columns.GROUPS)
        what = "result column or a group of them"
        read = [result_column(name, ("columns", i), known, self._notes, what) for i, name in enumerate(given)]
        return tuple(dict.fromkeys(name for name in read if name is not None))

    def _table(self, scene: Scene | None, sweep: Sweeps) -> Table:
        """The columns that ``where`` may name; all possible ones where the scene or a law has mistakes."""
        values = dict.fromkeys(value_paths(Scene)) if scene is None else scene.values()
        laws, methods = self._labels["laws"], self._labels["methods"]
        kinds = tuple(dict.fromkeys(law["kind"] for law in self._tree["laws"])) if laws else None
        known = self._known.usable() if kinds is None else kinds
        classes = [self._known.named(kind) for kind in known]
        parameters = {f"law.{name}": None for law in classes for name in number_paths(law)}
        inputs = [*(f"scene.{path}" for path in values), *parameters]
        if columns.belt_speed(inputs) != columns.BELT_SPEED:
            inputs += dict.fromkeys(f"{columns.SCALED}{name}" for law in classes for name in dimensions(law))
        texts = dict(zip(columns.INPUTS, (laws, kinds, methods), strict=True))
        words = _words(values, sweep.sweep)
        numbers = tuple(name for name in inputs if name not in words)
        swept = swept_paths(self._tree)
        if not scene_is_in_si(self._tree):
            return Table(texts, numbers, tuple(columns.results(inputs)), words, swept)
        units = {f"law.{name}": unit for law in classes for name, unit in units_of_law(law).items()}
        speed = columns.belt_speed(inputs)
        return Table(texts, numbers, tuple(columns.results(inputs)), words, swept, speed, units)


def _words(
    values: Mapping[str, Any], sweep: Mapping[str, tuple[GridValue, ...]]
) -> dict[str, tuple[str, ...] | None]:
    """The columns of a scene's words and waveforms, and what each can hold: None where that is uncertain."""
    numbers = number_paths(Scene)
    found: dict[str, tuple[str, ...] | None] = {}
    for path, value in values.items():
        if path not in numbers:
            # a scene in SI units has its words in both scales
            names = (f"scene.{path}", f"scene.dimensional.{path}")
            swept = next((sweep[name] for name in names if name in sweep), None)
            told = tuple(map(str, swept)) if swept else (str(value),)
            found[f"scene.{path}"] = None if value is None else told
    return found
