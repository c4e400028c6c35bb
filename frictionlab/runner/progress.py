"""Progress of long runs: one updating line on a terminal, separate lines elsewhere."""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Callable
from contextlib import suppress
from threading import Event, Lock, Thread
from types import TracebackType
from typing import Self, TextIO

from frictionlab.compile.notice import compiled_here, kernel_at_work
from frictionlab.runner.progress_line import RunStage, fitted, stage_words

Progress = Callable[[int, int], None]
"""Called now and then with the number of points done and of all points."""

QUIET = 2.0
"""Time [s] before a run prints its progress."""
OFTEN, NOW_AND_THEN = 0.2, 5.0
"""Time [s] between two states of the updating line, and between two lines where none can be updated."""


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


class Meter:
    """What a run is at, told on a stream from the third second on; no run below that prints anything.

    Within ``with`` a thread tells it, so that it goes on while kernels compile or figures are drawn.
    """

    def __init__(self, stream: TextIO, whose: str = "") -> None:
        self._stream, self._whose = stream, whose
        self._updating = stream.isatty() and os.environ.get("TERM") != "dumb"
        self._start = time.monotonic()
        self._next = self._start + QUIET
        self._stage = RunStage("solving", "points", self._start)
        self._compiled_before = len(compiled_here)
        self._shown = 0
        self._one_at_a_time, self._ended, self._thread = Lock(), Event(), Thread(target=self._go_on)

    def __call__(self, done: int, total: int) -> None:
        """Tell how far the stage is, if it is time to."""
        self._stage.reaches(done, total)
        self.look()

    def begins(self, doing: str, things: str = "") -> None:
        """The next stage of the run, and what is counted in it."""
        self._stage = RunStage(doing, things, time.monotonic())

    def look(self) -> None:
        """Tell what goes on, if it is time to."""
        with self._one_at_a_time:
            now, waiting, stage = time.monotonic(), compiling(), self._stage
            stage.passes(now, waiting)
            if now < self._next or self._ended.is_set():
                return
            self._next = now + (OFTEN if self._updating else NOW_AND_THEN)
            name = kernel_at_work() if waiting else ""
            number = len(compiled_here) - self._compiled_before + 1
            kernel = f"compiling kernel {number} ({name})" if name else ""
            facts = stage_words(stage, now - self._start, kernel)
            self._write([f"{self._whose}{facts[0]}", *facts[1:]], stage.share)

    def _write(self, facts: list[str], share: float | None) -> None:
        with suppress(OSError, ValueError):  # a stream that was closed is no error
            if self._updating:
                line = fitted(facts, share, self._room())
                self._stream.write("\r" + line.ljust(self._shown))
                self._shown = len(line)
            else:
                self._stream.write(", ".join(facts) + "\n")
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
            self._erase()

    def _erase(self) -> None:
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
