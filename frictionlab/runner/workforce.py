"""Workers that solve the pieces of a run: threads, processes of this machine, those of a cluster, any executor."""

from __future__ import annotations

import multiprocessing
import os
import signal
import threading
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Executor, ProcessPoolExecutor, ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from typing import Any

from frictionlab.runner.engine import Renew, Sent, SentPiece, SolveChunks, Take, solve_each
from frictionlab.runner.files import NoScheduler
from frictionlab.runner.pieces import Chunk

ANSWERS_WITHIN = 10.0
"""Seconds in which a scheduler answers."""


@dataclass(frozen=True)
class Workforce:
    """An executor and what it is given to do.

    renew: makes another where a lost worker broke it. elsewhere: whether in other processes.
    """

    executor: Executor
    renew: Renew | None = None
    elsewhere: bool = True
    solve_each: SolveChunks = solve_each

    def solve(self, pieces: Iterable[SentPiece], take: Take, tick: Callable[[], None]) -> None:
        """Solve pieces, as ``Sent.collect`` does.

        In other processes the first of each kind comes back before others of it are sent: the kernels it needs are
        then compiled once.
        """
        sent, known = Sent(self.executor, self.solve_each, self.renew), set[Any]()

        def first_of_each_kind_solved() -> Iterator[SentPiece]:
            for piece, chunks in pieces:
                if self.elsewhere and (kind := _kernels_of(chunks[0])) not in known:
                    known.add(kind)
                    sent.collect([(piece, chunks)], take, tick)
                else:
                    yield piece, chunks

        sent.collect(first_of_each_kind_solved(), take, tick)


def _kernels_of(chunk: Chunk) -> Any:
    """Return what decides which kernels a chunk needs."""
    scene = chunk.scenes.scene
    return type(chunk.law), type(chunk.method), scene.degrees_of_freedom, scene.load_along_belt_only


@contextmanager
def workforce(given: Executor | Workforce | None) -> Iterator[Workforce]:
    """Give the caller's workers, or threads."""
    if isinstance(given, Workforce):
        yield given
        return
    if given is not None:
        yield Workforce(given)
        return
    with threads(os.cpu_count() or 1) as found:
        yield found


@contextmanager
def threads(count: int) -> Iterator[Workforce]:
    """Give so many threads of this process; what they are at is given up at the end."""
    given_up = threading.Event()
    pool = ThreadPoolExecutor(count)
    try:
        yield Workforce(pool, elsewhere=False, solve_each=partial(solve_each, given_up=given_up))
    finally:
        given_up.set()
        pool.shutdown(wait=False, cancel_futures=True)


@contextmanager
def processes(count: int) -> Iterator[Workforce]:
    """Give so many processes of this machine; one that dies is replaced, and what it was at is begun anew."""
    pools: list[ProcessPoolExecutor] = []

    def renew() -> Executor:
        context = multiprocessing.get_context("spawn")  # a fork would copy locks that threads hold
        pools.append(ProcessPoolExecutor(count, context, initializer=_leave_interrupts_to_the_parent))
        return pools[-1]

    try:
        yield Workforce(renew(), renew)
    finally:
        for pool in pools:
            _end(pool)


def _end(pool: ProcessPoolExecutor) -> None:
    """End a pool without waiting for what is being solved: nobody asks for it any more."""
    running = list((getattr(pool, "_processes", None) or {}).values())
    pool.shutdown(wait=False, cancel_futures=True)
    for process in running:
        process.terminate()


def _leave_interrupts_to_the_parent() -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)


@contextmanager
def cluster(address: str) -> Iterator[Workforce]:
    """Give the workers of a dask scheduler. Raises NoScheduler where none answers or dask is not installed."""
    try:
        from distributed import Client
    except ModuleNotFoundError as problem:
        raise NoScheduler(
            "--scheduler needs dask.distributed: pip install 'frictionlab[cluster]'"
        ) from problem
    try:
        client = Client(address, timeout=ANSWERS_WITHIN)
    except (OSError, ValueError) as problem:
        raise NoScheduler(
            f"no scheduler answers at {address}: {str(problem).partition(chr(10))[0]}"
        ) from problem
    with client:
        yield Workforce(client.get_executor())
