"""Chunks through an executor: threads that a program need not wait for, limits of time, results as they come.

Threads that a program need not wait for: a kernel that runs on in one of them cannot be stopped from outside.

Chunks under a limit of time: points that take longer alone are killed, and keep no other point from its answer.

Chunks through an executor, results as they come, and what is kept when the run is cut short.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import BrokenExecutor, CancelledError, Executor, Future
from contextlib import suppress
from contextvars import copy_context
from dataclasses import replace
from queue import Empty, SimpleQueue
from threading import Event, Thread
from time import monotonic
from typing import Any, NamedTuple, TypeVar

from frictionlab.compile.notice import seconds_compiling
from frictionlab.laws.faults import BrokenPlugin
from frictionlab.methods.base import refused
from frictionlab.methods.under_way import UnderWay, told_to
from frictionlab.runner.chunks import Chunk
from frictionlab.runner.open_chunks import OpenChunk
from frictionlab.runner.part import Part
from frictionlab.runner.progress import compiling
from frictionlab.runner.solve import solve, text_columns

Found = TypeVar("Found")
LOOK = 0.1
"""Seconds between two looks at the time."""


class OverLimit(Exception):
    """Work that has taken longer than it may, and goes on in a thread of its own until it ends by itself."""


def within(seconds: float, work: Callable[..., Found], *arguments: Any) -> Found:
    """What the work returns or raises; compilation does not count. Raises OverLimit.

    The thread that asks only waits, so that an interrupt reaches it at once.
    """
    outcome: list[tuple[Any, BaseException | None]] = []
    done, spent, last = Event(), 0.0, time.monotonic()

    def go() -> None:
        try:
            outcome.append((work(*arguments), None))
        except BaseException as problem:
            outcome.append((None, problem))
        finally:
            done.set()

    Thread(target=copy_context().run, args=(go,), daemon=True).start()
    while not done.wait(LOOK):
        now = time.monotonic()
        spent, last = spent + (0.0 if compiling() else now - last), now
        if spent > seconds:
            raise OverLimit
    found, problem = outcome.pop()
    if problem is not None:
        raise problem
    return found


class Workers(Executor):
    """So many threads."""

    def __init__(self, count: int) -> None:
        self._waiting: SimpleQueue[tuple[Future[Any], Callable[[], Any]] | None] = SimpleQueue()
        self._threads = [Thread(target=self._work, daemon=True) for _ in range(count)]
        for thread in self._threads:
            thread.start()

    def submit(self, work: Callable[..., Any], /, *given: Any, **named: Any) -> Future[Any]:
        """The future of ``work(*given, **named)``."""
        future: Future[Any] = Future()
        self._waiting.put((future, lambda: work(*given, **named)))
        return future

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """Let the threads end after what waits, or after what they are at."""
        while cancel_futures:
            try:
                left = self._waiting.get_nowait()
            except Empty:
                break
            if left is not None:
                left[0].cancel()
        for _ in self._threads:
            self._waiting.put(None)
        for thread in self._threads if wait else ():
            thread.join()

    def _work(self) -> None:
        while (asked := self._waiting.get()) is not None:
            future, work = asked
            if not future.set_running_or_notify_cancel():
                continue
            try:
                future.set_result(work())
            except BaseException as problem:
                future.set_exception(problem)


TOGETHER = 10
"""Points of a chunk for which it is allowed the time of one: most need a small part of theirs."""
under_way: dict[int, UnderWay] = {}
"""By the id of each chunk that this process is solving: how far that is."""


class Solved(NamedTuple):
    """The rows of a chunk, and the seconds they took, compiling left out."""

    parts: list[Part]
    seconds: float


def solve_each(chunks: Sequence[Chunk]) -> list[Solved]:
    """Answer every point of chunks of one task; where they take too long together, of each half of them apart.

    Raises BrokenPlugin.
    """
    if len(chunks) == 1:
        return [solve_within(chunks[0])]
    try:
        return within(sum(map(_seconds, chunks)), _each_timed, chunks)
    except OverLimit:
        half = len(chunks) // 2
        return solve_each(chunks[:half]) + solve_each(chunks[half:])


def _each_timed(chunks: Sequence[Chunk]) -> list[Solved]:
    return [solve_timed(chunk) for chunk in chunks]


def solve_within(chunk: Chunk) -> Solved:
    """Answer every point of a chunk; what takes too long is halved, down to the single points that do.

    Raises BrokenPlugin.
    """
    size = len(chunk.rows)
    try:
        return within(_seconds(chunk), solve_timed, chunk)
    except OverLimit:
        if size == 1:
            return Solved([_killed(chunk)], chunk.task.seconds_per_point)
    halves = [solve_within(chunk.of(where)) for where in (slice(size // 2), slice(size // 2, None))]
    return Solved([part for half in halves for part in half.parts], sum(half.seconds for half in halves))


def _seconds(chunk: Chunk) -> float:
    """The time that it may take."""
    return chunk.task.seconds_per_point * max(1.0, len(chunk.rows) / TOGETHER)


def solve_timed(chunk: Chunk) -> Solved:
    """Answer every point of a chunk on this thread. Raises BrokenPlugin."""
    begun = time.perf_counter()
    now = under_way[id(chunk)] = UnderWay(begun - seconds_compiling(), begun)
    try:
        with told_to(now):
            parts = solve(chunk)
    finally:
        under_way.pop(id(chunk), None)
    return Solved(parts, time.perf_counter() - seconds_compiling() - now.begun)


def _killed(chunk: Chunk) -> Part:
    seconds = chunk.task.seconds_per_point
    reason = f"over the limit of {seconds:g} s (limit: {{seconds_per_point: {seconds:g}}} in the study)"
    answers = replace(refused([reason]), status=["killed"])
    return Part(chunk.rows, text_columns(answers), {}, {})


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
