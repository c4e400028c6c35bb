"""The names that a function's code uses."""

from __future__ import annotations

from collections.abc import Iterator
from types import CodeType

FOREIGN = {"builtins", "math", "cmath", "numpy", "numba", "llvmlite", "typing", "pydantic", "abc"}
"""Packages whose functions kernels name and nobody looks into."""


def names_used(code: CodeType) -> Iterator[str]:
    """Those of the functions inside it included."""
    yield from code.co_names
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            yield from names_used(constant)
