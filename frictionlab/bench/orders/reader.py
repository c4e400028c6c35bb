"""The key ``orders`` of a bench list."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, TypeVar

from frictionlab.bench.orders.motions import MOTIONS
from frictionlab.bench.orders.section import OrdersSection
from frictionlab.bench.orders.solvers import ORDER_SOLVERS
from frictionlab.bench.sections import Section, SectionSource
from frictionlab.study.choices import items

ORDERS_KEYS = ("motions", "steppers", "samples")
GRIDS_OF_A_STEP = 40
Named = TypeVar("Named")


def read_orders(source: SectionSource) -> tuple[Section, ...]:
    """``true``, or which motions, which steppers, and how many samples of irregular errors."""
    tree = {} if source.value is True else source.notes.mapping(source.value, source.path, ORDERS_KEYS)
    if tree is None:
        return ()
    motions = chosen_by_name(source, tree, "motions", MOTIONS)
    solvers = chosen_by_name(source, tree, "steppers", ORDER_SOLVERS)
    samples = source.notes.whole_number(tree.get("samples", GRIDS_OF_A_STEP), (*source.path, "samples"), 1)
    if samples is None or source.notes.below(source.path):
        return ()
    return (OrdersSection(motions, solvers, samples),)


def chosen_by_name(
    source: SectionSource, tree: dict[str, Any], key: str, known: dict[str, Named]
) -> tuple[Named, ...]:
    """What a list of names under a key means; everything that is known where the key is left out."""
    path = (*source.path, key)
    named: Iterable[Any] = (
        items(tree[key], path, f"[{next(iter(known))}]", source.notes) if key in tree else known
    )
    read = [source.notes.one_of(name, (*path, i), known) for i, name in enumerate(named)]
    return tuple(known[name] for name in read if name is not None)
