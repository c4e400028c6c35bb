"""Calls of kernels: by Python while that costs less than compiling them would, by machine code from then on."""

from __future__ import annotations

import contextlib
import os
import time
from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

import numba
import numpy as np

from frictionlab.compile.account import Account
from frictionlab.compile.cache import account_of, compiled, timed
from frictionlab.compile.interpret import TooLong, interpreted, limited_to
from frictionlab.compile.notice import add_to_compiling, named_while_it_compiles
from frictionlab.faults import from_outside
from frictionlab.laws.base import FrictionLaw

_config: Any = numba.config

WORTH = 3.0
"""Processor time [s] that Python may spend on a kernel, in all runs together, before it is compiled: compiling takes
2 to 20 s, once."""


class _Choice:
    """Whether everything is compiled at once, as ``FRICTIONLAB_COMPILE=always`` asks for."""

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


_compiled: set[Any] = set()
"""Calls, by entry and kinds of arguments, that this process has machine code for: numba takes 2 ms to find it out."""
_accounts: dict[Any, Account] = {}
"""Of the others that it has asked about."""


class KernelCall:
    """A kernel, and the law that is its first argument; called like a function.

    Where no machine code is kept, Python runs the kernel's text, and what that takes is written down beside the
    place of the machine code; a kernel that has taken WORTH, or would, is compiled. Both answer the same but for
    rounding. Raises CannotCompile, when called, where numba cannot compile the law's methods.
    """

    def __init__(self, kernel: Any, law: FrictionLaw | None = None) -> None:
        self.kernel, self.law = kernel, law
        self._machine = compiled(kernel, law)
        # what numba cannot compile in a law of others is told whatever the number of points
        self._always = bool(_config.DISABLE_JIT) or (law is not None and from_outside(type(law)))

    def __call__(self, *arguments: Any) -> Any:
        """What the kernel returns."""
        return self.timed(*arguments)[0]

    def timed(self, *arguments: Any, points: int = 1, first: tuple[Any, ...] = ()) -> tuple[Any, float]:
        """What the kernel returns, and the seconds it took, compiling left out.

        points: how many these arguments are for. first: arguments for the first of them alone, by which Python
        finds out what one costs; they are written to like the others, and left as they were.
        """
        key = self._key(arguments)
        if key in _compiled:
            start = time.perf_counter()
            return self._machine(*arguments), time.perf_counter() - start
        if not (self._always or _choice.always_compile):
            found = self._by_python(key, arguments, points, first)
            if found is not None:
                return found
        start = time.perf_counter()
        with named_while_it_compiles(self.name):
            done = timed(self._machine, *arguments)
        add_to_compiling(time.perf_counter() - start - done[1])
        _compiled.add(key)
        return done

    @property
    def name(self) -> str:
        """In words, with the law that it is compiled for."""
        kernel = self.kernel.__name__.replace("_", " ")
        return str(kernel) if self.law is None else f"{kernel} for {type(self.law).__name__}"

    def kept_for(self) -> list[str]:
        """The types of the arguments of each machine code that is kept of it."""
        machine: Any = self._machine
        entry = machine.args[0] if isinstance(machine, partial) else machine
        return [] if _config.DISABLE_JIT else list(entry._cache.kept_for())

    def _key(self, arguments: tuple[Any, ...]) -> Any:
        machine: Any = self._machine
        bound = machine.args if isinstance(machine, partial) else (machine,)
        return bound[0], _kind(bound[1:]), _kind(arguments)

    def _by_python(
        self, key: Any, arguments: tuple[Any, ...], points: int, first: tuple[Any, ...]
    ) -> tuple[Any, float] | None:
        """The same where Python is to run the kernel and comes to an end; else None, and nothing is written."""
        account = _accounts.get(key)
        if account is None:
            account = _accounts[key] = account_of(self._machine, arguments)
        if points > 1 and first:
            start = account.spent
            with _unwritten(first):
                found = self._run(first, account)
            if found is None or account.spent + points * (account.spent - start) > WORTH:
                return None
        return self._run(arguments, account)

    def _run(self, arguments: tuple[Any, ...], account: Account) -> tuple[Any, float] | None:
        if account.compiled or account.spent >= WORTH:
            return None
        given = arguments if self.law is None else (self.law, *arguments)
        begin, start = time.thread_time(), time.perf_counter()
        with _unwritten(arguments) as keep:
            try:
                with limited_to(WORTH - account.spent), np.errstate(all="ignore"):
                    found = interpreted(self.kernel)(*given)
                keep()
            except (TooLong, ArithmeticError, ValueError):  # Python refuses numbers that machine code takes
                account.spend(WORTH)
                return None
        account.spend(time.thread_time() - begin)
        return found, time.perf_counter() - start


def _kind(value: Any) -> Any:
    """What numba tells arguments apart by, found in microseconds."""
    if isinstance(value, np.ndarray):
        return value.dtype.char, value.ndim, value.flags.c_contiguous, value.flags.writeable
    if isinstance(value, tuple):
        return type(value), *map(_kind, value)
    return type(value)


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
