"""Ctrl-C where Python cannot obey it: in compiled code on the main thread, and in callbacks that lose exceptions."""

from __future__ import annotations

import os
import signal
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Any

from frictionlab.cli.output import INTERRUPTED, print_message, tell_stopping

NOTICED_WITHIN = 3.0
"""Seconds in which the main thread may notice by itself."""
SOON = 0.1
"""Seconds after which an interrupt that was lost is sent again."""


@contextmanager
def prompt_interrupts() -> Iterator[None]:
    """End the process where the main thread has not noticed an interrupt for some seconds."""
    usual = signal.getsignal(signal.SIGINT) is signal.default_int_handler
    if os.name != "posix" or not usual or threading.current_thread() is not threading.main_thread():
        yield
        return
    noticed, hook = threading.Event(), sys.unraisablehook

    def notice(number: int, frame: FrameType | None) -> None:
        noticed.set()
        tell_stopping()
        signal.default_int_handler(number, frame)

    # The signal writes its number to the pipe at once; Python calls the handler when the main thread is back.
    told, tell = os.pipe()
    os.set_blocking(tell, False)
    before = signal.set_wakeup_fd(tell, warn_on_full_buffer=False)
    signal.signal(signal.SIGINT, notice)
    sys.unraisablehook = _once_more(hook)
    watcher = threading.Thread(target=_watch, args=(told, noticed), daemon=True)
    watcher.start()
    try:
        yield
    finally:
        noticed.set()  # a command that ends has obeyed, whoever's handler heard the interrupt
        signal.signal(signal.SIGINT, signal.default_int_handler)
        signal.set_wakeup_fd(before)
        sys.unraisablehook = hook
        os.close(tell)
        watcher.join()


def _watch(told: int, noticed: threading.Event) -> None:
    while number := os.read(told, 1):
        if number[0] == signal.SIGINT and not noticed.wait(NOTICED_WITHIN):
            print_message("interrupted")
            os._exit(INTERRUPTED)
    os.close(told)


def _once_more(hook: Callable[[Any], object]) -> Callable[[Any], None]:
    """Return where a callback has lost an interrupt, interrupt once more; the hook is for everything else."""

    def hear(lost: Any) -> None:
        if not issubclass(lost.exc_type, KeyboardInterrupt):
            hook(lost)
            return
        again = threading.Timer(SOON, os.kill, (os.getpid(), signal.SIGINT))
        again.daemon = True
        again.start()

    return hear
