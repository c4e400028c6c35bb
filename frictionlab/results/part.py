"""The answers of one chunk of scenes, as rows of the result table."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

from frictionlab.methods.base import Answers
from frictionlab.quantities import Floats

if TYPE_CHECKING:
    from frictionlab.orbit.sample import Samples


class Piece(NamedTuple):
    """Some points of a chunk, by their place in it, and their answers."""

    places: list[int]
    answers: Answers


@dataclass(frozen=True)
class Part:
    """Rows of the table, answered: plain data, which may cross to another process."""

    rows: list[int]
    text: dict[str, list[str]]
    numbers: dict[str, Floats]
    orbits: dict[int, Samples]
