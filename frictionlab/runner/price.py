"""What solving a study will take: some points, spread over its curves, are solved to know; no answer is kept.

The time that a run has left: by kind of point, learnt from chunks that came back and from those under way.
"""

from __future__ import annotations

import math
import os
import time
from collections import Counter, defaultdict
from collections.abc import Iterable, Sequence
from contextlib import suppress
from threading import Thread
from typing import Any, NamedTuple

import numpy as np

from frictionlab.laws.faults import BrokenPlugin
from frictionlab.runner.chunks import Chunk, Cut, Task, cuts, is_long
from frictionlab.runner.execute import OverLimit, solve_timed, under_way, within
from frictionlab.runner.open_chunks import OpenChunk
from frictionlab.runner.progress import Progress, silent
from frictionlab.study.grid import StudyCurve

FEWEST, USUAL, MOST = 0.3, 1.0, 5.0
"""Seconds spent on points: in any case, if the price is then still ``UNSURE``, and if it is large beside them."""
SHARE, UNSURE = 0.1, 0.25
"""Of the price: what is spent to know it, and its standard error where it is known well enough."""
FEWEST_POINTS = 3
"""Of all kinds together, unless they take too long."""
SINGLE, QUICK, GROWTH = 4, 0.01, 4
"""Points solved one by one; the time [s] of quick ones, after which neighbours are solved together, more and more."""
COMPILING, TIMES_QUICKER = 15.0, 100.0
"""Time [s] to compile a kernel, and how many times quicker than Python it then is."""
BESIDES, A_CURVE, MOST_DRAWN = 4.0, 0.1, 100
"""Time [s] of imports, figures and the report of a run; of each curve in them; curves that are drawn at most."""
NEXT_PLACE = 0.6180339887498949
"""Step from place to place along a line of length one on which any number of places are spread evenly."""


class Price(NamedTuple):
    """Of the points of one law and method: seconds on one core, compiling left out, and those of its longest chunk.

    start: seconds until its machine code was read. measured: points that were solved to know it, in ``spent``
    seconds. to_compile: kernels that have to be compiled first; without a point measured nothing else is known.
    at_least: whether a point was left unfinished.
    """

    seconds: float
    longest: float
    start: float
    measured: int
    spent: float
    to_compile: frozenset[str] = frozenset()
    at_least: bool = False

    def record(self) -> dict[str, Any]:
        """As a record of plain values: ``seconds`` is None where kernels have to be compiled before it is known."""
        known = None if self.to_compile and not self.measured else self.seconds
        return {"seconds": known, "measured": self.measured, "to_compile": sorted(self.to_compile)}


def solving_seconds(prices: Sequence[Price]) -> float:
    """Of all together on the cores of this machine, compiling left out."""
    total, start = (sum(getattr(each, name) for each in prices) for name in ("seconds", "start"))
    return start + max(total / (os.cpu_count() or 1), *(each.longest for each in prices))


def prices(
    curves: Sequence[StudyCurve], task: Task, tell: Progress = silent, most: float = MOST
) -> dict[tuple[str, str], Price]:
    """By the labels of law and method, in the order of the curves; nothing is compiled. most: seconds spent on it.

    The next points are solved where they tell most about the sum. Raises BrokenPlugin.
    """
    kinds: dict[tuple[str, str], list[Cut]] = {}
    for each in cuts(curves, is_long(curves)):
        kinds.setdefault(each.curve.labels, []).append(each)
    found = {kind: _Sample(of_it, task) for kind, of_it in kinds.items()}
    samples = list(found.values())
    points = sum(each.points for each in samples)
    while True:
        spent, known = sum(each.spent for each in samples), sum(each.seconds for each in samples)
        best, error = max(samples, key=_unsure), math.hypot(*map(_unsure, samples))
        enough = FEWEST if error < UNSURE * known else min(max(USUAL, SHARE * known), most)
        few = error == math.inf or sum(each.measured for each in samples) < FEWEST_POINTS
        left = (most if few else enough) - spent
        if best.unsure == 0.0 or left < 0.0:
            break
        best.solve_more(most)
        tell(sum(each.measured for each in samples), points, left)
    solved = [each for each in samples if each.measured]
    usual = sum(each.seconds for each in solved) / max(1, sum(each.points for each in solved))
    return {kind: each.price(usual) for kind, each in found.items()}


class _Sample:
    """The points of one law and method, and what solving some of them took; ``over``: nothing more can be learnt."""

    def __init__(self, chunks: list[Cut], task: Task) -> None:
        self._chunks, self._task = chunks, task
        self._ends = np.cumsum([len(each.rows) for each in chunks])
        self.points = int(self._ends[-1])
        self._pieces: list[tuple[int, float]] = []
        self._at, self._size, self._start = 0.5, 1, 0.0
        self._to_compile, self._by_python, self._at_least, self._over = frozenset[str](), False, False, False

    @property
    def measured(self) -> int:
        """Points, some of them more than once."""
        return sum(points for points, _ in self._pieces)

    @property
    def spent(self) -> float:
        """Seconds that these took."""
        return sum(seconds for _, seconds in self._pieces)

    @property
    def seconds(self) -> float:
        """Of all points, as far as is known."""
        return self.points * self.spent / self.measured if self._pieces else 0.0

    @property
    def unsure(self) -> float:
        """Standard error of ``seconds``: zero where nothing more can be learnt, infinite at first."""
        if self._over or self.measured >= self.points:
            return 0.0
        if not self._pieces:
            return math.inf
        rates = [seconds / points for points, seconds in self._pieces]
        spread = float(np.std(rates, ddof=1)) if len(rates) >= SINGLE else max(rates)
        return self.points * spread / math.sqrt(len(rates))

    def solve_more(self, seconds: float) -> None:
        """Solve the next piece, for so long at most."""
        # brings numba: only where it is needed
        from frictionlab.compile.call import NotKept, seconds_by_python

        chunk, before, start = self._next_piece(), seconds_by_python(), time.perf_counter()
        try:
            took = within(seconds, _time, chunk)
            if not self._pieces:  # this call has read what others find read
                whole = time.perf_counter() - start
                took = within(seconds, _time, chunk) if took < USUAL / SINGLE else took
                self._start = max(0.0, whole - took)
        except OverLimit:
            took, self._at_least, self._over = seconds, True, True
        except NotKept as problem:
            self._to_compile, self._over = problem.kernels, True
            return
        self._by_python = self._by_python or seconds_by_python() > before
        self._pieces.append((len(chunk.rows), took))
        if len(self._pieces) >= SINGLE and max(spent for _, spent in self._pieces) < QUICK:
            self._size *= GROWTH

    def _next_piece(self) -> Chunk:
        """Neighbours about the next place on the line of all points."""
        at, self._at = int(self._at * self.points), (self._at + NEXT_PLACE) % 1.0
        which = int(np.searchsorted(self._ends, at, side="right"))
        cut = self._chunks[which]
        size = min(self._size, len(cut.rows))
        place = at - int(self._ends[which]) + len(cut.rows)
        first = min(max(0, place - size // 2), len(cut.rows) - size)
        return cut.chunk(self._task).of(slice(first, first + size))

    def price(self, usual: float) -> Price:
        """What all points take; usual: seconds a point of other laws and methods, where none of these was solved."""
        from frictionlab.compile.call import PYTHON_AT_MOST

        known = self._pieces or self._to_compile
        seconds = self.seconds if known else usual * self.points
        if self._by_python:  # until that has taken too long
            compiled = PYTHON_AT_MOST + seconds / TIMES_QUICKER
            seconds = compiled if self._to_compile else min(seconds, compiled + COMPILING)
        longest = max(len(each.rows) for each in self._chunks) / self.points * seconds
        return Price(
            seconds, longest, self._start, self.measured, self.spent, self._to_compile, self._at_least
        )


def _unsure(sample: _Sample) -> float:
    return sample.unsure


def _time(chunk: Chunk) -> float:
    """Seconds that solving takes, compiling and reading of machine code left out. Raises NotKept, BrokenPlugin."""
    from frictionlab.compile.call import compiling_nothing

    with compiling_nothing():
        return solve_timed(chunk).seconds


LEARNS_AFTER, MOST_LEARNING = 2.0, 4.0
"""Seconds after which points are solved to learn what kinds take whose turn comes late, and how long for."""
GOES_ON = 0.7
"""What has not told of a point for long goes on for about so many times as long."""
PointKind = tuple[str, str]
"""The labels of a law and of a method."""


class Forecast:
    """Points left of each kind, and what points of it took. is_over: whether nobody waits any longer."""

    def __init__(self, points: Iterable[tuple[PointKind, int]]) -> None:
        self._left = Counter[PointKind]()
        self._solved: defaultdict[PointKind, float] = defaultdict(float)
        self._seconds: defaultdict[PointKind, float] = defaultdict(float)
        for kind, count in points:
            self._left[kind] += count
        self._sent: dict[int, OpenChunk] = {}
        self._begun, self._back, self._learns = time.monotonic(), 0.0, False
        self.is_over = False

    def sent(self, work: OpenChunk) -> None:
        """A chunk is sent out."""
        self._sent[id(work.chunk)] = work

    def found(self, kind: PointKind, points: int) -> None:
        """Points need not be solved."""
        self._left[kind] -= points

    def came_back(self, work: OpenChunk, seconds: float) -> None:
        """A chunk was solved in so many seconds."""
        self._sent.pop(id(work.chunk), None)
        self._left[work.kind] -= len(work.left)
        self._back += seconds
        self.learn(work.kind, len(work.left), seconds)

    def learn(self, kind: PointKind, points: int, seconds: float) -> None:
        """So many points of a kind took so long."""
        self._solved[kind] += points
        self._seconds[kind] += seconds

    @property
    def points_under_way(self) -> int:
        """Points answered in chunks that have not come back."""
        return sum(int(now.points) for key, now in list(under_way.items()) if key in self._sent)

    def seconds_left(self) -> float:
        """Until all points are solved; NaN as long as of a kind that is left nothing is known."""
        running = [(self._sent[key], now) for key, now in list(under_way.items()) if key in self._sent]
        waiting, solved, seconds = self._left.copy(), self._solved.copy(), self._seconds.copy()
        for work, now in running:
            waiting[work.kind] -= len(work.left)
            solved[work.kind] += now.points
            seconds[work.kind] += now.seconds
        rate = {kind: seconds[kind] / count for kind, count in solved.items() if count}
        to_come = {kind for kind, count in waiting.items() if count > 0} | {work.kind for work, _ in running}
        if not rate or to_come - rate.keys():
            return math.nan
        clock, rests = time.perf_counter(), [0.0]
        for work, now in running:
            silent_for = clock - now.told_at
            known = (len(work.left) - now.points) * rate[work.kind] - silent_for
            rests.append(max(known, GOES_ON * silent_for))
        total = sum(rests) + sum(waiting[kind] * rate[kind] for kind in to_come if waiting[kind] > 0)
        passed = time.monotonic() - self._begun
        at_once = len(running) or max(1.0, self._back / passed if passed > 0.0 else 1.0)
        return max(total / at_once, *rests)

    def learn_from_samples(self, curves: Sequence[StudyCurve], task: Task) -> None:
        """Once it is time, solve points of the kinds of which nothing is known yet, on a thread of its own."""
        if self._learns or time.monotonic() - self._begun < LEARNS_AFTER:
            return
        self._learns = True
        pass  # with numba

        def learn() -> None:
            with suppress(BrokenPlugin):  # the run itself tells of it
                while (unknown := self._unknown()) and not self.is_over:
                    chosen = [each for each in curves if each.labels in unknown]
                    for kind, price in prices(chosen, task, most=MOST_LEARNING).items():
                        self.learn(kind, price.measured, price.spent)
                    time.sleep(LEARNS_AFTER)  # kernels may have been compiled by then

        if self._unknown():
            Thread(target=learn, daemon=True).start()

    def _unknown(self) -> set[PointKind]:
        """Kinds of which no point is solved, nor told of by a chunk under way."""
        told = {
            self._sent[key].kind for key, now in list(under_way.items()) if key in self._sent and now.points
        }
        return {kind for kind, count in self._left.items() if count > 0 and not self._solved[kind]} - told
