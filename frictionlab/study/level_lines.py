"""What a study wants level lines of: the key ``boundaries``, and the two swept numbers they are over."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from frictionlab.columns import CURVE_MEASURES
from frictionlab.mistakes.notes import Notes
from frictionlab.study.axes import SCENE, Axis, GridValue, axes_of
from frictionlab.study.grid import StudyGrid, of_law
from frictionlab.study.parts import LawChoice
from frictionlab.study.sweeps import Sweeps

BOUNDARIES_KEY = "boundaries"
_NEEDED = "needs the belt speed and two numbers swept"


def read_boundaries(given: Any, sweeps: Sweeps, notes: Notes) -> dict[str, tuple[float, ...]]:
    """Levels by measure of a curve; mistakes are noted."""
    read = notes.mapping(given, (BOUNDARIES_KEY,), CURVE_MEASURES) or {}
    found = {}
    for measure in (name for name in read if name in CURVE_MEASURES):
        levels = read[measure] if isinstance(read[measure], list) else [read[measure]]
        numbers = [notes.number(level, (BOUNDARIES_KEY, measure)) for level in levels]
        found[measure] = tuple(level for level in numbers if level is not None)
    axes = axes_of(sweeps.sweep, sweeps.links)
    speeds = [axis for axis in axes if axis.is_of_speed]
    if read and (len(speeds) != 1 or len(axes) != 3 or not all(map(_is_number, axes))):
        notes.add((BOUNDARIES_KEY,), f"{_NEEDED}; swept here: {', '.join(sweeps.sweep) or 'nothing'}")
    return found


def swept_numbers(study: StudyGrid) -> tuple[Axis, Axis]:
    """The two axes of a study that has boundaries beside that of belt speed."""
    one, other = (axis for axis in study.axes if not axis.is_of_speed)
    return one, other


def columns_swept(axis: Axis, law: LawChoice) -> dict[str, tuple[GridValue, ...]]:
    """The columns of the table that have numbers of an axis in the rows of a law, and these numbers."""
    own = [(SCENE, axis.of(SCENE)), ("law.", of_law(axis, law))]
    return {f"{owner}{name}": values for owner, found in own for name, values in found.items()}


def levels_told(boundaries: Mapping[str, tuple[float, ...]]) -> dict[str, Any]:
    """The entry of a study file."""
    return {name: levels[0] if len(levels) == 1 else list(levels) for name, levels in boundaries.items()}


def _is_number(axis: Axis) -> bool:
    different = all(len(set(values)) == len(axis) for values in axis.values.values())
    numbers = all(isinstance(value, float | int) for values in axis.values.values() for value in values)
    return axis.is_of_speed or (numbers and different and len(axis) > 1)
