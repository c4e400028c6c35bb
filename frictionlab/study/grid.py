"""Sweeps: the values that can be swept, and a check that every point of the grid can be built."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any

from pydantic import BaseModel, ValidationError

from frictionlab import registry
from frictionlab.mistakes.notes import Notes, Path, did_you_mean, number_text, value_text
from frictionlab.mistakes.validation import number_paths, record_at, valid_number, wrong_value
from frictionlab.scene.dimensional import Dimensional
from frictionlab.scene.scene import Scene
from frictionlab.study.choices import label_of, may_become_a_label
from frictionlab.study.study import Study

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
    """The sweeps of a study, and where their first values stand in for what the study left out."""

    sweep: dict[str, tuple[float, ...]] = field(default_factory=dict)
    stand_ins: dict[Path, Path] = field(default_factory=dict)


@dataclass(frozen=True)
class _Target:
    """What one sweep varies: ``key`` of the mapping at ``parent``, a field of ``record``."""

    parent: Path
    key: str
    record: type[BaseModel]


def read_sweeps(tree: dict[str, Any], laws: registry.Laws, notes: Notes) -> Sweeps:
    """Read the sweeps; a swept value that the study leaves out is put into the tree."""
    found = Sweeps()
    given = notes.mapping(tree.get("sweep", {}), ("sweep",)) or {}
    for key, range_ in given.items():
        values = sweep_values(range_, ("sweep", key), notes)
        if target := _target(tree, key, laws, notes):
            _check_values(values, target, ("sweep", key), notes)
            _stand_in(tree, target, values, found.stand_ins, key)
        found.sweep[key] = values
    return found


def _target(tree: dict[str, Any], key: str, laws: registry.Laws, notes: Notes) -> _Target | None:
    head, *steps = key.split(".")
    if head == "scene" and key.removeprefix("scene.") in number_paths(Scene):
        return _scene_target(tree, steps, ("sweep", key), notes)
    if head == "laws":
        return _law_target(tree, key, laws, notes)
    known = _sweepable(tree, laws)
    what = "only scene.<value> and laws.<label>.<parameter> can be swept"
    what = "no such value in a scene" if head == "scene" else what
    notes.on_key(("sweep", key), what, did_you_mean(key, known))
    return None


def _scene_target(tree: dict[str, Any], steps: list[str], path: Path, notes: Notes) -> _Target | None:
    parent: Path = ("scene", *steps[:-1])
    if steps[0] != "dimensional" and isinstance(_at(tree, ("scene", "dimensional")), dict):
        known = [f"scene.{value}" for value in number_paths(Dimensional, "dimensional.")]
        hint = did_you_mean(f"scene.{'.'.join(steps)}", known)
        notes.on_key(path, "the scene is given in SI units: sweep its values under scene.dimensional", hint)
        return None
    within = _at(tree, parent)
    name = ".".join(map(str, parent))
    if not isinstance(within, dict):
        if within is None:
            notes.on_key(path, f"the study has no {name}")
        return None
    if other := _alias_given(within, steps[-1]):
        notes.on_key(path, f"{name} gives {other}, so {steps[-1]} cannot be swept")
        return None
    record = record_at(Scene, tuple(steps[:-1]))
    return _Target(parent, steps[-1], record) if record else None


def _law_target(tree: dict[str, Any], key: str, laws: registry.Laws, notes: Notes) -> _Target | None:
    label, _, parameter = key.removeprefix("laws.").rpartition(".")
    index = _labels(tree).get(label)
    if index is None and may_become_a_label(label, tree.get("laws"), laws):
        return None
    if index is None:
        what = f"no law is labelled '{label}'" if label else "write laws.<label>.<parameter>"
        notes.on_key(("sweep", key), what, did_you_mean(key, _sweepable(tree, laws)))
        return None
    kind = tree["laws"][index].get("kind")
    if kind not in laws.names():
        return None
    law = laws.named(kind)
    if parameter not in number_paths(law):
        what = f"the law '{label}' has no parameter '{parameter}' to sweep"
        if parameter in law.model_fields:
            what = f"{parameter} of the law '{label}' is not one number: give a law of its own for each of its values"
        notes.on_key(("sweep", key), what, did_you_mean(parameter, number_paths(law)))
        return None
    if other := _alias_given(tree["laws"][index], parameter):
        notes.on_key(("sweep", key), f"the law '{label}' gives {other}, so {parameter} cannot be swept")
        return None
    return _Target(("laws", index), parameter, law)


def _alias_given(within: dict[str, Any], key: str) -> str | None:
    """An alternative to ``key``, such as amplitude for unbalance, if the study gives that one."""
    group = next((names for names in _GROUPS if key in names), ())
    return None if key in within else next((name for name in group if name in within), None)


def _labels(tree: dict[str, Any]) -> dict[str, int]:
    laws = tree.get("laws")
    laws = laws if isinstance(laws, list) else []
    found = {label_of(law): index for index, law in enumerate(laws) if isinstance(law, dict)}
    return {label: index for label, index in found.items() if label is not None}


def _sweepable(tree: dict[str, Any], laws: registry.Laws) -> list[str]:
    paths = [f"scene.{path}" for path in number_paths(Scene)]
    for label, index in _labels(tree).items():
        kind = tree["laws"][index].get("kind")
        if kind in laws.names():
            paths += [f"laws.{label}.{name}" for name in number_paths(laws.named(kind))]
    return paths


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


def _check_values(values: Iterable[float], target: _Target, path: Path, notes: Notes) -> None:
    """Check each value by itself, so that a mistake refers to the value and not to a point of the grid."""
    for index, value in enumerate(values):
        if what := wrong_value(target.record, target.key, value):
            notes.add((*path, index), what)


def _stand_in(
    tree: dict[str, Any], target: _Target, values: tuple[float, ...], stand_ins: dict[Path, Path], key: str
) -> None:
    """Complete a scene or law with the first of the swept values, which need not be given a second time."""
    within = _at(tree, target.parent)
    if isinstance(within, dict) and target.key not in within:
        good = [value for value in values if wrong_value(target.record, target.key, value) is None]
        within[target.key] = good[0] if good else valid_number(target.record, target.key)
        stand_ins[(*target.parent, target.key)] = ("sweep", key)


def note_impossible_points(study: Study, notes: Notes) -> None:
    """Build the whole grid and note points that cannot be built, or a grid that is too large."""
    size = grid_size(study)
    if size > LARGEST_GRID:
        notes.add(("sweep",), f"the grid has {size} points, more than {LARGEST_GRID}")
        return
    _build(lambda: study.scenes, study.sweep, "scene.", notes)
    for index, choice in enumerate(study.laws if not notes.all else ()):
        _build(lambda law=choice: study.laws_in_scenes(law), study.sweep, f"laws.{choice.label}.", notes)  # type: ignore[misc]
        if not notes.all and not all(map(_has_a_stiffness, study.laws_in_scenes(choice))):
            notes.on_key(("laws", index), "these values give no finite stiffness > 0: check their units")


def _has_a_stiffness(law: Any) -> bool:
    """Whether a compliant law keeps a presliding length and a stiffness > 0, neither infinite."""
    if not law.compliant:
        return True
    return 0.0 < law.bristle_stiffness < math.inf and 0.0 < law.presliding() < math.inf


def grid_size(study: Study) -> int:
    """The number of rows of the table."""
    scenes = math.prod(len(v) for path, v in study.sweep.items() if path.startswith("scene."))
    laws = (
        math.prod(len(v) for path, v in study.sweep.items() if path.rpartition(".")[0] == f"laws.{law.label}")
        for law in study.laws
    )
    return scenes * sum(laws) * len(study.methods)


def _build(build: Callable[[], Any], sweep: Mapping[str, Any], prefix: str, notes: Notes) -> None:
    """Note values that are right one by one but invalid together."""
    try:
        build()
    except (ValidationError, OverflowError) as problem:
        what = str(problem)
        if isinstance(problem, ValidationError):
            what = problem.errors(include_url=False)[0]["msg"]
        own = [path for path in sweep if path.startswith(prefix)]
        path: Path = ("sweep", own[-1]) if own else ("laws",)
        notes.on_key(path, f"a point of the grid cannot be built: {what}")


LARGEST_GRID = 1_000_000

_KEYS = ("start", "stop", "num", "spacing")
_SPACINGS = ("linear", "log")


def sweep_values(given: Any, path: Path, notes: Notes) -> tuple[float, ...]:
    """The values of one sweep, from a list or a range; empty, noted, where there is a mistake."""
    if isinstance(given, list):
        return _list_values(given, path, notes)
    if isinstance(given, dict):
        return _range_values(given, path, notes)
    notes.add(path, f"must be a list or {{start, stop, num, spacing}}, got {value_text(given)}")
    return ()


def _list_values(given: list[Any], path: Path, notes: Notes) -> tuple[float, ...]:
    if not given:
        notes.add(path, "the list is empty; give at least one value")
    values = [notes.number(item, (*path, index)) for index, item in enumerate(given)]
    seen: dict[float, int] = {}
    for index, value in enumerate(values):
        if value is not None and seen.setdefault(value, index) != index:
            notes.add((*path, index), f"{number_text(value)} is in the list twice")
    return tuple(value for value in values if value is not None)


def _range_values(given: dict[str, Any], path: Path, notes: Notes) -> tuple[float, ...]:
    notes.mapping(given, path, _KEYS)
    for key in ("start", "stop", "num"):
        if key not in given:
            notes.add((*path, key), "required key is missing")
    ends = [notes.number(given[key], (*path, key)) if key in given else None for key in ("start", "stop")]
    start, stop = ends
    num = notes.whole_number(given["num"], (*path, "num"), 2) if "num" in given else None
    spacing = notes.one_of(given.get("spacing", "linear"), (*path, "spacing"), _SPACINGS)
    if start is not None and spacing == "log" and start <= 0:
        notes.add((*path, "start"), f"must be > 0 for log spacing, got {number_text(start)}")
    if start is not None and stop is not None and stop <= start:
        notes.add((*path, "stop"), f"must be > start = {number_text(start)}, got {number_text(stop)}")
    if num is not None and num > LARGEST_GRID:
        notes.add((*path, "num"), f"must be <= {LARGEST_GRID}, got {num}")
    if notes.below(path) or start is None or stop is None or num is None:
        return ()
    values = _log(start, stop, num) if spacing == "log" else _linear(start, stop, num)
    if len(set(values)) < num:
        notes.add(path, f"there are no {num} different numbers between start and stop")
    return values


def _linear(start: float, stop: float, num: int) -> tuple[float, ...]:
    """Evenly spaced and correctly rounded: {0.1, 1, 10} holds 0.3, not 0.30000000000000004."""
    first, last = Fraction(repr(start)), Fraction(repr(stop))
    step = (last - first) / (num - 1)
    return tuple(float(first + index * step) for index in range(num))


def _log(start: float, stop: float, num: int) -> tuple[float, ...]:
    """Evenly spaced in the logarithm, both ends exact."""
    low, high = math.log(start), math.log(stop)
    inner = (math.exp(low + (high - low) * index / (num - 1)) for index in range(1, num - 1))
    return (start, *inner, stop)
