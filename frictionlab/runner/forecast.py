"""The time that a run has left: by kind of point, learnt from chunks that came back and from those under way."""

from __future__ import annotations

import math
import time
from collections import Counter, defaultdict
from collections.abc import Iterable, Sequence
from threading import Thread

from frictionlab.runner.chunks import Task
from frictionlab.runner.limit import under_way
from frictionlab.runner.open_chunks import OpenChunk
from frictionlab.study import StudyCurve

LEARNS_AFTER = 2.0
"""Seconds after which points are solved to learn what they take, where a kind of them has not come back yet."""
PointKind = tuple[str, str]
"""The labels of a law and of a method."""


class Forecast:
    """Points left of each kind, and what points of it took."""

    def __init__(self, points: Iterable[tuple[PointKind, int]]) -> None:
        self._left, self._solved = Counter[PointKind](), Counter[PointKind]()
        self._seconds: defaultdict[PointKind, float] = defaultdict(float)
        for kind, count in points:
            self._left[kind] += count
        self._sent: dict[int, OpenChunk] = {}
        self._begun, self._back, self._learns = time.monotonic(), 0.0, False

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
        return sum(now.points for key, now in list(under_way.items()) if key in self._sent)

    def seconds_left(self) -> float:
        """Until all points are solved; NaN as long as nothing is known."""
        running = [
            (self._sent[key], now.points, now.seconds, time.perf_counter() - now.begun)
            for key, now in list(under_way.items())
            if key in self._sent
        ]
        left, solved, seconds = self._left.copy(), self._solved.copy(), self._seconds.copy()
        for work, points, spent, _ in running:
            left[work.kind] -= points
            solved[work.kind] += points
            seconds[work.kind] += spent
        if not solved.total():
            return math.nan
        usual = sum(seconds.values()) / solved.total()
        rate = {kind: seconds[kind] / solved[kind] if solved[kind] else usual for kind in left}
        total = sum(count * rate[kind] for kind, count in left.items() if count > 0)
        longest = 0.0
        for work, points, spent, since in running:
            own = (len(work.left) - points) * rate[work.kind]
            # some of it is done, of a method that tells of no point all the time it has spent
            done = min(since - spent, 0.9 * own)
            total, longest = total - done, max(longest, own - done)
        passed = time.monotonic() - self._begun
        at_once = len(running) or max(1.0, self._back / passed if passed > 0.0 else 1.0)
        return max(total / at_once, longest)

    def learn_from_samples(self, curves: Sequence[StudyCurve], task: Task) -> None:
        """Once it is time, solve points of every kind on a thread of its own: the turn of some comes late."""
        if self._learns or time.monotonic() - self._begun < LEARNS_AFTER:
            return
        self._learns = True
        if all(self._solved[kind] for kind, count in self._left.items() if count > 0):
            return

        def learn() -> None:
            for kind, price in prices(curves, task).items():
                self.learn(kind, price.measured, price.spent)

        from frictionlab.runner.price import prices  # with numba

        Thread(target=learn, daemon=True).start()
