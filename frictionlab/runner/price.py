"""Estimate the time that solving a study takes, and the time that a run has left.

Before a run some points, spread over its curves, are solved; no answer is kept. A run learns from chunks that came
back and from those under way, by law and method.
"""

from __future__ import annotations

import math
import os
import time
from collections import Counter, defaultdict
from collections.abc import Iterable, Sequence
from typing import Any, NamedTuple

from frictionlab.methods.under_way import UnderWay
from frictionlab.runner.engine import OverLimit, solve_timed, under_way, within
from frictionlab.runner.pieces import Chunk, Cut, Piece, Task, cuts, is_long
from frictionlab.runner.progress import Progress, silent
from frictionlab.study.grid import StudyCurve

MOST_POINTS, MOST_SECONDS = 5, 3.0
"""Points of a law and method that are solved one by one, and the time [s] that each of them may take."""
QUICK = 0.01
"""Time [s] of points that are solved once more as a whole chunk: neighbours share most of what one alone takes."""
COMPILING, TIMES_QUICKER = 15.0, 100.0
"""Time [s] to compile a kernel, and how many times quicker than Python it then is."""
BESIDES, A_CURVE, MOST_DRAWN = 4.0, 0.1, 100
"""Time [s] of imports, figures and the report of a run; of each curve in them; curves that are drawn at most."""


class Price(NamedTuple):
    """Price of the points of one law and method.

    seconds: on one core, without compiling. longest: those of the longest chunk.

    start: seconds until its machine code was read. measured: points that were solved to know it, in ``spent``
    seconds. to_compile: kernels that have to be compiled first; without a point measured nothing else is known.
    over: how many of the points that were tried took longer than ``MOST_SECONDS``, which is counted for them.
    """

    seconds: float
    longest: float
    start: float
    measured: int
    spent: float
    to_compile: frozenset[str] = frozenset()
    over: int = 0

    def record(self) -> dict[str, Any]:
        """Return plain values; ``seconds`` is None where kernels have to be compiled before it is known."""
        known = None if self.to_compile and not self.measured else self.seconds
        told = {"measured": self.measured, "over_3_s": self.over, "to_compile": sorted(self.to_compile)}
        return {"seconds": known, **told}


def solving_seconds(prices: Sequence[Price]) -> float:
    """Return the seconds of all together on the cores of this machine, compiling left out."""
    total, start = (sum(getattr(each, name) for each in prices) for name in ("seconds", "start"))
    return start + max(total / (os.cpu_count() or 1), *(each.longest for each in prices))


def prices(curves: Sequence[StudyCurve], task: Task, tell: Progress = silent) -> dict[tuple[str, str], Price]:
    """Price the points by the labels of law and method, in the order of the curves.

    Nothing is compiled. Raises BrokenPlugin.
    """
    kinds: dict[tuple[str, str], list[Cut]] = {}
    for each in cuts(curves, is_long(curves)):
        kinds.setdefault(each.curve.labels, []).append(each)
    samples = {kind: _Sample(of_it, task) for kind, of_it in kinds.items()}
    for done, sample in enumerate(samples.values()):
        tell(done, len(samples), math.nan, "")
        sample.solve()
    solved = [sample for sample in samples.values() if sample.measured]
    usual = sum(one.rate * one.points for one in solved) / max(1, sum(one.points for one in solved))
    return {kind: sample.price(usual) for kind, sample in samples.items()}


class _Sample:
    """Points of one law and method, and the time that solving some of them took."""

    def __init__(self, chunks: list[Cut], task: Task) -> None:
        self._chunks, self._task = chunks, task
        self.points = sum(len(each.rows) for each in chunks)
        self.rate = self.spent = self._start = 0.0
        self.measured = self._over = 0
        self._to_compile, self._by_python = frozenset[str](), False

    def solve(self) -> None:
        """Solve points that are spread evenly over all of them, and a chunk of points that are quick."""
        # brings numba: only where it is needed
        from frictionlab.compile.call import NotKept, seconds_by_python

        before, count, taken = seconds_by_python(), min(MOST_POINTS, self.points), list[float]()
        try:
            for k in range(count):
                taken.append(self._time(self._at((2 * k + 1) * self.points // (2 * count)), k == 0))
                self.measured, self.rate = len(taken), sum(taken) / len(taken)
            if self.points > count and max(taken) < QUICK:
                cut = max(self._chunks, key=lambda each: len(each.rows))
                self.measured, self.rate = len(cut.rows), self._time(cut.chunk(self._task)) / len(cut.rows)
        except NotKept as problem:
            self._to_compile = problem.kernels
        self._by_python = seconds_by_python() > before

    def _at(self, place: int) -> Chunk:
        """Return the point at a place on the line of all points."""
        for cut in self._chunks:
            if place < len(cut.rows):
                break
            place -= len(cut.rows)
        return cut.chunk(self._task).of(slice(place, place + 1))

    def _time(self, chunk: Chunk, first: bool = False) -> float:
        """Return the seconds that a chunk takes, ``MOST_SECONDS`` a point at most.

        first: true for the first chunk of a law and method.
        """
        begun = time.perf_counter()
        try:
            took = within(MOST_SECONDS * len(chunk), _time, chunk)
            if first:  # this call has read what others find read
                whole = time.perf_counter() - begun
                took = within(MOST_SECONDS, _time, chunk) if took < 0.1 * MOST_SECONDS else took
                self._start = max(0.0, whole - took)
        except OverLimit:
            took, self._over = MOST_SECONDS * len(chunk), self._over + 1
        self.spent += time.perf_counter() - begun
        return took

    def price(self, usual: float) -> Price:
        """Return the price of all points.

        usual: seconds per point of other laws and methods, taken if none of these was solved.
        """
        from frictionlab.compile.call import PYTHON_AT_MOST

        seconds = self.points * (self.rate if self.measured or self._to_compile else usual)
        if self._by_python:  # until that has taken too long
            compiled = PYTHON_AT_MOST + seconds / TIMES_QUICKER
            seconds = compiled if self._to_compile else min(seconds, compiled + COMPILING)
        longest = max(len(each.rows) for each in self._chunks) / self.points * seconds
        found = self.measured, self.spent, self._to_compile, self._over
        return Price(seconds, longest, self._start, *found)


def _time(chunk: Chunk) -> float:
    """Return the seconds that solving takes, without compiling and reading of machine code.

    Raises NotKept, BrokenPlugin.
    """
    from frictionlab.compile.call import compiling_nothing

    with compiling_nothing():
        return solve_timed(chunk)[1]


GOES_ON = 0.7
"""Time that a point goes on that has not been told of for long, over the time it has taken."""
PointKind = tuple[str, str]
"""Labels of a law and of a method."""


class Forecast:
    """Points left of each law and method, and the time that solved ones took."""

    def __init__(self, pieces: Iterable[Piece]) -> None:
        self._left = Counter[PointKind]()
        self._solved: defaultdict[PointKind, float] = defaultdict(float)
        self._seconds: defaultdict[PointKind, float] = defaultdict(float)
        for piece in pieces:
            self._left[piece.kind] += len(piece)
        self._sent: dict[int, tuple[Piece, Chunk]] = {}
        self._begun, self._back = time.monotonic(), 0.0

    def sent(self, piece: Piece, chunks: Sequence[Chunk]) -> None:
        """Note that a piece is sent out."""
        self._sent |= {id(chunk): (piece, chunk) for chunk in chunks}

    def found(self, piece: Piece) -> None:
        """Take off points that need not be solved."""
        self._left[piece.kind] -= len(piece)

    def came_back(self, piece: Piece, seconds: float) -> None:
        """Note that a piece was solved in so many seconds."""
        self._sent = {key: sent for key, sent in self._sent.items() if sent[0] is not piece}
        self._left[piece.kind] -= len(piece)
        self._back += seconds
        self._solved[piece.kind] += len(piece)
        self._seconds[piece.kind] += seconds

    def _running(self) -> list[tuple[PointKind, Chunk, UnderWay]]:
        """Return the chunks that threads of this process are solving."""
        found = [(*self._sent[key], now) for key, now in list(under_way.items()) if key in self._sent]
        return [(piece.kind, chunk, now) for piece, chunk, now in found]

    @property
    def points_under_way(self) -> int:
        """Count of points answered in chunks that have not come back."""
        return sum(int(now.points) for _, _, now in self._running())

    def at(self) -> str:
        """Tell of the chunk that has been silent for longest: its law and its belt speeds."""
        running = self._running()
        if not running:
            return ""
        (law, method), chunk, _ = min(running, key=lambda one: one[2].told_at)
        ends = dict.fromkeys(f"{speed:.4g}" for speed in chunk.scenes.given[[0, -1]])
        unit = "" if chunk.scenes.scene.dimensional is None else " m/s"
        by = "" if method == "auto" else f" by {method}"
        return f"{law}{by} at belt speed{'s' if len(ends) > 1 else ''} {' to '.join(ends)}{unit}"

    def seconds_left(self) -> float:
        """Return the seconds until all points are solved; NaN while nothing is known of a kind that is left."""
        running, waiting = self._running(), self._left.copy()
        solved, seconds = self._solved.copy(), self._seconds.copy()
        for kind, chunk, now in running:
            waiting[kind] -= len(chunk)
            solved[kind] += now.points
            seconds[kind] += now.seconds
        rate = {kind: seconds[kind] / count for kind, count in solved.items() if count}
        to_come = {kind for kind, count in waiting.items() if count > 0} | {kind for kind, _, _ in running}
        if not rate or to_come - rate.keys():
            return math.nan
        clock, rests = time.perf_counter(), [0.0]
        for kind, chunk, now in running:
            silent_for = clock - now.told_at
            rests.append(max((len(chunk) - now.points) * rate[kind] - silent_for, GOES_ON * silent_for))
        total = sum(rests) + sum(waiting[kind] * rate[kind] for kind in to_come if waiting[kind] > 0)
        passed = time.monotonic() - self._begun
        at_once = len(running) or max(1.0, self._back / passed if passed > 0.0 else 1.0)
        return max(total / at_once, *rests)
