"""Chunks through an executor, results as they come, and what is kept when the run is cut short."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Executor, Future, wait
from contextlib import suppress

from frictionlab.results.part import Part
from frictionlab.runner.chunks import Chunk
from frictionlab.runner.limit import solve_within

TICK = 0.1
"""Seconds between two looks at what goes on."""
GRACE = 2.0
"""Time [s] that an interrupted run waits for chunks in progress; most chunks need far less."""

Take = Callable[[list[Part]], None]
Solving = Future[list[Part]]


def collect(chunks: Sequence[Chunk], executor: Executor, take: Take, tick: Callable[[], None]) -> None:
    """Solve every chunk, giving each answer to ``take`` on this thread; ``tick`` is called all along.

    Raises what ``solve_within`` raises, BrokenExecutor where workers died, and KeyboardInterrupt: chunks not begun
    are then dropped and those being solved get ``GRACE`` seconds, in which what they find is taken too.
    """
    futures = [executor.submit(solve_within, chunk) for chunk in chunks]
    taken: set[Solving] = set()
    try:
        _follow(futures, taken, take, tick)
    except BaseException as problem:
        for future in futures:
            future.cancel()
        if isinstance(problem, KeyboardInterrupt | BrokenExecutor):
            _rescue(futures, taken, take)
        raise


def _follow(futures: list[Solving], taken: set[Solving], take: Take, tick: Callable[[], None]) -> None:
    waiting = set(futures)
    while waiting:
        done, waiting = wait(waiting, timeout=TICK, return_when=FIRST_COMPLETED)
        for future in done:
            take(future.result())
            taken.add(future)
        tick()


def _rescue(futures: list[Solving], taken: set[Solving], take: Take) -> None:
    """Take what is done, or about to be. Taking an answer twice does no harm."""
    with suppress(KeyboardInterrupt):  # a second one: go with what is there
        wait([future for future in futures if not future.cancelled()], timeout=GRACE)
    for future in futures:
        if future.done() and not future.cancelled() and future not in taken and future.exception() is None:
            take(future.result())
