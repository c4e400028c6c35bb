"""Pieces through an executor: solved within their time, taken as they come, sent again where one is lost."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import BrokenExecutor, CancelledError, Executor, Future
from contextlib import suppress
from contextvars import copy_context
from dataclasses import replace
from queue import Empty, SimpleQueue
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar

from frictionlab.compile.notice import seconds_compiling
from frictionlab.laws.faults import BrokenPlugin
from frictionlab.methods.base import refused
from frictionlab.methods.under_way import UnderWay, told_to
from frictionlab.runner.part import Part, one_part
from frictionlab.runner.pieces import Chunk, Piece
from frictionlab.runner.progress import compiling
from frictionlab.runner.solve import solve, text_columns

if TYPE_CHECKING:
    import pyarrow as pa

Found = TypeVar("Found")
LOOK = 0.1
"""Seconds between two looks at the time."""
NEVER_GIVEN_UP = threading.Event()
"""Event of work that nobody gives up: it is never set."""


class OverLimit(Exception):
    """Work that has taken longer than it may, and goes on in a thread of its own until it ends by itself."""


def within(
    seconds: float, work: Callable[..., Found], *arguments: Any, given_up: threading.Event = NEVER_GIVEN_UP
) -> Found:
    """Return what the work returns, or raise what it raises; compiling does not count.

    The thread that asks only waits, so that an interrupt reaches it at once, and no program waits for the other one.
    Raises OverLimit, and CancelledError once it is given up.
    """
    outcome: list[tuple[Any, BaseException | None]] = []
    done, spent, last = threading.Event(), 0.0, time.monotonic()

    def go() -> None:
        try:
            outcome.append((work(*arguments), None))
        except BaseException as problem:
            outcome.append((None, problem))
        finally:
            done.set()

    threading.Thread(target=copy_context().run, args=(go,), daemon=True).start()
    while not done.wait(LOOK):
        now = time.monotonic()
        spent, last = spent + (0.0 if compiling() else now - last), now
        if spent > seconds:
            raise OverLimit
        if given_up.is_set():
            raise CancelledError
    found, problem = outcome.pop()
    if problem is not None:
        raise problem
    return found


OF_TEN = 10
"""Points of a chunk for which it is allowed the time of one: most need a small part of theirs."""
under_way: dict[int, UnderWay] = {}
"""By the id of each chunk that this process is solving: how far that is."""


class Solved(NamedTuple):
    """Answers to a piece, and the seconds they took, compiling left out."""

    answers: pa.Table
    seconds: float


def solve_each(chunks: Sequence[Chunk], given_up: threading.Event = NEVER_GIVEN_UP) -> Solved:
    """Answer every point of the chunks of a piece. Raises BrokenPlugin, CancelledError."""
    from frictionlab.runner.packing import packed_answers  # brings arrow: one number does without

    found = list[tuple[Part, float]]()
    if len(chunks) > 1:
        with suppress(OverLimit):
            found = within(sum(map(_allowed, chunks)), lambda: [*map(solve_timed, chunks)], given_up=given_up)
    found = found or [solve_within(chunk, given_up) for chunk in chunks]
    return Solved(packed_answers([part for part, _ in found]), sum(seconds for _, seconds in found))


def solve_within(chunk: Chunk, given_up: threading.Event = NEVER_GIVEN_UP) -> tuple[Part, float]:
    """Answer every point of a chunk; what takes too long is halved, down to the single points that do.

    Raises BrokenPlugin, CancelledError.
    """
    size = len(chunk)
    try:
        return within(_allowed(chunk), solve_timed, chunk, given_up=given_up)
    except OverLimit:
        if size == 1:
            return _killed(chunk.task.seconds_per_point), chunk.task.seconds_per_point
    places = range(size // 2), range(size // 2, size)
    halves = [solve_within(chunk.of(slice(own.start, own.stop)), given_up) for own in places]
    parts = [(own, part) for own, (part, _) in zip(places, halves, strict=True)]
    return one_part(parts, size), sum(seconds for _, seconds in halves)


def _allowed(chunk: Chunk) -> float:
    return chunk.task.seconds_per_point * max(1.0, len(chunk) / OF_TEN)


def solve_timed(chunk: Chunk) -> tuple[Part, float]:
    """Answer every point of a chunk on this thread; return the seconds, too. Raises BrokenPlugin."""
    begun = time.perf_counter()
    now = under_way[id(chunk)] = UnderWay(begun - seconds_compiling(), begun)
    try:
        with told_to(now):
            part = solve(chunk)
    finally:
        under_way.pop(id(chunk), None)
    return part, time.perf_counter() - seconds_compiling() - now.begun


def _killed(seconds: float) -> Part:
    reason = f"over the limit of {seconds:g} s (limit: {{seconds_per_point: {seconds:g}}} in the study)"
    return Part(text_columns(replace(refused([reason]), status=["killed"])), {}, {})


TICK = 0.1
"""Seconds between two looks at what goes on."""
GRACE = 1.0
"""Time [s] that an interrupted run waits for pieces in progress; most need far less."""
MOST_SENT = 256
"""Pieces that are out at once: enough for the workers of a cluster, few enough to be held in memory."""
MOST_SENDINGS = 5
"""Times that a piece is sent out whose worker was lost."""
MOST_RENEWALS = 20
"""Times that a pool is made anew that breaks before anything has come back."""

SentPiece = tuple[Piece, list[Chunk]]
"""A piece and what methods are given of it."""
SolveChunks = Callable[[Sequence[Chunk]], Solved]
Take = Callable[[Piece, Solved], None]
Renew = Callable[[], Executor]


class Sent:
    """Pieces that are sent out and have not come back.

    solve: what workers do. renew: makes an executor in place of one that a lost worker broke.
    """

    def __init__(self, executor: Executor, solve: SolveChunks, renew: Renew | None = None) -> None:
        self._executor, self._solve, self._renew = executor, solve, renew
        self._done: SimpleQueue[Future[Solved]] = SimpleQueue()
        self._tries: dict[int, int] = {}
        self._renewed = 0
        self._waiting: dict[Future[Solved], SentPiece] = {}

    def collect(self, pieces: Iterable[SentPiece], take: Take, tick: Callable[[], None]) -> None:
        """Solve every piece, giving each answer to ``take`` on this thread; ``tick`` is called all along.

        Raises what solving raises, BrokenExecutor where workers are lost for good, and KeyboardInterrupt: pieces not
        begun are then dropped and those being solved get ``GRACE`` seconds, in which what they find is taken too.
        """
        try:
            for piece, chunks in pieces:
                self._send(piece, chunks)
                while len(self._waiting) >= MOST_SENT:
                    self._take_one(take, tick)
            while self._waiting:
                self._take_one(take, tick)
        except BaseException as problem:
            for future in self._waiting:
                future.cancel()
            if isinstance(problem, KeyboardInterrupt | BrokenExecutor):
                self._rescue(take)
            raise

    def _send(self, piece: Piece, chunks: list[Chunk]) -> None:
        """Send a piece out. Raises BrokenExecutor."""
        try:
            future = self._executor.submit(self._solve, chunks)
        except BrokenExecutor:
            if self._renew is None:
                raise
            self._executor, self._renewed = self._renew(), self._renewed + 1
            future = self._executor.submit(self._solve, chunks)
        self._waiting[future] = piece, chunks
        future.add_done_callback(self._done.put)

    def _take_one(self, take: Take, tick: Callable[[], None]) -> None:
        """Take what comes back next, if that is soon."""
        with suppress(Empty):
            future = self._done.get(timeout=TICK)
            piece, chunks = self._waiting.pop(future)
            try:
                found = future.result()
            except (KeyboardInterrupt, BrokenPlugin):
                raise
            except (Exception, CancelledError) as problem:  # solving raises nothing else: its worker was lost
                self._send_again(piece, chunks, problem)
            else:
                self._renewed = 0
                take(piece, found)
        tick()

    def _send_again(self, piece: Piece, chunks: list[Chunk], problem: BaseException) -> None:
        """Send a piece whose worker was lost to another one. Raises BrokenExecutor where that happens too often."""
        if isinstance(problem, BrokenExecutor):  # of a pool all pieces are lost, with one worker at fault
            lost_for_good = self._renew is None or self._renewed >= MOST_RENEWALS
        else:
            tries = self._tries[id(piece)] = self._tries.get(id(piece), 1) + 1
            lost_for_good = tries > MOST_SENDINGS
        if lost_for_good:
            raise BrokenExecutor(str(problem) or type(problem).__name__) from problem
        self._send(piece, chunks)

    def _rescue(self, take: Take) -> None:
        """Take what is done, or about to be."""
        until = time.monotonic() + GRACE
        left = {future for future in self._waiting if not future.cancelled()}
        with suppress(KeyboardInterrupt):  # a second one: go with what is there
            while left and time.monotonic() < until:
                with suppress(Empty):
                    left.discard(self._done.get(timeout=TICK))
        for future, (piece, _) in self._waiting.items():
            if future.done() and not future.cancelled() and future.exception() is None:
                take(piece, future.result())
