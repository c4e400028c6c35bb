"""The time that a run has left: by kind of point, learnt from chunks that came back and from those under way."""

from __future__ import annotations

import math
import time
from collections import Counter, defaultdict
from collections.abc import Iterable, Sequence
from contextlib import suppress
from threading import Thread

from frictionlab.faults import BrokenPlugin
from frictionlab.runner.chunks import Task
from frictionlab.runner.limit import under_way
from frictionlab.runner.open_chunks import OpenChunk
from frictionlab.study import StudyCurve

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
        from frictionlab.runner.price import prices  # with numba

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
