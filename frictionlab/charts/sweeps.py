"""Swept values of a result table: the inputs, the one along the axis, and how their values are written."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple, TypeVar

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from pandas.api.types import is_numeric_dtype

from frictionlab.values.columns import (
    SHOWN_IN_PART,
    belt_speed,
    given,
    leading,
    quantity,
    symbol,
    unit_shown,
    word,
)
from frictionlab.values.units import ShownUnit, handy_unit

T = TypeVar("T")
POINTS_OF_A_CURVE = 8  # belt speeds; with fewer no shape is read, and what takes more values says more
LONGEST_LABEL, BESIDE = 36, 22  # letters of a name alone, and beside another name or a count
PREFIXED, WITHOUT_PREFIX = ("N", "N/m", "N s/m", "m", "m/s", "J", "s"), (0.01, 1e4)
"""Units that get a prefix, and sizes of numbers that do without."""
EVEN, EVENER = 0.3, 3.0
"""Unevenness below which logarithms count as even: of 1, 2, 5, 10 it is 0.14, of chosen belt speeds 0.4 and more.
Values over many decades that crowd somewhere count, too, if they are so much more uneven than their logarithms."""


class SweptValue(NamedTuple):
    """A swept input, ``law`` for the laws themselves, and its value; None where a law has no such parameter."""

    name: str
    value: float | str | None

    @classmethod
    def of(cls, name: str, cell: Any) -> SweptValue:
        """Read the value of a cell of a table."""
        return cls(name, None if pd.isna(cell) else cell if isinstance(cell, str) else float(cell))

    @property
    def text(self) -> str:
        """Return the value alone, with its unit."""
        if self.value is None or isinstance(self.value, str):
            return shortened(self.value or "", LONGEST_LABEL)
        unit, least, most = unit_shown(self.name), *WITHOUT_PREFIX
        takes_one = unit in PREFIXED and not least <= abs(self.value) < most
        shown = handy_unit(unit, abs(self.value)) if takes_one else ShownUnit(unit)
        return f"{self.value / shown.size:.5g} {shown.unit}".rstrip()

    @property
    def brief(self) -> str:
        """Its symbol with the value, a word alone."""
        if self.value is None:
            return f"no {symbol(self.name)}"
        return self.text if isinstance(self.value, str) else f"{symbol(self.name)} = {self.text}"

    @property
    def sentence(self) -> str:
        """Return the title of a picture: what is the same along its curves."""
        if self.name == "law":
            return self.text
        return f"no {quantity(self.name)}" if self.value is None else f"{quantity(self.name)} = {self.text}"


def headings(pictures: Sequence[Sequence[SweptValue]]) -> list[str]:
    """Return what is the same in each picture: every name in words once, then as its symbol."""
    told: set[str] = set()
    found = []
    for values in pictures:
        found.append(", ".join(each.brief if each.name in told else each.sentence for each in values))
        told |= {each.name for each in values}
    return found


class Sweep(NamedTuple):
    """Swept inputs of a table, those of the fewest values first: all inputs, and those that are numbers.

    along: the number along the axis of figures, None where none is swept.
    """

    inputs: list[str]
    numbers: list[str]
    along: str | None


def sweep_of(table: pd.DataFrame) -> Sweep:
    """Along the axis: belt speed, or the number of most values where belt speed takes too few for a curve."""
    counts = {name: table[name].nunique() for name in swept_columns(table)}
    inputs = sorted(counts, key=counts.__getitem__)
    numbers = [name for name in inputs if is_numeric_dtype(table[name])]
    speed, along = belt_speed(table.columns), numbers[-1] if numbers else None
    if along and speed in numbers and counts[speed] >= min(POINTS_OF_A_CURVE, counts[along]):
        along = speed
    return Sweep(inputs, numbers, along)


def swept_columns(table: pd.DataFrame) -> list[str]:
    """Inputs of more than one value, as given; a law's parameter counts only where it varies within one law.

    Of those that change together, the first; belt speed comes first.
    """
    names = sorted(given(table.columns), key=lambda name: name != belt_speed(table.columns))
    scene = [name for name in names if name.startswith("scene.") and table[name].nunique() > 1]
    parameters = [name for name in names if name.startswith("law.") and is_numeric_dtype(table[name])]
    within = table.groupby("law")[parameters].nunique().max()
    swept = scene + [name for name in parameters if within[name] > 1]
    return swept if SHOWN_IN_PART in table.attrs else leading(swept, table)


def linked_words(
    table: pd.DataFrame, name: str, swept: Sequence[str], told: Callable[[str], str] = word
) -> str:
    """An input in words, with the symbols of those of the scene that change together with it."""
    others = [symbol(each) for each in linked_with(table, name, swept)]
    return f"{told(name)}, with {' and '.join(others)}" if others else told(name)


def linked_with(table: pd.DataFrame, name: str, swept: Sequence[str]) -> list[str]:
    """Inputs of the scene that count as no sweep of their own, for they follow from this one of the swept."""
    return [
        each
        for each in given(table.columns)
        if each.startswith("scene.") and each not in swept and table[each].nunique() > 1
        if table.groupby(name)[each].nunique().max() == 1
    ]


def plain(text: str) -> str:
    """Words of the study: a dollar sign in them is one, and begins no formula."""
    return text.replace("$", r"\$")


def shortened(label: str, room: int) -> str:
    """A label of the study, as many letters of it as there is room for."""
    return plain(label if len(label) <= room else f"{label[: room - 1]}…")


def some_of(values: Sequence[T], most: int) -> list[T]:
    """So many of the values at most, spread over all of them, the first and the last among them."""
    places = np.unique(np.linspace(0, len(values) - 1, min(len(values), most)).round().astype(int))
    return [values[place] for place in places]


def is_logarithmic(values: NDArray[np.float64]) -> bool:
    """Check whether the distinct values are spaced evenly in their logarithms rather than in themselves."""
    steps = np.unique(values[np.isfinite(values)])
    if len(steps) < 3 or steps[0] <= 0 or steps[-1] < 5 * steps[0]:
        return False
    uneven = _unevenness(steps)
    return _unevenness(np.log(steps)) < max(min(EVEN, uneven), uneven / EVENER)


def _unevenness(steps: NDArray[np.float64]) -> float:
    gaps = np.diff(steps)
    return float(gaps.std() / gaps.mean())
