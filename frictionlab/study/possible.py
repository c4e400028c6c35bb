"""Whether every point of the grid of a study can be built, and is one of few enough."""

from __future__ import annotations

import math
from collections.abc import Callable, Container, Mapping
from dataclasses import replace
from typing import Any

from frictionlab.mistakes.notes import Notes, Path, StudyError, number_text
from frictionlab.study.axes import LINKED, SCENE, owner_of
from frictionlab.study.grid import StudyGrid, grid_size
from frictionlab.study.ranges import FINEST, MOST_CHOSEN, WITHIN, SpeedRange

LARGEST_GRID = 100_000_000
LARGEST_CHECK = 20_000
"""Points that are built to check a grid; of a larger one the ends and evenly spaced values of each sweep."""
LARGEST_KEPT = {
    "orbit": (50_000_000, "{count} samples of {size} points are more than {most}"),
    "harmonics": (10_000_000, "{count} harmonics of {size} points are more than {most}"),
    "attractors": (100_000, "{count} starts at {size} points are more than {most}"),
}
"""What is kept of each point: how much in all, and the sentence where it is more."""


def note_impossible_points(grid: StudyGrid, told: Mapping[str, Any], notes: Notes) -> None:
    """Build the whole grid and note points that cannot be built, or a grid that is too large.

    told: what else the study says.
    """
    if (size := grid_size(grid)) > LARGEST_GRID:
        notes.add(("sweep",), f"the grid has {size} points, more than {LARGEST_GRID}")
    elif grid.chosen_range is not None:
        _build(lambda: grid.scenes_along, (SCENE,), grid, notes)
        if not notes.all:
            _note_choice(grid, grid.chosen_range, told["tolerance"], notes)
    if not notes.all:
        _note_too_much_kept(grid_size(grid.foreseen()), told, notes)
    if not notes.all:
        _build_all(_thinned(grid), notes)


def _note_choice(grid: StudyGrid, along: SpeedRange, tolerance: float, notes: Notes) -> None:
    path: Path = ("sweep", next(path for path, each in grid.ranges.items() if each is along), WITHIN)
    about, least = grid_size(grid.foreseen()), FINEST * tolerance
    if along.within < least:
        said = f"must be >= {number_text(float(f'{least:.6g}'))}, {FINEST:g} times tolerance"
        notes.add(path, f"{said}, got {number_text(along.within)}")
    elif about > MOST_CHOSEN:
        what = f"belt speeds are chosen for {MOST_CHOSEN} at most: give num"
        notes.add(path, f"the grid has about {about} points; {what}")


def _note_too_much_kept(size: int, told: Mapping[str, Any], notes: Notes) -> None:
    for key, (most, said) in LARGEST_KEPT.items():
        if (count := told.get(f"keep_{key}") or 0) * size > most:
            notes.add(("keep", key), said.format(count=count, size=size, most=most))


def _build_all(grid: StudyGrid, notes: Notes) -> None:
    _build(lambda: grid.scenes_along, (SCENE,), grid, notes)
    for index, choice in enumerate(grid.laws if not notes.all else ()):
        own = f"laws.{choice.label}.", ""
        laws = _build(lambda law=choice: grid.laws_in_scenes(law), own, grid, notes)  # type: ignore[misc]  # of a lambda
        if laws is not None and not all(map(_has_a_stiffness, laws)):
            notes.on_key(("laws", index), "these values give no finite stiffness > 0: check their units")


def _has_a_stiffness(law: Any) -> bool:
    """Whether a compliant law keeps a presliding length and a stiffness > 0, neither infinite."""
    if not law.compliant:
        return True
    return 0.0 < law.bristle_stiffness < math.inf and 0.0 < law.presliding() < math.inf


def _thinned(grid: StudyGrid) -> StudyGrid:
    """The grid with few enough values of each sweep, its ends among them, to build every point."""
    while grid_size(grid) > LARGEST_CHECK:
        longest = max(grid.axes, key=len)
        if len(longest) == 2:
            break
        grid = replace(grid, sweep=grid.sweep | longest.thinned().values)
    return grid


def _build(build: Callable[[], Any], owners: Container[str], grid: StudyGrid, notes: Notes) -> Any:
    """What is built; None, noted, of values that are right one by one but invalid together.

    owners: of the sweeps they are of.
    """
    try:
        return build()
    except StudyError as problem:
        own = [path for path in grid.sweep if owner_of(path) in owners]
        path: Path = _place(own[-1], grid) if own else ("laws",)
        notes.on_key(path, problem.mistakes[0].what)
        return None


def _place(swept: str, grid: StudyGrid) -> Path:
    """Where in a study a sweep is."""
    entry = next((index for index, paths in enumerate(grid.links) if swept in paths), None)
    return ("sweep", swept) if entry is None else ("sweep", LINKED, entry, swept)
