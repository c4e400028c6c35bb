"""The answers of one chunk of scenes, as rows of the result table."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from frictionlab.methods.base import Answers, FoundState
from frictionlab.quantities import Floats

Places = NDArray[np.int64]
KeptRows = dict[int, dict[str, Floats]]
"""By row of the table, columns of equal length."""


STATE_NUMBERS = {
    **{"period": "period", "mean_friction": "mean", "error": "error", "share": "share"},
    **{"mean_low": "low", "mean_high": "high"},
}
"""The columns of numbers of a state, and the fields they are from."""


def columns_of_states(found: Sequence[FoundState]) -> dict[str, Floats]:
    """States of one row as columns of numbers."""
    return {
        name: np.array([getattr(one, field) for one in found], float) for name, field in STATE_NUMBERS.items()
    }


class Piece(NamedTuple):
    """Some points of a chunk, by their place in it, and their answers."""

    places: list[int]
    answers: Answers


@dataclass(frozen=True)
class Part:
    """Rows of the table, answered: plain data, which may cross to another process.

    kept: what stands beside the table, the ``states`` of points that have several, and what a study keeps, ``orbits``
    and ``harmonics``.
    """

    rows: Places
    text: dict[str, list[str]]
    numbers: dict[str, Floats]
    kept: dict[str, KeptRows]

    def moved(self, rows: Places) -> Part:
        """The same answers for other rows."""
        kept = {name: self._moved(found, rows) for name, found in self.kept.items()}
        return replace(self, rows=rows, kept=kept)

    def only(self, places: Places) -> Part:
        """The answers at these places."""
        text = {name: [words[place] for place in places.tolist()] for name, words in self.text.items()}
        numbers = {name: column[places] for name, column in self.numbers.items()}
        return Part(self.rows[places], text, numbers, self.kept)

    def _moved(self, found: KeptRows, rows: Places) -> KeptRows:
        pairs = zip(self.rows.tolist(), rows.tolist(), strict=True)
        return {new: found[old] for old, new in pairs if old in found}


def one_part(parts: Sequence[Part], rows: Places) -> Part:
    """The parts as one with these rows, which are theirs in another order; NaN where a part has no number."""
    if len(parts) == 1 and np.array_equal(parts[0].rows, rows):
        return parts[0]
    order = np.argsort(rows)
    names = {name: None for part in parts for name in part.numbers}
    numbers = {name: np.full(len(rows), np.nan) for name in names}
    text: dict[str, list[str]] = {name: [""] * len(rows) for part in parts for name in part.text}
    kept: dict[str, KeptRows] = {}
    for part in parts:
        places = order[np.searchsorted(rows, part.rows, sorter=order)]
        for name, column in part.numbers.items():
            numbers[name][places] = column
        for name, words in part.text.items():
            for place, word in zip(places.tolist(), words, strict=True):
                text[name][place] = word
        for name, found in part.kept.items():
            kept.setdefault(name, {}).update(found)
    return Part(rows, text, numbers, kept)
