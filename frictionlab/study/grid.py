"""Sweeps: the values that can be swept, and a check that every point of the grid can be built."""

from __future__ import annotations

import math
import operator
from collections.abc import Callable, Container, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

from pydantic import BaseModel

from frictionlab import registry
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
from frictionlab.study.choices import label_of, possible_labels
from frictionlab.study.ranges import SPACINGS, SweepRange
from frictionlab.study.study import GridValue, Study, owner

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
    """The sweeps of a study, the ranges among them, and where first values stand in for what the study left out."""

    sweep: dict[str, tuple[GridValue, ...]] = field(default_factory=dict)
    ranges: dict[str, SweepRange] = field(default_factory=dict)
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
    found = Sweeps()
    given = notes.mapping(tree.get("sweep", {}), ("sweep",)) or {}
    too_large = _note_too_large(given, notes)
    targets = _Targets(tree, laws, notes)
    for key, values in given.items():
        target = targets.target(key)
        read = _read_values(values, target, ("sweep", key), notes)
        if isinstance(read, SweepRange):
            found.ranges[key] = read
            if target is not None:
                _check_ends(read, target, ("sweep", key), notes)
        built = _ends(read) if too_large else _built(read, ("sweep", key), notes)
        if target is not None:
            _stand_in(tree, target, built, found.stand_ins, key)
        found.sweep[key] = built
    return found


def _ends(read: tuple[GridValue, ...] | SweepRange) -> tuple[GridValue, ...]:
    """The ends of a range, which decide whether its values are allowed; of a list the first value."""
    return (read.start, read.stop) if isinstance(read, SweepRange) else read[:1]


def _note_too_large(given: Mapping[str, Any], notes: Notes) -> bool:
    """Whether the sweeps alone give too large a grid, noted before their values are built."""
    sizes: dict[str, int] = {}
    for key, values in given.items():
        sizes[owner(key)] = sizes.get(owner(key), 1) * max(1, _size(values))
    size = sizes.pop("scene.", 1) * max(1, sum(sizes.values()))
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

    def target(self, key: str) -> _Target | None:
        """What a sweep of this name varies; None, noted, where it is nothing."""
        head, *steps = key.split(".")
        if head == "scene" and key.removeprefix("scene.") in value_paths(Scene):
            return self._of_scene(steps, ("sweep", key))
        if head == "laws":
            return self._of_law(key)
        what = "only scene.<value> and laws.<label>.<parameter> can be swept"
        what = "no such value in a scene" if head == "scene" else what
        self._notes.on_key(("sweep", key), what, did_you_mean(key, self._sweepable))
        return None

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

    def _of_law(self, key: str) -> _Target | None:
        label, _, parameter = key.removeprefix("laws.").rpartition(".")
        index = self._labels.get(label)
        if index is None and label in self._possible_labels:
            return None
        if index is None:
            what = f"no law is labelled '{label}'" if label else "write laws.<label>.<parameter>"
            self._notes.on_key(("sweep", key), what, did_you_mean(key, self._sweepable))
            return None
        kind = self._tree["laws"][index].get("kind")
        return (
            self._of_parameter(("laws", index), kind, label, parameter)
            if kind in self._laws.names()
            else None
        )

    def _of_parameter(self, at: Path, kind: str, label: str, parameter: str) -> _Target | None:
        law, path = self._laws.named(kind), ("sweep", f"laws.{label}.{parameter}")
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


def _check_ends(values: SweepRange, target: _Target, path: Path, notes: Notes) -> None:
    """Check the ends of a range, which decide whether its values are allowed."""
    for index, value in enumerate(_ends(values)):
        if what := wrong_value(target.record, target.key, value):
            notes.add((*path, index), what)


def _stand_in(
    tree: dict[str, Any],
    target: _Target,
    values: tuple[GridValue, ...],
    stand_ins: dict[Path, Path],
    key: str,
) -> None:
    """Complete a scene or law with the first of the swept values, which need not be given a second time."""
    within = _at(tree, target.parent)
    if not isinstance(within, dict) or target.key in within:
        return
    good = [value for value in values if wrong_value(target.record, target.key, value) is None]
    if good or target.is_number:
        within[target.key] = good[0] if good else valid_number(target.record, target.key)
        stand_ins[(*target.parent, target.key)] = ("sweep", key)


def note_impossible_points(study: Study, notes: Notes) -> None:
    """Build the whole grid and note points that cannot be built, or a grid that is too large."""
    size = grid_size(study)
    if size > LARGEST_GRID:
        notes.add(("sweep",), f"the grid has {size} points, more than {LARGEST_GRID}")
        return
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
    _build(lambda: study.scenes_along, study.sweep, "scene.", notes)
    for index, choice in enumerate(study.laws if not notes.all else ()):
        _build(lambda law=choice: study.laws_in_scenes(law), study.sweep, f"laws.{choice.label}.", notes)  # type: ignore[misc]
        if not notes.all and not all(map(_has_a_stiffness, study.laws_in_scenes(choice))):
            notes.on_key(("laws", index), "these values give no finite stiffness > 0: check their units")


def _has_a_stiffness(law: Any) -> bool:
    """Whether a compliant law keeps a presliding length and a stiffness > 0, neither infinite."""
    if not law.compliant:
        return True
    return 0.0 < law.bristle_stiffness < math.inf and 0.0 < law.presliding() < math.inf


def _thinned(study: Study) -> Study:
    """The study with few enough values of each sweep, its ends among them, to build every point."""
    while grid_size(study) > LARGEST_CHECK:
        path, values = max(study.sweep.items(), key=lambda item: len(item[1]))
        if len(values) == 2:
            break
        study = replace(study, sweep={**study.sweep, path: (*values[:-1:2], values[-1])})
    return study


def grid_size(study: Study) -> int:
    """The number of rows of the table."""
    sizes = {prefix: math.prod(map(len, sweeps.values())) for prefix, sweeps in study.sweeps_by_owner.items()}
    laws = sum(sizes.get(f"laws.{law.label}.", 1) for law in study.laws)
    return sizes.get("scene.", 1) * laws * len(study.methods)


def _build(build: Callable[[], Any], sweep: Mapping[str, Any], prefix: str, notes: Notes) -> None:
    """Note values that are right one by one but invalid together."""
    try:
        build()
    except StudyError as problem:
        own = [path for path in sweep if path.startswith(prefix)]
        path: Path = ("sweep", own[-1]) if own else ("laws",)
        notes.on_key(path, problem.mistakes[0].what)


def _read_values(
    given: Any, target: _Target | None, path: Path, notes: Notes
) -> tuple[GridValue, ...] | SweepRange:
    """The values of one sweep, from a list or a range not yet built; empty, noted, where there is a mistake."""
    words = target is not None and not target.is_number
    if isinstance(given, list):
        return _list_values(given, target, path, notes)
    if isinstance(given, dict) and not words:
        return _read_range(given, path, notes) or ()
    wanted = "must be a list" if words else "must be a list or {start, stop, num, spacing}"
    notes.add(path, f"{wanted}, got {value_text(given)}")
    return ()


def _list_values(given: list[Any], target: _Target | None, path: Path, notes: Notes) -> tuple[GridValue, ...]:
    if not given:
        notes.add(path, "the list is empty; give at least one value")
    values = [_list_value(item, target, (*path, index), notes) for index, item in enumerate(given)]
    seen: dict[GridValue, int] = {}
    for index, value in enumerate(values):
        if value is not None and seen.setdefault(value, index) != index:
            told = number_text(value) if isinstance(value, float) else str(value)
            notes.add((*path, index), f"{told} is in the list twice")
    return tuple(value for value in values if value is not None)


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


def _read_range(given: dict[str, Any], path: Path, notes: Notes) -> SweepRange | None:
    notes.mapping(given, path, _KEYS)
    for key in ("start", "stop", "num"):
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
    if notes.below(path) or start is None or stop is None or num is None or spacing is None:
        return None
    return SweepRange(start, stop, num, spacing)


def _built(read: tuple[GridValue, ...] | SweepRange, path: Path, notes: Notes) -> tuple[GridValue, ...]:
    if not isinstance(read, SweepRange):
        return read
    values = read.values()
    if not all(map(operator.lt, values, values[1:])):
        notes.add(path, f"there are no {read.num} different numbers between start and stop")
    return values
