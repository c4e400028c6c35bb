"""How kernels are compiled: the only options ever given to numba."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numba
import numba.core.typing.templates
import numba.extending

from frictionlab.compile.linking import ENTRIES, PARTS

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
    """The same for a function only other kernels call: it compiles faster, having no entry from Python.

    Never call one from Python: nothing stands in the way of the crash.
    """
    return _compiled(function, **INNER)


def inlined(function: Callable[..., Any]) -> Any:
    """Put a function's text in the place of every call: its arrays on the stack are then those of the caller.

    For such alone: numba compiles the text anew for every call.
    """
    return numba.njit(inline="always", **INNER)(function)


def fast(function: Callable[..., Any]) -> Any:
    """The same for inner arithmetic that never meets NaN or infinity on purpose."""
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
