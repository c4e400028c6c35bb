"""Kernels as Python runs them: the same text, with every compiled function it names replaced by its own text."""

from __future__ import annotations

import contextlib
import dis
import functools
import math
import threading
import time
from collections.abc import Callable, Iterator
from types import CellType, FunctionType, ModuleType, SimpleNamespace
from typing import Any

import numba

from frictionlab.compile.dispatch import FOREIGN, names_used

_config: Any = numba.config

LONG = 150
"""Instructions from which a function looks at the clock; one with a loop always does."""

_as_python: dict[int, tuple[Any, Any]] = {}
_twins: dict[int, tuple[Any, Any]] = {}


def run_as(intrinsic: Any, body: Callable[..., Any]) -> Any:
    """Tell Python what to run in the place of what only numba can: the intrinsic, returned as it is."""
    _as_python[id(intrinsic)] = intrinsic, body
    return intrinsic


class TooLong(Exception):
    """A kernel run by Python that has taken the time it was given."""


class _Clock(threading.local):
    until = math.inf


_clock = _Clock()


@contextlib.contextmanager
def limited_to(seconds: float) -> Iterator[None]:
    """While it lasts, kernels of this thread that Python runs raise TooLong after so much processor time [s]."""
    before, _clock.until = _clock.until, time.thread_time() + seconds
    try:
        yield
    finally:
        _clock.until = before


@functools.cache
def interpreted(kernel: Any) -> Any:
    """A kernel function as Python runs it: the formulas of a kernel have one address, for drivers too."""
    if _config.DISABLE_JIT:
        return kernel  # Python runs everything as it stands
    with _building:  # another thread must not be given a function whose names are not filled in yet
        return _of_python(kernel)


_building = threading.RLock()


def _of_python(kernel: Any) -> Any:
    if id(kernel) in _as_python:
        return _as_python[id(kernel)][1]
    function = getattr(kernel, "py_func", kernel)
    if isinstance(function, FunctionType):
        return _twin(function) if function.__module__.partition(".")[0] not in FOREIGN else kernel
    if isinstance(kernel, list):  # of bodies to choose from
        return [_of_python(each) for each in kernel]
    if type(kernel) is tuple:
        return tuple(_of_python(each) for each in kernel)
    if isinstance(kernel, dict):
        return {key: _of_python(each) for key, each in kernel.items()}
    return kernel


def _twin(function: FunctionType) -> Any:
    """Made once: a function may name itself, so what it names is filled in afterwards."""
    if id(function) in _twins:
        return _twins[id(function)][1]
    scope: dict[str, Any] = {"__builtins__": __builtins__, "__name__": function.__module__}
    cells = tuple(CellType() for _ in function.__closure__ or ())
    plain = FunctionType(function.__code__, scope, function.__name__, function.__defaults__, cells or None)
    plain.__kwdefaults__ = function.__kwdefaults__
    twin = _looking_at_the_clock(plain) if _may_take_long(function) else plain
    _twins[id(function)] = function, twin
    for name in names_used(function.__code__):
        if name in function.__globals__:
            scope[name] = _seen_in(function, function.__globals__[name])
    for cell, old in zip(cells, function.__closure__ or (), strict=True):
        cell.cell_contents = _of_python(old.cell_contents)
    return twin


def _seen_in(function: FunctionType, value: Any) -> Any:
    """What a name stands for in the twin of a function: of frictionlab's modules, what it takes from them."""
    if not isinstance(value, ModuleType) or value.__name__.partition(".")[0] in FOREIGN:
        return _of_python(value)
    taken = {name for name in names_used(function.__code__) if hasattr(value, name)}
    return SimpleNamespace(**{name: _of_python(getattr(value, name)) for name in taken})


def _may_take_long(function: FunctionType) -> bool:
    steps: Iterator[dis.Instruction] = dis.get_instructions(function)
    return any(step.opname.startswith("JUMP_BACKWARD") or step.offset > 2 * LONG for step in steps)


def _looking_at_the_clock(function: Callable[..., Any]) -> Callable[..., Any]:
    @functools.wraps(function)
    def watched(*arguments: Any) -> Any:
        if time.thread_time() > _clock.until:
            raise TooLong
        return function(*arguments)

    return watched
