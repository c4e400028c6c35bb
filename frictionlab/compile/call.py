"""Calls of kernels: by machine code, or by Python while that costs less than compiling them would."""

from __future__ import annotations

import contextlib
import os
import time
from collections.abc import Callable, Iterator
from contextvars import ContextVar
from functools import cached_property
from typing import Any

import numba
import numpy as np

from frictionlab.compile.cache import Compiled, compiled
from frictionlab.compile.interpret import TooLong, interpreted, limited_to
from frictionlab.compile.law_addresses import by_address, without_addresses
from frictionlab.compile.notice import add_to_compiling, named_while_it_compiles
from frictionlab.laws.base import FrictionLaw
from frictionlab.laws.faults import from_outside

_config: Any = numba.config

PYTHON_AT_MOST = 4.0
"""Processor time [s] that a process lets Python spend on a kernel before it compiles it, in 10 to 20 s, once."""
PYTHON_IN_A_TRIAL = 0.5
"""Processor time [s] of a call by Python where nothing is to be compiled."""


class _Choice:
    """Request of the environment, FRICTIONLAB_COMPILE=always: that Python runs no kernel."""

    always_compile = os.environ.get("FRICTIONLAB_COMPILE") == "always"


_choice = _Choice()


@contextlib.contextmanager
def compiling_at_once() -> Iterator[None]:
    """Meanwhile Python runs no kernel."""
    before, _choice.always_compile = _choice.always_compile, True
    try:
        yield
    finally:
        _choice.always_compile = before


class NotKept(BaseException):
    """Kernels that would have to be compiled where nothing is to be; no error of the point that asks for them."""

    def __init__(self, kernels: frozenset[str]) -> None:
        super().__init__(", ".join(sorted(kernels)))
        self.kernels = kernels


_compiles_nothing = ContextVar("compiles nothing", default=False)


@contextlib.contextmanager
def compiling_nothing() -> Iterator[None]:
    """Meanwhile, in this context, a kernel that Python does not bring to an end soon raises NotKept."""
    token = _compiles_nothing.set(True)
    try:
        yield
    finally:
        _compiles_nothing.reset(token)


def seconds_by_python() -> float:
    """Processor time [s] that this process has spent so far on kernels run by Python."""
    return sum(_spent.values())


_ready: set[Any] = set()
"""Calls, by kernel and kinds of arguments, that this process has machine code for: numba takes 2 ms to find out."""
_spent: dict[Any, float] = {}
"""Processor time [s] that Python has spent on each of the others in this process."""


class MadeByKernel:
    """Argument that another kernel makes on first use, once by machine code and once by Python.

    So kernels are handed the table of maps of a law on a body: compiled kernels a table of machine code, kernels that
    Python runs a table of Python functions. The kernel returns a pair: what has to live as long as the argument, and
    the argument.
    """

    def __init__(self, kernel: Any, law: FrictionLaw, *arguments: Any) -> None:
        self._call, self._arguments = KernelCall(kernel, law), arguments

    @cached_property
    def _made_by_machine(self) -> Any:
        entry = self._call.entry(self._arguments)
        return entry, entry(*self._arguments)

    @cached_property
    def _made_by_python(self) -> Any:
        return self._call.by_python(*self._arguments)

    @property
    def for_machine(self) -> Any:
        """Argument for machine code."""
        return self._made_by_machine[1][1]

    @property
    def for_python(self) -> Any:
        """Argument for a kernel that Python runs."""
        return self._made_by_python[1]

    @cached_property
    def kind(self) -> Any:
        """Key that differs between arguments of different types."""
        return self._call.key(self._arguments)

    def not_kept(self) -> frozenset[str]:
        """Name the kernels that have to be compiled to make it."""
        return self._call.not_kept(self._arguments)


class KernelCall:
    """A kernel, and the law that is its first argument; called like a function.

    Raises CannotCompile, when called, where numba cannot compile the law's methods.
    """

    def __init__(self, kernel: Any, law: FrictionLaw | None = None) -> None:
        self.kernel, self.law = kernel, law

    def __call__(self, *arguments: Any) -> Any:
        """Return what the kernel returns."""
        return self.timed(*arguments)[0]

    def timed(self, *arguments: Any) -> tuple[Any, float]:
        """Return what the kernel returns, and the seconds it took, compiling left out."""
        key = self.key(arguments)
        if key not in _ready:
            found = None if self._is_for_machine(key, arguments) else self._limited(key, arguments)
            if found is not None:
                return found
            if _compiles_nothing.get() and not _config.DISABLE_JIT and (lost := self.not_kept(arguments)):
                raise NotKept(lost)
            self._prepare(arguments)
            _ready.add(key)
        entry, given = self.entry(arguments), [_for_machine(each) for each in arguments]
        start = time.perf_counter()
        return entry(*given), time.perf_counter() - start

    @property
    def name(self) -> str:
        """In words."""
        return str(self.kernel.__name__.replace("_", " "))

    def key(self, arguments: tuple[Any, ...]) -> Any:
        """Return the kernel and the kinds of its arguments."""
        law = self.law and (type(self.law), self.law.structure())
        return self.kernel, law, _kind(arguments)

    def entry(self, arguments: tuple[Any, ...]) -> Compiled:
        """Return the machine code, for arguments like these."""
        return compiled(self.kernel, self.law and by_address(self.law, _is_planar(arguments)))

    def not_kept(self, arguments: tuple[Any, ...]) -> frozenset[str]:
        """Names of the entries to compile for arguments like these: no machine code is in memory or on disk."""
        entry = compiled(self.kernel, self.law and without_addresses(self.law))
        made = [each for each in arguments if isinstance(each, MadeByKernel)]
        # a kernel that others make arguments of is compiled once, whatever they make
        kept = entry.is_kept_at_all() if made else entry.is_kept(*arguments)
        # the methods of a law that it calls take less to compile than Python takes to be run
        own = frozenset[str]() if kept else frozenset({str(entry.entry.__module__)})
        return own.union(*(each.not_kept() for each in made))

    def by_python(self, *arguments: Any) -> Any:
        """Return what the kernel returns where Python runs it."""
        given = [each.for_python if isinstance(each, MadeByKernel) else each for each in arguments]
        return interpreted(self.kernel)(*((self.law, *given) if self.law else given))

    def _is_for_machine(self, key: Any, arguments: tuple[Any, ...]) -> bool:
        if _config.DISABLE_JIT or _choice.always_compile or _spent.get(key, 0.0) >= PYTHON_AT_MOST:
            return True
        return not self.not_kept(arguments)

    def _prepare(self, arguments: tuple[Any, ...]) -> None:
        """Compile the kernel, or load it."""
        start = time.perf_counter()
        with named_while_it_compiles(self.name):
            given = [_for_machine(each) for each in arguments]
            if not _config.DISABLE_JIT:
                self.entry(arguments).prepare(*given)
        add_to_compiling(time.perf_counter() - start)

    def _limited(self, key: Any, arguments: tuple[Any, ...]) -> tuple[Any, float] | None:
        """Return the same where Python comes to an end in time; else None, and nothing is written."""
        if self.law is not None and from_outside(type(self.law)):
            # what numba cannot compile in a law of others is told whatever Python can do
            by_address(self.law, _is_planar(arguments))
        spent, found, trial = _spent.get(key, 0.0), None, _compiles_nothing.get()
        begin, start = time.thread_time(), time.perf_counter()
        with _unwritten(arguments) as keep:
            try:
                left = PYTHON_AT_MOST - spent
                with limited_to(min(left, PYTHON_IN_A_TRIAL) if trial else left), np.errstate(all="ignore"):
                    found = self.by_python(*arguments), time.perf_counter() - start
                keep()
                _spent[key] = spent + time.thread_time() - begin
            except (TooLong, ArithmeticError, ValueError):  # Python refuses numbers that machine code takes
                _spent[key] = spent if trial else PYTHON_AT_MOST
        return found


def _for_machine(value: Any) -> Any:
    return value.for_machine if isinstance(value, MadeByKernel) else value


def _is_planar(value: Any) -> bool:
    """Check whether a number of the plane is among the arguments, records opened."""
    if isinstance(value, tuple):
        return any(map(_is_planar, value))
    return isinstance(value, complex) or (isinstance(value, np.ndarray) and value.dtype.kind == "c")


def _kind(value: Any) -> Any:
    """Return what numba tells arguments apart by, found in microseconds."""
    if isinstance(value, np.ndarray):
        return value.dtype.char, value.ndim, value.flags.c_contiguous, value.flags.writeable
    if isinstance(value, tuple):
        return type(value), *map(_kind, value)
    return value.kind if isinstance(value, MadeByKernel) else type(value)


@contextlib.contextmanager
def _unwritten(arguments: tuple[Any, ...]) -> Iterator[Callable[[], None]]:
    """Afterwards the arrays among the arguments, records opened, are what they were, unless ``keep`` was called."""
    before = [(array, array.copy()) for array in _arrays(arguments)]
    yield before.clear
    for array, content in before:
        array[...] = content


def _arrays(values: Any) -> Iterator[np.ndarray]:
    for value in values:
        if isinstance(value, np.ndarray):
            yield value
        elif isinstance(value, tuple):
            yield from _arrays(value)
