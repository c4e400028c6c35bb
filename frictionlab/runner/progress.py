"""Progress of long runs, told by tqdm: a line that is updated on a terminal, a bar in a notebook; lines in a log."""

from __future__ import annotations

import math
import os
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from threading import Event, Thread
from typing import Any, Self, TextIO

from frictionlab.compile.notice import kernel_at_work

Progress = Callable[[int, int, float, str], None]
"""Called now and then with the number of points done and of all points, the seconds left, NaN where not known, and
the words for what is under way, "" for nothing."""

QUIET = 2.0
"""Time [s] before a run prints its progress."""
OFTEN, NOW_AND_THEN = 0.2, 5.0
"""Time [s] between two states of the updating line, and between two lines where none can be updated."""


def silent(done: int, total: int, left: float = math.nan, words: str = "") -> None:
    """No progress."""


def compiling() -> bool:
    """Check whether numba compiles at this moment, on whatever other thread: it then holds its one lock."""
    module = sys.modules.get("numba.core.compiler_lock")
    lock = getattr(getattr(module, "global_compiler_lock", None), "_lock", None)
    if lock is None:
        return False
    if free := lock.acquire(blocking=False):
        lock.release()
    return not free


class Meter:
    """Progress of a run, told on a stream from the third second on; no run below that prints anything.

    Within ``with`` a thread tells it, so that it goes on while kernels compile or figures are drawn.
    """

    def __init__(self, stream: TextIO, whose: str = "") -> None:
        self._stream, self._whose, self._in_notebook = stream, whose, "ipykernel" in sys.modules
        self._updating = self._in_notebook or (_is_terminal(stream) and os.environ.get("TERM") != "dumb")
        self._start = time.monotonic()
        self._bar: Any = None
        self._ended, self._thread = Event(), Thread(target=self._go_on, daemon=True)
        self.begins("solving", "points")

    def begins(self, doing: str, things: str = "") -> None:
        """Name the next stage of the run, and what is counted in it."""
        self._at = 0, 0, math.nan, ""
        self._doing, self._things = doing, things

    def __call__(self, done: int, total: int, left: float = math.nan, words: str = "") -> None:
        """Take down how far the stage is; left: seconds, NaN where not known; words: for what is under way."""
        self._at = done, total, left, words

    def write(self, text: str) -> None:
        """Write on the stream at once; what it does not take is lost: a stream that was closed is no error."""
        with suppress(OSError, ValueError):
            self._stream.write(text)
            self._stream.flush()

    def clear(self) -> None:
        """Erase the updating line: something else is about to be printed."""
        if self._bar is not None:
            with self._bar.get_lock():
                self._bar.clear(nolock=True)

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._ended.set()
        self._thread.join()
        if self._bar is not None:
            self._bar.total = None  # else a notebook keeps the bar, as one of work that failed
            self._bar.close()

    def _go_on(self) -> None:
        pause = QUIET
        while not self._ended.wait(pause):
            pause = self._tell(self._line(), *self._at[:2])

    def _tell(self, line: str, done: int, total: int) -> float:
        """Tell what goes on; return the time [s] until it is told again."""
        if not self._updating:
            self.write(line + "\n")
            return NOW_AND_THEN
        if self._bar is None:
            from tqdm.auto import tqdm  # takes a moment, of long runs alone

            shape = "{desc}{bar}" if self._in_notebook else "{desc}"
            self._bar = tqdm(total=total, bar_format=shape, leave=False, file=self)
        if self._bar.total != total:
            self._bar.reset(total)
        self._bar.n, self._bar.ncols = done, None if self._in_notebook else _room(self._stream)
        self._bar.set_description_str(line)
        return OFTEN

    def _line(self) -> str:
        done, total, left, words = self._at
        kernel = kernel_at_work() if compiling() else ""
        stage = f"{self._doing}: {done} of {total} {self._things}".rstrip() if total else self._doing
        # how long kernels take to compile is not known
        rest = f"about {spoken(left)} left" if 0.5 < left < math.inf and not kernel else ""
        passed = f"{spoken(time.monotonic() - self._start)} so far"
        facts = kernel and f"compiling {kernel}", stage, words, rest, passed
        return self._whose + ", ".join(filter(None, facts))


def _is_terminal(stream: TextIO) -> bool:
    with suppress(OSError, ValueError):  # it may have been closed
        return stream.isatty()
    return False


def _room(stream: TextIO) -> int:
    """Letters that a line takes: one less than there are columns, as some terminals wrap at the last one."""
    with suppress(OSError, ValueError):
        return (os.get_terminal_size(stream.fileno()).columns or 80) - 1
    return 79


ProgressAsked = Progress | bool | None
"""Wish of a caller: whether to tell progress on stderr; None where somebody sees it."""


@contextmanager
def progress_told(
    progress: ProgressAsked, doing: str = "solving", things: str = "points"
) -> Iterator[Progress]:
    """Tell progress, within; nobody is told where neither a terminal nor a notebook shows stderr."""
    stream, in_notebook = sys.stderr, "ipykernel" in sys.modules
    if callable(progress):
        yield progress
    elif stream is None or not (in_notebook or _is_terminal(stream) if progress is None else progress):
        yield silent
    else:
        with Meter(stream) as meter:
            meter.begins(doing, things)
            yield meter


def spoken(seconds: float) -> str:
    """A time in words, to about a hundredth."""
    if seconds < 99.5:
        return f"{seconds:.0f} s" if seconds > 9.5 else f"{seconds:.1g} s"
    minutes, rest = divmod(round(seconds), 60)
    return f"{minutes} min {rest:02} s" if minutes < 60 else f"{minutes // 60} h {minutes % 60:02} min"
