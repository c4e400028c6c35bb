"""Kernels compiled at this moment and before, for those who wait. Imports nothing, so that asking is free."""

from __future__ import annotations

import contextlib
import threading
from collections.abc import Iterator
from dataclasses import dataclass

compiled_here: list[str] = []
"""Kernels that this process has compiled, by the names they are kept under."""

_called: list[_Called] = []
"""Kernels that machine code is asked for, in the order in which they were; for most of them it is kept."""


@dataclass(eq=False)
class _Called:
    """A kernel that a thread asks machine code for; not_kept: known to be compiled, not read from a file."""

    name: str
    thread: int
    not_kept: bool = False


class _Compiling(threading.local):
    seconds = 0.0


_compiling = _Compiling()


def add_to_compiling(seconds: float) -> None:
    """Add how long [s] this thread has waited for machine code."""
    _compiling.seconds += seconds


def seconds_compiling() -> float:
    """Return how long this thread has waited for machine code so far [s]."""
    return _compiling.seconds


@contextlib.contextmanager
def named_while_it_compiles(name: str) -> Iterator[None]:
    """Whatever numba compiles meanwhile on this thread is told under this name."""
    called = _Called(name, threading.get_ident())
    _called.append(called)
    try:
        yield
    finally:
        _called.remove(called)


def mark_cache_miss() -> None:
    """Note that the kernel this thread asks for is not in the cache."""
    for called in _called:
        if called.thread == threading.get_ident():
            called.not_kept = True


def kernel_at_work() -> str:
    """Return the kernel that is being compiled, others wait for it; empty where none is."""
    return next((called.name for called in list(_called) if called.not_kept), "")
