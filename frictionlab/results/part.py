"""The answers of one chunk of scenes, as rows of the result table."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from frictionlab.methods.base import Answers
from frictionlab.quantities import Floats

if TYPE_CHECKING:
    from frictionlab.orbit.sample import Samples

Places = NDArray[np.int64]


class Piece(NamedTuple):
    """Some points of a chunk, by their place in it, and their answers."""

    places: list[int]
    answers: Answers


@dataclass(frozen=True)
class Part:
    """Rows of the table, answered: plain data, which may cross to another process. orbits: by row."""

    rows: Places
    text: dict[str, list[str]]
    numbers: dict[str, Floats]
    orbits: dict[int, Samples]

    def moved(self, rows: Places) -> Part:
        """The same answers for other rows."""
        orbits = {new: self.orbits[old] for old, new in self._in_pairs(rows) if old in self.orbits}
        return replace(self, rows=rows, orbits=orbits)

    def only(self, places: Places) -> Part:
        """The answers at these places."""
        text = {name: [words[place] for place in places.tolist()] for name, words in self.text.items()}
        numbers = {name: column[places] for name, column in self.numbers.items()}
        return Part(self.rows[places], text, numbers, self.orbits)

    def _in_pairs(self, rows: Places) -> zip[tuple[int, int]]:
        return (
            zip(self.rows.tolist(), rows.tolist(), strict=True) if self.orbits else zip((), (), strict=True)
        )


def one_part(parts: Sequence[Part], rows: Places) -> Part:
    """The parts as one with these rows, which are theirs in another order; NaN where a part has no number."""
    if len(parts) == 1 and np.array_equal(parts[0].rows, rows):
        return parts[0]
    order = np.argsort(rows)
    names = {name: None for part in parts for name in part.numbers}
    numbers = {name: np.full(len(rows), np.nan) for name in names}
    text: dict[str, list[str]] = {name: [""] * len(rows) for part in parts for name in part.text}
    orbits: dict[int, Samples] = {}
    for part in parts:
        places = order[np.searchsorted(rows, part.rows, sorter=order)]
        for name, column in part.numbers.items():
            numbers[name][places] = column
        for name, words in part.text.items():
            for place, word in zip(places.tolist(), words, strict=True):
                text[name][place] = word
        orbits |= part.orbits
    return Part(rows, text, numbers, orbits)
