"""Compiled kernel entries, each named by a hash of all the code it can reach.

numba's own cache misses an edit in another file, so an entry is named by every piece of code and every constant the
kernel and the law can reach.

No search for garbage while numba compiles: its trees outlive every search, which took an eighth of the time.

Users of arrays are counted in records that hold arrays alone.

numba looks for arrays in every number of every record each time that one is given a name or let go: of a record of
thirty numbers that is half of the text it hands to LLVM, which then drops it.
"""

from __future__ import annotations

import contextlib
import gc
import hashlib
import inspect
import itertools
import platform
import secrets
import sys
import threading
from collections.abc import Iterator
from functools import cache, partial
from pathlib import Path
from types import CodeType, FunctionType, ModuleType
from typing import Any, NamedTuple

import llvmlite
import numba
import numba.core.event
import numba.core.runtime.context
import numba.core.typing.templates
import numba.extending
import numpy as np
from numba.core.bytecode import FunctionIdentity
from numba.core.errors import NumbaError, UnsupportedBytecodeError

from frictionlab.compile.decorators import FOREIGN, inner, names_used, njit
from frictionlab.compile.dispatch import KernelLaw, KnownLaw, by_itself, law_of_numbers
from frictionlab.compile.kept import KeptEntry
from frictionlab.laws.base import FrictionLaw
from frictionlab.laws.faults import cannot_compile

_event: Any = numba.core.event


class _PausesCollection(_event.Listener):  # type: ignore[misc]  # numba has no types
    """Switches the collector off where the outermost function begins to compile, and on again where it ends.

    One kernel is compiled at a time: numba holds a lock from before the first of these calls to after the last.
    """

    depth = 0
    was_on = False

    def on_start(self, event: Any) -> None:
        """Called for every function, before it is compiled."""
        if self.depth == 0:
            self.was_on = gc.isenabled()
            gc.disable()
        self.depth += 1

    def on_end(self, event: Any) -> None:
        """Called for every function, whether it was compiled or could not be."""
        self.depth -= 1
        if self.depth == 0 and self.was_on:
            gc.enable()


def pause_collection() -> None:
    """From now on."""
    _event.register("numba:compile", _PausesCollection())


_Context: Any = numba.core.runtime.context.NRTContext  # internals of numba, untyped
_holds: dict[Any, bool] = {}
"""Types of numba's values, with whether there is an array inside."""


def _arrays_in(context: Any, builder: Any, kind: Any, value: Any) -> list[Any]:
    """Return the type and the address of what counts the users of each array inside a value."""
    models = context._context.data_model_manager
    model = models[kind]
    found = [(kind, model.get_nrt_meminfo(builder, value))] if model.has_nrt_meminfo() else []
    for inside, part in model.traverse(builder) if _hold_arrays(models, kind) else ():
        if _hold_arrays(models, inside):
            found += _arrays_in(context, builder, inside, part(value))
    return found


def _hold_arrays(models: Any, kind: Any) -> bool:
    if kind not in _holds:
        _holds[kind] = models[kind].contains_nrt_meminfo()
    return _holds[kind]


def count_in_arrays_alone() -> None:
    """From now on."""
    _Context.get_meminfos = _arrays_in


# numba links compiled functions by name and types, and tells those of one name apart by a number that every process
# counts from 1: of two entries kept by two processes one would run the other's code. A random start keeps them apart.
FunctionIdentity._unique_ids = itertools.count(secrets.randbits(60))
pause_collection()
count_in_arrays_alone()
_typeof: Any = numba.typeof
_config: Any = numba.config


_one_at_a_time = threading.Lock()
"""Two threads that loaded one entry twice would hold two types of the same numbers, and compile for ever."""


class Compiled(NamedTuple):
    """Disk-cached entry of a kernel, called like a function; bound: the numbers of the law, filled in already.

    Raises CannotCompile, when called, where numba cannot compile the law's methods.
    """

    entry: Any
    law: KernelLaw | None
    bound: tuple[Any, ...]

    def __call__(self, *arguments: Any) -> Any:
        """Return what the kernel returns."""
        try:
            return self.entry(*self.bound, *arguments)
        except (NumbaError, UnsupportedBytecodeError) as problem:
            if self.law is None:
                raise
            raise cannot_compile(type(self.law.law), str(problem)) from problem

    def prepare(self, *arguments: Any) -> None:
        """Compile it for arguments like these, or load what is kept."""
        # the call itself says what is wrong with a law
        with contextlib.suppress(NumbaError, UnsupportedBytecodeError):
            self.entry.compile(self._signature(arguments))

    def is_kept(self, *arguments: Any) -> bool:
        """Check whether there is machine code for arguments like these, in this process or on disk."""
        signature = self._signature(arguments)
        return signature in self.entry.overloads or self.entry._cache.has(
            signature, self.entry.targetctx.codegen()
        )

    def is_kept_at_all(self) -> bool:
        """Check whether there is machine code for any arguments."""
        return bool(self.entry.overloads) or self.entry._cache.has_any()

    def _signature(self, arguments: tuple[Any, ...]) -> tuple[Any, ...]:
        return tuple(_typeof(argument) for argument in (*self.bound, *arguments))


def compiled(kernel: Any, law: KernelLaw | FrictionLaw | None = None) -> Any:
    """Entry of a kernel, its first argument the law where there is one: by itself where it is not told how.

    Where numba is told to compile nothing, the kernel itself.
    """
    if law is None:
        return kernel if _config.DISABLE_JIT else Compiled(_entry_of(kernel, None)[0], None, ())
    law = by_itself(law) if isinstance(law, FrictionLaw) else law
    if _config.DISABLE_JIT:
        return partial(kernel, law.law)
    entry, numbers = _entry_of(kernel, law)
    # arrays: one kernel for tuples of any length
    seen = {
        name: np.array(value) if isinstance(value, tuple) else value for name, value in law.numbers.items()
    }
    return Compiled(entry, law, (numbers(**seen),))


def _entry_of(kernel: Any, law: KernelLaw | None) -> Any:
    with _one_at_a_time:
        return _entry(kernel, None, ()) if law is None else _entry(kernel, law.kind, tuple(law.numbers))


@cache
def _entry(kernel: Any, law: KnownLaw | None, fields: tuple[str, ...]) -> tuple[Any, Any]:
    """Return the compiled entry and the type of the law's numbers (None without a law)."""
    structure = () if law is None else law.structure
    parameters = ", ".join(inspect.signature(kernel.py_func).parameters)
    source = (
        f"# {', '.join((*fields, *structure))}\n"
        "@njit\n"
        f"def entry({parameters}):\n    return kernel({parameters})\n"
    )
    numbers = None if law is None else _numbers(law, fields)
    name = f"frictionlab_{kernel.py_func.__name__}_{_fingerprint(source, kernel, law and law.kind)}"
    # a kernel that Python may call, too, would be made machine code of twice
    part = kernel if "no_cpython_wrapper" in kernel.targetoptions else inner(kernel.py_func)
    entry = _module(name, source, kernel=part, njit=njit).entry
    entry._cache = KeptEntry(name)
    compile_entry = entry.compile

    def compile_once(signature: Any) -> Any:
        with entry._cache.compiled_once(signature, entry.targetctx.codegen()):
            return compile_entry(signature)

    entry.compile = compile_once
    return entry, numbers


@cache
def _numbers(law: KnownLaw, fields: tuple[str, ...]) -> Any:
    """Return the type of a law's numbers, one for all entries: what they share is compiled once in a process."""
    source = (
        "from typing import NamedTuple\n\n\n"
        f"# {', '.join(law.structure)}\n"
        "class Numbers(NamedTuple):\n    "
        + "\n    ".join(f"{name}: float" for name in fields or ("none",))
        + "\n"
    )
    name = f"frictionlab_numbers_{_fingerprint(source, law.kind)}"
    known = sys.modules.get(name)  # of another class of the same code: entries may be kept that name its type
    numbers = (known or _module(name, source)).Numbers
    law_of_numbers[numbers] = law
    return numbers


def _module(name: str, source: str, **given: Any) -> ModuleType:
    """Return the module of this content, some names given before it runs; machine code refers to it by name."""
    module = ModuleType(name)
    vars(module).update(given)
    sys.modules[name] = module
    exec(compile(source, f"<{name}>", "exec"), vars(module))
    return module


HOST_ONLY = {"call.py", "interpret.py", "kept.py", "notice.py"}
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


_OF_RECORDS = "frictionlab.values.quantities"
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
        elif isinstance(value, partial):  # its own text is an address, as are those of lists of functions
            yield from _pieces([value.func, value.args, value.keywords], seen)
        elif isinstance(value, list | tuple | dict):
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
    """Return the constants of a function without its docstring, which changes nothing that it computes."""
    has_docstring = 0x4000000  # the flag of Python 3.13; before, None stands for a docstring that is missing
    named = code.co_flags & has_docstring if sys.version_info >= (3, 13) else not code.co_name.startswith("<")
    documented = bool(named) and isinstance(code.co_consts[0], str)
    return code.co_consts[1:] if documented else code.co_consts


def _globals_used(function: FunctionType) -> Iterator[Any]:
    """Yield the globals a function names, and what it takes from the modules among them, packages included."""
    names = list(names_used(function.__code__))
    waiting = [function.__globals__[name] for name in names if name in function.__globals__]
    opened: set[int] = set()
    for value in waiting:  # grows while modules are opened
        yield value
        foreign = not isinstance(value, ModuleType) or value.__name__.partition(".")[0] in FOREIGN
        if not foreign and id(value) not in opened:
            opened.add(id(value))
            waiting += [getattr(value, attribute) for attribute in names if hasattr(value, attribute)]
