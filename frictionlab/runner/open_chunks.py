"""Chunks of a study that a run has to solve, each with the hash of what it computes."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from frictionlab.runner.chunks import Chunk, Task, cuts, is_long
from frictionlab.runner.kept_chunks import Keys
from frictionlab.runner.part import Part, Places, one_part
from frictionlab.study.grid import StudyCurve


@dataclass(eq=False)
class OpenChunk:
    """Chunk to solve, and the rows of its answers.

    number: its place among all chunks. kind: the labels of its law and its method. whole: the rows of all its points;
    of these ``left`` are the places without an answer. key: the hash of what the whole computes, None where that
    cannot be known. same: others of the same key.
    """

    chunk: Chunk
    number: int
    kind: tuple[str, str]
    whole: Places
    left: Places
    key: str | None = None
    same: list[OpenChunk] = field(default_factory=list)

    @property
    def is_whole(self) -> bool:
        """True if every point of the chunk is to be solved."""
        return len(self.left) == len(self.whole)

    def of(self, part: Part) -> Part:
        """Return the rows that the answers of a whole chunk, by their places in it, answer."""
        answered = part.moved(self.whole)
        return answered if self.is_whole else answered.only(self.left)

    def one_answer(self, parts: list[Part]) -> Part:
        """Return the answers of a chunk that was solved as a whole, by their places in it."""
        return one_part(parts, self.whole).moved(np.arange(len(self.whole)))


def open_chunks(
    curves: Sequence[StudyCurve],
    task: Task,
    finished: NDArray[np.bool_] | None = None,
    keys: Keys | None = None,
) -> Iterator[OpenChunk]:
    """Yield the chunks still to solve; finished: true for each row that has an answer.

    Curves are cut before finished rows are left out: a run stopped and continued then solves the very chunks
    of one that went through.
    """
    for number, cut in enumerate(cuts(curves, is_long(curves))):
        places = np.arange(len(cut.rows))
        left = places if finished is None else np.flatnonzero(~finished[cut.rows])
        if len(left):
            chunk = cut.chunk(task)
            key = None if keys is None else keys.of(chunk, cut.curve.kind, cut.curve.method.name)
            yield OpenChunk(
                chunk if len(left) == len(places) else chunk.of(left),
                number,
                cut.curve.labels,
                cut.rows,
                left,
                key,
            )
