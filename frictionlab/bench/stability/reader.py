"""The key ``stability`` of a bench list."""

from __future__ import annotations

from typing import Any

from frictionlab.bench.orders.reader import chosen_by_name
from frictionlab.bench.sections import Section, SectionSource
from frictionlab.bench.stability.peers import MAPPED_PEERS
from frictionlab.bench.stability.problems import PROBLEMS
from frictionlab.bench.stability.section import MappedSolver, StabilitySection
from frictionlab.bench.stability.steppers import MAPPED_STEPPERS

STABILITY_KEYS = ("steppers", "peers", "problems", "grid")
GRID = 70
"""Settings, and rates: about 5,000 points a stepper and problem."""


def read_stability(source: SectionSource) -> tuple[Section, ...]:
    """``true``, or which steppers and peers, on which problems, on a grid of how many by how many."""
    tree = {} if source.value is True else source.notes.mapping(source.value, source.path, STABILITY_KEYS)
    if tree is None:
        return ()
    # naming steppers alone asks for no peers, and the other way round
    ours = chosen_by_name(source, tree, "steppers", MAPPED_STEPPERS) if _asked(tree, "steppers") else ()
    theirs = chosen_by_name(source, tree, "peers", MAPPED_PEERS) if _asked(tree, "peers") else ()
    problems = chosen_by_name(source, tree, "problems", PROBLEMS)
    grid = source.notes.whole_number(tree.get("grid", GRID), (*source.path, "grid"), 2)
    if grid is None or source.notes.below(source.path):
        return ()
    mapped: tuple[MappedSolver, ...] = (*ours, *theirs)
    return tuple(StabilitySection(each, problems, grid) for each in mapped)


def _asked(tree: dict[str, Any], key: str) -> bool:
    return key in tree or not {"steppers", "peers"} & tree.keys()
