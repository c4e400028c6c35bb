"""The chunks of a study and their answers: looked up where they are kept, else solved.

One of several shares of the chunks of a study, solved and kept: what a task of a job array does.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from concurrent.futures import BrokenExecutor, Executor
from itertools import chain, count
from typing import NamedTuple

import numpy as np

from frictionlab.runner.chunks import TOGETHER, Cut, Task, cuts, is_long, task_of
from frictionlab.runner.execute import Solved, grouped, solve_within
from frictionlab.runner.files import SaveError
from frictionlab.runner.kept_chunks import KeptChunks, Keys
from frictionlab.runner.open_chunks import OpenChunk, open_chunks
from frictionlab.runner.part import Part
from frictionlab.runner.price import Forecast
from frictionlab.runner.progress import Progress, silent
from frictionlab.runner.workforce import Workforce, workforce
from frictionlab.study.grid import StudyCurve
from frictionlab.study.study import Study
from frictionlab.values.notes import Mistake, StudyError


class Keeping(NamedTuple):
    """Where answers stay until they are gathered.

    kept: the folder of kept chunks, if there is one. keys: what chunks are looked up by; None where none is.
    in_memory: whether all answers are held, else those alone that cannot be kept. must_keep: whether it is an error
    where the disk does not take them.
    """

    kept: KeptChunks | None = None
    keys: Keys | None = None
    in_memory: bool = True
    must_keep: bool = False

    def keep(self, key: str | None, part: Part) -> bool:
        """Keep the answers to a chunk, if they have a key; whether they are kept. Raises SaveError."""
        if self.kept is None or key is None:
            return False
        try:
            return self.kept.keep(key, part)
        except SaveError:  # the run has the answers, and says so where it cannot save them either
            if self.must_keep:
                raise
            return False


IN_MEMORY = Keeping()


class Solving:
    """Curves cut into chunks, and what is known of each.

    known: rows that are answered already. points: how many there are to answer; computed, found: those that this run
    answered itself, and those of kept chunks. rest: why rows without an answer have none.
    """

    def __init__(
        self,
        curves: Sequence[StudyCurve],
        task: Task,
        keeping: Keeping = IN_MEMORY,
        known: Sequence[Part] = (),
    ) -> None:
        self.curves, self.task, self.known = curves, task, known
        self.points = sum(len(each.rows) for each in curves)
        self.computed = self.found = 0
        self.rest = "not finished"
        self._keeping = keeping
        self._answers: dict[int, str | list[Part]] = {}
        self._by_key: dict[str, Part] = {}
        self._sent: dict[str, OpenChunk] = {}
        self._forecast = Forecast(())

    @property
    def in_memory(self) -> bool:
        """Whether all answers are held."""
        return self._keeping.in_memory

    # --- solving ----------------------------------------------------------------------------------------------------

    def solve(self, force: Workforce, progress: Progress = silent, share: tuple[int, int] = (1, 1)) -> None:
        """Solve every N-th chunk from the I-th on, for share = (I, N), but for what is kept.

        Raises BrokenPlugin; BrokenExecutor, KeyboardInterrupt with what was solved by then taken.
        """
        number, shares = share
        own = [(curve.labels, len(curve.rows)) for curve in self.curves]
        if shares > 1:
            every = enumerate(cuts(self.curves, is_long(self.curves)))
            own = [(cut.curve.labels, len(cut.rows)) for at, cut in every if at % shares == number - 1]
            self.points = sum(points for _, points in own)
        known = sum(len(part.rows) for part in self.known)

        self._forecast = forecast = Forecast(own)

        def tick() -> None:
            done = known + self.found + self.computed + forecast.points_under_way
            progress(done, self.points, forecast.seconds_left())

        def to_solve() -> Iterator[OpenChunk]:
            for each in self._open_chunks():
                if each.number % shares == number - 1 and not self._is_known(each):
                    forecast.sent(each)
                    yield each

        try:
            force.solve(grouped(to_solve(), TOGETHER if is_long(self.curves) else 1), self._take, tick)
        finally:
            if self._keeping.kept is not None and not self._keeping.must_keep:
                self._keeping.kept.trim()

    def solve_or_say_why_not(self, force: Workforce, progress: Progress) -> bool:
        """Solve every chunk; True where that was interrupted."""
        try:
            self.solve(force, progress)
        except KeyboardInterrupt:
            self.rest = "interrupted"
        except BrokenExecutor as problem:
            self.rest = f"a worker died: {problem}"
        return self.rest == "interrupted"

    def _open_chunks(self) -> Iterator[OpenChunk]:
        finished = np.zeros(sum(len(each.rows) for each in self.curves), np.bool_)
        for part in self.known:
            finished[part.rows] = True
        return open_chunks(self.curves, self.task, finished if self.known else None, self._keeping.keys)

    def _is_known(self, work: OpenChunk) -> bool:
        """Whether a chunk needs no solving: it is kept, or the same as one that is being solved."""
        key, kept = work.key, self._keeping.kept
        if key is None:
            return False
        part = self._by_key.get(key)
        is_kept = part is None and kept is not None and (part := kept.found(key)) is not None
        if part is not None:
            self._enter(work, part, is_kept)
            self.found += len(work.left)
            self._forecast.found(work.kind, len(work.left))
        elif key in self._sent:
            self._sent[key].same.append(work)
            self._forecast.found(work.kind, len(work.left))
        else:
            self._sent |= {key: work} if work.is_whole else {}
            return False
        return True

    def _take(self, work: OpenChunk, solved: Solved) -> None:
        self.computed += len(work.left)
        self._forecast.came_back(work, solved.seconds)
        self._sent.pop(work.key or "", None)
        if work.is_whole:
            part = work.one_answer(solved.parts)
            is_kept = self._keeping.keep(work.key, part)
            for each in (work, *work.same):
                self._enter(each, part, is_kept)
            self.found += sum(len(each.left) for each in work.same)
        else:
            self._answers[work.number] = solved.parts

    def _enter(self, work: OpenChunk, part: Part, is_kept: bool) -> None:
        if is_kept and work.key is not None and not self.in_memory:
            self._answers[work.number] = work.key
            return
        self._answers[work.number] = [work.of(part)]
        if work.key is not None:
            self._by_key[work.key] = part

    # --- answers ----------------------------------------------------------------------------------------------------

    def parts(self) -> list[Part]:
        """All answers that are there."""
        return [*self.known, *chain.from_iterable(self.answers())]

    def answers(self) -> Iterator[list[Part]]:
        """Of one curve after another, the answers that are there."""
        numbers, long = count(), is_long(self.curves)
        for curve in self.curves:
            yield [part for cut in cuts([curve], long) for part in self._answer(next(numbers), cut)]

    def _answer(self, number: int, cut: Cut) -> list[Part]:
        """What was found of a chunk; one that is no longer kept is solved now."""
        found = self._answers.get(number, [])
        if not isinstance(found, str):
            return found
        part = None if self._keeping.kept is None else self._keeping.kept.found(found)
        return [part.moved(cut.rows)] if part is not None else solve_within(cut.chunk(self.task)).parts


def run_share(
    study: Study,
    part: tuple[int, int],
    kept: KeptChunks,
    executor: Executor | Workforce | None = None,
    progress: Progress = silent,
) -> Solving:
    """Solve and keep every N-th chunk of a study, from the I-th on, for part = (I, N).

    Which chunks those are hangs on the study alone. Points that fail by a defect are not kept: the run that gathers
    all parts tries them again. Raises BrokenPlugin, SaveError, BrokenExecutor, KeyboardInterrupt; what was solved by
    then is kept. Raises StudyError where belt speeds are chosen as a run goes.
    """
    if study.chosen_range is not None:
        within = f"belt speeds within {study.chosen_range.within:g} are chosen as a run goes"
        what = f"{within}, and a part of it cannot know them: run it whole, or give num"
        raise StudyError([Mistake("--part", None, "", what)])
    solving = Solving(list(study.curves()), task_of(study), Keeping(kept, Keys(study.code), must_keep=True))
    with workforce(executor) as force:
        solving.solve(force, progress, part)
    return solving
