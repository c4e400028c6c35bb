"""Laws, and methods, compared in pairs: where their means differ most, and by how much."""

from __future__ import annotations

from collections.abc import Sequence

import pandas as pd

from frictionlab.printable import with_error
from frictionlab.report.tables import Cell, Grid, grid, settings
from frictionlab.results.pairs import Difference, law_pairs, method_pairs


def laws_compared(table: pd.DataFrame) -> Grid:
    """Every two laws."""
    caption = "Laws in pairs: the largest difference of their mean friction at the same point"
    return _pairs(caption, law_pairs(table))


def methods_compared(table: pd.DataFrame) -> Grid:
    """Every two methods, law by law."""
    caption = "Methods in pairs: the largest difference of their mean friction at the same point"
    return _pairs(caption, method_pairs(table))


def _pairs(caption: str, pairs: Sequence[Difference]) -> Grid:
    head = ["law", "pair", "largest difference", "at", "points that differ by more than their errors"]
    return grid(caption, head, [_row(each) for each in pairs], "pairs")


def _row(pair: Difference) -> list[Cell]:
    names = f"{pair.one} less {pair.other}"
    counts = f"{pair.apart} of {pair.shared}"
    if pair.apart == 0:
        return [pair.law, names, _the_same(pair), settings(pair.where), counts]
    return [pair.law, names, with_error(pair.value, pair.error), settings(pair.where), counts]


def _the_same(pair: Difference) -> str:
    """Within the errors, which may be wide: what is found is told, too."""
    return f"the same within errors: {with_error(pair.value, pair.error)}"
