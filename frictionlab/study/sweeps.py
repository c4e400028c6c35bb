"""Sweeps: the values that can be swept, and their values."""

from __future__ import annotations

import itertools
import operator
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from frictionlab.study import registry
from frictionlab.study.axes import ENDS, LINKED, WITHIN, GridValue, SpeedRange, SweepRange
from frictionlab.study.sweep_targets import Target, Targets, value_at
from frictionlab.study.written import column_of, number_written, scene_is_in_si
from frictionlab.values.columns import BELT_SPEEDS
from frictionlab.values.notes import KeyPath, Notes, number_text, value_text
from frictionlab.values.units import number_before_unit
from frictionlab.values.validation import build_record, checked_value, placed, wrong_value


@dataclass
class Sweeps:
    """Sweeps of a study, the ranges and the links among them.

    stand_ins: where first values stand in for what the study left out. written: where each path is swept.
    """

    sweep: dict[str, tuple[GridValue, ...]] = field(default_factory=dict)
    ranges: dict[str, SweepRange | SpeedRange] = field(default_factory=dict)
    links: tuple[tuple[str, ...], ...] = ()
    stand_ins: dict[KeyPath, KeyPath] = field(default_factory=dict)
    written: dict[str, KeyPath] = field(default_factory=dict)


def read_sweeps(tree: dict[str, Any], laws: registry.Laws, notes: Notes) -> Sweeps:
    """Read the sweeps; a swept value that the study leaves out is put into the tree."""
    given = notes.mapping(tree.get("sweep", {}), ("sweep",)) or {}
    reader = _SweepReader(tree, laws, notes)
    for key, values in given.items():
        if key == LINKED:
            reader.read_linked(values)
        else:
            reader.read(key, values, ("sweep", key))
    return reader.found


class _SweepReader:
    """Sweeps of a study, read one after another."""

    def __init__(self, tree: dict[str, Any], laws: registry.Laws, notes: Notes) -> None:
        self._tree, self._notes = tree, notes
        self._targets = Targets(tree, laws, notes)
        self._in_si = scene_is_in_si(tree)
        self.found = Sweeps()

    def read(self, key: str, values: Any, path: KeyPath, linked: bool = False) -> None:
        """One list or range, of a path by itself or of one among those of a linked entry."""
        name = column_of(key)
        targets = self._targets.at(name, path)
        if name in self.found.sweep:
            self._notes.on_key(path, f"{name} is swept already")
            return
        first = targets[0] if targets else None
        values = self._numbers(values, first, key)
        read = _read_values(values, first, path, self._notes, unique=not linked)
        if isinstance(read, SpeedRange) and (linked or name not in BELT_SPEEDS):
            what = "belt speeds alone are chosen so, where no others are linked to them; give num"
            self._notes.on_key((*path, WITHIN), what)
            return
        checked, others = read, targets[1:]  # the first target has read each value of a list
        if not isinstance(read, tuple):
            self.found.ranges[name] = read
            checked, others = read.ends, targets  # ends decide whether all values between are allowed
        for target, (index, value) in itertools.product(others, enumerate(checked)):
            if wrong := wrong_value(target.record, target.key, value):
                self._notes.add((*path, index), wrong)
        built = _built(read, path, self._notes)
        for target in targets:
            _stand_in(self._tree, target, built, self.found.stand_ins, path)
        self.found.sweep[name] = built
        self.found.written[name] = path

    def _numbers(self, given: Any, target: Target | None, key: str) -> Any:
        """Return the values of a sweep, or the ends of its range, those written as text with a unit as numbers."""
        if not self._in_si:
            return given
        key = key.rpartition(".")[2]

        def number(each: Any) -> Any:
            if target is None:  # that there is no such thing is said; not that its texts are no numbers
                return number_before_unit(each) if isinstance(each, str) else each
            return number_written(target.record, key, target.key, each)

        if isinstance(given, list):
            return [number(each) for each in given]
        if not isinstance(given, dict):
            return given
        return {name: number(each) if name in ENDS else each for name, each in given.items()}

    def read_linked(self, given: Any) -> None:
        """Read the entries of lists that advance together."""
        if not isinstance(given, list):
            what = (
                "must be a list of entries such as {scene.drive.frequency: [1, 2], scene.normal_load: [5, 9]}"
            )
            self._notes.add(("sweep", LINKED), f"{what}, got {value_text(given)}")
            return
        if not given:
            self._notes.add(("sweep", LINKED), "the list is empty; give at least one entry")
        for index, entry in enumerate(given):
            path: KeyPath = ("sweep", LINKED, index)
            if (lists := self._notes.mapping(entry, path)) is None:
                continue
            if len(lists) < 2:
                self._notes.add(
                    path, "one list alone links nothing: give two or more, or write it under sweep"
                )
            for key, values in lists.items():
                self.read(key, values, (*path, key), linked=True)
            if not self._notes.below(path):
                self._check_entry({name: self.found.sweep[name] for name in map(column_of, lists)}, path)

    def _check_entry(self, lists: dict[str, tuple[GridValue, ...]], path: KeyPath) -> None:
        sizes = {key: len(values) for key, values in lists.items()}
        first = next(iter(sizes))
        for key, size in sizes.items():
            if size != sizes[first]:
                what = f"has {size} values, {first} {sizes[first]}: lists of one entry advance together"
                self._notes.add((*path, key), what)
                return
        seen: dict[tuple[GridValue, ...], int] = {}
        for at, point in enumerate(zip(*lists.values(), strict=True)):
            if (before := seen.setdefault(point, at)) != at:
                self._notes.add(path, f"its places {before} and {at} are the same point")
        self.found.links += (tuple(lists),)


Read = tuple[GridValue, ...] | SweepRange | SpeedRange
"""A list of values, or a range of them not yet built."""


def _stand_in(
    tree: dict[str, Any],
    target: Target,
    values: tuple[GridValue, ...],
    stand_ins: dict[KeyPath, KeyPath],
    path: KeyPath,
) -> None:
    """Complete a scene or law with the first of the swept values, which need not be given a second time."""
    within = value_at(tree, target.parent)
    if not isinstance(within, dict) or target.is_given(within):
        return
    likely = [*values, *((1.0, 0.5) if target.is_number else ())]  # shares are below one
    good = [value for value in likely if wrong_value(target.record, target.key, value) is None]
    if good:
        within[target.key] = good[0]
        stand_ins[(*target.parent, target.key)] = path


def _read_values(given: Any, target: Target | None, path: KeyPath, notes: Notes, unique: bool) -> Read:
    """Values of one sweep, from a list or a range not yet built; empty, noted, where there is a mistake."""
    words = target is not None and not target.is_number
    if isinstance(given, list):
        values = _list_values(given, target, path, notes)
        if unique:
            _note_doubles(values, path, notes)
        return tuple(value for value in values if value is not None)
    if isinstance(given, dict) and not words:
        kind: type[SpeedRange | SweepRange] = SpeedRange if WITHIN in given else SweepRange
        return build_record(kind, given, path, notes) or ()
    wanted = "must be a list" if words else "must be a list or {start, stop, num, spacing}"
    notes.add(path, f"{wanted}, got {value_text(given)}")
    return ()


def _list_values(
    given: list[Any], target: Target | None, path: KeyPath, notes: Notes
) -> list[GridValue | None]:
    if not given:
        notes.add(path, "the list is empty; give at least one value")
    return [_list_value(item, target, (*path, index), notes) for index, item in enumerate(given)]


def _note_doubles(values: Sequence[GridValue | None], path: KeyPath, notes: Notes) -> None:
    seen: dict[GridValue, int] = {}
    for index, value in enumerate(values):
        if value is not None and seen.setdefault(value, index) != index:
            told = number_text(value) if isinstance(value, float) else str(value)
            notes.add((*path, index), f"{told} is in the list twice")


def _list_value(item: Any, target: Target | None, path: KeyPath, notes: Notes) -> GridValue | None:
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


def _built(read: Read, path: KeyPath, notes: Notes) -> tuple[GridValue, ...]:
    """Return the values; of belt speeds that are chosen as a run goes the ends."""
    if not isinstance(read, SweepRange):
        return read.ends if isinstance(read, SpeedRange) else read
    values = read.values()
    if not all(map(operator.lt, values, values[1:])):
        notes.add(path, f"there are no {read.num} different numbers between start and stop")
    return values
