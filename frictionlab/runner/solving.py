"""Pieces of a study and their answers: found in the store, else solved and put there; read from it alone."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Iterator, Sequence
from concurrent.futures import BrokenExecutor, Executor

import numpy as np
import pyarrow as pa

from frictionlab.runner.arguments import check_limit
from frictionlab.runner.engine import Solved, solve_each
from frictionlab.runner.packing import IN_LISTS, rows_joined
from frictionlab.runner.pieces import Chunk, Piece, TableBlock, Task, blocks_of_table, task_of
from frictionlab.runner.price import Forecast
from frictionlab.runner.progress import Progress, silent
from frictionlab.runner.store import Keys, Store
from frictionlab.runner.workforce import Workforce, workforce
from frictionlab.study.grid import StudyCurve
from frictionlab.study.study import Study
from frictionlab.values.columns import ALWAYS
from frictionlab.values.notes import Mistake, StudyError


class Solving:
    """Curves cut into pieces, and where their answers are.

    blocks: pieces with the rows of these curves, where they were cut before. computed,
    found: points that were solved, and those whose answers were there. rest: why rows without an answer have none;
    '' where none is missing.
    """

    def __init__(
        self,
        curves: Sequence[StudyCurve],
        task: Task,
        store: Store | None = None,
        keys: Keys | None = None,
        blocks: Sequence[TableBlock] | None = None,
    ) -> None:
        self.curves, self.task, self.store = curves, task, store or Store()
        self.blocks = blocks_of_table(curves, task) if blocks is None else blocks
        self.computed = self.found = 0
        self.rest = ""
        self.keys = keys or Keys({})

    @property
    def points(self) -> int:
        """Count of all rows."""
        return sum(len(each.rows) for each in self.curves)

    # --- solving ----------------------------------------------------------------------------------------------------

    def solve(self, force: Workforce, progress: Progress = silent, share: tuple[int, int] = (1, 1)) -> int:
        """Solve every N-th piece from the I-th on, for share = (I, N); return how many points these have.

        Raises BrokenPlugin, SaveError; BrokenExecutor, KeyboardInterrupt with what was solved by then in the store.
        """
        number, shares = share
        own = [piece for block in self.blocks for piece in block.pieces][number - 1 :: shares]
        forecast, points = Forecast(own), sum(map(len, own))

        def take(piece: Piece, solved: Solved) -> None:
            self.store.put(self._key_of(piece), solved.answers)
            self.computed += len(piece)
            forecast.came_back(piece, solved.seconds)

        def tick() -> None:
            done = self.found + self.computed + forecast.points_under_way
            progress(done, points, forecast.seconds_left(), forecast.at())

        try:
            force.solve(self._to_solve(own, forecast), take, tick)
        finally:
            self.store.trim()
        return points

    def _to_solve(self, own: Iterable[Piece], forecast: Forecast) -> Iterator[tuple[Piece, list[Chunk]]]:
        """Yield the pieces without an answer, of equal ones the first, with what methods are given."""
        sent = set[str]()
        for piece in own:
            key = self._key_of(piece)
            if key in sent or self.store.columns(key):
                self.found += len(piece)
                forecast.found(piece)
            else:
                sent.add(key)
                chunks = piece.chunks()
                forecast.sent(piece, chunks)
                yield piece, chunks

    def solve_or_say_why_not(self, force: Workforce, progress: Progress) -> bool:
        """Solve every piece; return True where that was interrupted."""
        try:
            self.solve(force, progress)
        except KeyboardInterrupt:
            self.rest = "interrupted"
        except BrokenExecutor as problem:
            self.rest = f"a worker died: {problem}"
        return self.rest == "interrupted"

    def _key_of(self, piece: Piece) -> str:
        piece.key = piece.key or self.keys.of(piece)
        return piece.key

    def key(self, what: str, *how: object) -> str:
        """Return the key of a table that is made from all answers, and nothing else."""
        keys = [self._key_of(piece) for block in self.blocks for piece in block.pieces]
        mark = "?" if any(key.startswith("?") for key in keys) else ""
        return mark + hashlib.sha256(repr((what, how, keys)).encode()).hexdigest()

    # --- answers ----------------------------------------------------------------------------------------------------

    def columns(self) -> list[str]:
        """Return the names of the columns that some row has."""
        keys = dict.fromkeys(self._key_of(piece) for block in self.blocks for piece in block.pieces)
        return list(dict.fromkeys([*ALWAYS, *(name for key in keys for name in self.store.columns(key))]))

    def columns_of(self, kind: str) -> list[str]:
        """Return the columns of what is kept beside rows, such as ``orbits``, those of every law."""
        start = f"{kind}{IN_LISTS}"
        return [name.removeprefix(start) for name in self.columns() if name.startswith(start)]

    def answers(self, block: TableBlock | None = None) -> pa.Table:
        """Return the answers of a block, or of all, in the order of the rows; those that are missing are ``killed``.

        A piece that is damaged, or that somebody has removed from the store since, is solved now.
        """
        pieces = block.pieces if block else [piece for each in self.blocks for piece in each.pieces]
        found = rows_joined([self._answer(piece) for piece in pieces])
        order = np.argsort(np.concatenate([piece.rows for piece in pieces]))
        return found.unify_dictionaries().combine_chunks().take(pa.array(order))

    def _answer(self, piece: Piece) -> pa.Table:
        key = self._key_of(piece)
        found = self.store.get(key)
        if found is None and self.rest:
            return unanswered(len(piece), self.rest)
        if found is None:  # its file is damaged, or gone
            found = solve_each(piece.chunks()).answers
            self.store.put(key, found)
        return found


def unanswered(size: int, reason: str) -> pa.Table:
    """Return the answers of so many points that were not solved."""
    columns = {name: [word] * size for name, word in (("status", "killed"), ("reason", reason))}
    return pa.table({name: pa.array(words).dictionary_encode() for name, words in columns.items()})


def run_share(
    study: Study,
    part: tuple[int, int],
    store: Store,
    executor: Executor | Workforce | None = None,
    progress: Progress = silent,
) -> tuple[Solving, int]:
    """Solve and keep every N-th piece of a study, from the I-th on, for part = (I, N); return their points, too.

    Which pieces those are hangs on the study alone. Points that fail by a defect are not kept: the run that gathers
    all parts tries them again. Raises BrokenPlugin, SaveError, BrokenExecutor, KeyboardInterrupt; what was solved by
    then is kept. Raises StudyError where belt speeds are chosen as a run goes, or threads cannot keep its limit.
    """
    check_limit(study, executor)
    if study.chosen_range is not None:
        within = f"belt speeds within {study.chosen_range.within:g} are chosen as a run goes"
        what = f"{within}, and a part of it cannot know them: run it whole, or give num"
        raise StudyError([Mistake("--part", None, "", what)])
    with workforce(executor) as force:
        task = task_of(study, limited=force.elsewhere)
        solving = Solving(list(study.curves()), task, store, Keys(study.code))
        return solving, solving.solve(force, progress, part)
