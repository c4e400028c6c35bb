"""Progress of long runs: one updating line on a terminal, a bar in a notebook, separate lines elsewhere."""

from __future__ import annotations

import math
import os
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from threading import Event, Lock, Thread
from types import TracebackType
from typing import Any, Self, TextIO

from frictionlab.compile.notice import kernel_at_work

Progress = Callable[..., None]
"""Called now and then with the number of points done and of all points, and the seconds left, NaN where not known."""

QUIET = 2.0
"""Time [s] before a run prints its progress."""
OFTEN, NOW_AND_THEN = 0.2, 5.0
"""Time [s] between two states of the updating line, and between two lines where none can be updated."""


def silent(done: int, total: int, left: float = math.nan, at: str = "") -> None:
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


class Meter:
    """What a run is at, told on a stream from the third second on; no run below that prints anything.

    Within ``with`` a thread tells it, so that it goes on while kernels compile or figures are drawn.
    """

    def __init__(self, stream: TextIO, whose: str = "") -> None:
        self._stream, self._whose = stream, whose
        self._updating = stream.isatty() and os.environ.get("TERM") != "dumb"
        self._start = time.monotonic()
        self._next, self._shown = self._start + QUIET, 0
        self._one_at_a_time, self._ended, self._thread = Lock(), Event(), Thread(target=self._go_on)
        self.begins("solving", "points")

    def begins(self, doing: str, things: str = "") -> None:
        """The next stage of the run, and what is counted in it."""
        self._doing, self._things = doing, things
        self._done = self._total = self._at_first = 0
        self._working, self._last = 0.0, time.monotonic()
        self._left: float | None = None

    def __call__(self, done: int, total: int, left: float | None = None, at: str = "") -> None:
        """Tell how far the stage is, if it is time to; left: seconds, NaN where not known, None by the count."""
        self._left = left
        self._at_first = self._at_first if self._total else done
        self._done, self._total = done, total
        self.look()

    def look(self) -> None:
        """Tell what goes on, if it is time to."""
        with self._one_at_a_time:
            now, waiting = time.monotonic(), compiling()
            self._working += 0.0 if waiting else now - self._last
            self._last = now
            if now < self._next or self._ended.is_set():
                return
            self._next = now + (OFTEN if self._updating else NOW_AND_THEN)
            self._write(self._words(now - self._start, kernel_at_work() if waiting else ""))

    def _words(self, passed: float, kernel: str) -> str:
        count = f": {self._done} of {self._total} {self._things}" if self._total else ""
        new = self._done - self._at_first  # kernels are compiled once: that is not held against the points
        left = self._working / new * (self._total - self._done) if new else 0.0
        left = left if self._left is None else self._left
        # how long kernels take to compile is not known
        facts = [f"compiling {kernel}", self._doing + count] if kernel else [self._doing + count]
        facts += [f"about {spoken(left)} left"] if left > 0.5 and not kernel else []
        return self._whose + ", ".join([*facts, f"{spoken(passed)} so far"])

    def _write(self, line: str) -> None:
        with suppress(OSError, ValueError):  # a stream that was closed is no error
            if self._updating:
                line = line[: self._room()]
                self._stream.write("\r" + line.ljust(self._shown))
                self._shown = len(line)
            else:
                self._stream.write(line + "\n")
            self._stream.flush()

    def _room(self) -> int:
        """Letters that a line takes: one less than there are columns, as some terminals wrap at the last one."""
        try:
            return (os.get_terminal_size(self._stream.fileno()).columns or 80) - 1
        except (OSError, ValueError):
            return 79

    def clear(self) -> None:
        """Erase the updating line: something else is about to be printed."""
        with self._one_at_a_time, suppress(OSError, ValueError):
            if self._shown:
                self._stream.write("\r" + " " * min(self._shown, self._room()) + "\r")
                self._stream.flush()
                self._shown = 0

    def close(self) -> None:
        """Tell nothing more."""
        self._ended.set()
        self.clear()

    def _go_on(self) -> None:
        while not self._ended.wait(OFTEN):
            self.look()

    def __enter__(self) -> Self:
        self._thread.daemon = True
        self._thread.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, problem: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()
        self._thread.join()


class NotebookMeter(Meter):
    """The same as a bar, as notebooks draw it."""

    def __init__(self, stream: TextIO) -> None:
        super().__init__(stream)
        self._updating = True
        self._bar: Any = None

    def _write(self, line: str) -> None:
        if self._bar is None:
            from tqdm.auto import tqdm  # takes a moment, of long runs alone

            self._bar = tqdm(total=self._total, bar_format="{desc}{bar}", leave=False)
        if self._bar.total != self._total:
            self._bar.reset(self._total)
        self._bar.n = self._done
        self._bar.set_description_str(line)

    def clear(self) -> None:
        """Take the bar away."""
        with self._one_at_a_time:
            if self._bar is not None:
                self._bar.close()
            self._bar = None


ProgressAsked = Progress | bool | None
"""What a function takes: whether to tell progress on stderr; None where somebody sees it."""


@contextmanager
def progress_told(
    progress: ProgressAsked, doing: str = "solving", things: str = "points"
) -> Iterator[Progress]:
    """What tells progress, within; nobody is told where neither a terminal nor a notebook shows stderr."""
    in_notebook, stream = "ipykernel" in sys.modules, sys.stderr
    watched = stream is not None and (in_notebook or stream.isatty())
    if callable(progress):
        yield progress
    elif stream is None or not (watched if progress is None else progress):
        yield silent
    else:
        with (NotebookMeter if in_notebook else Meter)(stream) as meter:
            meter.begins(doing, things)
            yield meter


def spoken(seconds: float) -> str:
    """A time in words, to about a hundredth."""
    if seconds < 99.5:
        return f"{seconds:.0f} s" if seconds > 9.5 else f"{seconds:.1g} s"
    minutes, rest = divmod(round(seconds), 60)
    return f"{minutes} min {rest:02} s" if minutes < 60 else f"{minutes // 60} h {minutes % 60:02} min"
