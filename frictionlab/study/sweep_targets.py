"""Values that a sweep can vary: those of a scene, and the numbers of its laws."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

from pydantic import BaseModel

from frictionlab.scene.dimensional import without_unit
from frictionlab.scene.scene import Scene
from frictionlab.scene.units import DASHPOT, SPRING, SWINGS
from frictionlab.study import registry
from frictionlab.study.axes import ENDS, FRICTION, LINKED, STATIC
from frictionlab.study.parts import coefficient_of, label_of
from frictionlab.study.written import column_of, scene_is_in_si
from frictionlab.values.notes import KeyPath, Notes, did_you_mean, number_text
from frictionlab.values.validation import field_name, number_paths, record_at, value_paths

_GROUPS = (
    ("unbalance", "amplitude"),
    ("unbalance_kg_m", "amplitude_N"),
    ("gravity_m_per_s2", "normal_load_N"),
    *(SPRING, DASHPOT, SWINGS),
    ("stiffness", "presliding_length", "contact_stiffness"),
    ("damping", "contact_damping"),
)
"""Names of one and the same thing, of which a part of a study gives one."""


@dataclass(frozen=True)
class Target:
    """Target of one sweep: ``key`` of the mapping at ``parent``, a field of ``record``."""

    parent: KeyPath
    key: str
    record: type[BaseModel]

    @property
    def is_number(self) -> bool:
        """Check whether it is a number, of which ranges are made, and no word."""
        return self.key in number_paths(self.record)

    def is_given(self, within: dict[str, Any]) -> bool:
        """Check whether a part of a study gives it, under whichever key."""
        return any(field_name(self.record, key) == self.key for key in within)


class Targets:
    """Values that sweeps can vary: those of a scene, and the numbers of its laws by label."""

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
        own = scene_is_in_si(self._tree)
        paths = [f"scene.{path}" for path in value_paths(Scene) if path.startswith("dimensional.") == own]
        for label, index in self._labels.items():
            kind = self._tree["laws"][index].get("kind")
            if kind in self._laws.names():
                paths += [f"laws.{label}.{name}" for name in number_paths(self._laws.named(kind))]
        return paths

    @cached_property
    def _all_known(self) -> bool:
        """Check whether no mistake in a law leaves its label or its kind open."""
        laws, kinds = self._tree.get("laws"), self._laws.names()
        each = laws if isinstance(laws, list) else []
        visible = all(label.strip() and label.isprintable() for label in self._labels)
        sure = visible and len(self._labels) == len(each) > 0
        return sure and all(isinstance(law, dict) and law.get("kind") in kinds for law in each)

    def at(self, key: str, path: KeyPath) -> list[Target]:
        """Return what a sweep of this name, at this path, varies; nothing, noted, where there is no such thing."""
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
            self._notes.on_key(path, what, self._hint(key, path))
            found = None
        return [] if found is None else [found]

    def _hint(self, key: str, at: KeyPath) -> str:
        """Value whose path ends so, of a part that the study has; else the name most similar to the one given."""
        names = {path: {path, without_unit(path)} for path in self._sweepable}
        ending = (path for path in names if any(f".{name}".endswith(f".{key}") for name in names[path]))
        found = next((path for path in ending if self._has_part(path)), None)
        as_told = without_unit if self._has_texts(at) else str
        known = [*dict.fromkeys(map(as_told, names)), FRICTION, LINKED]
        return did_you_mean(as_told(found or key), known)

    def _has_texts(self, at: KeyPath) -> bool:
        """Check whether values of a sweep are written as text, with units then: so its name needs none."""
        given = value_at(self._tree, at)
        each = [given.get(end) for end in ENDS] if isinstance(given, dict) else given
        return isinstance(each, list) and any(isinstance(value, str) for value in each)

    def _has_part(self, path: str) -> bool:
        """Check whether the study has the law, or gives the part of the scene, that this value is of."""
        return path.startswith("laws.") or isinstance(value_at(self._tree, tuple(path.split(".")[:-1])), dict)

    @cached_property
    def _with_friction(self) -> bool:
        """Check whether the study sweeps the friction coefficient of every law."""
        return FRICTION in swept_paths(self._tree)

    def _of_every_law(self, path: KeyPath) -> list[Target]:
        """Return the friction coefficient of sliding of every law of a known kind."""
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
                found.append(Target(("laws", index), name, law))
        return found

    def _of_scene(self, steps: list[str], path: KeyPath) -> Target | None:
        parent: KeyPath = ("scene", *steps[:-1])
        if steps[0] != "dimensional" and isinstance(value_at(self._tree, ("scene", "dimensional")), dict):
            what = "the scene is given in SI units: sweep its values under scene.dimensional"
            self._notes.on_key(path, what, self._hint(f"scene.dimensional.{'.'.join(steps)}", path))
            return None
        within = value_at(self._tree, parent)
        name = ".".join(map(str, parent))
        if not isinstance(within, dict):
            if within is None:
                self._notes.on_key(path, f"the study has no {name}")
            return None
        if (record := record_at(Scene, tuple(steps[:-1]))) is None:
            return None
        if other := _alias_given(within, steps[-1], record):
            self._notes.on_key(path, f"{name} gives {other}, so {steps[-1]} cannot be swept")
            return None
        return Target(parent, steps[-1], record)

    def _of_law(self, key: str, path: KeyPath) -> Target | None:
        label, _, parameter = key.removeprefix("laws.").rpartition(".")
        index = self._labels.get(label)
        if index is None and not self._all_known:
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

    def _of_parameter(
        self, at: KeyPath, kind: str, label: str, parameter: str, path: KeyPath
    ) -> Target | None:
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
        if other := _alias_given(value_at(self._tree, at), parameter, law):
            self._notes.on_key(path, f"the law '{label}' gives {other}, so {parameter} cannot be swept")
            return None
        return Target(at, parameter, law)


def _alias_given(within: dict[str, Any], key: str, record: type[BaseModel]) -> str | None:
    """An alternative to ``key``, such as amplitude for unbalance, if the study gives that one."""
    group = next((names for names in _GROUPS if key in names), ())
    given = {field_name(record, each): each for each in within}
    return None if key in given else next((given[name] for name in group if name in given), None)


def swept_paths(tree: dict[str, Any]) -> tuple[str, ...]:
    """Return the paths that a study sweeps, those of linked entries included, right or wrong."""
    given = tree.get("sweep")
    entries = given.get(LINKED) if isinstance(given, dict) else None
    lists = [given, *(entries if isinstance(entries, list) else ())]
    return tuple(column_of(key) for each in lists if isinstance(each, dict) for key in each if key != LINKED)


def value_at(tree: Any, path: KeyPath) -> Any:
    """Return the value at this path, None if there is none; if the tree ends before the path does, its last value."""
    for step in path:
        if isinstance(tree, list) and isinstance(step, int):
            tree = tree[step]
        elif isinstance(tree, dict):
            tree = tree.get(step)
        else:
            return tree
    return tree
