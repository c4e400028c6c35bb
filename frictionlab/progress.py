"""Progress of runs that take more than a moment: one updating line on a terminal, plain lines elsewhere."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import TextIO

Progress = Callable[[int, int], None]
"""Called now and then with the number of points done and of all points."""

QUIET = 2.0
"""Seconds a run may take without a word."""


def silent(done: int, total: int) -> None:
    """No progress."""


class Meter:
    """Progress lines on a stream, from the third second on."""

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream
        self._updating = stream.isatty()
        self._interval = 0.2 if self._updating else 5.0
        self._start = time.monotonic()
        self._next = self._start + QUIET
        self._first: int | None = None
        self._width = 0

    def __call__(self, done: int, total: int) -> None:
        """Tell how far the run is, if it is time to."""
        now = time.monotonic()
        self._first = done if self._first is None else self._first
        if now < self._next:
            return
        self._next = now + self._interval
        self._write(self._line(done, total, now - self._start))

    def _line(self, done: int, total: int, elapsed: float) -> str:
        fresh = done - (self._first or 0)
        left = f", about {elapsed * (total - done) / fresh:.0f} s left" if fresh else ""
        return f"{done} of {total} points, {elapsed:.0f} s{left}"

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
