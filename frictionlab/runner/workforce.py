"""Who solves the chunks of a run: threads, processes of this machine, the workers of a cluster, any executor."""

from __future__ import annotations

import multiprocessing
import os
import signal
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Executor, ProcessPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

from frictionlab.runner.execute import Renew, SentGroup, Take, Workers, collect
from frictionlab.runner.files import NoScheduler
from frictionlab.runner.open_chunks import OpenChunk

ANSWERS_WITHIN = 10.0
"""Seconds in which a scheduler answers."""


@dataclass(frozen=True)
class Workforce:
    """An executor. renew: makes another where a lost worker broke it. elsewhere: whether in other processes."""

    executor: Executor
    renew: Renew | None = None
    elsewhere: bool = True

    def solve(self, groups: Iterable[SentGroup], take: Take, tick: Callable[[], None]) -> None:
        """Solve groups of chunks, as ``collect`` does.

        In other processes the first of each kind comes back before others of it are sent: the kernels it needs are
        then compiled once.
        """

        def first_of_each_kind_solved() -> Iterator[SentGroup]:
            known: set[Any] = set()
            for each in groups:
                kinds = {_kernels_of(work) for work in each}
                if kinds <= known:
                    yield each
                else:
                    known.update(kinds)
                    collect([each], self.executor, take, tick, self.renew)

        sent = first_of_each_kind_solved() if self.elsewhere else groups
        collect(sent, self.executor, take, tick, self.renew)


def _kernels_of(each: OpenChunk) -> Any:
    """What decides which kernels a chunk needs."""
    law, method, scene = each.chunk.law, each.chunk.method, each.chunk.scenes.scene
    return type(law), type(method), scene.degrees_of_freedom, scene.load_along_belt_only


@contextmanager
def workforce(given: Executor | Workforce | None) -> Iterator[Workforce]:
    """The caller's, or threads that are not waited for after an interrupt."""
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
    """So many threads of this process, which are not waited for at the end."""
    pool = Workers(count)
    try:
        yield Workforce(pool, elsewhere=False)
    finally:
        pool.shutdown(wait=False, cancel_futures=True)


@contextmanager
def processes(count: int) -> Iterator[Workforce]:
    """So many processes of this machine; one that dies is replaced, and what it was at is begun anew."""
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
    """Without waiting for what is being solved: it is not asked for any more."""
    running = list((getattr(pool, "_processes", None) or {}).values())
    pool.shutdown(wait=False, cancel_futures=True)
    for process in running:
        process.terminate()


def _leave_interrupts_to_the_parent() -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)


@contextmanager
def cluster(address: str) -> Iterator[Workforce]:
    """The workers of a dask scheduler. Raises NoScheduler where none answers, or distributed is not installed."""
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
