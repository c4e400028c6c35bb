"""Threads that a program need not wait for: a kernel that runs on in one of them cannot be stopped from outside."""

from __future__ import annotations

import time
from collections.abc import Callable
from concurrent.futures import Executor, Future
from contextvars import copy_context
from queue import Empty, SimpleQueue
from threading import Event, Thread
from typing import Any, TypeVar

from frictionlab.runner.progress import compiling

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
