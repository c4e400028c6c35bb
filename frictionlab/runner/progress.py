"""Progress of long runs: one updating line on a terminal, separate lines elsewhere."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from typing import TextIO

from frictionlab.compile.notice import compiled_here, kernel_at_work

Progress = Callable[[int, int], None]
"""Called now and then with the number of points done and of all points."""

QUIET = 2.0
"""Time [s] before a run prints its progress."""


def silent(done: int, total: int) -> None:
    """No progress."""


def compiling() -> bool:
    """Whether numba compiles at this moment, on whatever other thread: it then holds its one lock."""
    module = sys.modules.get("numba.core.compiler_lock")
    lock = getattr(getattr(module, "global_compiler_lock", None), "_lock", None)
    if lock is None:
        return False
    if free := lock.acquire(blocking=False):
        lock.release()
    return not free


def _compiling_what() -> str:
    kernel = kernel_at_work()
    return f", compiling kernel {len(compiled_here) + 1}{kernel and f' ({kernel})'}, once per machine"


class Meter:
    """Progress lines on a stream, from the third second on."""

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream
        self._updating = stream.isatty()
        self._interval = 0.2 if self._updating else 5.0
        self._start = self._last = time.monotonic()
        self._next = self._start + QUIET
        self._solving = 0.0
        self._first: int | None = None
        self._width = 0

    def __call__(self, done: int, total: int) -> None:
        """Tell how far the run is, if it is time to."""
        now, waiting = time.monotonic(), compiling()
        self._solving += 0.0 if waiting else now - self._last
        self._last = now
        self._first = done if self._first is None else self._first
        if now < self._next:
            return
        self._next = now + self._interval
        news = _compiling_what() if waiting else self._time_left(done, total)
        self._write(f"{done} of {total} points, {now - self._start:.0f} s{news}")

    def _time_left(self, done: int, total: int) -> str:
        """At the speed so far, compiling not counted: it does not come again."""
        fresh = done - (self._first or 0)
        left = self._solving * (total - done) / fresh if fresh else 0.0
        return f", about {left:.0f} s left" if left > 0.5 else ""

    def _write(self, line: str) -> None:
        if self._updating:
            self._stream.write("\r" + line.ljust(self._width))
            self._width = len(line)
        else:
            self._stream.write(line + "\n")
        self._stream.flush()

    def close(self) -> None:
        """End the updating line, if there is one."""
        if self._width:
            self._stream.write("\n")
            self._stream.flush()
            self._width = 0
