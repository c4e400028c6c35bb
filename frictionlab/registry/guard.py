"""Code of a plugin, run so that it cannot end the process, write to stdout or change Python for everybody else."""

from __future__ import annotations

import contextvars
import ctypes
import io
import os
import pkgutil
import signal
import sys
import threading
import warnings
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from importlib import import_module
from typing import Any, NoReturn, TypeVar

from frictionlab import laws
from frictionlab.laws.arrays import OfEach
from frictionlab.laws.base import FrictionLaw

Answer = TypeVar("Answer")

ENDS = ("_exit", "abort", "execv", "execve", "fork", "forkpty")
"""Functions of ``os`` that end this process or continue it twice."""
SHARED = ("builtins", "cmath", "math", "numba", "numpy", "numpy.linalg", "os", "random", "time")
"""Modules whose functions and numbers must stay what they are, beside those of frictionlab."""


class Meddling(Exception):
    """Code that changed what others use, all of which has been put back; the message says what, as a sentence."""


class ProcessExit(BaseException):
    """A call that would have ended the process."""


class TimeLimitExceeded(BaseException):
    """Raised at the time limit; not an Exception, so that a law cannot catch it by ``except Exception``."""


class ForwardedText(io.TextIOBase):
    """A stream that hands text on to another; closing it leaves that one open."""

    def __init__(self, stream: Any) -> None:
        self._stream = stream
        self.was_closed = False

    def write(self, text: str) -> int:
        """Hand on."""
        return int(self._stream.write(text))

    def flush(self) -> None:
        """Flush the other."""
        self._stream.flush()

    def close(self) -> None:
        """Take note of it."""
        self.was_closed = True

    @property
    def encoding(self) -> str:  # type: ignore[override]  # of io's stream it is an attribute
        """That of the other."""
        return str(self._stream.encoding)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._stream, name)


LOADING = 60.0
"""Time limit [s] for loading a module, the packages it imports included."""
_ONE_AT_A_TIME = threading.RLock()


def guarded(work: Callable[[], Answer]) -> Answer:
    """What ``work`` returns; its prints go to stderr, and what it changes of Python is put back.

    Raises Meddling where it replaces functions of others or closes a standard stream, ProcessExit where it would end
    the process, and what it raises itself.
    """
    with _ONE_AT_A_TIME, _without_ends(), _settings_kept(), _functions_kept(), _streams_kept():
        return contextvars.copy_context().run(work)  # numpy's handling of errors lives in the context


def load_guarded(load: Callable[[], Answer]) -> Answer:
    """What ``load`` returns, which runs the code of a module: guarded, and under a time limit."""

    def within_limit() -> Answer:
        with time_limit(LOADING):
            return load()

    return guarded(within_limit)


@contextmanager
def _without_ends() -> Iterator[None]:
    held = {name: getattr(os, name) for name in ENDS if hasattr(os, name)}
    for name in held:
        setattr(os, name, _refusing(name))
    try:
        yield
    finally:
        for name, function in held.items():
            setattr(os, name, function)


def _refusing(name: str) -> Callable[..., NoReturn]:
    def refuse(*_: Any) -> NoReturn:
        raise ProcessExit(f"os.{name} is not for plugins: it acts on the whole program")

    return refuse


@contextmanager
def _settings_kept() -> Iterator[None]:
    """Put back the working folder, the limit of recursion, what becomes of warnings and of Ctrl-C."""
    folder, depth, interrupt = os.getcwd(), sys.getrecursionlimit(), signal.getsignal(signal.SIGINT)
    try:
        with warnings.catch_warnings():
            yield
    finally:
        sys.setrecursionlimit(depth)
        os.chdir(folder)
        if signal.getsignal(signal.SIGINT) is not interrupt:
            signal.signal(signal.SIGINT, interrupt)


@contextmanager
def _functions_kept() -> Iterator[None]:
    """Put back what is replaced, and raise Meddling with the names."""
    kept = [(owner, space, _fixed(space)) for owner, space in _spaces()]
    changed: list[str] = []
    try:
        yield
    finally:
        for owner, space, fixed in kept:
            if not isinstance(space, type) and sys.modules.get(owner) is not space:
                sys.modules[owner] = space
                changed.append(f"module {owner}")
            for name in [name for name, value in fixed.items() if vars(space).get(name) is not value]:
                setattr(space, name, fixed[name])
                changed.append(f"{owner}.{name}")
    if changed:
        more = f" and {len(changed) - 5} more" if changed[5:] else ""
        raise Meddling(
            f"replaces {', '.join(changed[:5])}{more}, which all others use; give yours another name"
        )


def _spaces() -> Iterator[tuple[str, Any]]:
    """Modules and classes whose names are watched, frictionlab's own laws among them, loaded or not yet."""
    for found in pkgutil.iter_modules(laws.__path__, f"{laws.__name__}."):
        import_module(found.name)
    for name, module in list(sys.modules.items()):
        if module is not None and (name in SHARED or f"{name}.".startswith("frictionlab.")):
            yield name, module
    kinds: tuple[type[Any], ...] = (FrictionLaw, *_subclasses(FrictionLaw))
    for law in kinds:
        if f"{law.__module__}.".startswith("frictionlab."):
            yield f"{law.__module__}.{law.__qualname__}", law


def _subclasses(kind: type[Any]) -> Iterator[type[Any]]:
    for each in kind.__subclasses__():
        yield each
        yield from _subclasses(each)


def _fixed(space: Any) -> Mapping[str, Any]:
    """The functions, classes and numbers of a module; the methods and properties of a class."""
    own = dict(vars(space))
    if isinstance(space, type):
        return {name: value for name, value in own.items() if _is_method(name, value)}
    return {name: value for name, value in own.items() if callable(value) or isinstance(value, float)}


def _is_method(name: str, value: Any) -> bool:
    return not name.startswith("__") and isinstance(value, property | OfEach | type(_is_method))


@contextmanager
def _streams_kept() -> Iterator[None]:
    """Let both streams of text be stderr; open again what is closed, and raise Meddling with the names."""
    streams = {name: getattr(sys, name) for name in ("stdout", "stderr", "__stdout__", "__stderr__")}
    copies = {number: os.dup(number) for number in [each for each in (0, 1, 2) if _is_open(each)]}
    lent = {name: ForwardedText(streams["stderr"]) for name in ("stdout", "stderr")}
    closed: list[str] = []
    for name, stream in lent.items():
        setattr(sys, name, stream)
    try:
        yield
    finally:
        closed += [f"sys.{name}" for name in lent if getattr(sys, name) is not lent[name]]
        closed += [f"sys.{name}" for name, stream in lent.items() if stream.was_closed]
        closed += [f"file descriptor {number}" for number, copy in copies.items() if _put_back(number, copy)]
        for name, stream in streams.items():
            gone = stream is not None and stream.closed
            closed += [f"sys.{name}"] if gone else []
            setattr(sys, name, _opened_again(stream, 1 + ("err" in name)) if gone else stream)
    if closed:
        told = ", ".join(dict.fromkeys(closed))
        raise Meddling(f"closes or replaces {told}: the program needs it to report results")


def _is_open(number: int) -> bool:
    try:
        os.fstat(number)
    except OSError:
        return False
    return True


def _put_back(number: int, copy: int) -> bool:
    """Whether a file descriptor is no longer what it was; it is afterwards."""
    same = False
    with suppress(OSError):
        same = os.path.sameopenfile(number, copy)
    if not same:
        os.dup2(copy, number)
    os.close(copy)
    return not same


def _opened_again(stream: Any, number: int) -> Any:
    """A stream like the closed one. Python's own leave the file descriptor open when closed."""
    return open(number, "w", encoding=stream.encoding, errors=stream.errors, buffering=1, closefd=False)


@contextmanager
def time_limit(seconds: float) -> Iterator[None]:
    """Raise TimeLimitExceeded in this thread if the block takes longer; compiled code is not interrupted."""
    thread, done, turn = threading.get_ident(), threading.Event(), threading.Lock()

    def watch() -> None:
        wait = seconds
        while not done.wait(wait):
            wait = 0.5  # again: what is raised inside a callback of the collector is lost
            with turn:
                if not done.is_set():
                    ctypes.pythonapi.PyThreadState_SetAsyncExc(
                        ctypes.c_ulong(thread), ctypes.py_object(TimeLimitExceeded)
                    )

    watcher = threading.Thread(target=watch, daemon=True)
    watcher.start()
    try:
        yield
    finally:
        with turn:
            done.set()
