"""Sweeps: the values that can be swept, and a check that every point of the grid can be built."""

from __future__ import annotations

import math
import operator
from collections.abc import Callable, Container, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

from pydantic import BaseModel

from frictionlab import registry
from frictionlab.columns import BELT_SPEEDS
from frictionlab.mistakes.notes import Notes, Path, StudyError, did_you_mean, number_text, value_text
from frictionlab.mistakes.validation import (
    checked_value,
    number_paths,
    placed,
    record_at,
    valid_number,
    value_paths,
    wrong_value,
)
from frictionlab.scene.dimensional import Dimensional
from frictionlab.scene.scene import Scene
from frictionlab.study.axes import FRICTION, LINKED, SCENE, STATIC, GridValue, grid_points, owner_of
from frictionlab.study.choices import label_of, possible_labels
from frictionlab.study.ranges import SPACINGS, SpeedRange, SweepRange
from frictionlab.study.study import Study, coefficient_of

LARGEST_GRID = 100_000_000
LARGEST_RANGE = 1_000_000
LARGEST_CHECK = 20_000
"""Points that are built to check a grid; of a larger one the ends and evenly spaced values of each sweep."""
MOST_KEPT_SAMPLES = 50_000_000
"""Samples of kept orbits in all."""
MOST_WITH_HARMONICS = 100_000
"""Points of a table whose harmonics are held with it."""
MOST_STARTS = 100_000
"""Starts from which attractors are looked for, in all."""
_KEYS = ("start", "stop", "num", "spacing")
WITHIN = "within"
"""The key of a range out of which belt speeds are chosen as a run goes."""
FINEST = 10.0
"""Tolerances within which straight lines may be asked to be: a point's own error is as large as that."""
MOST_CHOSEN = 100_000
"""Points of a table whose belt speeds are chosen as a run goes."""

_GROUPS = (
    ("unbalance", "amplitude"),
    ("unbalance_kg_m", "amplitude_N"),
    ("gravity_m_per_s2", "normal_load_N"),
    ("stiffness", "presliding_length", "contact_stiffness"),
    ("damping", "contact_damping"),
)
"""Names of one and the same thing, of which a part of a study gives one."""


@dataclass
class Sweeps:
    """The sweeps of a study, the ranges and the links among them.

    stand_ins: where first values stand in for what the study left out.
    """

    sweep: dict[str, tuple[GridValue, ...]] = field(default_factory=dict)
    ranges: dict[str, SweepRange | SpeedRange] = field(default_factory=dict)
    links: tuple[tuple[str, ...], ...] = ()
    stand_ins: dict[Path, Path] = field(default_factory=dict)


@dataclass(frozen=True)
class _Target:
    """What one sweep varies: ``key`` of the mapping at ``parent``, a field of ``record``."""

    parent: Path
    key: str
    record: type[BaseModel]

    @property
    def is_number(self) -> bool:
        """Whether it is a number, of which ranges are made, and no word."""
        return self.key in number_paths(self.record)


def read_sweeps(tree: dict[str, Any], laws: registry.Laws, notes: Notes) -> Sweeps:
    """Read the sweeps; a swept value that the study leaves out is put into the tree."""
    given = notes.mapping(tree.get("sweep", {}), ("sweep",)) or {}
    too_large = _note_too_large(given, notes)
    reader = _SweepReader(tree, laws, notes, too_large)
    for key, values in given.items():
        if key == LINKED:
            reader.read_linked(values)
        else:
            reader.read(key, values, ("sweep", key))
    return reader.found


class _SweepReader:
    """The sweeps of a study, read one after another."""

    def __init__(self, tree: dict[str, Any], laws: registry.Laws, notes: Notes, too_large: bool) -> None:
        self._tree, self._notes, self._too_large = tree, notes, too_large
        self._targets = _Targets(tree, laws, notes)
        self.found = Sweeps()

    def read(self, key: str, values: Any, path: Path, linked: bool = False) -> None:
        """One list or range, of a path by itself or of one among those of a linked entry."""
        targets = self._targets.at(key, path)
        if key in self.found.sweep:
            self._notes.on_key(path, f"{key} is swept already")
            return
        first = targets[0] if targets else None
        read = _read_values(values, first, path, self._notes, unique=not linked)
        if isinstance(read, SpeedRange) and (linked or key not in BELT_SPEEDS):
            what = "belt speeds alone are chosen so, where no others are linked to them; give num"
            self._notes.on_key((*path, WITHIN), what)
            return
        is_range = isinstance(read, SweepRange | SpeedRange)
        if isinstance(read, SweepRange | SpeedRange):
            self.found.ranges[key] = read
        for target in targets if is_range else targets[1:]:
            _check_values(read if isinstance(read, tuple) else _ends(read), target, path, self._notes)
        built = _ends(read) if self._too_large else _built(read, path, self._notes)
        for target in targets:
            _stand_in(self._tree, target, built, self.found.stand_ins, path)
        self.found.sweep[key] = built

    def read_linked(self, given: Any) -> None:
        """The entries of lists that advance together."""
        if not isinstance(given, list):
            what = (
                "must be a list of entries such as {scene.drive.frequency: [1, 2], scene.normal_load: [5, 9]}"
            )
            self._notes.add(("sweep", LINKED), f"{what}, got {value_text(given)}")
            return
        if not given:
            self._notes.add(("sweep", LINKED), "the list is empty; give at least one entry")
        for index, entry in enumerate(given):
            path: Path = ("sweep", LINKED, index)
            if (lists := self._notes.mapping(entry, path)) is None:
                continue
            if len(lists) < 2:
                self._notes.add(
                    path, "one list alone links nothing: give two or more, or write it under sweep"
                )
            for key, values in lists.items():
                self.read(key, values, (*path, key), linked=True)
            if not self._notes.below(path):
                self._check_entry({key: self.found.sweep[key] for key in lists}, path)

    def _check_entry(self, lists: dict[str, tuple[GridValue, ...]], path: Path) -> None:
        sizes = {key: len(values) for key, values in lists.items()}
        first = next(iter(sizes))
        for key, size in sizes.items():
            if size != sizes[first] and not self._too_large:
                what = f"has {size} values, {first} {sizes[first]}: lists of one entry advance together"
                self._notes.add((*path, key), what)
                return
        points = list(zip(*lists.values(), strict=True))
        twice = next((at for at, point in enumerate(points) if points.index(point) < at), None)
        if twice is not None:
            self._notes.add(path, f"its places {points.index(points[twice])} and {twice} are the same point")
        self.found.links += (tuple(lists),)


Read = tuple[GridValue, ...] | SweepRange | SpeedRange
"""A list of values, or a range of them not yet built."""


def _ends(read: Read) -> tuple[GridValue, ...]:
    """The ends of a range, which decide whether its values are allowed; of a list the first value."""
    return read[:1] if isinstance(read, tuple) else (read.start, read.stop)


def _note_too_large(given: Mapping[str, Any], notes: Notes) -> bool:
    """Whether the sweeps alone give too large a grid, noted before their values are built."""
    scene, laws = 1, dict[str, int]()
    entries = given[LINKED] if isinstance(given.get(LINKED), list) else []
    alone = [{key: values} for key, values in given.items() if key != LINKED]
    for lists in [*alone, *(entry for entry in entries if isinstance(entry, dict) and entry)]:
        size, owners = max(1, *map(_size, lists.values())), {owner_of(str(key)) for key in lists}
        if owners & {SCENE, ""}:
            scene *= size
        else:
            laws |= {owner: laws.get(owner, 1) * size for owner in owners}
    size = scene * max(1, sum(laws.values()))
    if size > LARGEST_GRID:
        notes.add(("sweep",), f"the grid has at least {size} points, more than {LARGEST_GRID}")
    return size > LARGEST_GRID


def _size(given: Any) -> int:
    """How many values a list or a range gives; 1 where it is mistaken."""
    if isinstance(given, list):
        return len(given)
    num = given.get("num") if isinstance(given, dict) else None
    return num if isinstance(num, int) and 2 <= num <= LARGEST_RANGE else 1


class _Targets:
    """What sweeps can vary: the values of a scene, and the numbers of its laws by label."""

    def __init__(self, tree: dict[str, Any], laws: registry.Laws, notes: Notes) -> None:
        self._tree, self._laws, self._notes = tree, laws, notes

    @cached_property
    def _labels(self) -> dict[str, int]:
        laws = self._tree.get("laws")
        laws = laws if isinstance(laws, list) else []
        found = {label_of(law): index for index, law in enumerate(laws) if isinstance(law, dict)}
        return {label: index for label, index in found.items() if label is not None}

    @cached_property
    def _sweepable(self) -> list[str]:
        paths = [f"scene.{path}" for path in value_paths(Scene)]
        for label, index in self._labels.items():
            kind = self._tree["laws"][index].get("kind")
            if kind in self._laws.names():
                paths += [f"laws.{label}.{name}" for name in number_paths(self._laws.named(kind))]
        return paths

    @cached_property
    def _possible_labels(self) -> Container[str]:
        return possible_labels(self._tree.get("laws"), self._laws)

    def at(self, key: str, path: Path) -> list[_Target]:
        """What a sweep of this name, at this path, varies; nothing, noted, where there is no such thing."""
        if key == FRICTION:
            return self._of_every_law(path)
        head, *steps = key.split(".")
        if head == "scene" and key.removeprefix("scene.") in value_paths(Scene):
            found = self._of_scene(steps, path)
        elif head == "laws":
            found = self._of_law(key, path)
        else:
            what = "only scene.<value>, laws.<label>.<parameter>, friction and linked can be swept"
            what = "no such value in a scene" if head == "scene" else what
            self._notes.on_key(path, what, self._hint(key))
            found = None
        return [] if found is None else [found]

    def _hint(self, key: str) -> str:
        """The value whose path ends so, of a part that the study has; else the name most similar to the one given."""
        ending = (path for path in self._sweepable if path.endswith(f".{key}"))
        found = next((path for path in ending if self._has_part(path)), None)
        return did_you_mean(found or key, [*self._sweepable, FRICTION, LINKED])

    def _has_part(self, path: str) -> bool:
        """Whether the study has the law, or gives the part of the scene, that this value is of."""
        return path.startswith("laws.") or isinstance(_at(self._tree, tuple(path.split(".")[:-1])), dict)

    @cached_property
    def _with_friction(self) -> bool:
        """Whether the study sweeps the friction coefficient of every law."""
        given = self._tree["sweep"]
        entries = given[LINKED] if isinstance(given.get(LINKED), list) else []
        return any(FRICTION in lists for lists in (given, *entries) if isinstance(lists, dict))

    def _of_every_law(self, path: Path) -> list[_Target]:
        """The friction coefficient of sliding of every law of a known kind."""
        found = []
        for label, index in self._labels.items():
            given = self._tree["laws"][index]
            if given.get("kind") not in self._laws.names():
                continue
            law = self._laws.named(given["kind"])
            name = coefficient_of(law)
            if not name:
                what = f"the law '{label}' has neither mu nor mu_kinetic to set"
                self._notes.on_key(path, what, "sweep laws.<label>.<parameter> of the others")
            elif name not in number_paths(law):
                self._notes.on_key(path, f"{name} of the law '{label}' is not one number")
            else:
                if given.get(STATIC) is not None and not given.get(name):
                    said = f"{name} is {'missing' if name not in given else number_text(0)}"
                    what = f"friction keeps the ratio of {STATIC} to {name}: of the law '{label}' {said}"
                    self._notes.on_key(path, what)
                found.append(_Target(("laws", index), name, law))
        return found

    def _of_scene(self, steps: list[str], path: Path) -> _Target | None:
        parent: Path = ("scene", *steps[:-1])
        if steps[0] != "dimensional" and isinstance(_at(self._tree, ("scene", "dimensional")), dict):
            known = [f"scene.{value}" for value in value_paths(Dimensional, "dimensional.")]
            hint = did_you_mean(f"scene.{'.'.join(steps)}", known)
            what = "the scene is given in SI units: sweep its values under scene.dimensional"
            self._notes.on_key(path, what, hint)
            return None
        within = _at(self._tree, parent)
        name = ".".join(map(str, parent))
        if not isinstance(within, dict):
            if within is None:
                self._notes.on_key(path, f"the study has no {name}")
            return None
        if other := _alias_given(within, steps[-1]):
            self._notes.on_key(path, f"{name} gives {other}, so {steps[-1]} cannot be swept")
            return None
        record = record_at(Scene, tuple(steps[:-1]))
        return _Target(parent, steps[-1], record) if record else None

    def _of_law(self, key: str, path: Path) -> _Target | None:
        label, _, parameter = key.removeprefix("laws.").rpartition(".")
        index = self._labels.get(label)
        if index is None and label in self._possible_labels:
            return None
        if index is None:
            what = f"no law is labelled '{label}'" if label else "write laws.<label>.<parameter>"
            self._notes.on_key(path, what, did_you_mean(key, self._sweepable))
            return None
        kind = self._tree["laws"][index].get("kind")
        return (
            self._of_parameter(("laws", index), kind, label, parameter, path)
            if kind in self._laws.names()
            else None
        )

    def _of_parameter(self, at: Path, kind: str, label: str, parameter: str, path: Path) -> _Target | None:
        law = self._laws.named(kind)
        if self._with_friction and parameter in (coefficient_of(law), STATIC):
            self._notes.on_key(path, f"the study sweeps friction, which sets {parameter} of every law")
            return None
        if parameter not in number_paths(law):
            what = f"the law '{label}' has no parameter '{parameter}' to sweep"
            if parameter in law.model_fields:
                advice = "give a law of its own for each of its values"
                what = f"{parameter} of the law '{label}' is not one number: {advice}"
            self._notes.on_key(path, what, did_you_mean(parameter, number_paths(law)))
            return None
        if other := _alias_given(_at(self._tree, at), parameter):
            self._notes.on_key(path, f"the law '{label}' gives {other}, so {parameter} cannot be swept")
            return None
        return _Target(at, parameter, law)


def _alias_given(within: dict[str, Any], key: str) -> str | None:
    """An alternative to ``key``, such as amplitude for unbalance, if the study gives that one."""
    group = next((names for names in _GROUPS if key in names), ())
    return None if key in within else next((name for name in group if name in within), None)


def _at(tree: Any, path: Path) -> Any:
    """The value at this path, None if there is none; if the tree ends before the path does, its last value."""
    for step in path:
        if isinstance(tree, list) and isinstance(step, int):
            tree = tree[step]
        elif isinstance(tree, dict):
            tree = tree.get(step)
        else:
            return tree
    return tree


def _check_values(values: Sequence[GridValue], target: _Target, path: Path, notes: Notes) -> None:
    """Check values, such as the ends of a range, which decide whether all of them are allowed."""
    for index, value in enumerate(values):
        if what := wrong_value(target.record, target.key, value):
            notes.add((*path, index), what)


def _stand_in(
    tree: dict[str, Any],
    target: _Target,
    values: tuple[GridValue, ...],
    stand_ins: dict[Path, Path],
    path: Path,
) -> None:
    """Complete a scene or law with the first of the swept values, which need not be given a second time."""
    within = _at(tree, target.parent)
    if not isinstance(within, dict) or target.key in within:
        return
    good = [value for value in values if wrong_value(target.record, target.key, value) is None]
    if good or target.is_number:
        within[target.key] = good[0] if good else valid_number(target.record, target.key)
        stand_ins[(*target.parent, target.key)] = path


def note_impossible_points(study: Study, notes: Notes) -> None:
    """Build the whole grid and note points that cannot be built, or a grid that is too large."""
    size = grid_size(study)
    if size > LARGEST_GRID:
        notes.add(("sweep",), f"the grid has {size} points, more than {LARGEST_GRID}")
        return
    if study.chosen_range is not None:
        _build(lambda: study.scenes_along, (SCENE,), study, notes)
        if notes.all or not _may_be_chosen(study, study.chosen_range, notes):
            return
        size = grid_size(study.foreseen())
    if (study.keep_orbit or 0) * size > MOST_KEPT_SAMPLES:
        notes.add(
            ("keep", "orbit"),
            f"{study.keep_orbit} samples of {size} points are more than {MOST_KEPT_SAMPLES}",
        )
        return
    if study.keep_harmonics is not None and size > MOST_WITH_HARMONICS:
        said = f"harmonics are kept of {MOST_WITH_HARMONICS} points at most, not of {size}"
        notes.add(("keep", "harmonics"), said)
        return
    if (study.keep_attractors or 0) * size > MOST_STARTS:
        said = f"{study.keep_attractors} starts at {size} points are more than {MOST_STARTS}"
        notes.add(("keep", "attractors"), said)
        return
    study = _thinned(study)
    _build(lambda: study.scenes_along, (SCENE,), study, notes)
    for index, choice in enumerate(study.laws if not notes.all else ()):
        own = f"laws.{choice.label}.", ""
        _build(lambda law=choice: study.laws_in_scenes(law), own, study, notes)  # type: ignore[misc]  # of a lambda
        if not notes.all and not all(map(_has_a_stiffness, study.laws_in_scenes(choice))):
            notes.on_key(("laws", index), "these values give no finite stiffness > 0: check their units")


def _may_be_chosen(study: Study, along: SpeedRange, notes: Notes) -> bool:
    path: Path = ("sweep", next(path for path, each in study.ranges.items() if each is along), WITHIN)
    about = grid_size(study.foreseen())
    if along.within < FINEST * study.tolerance:
        least = number_text(float(f"{FINEST * study.tolerance:.6g}"))
        notes.add(path, f"must be >= {least}, {FINEST:g} times tolerance, got {number_text(along.within)}")
    elif about > MOST_CHOSEN:
        what = (
            f"the grid has about {about} points; belt speeds are chosen for {MOST_CHOSEN} at most: give num"
        )
        notes.add(path, what)
    return not notes.all


def _has_a_stiffness(law: Any) -> bool:
    """Whether a compliant law keeps a presliding length and a stiffness > 0, neither infinite."""
    if not law.compliant:
        return True
    return 0.0 < law.bristle_stiffness < math.inf and 0.0 < law.presliding() < math.inf


def _thinned(study: Study) -> Study:
    """The study with few enough values of each sweep, its ends among them, to build every point."""
    while grid_size(study) > LARGEST_CHECK:
        longest = max(study.axes, key=len)
        if len(longest) == 2:
            break
        study = replace(study, sweep=study.sweep | longest.thinned().values)
    return study


def grid_size(study: Study) -> int:
    """The number of rows of the table."""
    laws = sum(grid_points(study.own_axes(law)) for law in study.laws)
    points = sum(map(len, study.chosen)) if study.chosen else grid_points(study.scene_axes)
    return points * laws * len(study.methods)


def _build(build: Callable[[], Any], owners: Container[str], study: Study, notes: Notes) -> None:
    """Note values that are right one by one but invalid together. owners: of the sweeps they are of."""
    try:
        build()
    except StudyError as problem:
        own = [path for path in study.sweep if owner_of(path) in owners]
        path: Path = _place(own[-1], study) if own else ("laws",)
        notes.on_key(path, problem.mistakes[0].what)


def _place(swept: str, study: Study) -> Path:
    """Where in a study a sweep is."""
    entry = next((index for index, paths in enumerate(study.links) if swept in paths), None)
    return ("sweep", swept) if entry is None else ("sweep", LINKED, entry, swept)


def _read_values(given: Any, target: _Target | None, path: Path, notes: Notes, unique: bool) -> Read:
    """The values of one sweep, from a list or a range not yet built; empty, noted, where there is a mistake."""
    words = target is not None and not target.is_number
    if isinstance(given, list):
        values = _list_values(given, target, path, notes)
        if unique:
            _note_doubles(values, path, notes)
        return tuple(value for value in values if value is not None)
    if isinstance(given, dict) and not words:
        return _read_range(given, path, notes) or ()
    wanted = "must be a list" if words else "must be a list or {start, stop, num, spacing}"
    notes.add(path, f"{wanted}, got {value_text(given)}")
    return ()


def _list_values(
    given: list[Any], target: _Target | None, path: Path, notes: Notes
) -> list[GridValue | None]:
    if not given:
        notes.add(path, "the list is empty; give at least one value")
    return [_list_value(item, target, (*path, index), notes) for index, item in enumerate(given)]


def _note_doubles(values: Sequence[GridValue | None], path: Path, notes: Notes) -> None:
    seen: dict[GridValue, int] = {}
    for index, value in enumerate(values):
        if value is not None and seen.setdefault(value, index) != index:
            told = number_text(value) if isinstance(value, float) else str(value)
            notes.add((*path, index), f"{told} is in the list twice")


def _list_value(item: Any, target: _Target | None, path: Path, notes: Notes) -> GridValue | None:
    """One value as the scene or law holds it; None, noted, where it cannot."""
    if target is None:  # the mistake is in the key
        return item if isinstance(item, float | int | str) else None
    if item is None:
        notes.add(path, f"must be a {'number' if target.is_number else 'value'}, got null")
        return None
    value: GridValue | None
    value, what, hint = checked_value(target.record, target.key, item)
    if what is not None:
        notes.add(*placed(path, what, item), hint)
    return value


def _read_range(given: dict[str, Any], path: Path, notes: Notes) -> SweepRange | SpeedRange | None:
    chosen = WITHIN in given
    usual = (*_KEYS, WITHIN) if path[-1] in BELT_SPEEDS else _KEYS
    notes.mapping(given, path, ("start", "stop", WITHIN) if chosen else usual)
    for key in ("start", "stop") if chosen else ("start", "stop", "num"):
        if key not in given:
            notes.add((*path, key), "required key is missing")
    ends = [notes.number(given[key], (*path, key)) if key in given else None for key in ("start", "stop")]
    start, stop = ends
    num = notes.whole_number(given["num"], (*path, "num"), 2) if "num" in given else None
    spacing = notes.one_of(given.get("spacing", "linear"), (*path, "spacing"), SPACINGS)
    if start is not None and spacing == "log" and start <= 0:
        notes.add((*path, "start"), f"must be > 0 for log spacing, got {number_text(start)}")
    if start is not None and stop is not None and stop <= start:
        notes.add((*path, "stop"), f"must be > start = {number_text(start)}, got {number_text(stop)}")
    if num is not None and num > LARGEST_RANGE:
        notes.add((*path, "num"), f"must be <= {LARGEST_RANGE}, got {num}")
    within = notes.positive(given[WITHIN], (*path, WITHIN)) if chosen else None
    if chosen and start is not None and stop is not None and within is not None:
        return None if notes.below(path) else SpeedRange(start, stop, within)
    if notes.below(path) or start is None or stop is None or num is None or spacing is None:
        return None
    return SweepRange(start, stop, num, spacing)


def _built(read: Read, path: Path, notes: Notes) -> tuple[GridValue, ...]:
    """The values; of belt speeds that are chosen as a run goes the ends."""
    if not isinstance(read, SweepRange):
        return _ends(read) if isinstance(read, SpeedRange) else read
    values = read.values()
    if not all(map(operator.lt, values, values[1:])):
        notes.add(path, f"there are no {read.num} different numbers between start and stop")
    return values
