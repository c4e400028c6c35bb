"""Compiled kernel entries, each named by a hash of all the code it can reach.

numba's own cache misses an edit in another file, so an entry is named by every piece of code and every constant the
kernel and the law can reach.
"""

from __future__ import annotations

import contextlib
import hashlib
import inspect
import itertools
import platform
import secrets
import sys
import threading
import time
from collections.abc import Callable, Iterator
from functools import cache, partial
from pathlib import Path
from types import CodeType, FunctionType, ModuleType
from typing import Any

import llvmlite
import numba
import numba.core.typing.templates
import numba.extending
import numpy as np
from numba.core.bytecode import FunctionIdentity
from numba.core.errors import NumbaError, UnsupportedBytecodeError

from frictionlab.compile import collection  # noqa: F401  # listens
from frictionlab.compile.account import Account
from frictionlab.compile.dispatch import FOREIGN, law_of_numbers, names_used
from frictionlab.compile.kept import KeptEntry
from frictionlab.faults import cannot_compile
from frictionlab.laws.base import FrictionLaw

# numba links compiled functions by name and types, and tells those of one name apart by a number that every process
# counts from 1: of two entries kept by two processes one would run the other's code. A random start keeps them apart.
FunctionIdentity._unique_ids = itertools.count(secrets.randbits(60))
_typeof: Any = numba.typeof
_config: Any = numba.config


_one_at_a_time = threading.Lock()
"""Two threads that loaded one entry twice would hold two types of the same numbers, and compile for ever."""


def compiled(kernel: Any, law: FrictionLaw | None = None) -> Callable[..., Any]:
    """The disk-cached entry of a kernel; with a law, the kernel's first argument is already filled in.

    Where numba is told to compile nothing, the kernel itself, and the law as it is. Raises CannotCompile, when
    called, where numba cannot compile the law's methods.
    """
    if _config.DISABLE_JIT:
        return kernel if law is None else partial(kernel, law)
    numbers, structure = (law.numbers(), law.structure()) if law is not None else ({}, ())
    with _one_at_a_time:
        entry, numbers_type = _entry(
            kernel, type(law) if law is not None else None, tuple(numbers), structure
        )
    if law is None:
        return entry
    seen = {name: np.array(value) if isinstance(value, tuple) else value for name, value in numbers.items()}
    return partial(
        _guarded, entry, type(law), numbers_type(**seen)
    )  # arrays: one kernel for tuples of any length


def timed(call: Callable[..., Any], *arguments: Any) -> tuple[Any, float]:
    """What a compiled entry returns, and the seconds it took, compilation left out."""
    # The call itself says what is wrong with a law; interpreted kernels have nothing to compile.
    with contextlib.suppress(NumbaError, UnsupportedBytecodeError, AttributeError):
        entry, signature = _entry_and_signature(call, arguments)
        entry.compile(signature)
    start = time.perf_counter()
    result = call(*arguments)
    return result, time.perf_counter() - start


def account_of(call: Callable[..., Any], arguments: tuple[Any, ...]) -> Account:
    """What Python has spent on a compiled entry for arguments like these."""
    entry, signature = _entry_and_signature(call, arguments)
    return entry._cache.account(signature, entry.targetctx.codegen(), signature in entry.overloads)


def _entry_and_signature(call: Any, arguments: tuple[Any, ...]) -> tuple[Any, tuple[Any, ...]]:
    entry: Any = call.args[0] if isinstance(call, partial) else call
    bound = call.args[2:] if isinstance(call, partial) else ()
    return entry, tuple(_typeof(argument) for argument in (*bound, *arguments))


def _guarded(entry: Callable[..., Any], law: type[FrictionLaw], *arguments: Any) -> Any:
    try:
        return entry(*arguments)
    except (NumbaError, UnsupportedBytecodeError) as problem:
        raise cannot_compile(law, str(problem)) from problem


@cache
def _entry(
    kernel: Any, law: type[FrictionLaw] | None, fields: tuple[str, ...], structure: tuple[str, ...]
) -> tuple[Any, Any]:
    """The compiled entry and the type of the law's numbers (None without a law)."""
    parameters = ", ".join(inspect.signature(kernel.py_func).parameters)
    source = (
        "from numba import njit\n\n\n"
        f"# {', '.join((*fields, *structure))}\n"
        '@njit(nogil=True, error_model="numpy")\n'
        f"def entry({parameters}):\n    return kernel({parameters})\n"
    )
    numbers = _numbers(law, fields, structure) if law is not None else None
    name = f"frictionlab_{kernel.py_func.__name__}_{_fingerprint(source, kernel, law)}"
    entry = _module(name, source, kernel=kernel).entry
    entry._cache = KeptEntry(name)
    return entry, numbers


@cache
def _numbers(law: type[FrictionLaw], fields: tuple[str, ...], structure: tuple[str, ...]) -> Any:
    """The type of a law's numbers, one for all entries: what they share is compiled once in a process."""
    source = (
        "from typing import NamedTuple\n\n\n"
        f"# {', '.join(structure)}\n"
        "class Numbers(NamedTuple):\n    "
        + "\n    ".join(f"{name}: float" for name in fields or ("none",))
        + "\n"
    )
    name = f"frictionlab_numbers_{_fingerprint(source, law)}"
    known = sys.modules.get(name)  # of another class of the same code: entries may be kept that name its type
    numbers = (known or _module(name, source)).Numbers
    law_of_numbers[numbers] = law, structure
    return numbers


def _module(name: str, source: str, **given: Any) -> ModuleType:
    """The module of this content, some names given before it runs; machine code refers to it by name."""
    module = ModuleType(name)
    vars(module).update(given)
    sys.modules[name] = module
    exec(compile(source, f"<{name}>", "exec"), vars(module))
    return module


HOST_ONLY = {"account.py", "call.py", "collection.py", "interpret.py", "kept.py", "notice.py"}
"""Files of this folder that decide where machine code is kept and how soon it is there, and nothing in it."""
# Read once: were these files edited while a process runs, an entry would be named by the new ones and refer to
# numbers named by the old ones, and no other process could load it.
_COMPILER = b"".join(
    file.read_bytes() for file in sorted(Path(__file__).parent.glob("*.py")) if file.name not in HOST_ONLY
)


def _fingerprint(*roots: Any) -> str:
    """A hash of everything the roots can reach: code, constants, helpers in any file, and the compiler."""
    versions = (sys.version, platform.machine(), numba.__version__, llvmlite.__version__, np.__version__)
    digest = hashlib.sha256(repr(versions).encode())
    digest.update(_COMPILER)
    for piece in _pieces(roots, set()):
        digest.update(piece.encode())
        digest.update(b"\0")
    return digest.hexdigest()[:24]


_OF_RECORDS = "frictionlab.quantities"
"""Home of what laws share with all records: it checks what they are given, and no kernel calls it."""


def _pieces(values: Any, seen: set[int]) -> Iterator[str]:
    """Text that changes whenever what these values compute changes; each object is read once, then named."""
    for value in values:
        if value is law_of_numbers:  # laws that this process has met change no code
            continue
        value = getattr(value, "py_func", value)
        if not isinstance(
            value, FunctionType
        ):  # a cached one has its function inside, and no text of its own
            value = getattr(value, "__wrapped__", value)
        if id(value) in seen:  # which one stands here matters, too
            yield f"{getattr(value, '__module__', '')}.{value.__name__}"
            continue
        if isinstance(value, FunctionType | type | ModuleType):
            seen.add(id(value))
            yield from _pieces_of_code(value, seen)
        elif isinstance(value, np.ndarray):
            yield f"{value.dtype}{value.shape}{value.tobytes()!r}"
        elif isinstance(value, list | tuple | dict):  # of functions: their own text is an address
            yield f"{type(value).__name__} of {len(value)}"
            yield from _pieces(itertools.chain(*value.items()) if isinstance(value, dict) else value, seen)
        elif isinstance(value, set | frozenset):  # in another order in every process
            yield repr(sorted(map(repr, value)))
        else:
            yield repr(value)


def _pieces_of_code(value: Any, seen: set[int]) -> Iterator[str]:
    home: str = getattr(value, "__module__", None) or getattr(value, "__name__", None) or ""
    yield f"{home}.{getattr(value, '__qualname__', '')}"
    if home.partition(".")[0] in FOREIGN or isinstance(value, ModuleType):
        return
    if isinstance(value, type) and home == _OF_RECORDS:
        return
    if isinstance(value, type):
        yield repr(getattr(value, "_fields", ()))
        yield from _pieces([base for base in value.__mro__[1:] if base is not object], seen)
        methods = [getattr(member, "py_func", member) for member in vars(value).values()]
        yield from _pieces([each for each in methods if isinstance(each, FunctionType)], seen)
        return
    yield from _pieces_of_bytecode(value.__code__)
    cells = [cell.cell_contents for cell in value.__closure__ or ()]
    yield from _pieces([*(value.__defaults__ or ()), *cells, *_globals_used(value)], seen)


def _pieces_of_bytecode(code: CodeType) -> Iterator[str]:
    yield repr((code.co_code, code.co_names, code.co_varnames))
    for constant in _constants(code):
        if isinstance(constant, CodeType):
            yield from _pieces_of_bytecode(constant)
        else:
            yield from _pieces([constant], set())


def _constants(code: CodeType) -> tuple[Any, ...]:
    """The constants of a function without its docstring, which changes nothing that it computes."""
    has_docstring = 0x4000000  # the flag of Python 3.13; before, None stands for a docstring that is missing
    named = code.co_flags & has_docstring if sys.version_info >= (3, 13) else not code.co_name.startswith("<")
    documented = bool(named) and isinstance(code.co_consts[0], str)
    return code.co_consts[1:] if documented else code.co_consts


def _globals_used(function: FunctionType) -> Iterator[Any]:
    """The globals a function names, and what it takes from the modules among them, packages included."""
    names = list(names_used(function.__code__))
    waiting = [function.__globals__[name] for name in names if name in function.__globals__]
    opened: set[int] = set()
    for value in waiting:  # grows while modules are opened
        yield value
        foreign = not isinstance(value, ModuleType) or value.__name__.partition(".")[0] in FOREIGN
        if not foreign and id(value) not in opened:
            opened.add(id(value))
            waiting += [getattr(value, attribute) for attribute in names if hasattr(value, attribute)]
