"""The only place that configures numba: how kernels are compiled, how they see a law, how they are cached.

A kernel takes a law as its first argument and calls its methods, ``law.sliding_vector(v)``. Interpreted, that is
the law itself; compiled, it is a named tuple of the law's numbers whose *type* tells numba which law's methods to
compile. numba's own cache misses an edit in another file, so the disk-cached entry of a kernel lives in a small
module named by a hash of every piece of code and every constant the kernel and the law can reach.
"""

from __future__ import annotations

import atexit
import contextlib
import hashlib
import importlib.util
import inspect
import itertools
import math
import os
import platform
import secrets
import shutil
import sys
import tempfile
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

from frictionlab import kernel_parts
from frictionlab.faults import cannot_compile
from frictionlab.kernel_parts import PARTS
from frictionlab.laws.base import FrictionLaw, SlidingLaw
from frictionlab.laws.bristle import BristleLaw
from frictionlab.laws.memory import MemoryLaw

# numba links compiled functions by name and types, and tells those of one name apart by a number that every process
# counts from 1: of two entries kept by two processes one would run the other's code. A random start keeps them apart.
FunctionIdentity._unique_ids = itertools.count(secrets.randbits(60))

_extending: Any = numba.extending  # its published types lag behind what it accepts
_typeof: Any = numba.typeof
_templates: Any = numba.core.typing.templates
_COMMON: dict[str, Any] = {"nogil": True, "error_model": "numpy"}
_INNER: dict[str, Any] = _COMMON | {"no_cpython_wrapper": True, "no_cfunc_wrapper": True} | PARTS


def njit(function: Callable[..., Any]) -> Any:
    """Compile a kernel function; it runs without the interpreter lock and divides as IEEE 754 says."""
    return numba.njit(**_COMMON)(function)


def inner(function: Callable[..., Any]) -> Any:
    """The same for a function only other kernels call: it compiles faster, having no entry from Python.

    Never call one from Python: nothing stands in the way of the crash.
    """
    return numba.njit(**_INNER)(function)


def fast(function: Callable[..., Any]) -> Any:
    """The same for inner arithmetic that never meets NaN or infinity on purpose."""
    return numba.njit(fastmath=True, **_INNER)(function)


_one_at_a_time = threading.Lock()
"""Two threads that loaded one entry twice would hold two types of the same numbers, and compile for ever."""

_law_of_numbers: dict[type, tuple[type[FrictionLaw], tuple[str, ...]]] = {}


def _open_door(interface: Any, method: str) -> None:
    """Let kernels call this method of an interface on a law's numbers."""

    def resolve(self: Any, *_: Any) -> Any:
        known = _law_of_numbers.get(self.instance_class)
        return None if known is None else _compilable(getattr(known[0], method))

    resolve.__signature__ = inspect.signature(getattr(interface, method))  # type: ignore[attr-defined]  # numba compares
    for kind in (numba.types.NamedTuple, numba.types.NamedUniTuple):
        door = _templates.make_overload_method_template(kind, method, resolve, inline="never", strict=False)
        _templates.infer_getattr(type(method, (_OfLaws, door), {"interface": interface}))
    _extending.overload(resolve, strict=False)(resolve)


class _OfLaws:
    """Opens a door for the numbers of an interface's laws alone.

    Other records may have a field of the method's name, and other laws a method of that name with more arguments:
    numba knows what it compiles by name, so the interface is made a part of it.
    """

    interface: Any
    _attr: str

    def _init_once(self) -> None:
        own = self._attr
        self._attr = self._full(own)
        super()._init_once()  # type: ignore[misc]  # the other base has it
        self._attr = own

    def _resolve(self, typ: Any, attribute: str) -> Any:
        law, _structure = _law_of_numbers.get(typ.instance_class, (object, ()))
        bound = super()._resolve(typ, attribute) if issubclass(law, self.interface) else None  # type: ignore[misc]
        if bound is None:
            return None
        bound.template.key = bound.template.key[0], self._full(attribute)
        return bound.copy(bound.this)  # which knows itself by the new key

    def _full(self, method: str) -> str:
        return f"{self.interface.__name__}.{method}"


for _method in ("sliding_friction", "sliding_vector"):
    _open_door(FrictionLaw, _method)
_open_door(SlidingLaw, "static_friction")
for _method in (
    "rate",
    "friction",
    "exact_path",
    "deflected",
    "saturation_path",
    "largest_deflection",
    "elastic_unloading",
    "yield_deflection",
):
    _open_door(BristleLaw, _method)
for _method in ("count", "rate", "friction", "steady", "stored", "within", "largest_rate"):
    _open_door(MemoryLaw, _method)


def by_dimension(on_the_line: Any, in_the_plane: Any) -> Any:
    """A kernel function with two bodies, chosen by the type of its last argument: ``float`` or ``complex``.

    numba types a branch it never takes; this keeps the other dimension's code out. Both bodies are plain
    functions of the same signature.
    """

    def chosen(*arguments: Any) -> Any:
        return (in_the_plane if isinstance(arguments[-1], complex) else on_the_line)(*arguments)

    def resolve(*types: Any) -> Any:
        return in_the_plane if isinstance(types[-1], numba.types.Complex) else on_the_line

    chosen.bodies = (on_the_line, in_the_plane)  # type: ignore[attr-defined]
    resolve.__signature__ = inspect.signature(on_the_line)  # type: ignore[attr-defined]
    _extending.overload(chosen, jit_options=_INNER | {"fastmath": True}, strict=False)(resolve)
    return chosen


def by_law(
    of_sliding: Any, of_bristle: Any, of_path: Any = None, of_memory: Any = None, of_vectors: Any = None
) -> Any:
    """A kernel function with several bodies of one signature, chosen by the law its first argument is.

    of_path is for bristle laws on the line (no argument is complex) whose path is exact, of_memory for memory laws,
    of_vectors for those whose memories are deflections in the plane; the choice is made when kernels are compiled,
    so that what a law does not need is never compiled for it.
    """
    memory = of_memory or of_sliding
    choices = of_sliding, of_bristle, of_path or of_bristle, memory, of_vectors or memory
    bodies = [getattr(body, "py_func", body) for body in choices]

    def chosen(*arguments: Any) -> Any:
        law, planar = arguments[0], any(isinstance(argument, complex) for argument in arguments)
        return bodies[_which(type(law), law.structure(), planar)](*arguments)

    def resolve(*types: Any) -> Any:
        law, structure = _law_of_numbers[types[0].instance_class]
        return bodies[_which(law, structure, any(isinstance(kind, numba.types.Complex) for kind in types))]

    chosen.bodies = tuple(bodies)  # type: ignore[attr-defined]  # for the fingerprint to find
    resolve.__signature__ = inspect.signature(bodies[0])  # type: ignore[attr-defined]  # numba compares them
    _extending.overload(chosen, jit_options=_INNER, strict=False)(resolve)
    return chosen


def _which(law: type[FrictionLaw], structure: tuple[str, ...], planar: bool) -> int:
    if issubclass(law, MemoryLaw):
        return 4 if law.memory_kind == "deflections" and planar else 3
    if not issubclass(law, BristleLaw):
        return 0
    return 2 if "exact path" in structure and not planar else 1


def _length_on_the_line(v: float) -> float:
    return math.fabs(v)


def _length_in_the_plane(v: complex) -> float:
    return math.sqrt(v.real * v.real + v.imag * v.imag)


length = by_dimension(_length_on_the_line, _length_in_the_plane)
"""``abs`` for kernels: no kernel meets slip near 1e-150, and without that guard it takes a third of the time."""


@cache
def _compilable(function: FunctionType) -> FunctionType:
    """The function with the plain helpers it names compiled too, and ``abs`` quick: laws do not know numba."""
    names = {
        name for name in _names(function.__code__) if isinstance(function.__globals__.get(name), FunctionType)
    }
    helpers = {name: fast(_compilable(function.__globals__[name])) for name in names - {function.__name__}}
    scope = {**function.__globals__, **helpers, "abs": length}
    twin = FunctionType(
        function.__code__, scope, function.__name__, function.__defaults__, function.__closure__
    )
    twin.__annotations__ = {}
    return twin


def compiled(kernel: Any, law: FrictionLaw | None = None) -> Callable[..., Any]:
    """The disk-cached entry of a kernel; with a law, the kernel's first argument is already filled in.

    Raises CannotCompile, when called, where numba cannot compile the law's methods.
    """
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
    entry: Any = call.args[0] if isinstance(call, partial) else call
    bound = call.args[2:] if isinstance(call, partial) else ()
    with contextlib.suppress(NumbaError, UnsupportedBytecodeError):  # the call itself says what is wrong
        entry.compile(tuple(_typeof(argument) for argument in (*bound, *arguments)))
    start = time.perf_counter()
    result = call(*arguments)
    return result, time.perf_counter() - start


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
        '"""A compiled kernel entry of frictionlab, named by its content; safe to delete."""\n'
        "from numba import njit\n\n\n"
        f"# {', '.join((*fields, *structure))}\n"
        '@njit(nogil=True, error_model="numpy", cache=True)\n'
        f"def entry({parameters}):\n    return kernel({parameters})\n"
    )
    numbers = _numbers(law, fields, structure) if law is not None else None
    name = f"frictionlab_{kernel.py_func.__name__}_{_fingerprint(source, kernel, law)}"
    return _load(name, source, kernel=kernel).entry, numbers


@cache
def _numbers(law: type[FrictionLaw], fields: tuple[str, ...], structure: tuple[str, ...]) -> Any:
    """The type of a law's numbers, one for all entries: what they share is compiled once in a process."""
    source = (
        '"""The numbers of a law as kernels of frictionlab see them, named by content; safe to delete."""\n'
        "from typing import NamedTuple\n\n\n"
        f"# {', '.join(structure)}\n"
        "class Numbers(NamedTuple):\n    "
        + "\n    ".join(f"{name}: float" for name in fields or ("none",))
        + "\n"
    )
    name = f"frictionlab_numbers_{_fingerprint(source, law)}"
    known = sys.modules.get(name)  # of another class of the same code: entries may be kept that name its type
    numbers = (known or _load(name, source)).Numbers
    _law_of_numbers[numbers] = law, structure
    return numbers


def _load(name: str, source: str, **given: Any) -> ModuleType:
    """The module of this content, some names given before it runs."""
    path = _written(cache_folder() / f"{name}.py", source)
    if path is None:  # nowhere to write: compile afresh in every process
        folder = Path(tempfile.mkdtemp(prefix="frictionlab-"))
        atexit.register(shutil.rmtree, folder, ignore_errors=True)
        path = folder / f"{name}.py"
        path.write_text(source)
    spec = importlib.util.spec_from_file_location(name, path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    vars(module).update(given)
    sys.modules[name] = module
    spec.loader.exec_module(module)
    return module


def _written(path: Path, source: str) -> Path | None:
    """The module file, written once and whole, or None where that is not possible."""
    try:
        if not path.exists():
            path.parent.mkdir(parents=True, exist_ok=True)
            handle, temporary = tempfile.mkstemp(dir=path.parent, suffix=".tmp")
            with os.fdopen(handle, "w") as file:
                file.write(source)
            os.replace(temporary, path)
    except OSError:
        return None
    return path


def cache_folder() -> Path:
    """Where compiled entries are kept: $FRICTIONLAB_CACHE, else the user's cache folder."""
    if chosen := os.environ.get("FRICTIONLAB_CACHE"):
        return Path(chosen)
    base = os.environ.get("XDG_CACHE_HOME") or os.environ.get("LOCALAPPDATA") or Path.home() / ".cache"
    return Path(base) / "frictionlab"


def _fingerprint(*roots: Any) -> str:
    """A hash of everything the roots can reach: code, constants, helpers in any file, and the compiler."""
    versions = (sys.version, platform.machine(), numba.__version__, llvmlite.__version__, np.__version__)
    digest = hashlib.sha256(repr(versions).encode())
    for file in (__file__, kernel_parts.__file__):
        digest.update(Path(file).read_bytes())
    for piece in _pieces(roots, set()):
        digest.update(piece.encode())
        digest.update(b"\0")
    return digest.hexdigest()[:24]


_FOREIGN = {"builtins", "math", "cmath", "numpy", "numba", "typing", "pydantic", "abc"}


def _pieces(values: Any, seen: set[int]) -> Iterator[str]:
    """Text that changes whenever what these values compute changes; each object is visited once."""
    for value in values:
        value = getattr(value, "py_func", value)
        if id(value) in seen:
            continue
        if isinstance(value, FunctionType | type | ModuleType):
            seen.add(id(value))
            yield from _pieces_of_code(value, seen)
        elif isinstance(value, np.ndarray):
            yield f"{value.dtype}{value.shape}{value.tobytes()!r}"
        elif isinstance(value, list | tuple | dict):  # of functions: their own text is an address
            yield f"{type(value).__name__} of {len(value)}"
            yield from _pieces(itertools.chain(*value.items()) if isinstance(value, dict) else value, seen)
        else:
            yield repr(value)


def _pieces_of_code(value: Any, seen: set[int]) -> Iterator[str]:
    home: str = getattr(value, "__module__", None) or getattr(value, "__name__", None) or ""
    yield f"{home}.{getattr(value, '__qualname__', '')}"
    if home.partition(".")[0] in _FOREIGN or isinstance(value, ModuleType):
        return
    if isinstance(value, type):
        yield repr(getattr(value, "_fields", ()))
        yield from _pieces([base for base in value.__mro__[1:] if base is not object], seen)
        yield from _pieces([m for m in vars(value).values() if isinstance(m, FunctionType)], seen)
        return
    yield from _pieces_of_bytecode(value.__code__)
    cells = [cell.cell_contents for cell in value.__closure__ or ()]
    yield from _pieces([*(value.__defaults__ or ()), *cells, *_globals_used(value)], seen)


def _pieces_of_bytecode(code: CodeType) -> Iterator[str]:
    yield repr((code.co_code, code.co_names, code.co_varnames))
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            yield from _pieces_of_bytecode(constant)
        else:
            yield repr(constant)


def _globals_used(function: FunctionType) -> Iterator[Any]:
    """The globals a function names, and what it takes from the modules among them, packages included."""
    names = list(_names(function.__code__))
    waiting = [function.__globals__[name] for name in names if name in function.__globals__]
    opened: set[int] = set()
    for value in waiting:  # grows while modules are opened
        yield value
        foreign = not isinstance(value, ModuleType) or value.__name__.partition(".")[0] in _FOREIGN
        if not foreign and id(value) not in opened:
            opened.add(id(value))
            waiting += [getattr(value, attribute) for attribute in names if hasattr(value, attribute)]


def _names(code: CodeType) -> Iterator[str]:
    yield from code.co_names
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            yield from _names(constant)
