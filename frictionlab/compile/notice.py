"""What is compiled at this moment and what has been, for those who wait. Imports nothing, so that asking is free."""

from __future__ import annotations

import contextlib
import threading
from collections.abc import Iterator

compiled_here: list[str] = []
"""The kernels that this process has compiled, by the names they are kept under."""

_called: list[str] = []
"""The kernels that machine code is asked for, by the names of their functions; most are compiled already."""


class _Compiling(threading.local):
    seconds = 0.0


_compiling = _Compiling()


def add_to_compiling(seconds: float) -> None:
    """This thread has waited so long [s] for machine code."""
    _compiling.seconds += seconds


def seconds_compiling() -> float:
    """How long this thread has waited for machine code so far [s]."""
    return _compiling.seconds


@contextlib.contextmanager
def named_while_it_compiles(name: str) -> Iterator[None]:
    """Whatever numba compiles meanwhile is told under this name."""
    _called.append(name)
    try:
        yield
    finally:
        _called.remove(name)


def kernel_at_work() -> str:
    """Of the kernels called the one called first, others wait for it; empty where none is."""
    return next(iter(_called), "")
