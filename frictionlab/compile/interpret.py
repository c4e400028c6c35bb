"""Kernels as Python runs them: the same text, with every compiled function it names replaced by its own text."""

from __future__ import annotations

import builtins
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
import numpy as np

from frictionlab.compile.decorators import FOREIGN, names_used

_config: Any = numba.config

LONG = 150
"""Instructions from which a function looks at the clock; one with a loop always does."""


def run_as(intrinsic: Any, body: Callable[..., Any]) -> Any:
    """Tell Python what to run in the place of what only numba can: the intrinsic, returned as it is."""
    _OF_NUMBERS.instead[id(intrinsic)] = intrinsic, body
    return intrinsic


def run_on_arrays_as(intrinsic: Any, body: Callable[..., Any]) -> Any:
    """Return the same for texts that Python runs on arrays."""
    _OF_ARRAYS.instead[id(intrinsic)] = intrinsic, body
    return intrinsic


def over_lanes(kernel: Any) -> Any:
    """Mark a kernel whose numbers are lanes: Python runs its text on arrays of any length. Returns the kernel."""

    def on_arrays(*arguments: Any) -> Any:
        return interpreted_on_arrays(kernel)(*arguments)

    return on_arrays if _config.DISABLE_JIT else run_as(kernel, on_arrays)


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
        return _OF_NUMBERS.read(kernel)


@functools.cache
def interpreted_on_arrays(kernel: Any) -> Any:
    """Return the same for numbers that are planar and arrays of any length."""
    with _building:
        return _OF_ARRAYS.read(kernel)


_building = threading.RLock()


class _Reader:
    """Twins of kernel functions: the same text, every name standing for what Python is to run.

    instead: what Python runs in place of what numba alone can, each beside that. builtins, math: what those names
    stand for.
    """

    def __init__(self, builtins: dict[str, Any], math: Any) -> None:
        self.builtins, self.math = builtins, math
        self.instead: dict[int, tuple[Any, Any]] = {}
        self.twins: dict[int, tuple[Any, Any]] = {}

    def read(self, kernel: Any) -> Any:
        """Return what stands for a kernel function, or for anything else that a name may stand for."""
        if id(kernel) in self.instead:
            return self.instead[id(kernel)][1]
        function = getattr(kernel, "py_func", kernel)
        if isinstance(function, FunctionType):
            return self._twin(function) if function.__module__.partition(".")[0] not in FOREIGN else kernel
        if isinstance(kernel, list):  # of bodies to choose from
            return [self.read(each) for each in kernel]
        if type(kernel) is tuple:
            return tuple(self.read(each) for each in kernel)
        if isinstance(kernel, dict):
            return {key: self.read(each) for key, each in kernel.items()}
        return kernel

    def _twin(self, function: FunctionType) -> Any:
        """Made once: a function may name itself, so what it names is filled in afterwards."""
        if id(function) in self.twins:
            return self.twins[id(function)][1]
        scope: dict[str, Any] = {"__builtins__": self.builtins, "__name__": function.__module__}
        cells = tuple(CellType() for _ in function.__closure__ or ())
        plain = FunctionType(
            function.__code__, scope, function.__name__, function.__defaults__, cells or None
        )
        plain.__kwdefaults__ = function.__kwdefaults__
        twin = _looking_at_the_clock(plain) if _may_take_long(function) else plain
        self.twins[id(function)] = function, twin
        for name in names_used(function.__code__):
            if name in function.__globals__:
                scope[name] = self._seen_in(function, function.__globals__[name])
        for cell, old in zip(cells, function.__closure__ or (), strict=True):
            cell.cell_contents = self.read(old.cell_contents)
        return twin

    def _seen_in(self, function: FunctionType, value: Any) -> Any:
        """Return what a name stands for in the twin of a function: of our modules, what it takes from them."""
        if value is math:
            return self.math
        if not isinstance(value, ModuleType) or value.__name__.partition(".")[0] in FOREIGN:
            return self.read(value)
        taken = {name for name in names_used(function.__code__) if hasattr(value, name)}
        return SimpleNamespace(**{name: self.read(getattr(value, name)) for name in taken})


class _ArrayReader(_Reader):
    """Twins whose numbers are planar and arrays."""

    def read(self, kernel: Any) -> Any:
        """Return that body for lanes of a function that has one."""
        return super().read(getattr(kernel, "of_lanes", kernel))


def _paired(re: Any, im: Any) -> Any:
    return re + 1j * im


_OF_NUMBERS = _Reader(vars(builtins), math)
_OF_ARRAYS = _ArrayReader(vars(builtins) | {"min": np.minimum, "max": np.maximum, "complex": _paired}, np)


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
