"""Compiling of kernels: the only options ever given to numba.

The names that a function's code uses.

Code that only other kernels call: kept as it is until the entry that calls it is compiled, and compiled there.

numba by itself optimises every function together with all it calls and makes machine code of it at every level of
calls, though only entries are ever run. Here a function keeps its own code and a list of what it calls; an entry
links each function once. Small parts are still optimised by themselves: what is inlined from them is then small, and
the entry runs some 15 % faster.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from types import CodeType
from typing import Any

import llvmlite.binding
import numba
import numba.core.codegen
import numba.core.compiler
import numba.core.typing.templates
import numba.extending

FOREIGN = {"builtins", "math", "cmath", "numpy", "numba", "llvmlite", "typing", "pydantic", "abc"}
"""Packages whose functions kernels name and nobody looks into."""


def names_used(code: CodeType) -> Iterator[str]:
    """Return the names that a function uses, those of the functions inside it included."""
    yield from code.co_names
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            yield from names_used(constant)


_Library: Any = numba.core.codegen.JITCodeLibrary  # internals of numba, untyped
_Compiler: Any = numba.core.compiler.Compiler
SMALL_PART = 10
"""Size of a function with all it calls [functions] up to which they are linked and optimised by themselves."""
OF_OTHERS = 3
"""Functions that a library of numba's own counts for."""


class _Part(_Library):  # type: ignore[misc]
    """A function to be linked into an entry; it has no address, and needs no environment."""

    _reached: tuple[Any, ...] = ()
    _size = 1

    def finalize(self) -> None:
        """Link what it calls where that is little; else remember it for the entry."""
        self._raise_if_finalized()
        called = callers_first(self._linking_libraries)
        if 1 + sum(getattr(each, "_size", OF_OTHERS) for each in called) <= SMALL_PART:
            link(self._final_module, called)
            self._optimize_final_module()
            self._size = sum(1 for _ in self.get_defined_functions())
        else:
            self._reached = tuple(called)
        self._finalize_dynamic_globals()
        self._finalized = True

    def own_module(self) -> Any:
        """Return the function, without what it reaches."""
        return super()._get_module_for_linking()

    def _get_module_for_linking(self) -> Any:
        """With all that it reaches: for libraries of numba's own."""
        if not self._reached:
            return self.own_module()
        whole = self.own_module().clone()
        link(whole, self._reached)
        return whole

    def get_pointer_to_function(self, name: str) -> int:
        """No address: machine code is made of the entry alone."""
        return 0

    @property
    def codegen(self) -> Any:
        """Itself, to be asked for ``set_env`` in place of the machine code's owner."""
        return self

    def set_env(self, name: str, environment: Any) -> None:
        """Nothing to set: only code that calls Python reads its environment."""


class _Entry(_Library):  # type: ignore[misc]
    """A function that Python calls, with all that it reaches."""

    def finalize(self) -> None:
        """Link every function it reaches once, and compile them together."""
        for each in self._linking_libraries:
            self._reload_init.update(getattr(each, "_reload_init", ()))
        link(self._final_module, callers_first(self._linking_libraries))
        self._linking_libraries.clear()
        super().finalize()


def link(module: Any, libraries: Sequence[Any]) -> None:
    """Put their functions into a module."""
    for each in libraries:
        own = each.own_module() if isinstance(each, _Part) else each._get_module_for_linking()
        module.link_in(own, preserve=True)


def callers_first(libraries: list[Any]) -> list[Any]:
    """Return the libraries and all that they reach, each once and before what it calls.

    The linker drops a function that nothing refers to yet.
    """
    found: dict[Any, None] = {}

    def visit(library: Any) -> None:
        for each in getattr(library, "_reached", ())[::-1]:
            found.setdefault(each)
        found.setdefault(library)

    for library in libraries:
        visit(library)
    return list(found)[::-1]


class _OfParts(_Compiler):  # type: ignore[misc]
    """numba's compiler of functions that other kernels call."""

    def __init__(self, typing: Any, target: Any, library: Any, *others: Any) -> None:
        super().__init__(typing, target, library or _Part(target.codegen(), "part"), *others)


class _OfEntries(_Compiler):  # type: ignore[misc]
    """numba's compiler of functions that Python calls."""

    def __init__(self, typing: Any, target: Any, library: Any, *others: Any) -> None:
        if library is None:
            library = _Entry(target.codegen(), "entry")
            library.enable_object_caching()
        super().__init__(typing, target, library, *others)


def _known() -> bool:
    inherited = ("_optimize_final_module", "_finalize_dynamic_globals", "_get_module_for_linking")
    return all(hasattr(_Library, name) for name in (*inherited, "get_pointer_to_function"))


PARTS: dict[str, Any] = {"pipeline_class": _OfParts} if _known() else {}
ENTRIES: dict[str, Any] = {"pipeline_class": _OfEntries} if _known() else {}
"""Options that tell numba so; empty where its library of code is not the one of numba 0.60 to 0.68."""


def _without_callbacks() -> None:
    """Let llvmlite take its lock without telling listeners: numba times every one of 100,000 calls a kernel."""
    callbacks = getattr(getattr(llvmlite.binding.ffi.lib, "_lock", None), "_cblist", None)
    if isinstance(callbacks, list):
        callbacks.clear()


_without_callbacks()


_COMMON: dict[str, Any] = {"nogil": True, "error_model": "numpy"}
INNER: dict[str, Any] = _COMMON | {"no_cpython_wrapper": True, "no_cfunc_wrapper": True} | PARTS


def _compiled(function: Callable[..., Any], **options: Any) -> Any:
    """By numba, which would compile it anew for every number or truth that a caller writes out: types will do."""
    made: Any = numba.njit(**options)(function)
    if made is function:  # numba compiles nothing
        return made
    own = made._compiler.fold_argument_types

    def folded(given: Any, named: Any) -> Any:
        signature, kinds = own(given, named)
        return signature, tuple(getattr(kind, "literal_type", kind) for kind in kinds)

    made._compiler.fold_argument_types = folded
    return made


def njit(function: Callable[..., Any]) -> Any:
    """Compile a kernel function; it runs without the interpreter lock and divides as IEEE 754 says."""
    return _compiled(function, **_COMMON, **ENTRIES)


def inner(function: Callable[..., Any]) -> Any:
    """Return the same for a function only other kernels call: it compiles faster, having no entry from Python.

    Never call one from Python: nothing stands in the way of the crash.
    """
    return _compiled(function, **INNER)


def inlined(function: Callable[..., Any]) -> Any:
    """Put a function's text in the place of every call: its arrays on the stack are then those of the caller.

    For such alone: numba compiles the text anew for every call.
    """
    return numba.njit(inline="always", **INNER)(function)


def fast(function: Callable[..., Any]) -> Any:
    """Return the same for inner arithmetic that never meets NaN or infinity on purpose."""
    return _compiled(function, fastmath=True, **INNER)


def embedded(function: Callable[..., Any]) -> Any:
    """``inner`` for what is at the heart of a stepper: it is copied into its callers, however many and long.

    Left to itself, LLVM calls such a function once it has grown by a few products, and a planar map takes twice the
    time: a body alone is some thirty numbers to be handed over.
    """
    return _compiled(function, forceinline=True, **INNER)


def fast_embedded(function: Callable[..., Any]) -> Any:
    """``fast``, copied into its callers."""
    return _compiled(function, fastmath=True, forceinline=True, **INNER)
