"""Chunks through an executor, results as they come, and what is kept when the run is cut short."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import BrokenExecutor, CancelledError, Executor, Future
from contextlib import suppress
from queue import Empty, SimpleQueue
from time import monotonic

from frictionlab.faults import BrokenPlugin
from frictionlab.runner.limit import Solved, solve_each
from frictionlab.runner.open_chunks import OpenChunk

TICK = 0.1
"""Seconds between two looks at what goes on."""
GRACE = 2.0
"""Time [s] that an interrupted run waits for chunks in progress; most chunks need far less."""
MOST_SENT = 256
"""Groups of chunks that are out at once: enough for the workers of a cluster, few enough to be held in memory."""
MOST_SENDINGS = 5
"""How often a chunk is sent out whose worker was lost."""
MOST_RENEWALS = 20
"""How often a pool is made anew that breaks before anything has come back."""

SentGroup = list[OpenChunk]
"""Chunks that go to a worker, and come back, together."""
Take = Callable[[OpenChunk, Solved], None]
Renew = Callable[[], Executor]


def grouped(chunks: Iterable[OpenChunk], points: int) -> Iterator[SentGroup]:
    """Neighbours that have about so many points: to send out chunks of a few takes longer than to solve them."""
    group, size = SentGroup(), 0
    for each in chunks:
        group.append(each)
        size += len(each.left)
        if size + 0.5 * len(each.left) > points:
            yield group
            group, size = SentGroup(), 0
    if group:
        yield group


def collect(
    groups: Iterable[SentGroup],
    executor: Executor,
    take: Take,
    tick: Callable[[], None],
    renew: Renew | None = None,
) -> None:
    """Solve every chunk, giving each answer to ``take`` on this thread; ``tick`` is called all along.

    renew: makes an executor in place of one that a lost worker broke. Raises what ``solve_each`` raises,
    BrokenExecutor where workers are lost for good, and KeyboardInterrupt: groups not begun are then dropped and those
    being solved get ``GRACE`` seconds, in which what they find is taken too.
    """
    sent = _Sent(executor, renew)
    try:
        for each in groups:
            sent.send(each)
            while len(sent.waiting) >= MOST_SENT:
                _take_one(sent, take, tick)
        while sent.waiting:
            _take_one(sent, take, tick)
    except BaseException as problem:
        for future in sent.waiting:
            future.cancel()
        if isinstance(problem, KeyboardInterrupt | BrokenExecutor):
            _rescue(sent, take)
        raise


class _Sent:
    """Chunks that are sent out and have not come back."""

    def __init__(self, executor: Executor, renew: Renew | None) -> None:
        self._executor, self._renew = executor, renew
        self._done: SimpleQueue[Future[list[Solved]]] = SimpleQueue()
        self._tries: dict[int, int] = {}
        self._renewed = 0
        self.waiting: dict[Future[list[Solved]], SentGroup] = {}

    def send(self, group: SentGroup) -> None:
        """Send chunks out. Raises BrokenExecutor."""
        chunks = [work.chunk for work in group]
        try:
            future = self._executor.submit(solve_each, chunks)
        except BrokenExecutor:
            if self._renew is None:
                raise
            self._executor, self._renewed = self._renew(), self._renewed + 1
            future = self._executor.submit(solve_each, chunks)
        self.waiting[future] = group
        future.add_done_callback(self._done.put)

    def one_done(self, seconds: float) -> Future[list[Solved]] | None:
        """A group that came back, within so many seconds."""
        with suppress(Empty):
            return self._done.get(timeout=seconds)
        return None

    def send_again(self, group: SentGroup, problem: BaseException) -> None:
        """Chunks whose worker was lost, to another one. Raises BrokenExecutor where that happens again and again."""
        if isinstance(problem, BrokenExecutor):  # of a pool all chunks are lost, with one worker at fault
            lost_for_good = self._renew is None or self._renewed >= MOST_RENEWALS
        else:
            tries = self._tries[id(group)] = self._tries.get(id(group), 1) + 1
            lost_for_good = tries > MOST_SENDINGS
        if lost_for_good:
            raise BrokenExecutor(str(problem) or type(problem).__name__) from problem
        self.send(group)

    def came_back(self) -> None:
        """Something was solved: workers are not lost one after another."""
        self._renewed = 0


def _take_one(sent: _Sent, take: Take, tick: Callable[[], None]) -> None:
    """What comes back next, if that is soon."""
    future = sent.one_done(TICK)
    if future is not None and (group := sent.waiting.pop(future, None)) is not None:
        try:
            found = future.result()
        except (KeyboardInterrupt, BrokenPlugin):
            raise
        except (Exception, CancelledError) as problem:  # solving raises nothing else: its worker was lost
            sent.send_again(group, problem)
        else:
            sent.came_back()
            for work, solved in zip(group, found, strict=True):
                take(work, solved)
    tick()


def _rescue(sent: _Sent, take: Take) -> None:
    """Take what is done, or about to be."""
    until = monotonic() + GRACE
    left = {future for future in sent.waiting if not future.cancelled()}
    with suppress(KeyboardInterrupt):  # a second one: go with what is there
        while left and monotonic() < until:
            if (future := sent.one_done(TICK)) is not None:
                left.discard(future)
    for future, group in sent.waiting.items():
        if future.done() and not future.cancelled() and future.exception() is None:
            for work, solved in zip(group, future.result(), strict=True):
                take(work, solved)
